//! Finds rows that disagree with the others: in another unit, with columns exchanged, of another
//! sensor. A model that has not seen them errs much less on the rest.
//!
//! `suspects` tells which rows these may be. A model that cannot follow the material also errs in
//! some rows more than in others. So those that a model alone tells disagree only if it is known
//! why (`explained`): a change of their unit, or an exchange of their columns, makes them agree, or
//! a channel stands still.

use super::explained::{explained, may_stand_still, stands_still};
use super::judge::{apart, from_kept, mean, unseen};
use super::misread::may_be_exchanged;
use super::suspects::{
    HALF, Suspect, all_jumps, are_fewer, of_models, of_the_series, with_that_of_the_error,
};
use crate::recording::Recording;
use crate::series::spread::usual_span;
use std::ops::Range;

/// Rows that disagree raise the error on the others by at least this factor,
const FACTOR: f64 = 2.0;
/// and by this one the error on what no model has seen, where the ends of gaps tell less,
const FACTOR_UNSEEN: f64 = 1.4;
/// to at least this share of the usual range of the output.
const LEAST: f64 = 0.01;
/// The first rows may be a virgin curve, which no later ones follow: they count from this share on.
const LEAST_AT_START: f64 = 0.03;
/// Where the readings of the rows themselves are suspect, less is enough.
const LEAST_IF_SUSPECT: f64 = 0.005;
/// Sets of rows without which the others are followed nearly as well, up to this factor, are told
/// from each other by their size: the smallest is named.
const NEARLY: f64 = 1.5;
/// Where nothing but a model tells which rows these are, the others err at most by this share of
/// the range: otherwise the model cannot follow the material.
const FOLLOWED: f64 = 0.02;
/// Rows in the middle that raise the error on the others by this factor need no explanation: no
/// material does that.
const CLEAR: f64 = 20.0;
/// Stretches are tried whose ends divide the rows into so many pieces. Of a stretch with other ends
/// the one inside it leaves at least 0.5 / 0.6 of the error on the others. Their range is seen from
/// so many rows.
const PIECES: usize = 20;
const ALMOST: f64 = 0.8;
const SEEN_OF_RANGE: usize = 400;
/// In a longer recording, rows are taken from which the shape of the loops can be seen.
const ROWS: usize = 10_000;

/// Rows that disagree with the others, and the errors on the others with these, and without them or
/// with them read in another way: mean distances.
pub(super) struct Disagreement {
    pub(super) suspect: Suspect,
    pub(super) with: f64,
    pub(super) without: f64,
}

/// The stretches without which a model errs least on the others, if that is much less.
pub(super) fn disagreement(recording: &Recording) -> Option<Disagreement> {
    let rows = fewer(recording);
    if rows.len() == recording.len() {
        return found(recording);
    }
    let mut found = found(&recording.only(|n| rows.binary_search(&n).is_ok())?)?;
    for own in &mut found.suspect.rows {
        *own = rows[own.start]..rows[own.end - 1] + 1;
    }
    Some(found)
}

/// All rows of a short recording; of a long one, its ends and those with the smallest and the
/// largest input of each of many pieces, so that turning points stay.
fn fewer(recording: &Recording) -> Vec<usize> {
    let len = recording.len();
    if len <= ROWS {
        return (0..len).collect();
    }
    let input = &recording.input;
    let pieces = ROWS / 2;
    let ends = |piece: usize| {
        let rows = || piece * len / pieces..(piece + 1) * len / pieces;
        let least = rows().min_by(|a, b| input[*a].total_cmp(&input[*b]));
        let most = rows().max_by(|a, b| input[*a].total_cmp(&input[*b]));
        [least, most].into_iter().flatten()
    };
    let mut rows: Vec<usize> = (0..pieces).flat_map(ends).collect();
    rows.extend([0, len - 1]);
    rows.sort_unstable();
    rows.dedup();
    rows
}

/// The rows that disagree with the others most clearly.
fn found(recording: &Recording) -> Option<Disagreement> {
    let all = from_kept(recording, &|_| true)?;
    let span = usual_span(&recording.output);
    let jumps = all_jumps(recording);
    // No part of the rows then errs by enough. The usual range of the others may be smaller; that
    // is so where the outputs of many rows are wrong, and then the series jump, or the errors are
    // large.
    let error = mean(apart(&recording.output, &all));
    if jumps.is_empty() && error <= HALF * LEAST_IF_SUSPECT * span {
        return None;
    }
    let compared_with = |suspect| compared(recording, suspect, FACTOR, &all, from_kept);
    let cuts = with_that_of_the_error(&jumps, recording, &all);
    let seen = of_the_series(recording, &jumps, &cuts).into_iter();
    let seen = seen.filter_map(compared_with);
    let may_harm = one_stretch_may_harm(recording, &all, span);
    let concentrated = may_harm.then(|| of_models(recording, &cuts, &all));
    let concentrated = concentrated
        .into_iter()
        .flatten()
        .filter_map(compared_with)
        .filter(|found| found.without <= FOLLOWED * span)
        .filter(|found| {
            let rows = &found.suspect.rows[0];
            let clear = rows.start > 0 && found.with > CLEAR * found.without;
            clear || explained(recording, rows, found.without)
        });
    let found: Vec<Disagreement> = seen.chain(concentrated).collect();
    let least = found
        .iter()
        .map(|one| one.without)
        .fold(f64::INFINITY, f64::min);
    let good = found
        .into_iter()
        .filter(|one| one.without <= NEARLY * least);
    let best = good.min_by_key(|one| one.suspect.rows.iter().map(Range::len).sum::<usize>())?;
    // A model of less data may follow them more closely without having learned more.
    compared(
        recording,
        best.suspect,
        FACTOR_UNSEEN,
        &unseen(recording, &|_| true)?,
        unseen,
    )
}

