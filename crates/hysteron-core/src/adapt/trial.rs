//! The last good parameters, and how others come to take their place.
//!
//! At the start of each trial the present parameters become the candidate. Through the trial the candidate and the last
//! good ones stand still and predict samples that neither has seen. The candidate is good in turn where it predicts them
//! no worse, so that what was learned in the middle of a burst of wrong readings does not become good as long as the
//! burst is shorter than half a trial.

use crate::scalar::Real;

/// Sums of squares over the samples of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Trial<T> {
    now: T,
    candidate: T,
    good: T,
    /// What rounding alone can make of these.
    rounding: T,
    count: u32,
}

/// Errors of one sample.
#[derive(Clone, Copy)]
pub(super) struct Errors<T> {
    pub(super) now: T,
    pub(super) candidate: T,
    pub(super) good: T,
}

/// Those that stand the trial.
pub(super) struct Contest<'a, T> {
    pub(super) now: &'a mut [T],
    pub(super) candidate: &'a mut [T],
    pub(super) good: &'a mut [T],
}

impl<T: Real> Trial<T> {
    /// Adds a sample; the trial ends after `length` of them. Says whether the present parameters did far worse than the
    /// good ones, with more than four times their mean square, and were taken back.
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
        // Sums that overflow say nothing: an outlier of that size is in all of them.
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

    /// Puts the good parameters in the place of the present ones.
    pub(super) fn roll_back(&mut self) {
        self.now.copy_from_slice(self.good);
        self.candidate.copy_from_slice(self.good);
    }
}
