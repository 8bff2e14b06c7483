//! Rows that may disagree with the others: where the series jump, or the error of a model does;
//! where a channel keeps one value; and, by concentration (Rousseeuw & Van Driessen 1999), where a
//! model errs that was fitted to those blocks on which the model before erred least.

use super::judge::{apart, from_kept, mean};
use super::misread::{JUMPS, Reading, fits_exchanged, readings};
use crate::recording::Recording;
use crate::series::frozen::still;
use crate::series::jumps::jumps;
use crate::series::noise::median_of;
use std::ops::Range;

/// A longer recording is divided into so many blocks. So many times the usual error makes one
/// suspect.
pub(super) const BLOCKS: usize = 40;
pub(super) const SUSPECT: f64 = 4.0;
/// The rows that disagree are fewer than the others.
pub(super) const HALF: f64 = 0.5;
/// Blocks that disagree may have so many between them where they agree by chance.
const BETWEEN: [usize; 3] = [0, 2, 5];
/// Rounds of the concentration, and number of windows without which it begins. Each is of this
/// share of the rows.
const ROUNDS: usize = 4;
const WINDOWS: usize = 5;
pub(super) const WINDOW: f64 = 0.4;

/// Stretches of rows that may disagree with the others.
#[derive(Debug, Clone)]
pub(super) struct Suspect {
    pub(super) rows: Vec<Range<usize>>,
    /// Another way to read them.
    pub(super) way: Option<Reading>,
    /// Whether the readings of these rows alone make them suspect.
    pub(super) at_sight: bool,
}

impl Suspect {
    fn seen(rows: Vec<Range<usize>>, way: Option<Reading>) -> Self {
        Self {
            rows,
            way,
            at_sight: true,
        }
    }

    fn unseen(rows: Vec<Range<usize>>) -> Self {
        Self {
            rows,
            way: None,
            at_sight: false,
        }
    }

    /// The others of `len` rows, if these are one stretch beside one stretch: two recordings, of
    /// which either may be wrong. Of a channel that stands still it is known.
    pub(super) fn rest(&self, len: usize) -> Option<Range<usize>> {
        let stands_still = self.at_sight && self.way.is_none();
        match &self.rows[..] {
            [own] if !stands_still && own.start == 0 => Some(own.end..len),
            [own] if !stands_still && own.end == len => Some(0..own.start),
            _ => None,
        }
    }
}

/// The samples before which a series jumps.
pub(super) fn all_jumps(recording: &Recording) -> Vec<usize> {
    ascending([jumps(&recording.input), jumps(&recording.output)].concat())
}

fn ascending(mut cuts: Vec<usize>) -> Vec<usize> {
    cuts.sort_unstable();
    cuts.dedup();
    cuts
}

/// The `jumps` of the series, and the sample before which the error of a model jumps furthest: a
/// small slip of a sensor, which the series alone do not show.
pub(super) fn with_that_of_the_error(
    jumps: &[usize],
    recording: &Recording,
    predicted: &[f64],
) -> Vec<usize> {
    let error = |n: usize| recording.output[n] - predicted[n];
    let jump = |n: &usize| (error(*n) - error(n - 1)).abs();
    let furthest = (1..recording.len()).max_by(|a, b| jump(a).total_cmp(&jump(b)));
    ascending(jumps.iter().copied().chain(furthest).collect())
}

/// Those that the series tell, between their `jumps`, and between these `cuts` that may be more.
pub(super) fn of_the_series(
    recording: &Recording,
    jumps: &[usize],
    cuts: &[usize],
) -> Vec<Suspect> {
    let len = recording.len();
    let parts = between(jumps, len).into_iter();
    let mut found: Vec<Suspect> = parts.map(Suspect::unseen).collect();
    let misread = readings(recording, cuts).into_iter();
    found.extend(misread.map(|(rows, way)| Suspect::seen(rows, Some(way))));
    let parts = between(cuts, len).into_iter();
    found.extend(parts.filter_map(|rows| slipped(recording, rows)));
    let channels = [&recording.input, &recording.output].into_iter();
    found.extend(channels.map(|values| still(values)).flat_map(|runs| {
        // A loose contact holds a series again and again.
        let all = (runs.len() > 1).then(|| runs.clone());
        let each = runs.into_iter().map(|rows| vec![rows]);
        each.chain(all).map(|rows| Suspect::seen(rows, None))
    }));
    found
}

