//! Gaps in the time of a recording.

#[cfg(feature = "data")]
use crate::series::clear_branches;
use crate::series::lost::Turn;
use crate::series::spread::usual_span;

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
#[cfg(feature = "data")]
const LONG: f64 = 10.0;

/// The indices of samples that follow a long gap.
#[cfg(feature = "data")]
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
    let branch = seen / clear_branches(input) as f64;
    found.retain(|&n| step(n) > 0.5 * branch);
    found
}

/// An input that went on unseen by more than this share of its usual range, and came back, has
/// turned in a way that a model remembers.
const BEYOND: f64 = 0.02;

/// The indices of samples that follow a gap in which the input turned: it comes back from where it
/// went, and where its ways before and after meet is beyond both readings.
pub(crate) fn turned_in_gaps(time: &[f64], input: &[f64]) -> Vec<usize> {
    let Some((median, mut found)) = gaps(time) else {
        return Vec::new();
    };
    let far = BEYOND * usual_span(input);
    found.retain(|&n| {
        let length = (time[n] - time[n - 1]) / median;
        let turn = Turn::between(&input[..n], &input[n..], length);
        turn.is_some_and(|Turn { at, rises: [a, b] }| {
            (a * at).abs().min((b * (length - at)).abs()) > far
        })
    });
    found
}
