//! Range, mean and standard deviation of a series, and its quantiles.

/// Smallest and largest value of finite `values`. For an empty slice, infinity and minus infinity.
///
/// ```
/// assert_eq!(hysteron::range(&[1.0, -2.0, 3.0]), (-2.0, 3.0));
/// ```
#[must_use]
pub fn range(values: &[f64]) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    values
        .iter()
        .fold(start, |(low, high), &v| (low.min(v), high.max(v)))
}

/// Of fewer values, none is taken for far from the others.
const FEW: usize = 20;
/// Some of more than these say as well where most lie.
const MANY: usize = 50_000;

/// The range of finite `values` that a few far from all others do not set: up to a two-hundredth of
/// them at each end, further from the others than these spread, where these spread at all. For an
/// empty slice, infinity and minus infinity.
///
/// ```
/// let mut read: Vec<f64> = (0..100).map(f64::from).collect();
/// read[50] = 5000.0;
/// assert_eq!(hysteron::fair_range(&read), (0.0, 99.0));
/// assert_eq!(hysteron::fair_range(&read[..50]), (0.0, 49.0));
/// ```
#[must_use]
pub fn fair_range(values: &[f64]) -> (f64, f64) {
    fair(values.iter().copied())
}

/// As [`fair_range`], of the values of several series.
pub(crate) fn fair_range_of_all<'a>(
    series: impl Iterator<Item = &'a Vec<f64>> + Clone,
) -> (f64, f64) {
    fair(series.flatten().copied())
}

fn fair(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let (mut low, mut high) = range(&[]);
    let mut count = 0;
    for value in values.clone() {
        (low, high) = (low.min(value), high.max(value));
        count += 1;
    }
    if count < FEW {
        return (low, high);
    }
    let mut some: Vec<f64> = values.step_by(count.div_ceil(MANY)).collect();
    let few = (some.len() / 200).max(1);
    let last = some.len() - 1;
    let mut nth = |n: usize| *some.select_nth_unstable_by(n, f64::total_cmp).1;
    let inner = (nth(few), nth(last - few));
    let spread = inner.1 - inner.0;
    if spread > 0.0 && low < inner.0 - spread {
        low = inner.0;
    }
    if spread > 0.0 && high > inner.1 + spread {
        high = inner.1;
    }
    (low, high)
}

/// The range of several series together.
pub(crate) fn range_of_all<'a>(series: impl IntoIterator<Item = &'a Vec<f64>>) -> (f64, f64) {
    let ranges = series.into_iter().map(|values| range(values));
    ranges.fold(range(&[]), |(low, high), (a, b)| (low.min(a), high.max(b)))
}

/// Mean and standard deviation of `values` (divided by `n`, not `n − 1`). NaN for an empty slice.
///
/// ```
/// assert_eq!(hysteron::mean_and_deviation(&[1.0, 3.0]), (2.0, 1.0));
/// ```
#[must_use]
pub fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|y| (y - mean) * (y - mean)).sum::<f64>();
    (mean, (square / count).sqrt())
}

/// The value below which a share of the values lies; 0 for no values.
pub(crate) fn quantile(values: impl IntoIterator<Item = f64>, share: f64) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    let Some(last) = values.len().checked_sub(1) else {
        return 0.0;
    };
    let place = (share * last as f64).round() as usize;
    *values
        .select_nth_unstable_by(place.min(last), f64::total_cmp)
        .1
}

/// The size of the range without the hundredth of the values at either end, so that single readings
/// do not make the range.
pub(crate) fn usual_span(values: &[f64]) -> f64 {
    let end = |share| quantile(values.iter().copied(), share);
    end(0.99) - end(0.01)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_series_have_the_fair_range_of_one() {
        let swing = |n: i32| 10.0 * (f64::from(n) * 0.1).sin();
        let one: Vec<f64> = (0..700).map(swing).collect();
        let mut other: Vec<f64> = (700..900).map(swing).collect();
        let clean = range(&[&one[..], &other].concat());
        assert_eq!(fair_range_of_all([&one, &other].into_iter()), clean);
        other[50] = -999.0;
        let (low, high) = fair_range_of_all([&one, &other].into_iter());
        assert_eq!((low, high), fair_range(&[&one[..], &other].concat()));
        assert!(
            (-10.0..-9.0).contains(&low) && high == clean.1,
            "{low} {high}"
        );
        // Where the others do not move, what moves is no spike.
        let mut rests = vec![4.0; 1000];
        rests[500] = 5.0;
        assert_eq!(fair_range(&rests), (4.0, 5.0));
        assert_eq!(fair_range(&[]), range(&[]));
    }
}
