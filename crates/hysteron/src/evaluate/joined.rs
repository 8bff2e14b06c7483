//! One evaluation of one recording or of several: the entry points.

use super::one::{Evaluation, InverseEvaluation, InverseRun, keeping};
use crate::error::Result;
use crate::model::{BandEvaluation, Model, Start};
use crate::recording::{Recording, no_recordings};
use crate::series::{Errors, fair_range_of_all};

/// Runs `model` forward over the measured input, and its inverse over the measured output. Both
/// start where the model does ([`Model::start`]), and use time and load of the recording as far as
/// the model needs them. Several recordings are parts of one experiment, such as the segments of a
/// file: the model starts anew in each.
///
/// For a model with a thermal body, the inverse is tested behind the body: its result is compared
/// with the temperature, because a drive that follows noise says nothing.
///
/// ```
/// use hysteron::{Model, Operator, Plane, Recording, Sign, evaluate};
/// let plane = Plane::new(20.0, 80.0, 3)?;
/// let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
/// let input = vec![20.0, 80.0, 50.0];
/// let recording = Recording::new(input.clone(), model.simulate(&input)?)?;
/// let segments = [recording.clone(), recording];
/// assert_eq!(evaluate(&model, &segments)?.forward.max_abs, 0.0);
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::Recording`] for an invalid recording, or none; as [`Model::run_in`].
pub fn evaluate(
    model: &Model,
    recordings: &(impl AsRef<[Recording]> + ?Sized),
) -> Result<Evaluation> {
    evaluate_from(model, recordings, Start::Fitted)
}

/// As [`evaluate`], from another start. With [`Start::Unknown`], the start is the one that explains
/// the beginning of the recording best; [`Evaluation::estimated_from`] tells its length.
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_from(
    model: &Model,
    recordings: &(impl AsRef<[Recording]> + ?Sized),
    start: Start,
) -> Result<Evaluation> {
    all(model, recordings.as_ref(), start, |series| series)
}

/// As [`evaluate_from`], for the errors alone: no series of the model is kept, so that a long
/// recording takes less memory.
///
/// ```
/// use hysteron::{Model, Operator, Plane, Recording, Sign, Start, evaluate_errors, evaluate_from};
/// let plane = Plane::new(20.0, 80.0, 3)?;
/// let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
/// let recording = Recording::new(vec![20.0, 60.0, 30.0], vec![0.0, 3.5, 2.0])?;
/// let errors = evaluate_errors(&model, &recording, Start::Fitted)?;
/// assert_eq!(errors.forward, evaluate_from(&model, &recording, Start::Fitted)?.forward);
/// assert!(errors.output_model.is_empty());
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_errors(
    model: &Model,
    recordings: &(impl AsRef<[Recording]> + ?Sized),
    start: Start,
) -> Result<Evaluation> {
    all(model, recordings.as_ref(), start, |_| Vec::new())
}

fn all(
    model: &Model,
    recordings: &[Recording],
    start: Start,
    keep: fn(Vec<f64>) -> Vec<f64>,
) -> Result<Evaluation> {
    let each = recordings.iter();
    let parts = each.map(|recording| keeping(model, recording, start, keep));
    joined(parts.collect::<Result<_>>()?, recordings)
}

/// The evaluation over all of `recordings`, from one of each.
fn joined(parts: Vec<Evaluation>, recordings: &[Recording]) -> Result<Evaluation> {
    let parts = match <[Evaluation; 1]>::try_from(parts) {
        Ok([one]) => return Ok(one),
        Err(parts) => parts,
    };
    let mut evaluation = Evaluation {
        output_model: Vec::new(),
        forward: over_all(parts.iter().map(|part| part.forward), recordings)?,
        clipped: parts.iter().map(|part| part.clipped).sum(),
        estimated_from: parts.iter().map(|part| part.estimated_from).sum(),
        rests: parts.iter().flat_map(|part| part.rests.clone()).collect(),
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
        let input = fair_range_of_all(recordings.iter().map(|recording| &recording.input));
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
    let output = fair_range_of_all(recordings.iter().map(|recording| &recording.output));
    Errors::joined(parts, output).ok_or_else(no_recordings)
}

fn band(parts: &[Evaluation]) -> Option<BandEvaluation> {
    let sessions = parts.first()?.band.as_ref()?.sessions;
    let (mut half_width, mut inside, mut samples) = (Vec::new(), 0.0, 0);
    for part in parts {
        let band = part.band.as_ref()?;
        half_width.extend(&band.half_width);
        inside += band.coverage_percent * part.forward.samples as f64;
        samples += part.forward.samples;
    }
    Some(BandEvaluation {
        half_width,
        sessions,
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
