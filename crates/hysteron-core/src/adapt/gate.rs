//! Readings that are not learned from, because they differ too much from what was expected.
//!
//! What counts is the *surprise*: the error of a prediction less the error that the last reading believed left behind. What a
//! model says wrongly again and again, on a branch that it knows badly, is no surprise, however large.
//!
//! The scale is a running mean of the surprises' sizes, in which one beyond the gate counts as the gate. So a wrong
//! reading raises the scale by the same small factor whatever its size, and noise that grows for good is followed. Readings
//! beyond the gate that agree with each other for long enough are a jump of the plant, and believed.

use super::Adaptation;
use crate::{Model, Real};

/// Surprises that the mean remembers. A branch takes some hundred samples, and its scale is not that of the next one.
const MEMORY: usize = 64;
/// The scale at the start, in shares of the model's range: usual errors of a fitted model. Worse ones wait for the way back.
const AT_START: usize = 50;
/// The least scale, in shares of the model's range. Where there is no noise, the scale would vanish and rounding be refused;
/// readings within a gate of this scale do no harm.
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
    /// Readings refused one after the other that agree.
    run: u32,
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
            run: 0,
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
        let size = surprise.larger(-surprise);
        let limit = options.gate * self.scale;
        // Without a range there is nothing to measure by before the first surprise.
        if size <= limit || self.scale == T::ZERO {
            self.run = 0;
            self.remember(size);
            return true;
        }
        self.remember(limit);
        self.run = if agree(surprise, self.last) {
            self.run + 1
        } else {
            1
        };
        self.last = surprise;
        let jump = self.run >= options.burst;
        if jump {
            self.run = 0;
            self.scale = size;
        }
        jump
    }

    /// What a reading that was believed has left of its error.
    pub(super) fn settle(&mut self, left: T) {
        self.left = if left.is_finite() { left } else { T::ZERO };
    }

    fn remember(&mut self, size: T) {
        let scale = self.scale + (size - self.scale) / T::from_index(MEMORY);
        if scale.is_finite() {
            self.scale = scale.larger(self.range / T::from_index(LEAST));
        }
    }
}

/// Whether two surprises are of one jump: they differ by at most half of the larger one.
fn agree<T: Real>(a: T, b: T) -> bool {
    let size = |x: T| x.larger(-x);
    size(a - b) <= T::HALF * size(a).larger(size(b))
}
