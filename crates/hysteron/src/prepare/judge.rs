//! Judges a step of the preparation by the error of a model on data that it did not see.
//!
//! The recording is divided into blocks. A small model is fitted without a fifth of them, and
//! predicts the output there; so each block is left out once. The predictions are compared with the
//! output as it was measured. A step is kept only if they come closer to it: where it changes the
//! input, and no further from it elsewhere; or where it does not change the output. Outputs that are
//! suspect have no say in steps of the input. The mean distance is compared, not its square: of
//! the wrong readings that nobody suspects, each then counts the same with and without the step.
//!
//! A filter is judged otherwise, see [`super::alike`].

use super::change::Change;
use crate::identify::{FitOptions, SOME_SMOOTHNESS, predicted_from, predicted_without};
use crate::model::Start;
use crate::prepare::options::Step;
use crate::prepare::resample::at_times;
use crate::recording::Recording;
use crate::series::range;
use serde::Serialize;
use std::borrow::Cow;

/// Levels of the model: enough to resolve the loops, and few enough for many fits.
const LEVELS: usize = 20;
/// Number of blocks of a recording, and number of groups of blocks that are left out in turn.
const BLOCKS: usize = 20;
const FOLDS: usize = 5;
/// With fewer samples in a block nothing can be judged.
const SHORTEST: usize = 3;
/// A gain below this share of the error is rounding, or luck.
const WORTH: f64 = 1e-3;

/// What a step was worth. The errors are those of a small model on what it was not fitted to, in
/// the unit of the output: mean distances from the output as measured, over the samples whose input
/// the step changes, or whose output it does not change; for a low-pass, the root of the mean squared
/// distance from the output of a simulated recording like this one, without its noise.
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

/// The low-passes of input and output, as steps.
pub(super) const LOW_PASSES: [&str; 2] = ["low-pass of the input", "low-pass of the output"];

impl Judged {
    /// Whether the errors are those on a simulated recording like this one: a low-pass is judged so,
    /// because no model of noisy readings tells what they would be without noise.
    #[must_use]
    pub fn is_on_simulated(&self) -> bool {
        LOW_PASSES.contains(&self.step)
    }
}

/// Judges the steps of one recording, each after those that were kept.
pub(super) struct Judge<'a> {
    measured: &'a Recording,
    /// What was judged so far.
    pub(super) judged: Vec<Judged>,
    /// The distances of the last recording that was kept, over a range of inputs, once they are
    /// needed.
    distances: Option<(Range, Option<Vec<f64>>)>,
    /// Samples whose output is not to be believed, ascending: they take no part.
    ignored: Vec<usize>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(measured: &'a Recording) -> Self {
        Self {
            measured,
            judged: Vec::new(),
            distances: None,
            ignored: Vec::new(),
        }
    }

    /// Steps of the input are judged without these samples, whose output is suspect.
    pub(super) fn ignore(&mut self, outputs: Vec<usize>) {
        if self.ignored != outputs {
            self.ignored = outputs;
            self.distances = None;
        }
    }

    /// Takes a step that was asked for by its value; one that is left to the data, only if it lowers
    /// the error. Returns whether it was taken. What changes nothing is not judged.
    pub(super) fn offer(
        &mut self,
        step: &'static str,
        how: Step,
        work: &mut Recording,
        mut change: Change,
    ) -> bool {
        if how != Step::Auto {
            self.take(work, &mut change);
            return true;
        }
        let samples = change.samples(work);
        if samples.is_empty() {
            return false;
        }
        if matches!(change, Change::Output(_)) {
            self.ignore(Vec::new());
        }
        let listed = |samples: &[usize], n: &usize| samples.binary_search(n).is_ok();
        let all = || (0..self.measured.len()).filter(|n| !listed(&self.ignored, n));
        let touched: Vec<usize> = match change {
            _ if work.time != self.measured.time => all().collect(),
            Change::Resampled(_) => all().collect(),
            Change::Input(_) => all().filter(|n| listed(&samples, n)).collect(),
            Change::Output(_) => all().filter(|n| !listed(&samples, n)).collect(),
        };
        // Where all that it touches is ignored, it shows in what comes after.
        let touched = match touched.is_empty() {
            true => all().collect(),
            false => touched,
        };
        // With and without it on the same plane: a wrong input makes it wider, and the model coarser
        // or freer.
        let inner = within(range(&work.input), range(change.input(work)));
        let before = match self.distances.take() {
            Some((range, known)) if range == inner => known,
            _ => self.distances(work, inner),
        };
        change.swap(work);
        let after = before.as_ref().and_then(|_| self.distances(work, inner));
        let here = |distances: &Vec<f64>| mean(touched.iter().map(|n| distances[*n]));
        let everywhere = |distances: &Vec<f64>| mean(all().map(|n| distances[n]));
        let pair = before.as_ref().zip(after.as_ref());
        let better =
            |(before, after): (&Vec<f64>, &Vec<f64>)| here(after) < (1.0 - WORTH) * here(before);
        let harms = |(before, after): (&Vec<f64>, &Vec<f64>)| {
            !matches!(change, Change::Output(_))
                && everywhere(after) > (1.0 + WORTH) * everywhere(before)
        };
        // What is told is what decided.
        let harms = pair.is_some_and(harms);
        let told = |distances| match harms {
            true => everywhere(distances),
            false => here(distances),
        };
        let kept = pair.is_some_and(better) && !harms;
        self.judged.push(Judged {
            step,
            samples: samples.len(),
            before: before.as_ref().map(told),
            after: after.as_ref().map(told),
            kept,
        });
        if !kept {
            change.swap(work);
        }
        self.distances = Some((inner, if kept { after } else { before }));
        kept
    }

    /// Makes a change that needs no judgement of this kind.
    pub(super) fn take(&mut self, work: &mut Recording, change: &mut Change) {
        change.swap(work);
        self.distances = None;
    }

    /// The distances of the output as measured from what models predict that did not see it. The
    /// recording that they are fitted to may have other samples in time. `None` if none can be
    /// fitted.
    fn distances(&self, work: &Recording, range: Range) -> Option<Vec<f64>> {
        let (measured, len) = (self.measured, self.measured.len());
        let fold = |n: usize| {
            let ignored = self.ignored.binary_search(&n).is_ok();
            (!ignored).then(|| fold(n, len))
        };
        let predicted = match (&measured.time, &work.time) {
            (Some(old), Some(new)) if old != new => {
                // A sample is in the block of the last sample measured until then.
                let until = |t: &f64| old.partition_point(|o| o <= t).saturating_sub(1);
                let fold: Vec<Option<usize>> = new.iter().map(|t| fold(until(t))).collect();
                at_times(new, &without_folds(work, &fold, Some(range))?, old)
            }
            _ => {
                let fold: Vec<Option<usize>> = (0..len).map(fold).collect();
                without_folds(work, &fold, Some(range))?
            }
        };
        Some(apart(&measured.output, &predicted).collect())
    }
}

