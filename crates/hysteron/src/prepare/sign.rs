//! Readings that lost their sign.
//!
//! A meter that shows the magnitude only, as some do just below zero, turns −3 into 3. Over a run
//! of such samples the series jumps where the run begins or ends, unless it begins at zero. Of all
//! ways of giving signs back the one is taken that makes the path of the series shortest, each run
//! costing as much as a jump that is beyond doubt (a shortest path through two states a sample:
//! Viterbi 1967).

use super::noise::{median_of, noise};
use crate::series::range;

/// Signs are lost near zero: only readings up to this part of the range are turned.
const NEAR_ZERO: f64 = 0.1;

/// What one run costs: this part of the range, or more.
const LEAST_GAIN: f64 = 0.04;
/// Or this many standard deviations of the noise, which crosses zero too: turning one sample saves
/// at most four times its magnitude.
const NOISES: f64 = 16.0;
/// Or this many usual steps: a series that goes from one side to the other in single steps does so
/// by itself.
const STEPS: f64 = 3.0;

/// Gives back lost signs, in place, and returns which samples were turned.
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

    // Cost of the best path that ends with the sample as it is, and turned; and whether that path
    // came from a turned one.
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
    use crate::prepare::test_series::gaussian;

    fn cooling_and_heating() -> Vec<f64> {
        (0..2000)
            .map(|n| 20.0 + 50.0 * (f64::from(n) * 0.01).cos())
            .collect()
    }

    #[test]
    fn single_readings_and_runs_get_their_sign_back() {
        let truth = cooling_and_heating();
        let below_zero = |n: &usize| (-8.0..0.0).contains(&truth[*n]);
        // The first three passes from zero down to −8 whole, of the others every third sample.
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
            // Within a step of zero, 0.5, either sign continues the series as well.
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
        // Demagnetisation in single steps, a square wave, a touch of zero.
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
