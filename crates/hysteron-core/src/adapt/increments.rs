//! The gradient on increments: what the output gained while the input crossed some levels is owed to the operators in
//! these rows and columns alone (time-difference scheme, Tan & Baras 2005).

use super::memory::Slices;
use super::operators::{touched, within};
use super::trial::Errors;
use crate::operator::Operator;
use crate::scalar::Real;

/// An increment under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Increment<T> {
    /// The output as measured where it began.
    measured: T,
    /// The position there.
    position: T,
    /// Lowest and highest position since: all rows and columns in which operators can have moved.
    range: (T, T),
}

/// A finished increment, against the present and other weights.
pub(super) struct Finished<T> {
    pub(super) errors: Errors<T>,
    norm: T,
    rows: (usize, usize),
}

impl<T: Real> Increment<T> {
    pub(super) fn start(measured: T, position: T) -> Self {
        Self {
            measured,
            position,
            range: (position, position),
        }
    }

    /// Goes on to `position`; says whether that is `span` levels from where it began. Then the diagonal operators,
    /// which have no memory, have moved by as much, so that the increment says something for sure.
    pub(super) fn extend(&mut self, position: T, span: T) -> bool {
        let (low, high) = self.range;
        self.range = (low.min(position), high.max(position));
        let travelled = position - self.position;
        travelled.max(-travelled) >= span
    }

    /// What the weights say of the increment that ends with `measured`. `O(K)` for each level travelled.
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
    /// Moves the weights of the rows and columns travelled by the share `gain` of `error`, and by `leakage` to the
    /// off-line ones.
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

    /// The next increment begins where this one ends.
    pub(super) fn close(&self, slices: &mut Slices<'_, T>, levels: usize) {
        within(self.rows.0, self.rows.1, levels, |n| {
            slices.anchor[n] = slices.gamma[n];
        });
    }
}

/// What the operators' outputs have changed by since the increment began.
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
