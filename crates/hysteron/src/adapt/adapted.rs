//! What an adaptation gives: the model, and its errors beside those of the model left alone.

use super::{Drift, EstimatorOptions, OutcomeCounts, ShiftFound, Stuck};
use crate::model::{Model, Start};
use crate::recording::Recording;
use crate::series::{CutOff, Errors};
use hysteron_core::Outcome;
use serde::Serialize;

/// From this share of a constant's error on, a model says nothing of the output.
const NOTHING: f64 = 0.9;

/// The result of an adaptation.
#[derive(Debug, Clone, PartialEq)]
pub struct Adapted {
    /// The model with the last weights that are not on [probation](Adapted::probation). Its
    /// [`crate::FitSummary`] gives the errors of these weights over the whole recording. The
    /// confidence of the off-line model does not hold for them and is removed. The field `adapted`
    /// records how they were obtained.
    pub model: Model,
    /// Number of samples at the end that did not change the model, because no later samples can
    /// confirm them: [`crate::AdaptOptions::burst`], or 0 without a [`crate::AdaptOptions::gate`].
    pub probation: usize,
    /// Output expected at each sample before the estimator learned from it.
    pub output_model: Vec<f64>,
    /// What was done with each sample.
    pub outcomes: Vec<Outcome>,
    /// How often each outcome occurred.
    pub counts: OutcomeCounts,
    /// Errors over the whole recording.
    pub whole: Compared,
    /// Errors over the first, second and last third of the samples; empty for fewer than three
    /// samples.
    pub thirds: Vec<Compared>,
    /// Errors over the last third of the samples that are not [stuck](Adapted::stuck), without the
    /// rejected readings and those on probation; [`Adapted::worse`] begins with them. `None` if
    /// there are no such samples.
    pub late: Option<Compared>,
    /// Whether the model that learned is no better than the model left alone: on the last third its
    /// errors, taken before it learned from each sample, are larger than those of the fixed model,
    /// or less than 1 % smaller although it changed. Differences of the size of rounding do not
    /// count. Or the final weights have larger errors there ([`Adapted::again_late`]). Or they err
    /// more on the first third, by 1 % of the range ([`Adapted::again_first`]), and either learning or
    /// they gained less than a tenth on the last. Of a model of another [session](Adapted::session)
    /// only whether it errs more on the first or the last third.
    pub worse: bool,
    /// Errors of the final weights over the whole recording, run again from its start. These
    /// weights have seen all of it.
    pub again: Errors,
    /// The same over the samples of [`Adapted::late`], beside the fixed model.
    pub again_late: Option<Compared>,
    /// The same over the first third of the samples.
    pub again_first: Option<Compared>,
    /// The standard deviation of the measured output there: what a constant errs. A model that
    /// erred about as much before it learned says nothing of an output that no longer follows its
    /// input; it is [worse](Adapted::worse), too.
    pub late_spread: f64,
    /// How the model has changed.
    pub drift: Drift,
    /// Where a channel stood still. What was learned from there is undone.
    pub stuck: Vec<Stuck>,
    /// Where the output is cut off, though the model goes on by more than 1 % of its range: a
    /// sensor at its end. The model has learned that end. `None` where it is not.
    pub cut_off: Option<CutOff>,
    /// Where the operators began: of an unknown start, the one that was taken.
    pub start: Start,
    /// The share of the plane's input range that the recordings cover, from 0 to 1. What the model
    /// does beyond, no reading says.
    pub covered: f64,
    /// The learners that [`crate::Learner::Auto`] mixes, each with its share of the model; empty
    /// for the other learners. *trend* is the refit, and half as far beyond it as it moved in a
    /// cycle.
    pub shares: Vec<(&'static str, f64)>,
    /// Whether the model is the one before with another offset, gain and shift, as of another
    /// session, and no mean of learners: from recordings of one loop at most, where that errs less
    /// than what [`crate::Learner::Auto`] learned, and at most half as much as the model left alone.
    pub session: bool,
    /// Whether the model depended on a load before, and is for one load now: that of the
    /// recordings.
    pub one_load: bool,
    /// What [`crate::Learner::Load`] found; `None` for the other learners.
    pub shift: Option<ShiftFound>,
    /// The options of what learned.
    pub options: EstimatorOptions,
}

/// Errors of the adapting model, taken before it learned from each sample, beside those of the
/// fixed model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Compared {
    /// Errors of the adapting model.
    pub adapting: Errors,
    /// Errors of the model that was not adapted.
    pub fixed: Errors,
}

impl Compared {
    /// By how much the adapting model has larger errors, as a share of the model's range.
    pub(super) fn loss(&self, (off, on): (f64, f64)) -> f64 {
        (self.adapting.rmse - self.fixed.rmse) / (on - off).abs()
    }

    /// Whether what learned says nothing of outputs of that `spread`.
    pub(super) fn says_nothing(&self, spread: f64) -> bool {
        self.adapting.rmse > NOTHING * spread
    }
}

impl Adapted {
    /// Measured minus expected output, for each sample of the recordings.
    #[must_use]
    pub fn errors(&self, recordings: &(impl AsRef<[Recording]> + ?Sized)) -> Vec<f64> {
        let measured = recordings.as_ref().iter().flat_map(|r| &r.output);
        let pairs = measured.zip(&self.output_model);
        pairs.map(|(measured, model)| measured - model).collect()
    }
}
