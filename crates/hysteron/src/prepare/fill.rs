//! What stands in place of readings that were lost.
//!
//! The input may have turned meanwhile. So the lines along which it went before and after are
//! drawn on, and where they meet it turned; where they do not meet, a line joins both sides. The
//! output is what a model of all other readings says, moved so that it joins the readings on both
//! sides. It then has no say in the model that is fitted to it.

use super::judge::from_kept;
use crate::recording::Recording;
use crate::series::lost::{Turn, ends, fill};
use crate::series::range;
use std::ops::Range;

/// In a shorter run than this nothing turns.
const SHORTEST: usize = 3;

/// The input, with other values in place of `lost` samples, which ascend.
pub(super) fn input(recording: &Recording, lost: &[usize]) -> Vec<f64> {
    let mut values = recording.input.clone();
    let kept = (0..values.len()).filter(|n| lost.binary_search(n).is_err());
    let (low, high) = range(&kept.map(|n| values[n]).collect::<Vec<_>>());
    let runs = runs(lost);
    for (n, run) in runs.iter().enumerate() {
        let from = n.checked_sub(1).map_or(0, |n| runs[n].end);
        let until = runs.get(n + 1).map_or(values.len(), |next| next.start);
        fill(&mut values, run);
        let length = (run.len() + 1) as f64;
        let turn = Turn::between(&values[from..run.start], &values[run.end..until], length);
        let Some(turn) = turn.filter(|_| run.len() >= SHORTEST) else {
            continue;
        };
        let (before, after) = ends(&values, run);
        let [a, b] = turn.rises;
        for (t, value) in (1_u32..).map(f64::from).zip(&mut values[run.clone()]) {
            let line = match t < turn.at {
                true => before + a * t,
                false => after - b * (length - t),
            };
            *value = line.clamp(low, high);
        }
    }
    values
}

/// The output, with other values in place of `lost` samples, which ascend.
pub(super) fn output(recording: &Recording, lost: &[usize]) -> Vec<f64> {
    let mut values = recording.output.clone();
    let runs = runs(lost);
    match from_kept(recording, &|n| lost.binary_search(&n).is_err()) {
        Some(model) => {
            // What the model leaves changes slowly.
            let mut left: Vec<f64> = values.iter().zip(&model).map(|(y, h)| y - h).collect();
            for run in &runs {
                fill(&mut left, run);
            }
            for n in lost {
                values[*n] = model[*n] + left[*n];
            }
        }
        None => runs.iter().for_each(|run| fill(&mut values, run)),
    }
    values
}

/// The samples that follow each other.
fn runs(samples: &[usize]) -> Vec<Range<usize>> {
    let runs = samples.chunk_by(|a, b| a + 1 == *b);
    runs.map(|run| run[0]..run[0] + run.len()).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::prepare::test_series::two_rates;

    /// Plays and their input go along lines between turning points: what was lost comes back.
    #[test]
    fn what_was_lost_comes_back() {
        let clean = two_rates(0.25);
        // Within a branch, and over the first turning point, at 120.
        for run in [40..55, 110..126] {
            let lost: Vec<usize> = run.clone().collect();
            let mut read = clean.clone();
            read.input[run.clone()].fill(0.0);
            for (filled, truth) in input(&read, &lost).iter().zip(&clean.input) {
                assert!((filled - truth).abs() < 1e-9, "{run:?}: {filled} {truth}");
            }
            let mut read = clean.clone();
            read.output[run.clone()].fill(-300.0);
            // The model of 20 levels errs by less than half a level, of three degrees.
            for (filled, truth) in output(&read, &lost).iter().zip(&clean.output) {
                assert!((filled - truth).abs() < 1.0, "{run:?}: {filled} {truth}");
            }
        }
    }
}
