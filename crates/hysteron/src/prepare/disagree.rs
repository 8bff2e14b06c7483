//! Finds rows that disagree with the others: in another unit, with columns exchanged, of another
//! sensor. A model that has not seen them errs much less on the rest.
//!
//! Which rows these may be is told by jumps of the series. Where nothing jumps, it is told by
//! concentration (Rousseeuw & Van Driessen 1999): a model is fitted to those blocks on which the
//! model before erred least, until the blocks stay the same; it begins with all rows, and with all but a window. A model that cannot follow the material
//! also errs in some blocks more than in others. So these rows disagree only if a change of their
//! unit, or an exchange of their columns, makes them agree.

use super::judge::{apart, from_kept, mean, unseen};
use crate::recording::Recording;
use crate::series::jumps::jumps;
use crate::series::mean_and_deviation;
use crate::series::noise::median_of;
use crate::series::spread::usual_span;
use std::ops::Range;

/// Rows that disagree raise the error on the others by at least this factor,
const FACTOR: f64 = 2.0;
/// to at least this share of the usual range of the output.
const LEAST: f64 = 0.01;
/// The first rows may be a virgin curve, which no later ones follow: they count from this share on.
const LEAST_AT_START: f64 = 0.03;
/// At most this share of the rows can disagree with the others.
const MOST: f64 = 0.4;
/// Sets of rows without which the others are followed nearly as well, up to this factor, are told
/// from each other by their size: the smallest is named.
const NEARLY: f64 = 1.5;
/// A change of unit explains rows if they then err at most so many times as much as the others, and
/// by at most this share of what they did before. The others err at most by this share of the range:
/// otherwise the model cannot follow the material.
const EXPLAINED: f64 = 1.0;
const LEFT: f64 = 0.1;
const FOLLOWED: f64 = 0.02;
/// There they move by at least this share of the usual range.
const MOVES: f64 = 0.3;
/// In a longer recording, rows are taken from which the shape of the loops can be seen.
const ROWS: usize = 10_000;
/// Blocks that disagree may have so many between them where they agree by chance.
const BETWEEN: [usize; 3] = [0, 2, 5];
/// With more jumps than this, stretches between them say nothing.
const JUMPS: usize = 8;
/// Number of blocks of a recording, and how many times the usual error makes one suspect.
const BLOCKS: usize = 40;
const SUSPECT: f64 = 4.0;
/// Rounds of the concentration, and number of windows without which it begins.
const ROUNDS: usize = 4;
const WINDOWS: usize = 5;

/// Stretches of rows that disagree with the others, and the errors on the others with and without
/// them: mean distances.
pub(super) struct Disagreement {
    pub(super) rows: Vec<Range<usize>>,
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
    for own in &mut found.rows {
        *own = rows[own.start]..rows[own.end - 1] + 1;
    }
    Some(found)
}

/// All rows of a short recording; of a long one, those with the smallest and the largest input of
/// each of many pieces, so that turning points stay.
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
    rows.sort_unstable();
    rows.dedup();
    rows
}

/// The rows that disagree with the others most clearly.
fn found(recording: &Recording) -> Option<Disagreement> {
    let all = from_kept(recording, |_| true)?;
    let span = usual_span(&recording.output);
    // No part of the rows then errs by enough. The usual range of the others may be smaller; that
    // is so where the outputs of many rows are wrong, and then the errors are large.
    if mean(apart(&recording.output, &all)) <= 0.5 * (1.0 - MOST) * LEAST * span {
        return None;
    }
    let fitted = |rest: &Recording| from_kept(rest, |_| true);
    let compared_with = |rows| compared(recording, rows, &all, fitted);
    let of_jumps = between_jumps(recording)
        .into_iter()
        .filter_map(compared_with);
    let starts = [Some(all.clone()), without_a_window(recording)];
    let starts = starts.into_iter().flatten();
    let concentrated = starts
        .flat_map(|start| concentrated(recording, start))
        .filter_map(|rows| compared_with(vec![rows.clone()]))
        .filter(|found| found.without <= FOLLOWED * span)
        .filter(|found| explained(recording, &found.rows[0], found.without));
    let found: Vec<Disagreement> = of_jumps.chain(concentrated).collect();
    let least = found
        .iter()
        .map(|one| one.without)
        .fold(f64::INFINITY, f64::min);
    let good = found
        .into_iter()
        .filter(|one| one.without <= NEARLY * least);
    let best = good.min_by_key(|one| one.rows.iter().map(Range::len).sum::<usize>())?;
    // A model of less data may follow them more closely without having learned more.
    compared(recording, best.rows, &unseen(recording)?, unseen)
}

/// The errors with and without some rows, if they disagree with the others. `all` is what models of
/// all rows predict, and `predicted` makes such models of the others.
fn compared(
    recording: &Recording,
    rows: Vec<Range<usize>>,
    all: &[f64],
    predicted: fn(&Recording) -> Option<Vec<f64>>,
) -> Option<Disagreement> {
    let kept = |n: usize| !rows.iter().any(|rows| rows.contains(&n));
    let others: Vec<usize> = (0..recording.len()).filter(|n| kept(*n)).collect();
    let share = 1.0 - others.len() as f64 / recording.len() as f64;
    if share == 0.0 || share > MOST {
        return None;
    }
    let rest = recording.only(kept)?;
    let without = mean(apart(&rest.output, &predicted(&rest)?));
    let seen: Vec<f64> = others.iter().map(|n| all[*n]).collect();
    let with = mean(apart(&rest.output, &seen));
    // The usual range may be that of the wrong rows.
    let least = match kept(0) {
        true => LEAST,
        false => LEAST_AT_START,
    };
    let least = least * usual_span(&rest.output).min(usual_span(&recording.output));
    (with > least && with > FACTOR * without).then_some(Disagreement {
        rows,
        with,
        without,
    })
}

