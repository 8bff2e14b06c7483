//! Simple rivals on the same branches left out. Where one of them wins, the model has learned
//! little.

use crate::error::Result;
use crate::identify::weights::units::Folds;
use crate::model::RivalScore;
use crate::recording::Recording;
use crate::rivals::{Measured, Predictor, RivalKind};
use crate::series::{Runs, fair_range_of_all};
use std::ops::Range;

/// The errors of simple rivals on samples that their `folds` left out.
///
/// Where only parts of branches are left out, both neighbours of a gap are known, and interpolation
/// would be asked nothing. Then the straight line is the only rival.
pub(super) fn left_out(recordings: &[Recording], folds: &Folds) -> Result<Vec<RivalScore>> {
    // A load that changes moves the output by itself, so these rivals say nothing then.
    if recordings.iter().any(|recording| recording.load.is_some()) {
        return Ok(Vec::new());
    }
    let kinds: &[RivalKind] = match folds.units.whole_branches {
        true => &[RivalKind::Line, RivalKind::Interpolation],
        false => &[RivalKind::Line],
    };
    let (low, high) = fair_range_of_all(recordings.iter().map(|recording| &recording.output));
    let mut scores = Vec::new();
    for &kind in kinds {
        let (mut squares, mut samples) = (0.0, 0);
        for fold in 0..folds.count {
            let pieces = pieces(recordings, folds, fold);
            if pieces.is_empty() {
                continue;
            }
            let Ok(rival) = Predictor::fit(kind, &pieces) else {
                continue;
            };
            for (recording, first) in with_first(recordings) {
                let is_left_out = |n: usize| folds.fold(first + n) == Some(fold);
                rival.each(&recording.input, is_left_out, |n, predicted| {
                    squares += (recording.output[n] - predicted).powi(2);
                    samples += 1;
                })?;
            }
        }
        if samples > 0 {
            scores.push(RivalScore {
                name: kind.name().to_owned(),
                nrmse_percent: 100.0 * (squares / f64::from(samples)).sqrt() / (high - low),
            });
        }
    }
    Ok(scores)
}

/// Each recording with the number of its first sample among those of all.
fn with_first(recordings: &[Recording]) -> impl Iterator<Item = (&Recording, usize)> {
    recordings.iter().scan(0, |next, recording| {
        let first = *next;
        *next += recording.len();
        Some((recording, first))
    })
}

/// The runs of samples that a fold keeps.
fn pieces<'a>(recordings: &'a [Recording], folds: &Folds, fold: usize) -> Vec<Measured<'a>> {
    let mut pieces = Vec::new();
    for (recording, first) in with_first(recordings) {
        let is_kept = |n: usize| folds.fold(first + n).is_some_and(|of| of != fold);
        let runs: Runs<bool> = (0..recording.len()).map(is_kept).collect();
        // A single sample has no direction.
        let long = |(samples, kept): &(Range<usize>, bool)| *kept && samples.len() > 1;
        pieces.extend(runs.iter().filter(long).map(|(samples, _)| Measured {
            input: &recording.input[samples.clone()],
            output: &recording.output[samples],
        }));
    }
    pieces
}
