//! Range, mean and standard deviation of a series.

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
