//! The rest before a recording: all operators off, then one input or two, then the first sample.
//!
//! One number tells a lot: at the lowest input the operators stay off, and at the highest they are
//! all on. A second number is taken only where it explains clearly more.

use crate::error::Result;
use crate::identify::history::{beginning, squares};
use crate::identify::initial::Initial;
use crate::model::{Model, State, Surroundings};
use crate::recording::Recording;
use crate::series::range;

/// Candidates for an input, evenly over the range.
const CANDIDATES: usize = 12;

/// Refinements, each with half the step of the one before.
const REFINED: usize = 5;

/// A second number has to reduce the squared error by this share.
const WORTH: f64 = 0.05;

/// The rest with the least `error`, and that error. Candidates are inputs in `range`: the same
/// input twice, or the highest and then a lower one; at last both on their own.
///
/// # Errors
/// Those of `error`.
pub(super) fn search(
    (low, high): (f64, f64),
    mut error: impl FnMut([f64; 2]) -> Result<f64>,
) -> Result<([f64; 2], f64)> {
    let step = (high - low) / CANDIDATES as f64;
    let once = |x: f64| [x, x];
    let from_top = |x: f64| [high, x];
    let shapes = [&once as &dyn Fn(f64) -> [f64; 2], &from_top];
    let mut found = [(low, f64::INFINITY); 2];
    for (best, shape) in found.iter_mut().zip(shapes) {
        for n in 0..=CANDIDATES {
            *best = lesser(*best, low + step * n as f64, |x| error(shape(x)))?;
        }
    }
    let better = usize::from(found[1].1 < found[0].1);
    let shape = shapes[better];
    let (x, least) = refined(found[better], step, (low, high), |x| error(shape(x)))?;
    let single = (shape(x), least);
    // Each number in turn.
    let [a, b] = single.0;
    let lower = refined((b, least), step, (low, high), |x| error([a, x]))?;
    let upper = refined((a, lower.1), step, (low, high), |x| error([x, lower.0]))?;
    let both = ([upper.0, lower.0], upper.1);
    Ok(match both.1 < (1.0 - WORTH) * least {
        true => both,
        false => single,
    })
}

/// The rest near `from` with the least `error`, which is a finer one than that of the search.
///
/// # Errors
/// Those of `error`.
pub(super) fn polished(
    from: [f64; 2],
    (low, high): (f64, f64),
    mut error: impl FnMut([f64; 2]) -> Result<f64>,
) -> Result<[f64; 2]> {
    let [first, second] = from;
    let shape = |x: f64| [if first == second { x } else { first }, x];
    let step = (high - low) / CANDIDATES as f64;
    let start = (second, error(from)?);
    let (x, _) = refined(start, step, (low, high), |x| error(shape(x)))?;
    Ok(shape(x))
}

/// A number and its error.
type Rated = (f64, f64);

/// The number in a range with the least `error`, and that error.
///
/// # Errors
/// Those of `error`.
pub(super) fn least(
    (low, high): (f64, f64),
    mut error: impl FnMut(f64) -> Result<f64>,
) -> Result<Rated> {
    let step = (high - low) / CANDIDATES as f64;
    let mut best = (low, f64::INFINITY);
    for n in 0..=CANDIDATES {
        best = lesser(best, low + step * n as f64, &mut error)?;
    }
    refined(best, step, (low, high), error)
}

fn lesser(best: Rated, x: f64, mut error: impl FnMut(f64) -> Result<f64>) -> Result<Rated> {
    let other = error(x)?;
    Ok(if other < best.1 { (x, other) } else { best })
}

/// Moves to neighbours at half the step, again and again.
fn refined(
    mut best: Rated,
    mut step: f64,
    (low, high): (f64, f64),
    mut error: impl FnMut(f64) -> Result<f64>,
) -> Result<Rated> {
    for _ in 0..REFINED {
        step *= 0.5;
        let at = best.0;
        for x in [at - step, at + step] {
            best = lesser(best, x.clamp(low, high), &mut error)?;
        }
    }
    Ok(best)
}

/// The state of a model's operators after a rest, given as they see it.
pub(super) fn after(model: &Model, rest: [f64; 2]) -> Result<State> {
    let state = Initial::After(rest).state(&model.operators().core)?;
    let turning_points: Vec<f64> = state.turning_points().collect();
    model.restore(&turning_points, state.input())
}

/// The state after the rest that explains the beginning of a recording best, and the number of
/// samples that count as its beginning, as in [`find_start`](super::history::find_start).
///
/// # Errors
/// As [`Model::run_in`].
pub(crate) fn find_rest(model: &Model, recording: &Recording) -> Result<(State, usize)> {
    let seen = model.seen(
        &recording.input,
        Surroundings::from_recording(model, recording),
    )?;
    let samples = beginning(&seen);
    let head = recording.part(0..samples);
    let error = |rest| squares(model, after(model, rest)?, &head);
    // Before a small loop the input may have rested anywhere on the plane.
    let (low, high) = range(&seen);
    let plane = model.plane();
    let (rest, _) = search((low.min(plane.min()), high.max(plane.max())), error)?;
    Ok((after(model, rest)?, samples))
}
