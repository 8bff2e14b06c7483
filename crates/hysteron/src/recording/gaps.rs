//! Gaps in the time of a recording.

use crate::series::{branches, range};

/// A gap is a step of more than so many times the median.
pub(crate) const GAP: f64 = 3.0;

/// The median time step, and the indices of samples that follow a gap.
pub(crate) fn gaps(time: &[f64]) -> Option<(f64, Vec<usize>)> {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return None;
    }
    let median = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let gap = |&n: &usize| time[n] - time[n - 1] > GAP * median;
    Some((median, (1..time.len()).filter(gap).collect()))
}

/// A gap is long if the input may have turned in it unseen: more than half of what it takes from
/// one reversal to the next, and more than so many times the median step.
const LONG: f64 = 10.0;
/// Smaller reversals than this share of the input's range are none.
const TURN: f64 = 0.05;

/// The indices of samples that follow a long gap.
pub(crate) fn long_gaps(time: &[f64], input: &[f64]) -> Vec<usize> {
    let Some((median, mut found)) = gaps(time) else {
        return Vec::new();
    };
    let step = |n: usize| time[n] - time[n - 1];
    found.retain(|&n| step(n) > LONG * median);
    let (Some(first), Some(last), false) = (time.first(), time.last(), found.is_empty()) else {
        return found;
    };
    let seen = last - first - found.iter().map(|&n| step(n)).sum::<f64>();
    let (low, high) = range(input);
    let turns = branches(input, TURN * (high - low)).len().max(1);
    found.retain(|&n| step(n) > 0.5 * seen / turns as f64);
    found
}
