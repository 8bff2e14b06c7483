//! How far to smooth: as far as the noise goes.
//!
//! The discrepancy principle (Morozov 1966): what is taken away must be as large as the noise, for
//! more would be signal and less would leave noise.

use crate::error::Result;
use crate::series::filter::low_pass;

/// Noise below this part of the range is left alone. A model of 20 levels misses clean recordings
/// by about 0.5 % of the range at best; a tenth of that, added in squares, changes such an error by
/// a half per cent of itself.
pub(super) const NEGLIGIBLE: f64 = 0.0005;

/// The highest cut-off, in cycles a sample; half a cycle is the most there can be.
const HIGHEST: f64 = 0.45;
/// The lowest, in cycles over the whole series.
const LOWEST: f64 = 4.0;

/// The cut-off, in cycles a sample, at which the root mean square of what the filter takes away is
/// `sigma`; `None` where even the highest takes away more.
pub(super) fn cutoff_for(values: &[f64], sigma: f64) -> Result<Option<f64>> {
    let removed = |cutoff: f64| -> Result<f64> {
        let smooth = low_pass(values, 1.0, cutoff)?;
        Ok(distance(values, &smooth))
    };
    let (mut low, mut high) = (LOWEST / values.len() as f64, HIGHEST);
    if low >= high || removed(high)? >= sigma {
        return Ok(None);
    }
    // To a hundredth of itself.
    while high / low > 1.01 {
        let middle = (low * high).sqrt();
        if removed(middle)? > sigma {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(Some(high))
}

/// The part of white noise of standard deviation 1 that the filter lets through, as a standard
/// deviation.
///
/// Its gain at `f` is `1/(1 + (f/f_c)⁴)` (twice a Butterworth filter of order 2), the square of
/// which has the area `3π f_c / 8√2`; white noise fills half a cycle a sample.
pub(super) fn let_through(cutoff: f64) -> f64 {
    let area = 3.0 * std::f64::consts::PI / (8.0 * std::f64::consts::SQRT_2) * cutoff;
    (area / 0.5).min(1.0).sqrt()
}

/// Root of the mean squared difference.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / a.len() as f64).sqrt()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::prepare::test_series::gaussian;

    #[test]
    fn what_is_taken_away_is_the_noise() {
        let truth: Vec<f64> = (0..3000).map(|n| (f64::from(n) * 0.02).sin()).collect();
        let noisy: Vec<f64> = truth
            .iter()
            .zip(gaussian(8, 3000))
            .map(|(x, e)| x + 0.05 * e)
            .collect();
        let cutoff = cutoff_for(&noisy, 0.05).unwrap().unwrap();
        let smooth = low_pass(&noisy, 1.0, cutoff).unwrap();
        // The cut-off is found to a hundredth.
        assert!((distance(&noisy, &smooth) / 0.05 - 1.0).abs() < 0.01);
        // What is taken away is nearly all noise: of 3000 samples it is known to 1.3 %, and what
        // the signal may lose beside it is √(2 · 0.013) = 0.16 of it; as much noise stays, and both
        // may be somewhat unlucky.
        assert!(distance(&truth, &smooth) < 0.3 * 0.05, "cut-off {cutoff}");
    }

    #[test]
    fn the_noise_let_through_is_as_computed() {
        let white = gaussian(9, 20_000);
        for cutoff in [0.02, 0.1, 0.2] {
            let left = low_pass(&white, 1.0, cutoff).unwrap();
            let ratio = distance(&left, &vec![0.0; left.len()]) / let_through(cutoff);
            // Some 2·0.02·20,000 independent values at the lowest cut-off: 3 % of the deviation,
            // twice that allowed.
            assert!((ratio - 1.0).abs() < 0.06, "{cutoff}: {ratio}");
        }
    }

    #[test]
    fn a_rough_signal_is_not_smoothed() {
        let rough: Vec<f64> = (0..100)
            .map(|n| if n % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        assert_eq!(cutoff_for(&rough, 0.01).unwrap(), None);
        assert_eq!(cutoff_for(&[1.0, 2.0, 1.0], 0.5).unwrap(), None);
    }
}
