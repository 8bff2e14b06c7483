//! One evaluation of several recordings.

use super::{Evaluation, InverseEvaluation, InverseRun};
use crate::error::Result;
use crate::model::BandEvaluation;
use crate::recording::{Recording, no_recordings};
use crate::series::{Errors, range_of_all};

/// The evaluation over all of `recordings`, from one of each.
pub(super) fn joined(parts: Vec<Evaluation>, recordings: &[Recording]) -> Result<Evaluation> {
    let parts = match <[Evaluation; 1]>::try_from(parts) {
        Ok([one]) => return Ok(one),
        Err(parts) => parts,
    };
    let mut evaluation = Evaluation {
        output_model: Vec::new(),
        forward: over_all(parts.iter().map(|part| part.forward), recordings)?,
        clipped: parts.iter().map(|part| part.clipped).sum(),
        estimated_from: parts.iter().map(|part| part.estimated_from).sum(),
        was_fitted: parts.iter().all(|part| part.was_fitted),
        seen_for_band: parts.iter().any(|part| part.seen_for_band),
        band: band(&parts),
        inverse: Err(String::new()),
    };
    let mut inverses = Vec::new();
    for part in parts {
        evaluation.output_model.extend(part.output_model);
        match part.inverse {
            Ok(inverse) => inverses.push(inverse),
            Err(reason) => evaluation.inverse = Err(reason),
        }
    }
    if inverses.len() == recordings.len() {
        let input = range_of_all(recordings.iter().map(|recording| &recording.input));
        let (mut moving, mut hold, mut anticipate) = (Vec::new(), Vec::new(), Vec::new());
        for inverse in inverses {
            moving.extend(inverse.moving);
            hold.push(inverse.hold);
            anticipate.push(inverse.anticipate);
        }
        evaluation.inverse = Ok(InverseEvaluation {
            moving,
            hold: run(hold, input)?,
            anticipate: run(anticipate, input)?,
        });
    }
    Ok(evaluation)
}

/// The errors of the output over all of `recordings`, from those of each.
pub(crate) fn over_all(
    parts: impl IntoIterator<Item = Errors>,
    recordings: &[Recording],
) -> Result<Errors> {
    let output = range_of_all(recordings.iter().map(|recording| &recording.output));
    Errors::joined(parts, output).ok_or_else(no_recordings)
}

fn band(parts: &[Evaluation]) -> Option<BandEvaluation> {
    let (mut half_width, mut inside, mut samples) = (Vec::new(), 0.0, 0);
    for part in parts {
        let band = part.band.as_ref()?;
        half_width.extend(&band.half_width);
        inside += band.coverage_percent * part.forward.samples as f64;
        samples += part.forward.samples;
    }
    Some(BandEvaluation {
        half_width,
        coverage_percent: inside / samples as f64,
    })
}

fn run(parts: Vec<InverseRun>, input: (f64, f64)) -> Result<InverseRun> {
    let of = |errors: fn(&InverseRun) -> Option<Errors>| {
        Errors::joined(parts.iter().filter_map(errors), input)
    };
    Ok(InverseRun {
        all: of(|run| Some(run.all)).ok_or_else(no_recordings)?,
        moving: of(|run| run.moving),
        dead_band: of(|run| run.dead_band),
        out_of_reach: parts.iter().map(|run| run.out_of_reach).sum(),
        input_model: parts.into_iter().flat_map(|run| run.input_model).collect(),
    })
}
