//! Judges a step of the preparation by the error of a model on data that it did not see.
//!
//! The recording is divided into blocks. A small model is fitted without a fifth of them, and
//! predicts the output there; so each block is left out once. The predictions are compared with the
//! output as it was measured. A step is kept only if they come closer to it where it changes the
//! input, and no further from it elsewhere. The mean distance is compared, not its square: a reading
//! of the output that is wrong then counts the same with and without the step, and decides nothing.

use crate::identify::{FitOptions, SOME_SMOOTHNESS, predicted_without};
use crate::model::Start;
use crate::prepare::options::Step;
use crate::prepare::resample::at_times;
use crate::recording::Recording;
use crate::series::range;
use serde::Serialize;

/// Levels of the model: enough to resolve the loops, and few enough for many fits.
const LEVELS: usize = 20;
/// Number of blocks of a recording, and number of groups of blocks that are left out in turn.
const BLOCKS: usize = 20;
const FOLDS: usize = 5;
/// With fewer samples in a block nothing can be judged.
const SHORTEST: usize = 3;
/// A gain below this share of the error is rounding, or luck.
const WORTH: f64 = 1e-3;

/// What a step was worth. The errors are those of a small model on parts of the recording that it
/// was not fitted to: mean distances from the output as measured, in its unit, over the samples whose
/// input the step changes; over all, if it changes none or the times.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// The step, and the series that it changes.
    pub step: &'static str,
    /// Number of samples that it changes.
    pub samples: usize,
    /// The error without the step; `None` if no model can be fitted.
    pub before: Option<f64>,
    /// The error with the step; `None` if no model can be fitted.
    pub after: Option<f64>,
    /// Whether the step was taken.
    pub kept: bool,
}

/// Judges the steps of one recording, each after those that were kept.
pub(super) struct Judge<'a> {
    measured: &'a Recording,
    /// What was judged so far.
    pub(super) judged: Vec<Judged>,
    /// The distances of the last recording that was kept, once they are needed.
    distances: Option<Option<Vec<f64>>>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(measured: &'a Recording) -> Self {
        Self {
            measured,
            judged: Vec::new(),
            distances: None,
        }
    }

    /// Takes a step that was asked for by its value; one that is left to the data, only if it lowers
    /// the error. Returns whether it was taken. What changes nothing is not judged.
    pub(super) fn offer(
        &mut self,
        step: &'static str,
        how: Step,
        work: &mut Recording,
        candidate: Recording,
    ) -> bool {
        if how != Step::Auto {
            *work = candidate;
            self.distances = None;
            return true;
        }
        if *work == candidate {
            return false;
        }
        let before = self
            .distances
            .get_or_insert_with(|| distances(self.measured, work))
            .as_deref();
        let after = before.and_then(|_| distances(self.measured, &candidate));
        let touched = touched(self.measured, work, &candidate);
        let here = |distances: &[f64]| mean(touched.iter().map(|n| distances[*n]));
        let all = |distances: &[f64]| mean(distances.iter().copied());
        let pair = before.zip(after.as_deref());
        let kept = pair.is_some_and(|(before, after)| {
            here(after) < (1.0 - WORTH) * here(before) && all(after) <= (1.0 + WORTH) * all(before)
        });
        self.judged.push(Judged {
            step,
            samples: changed(work, &candidate),
            before: before.map(here),
            after: after.as_deref().map(here),
            kept,
        });
        if kept {
            *work = candidate;
            self.distances = Some(after);
        }
        kept
    }
}

/// Number of samples that differ; all, if their times differ.
fn changed(work: &Recording, candidate: &Recording) -> usize {
    if work.time != candidate.time {
        return candidate.len();
    }
    let same = |n: &usize| {
        work.input[*n] == candidate.input[*n] && work.output[*n] == candidate.output[*n]
    };
    (0..work.len()).filter(|n| !same(n)).count()
}

/// The samples as measured whose input differs; all, if none does or the times are others.
fn touched(measured: &Recording, work: &Recording, candidate: &Recording) -> Vec<usize> {
    let all = 0..measured.len();
    if work.time != measured.time || candidate.time != measured.time {
        return all.collect();
    }
    let differs = |n: &usize| work.input[*n] != candidate.input[*n];
    match all.clone().any(|n| differs(&n)) {
        true => all.filter(differs).collect(),
        false => all.collect(),
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// The distances of the output as measured from what models predict that did not see it. The
/// candidate may have other samples in time. `None` if no model can be fitted.
fn distances(measured: &Recording, candidate: &Recording) -> Option<Vec<f64>> {
    let len = measured.len();
    let predicted = match (&measured.time, &candidate.time) {
        (Some(old), Some(new)) if old != new => {
            // A sample is in the block of the last sample measured until then.
            let until = |t: &f64| old.partition_point(|o| o <= t).saturating_sub(1);
            let fold: Vec<usize> = new.iter().map(|t| fold(until(t), len)).collect();
            at_times(new, &without_folds(candidate, len, &fold)?, old)
        }
        _ => unseen(candidate)?,
    };
    let pairs = measured.output.iter().zip(&predicted);
    Some(pairs.map(|(y, p)| (y - p).abs()).collect())
}

/// The output at each sample, from models that did not see it; `None` if none can be fitted.
pub(super) fn unseen(recording: &Recording) -> Option<Vec<f64>> {
    let len = recording.len();
    let fold: Vec<usize> = (0..len).map(|n| fold(n, len)).collect();
    without_folds(recording, len, &fold)
}

pub(super) fn mean_distance(measured: &[f64], predicted: &[f64]) -> f64 {
    let distances = measured.iter().zip(predicted).map(|(y, p)| (y - p).abs());
    distances.sum::<f64>() / measured.len() as f64
}

/// The group of blocks that a sample of `len` belongs to.
fn fold(sample: usize, len: usize) -> usize {
    (sample * BLOCKS / len) % FOLDS
}

fn without_folds(recording: &Recording, len: usize, fold: &[usize]) -> Option<Vec<f64>> {
    if len < BLOCKS * SHORTEST {
        return None;
    }
    let varies = |load: &Vec<f64>| {
        let (low, high) = range(load);
        high - low > 1e-9 * high.abs().max(low.abs())
    };
    let operators = Recording {
        load: recording.load.clone().filter(varies),
        ..recording.clone()
    };
    let options = FitOptions {
        levels: LEVELS,
        smooth: SOME_SMOOTHNESS,
        start: Start::Unknown,
        ..FitOptions::default()
    };
    predicted_without(&operators, &options, fold).ok()
}
