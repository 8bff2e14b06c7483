//! The last good weights, and how others come to take their place.
//!
//! At the start of each trial the present weights become the candidate. Through the trial the candidate and the last
//! good weights stand still and predict samples that neither has seen. The candidate is good in turn where it predicts them
//! no worse, so that weights learned in the middle of a burst of wrong readings do not become the good ones as long as the
//! burst is shorter than half a trial.

use super::memory::Slices;
use crate::Real;

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
    /// By the present weights.
    pub(super) now: T,
    /// By the candidate.
    pub(super) candidate: T,
    /// By the last good weights.
    pub(super) good: T,
}

impl<T: Real> Trial<T> {
    /// Adds a sample; the trial ends after `length` of them. Says whether the present weights did far worse than the
    /// good ones, with more than four times their mean square, and have to go.
    pub(super) fn judge(
        &mut self,
        slices: &mut Slices<'_, T>,
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
            slices.good.copy_from_slice(slices.candidate);
        }
        let best = candidate.smaller(good);
        if now > T::from_index(4) * (best + rounding) {
            return true;
        }
        slices.candidate.copy_from_slice(slices.theta);
        false
    }
}

/// Takes the present weights as good.
pub(super) fn keep<T: Real>(slices: &mut Slices<'_, T>) {
    slices.good.copy_from_slice(slices.theta);
    slices.candidate.copy_from_slice(slices.theta);
}

/// Puts the good weights in the place of the present ones.
pub(super) fn roll_back<T: Real>(slices: &mut Slices<'_, T>) {
    slices.theta.copy_from_slice(slices.good);
    slices.candidate.copy_from_slice(slices.good);
}
