//! What a session changes, from a recording of one loop at most: offset, gain and shift.
//!
//! The learners trust what has foretold strokes to come, and one loop has none. But between two
//! sessions a model keeps its shape: so a few numbers say more of the next stroke than weights do,
//! which one loop cannot determine.

use super::basis::along_diagonal;
use super::begun::{Begun, run_from};
use super::window::TURN;
use crate::error::Result;
use crate::model::{FitSummary, Model, Operators, Plane, Start};
use crate::recording::Recording;
use crate::series::{Line, branch_spans, range};
use hysteron_core::Outcome;

/// A loop is so many ranges of the input long, there and back; the rest is how it was entered and
/// left.
const LOOP: f64 = 2.5;

/// Shifts up to this share of the plane are tried, by a quarter of a level or so that there are at
/// most so many in each direction: each costs a run.
const MOST: f64 = 0.15;
const STEP: f64 = 0.25;
const SHIFTS: f64 = 30.0;

/// The readings of one loop are worth so many independent ones at most: a model's error is the same
/// for neighbours. Fewer than [`LEAST`] say too little of three numbers.
const READINGS: f64 = 60.0;
const LEAST: usize = 20;

/// One rejected reading in so many is a spike.
pub(super) const SELDOM: usize = 20;

/// A recording of less than this share of the model's range says too little of the rest.
const COVERED: f64 = 0.8;

/// A shift moves both branches. From one alone it cannot be told from other hysteresis: the input
/// has to go through so large a share of its range in both directions.
const BOTH: f64 = 0.5;

/// Another session is believed where it leaves at most this share of the errors of the model left
/// alone, and of a constant; and less than a line in the input, which fits one stroke of anything.
/// Shape alone, which no other offset mends, leaves more.
const CLEAR: f64 = 0.5;

/// The model of another session and its outputs, if the recordings are of one loop at most, and if it
/// errs less than `kept`, the outputs of what all learners together made, and far less than the model
/// left alone. `outcomes` are those of the samples that may be learned from, `joined` the recordings
/// one after the other.
///
/// # Errors
/// As [`Model::run_in`].
pub(super) fn session(
    begun: &Begun,
    (kept, outcomes): (&[f64], &[Outcome]),
    (recordings, joined): (&[Recording], &Recording),
) -> Result<Option<(Model, Vec<f64>)>> {
    let measured = &joined.output[..];
    let Some((sure, most)) = one_loop(begun.model.plane(), outcomes, recordings) else {
        return Ok(None);
    };
    let squares = |outputs: &dyn Fn(usize) -> f64| -> f64 {
        let squares = sure.iter().map(|n| (measured[*n] - outputs(*n)).powi(2));
        squares.sum()
    };
    let line = Line::through(sure.iter().map(|n| (joined.input[*n], measured[*n])));
    let [alone, kept, constant, line] = [
        squares(&|n| begun.output[n]),
        squares(&|n| kept[n]),
        squares(&|_| line.centre.1),
        squares(&|n| line.at(joined.input[n])),
    ];
    let enough = (CLEAR.powi(2) * alone.min(constant)).min(kept).min(line);
    let levels = begun.model.plane().levels() as f64;
    let step = STEP.max(most * levels / SHIFTS);
    let steps = (most * levels / step) as i32;
    let mut best: Option<(f64, Model)> = None;
    for step in (-steps..=steps).map(|n| f64::from(n) * step) {
        let found = shifted(begun, recordings, (measured, &sure), step)?;
        if let Some((doubt, model)) = found
            && best.as_ref().is_none_or(|(least, _)| doubt < *least)
        {
            best = Some((doubt, model));
        }
    }
    let Some((_, model)) = best else {
        return Ok(None);
    };
    let outputs = run_from(&model, Start::Fitted, recordings)?;
    let better = squares(&|n| outputs[n]) < enough;
    Ok(better.then_some((model, outputs)))
}

