//! Estimates the white noise of a series, and the resolution of its readings.

/// Orders of the differences that are tried.
const ORDERS: std::ops::RangeInclusive<usize> = 2..=6;
/// The median of so many differences is within some thousandths of that of all.
const ENOUGH: usize = 100_000;
/// With fewer differences than this there is no estimate.
const FEWEST: usize = 8;
/// Standard deviation of a Gaussian variable over the median of its absolute value.
pub(super) const SIGMA_PER_MEDIAN: f64 = 1.4826;

/// The standard deviation of the white noise on `values`, in their unit. 0 for fewer than ten
/// samples.
///
/// The estimate is the median of the absolute differences of order `k`, over `√C(2k, k)`, the
/// factor by which such a difference amplifies white noise. White noise gives the same at every
/// order from 2 to 6. A smooth signal gives less at each higher order. So the smallest estimate is
/// taken. (Differences of second order: Gasser, Sroka & Jennen-Steinmetz 1986; of higher order:
/// Hall, Kay & Titterington 1990.)
///
/// Slow noise is not detected. For a series that is mostly constant the estimate is 0.
///
/// ```
/// // Every other sample 0.1 too high: a standard deviation of 0.05, though no Gaussian one.
/// let rough: Vec<f64> = (0..100).map(|n| f64::from(n) * 0.3 + f64::from(n % 2) * 0.1).collect();
/// assert!(hysteron::noise(&rough) > 0.03);
/// let smooth: Vec<f64> = (0..100).map(|n| (f64::from(n) * 0.1).sin()).collect();
/// assert!(hysteron::noise(&smooth) < 1e-5);
/// ```
#[must_use]
pub fn noise(values: &[f64]) -> f64 {
    // Odd, since what logs by turns repeats after an even number of samples.
    let stride = values.len().div_ceil(ENOUGH) | 1;
    let mut sizes = Vec::with_capacity(values.len() / stride + 1);
    // C(2k, k), from one order to the next.
    let mut gain = 1.0;
    let mut smallest: Option<f64> = None;
    for order in 1..=*ORDERS.end() {
        gain *= (4 * order - 2) as f64 / order as f64;
        if values.len() < FEWEST + order {
            break;
        }
        if ORDERS.contains(&order) {
            sizes.clear();
            let some = differences(values, order).step_by(stride);
            sizes.extend(some.map(f64::abs));
            let sigma = SIGMA_PER_MEDIAN * median(&mut sizes) / gain.sqrt();
            smallest = Some(smallest.map_or(sigma, |least| least.min(sigma)));
        }
    }
    smallest.unwrap_or(0.0)
}

/// How many deviations the furthest of so many readings with Gaussian noise is away, about.
pub(crate) fn furthest(samples: usize) -> f64 {
    (2.0 * (samples.max(1) as f64).ln()).sqrt()
}

/// The differences of an order, one after the other.
fn differences(values: &[f64], order: usize) -> impl Iterator<Item = f64> {
    // Those of each lower order, at the value before.
    let mut before = [0.0; *ORDERS.end()];
    let all = values.iter().map(move |value| {
        before[..order].iter_mut().fold(*value, |own, before| {
            let next = own - *before;
            *before = own;
            next
        })
    });
    all.skip(order)
}

/// The smallest distance between two different values: the resolution of a reading with a fixed
/// step. 0 if there is only one value.
pub(crate) fn resolution(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.dedup();
    let steps = sorted.windows(2).map(|pair| pair[1] - pair[0]);
    steps.reduce(f64::min).unwrap_or(0.0)
}

/// The median, with the mean of the two middle values for an even count; 0 for no values.
pub(crate) fn median_of(mut values: Vec<f64>) -> f64 {
    median(&mut values)
}

/// As [`median_of`], of values whose order does not matter.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    let Some(middle) = values.len().checked_sub(1).map(|last| last.div_ceil(2)) else {
        return 0.0;
    };
    let (below, &mut upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    if below.len() * 2 == values.len() {
        let lower = values[..middle]
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        return 0.5 * (lower + upper);
    }
    upper
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::test_series::gaussian;

    #[test]
    fn the_noise_on_a_slow_signal_is_found() {
        let count = 4000;
        for (seed, sigma) in [(1, 0.02), (2, 0.2), (3, 1.0)] {
            let white = gaussian(seed, count);
            let signal = (0..count).map(|n| 10.0 * (n as f64 * 0.01).sin());
            let noisy: Vec<f64> = signal.zip(white).map(|(s, e)| s + sigma * e).collect();
            let found = noise(&noisy) / sigma;
            // The median of n absolute values has an error of 1.17/√n, 2 %. Overlapping differences
            // and taking the smallest of five orders make it three times as much.
            assert!((found - 1.0).abs() < 0.06, "{found} of {sigma}");
        }
    }

    #[test]
    fn smooth_short_and_constant_series_have_none() {
        let smooth: Vec<f64> = (0..500).map(|n| (f64::from(n) * 0.05).sin()).collect();
        assert!(noise(&smooth) < 1e-6);
        assert_eq!(noise(&[1.0, 9.0, -3.0]), 0.0);
        assert_eq!(noise(&[2.0; 50]), 0.0);
    }

    #[test]
    fn differences_are_those_taken_again_and_again() {
        let values = gaussian(4, 50);
        let mut expected = values.clone();
        for order in 1..=6 {
            expected = expected.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert!(differences(&values, order).eq(expected.iter().copied()));
            assert_eq!(differences(&values[..order], order).count(), 0);
        }
    }

    #[test]
    fn medians_and_resolution() {
        assert_eq!(median_of(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median_of(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(median_of(vec![]), 0.0);
        assert_eq!(resolution(&[3.0, 1.0, 1.0, 1.5]), 0.5);
        assert_eq!(resolution(&[3.0]), 0.0);
    }
}
