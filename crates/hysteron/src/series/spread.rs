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
