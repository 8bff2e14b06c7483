//! The dead band for reversals of the input. It removes reversals that are noise, without a time
//! lag.
//!
//! Noise on the input causes false turning points, and each of them moves operators. A reversal
//! counts only if it is larger than the dead band. Between two reversals that count, the input is
//! made monotone: each value becomes the mean of the largest value so far and the smallest value
//! still to come (on a rising branch).

use crate::series::Turning;
use crate::series::noise::{furthest, resolution};
use hysteron_core::Direction;

/// Makes `values` monotone between reversals of more than `dead_band`, in place. No value moves by
/// more than half the dead band.
pub(super) fn settle(values: &mut [f64], dead_band: f64) {
    let mut turning = Turning::new(dead_band);
    let turns: Vec<(usize, Direction)> = values.iter().filter_map(|&v| turning.push(v)).collect();
    let ends = turns.iter().skip(1).map(|(n, _)| *n);
    let ends: Vec<usize> = ends.chain(values.len().checked_sub(1)).collect();
    for ((start, heading), end) in turns.into_iter().zip(ends) {
        let branch = &mut values[start..=end];
        match heading {
            Direction::Rising => monotone(branch, f64::max, f64::min),
            Direction::Falling => monotone(branch, f64::min, f64::max),
        }
    }
}

/// Replaces each value by the mean of two running extremes: from the front with `ahead`, from the
/// back with `behind`.
fn monotone(branch: &mut [f64], ahead: fn(f64, f64) -> f64, behind: fn(f64, f64) -> f64) {
    let mut from_back = branch.to_vec();
    for n in (1..from_back.len()).rev() {
        from_back[n - 1] = behind(from_back[n - 1], from_back[n]);
    }
    let mut front = None;
    for (value, back) in branch.iter_mut().zip(from_back) {
        let extreme = front.map_or(*value, |so_far| ahead(so_far, *value));
        front = Some(extreme);
        *value = if extreme == back {
            back
        } else {
            0.5 * (extreme + back)
        };
    }
}

/// The largest reversal that white noise of deviation `sigma` causes in `len` samples: the largest
/// of so many Gaussian values (Donoho & Johnstone 1994), on both sides.
pub(super) fn reach(len: usize, sigma: f64) -> f64 {
    2.0 * furthest(len) * sigma
}

/// The smallest step of a reading, plus a margin for the rounding of the difference of two
/// readings.
pub(super) fn resolution_with_rounding(values: &[f64]) -> f64 {
    resolution(values) * (1.0 + 1e-9)
}

/// Number of reversals of the series, of any size.
pub(super) fn reversals(values: &[f64]) -> usize {
    let mut turning = Turning::new(0.0);
    let turns = values.iter().filter_map(|&v| turning.push(v)).count();
    turns.saturating_sub(1) // the start is not a reversal
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::test_series::gaussian;

    #[test]
    fn a_noisy_triangle_keeps_its_own_reversals_only() {
        let truth: Vec<f64> = (0..4000)
            .map(|n| (f64::from(n % 800) - 400.0).abs() * 0.1)
            .collect();
        let noisy: Vec<f64> = truth
            .iter()
            .zip(gaussian(7, 4000))
            .map(|(x, e)| x + 0.3 * e)
            .collect();
        assert!(reversals(&noisy) > 1000);
        let band = 3.0;
        let mut settled = noisy.clone();
        settle(&mut settled, band);
        assert_eq!(reversals(&settled), reversals(&truth));
        for (after, before) in settled.iter().zip(&noisy) {
            assert!((after - before).abs() <= 0.5 * band + 1e-12);
        }
        let mut again = settled.clone();
        settle(&mut again, band);
        assert_eq!(again, settled);
    }

    #[test]
    fn real_reversals_and_their_extremes_stay() {
        let series = [0.0, 5.0, 4.9, 10.0, 3.0, 3.1, 2.0, 8.0, 7.95];
        let mut settled = series;
        settle(&mut settled, 0.5);
        assert_eq!(
            [settled[0], settled[3], settled[6], settled[7]],
            [0.0, 10.0, 2.0, 7.975]
        );
        assert_eq!(reversals(&settled), 2);
        let mut small = [1.0, 1.1, 0.9];
        settle(&mut small, 0.5);
        assert_eq!(small, [1.0, 1.1, 0.9]);
        settle(&mut [], 1.0);
    }
}
