//! Chooses the cut-off of the low-pass filter, so that it removes as much as the noise.
//!
//! This is the discrepancy principle (Morozov 1966): the part removed must be as large as the
//! noise. Removing more would remove signal, and removing less would leave noise.

use crate::error::Result;
use crate::series::filter::low_pass;

/// Noise below this share of the range is not filtered. A model of 20 levels has an error of at
/// least 0.5 % of the range on clean recordings. A tenth of that, added in squares, increases the
/// error by half a percent of itself.
pub(super) const NEGLIGIBLE: f64 = 0.0005;

/// The highest cut-off, in cycles per sample. The limit is half a cycle.
const HIGHEST: f64 = 0.45;
/// The lowest cut-off, in cycles over the whole series.
const LOWEST: f64 = 4.0;

/// The cut-off, in cycles per sample, at which the root mean square of the part removed is `sigma`.
/// `None` if even the highest cut-off removes more.
pub(super) fn cutoff_for(values: &[f64], sigma: f64) -> Result<Option<f64>> {
    let removed = |cutoff: f64| -> Result<f64> {
        let smooth = low_pass(values, 1.0, cutoff)?;
        Ok(distance(values, &smooth))
    };
    let (mut low, mut high) = (LOWEST / values.len() as f64, HIGHEST);
    if low >= high || removed(high)? >= sigma {
        return Ok(None);
    }
    // To an accuracy of 1 %.
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

/// Standard deviation after the filter of white noise with standard deviation 1.
///
/// The gain at `f` is `1/(1 + (f/f_c)⁴)` (a Butterworth filter of order 2, applied twice). Its
/// square has the area `3π f_c / 8√2`. White noise fills half a cycle per sample.
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
    use crate::series::test_series::gaussian;

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
        // The cut-off is accurate to 1 %.
        assert!((distance(&noisy, &smooth) / 0.05 - 1.0).abs() < 0.01);
        // The part removed is nearly all noise. Over 3000 samples its size is known to 1.3 %, so up
        // to √(2 · 0.013) = 0.16 of it may be signal. About as much noise remains, and both may be
        // larger by chance.
        assert!(distance(&truth, &smooth) < 0.3 * 0.05, "cut-off {cutoff}");
    }

    #[test]
    fn the_noise_let_through_is_as_computed() {
        let white = gaussian(9, 20_000);
        for cutoff in [0.02, 0.1, 0.2] {
            let left = low_pass(&white, 1.0, cutoff).unwrap();
            let ratio = distance(&left, &vec![0.0; left.len()]) / let_through(cutoff);
            // About 2·0.02·20,000 independent values at the lowest cut-off give 3 % of the
            // deviation. Twice that is allowed.
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