/// NaN of no values.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// The distances of two series, sample by sample.
pub(super) fn apart<'a>(a: &'a [f64], b: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    a.iter().zip(b).map(|(a, b)| (a - b).abs())
}

/// The output at each sample, from models of those that are `kept`, which did not see it; `None` if
/// none can be fitted.
pub(super) fn unseen(recording: &Recording, kept: &dyn Fn(usize) -> bool) -> Option<Vec<f64>> {
    let len = recording.len();
    let fold = |n| kept(n).then(|| fold(n, len));
    let fold: Vec<Option<usize>> = (0..len).map(fold).collect();
    without_folds(recording, &fold, None)
}

/// The output at each sample, from a model of those that are `kept`; `None` if it cannot be fitted.
pub(super) fn from_kept(recording: &Recording, kept: &dyn Fn(usize) -> bool) -> Option<Vec<f64>> {
    let kept: Vec<f64> = (0..recording.len()).map(|n| f64::from(kept(n))).collect();
    if recording.len() < BLOCKS * SHORTEST {
        return None;
    }
    let recording = with_its_load(recording);
    predicted_from(&recording, &small(), &kept).ok()
}

/// The group of blocks that a sample of `len` belongs to.
fn fold(sample: usize, len: usize) -> usize {
    (sample * BLOCKS / len) % FOLDS
}

/// On the plane of a range, or of that of the inputs.
fn without_folds(
    recording: &Recording,
    fold: &[Option<usize>],
    range: Option<Range>,
) -> Option<Vec<f64>> {
    if recording.len() < BLOCKS * SHORTEST {
        return None;
    }
    let recording = with_its_load(recording);
    let options = FitOptions { range, ..small() };
    predicted_without(&recording, &options, fold).ok()
}

/// Lowest and highest value.
type Range = (f64, f64);

/// What two ranges have in common; the second, if that is nothing.
fn within(a: Range, b: Range) -> Range {
    let common = (a.0.max(b.0), a.1.min(b.1));
    if common.0 < common.1 { common } else { b }
}

/// The small model that all is judged by.
pub(super) fn small() -> FitOptions {
    FitOptions {
        levels: LEVELS,
        smooth: SOME_SMOOTHNESS,
        start: Start::Unknown,
        ..FitOptions::plain()
    }
}

/// The recording without a load that does not vary.
pub(super) fn with_its_load(recording: &Recording) -> Cow<'_, Recording> {
    let constant = recording.load.as_ref().is_some_and(|load| {
        let (low, high) = range(load);
        high - low <= 1e-9 * high.abs().max(low.abs())
    });
    match constant {
        true => Cow::Owned(Recording {
            load: None,
            ..recording.clone()
        }),
        false => Cow::Borrowed(recording),
    }
}
