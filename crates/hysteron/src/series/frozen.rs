//! Finds a channel that stands still while the other one moves.

use crate::series::lost::{half_a_branch, held};
use crate::series::spread::{range, usual_span};
use std::ops::Range;

/// Fewer equal readings in a row are not told from a slow signal.
const SHORTEST: usize = 20;
/// The other series rises and falls by at least this share of its usual range meanwhile. No material
/// with any response is still over such a way. One way alone proves nothing: a wire without a drive
/// cools, and its output moves all the way back.
const FAR: f64 = 0.8;
/// A series that often stands still is one of steps: at most this share of its other samples is in
/// long runs.
const OFTEN: f64 = 0.5;

/// The samples over which `values` keeps exactly one value while `other` moves far, or for so long
/// that it may have turned twice, and then goes on elsewhere.
///
/// Frozen are readings of a sensor that lost its contact or of a logger that goes on with the last
/// value. A series that moves in steps is not frozen between them.
pub(crate) fn frozen(values: &[f64], other: &[f64]) -> Vec<Range<usize>> {
    let mut end = 0;
    let runs = values.chunk_by(|a, b| a == b).map(|run| {
        end += run.len();
        end - run.len()..end
    });
    let long: Vec<Range<usize>> = runs.filter(|run| run.len() >= SHORTEST).collect();
    let far = FAR * usual_span(other);
    // A drive may rest at the end of its range before an experiment, while what it moves settles.
    let (low, high) = range(values);
    let not_begun = |run: &Range<usize>| run.start == 0 && [low, high].contains(&values[0]);
    let moves_far = |run: &Range<usize>| {
        let (rise, fall) = rise_and_fall(&other[run.clone()]);
        far > 0.0 && rise.min(fall) >= far && !not_begun(run)
    };
    let (still, rest): (Vec<_>, Vec<_>) = long.into_iter().partition(moves_far);
    let count = |runs: &[Range<usize>]| runs.iter().map(Range::len).sum::<usize>();
    let others = values.len() - count(&still);
    let mut found = match count(&rest) as f64 > OFTEN * others as f64 || others == 0 {
        true => Vec::new(),
        false => still,
    };
    let longest = half_a_branch(values);
    for run in held(values, None)
        .into_iter()
        .filter(|run| run.len() > longest)
    {
        if found.iter().all(|other| !other.contains(&run.start)) {
            found.push(run);
        }
    }
    found
}

/// How far a series rises from a value before, at most, and how far it falls.
fn rise_and_fall(values: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut rise, mut fall) = (0.0_f64, 0.0_f64);
    for &value in values {
        (low, high) = (low.min(value), high.max(value));
        (rise, fall) = (rise.max(value - low), fall.max(high - value));
    }
    (rise, fall)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frozen_channel_is_found_and_steps_are_not() {
        let input: Vec<f64> = (0..2000).map(|n| (f64::from(n) * 0.02).sin()).collect();
        let mut output = input.clone();
        let held = output[1200];
        output[1200..1500].fill(held);
        assert_eq!(frozen(&output, &input), vec![1200..1500]);
        assert_eq!(frozen(&input, &output), vec![]);
        // A drive that is off, while the actuator goes back.
        let mut off = input.clone();
        off[1000..].fill(0.0);
        let back: Vec<f64> = (0..2000)
            .map(|n| {
                if n < 1000 {
                    input[n]
                } else {
                    1.0 - f64::from(n as i32 - 1000) / 500.0
                }
            })
            .collect();
        assert_eq!(frozen(&off, &back), vec![]);
        // Shorter than the way over the range.
        let mut short = input.clone();
        short[1200..1260].fill(held);
        assert_eq!(frozen(&short, &input), vec![]);
        // A drive in steps, and an actuator that follows each.
        let steps: Vec<f64> = (0..2000).map(|n| f64::from(n / 200 % 3)).collect();
        let slow: Vec<f64> = (0..2000).map(|n| f64::from(n % 200)).collect();
        assert_eq!(frozen(&steps, &slow), vec![]);
        assert_eq!(frozen(&[], &[]), vec![]);
    }
}
