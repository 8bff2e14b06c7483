//! The last good parameters, and the trial by which others replace them.
//!
//! At the start of each trial the present parameters become the candidate. During the trial the
//! candidate and the last good parameters do not change, and both predict samples that neither has
//! learned from. At the end the candidate becomes the good one if it predicted no worse. So
//! parameters from within a burst of wrong readings do not become good, as long as the burst is
//! shorter than half a trial.

use crate::scalar::Real;

/// Sums of squared errors over the samples of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Trial<T> {
    now: T,
    candidate: T,
    good: T,
    /// The sum that rounding errors alone can give.
    rounding: T,
    count: u32,
}

/// Prediction errors of one sample, with each set of parameters.
#[derive(Clone, Copy)]
pub(super) struct Errors<T> {
    pub(super) now: T,
    pub(super) candidate: T,
    pub(super) good: T,
}

/// The sets of parameters in a trial.
pub(super) struct Contest<'a, T> {
    pub(super) now: &'a mut [T],
    pub(super) candidate: &'a mut [T],
    pub(super) good: &'a mut [T],
}

impl<T: Real> Trial<T> {
    /// Adds a sample. The trial ends after `length` samples. Returns whether the good parameters
    /// replaced the present ones, because these had more than four times the mean square error.
    pub(super) fn judge(
        &mut self,
        contest: &mut Contest<'_, T>,
        errors: Errors<T>,
        measured: T,
        length: u32,
    ) -> bool {
        let rounding = T::from_index(256) * T::EPSILON * measured;
        self.now = self.now + errors.now * errors.now;
        self.candidate = self.candidate + errors.candidate * errors.candidate;
        self.good = self.good + errors.good * errors.good;
        self.rounding = self.rounding + rounding * rounding;
        self.count += 1;
        if self.count < length {
            return false;
        }
        let Self {
            now,
            candidate,
            good,
            rounding,
            ..
        } = core::mem::take(self);
        // Sums that overflow give no answer: the outlier is in all of them.
        if candidate <= good && candidate.is_finite() {
            contest.good.copy_from_slice(contest.candidate);
        }
        let worse = now > T::from_index(4) * (candidate.min(good) + rounding);
        if worse {
            contest.roll_back();
        } else {
            contest.candidate.copy_from_slice(contest.now);
        }
        worse
    }
}

impl<T: Real> Contest<'_, T> {
    /// Takes the present parameters as good.
    pub(super) fn keep(&mut self) {
        self.good.copy_from_slice(self.now);
        self.candidate.copy_from_slice(self.now);
    }

    /// Replaces the present parameters by the good ones.
    pub(super) fn roll_back(&mut self) {
        self.now.copy_from_slice(self.good);
        self.candidate.copy_from_slice(self.good);
    }
}
