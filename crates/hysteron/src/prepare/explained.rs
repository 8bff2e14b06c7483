//! Why rows disagree with the others.

use super::judge::{apart, from_kept, mean};
use super::misread::Reading;
use super::suspects::{BLOCKS, SUSPECT};
use crate::recording::Recording;
use crate::series::frozen::rise_and_fall;
use crate::series::noise::median_of;
use crate::series::spread::{mean_and_deviation, range, usual_span};
use std::ops::Range;

/// A change of unit explains rows if they then err at most so many times as much as the others, and
/// by at most this share of what they did before.
const EXPLAINED: f64 = 1.0;
const LEFT: f64 = 0.1;
/// There they move by at least this share of the usual range.
const MOVES: f64 = 0.3;
/// Where they turn, by at least this share back.
const TURNS: f64 = 0.1;
/// Where the model errs little, a smaller move is clear: so many times its error, and at least this
/// share of the usual range. The first number is for the way there, the second for the way back.
const TIMES: [f64; 2] = [10.0, 4.0];
const CLEARLY: [f64; 2] = [0.05, 0.02];
/// A model of all rows follows a frozen channel a part of the way, so it needs to move by this share
/// of that alone. None of the faults that are tried (`measured/faults.md`) is passed over by it.
const SEEN: f64 = 0.5;
/// There a channel stands still if it moves by at most this share of its usual range.
const STILL: f64 = 0.02;

/// Whether it is known why rows disagree: a channel stands still, or they agree with the others,
/// nearly as well as these with each other, once their outputs are moved and stretched, or their
/// columns exchanged. The first and the last block of the rows may have others among them.
pub(super) fn explained(recording: &Recording, rows: &Range<usize>, without: f64) -> bool {
    let block = recording.len().div_ceil(BLOCKS);
    let inner = match rows.len() > 3 * block {
        true => rows.start + block..rows.end - block,
        false => rows.clone(),
    };
    let others = |recording: &Recording| from_kept(recording, &|n| !rows.contains(&n));
    let model = others(recording);
    if is_frozen(recording, model.as_deref(), &inner, without) {
        return true;
    }
    let output = &recording.output;
    let kept: Vec<f64> = (0..recording.len())
        .filter(|n| !rows.contains(n))
        .map(|n| output[n])
        .collect();
    let of_others = usual_span(&kept).min(usual_span(output));
    let off = |recording: &Recording, model: &[f64], affine: bool| -> Option<f64> {
        let (read, model) = (&recording.output[inner.clone()], &model[inner.clone()]);
        // Where nothing moves, a line explains anything.
        if usual_span(model) < MOVES * of_others {
            return None;
        }
        let (gain, offset) = if affine {
            line(model, read)?
        } else {
            (1.0, 0.0)
        };
        // In the unit of the others.
        let pairs = read.iter().zip(model);
        Some(median_of(
            pairs
                .map(|(y, h)| ((y - offset) / gain - h).abs())
                .collect(),
        ))
    };
    let exchanged = Reading::Exchanged.of(recording, std::slice::from_ref(rows));
    let as_read = |affine| off(recording, model.as_deref()?, affine);
    let before = as_read(false).unwrap_or(f64::INFINITY);
    let enough = (EXPLAINED * without).min(LEFT * before);
    let of_exchanged = || off(&exchanged, &others(&exchanged)?, false);
    let found = [as_read(true), of_exchanged()];
    found.into_iter().flatten().any(|off| off <= enough)
}

/// Whether rows in which a channel stands still may be far from what a model of the others says,
/// judged by the model of `all` rows, which is there already: it saves a fit for each rest.
pub(super) fn may_stand_still(recording: &Recording, rows: &Range<usize>, all: &[f64]) -> bool {
    is_still_beside(
        recording,
        Some(all),
        rows,
        CLEARLY.map(|share| SEEN * share),
    )
}

/// Whether rows in which a channel stands still are far from what a `model` of the others says,
/// which follows these with the error `without`. With a larger error fewer rows are.
pub(super) fn stands_still(
    recording: &Recording,
    rows: &Range<usize>,
    model: &[f64],
    without: f64,
) -> bool {
    let Some(others) = recording.only(|n: usize| !rows.contains(&n)) else {
        return false;
    };
    let (low, high) = range(&others.input);
    let known = |x: &f64| (low..=high).contains(x);
    let rows = rows.clone();
    let off = mean(apart(&recording.output[rows.clone()], &model[rows.clone()]));
    off >= SUSPECT * without
        && recording.input[rows.clone()].iter().all(known)
        && is_frozen(recording, Some(model), &rows, without)
}

/// Whether one channel stands still in these rows while the other one turns, or while the output of
/// the `model` of the others does. One way alone proves nothing: a wire without a drive cools. The
/// model errs by `without` elsewhere.
fn is_frozen(
    recording: &Recording,
    model: Option<&[f64]>,
    rows: &Range<usize>,
    without: f64,
) -> bool {
    let error = without / usual_span(&recording.output);
    let far = |most: f64, n: usize| (TIMES[n] * error).max(CLEARLY[n]).min(most);
    is_still_beside(recording, model, rows, [far(MOVES, 0), far(TURNS, 1)])
}

/// Whether one channel stands still in these rows while the other one, or the output of the
/// `model`, goes one way and back by these shares of the usual range of the output.
fn is_still_beside(
    recording: &Recording,
    model: Option<&[f64]>,
    rows: &Range<usize>,
    [there, back]: [f64; 2],
) -> bool {
    let (input, output) = (&recording.input, &recording.output);
    let is_still = |values: &[f64]| usual_span(&values[rows.clone()]) <= STILL * usual_span(values);
    let span = usual_span(output);
    let turns = |values: &[f64]| {
        let (rise, fall) = rise_and_fall(&values[rows.clone()]);
        rise.max(fall) >= there * span && rise.min(fall) >= back * span
    };
    is_still(input) && turns(output) || is_still(output) && model.is_some_and(turns)
}

/// The rising line from `x` to `y` with the least squares; `None` if it does not rise.
fn line(x: &[f64], y: &[f64]) -> Option<(f64, f64)> {
    let ((x_mean, _), (y_mean, _)) = (mean_and_deviation(x), mean_and_deviation(y));
    let pairs = || {
        x.iter()
            .map(|x| x - x_mean)
            .zip(y.iter().map(|y| y - y_mean))
    };
    let gain = pairs().map(|(x, y)| x * y).sum::<f64>() / pairs().map(|(x, _)| x * x).sum::<f64>();
    (gain > 0.0 && gain.is_finite()).then_some((gain, y_mean - gain * x_mean))
}
