//! What a session changes, from a recording of one loop at most: offset, gain and shift.
//!
//! The learners trust what has foretold strokes to come, and one loop has none. But between two
//! sessions a model keeps its shape: so a few numbers say more of the next stroke than weights do,
//! which one loop cannot determine.

use super::basis::along_diagonal;
use super::begun::{Begun, run_from};
use super::learned::Learned;
use super::window::TURN;
use crate::error::Result;
use crate::model::{Model, Operators, Start};
use crate::recording::Recording;
use crate::series::{branch_spans, mean_and_deviation, range};
use hysteron_core::Outcome;

/// A loop is so many ranges of the input long, there and back; the rest is how it was entered and
/// left.
const LOOP: f64 = 2.5;

/// Standard deviations between sessions: of the gain, and of the shift as a share of the plane. A
/// constant added to the output may be of any size.
const GAIN: f64 = 0.2;
const SHIFT: f64 = 0.02;

/// Shifts up to this share of the plane are tried, so many to a level.
const MOST: f64 = 0.15;
const STEPS: f64 = 4.0;

/// The readings of one loop are worth so many independent ones, however many they are: a model's
/// error is the same for neighbours.
const READINGS: f64 = 60.0;

/// A recording of less than this share of the model's range says too little of the rest.
const COVERED: f64 = 0.5;

/// A shift moves both branches. From one alone it cannot be told from other hysteresis: the input
/// has to go through so large a share of its range in both directions.
const BOTH: f64 = 0.5;

/// Another session is believed where it leaves at most this share of the errors of the model left
/// alone, and of a constant. Shape alone, which no other offset mends, leaves more.
const CLEAR: f64 = 0.5;

/// A model of another session.
struct Session {
    model: Model,
    /// Its squared error over the samples that are sure.
    squares: f64,
}

/// Takes the model of another session, if the recordings are of one loop at most, and if it errs
/// less than what all learners together made, and far less than the model left alone and than a
/// constant. `measured` are the outputs of the recordings one after the other.
///
/// # Errors
/// As [`Model::run_in`].
pub(super) fn session(
    learned: &mut Learned,
    recordings: &[Recording],
    measured: &[f64],
) -> Result<()> {
    let plane = *learned.begun.model.plane();
    let inputs = || recordings.iter().map(|recording| &recording.input[..]);
    let seen = inputs().map(range).fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(low, high), (least, most)| (low.min(least), high.max(most)),
    );
    let width = seen.1 - seen.0;
    let [up, down] = ways(recordings, TURN * (plane.max() - plane.min()));
    if up + down > LOOP * width || learned.covered < COVERED {
        return Ok(());
    }
    let count = measured.len() - learned.probation.max(learned.still);
    let sure = |n: &usize| {
        learned.learned[*n].outcome != Outcome::Rejected
            && !learned.held.iter().any(|held| held.contains(n))
    };
    let sure: Vec<usize> = (0..count).filter(sure).collect();
    let squares = |outputs: &dyn Fn(usize) -> f64| -> f64 {
        sure.iter()
            .map(|n| (measured[*n] - outputs(*n)).powi(2))
            .sum()
    };
    let sure_outputs: Vec<f64> = sure.iter().map(|n| measured[*n]).collect();
    let (mean, _) = mean_and_deviation(&sure_outputs);
    let (alone, constant) = (squares(&|n| learned.begun.output[n]), squares(&|_| mean));
    let enough = (CLEAR.powi(2) * alone.min(constant)).min(squares(&|n| learned.again[n]));
    let most = match up.min(down) < BOTH * width {
        true => 0,
        false => (MOST * STEPS * plane.levels() as f64) as i32,
    };
    let mut best: Option<(f64, Session)> = None;
    for step in -most..=most {
        let levels = f64::from(step) / STEPS;
        let Some(found) = shifted(&learned.begun, recordings, (measured, &sure), levels)? else {
            continue;
        };
        let share = levels / plane.levels() as f64;
        // Twice the negative logarithm of the posterior, with noise of unknown size.
        let doubt = READINGS * found.squares.max(f64::MIN_POSITIVE).ln() + (share / SHIFT).powi(2);
        if best.as_ref().is_none_or(|(least, _)| doubt < *least) {
            best = Some((doubt, found));
        }
    }
    let Some((_, found)) = best.filter(|(_, session)| session.squares < enough) else {
        return Ok(());
    };
    learned.again = run_from(&found.model, Start::Fitted, recordings)?;
    learned.last = found.model;
    learned.shares = vec![("session", 1.0)];
    Ok(())
}

/// How far the input goes up, and down, from turn to turn.
fn ways(recordings: &[Recording], tolerance: f64) -> [f64; 2] {
    let (mut up, mut down) = (0.0, 0.0);
    for Recording { input, .. } in recordings {
        for stroke in branch_spans(input, tolerance) {
            let way = input[stroke.end - 1] - input[stroke.start];
            up += way.max(0.0);
            down -= way.min(0.0);
        }
    }
    [up, down]
}

/// The model moved by so many levels, with the offset and gain that suit the sure samples best.
/// `None` where its output stands still there, or where numbers overflow.
fn shifted(
    begun: &Begun,
    recordings: &[Recording],
    (measured, sure): (&[f64], &[usize]),
    levels: f64,
) -> Result<Option<Session>> {
    let model = &begun.model;
    let weights = along_diagonal_by(model, levels);
    let with = |gain: f64, offset: f64| -> Result<Model> {
        let weights = weights.iter().map(|mu| gain * mu).collect();
        let (operator, plane, sign) = (model.operator(), *model.plane(), model.sign());
        let operators = Operators::new(operator, plane, weights, offset, sign)?;
        model.starts(model.around(operators), begun.start)
    };
    let outputs = run_from(&with(1.0, model.offset())?, Start::Fitted, recordings)?;
    let pair = |n: &usize| (outputs[*n] - model.offset(), measured[*n]);
    let pairs: Vec<(f64, f64)> = sure.iter().map(pair).collect();
    let count = pairs.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (h_mean, y_mean) = (mean(&|pair| pair.0), mean(&|pair| pair.1));
    let spread = mean(&|(h, _)| (h - h_mean).powi(2));
    let common = mean(&|(h, y)| (h - h_mean) * (y - y_mean));
    let error = |gain: f64| mean(&|(h, y)| (y - y_mean - gain * (h - h_mean)).powi(2));
    let free = common / spread;
    // The prior of the gain weighs as much as so many readings with the error that is left.
    let prior = error(free) / (READINGS * GAIN.powi(2));
    let gain = (common + prior) / (spread + prior);
    if !(spread > 0.0 && gain.is_finite() && gain > 0.0) {
        return Ok(None);
    }
    let Ok(model) = with(gain, y_mean - gain * h_mean) else {
        return Ok(None);
    };
    Ok(Some(Session {
        model,
        squares: count * error(gain),
    }))
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
