//! What depends on the kind of parameters: all weights, or the coefficients of a basis.

use super::Method;
use super::least_squares::packed;
use super::memory::Slices;
use super::operators::outputs;
use crate::branch::Turn;
use crate::everett::{fill_row, table_index, table_len};
use crate::memory::Memory;
use crate::model::Model;
use crate::operator::Operator;
use crate::plane::operators;
use crate::scalar::Real;
use crate::state::State;

/// Writes the regressor: the derivative of the output with respect to each parameter. That of the
/// offset is `share`.
pub(super) fn regressor<T, S>(
    slices: &mut Slices<'_, T>,
    operator: Operator,
    levels: usize,
    share: T,
    state: &State<T, S>,
) where
    T: Real,
    S: Memory<Turn<T>>,
{
    let n = slices.phi.len() - 1;
    slices.phi[n] = share;
    if slices.tables.is_empty() {
        outputs(operator, slices.gamma, &mut slices.phi[..n]);
        return;
    }
    let len = table_len(levels);
    slices.phi[..n].fill(T::ZERO);
    state.everett_terms(|index, factor| {
        for (phi, table) in slices.phi.iter_mut().zip(slices.tables.chunks(len)) {
            *phi = *phi + factor * table[index];
        }
    });
    // From Σ μ γ to the sum of the operators' outputs.
    for (phi, table) in slices.phi.iter_mut().zip(slices.tables.chunks(len)) {
        *phi = match operator {
            Operator::Mkp => *phi,
            Operator::Kp | Operator::Relay => *phi + *phi - table[table_index(levels, 0)],
        };
    }
}

/// Writes the model's whole table from the parameters.
pub(super) fn rewrite<T: Real, C: Memory<T>>(
    slices: &Slices<'_, T>,
    levels: usize,
    model: &mut Model<T, C>,
) {
    let Slices { theta, tables, .. } = slices;
    if tables.is_empty() {
        model.rewrite(|p, above, row| fill_row(p, theta, above, row));
        return;
    }
    model.rewrite(|p, _, row| {
        row.fill(T::ZERO);
        for (&coefficient, table) in theta.iter().zip(tables.chunks(table_len(levels))) {
            let member = &table[table_index(p, 0)..];
            for (entry, &member) in row.iter_mut().zip(member) {
                *entry = *entry + coefficient * member;
            }
        }
    });
}

/// Writes the covariance at the start, for methods that have one.
pub(super) fn start_covariance<T: Real>(
    slices: &mut Slices<'_, T>,
    levels: usize,
    method: Method<T>,
) {
    let Method::LeastSquares {
        spread,
        correlation,
        ..
    } = method
    else {
        return;
    };
    let variance = spread * spread;
    slices.start.fill(T::ZERO);
    for n in 0..slices.theta.len() {
        slices.start[packed(n, n)] = variance;
    }
    if slices.tables.is_empty() && correlation > T::ZERO {
        let square = |n: usize| T::from_index(n) * T::from_index(n);
        let mut entries = slices.start.iter_mut();
        for (a, (i, j)) in operators(levels).enumerate() {
            for ((k, l), entry) in operators(levels).take(a + 1).zip(entries.by_ref()) {
                let distance = square(i.abs_diff(k)) + square(j.abs_diff(l));
                *entry = variance / (T::ONE + distance / (correlation * correlation));
            }
        }
    }
}