/// Of recordings of one loop at most: the samples that are sure, and the largest shift to try, as a
/// share of the plane. `None` for others, and where readings were rejected more than seldom.
fn one_loop(
    plane: &Plane,
    outcomes: &[Outcome],
    recordings: &[Recording],
) -> Option<(Vec<usize>, f64)> {
    let count = outcomes.len();
    let sure = |n: &usize| outcomes[*n] != Outcome::Rejected;
    let sure: Vec<usize> = (0..count).filter(sure).collect();
    if sure.len() < LEAST || (count - sure.len()) * SELDOM > count {
        return None;
    }
    // Beyond the plane the operators see its end.
    let inside = |x: &f64| x.clamp(plane.min(), plane.max());
    let inputs = recordings.iter().map(|recording| {
        let inside = recording.input.iter().map(inside);
        inside.collect::<Vec<f64>>()
    });
    let inputs: Vec<Vec<f64>> = inputs.collect();
    let (low, high) = range(&inputs.concat());
    let [up, down] = ways(&inputs, TURN * (plane.max() - plane.min()));
    let width = high - low;
    if up + down > LOOP * width || width < COVERED * (plane.max() - plane.min()) {
        return None;
    }
    let most = if up.min(down) < BOTH * width {
        0.0
    } else {
        MOST
    };
    Some((sure, most))
}

/// How far the input goes up, and down, from turn to turn.
fn ways(inputs: &[Vec<f64>], tolerance: f64) -> [f64; 2] {
    let (mut up, mut down) = (0.0, 0.0);
    for input in inputs {
        for stroke in branch_spans(input, tolerance) {
            // A stroke begins at the turn, the last sample of the one before.
            let way = input[stroke.end - 1] - input[stroke.start.saturating_sub(1)];
            up += way.max(0.0);
            down -= way.min(0.0);
        }
    }
    [up, down]
}

/// The model moved by so many levels, with the offset and gain that suit the sure samples best, and
/// twice the negative logarithm of its posterior, for noise of unknown size. `None` where its output
/// stands still there, or where numbers overflow.
fn shifted(
    begun: &Begun,
    recordings: &[Recording],
    (measured, sure): (&[f64], &[usize]),
    levels: f64,
) -> Result<Option<(f64, Model)>> {
    let model = &begun.model;
    let weights = along_diagonal_by(model, levels);
    let with = |gain: f64, offset: f64| -> Result<Model> {
        let weights = weights.iter().map(|mu| gain * mu).collect();
        let (operator, plane, sign) = (model.operator(), *model.plane(), model.sign());
        let operators = Operators::new(operator, plane, weights, offset, sign)?;
        model.starts(model.around(operators), begun.start)
    };
    let outputs = run_from(&with(1.0, model.offset())?, Start::Fitted, recordings)?;
    let pairs = sure
        .iter()
        .map(|n| (outputs[*n] - model.offset(), measured[*n]));
    let line = Line::through(pairs.clone());
    let squares = |gain: f64| -> f64 {
        let errors = pairs.clone().map(|(h, y)| y - line.inclined(gain, h));
        errors.map(|error| error.powi(2)).sum()
    };
    let readings = READINGS.min(sure.len() as f64);
    // The prior of the gain weighs as much as so many readings with the error that is left.
    let known = model.fit.as_ref().and_then(FitSummary::change);
    let change = known.unwrap_or_default();
    let prior = squares(line.slope()) / (readings * change.gain.powi(2));
    let gain = (line.common + prior) / (line.spread + prior);
    if !(line.spread > 0.0 && gain.is_finite() && gain > 0.0) {
        return Ok(None);
    }
    let share = levels / model.plane().levels() as f64;
    let doubt = readings * squares(gain).max(f64::MIN_POSITIVE).ln()
        + (share / change.shift).powi(2)
        + ((gain - 1.0) / change.gain).powi(2);
    let found = with(gain, line.inclined(gain, 0.0)).ok();
    Ok(found.map(|model| (doubt, model)))
}

/// The weights moved along the diagonal by a number of levels: a mean of those moved by the whole
/// numbers below and above.
fn along_diagonal_by(model: &Model, levels: f64) -> Vec<f64> {
    let (whole, part) = (levels.floor() as isize, levels - levels.floor());
    let mut moved = along_diagonal(model, whole);
    if part > 0.0 {
        let above = along_diagonal(model, whole + 1);
        for (weight, above) in moved.iter_mut().zip(above) {
            *weight += part * (above - *weight);
        }
    }
    moved
}
