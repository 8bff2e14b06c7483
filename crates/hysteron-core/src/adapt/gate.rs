//! Readings that are not learned from, because they differ too much from what was expected.
//!
//! What counts is the *surprise*: the error of a prediction less the error that the last reading
//! believed left behind. What a model says wrongly again and again, on a branch that it knows
//! badly, is no surprise, however large.
//!
//! The scale is a running mean of the sizes of those surprises that were believed, so that no wrong
//! reading is in it. Two ways lead back for a plant that is not what it was. Readings refused in a
//! row that agree with each other are a jump, and believed. Those that do not agree are noise that
//! has grown, and the scale follows it step by step.

use super::Adaptation;
use crate::model::Model;
use crate::scalar::Real;

/// Surprises that the mean remembers. A branch takes some hundred samples, and its scale is not
/// that of the next one.
const MEMORY: usize = 64;
/// The scale at the start, in shares of the model's range: usual errors of a fitted model. Worse
/// ones wait for the way back.
const AT_START: usize = 50;
/// The least scale, in shares of the model's range. Where there is no noise, the scale would vanish
/// and rounding be refused; readings within a gate of this scale do no harm.
const LEAST: usize = 1000;

/// What has been seen of the errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gate<T> {
    range: T,
    scale: T,
    /// The error that was left after the last reading believed.
    left: T,
    /// The surprise of the last reading refused.
    last: T,
    /// Readings refused in a row, since the scale last changed for them.
    refused: u32,
    /// The last of them that agree.
    agreeing: u32,
}

impl<T: Real> Gate<T> {
    /// Nothing has been seen of the model's errors.
    pub(super) fn over<C: AsRef<[T]>>(model: &Model<T, C>) -> Self {
        let (off, on) = model.output_range();
        Self::new(on - off)
    }

    /// Nothing has been seen, and the model's output has this range.
    pub(super) fn new(range: T) -> Self {
        Self {
            range,
            scale: range / T::from_index(AT_START),
            left: T::ZERO,
            last: T::ZERO,
            refused: 0,
            agreeing: 0,
        }
    }

    /// Forgets all errors: those of other weights.
    pub(super) fn restart(&mut self) {
        *self = Self::new(self.range);
    }

    /// Whether a reading is believed whose prediction has this `error`.
    pub(super) fn believes(&mut self, error: T, options: &Adaptation<T>) -> bool {
        if options.gate == T::ZERO {
            return true;
        }
        let surprise = error - self.left;
        let size = surprise.max(-surprise);
        // Without a range there is nothing to measure by before the first surprise.
        if size <= options.gate * self.scale || self.scale == T::ZERO {
            self.believe(self.scale + (size - self.scale) / T::from_index(MEMORY));
            return true;
        }
        let agrees = self.agreeing > 0 && agree(surprise, self.last);
        self.agreeing = if agrees { self.agreeing + 1 } else { 1 };
        self.refused += 1;
        self.last = surprise;
        if self.agreeing >= options.burst {
            self.believe(size);
            return true;
        }
        if self.refused >= options.burst {
            self.refused = 0;
            self.rescale(self.scale + self.scale);
        }
        false
    }

    /// What a reading that was believed has left of its error.
    pub(super) fn settle(&mut self, left: T) {
        self.left = if left.is_finite() { left } else { T::ZERO };
    }

    fn believe(&mut self, scale: T) {
        (self.refused, self.agreeing) = (0, 0);
        self.rescale(scale);
    }

    fn rescale(&mut self, scale: T) {
        if scale.is_finite() {
            self.scale = scale.max(self.range / T::from_index(LEAST));
        }
    }
}

/// Whether two surprises are of one jump: they differ by at most half of the larger one.
fn agree<T: Real>(a: T, b: T) -> bool {
    let size = |x: T| x.max(-x);
    size(a - b) <= T::HALF * size(a).max(size(b))
}
