//! The gradient on increments (time-difference scheme, Tan & Baras 2005).
//!
//! While the input crosses some levels, only the operators in these rows and columns change. So the
//! change of the output concerns their weights alone.

use super::memory::Slices;
use super::operators::{touched, within};
use super::trial::Errors;
use crate::operator::Operator;
use crate::scalar::Real;

/// An increment under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Increment<T> {
    /// The measured output at its start.
    measured: T,
    /// The normalised position at its start.
    position: T,
    /// Lowest and highest position since. Operators in all rows and columns between may have moved.
    range: (T, T),
}

/// A finished increment, and its errors with the present and with other weights.
pub(super) struct Finished<T> {
    pub(super) errors: Errors<T>,
    /// `φᵀφ` of the changes of the operators' outputs.
    norm: T,
    /// First and last row and column crossed.
    rows: (usize, usize),
}

impl<T: Real> Increment<T> {
    /// An increment that starts here.
    pub(super) fn start(measured: T, position: T) -> Self {
        Self {
            measured,
            position,
            range: (position, position),
        }
    }

    /// Goes on to `position`. Returns whether that is at least `span` levels from its start.
    ///
    /// The operators on the diagonal have no memory. Over such a distance they surely changed, so
    /// the increment has information.
    pub(super) fn extend(&mut self, position: T, span: T) -> bool {
        let (low, high) = self.range;
        self.range = (low.min(position), high.max(position));
        let travelled = position - self.position;
        travelled.max(-travelled) >= span
    }

    /// Finishes the increment with the output `measured` and computes its errors. `O(K)` for each
    /// level crossed.
    pub(super) fn finish(
        &self,
        slices: &Slices<'_, T>,
        operator: Operator,
        levels: usize,
        measured: T,
    ) -> Finished<T> {
        let rows = touched(self.range.0, self.range.1, levels);
        let change = Change::of(operator, slices);
        let gained = measured - self.measured;
        let (mut norm, mut now, mut candidate, mut good) = (T::ZERO, gained, gained, gained);
        within(rows.0, rows.1, levels, |n| {
            let phi = change.at(n);
            norm = norm + phi * phi;
            now = now - slices.theta[n] * phi;
            candidate = candidate - slices.candidate[n] * phi;
            good = good - slices.good[n] * phi;
        });
        let errors = Errors {
            now,
            candidate,
            good,
        };
        Finished { errors, norm, rows }
    }
}

impl<T: Real> Finished<T> {
    /// Moves the weights of the rows and columns crossed, `θ ← θ + g φ e/(φᵀφ) + l (θ₀ − θ)`, with
    /// gain `g`, leakage `l` and off-line weights `θ₀`. Weights stay at zero or above.
    pub(super) fn update(
        &self,
        slices: &mut Slices<'_, T>,
        operator: Operator,
        levels: usize,
        error: T,
        (gain, leakage): (T, T),
    ) {
        let step = gain * error / self.norm;
        within(self.rows.0, self.rows.1, levels, |n| {
            let phi = Change::of(operator, slices).at(n);
            let theta = slices.theta[n];
            let moved = theta + step * phi + leakage * (slices.offline[n] - theta);
            if moved.is_finite() {
                slices.theta[n] = moved.max(T::ZERO);
            }
        });
    }

    /// Keeps the operators' states as the start of the next increment.
    pub(super) fn close(&self, slices: &mut Slices<'_, T>, levels: usize) {
        within(self.rows.0, self.rows.1, levels, |n| {
            slices.anchor[n] = slices.gamma[n];
        });
    }
}

/// The change of the operators' outputs since the increment began.
struct Change<'a, T> {
    gamma: &'a [T],
    anchor: &'a [T],
    factor: T,
}

impl<'a, T: Real> Change<'a, T> {
    fn of(operator: Operator, slices: &'a Slices<'_, T>) -> Self {
        Self {
            gamma: slices.gamma,
            anchor: slices.anchor,
            factor: operator.output(T::ONE) - operator.output(T::ZERO),
        }
    }

    fn at(&self, n: usize) -> T {
        self.factor * (self.gamma[n] - self.anchor[n])
    }
}
