//! The states of all operators, updated with every sample. They are the regressor of an estimator
//! of all weights.

use crate::branch::Turn;
use crate::memory::Memory;
use crate::operator::Operator;
use crate::operator::{mkp, ridge};
use crate::plane::operator_index;
use crate::scalar::Real;
use crate::state::State;

/// The first and the last row or column whose ridge a move from `x` to `to` touches. They are as
/// many as the grid lines crossed, and one more.
pub(super) fn touched<T: Real>(x: T, to: T, levels: usize) -> (usize, usize) {
    let cell = |x: T| x.floor_index().min(levels - 1) + 1;
    (cell(x.min(to)), cell(x.max(to)))
}

/// Moves the states `gamma` from the normalised position `x` to `to`, equation (5). `O(K)` for each
/// level crossed. Returns the change of `Σ weights γ`.
///
/// A rising input changes only rows, a falling one only columns.
pub(super) fn follow<T: Real>(gamma: &mut [T], weights: &[T], levels: usize, x: T, to: T) -> T {
    let (first, last) = touched(x, to, levels);
    let mut change = T::ZERO;
    let mut lead = |n: usize, limit: fn(T, T) -> T, to: T| {
        let moved = limit(gamma[n], to);
        change = change + weights[n] * (moved - gamma[n]);
        gamma[n] = moved;
    };
    if to > x {
        for j in first..=last {
            let on = ridge(to, j);
            for i in 1..=j {
                lead(operator_index(i, j), T::max, on);
            }
        }
    } else if to < x {
        for i in first..=last {
            let off = ridge(to, i);
            for j in i..=levels {
                lead(operator_index(i, j), T::min, off);
            }
        }
    }
    change
}

/// Computes the states of all operators from the turning points of `state`. `O(K²)` for each
/// turning point.
pub(super) fn align<T, S>(gamma: &mut [T], levels: usize, state: &State<T, S>)
where
    T: Real,
    S: Memory<Turn<T>>,
{
    gamma.fill(T::ZERO);
    for x in state.turning_points() {
        for j in 1..=levels {
            for i in 1..=j {
                let gamma = &mut gamma[operator_index(i, j)];
                *gamma = mkp(*gamma, x, i, j);
            }
        }
    }
}

/// Writes the operators' outputs to `phi`: the regressor of all weights.
pub(super) fn outputs<T: Real>(operator: Operator, gamma: &[T], phi: &mut [T]) {
    for (phi, &gamma) in phi.iter_mut().zip(gamma) {
        *phi = operator.output(gamma);
    }
}

/// Calls `visit(index)` once for each operator in the rows and columns `first..=last`. A move over
/// these levels changes no other operators.
pub(super) fn within(first: usize, last: usize, levels: usize, mut visit: impl FnMut(usize)) {
    for j in first..=last {
        for i in 1..=j {
            visit(operator_index(i, j));
        }
    }
    for j in last + 1..=levels {
        for i in first..=last {
            visit(operator_index(i, j));
        }
    }
}
