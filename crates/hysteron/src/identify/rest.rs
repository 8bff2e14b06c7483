//! The rest before a recording: all operators off, then one input or two, then the first sample.
//!
//! One number tells a lot: at the lowest input the operators stay off, and at the highest they are
//! all on. A second number is taken only where it explains clearly more.

use crate::error::Result;
use crate::identify::history::{beginning, squares};
use crate::identify::initial::Initial;
use crate::model::{Model, State, Surroundings};
use crate::recording::{Quantity, Recording};
use crate::series::range;
use std::borrow::Cow;

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

/// A body was at rest with another drive before a recording if the squared error at its beginning
/// is at most this part of that without it.
const CLEAR: f64 = 0.5;

/// Fewer samples tell nothing of one number.
const FEWEST: usize = 8;

/// So many time constants are the beginning of a recording behind a body. After them, 5 % are left
/// of where it began.
const BEGINNING: f64 = 3.0;

/// The recording with the drive at which the body of `model` was at rest before it, where the first
/// drive clearly was not it: the wire was warm, or the drive began with the recording.
///
/// # Errors
/// As [`Model::run_in`].
pub(crate) fn with_rest<'r>(model: &Model, recording: &'r Recording) -> Result<Cow<'r, Recording>> {
    let found = match recording.rest {
        Some(_) => None,
        None => rest_before(model, recording)?,
    };
    Ok(match found {
        None => Cow::Borrowed(recording),
        rest => Cow::Owned(Recording {
            rest,
            ..recording.clone()
        }),
    })
}

/// As [`with_rest`], of all recordings.
pub(crate) fn with_rests<'r>(
    model: &Model,
    recordings: &'r [Recording],
) -> Result<Cow<'r, [Recording]>> {
    if model.thermal.is_none() {
        return Ok(Cow::Borrowed(recordings));
    }
    let each = recordings.iter();
    let each = each.map(|recording| Ok(with_rest(model, recording)?.into_owned()));
    Ok(Cow::Owned(each.collect::<Result<_>>()?))
}

/// What is said of the drives at which a body was at rest; `None` where each was the first one.
#[must_use]
pub fn rested_words(rests: &[Option<f64>], input: &Quantity) -> Option<String> {
    let found = rests.iter().enumerate();
    let found = found.filter_map(|(n, rest)| Some((n, input.text((*rest)?))));
    let found: Vec<String> = match rests {
        [_] => found.map(|(_, rest)| rest).collect(),
        _ => found
            .map(|(n, rest)| format!("{rest} before recording {}", n + 1))
            .collect(),
    };
    (!found.is_empty()).then(|| {
        let found = found.join(", ");
        format!(
            "the body did not begin at rest with its first drive: it was at rest with {found}, \
             found from the beginning; to simulate, give this rest"
        )
    })
}

/// The drive of [`with_rest`]; `None` for the first one, and for a model without a body.
fn rest_before(model: &Model, recording: &Recording) -> Result<Option<f64>> {
    let (Some(body), Some(time)) = (model.thermal, &recording.time) else {
        return Ok(None);
    };
    let end = time[0] + BEGINNING * body.tau_heating.max(body.tau_cooling);
    let samples = time.partition_point(|t| *t <= end);
    if samples < FEWEST {
        return Ok(None);
    }
    let mut head = recording.part(0..samples);
    let mut error = |rest| {
        head.rest = rest;
        squares(model, model.start(), &head)
    };
    let none = error(None)?;
    let (low, high) = drives(model.drive_range(), &recording.input);
    let step = (high - low) / CANDIDATES as f64;
    let mut error = |x| error(Some(x));
    let mut best = (low, f64::INFINITY);
    for n in 0..=CANDIDATES {
        best = lesser(best, low + step * n as f64, &mut error)?;
    }
    let (x, least) = refined(best, step, (low, high), error)?;
    Ok((least < CLEAR * none).then_some(x))
}

/// The drives that a body may have been at rest with: none at all is among them.
fn drives((low, high): (f64, f64), input: &[f64]) -> (f64, f64) {
    let (least, most) = range(input);
    (low.min(least).min(0.0), high.max(most).max(0.0))
}

type Rated = (f64, f64);

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