/// Whether rows agree with the others, nearly as well as these with each other, once their outputs
/// are moved and stretched, or their columns exchanged. The first and the last block of the rows may
/// have others among them.
fn explained(recording: &Recording, rows: &Range<usize>, without: f64) -> bool {
    let block = recording.len().div_ceil(BLOCKS);
    let inner = match rows.len() > 3 * block {
        true => rows.start + block..rows.end - block,
        false => rows.clone(),
    };
    let off = |recording: &Recording, affine: bool| -> Option<f64> {
        let model = from_kept(recording, |n| !rows.contains(&n))?;
        let (read, model) = (&recording.output[inner.clone()], &model[inner.clone()]);
        // Where nothing moves, a line explains anything.
        if usual_span(model) < MOVES * usual_span(&recording.output) {
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
    let mut exchanged = recording.clone();
    exchanged.input[rows.clone()].copy_from_slice(&recording.output[rows.clone()]);
    exchanged.output[rows.clone()].copy_from_slice(&recording.input[rows.clone()]);
    let before = off(recording, false).unwrap_or(f64::INFINITY);
    let enough = (EXPLAINED * without).min(LEFT * before);
    let found = [off(recording, true), off(&exchanged, false)];
    found.into_iter().flatten().any(|off| off <= enough)
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

/// The stretches between jumps that may disagree with the rest: each alone, and every other one.
fn between_jumps(recording: &Recording) -> Vec<Vec<Range<usize>>> {
    let mut sets = Vec::new();
    let mut cuts = [jumps(&recording.input), jumps(&recording.output)].concat();
    cuts.sort_unstable();
    cuts.dedup();
    if (1..=JUMPS).contains(&cuts.len()) {
        let begins = [0].into_iter().chain(cuts.iter().copied());
        let ends = cuts.iter().copied().chain([recording.len()]);
        let stretches: Vec<Range<usize>> = begins.zip(ends).map(|(a, b)| a..b).collect();
        for first in [0, 1] {
            sets.push(stretches.iter().skip(first).step_by(2).cloned().collect());
        }
        sets.extend(stretches.into_iter().map(|stretch| vec![stretch]));
    }
    sets
}

/// What a model of all rows but a window predicts, for the window without which it follows the
/// others most closely.
fn without_a_window(recording: &Recording) -> Option<Vec<f64>> {
    let len = recording.len();
    let width = (MOST * len as f64) as usize;
    let models = (0..WINDOWS).filter_map(|n| {
        let start = n * (len - width) / (WINDOWS - 1);
        let kept = |n: usize| !(start..start + width).contains(&n);
        let model = from_kept(recording, kept)?;
        let off = apart(&recording.output, &model).enumerate();
        Some((
            mean(off.filter(|(n, _)| kept(*n)).map(|(_, off)| off)),
            model,
        ))
    });
    models
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, model)| model)
}

/// The longest stretch of blocks on which a model errs many times more than usual, round by round:
/// a first model, then one of the blocks on which the model before erred least.
fn concentrated(recording: &Recording, mut predicted: Vec<f64>) -> Vec<Range<usize>> {
    let bounds: Vec<usize> = (0..=BLOCKS).map(|n| n * recording.len() / BLOCKS).collect();
    let block = |n: usize| bounds[n]..bounds[n + 1];
    let keep = ((1.0 - MOST) * BLOCKS as f64).ceil() as usize;
    let mut found: Vec<Range<usize>> = Vec::new();
    let mut least: Vec<usize> = Vec::new();
    for _ in 0..ROUNDS {
        let error = |n: usize| mean(apart(&recording.output[block(n)], &predicted[block(n)]));
        let errors: Vec<f64> = (0..BLOCKS).map(error).collect();
        let suspect = SUSPECT * median_of(errors.clone());
        let large: Vec<usize> = (0..BLOCKS).filter(|n| errors[*n] > suspect).collect();
        for between in BETWEEN {
            let near = large.chunk_by(|a, b| b - a <= between + 1);
            let rows = near.map(|run| bounds[run[0]]..bounds[run[run.len() - 1] + 1]);
            let longest = rows.max_by_key(Range::len);
            found.extend(longest.filter(|rows| !found.contains(rows)));
        }
        let mut order: Vec<usize> = (0..BLOCKS).collect();
        order.sort_by(|a, b| errors[*a].total_cmp(&errors[*b]));
        order.truncate(keep);
        order.sort_unstable();
        if order == least {
            break;
        }
        least = order;
        let kept = |n: usize| least.iter().any(|own| block(*own).contains(&n));
        match from_kept(recording, kept) {
            Some(of_the_least) => predicted = of_the_least,
            None => break,
        }
    }
    found
}