/// Whether the model of `all` rows errs, outside some stretch of at most half of them, by nearly
/// what [`compared`] asks for. `span` is the usual range of the output.
fn one_stretch_may_harm(recording: &Recording, all: &[f64], span: f64) -> bool {
    let len = recording.len();
    let off = apart(&recording.output, all).scan(0.0, |sum, off| {
        *sum += off;
        Some(*sum)
    });
    let sums: Vec<f64> = [0.0].into_iter().chain(off).collect();
    let bound = |piece: usize| piece * len / PIECES;
    let stretches = (0..=PIECES).flat_map(|from| (from..=PIECES).map(move |to| (from, to)));
    let mut stretches = stretches
        .map(|(from, to)| bound(from)..bound(to))
        .filter(|rows| are_fewer(std::slice::from_ref(rows), len));
    let least = match may_be_exchanged(recording) {
        true => LEAST_IF_SUSPECT,
        false => LEAST,
    };
    let every = len.div_ceil(SEEN_OF_RANGE);
    stretches.any(|rows| {
        let off = (sums[len] - sums[rows.end] + sums[rows.start]) / (len - rows.len()) as f64;
        let of_others = || {
            let others = (0..len).step_by(every).filter(|n| !rows.contains(n));
            usual_span(&others.map(|n| recording.output[n]).collect::<Vec<_>>())
        };
        off > ALMOST * least * span || off > ALMOST * least * of_others()
    })
}

/// What models of the samples that are kept predict.
type Predicted = fn(&Recording, &dyn Fn(usize) -> bool) -> Option<Vec<f64>>;

/// The errors with and without suspect rows, if these raise that on the others by this `factor`.
/// `all` is what models of all rows predict, and `predicted` makes such models.
fn compared(
    recording: &Recording,
    suspect: Suspect,
    factor: f64,
    all: &[f64],
    predicted: Predicted,
) -> Option<Disagreement> {
    let rows = &suspect.rows;
    let kept = |n: usize| !rows.iter().any(|rows| rows.contains(&n));
    let others: Vec<usize> = (0..recording.len()).filter(|n| kept(*n)).collect();
    let of_others = |values: &[f64]| -> Vec<f64> { others.iter().map(|n| values[*n]).collect() };
    let least = match suspect.at_sight {
        true => LEAST_IF_SUSPECT,
        false if kept(0) => LEAST,
        false => LEAST_AT_START,
    };
    if others.len() == recording.len() || !are_fewer(rows, recording.len()) {
        return None;
    }
    let output = of_others(&recording.output);
    let off = |model: &[f64]| mean(apart(&output, model));
    let with = off(&of_others(all));
    // The usual range may be that of the wrong rows.
    let span = usual_span(&output).min(usual_span(&recording.output));
    let harms = with > least * span;
    // Only a channel that stands still may do less harm. All others need no models then.
    let may_stand = suspect.at_sight
        && rows.len() == 1
        && suspect.way.is_none()
        && may_stand_still(recording, &rows[0], all);
    let model = may_stand.then(|| from_kept(recording, &kept)).flatten();
    let stands = |without| {
        let stands = |model: &Vec<f64>| stands_still(recording, &rows[0], model, without);
        model.as_ref().is_some_and(stands)
    };
    if !harms && !stands(0.0) {
        return None;
    }
    let without = match suspect.way {
        Some(way) => off(&of_others(&predicted(&way.of(recording, rows), &|_| true)?)),
        // If their outputs alone are wrong, the inputs are still history.
        None => {
            let history = predicted(recording, &kept).map(|model| off(&of_others(&model)));
            let none = predicted(&recording.only(kept)?, &|_| true).map(|model| off(&model));
            history
                .into_iter()
                .chain(none)
                .fold(f64::INFINITY, f64::min)
        }
    };
    let harm = harms && with > factor * without;
    (harm || stands(without)).then_some(Disagreement {
        suspect,
        with,
        without,
    })
}
