//! The last good weights, and the trial that the present ones are put to.

use super::memory::Slices;
use crate::Real;

/// Errors of the present and of the last good parameters on the same samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Trial<T> {
    now: T,
    good: T,
    count: u32,
}

/// What a trial comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It goes on, or decided nothing.
    Open,
    /// The present parameters are the better ones.
    Keep,
    /// They are far worse.
    RollBack,
}

impl<T: Real> Trial<T> {
    /// Adds the errors of one sample; after `length` of them comes the verdict: kept where no worse, rolled
    /// back where the mean square is more than four times as large.
    pub(super) fn judge(&mut self, now: T, good: T, length: u32) -> Verdict {
        self.now = self.now + now * now;
        self.good = self.good + good * good;
        self.count += 1;
        if self.count < length {
            return Verdict::Open;
        }
        let Self { now, good, .. } = core::mem::take(self);
        if now <= good {
            Verdict::Keep
        } else if now > T::from_index(4) * good {
            Verdict::RollBack
        } else {
            Verdict::Open
        }
    }
}

pub(super) fn keep<T: Real>(slices: &mut Slices<'_, T>) {
    slices.good.copy_from_slice(slices.theta);
}

pub(super) fn roll_back<T: Real>(slices: &mut Slices<'_, T>) {
    slices.theta.copy_from_slice(slices.good);
}
