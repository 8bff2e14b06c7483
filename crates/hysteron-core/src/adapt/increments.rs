//! The gradient on increments: what the output gained while the input crossed some levels is owed to the operators in
//! these rows and columns alone (time-difference scheme, Tan & Baras 2005).

use super::memory::Slices;
use super::operators::{touched, within};
use crate::{Operator, Real};

/// An increment under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Increment<T> {
    /// The output as measured where it began.
    began: T,
    /// Lowest and highest position since.
    range: (T, T),
}

/// Errors of a finished increment, by the present and by the last good weights.
pub(super) struct Finished<T> {
    pub(super) error: T,
    pub(super) good: T,
    norm: T,
    rows: (usize, usize),
}

impl<T: Real> Increment<T> {
    pub(super) fn start(measured: T, position: T) -> Self {
        Self {
            began: measured,
            range: (position, position),
        }
    }

    /// Goes on to `position`; says whether `span` levels are travelled.
    pub(super) fn extend(&mut self, position: T, span: T) -> bool {
        let (low, high) = self.range;
        self.range = (low.smaller(position), high.larger(position));
        self.range.1 - self.range.0 >= span
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
        let (mut now, mut good, mut norm) = (T::ZERO, T::ZERO, T::ZERO);
        within(rows.0, rows.1, levels, |n| {
            let phi = change.at(n);
            now = now + slices.theta[n] * phi;
            good = good + slices.good[n] * phi;
            norm = norm + phi * phi;
        });
        let gained = measured - self.began;
        Finished {
            error: gained - now,
            good: gained - good,
            norm,
            rows,
        }
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
        if self.norm <= T::ZERO {
            return;
        }
        let step = gain * error / self.norm;
        within(self.rows.0, self.rows.1, levels, |n| {
            let phi = Change::of(operator, slices).at(n);
            let theta = slices.theta[n];
            let moved = theta + step * phi + leakage * (slices.offline[n] - theta);
            slices.theta[n] = moved.larger(T::ZERO);
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
