//! What the error of a model consists of: an offset, a gain, a shift of the input, a delay, a
//! drift, and what is left, the shape.

use crate::recording::Recording;
use serde::Serialize;

/// What a few numbers explain of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PartKind {
    /// A constant, in the output's unit: another mounting, another zero of the sensor.
    Offset,
    /// The output moves by so much more than the model's, about zero or about its mean, from −1 on:
    /// 0.1 is 10 % more.
    Gain,
    /// The loops lie further along the input by a constant, in its unit: another sensor or load.
    Shift,
    /// The output comes late, by so many samples.
    Late,
    /// The output runs away from the model, by so much from the first to the last sample.
    Drift,
}

impl PartKind {
    /// Every kind.
    const ALL: [Self; 5] = [
        Self::Offset,
        Self::Gain,
        Self::Shift,
        Self::Late,
        Self::Drift,
    ];
}

/// The share of one kind in an error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorPart {
    /// What it is.
    pub kind: PartKind,
    /// Its share of the squared error, from 0 to 1. The shares add up to 1 less the share of the
    /// shape.
    pub share: f64,
    /// How large it is; in what unit, [`PartKind`] says.
    pub size: f64,
}

/// What remains of a regressor's square once those before it are taken out. Less is rounding.
const LEFT: f64 = 1e-9;

/// The parts of the differences between the outputs of `recordings` and `modelled`, which has the
/// outputs of the model for all of them, one after the other.
///
/// By least squares over all samples. First stands the part that explains most by itself, then the
/// one that explains most of what is left, and so on (forward selection). The shift is along the
/// model's slope `Δy/Δx`, the delay along its change from sample to sample.
///
/// ```
/// use hysteron::{PartKind, Recording, error_parts};
/// let input: Vec<f64> = (0..100).map(|n| (f64::from(n) * 0.2).sin()).collect();
/// let recording = Recording::new(input.clone(), input.iter().map(|x| 1.1 * x + 3.0).collect())?;
/// let [offset, gain, ..] = error_parts(&recording, &input);
/// assert_eq!((offset.kind, gain.kind), (PartKind::Offset, PartKind::Gain));
/// assert!(offset.share > 0.9 && (offset.size - 3.0).abs() < 0.1);
/// assert!((gain.size - 0.1).abs() < 1e-9);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[must_use]
pub fn error_parts(
    recordings: &(impl AsRef<[Recording]> + ?Sized),
    modelled: &[f64],
) -> [ErrorPart; 5] {
    parts_after(&[], recordings.as_ref(), modelled)
}

/// As [`error_parts`], but those `named` come first, in their order, whatever they explain.
pub(super) fn parts_after(
    named: &[PartKind],
    recordings: &[Recording],
    modelled: &[f64],
) -> [ErrorPart; 5] {
    let about_zero = parts_about(0.0, named, recordings, modelled);
    if !named.is_empty() {
        return about_zero;
    }
    // A gain about zero, as of another unit, or about the middle: of these the other one would stand
    // as a gain and an offset that is larger than the error.
    let middle = modelled.iter().sum::<f64>() / modelled.len().max(1) as f64;
    let about_middle = parts_about(middle, named, recordings, modelled);
    match about_middle[0].share > about_zero[0].share + LEFT {
        true => about_middle,
        false => about_zero,
    }
}

/// The parts, with a gain about an output of `middle`.
fn parts_about(
    middle: f64,
    named: &[PartKind],
    recordings: &[Recording],
    modelled: &[f64],
) -> [ErrorPart; 5] {
    // The Gram matrix of the five regressors and of the difference itself.
    let mut gram = [[0.0; 6]; 6];
    let mut first = 0;
    for recording in recordings {
        let count = recording.len().min(modelled.len().saturating_sub(first));
        let y = &modelled[first..first + count];
        let (x, measured) = (&recording.input, &recording.output);
        for n in 0..count {
            let (before, after) = (n.saturating_sub(1), (n + 1).min(count - 1));
            let (dy, dx) = (y[after] - y[before], x[after] - x[before]);
            let steps = (after - before).max(1) as f64;
            // Across a reversal the slope says nothing.
            let turns = (x[after] - x[n]) * (x[n] - x[before]) <= 0.0;
            let slope = if turns { 0.0 } else { dy / dx };
            let along = n as f64 / (count.max(2) - 1) as f64;
            let row = [
                1.0,
                y[n] - middle,
                slope,
                dy / steps,
                along,
                measured[n] - y[n],
            ];
            for (i, a) in row.iter().enumerate() {
                for (j, b) in row.iter().enumerate() {
                    gram[i][j] += a * b;
                }
            }
        }
        first += count;
    }
    let whole = gram;
    let total = whole[5][5];
    let mut left: Vec<usize> = (0..5).collect();
    let mut named = named.iter();
    [(); 5].map(|()| {
        let explains = |k: usize| match gram[k][k] > LEFT * whole[k][k] && total > 0.0 {
            true => gram[k][5] * gram[k][5] / gram[k][k] / total,
            false => 0.0,
        };
        let stands = |kind: &PartKind| left.iter().position(|&k| PartKind::ALL[k] == *kind);
        let place = match named.next().and_then(stands) {
            Some(place) => place,
            None => most(left.iter().map(|&k| explains(k))),
        };
        let share = explains(left[place]);
        let k = left.remove(place);
        let kind = PartKind::ALL[k];
        if share == 0.0 {
            let size = 0.0;
            return ErrorPart { kind, share, size };
        }
        let taken = gram[k];
        for row in left.iter().copied().chain([5]) {
            let factor = gram[row][k] / taken[k];
            for (cell, above) in gram[row].iter_mut().zip(taken) {
                *cell -= factor * above;
            }
        }
        // What moves the model towards the recording: a late output is that of earlier inputs.
        let sign = match kind {
            PartKind::Shift | PartKind::Late => -1.0,
            _ => 1.0,
        };
        ErrorPart {
            kind,
            share: share.min(1.0),
            size: sign * taken[5] / taken[k],
        }
    })
}

/// Where the largest of some shares stands, the first of equal ones.
fn most(shares: impl Iterator<Item = f64>) -> usize {
    let mut best = (0, 0.0);
    for (place, share) in shares.enumerate() {
        if share > best.1 {
            best = (place, share);
        }
    }
    best.0
}
