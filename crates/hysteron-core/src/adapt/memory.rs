//! The arrays of an estimator, in one block of memory of the caller.

use core::ops::Range;

use super::trial::Contest;
use crate::adapt::Method;
use crate::everett::table_len;
use crate::plane::operator_count;

/// Number of elements of memory for an [`crate::Estimator`] of all weights
/// ([`Estimator::new`](crate::Estimator::new)).
#[must_use]
pub const fn estimator_len<T: Copy>(levels: usize, method: Method<T>) -> usize {
    Layout::all(levels, method).len()
}

/// Number of elements of memory for an [`crate::Estimator`] of the coefficients of a basis
/// ([`Estimator::of_basis`](crate::Estimator::of_basis)) with `count` members.
#[must_use]
pub const fn estimator_len_of_basis<T: Copy>(
    levels: usize,
    method: Method<T>,
    count: usize,
) -> usize {
    Layout::basis(levels, method, count).len()
}

/// The lengths of the arrays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    /// Number of parameters. The offset is the last one.
    pub(super) parameters: usize,
    gamma: usize,
    anchor: usize,
    covariance: usize,
    tables: usize,
}

/// The arrays.
pub(super) struct Slices<'a, T> {
    /// The present parameters.
    pub(super) theta: &'a mut [T],
    /// The off-line parameters.
    pub(super) offline: &'a mut [T],
    /// The last good parameters.
    pub(super) good: &'a mut [T],
    /// The parameters on trial to become the good ones.
    pub(super) candidate: &'a mut [T],
    /// The parameters before the last piece of the watch in which the output moved.
    pub(super) trusted: &'a mut [T],
    /// The parameters before the present piece.
    pub(super) pending: &'a mut [T],
    /// The regressor: the derivative of the output with respect to each parameter.
    pub(super) phi: &'a mut [T],
    /// The operators' states; empty with a basis.
    pub(super) gamma: &'a mut [T],
    /// The operators' states at the start of the increment; empty for other methods.
    pub(super) anchor: &'a mut [T],
    /// The lower triangle of the covariance; empty for other methods.
    pub(super) covariance: &'a mut [T],
    /// The covariance at the start; empty for other methods.
    pub(super) start: &'a mut [T],
    /// Covariance times regressor; empty for other methods.
    pub(super) gain: &'a mut [T],
    /// The parameters of least squares, before the remaining negative ones are set to zero; empty
    /// for other methods.
    pub(super) estimate: &'a mut [T],
    /// The Everett tables of the members of the basis, one after the other; empty without a basis.
    pub(super) tables: &'a mut [T],
}

impl Layout {
    /// For an estimator of all weights.
    pub(super) const fn all<T: Copy>(levels: usize, method: Method<T>) -> Self {
        let n = operator_count(levels);
        let anchor = match method {
            Method::Increments { .. } => n,
            _ => 0,
        };
        Self {
            parameters: n + 1,
            gamma: n,
            anchor,
            covariance: Self::covariance(n + 1, method),
            tables: 0,
        }
    }

    /// For an estimator of the coefficients of a basis with `count` members.
    pub(super) const fn basis<T: Copy>(levels: usize, method: Method<T>, count: usize) -> Self {
        Self {
            parameters: count + 1,
            gamma: 0,
            anchor: 0,
            covariance: Self::covariance(count + 1, method),
            tables: count * table_len(levels),
        }
    }

    const fn covariance<T: Copy>(parameters: usize, method: Method<T>) -> usize {
        match method {
            Method::LeastSquares { .. } => operator_count(parameters),
            _ => 0,
        }
    }

    const fn gain(self) -> usize {
        if self.covariance > 0 {
            self.parameters
        } else {
            0
        }
    }

    /// Length of all arrays together.
    pub(super) const fn len(self) -> usize {
        7 * self.parameters
            + self.gamma
            + self.anchor
            + 2 * self.covariance
            + 2 * self.gain()
            + self.tables
    }

    /// Divides `memory`, which has at least [`Layout::len`] elements, into the arrays.
    pub(super) fn cut<T>(self, memory: &mut [T]) -> Slices<'_, T> {
        let mut rest = memory;
        let mut next = |count: usize| {
            let (here, after) = core::mem::take(&mut rest).split_at_mut(count);
            rest = after;
            here
        };
        Slices {
            theta: next(self.parameters),
            offline: next(self.parameters),
            good: next(self.parameters),
            candidate: next(self.parameters),
            trusted: next(self.parameters),
            pending: next(self.parameters),
            phi: next(self.parameters),
            gamma: next(self.gamma),
            anchor: next(self.anchor),
            covariance: next(self.covariance),
            start: next(self.covariance),
            gain: next(self.gain()),
            estimate: next(self.gain()),
            tables: next(self.tables),
        }
    }
}

impl<T> Slices<'_, T> {
    /// The parameters `which`, for a trial.
    pub(super) fn contest(&mut self, which: Range<usize>) -> Contest<'_, T> {
        Contest {
            now: &mut self.theta[which.clone()],
            candidate: &mut self.candidate[which.clone()],
            good: &mut self.good[which],
        }
    }
}
