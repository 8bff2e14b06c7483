//! Restores the sign of readings that lost it.
//!
//! Some meters show only the magnitude just below zero and turn −3 into 3. A run of such samples
//! makes the series jump where the run begins and ends, unless it does so at zero. Among all ways
//! to restore signs, this module takes the one with the shortest path of the series. Each run costs
//! as much as a jump that is certainly not noise. This is a shortest path with two states per
//! sample (Viterbi 1967).

use crate::series::noise::{median_of, noise};
use crate::series::range;

/// Signs are lost near zero: only readings up to this share of the range are changed.
const NEAR_ZERO: f64 = 0.1;

/// The cost of one run is at least this share of the range,
const LEAST_GAIN: f64 = 0.04;
/// and at least this many standard deviations of the noise, because noise crosses zero too:
/// changing the sign of one sample saves at most four times its magnitude,
const NOISES: f64 = 16.0;
/// and at least this many usual steps, because some series go from one side to the other in single
/// steps.
const STEPS: f64 = 3.0;

/// Restores lost signs, in place, and returns the indices of the samples changed.
pub(super) fn restore(values: &mut [f64]) -> Vec<usize> {
    let (low, high) = range(values);
    if low >= 0.0 || high <= 0.0 {
        return Vec::new();
    }
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let usual = median_of(steps.filter(|step| *step > 0.0).collect());
    let price = (LEAST_GAIN * (high - low))
        .max(NOISES * noise(values))
        .max(STEPS * usual);
    let turnable = |x: f64| x >= 0.0 && x <= NEAR_ZERO * (high - low);

    // For the sample as it is and with its sign changed: cost of the best path that ends there, and
    // whether the sample before has its sign changed on that path.
    let mut cost = [0.0, f64::INFINITY];
    let mut came_turned: Vec<[bool; 2]> = Vec::with_capacity(values.len());
    let mut last = None;
    for &x in values.iter() {
        let last = last.replace(x).unwrap_or(x);
        let from = |before: f64, x: f64, enter: f64| {
            let (plain, turned) = (
                cost[0] + (x - before).abs() + enter,
                cost[1] + (x + before).abs(),
            );
            (plain.min(turned), turned < plain)
        };
        let plain = from(last, x, 0.0);
        let turned = match turnable(x) {
            true => from(last, -x, price),
            false => (f64::INFINITY, false),
        };
        cost = [plain.0, turned.0];
        came_turned.push([plain.1, turned.1]);
    }
    let mut turned = cost[1] < cost[0];
    let mut result = Vec::new();
    for n in (0..values.len()).rev() {
        if turned && values[n] > 0.0 {
            values[n] = -values[n];
            result.push(n);
        }
        turned = came_turned[n][usize::from(turned)];
    }
    result.reverse();
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::test_series::gaussian;

    fn cooling_and_heating() -> Vec<f64> {
        (0..2000)
            .map(|n| 20.0 + 50.0 * (f64::from(n) * 0.01).cos())
            .collect()
    }

    #[test]
    fn single_readings_and_runs_get_their_sign_back() {
        let truth = cooling_and_heating();
        let below_zero = |n: &usize| (-8.0..0.0).contains(&truth[*n]);
        // All samples of the first three passes from zero down to −8, then every third sample.
        let lost: Vec<usize> = (0..truth.len())
            .filter(below_zero)
            .filter(|n| *n < 1000 || n % 3 == 0 && truth[*n] < -3.0)
            .collect();
        let mut read = truth.clone();
        for &n in &lost {
            read[n] = -read[n];
        }
        assert!(lost.len() > 40);
        let turned = restore(&mut read);
        assert!(turned.iter().all(|n| lost.contains(n)));
        for (n, (found, truth)) in read.iter().zip(&truth).enumerate() {
            // Within a step of zero, 0.5, either sign continues the series equally well.
            let unsure = if truth.abs() < 0.5 { 1.0 } else { 0.0 };
            assert!((found - truth).abs() <= unsure, "{n}: {found} for {truth}");
        }
    }

    #[test]
    fn nothing_else_is_turned() {
        let quiet = cooling_and_heating();
        let noisy: Vec<f64> = quiet
            .iter()
            .zip(gaussian(4, 2000))
            .map(|(x, e)| x + e)
            .collect();
        let noise_alone = gaussian(5, 4000);
        // Demagnetisation in single steps, a square wave, and a series that touches zero.
        let alternating: Vec<f64> = (0..100)
            .map(|n| f64::from(100 - n) * if n % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let square: Vec<f64> = (0..100)
            .map(|n| if n % 20 < 10 { 5.0 } else { -5.0 })
            .collect();
        let touching: Vec<f64> = (0..200).map(|n| f64::from(n - 100).abs() - 1.0).collect();
        for series in [quiet, noisy, noise_alone, alternating, square, touching] {
            let mut after = series.clone();
            assert_eq!(restore(&mut after), [0; 0]);
            assert_eq!(after, series);
        }
    }
}
