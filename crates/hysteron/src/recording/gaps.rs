//! Gaps in the time of a recording.

/// The median time step, and the indices of samples that follow a gap: a step of more than three
/// times the median.
pub(crate) fn gaps(time: &[f64]) -> Option<(f64, Vec<usize>)> {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return None;
    }
    let median = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let gap = |&n: &usize| time[n] - time[n - 1] > 3.0 * median;
    Some((median, (1..time.len()).filter(gap).collect()))
}