/// Those that models tell, of which the first one, of all rows, `predicted`. Their ends are also
/// moved to near `cuts`.
pub(super) fn of_models(recording: &Recording, cuts: &[usize], predicted: &[f64]) -> Vec<Suspect> {
    let starts = [Some(predicted.to_vec()), without_a_window(recording)];
    let mut known = Vec::new();
    let mut found: Vec<Range<usize>> = Vec::new();
    for start in starts.into_iter().flatten() {
        for rows in concentrated(recording, start, &mut known) {
            for rows in [snapped(&rows, cuts, recording.len()), rows] {
                if !found.contains(&rows) {
                    found.push(rows);
                }
            }
        }
    }
    let suspects = found.into_iter().flat_map(|rows| {
        let exchanged = || Suspect::seen(vec![rows.clone()], Some(Reading::Exchanged));
        let exchanged = fits_exchanged(recording, &rows).then(exchanged);
        exchanged.into_iter().chain([Suspect::unseen(vec![rows])])
    });
    suspects.collect()
}

/// Whether rows are few enough of `len` to be those that disagree.
pub(super) fn are_fewer(rows: &[Range<usize>], len: usize) -> bool {
    rows.iter().map(Range::len).sum::<usize>() as f64 <= HALF * len as f64
}

/// The stretches between the samples `cuts`: each alone, and every other one; those that are fewer
/// than the others.
fn between(cuts: &[usize], len: usize) -> Vec<Vec<Range<usize>>> {
    let mut sets = Vec::new();
    if (1..=JUMPS).contains(&cuts.len()) {
        let begins = [0].into_iter().chain(cuts.iter().copied());
        let ends = cuts.iter().copied().chain([len]);
        let stretches: Vec<Range<usize>> = begins.zip(ends).map(|(a, b)| a..b).collect();
        for first in [0, 1] {
            let others: Vec<_> = stretches.iter().skip(first).step_by(2).cloned().collect();
            // One alone comes below.
            sets.extend(Some(others).filter(|others| others.len() > 1));
        }
        sets.extend(stretches.into_iter().map(|stretch| vec![stretch]));
    }
    sets.retain(|rows| are_fewer(rows, len));
    sets
}

/// Rows whose output may be that of another zero, by what a model of the others expects there.
fn slipped(recording: &Recording, rows: Vec<Range<usize>>) -> Option<Suspect> {
    let listed = |n: usize| rows.iter().any(|rows| rows.contains(&n));
    let model = from_kept(recording, &|n| !listed(n))?;
    let errors = (0..recording.len()).filter(|n| listed(*n));
    let errors = errors.map(|n| model[n] - recording.output[n]).collect();
    let way = Reading::Output(1.0, median_of(errors));
    Some(Suspect::seen(rows, Some(way)))
}

/// Rows whose ends are moved to the nearest of the `cuts`, by less than a block.
fn snapped(rows: &Range<usize>, cuts: &[usize], len: usize) -> Range<usize> {
    let nearest = |end: usize| {
        let near = cuts
            .iter()
            .filter(|cut| cut.abs_diff(end) < len.div_ceil(BLOCKS));
        near.min_by_key(|cut| cut.abs_diff(end))
            .copied()
            .unwrap_or(end)
    };
    nearest(rows.start)..nearest(rows.end)
}

/// What a model of all rows but a window predicts, for the window without which it follows the
/// others most closely.
fn without_a_window(recording: &Recording) -> Option<Vec<f64>> {
    let len = recording.len();
    let width = (WINDOW * len as f64) as usize;
    let models = (0..WINDOWS).filter_map(|n| {
        let start = n * (len - width) / (WINDOWS - 1);
        let kept = |n: usize| !(start..start + width).contains(&n);
        let model = from_kept(recording, &kept)?;
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
/// a first model, then one of the blocks on which the model before erred least. It ends at blocks
/// that are `known`: what comes after them was looked at before.
fn concentrated(
    recording: &Recording,
    mut predicted: Vec<f64>,
    known: &mut Vec<Vec<usize>>,
) -> Vec<Range<usize>> {
    let bounds: Vec<usize> = (0..=BLOCKS).map(|n| n * recording.len() / BLOCKS).collect();
    let block = |n: usize| bounds[n]..bounds[n + 1];
    let keep = ((1.0 - WINDOW) * BLOCKS as f64).ceil() as usize;
    let mut found: Vec<Range<usize>> = Vec::new();
    for round in 1..=ROUNDS {
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
        if round == ROUNDS || known.contains(&order) {
            break;
        }
        let kept = |n: usize| order.iter().any(|own| block(*own).contains(&n));
        match from_kept(recording, &kept) {
            Some(of_the_least) => predicted = of_the_least,
            None => break,
        }
        known.push(order);
    }
    found
}
