//! Simple rivals on the same branches left out. Where one of them wins, the model has learned
//! little.

use crate::error::Result;
use crate::identify::weights::experiment::Experiment;
use crate::model::RivalScore;
use crate::recording::Recording;
use crate::rivals::{Rival, RivalKind};
use crate::series::range;

/// The errors of simple rivals on samples that their `folds` left out.
///
/// Where only parts of branches are left out, both neighbours of a gap are known, and interpolation
/// would be asked nothing. Then the straight line is the only rival.
pub(super) fn left_out(
    experiment: &Experiment,
    folds: &[Option<usize>],
    whole_branches: bool,
) -> Result<Vec<RivalScore>> {
    // A load that changes moves the output by itself, so these rivals say nothing then.
    if experiment.load_range.is_some() {
        return Ok(Vec::new());
    }
    let kinds: &[RivalKind] = match whole_branches {
        true => &[RivalKind::Line, RivalKind::Interpolation],
        false => &[RivalKind::Line],
    };
    let count = folds.iter().flatten().max().map_or(0, |fold| fold + 1);
    let (low, high) = range(&experiment.output);
    let mut scores = Vec::new();
    for &kind in kinds {
        let (mut squares, mut samples) = (0.0, 0);
        for fold in 0..count {
            let Ok(rival) = Rival::fit(kind, &pieces(experiment, folds, fold)?) else {
                continue;
            };
            for range in &experiment.recordings {
                let whole = piece(experiment, range.clone())?;
                let predicted = rival.predict(&whole)?;
                for (n, predicted) in range.clone().zip(predicted) {
                    if folds[n] == Some(fold) {
                        squares += (experiment.output[n] - predicted).powi(2);
                        samples += 1;
                    }
                }
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

/// The runs of samples that a fold keeps.
fn pieces(experiment: &Experiment, folds: &[Option<usize>], fold: usize) -> Result<Vec<Recording>> {
    let mut pieces = Vec::new();
    for recording in &experiment.recordings {
        let mut start = recording.start;
        for n in recording.clone().chain([recording.end]) {
            let kept = n < recording.end && folds[n].is_some_and(|other| other != fold);
            if !kept {
                // A single sample has no direction.
                if n > start + 1 {
                    pieces.push(piece(experiment, start..n)?);
                }
                start = n + 1;
            }
        }
    }
    Ok(pieces)
}

fn piece(experiment: &Experiment, range: std::ops::Range<usize>) -> Result<Recording> {
    let [input, output] =
        [&experiment.input, &experiment.output].map(|all| all[range.clone()].to_vec());
    Recording::new(input, output)
}
