//! How an estimator is made.

use super::estimator::Estimator;
use super::gate::Gate;
use super::memory::Layout;
use super::trial::Trial;
use super::watch::Watch;
use super::{Adaptation, Method, least_squares, parameters};
use crate::error::Error;
use crate::everett;
use crate::memory::Memory;
use crate::model::Model;
use crate::plane::operator_count;
use crate::scalar::Real;

impl<T: Real, M: Memory<T>> Estimator<T, M> {
    /// An estimator of all weights and the offset.
    ///
    /// It starts from the off-line `weights` (`N = K(K + 1)/2`, row by row) and `offset`, both in
    /// the output's unit, and writes these weights to `model`. `memory` has at least
    /// [`estimator_len`](crate::estimator_len) elements.
    ///
    /// # Errors
    /// [`Error::Adaptation`] for options out of range, [`Error::WeightCount`],
    /// [`Error::WeightNotFinite`], [`Error::NegativeWeights`], [`Error::InputNotFinite`] for the
    /// offset. [`Error::MemoryTooSmall`] for `memory` and, with [`Method::Increments`], for the
    /// model's memory: that method needs room for two tables.
    pub fn new<C: Memory<T>>(
        options: Adaptation<T>,
        model: &mut Model<T, C>,
        weights: &[T],
        offset: T,
        memory: M,
    ) -> Result<Self, Error> {
        let levels = model.plane().levels();
        let layout = Layout::all(levels, options.method);
        let mut estimator = Self::empty(options, model, layout, offset, memory)?;
        if matches!(options.method, Method::Increments { .. }) {
            model.check_renewable()?;
        }
        refuse_negative(levels, weights)?;
        estimator.begin(weights);
        model.set_weights(weights)?;
        estimator.guard(model);
        Ok(estimator)
    }

    /// An estimator of the coefficients of a basis, and of the offset: `μ = Σ_k coefficients_k
    /// basis_k`.
    ///
    /// The members of the basis stand for the ways in which the weights can change (load, drift).
    /// `basis` has `N = K(K + 1)/2` weights for each of the `P` coefficients, one member after the
    /// other. `memory` has at least [`estimator_len_of_basis`](crate::estimator_len_of_basis)
    /// elements. A step takes `O(P K²)` for the table.
    ///
    /// # Errors
    /// As [`Estimator::new`]. [`Error::Adaptation`] also for [`Method::Increments`], for a
    /// correlation above 0, and for coefficients that are none, negative, not finite, or too large
    /// for their members.
    pub fn of_basis<C: Memory<T>>(
        options: Adaptation<T>,
        model: &mut Model<T, C>,
        basis: &[T],
        coefficients: &[T],
        offset: T,
        memory: M,
    ) -> Result<Self, Error> {
        let levels = model.plane().levels();
        let (n, count) = (operator_count(levels), coefficients.len());
        let fit = |c: &T| *c >= T::ZERO && c.is_finite();
        let unfit = match options.method {
            Method::Increments { .. } => Some("method"),
            Method::LeastSquares { correlation, .. } if correlation != T::ZERO => {
                Some("correlation")
            }
            _ if count == 0 || !coefficients.iter().all(fit) => Some("coefficients"),
            _ => None,
        };
        if let Some(option) = unfit {
            return Err(Error::Adaptation { option });
        }
        if basis.len() != n * count {
            let (expected, found) = (n * count, basis.len());
            return Err(Error::WeightCount { expected, found });
        }
        let layout = Layout::basis(levels, options.method, count);
        let mut estimator = Self::empty(options, model, layout, offset, memory)?;
        let len = everett::table_len(levels);
        let tables = estimator.slices().tables;
        let mut size = T::ZERO;
        for ((member, table), &coefficient) in basis
            .chunks(n)
            .zip(tables.chunks_mut(len))
            .zip(coefficients)
        {
            refuse_negative(levels, member)?;
            everett::fill(levels, member, table);
            size = size + coefficient * table[everett::table_index(levels, 0)];
        }
        if !(size + size).is_finite() {
            return Err(Error::Adaptation {
                option: "coefficients",
            });
        }
        estimator.begin(coefficients);
        estimator.rewrite(model);
        estimator.guard(model);
        Ok(estimator)
    }

    /// Checks options and memory. The parameters are not written yet.
    fn empty<C: AsRef<[T]>>(
        options: Adaptation<T>,
        model: &Model<T, C>,
        layout: Layout,
        offset: T,
        memory: M,
    ) -> Result<Self, Error> {
        options.check()?;
        if !offset.is_finite() {
            return Err(Error::InputNotFinite { index: 0 });
        }
        let (needed, found) = (layout.len(), memory.as_ref().len());
        if found < needed {
            return Err(Error::MemoryTooSmall { needed, found });
        }
        Ok(Self {
            options,
            operator: model.operator(),
            levels: model.plane().levels(),
            layout,
            memory,
            offset,
            aligned: None,
            learned: T::ZERO,
            increment: None,
            rows_due: 0,
            trial: Trial::default(),
            level: Trial::default(),
            gate: Gate::new(T::ZERO),
            watch: Watch::new(T::ZERO, T::ZERO),
            expected: T::ZERO,
            undone: false,
            frozen: false,
        })
    }

    /// Sets the guards up for the range of `model`.
    fn guard<C: AsRef<[T]>>(&mut self, model: &Model<T, C>) {
        let (off, on) = model.output_range();
        (self.gate, self.watch) = (
            Gate::new(on - off),
            Watch::new(on - off, T::from_index(self.levels)),
        );
    }

    /// Writes the off-line parameters, and what follows from them.
    fn begin(&mut self, parameters: &[T]) {
        let (levels, method) = (self.levels, self.options.method);
        let mut slices = self.slices();
        let n = parameters.len();
        slices.theta[..n].copy_from_slice(parameters);
        slices.theta[n] = T::ZERO;
        slices.offline.copy_from_slice(slices.theta);
        slices.good.copy_from_slice(slices.theta);
        slices.candidate.copy_from_slice(slices.theta);
        slices.trusted.copy_from_slice(slices.theta);
        slices.pending.copy_from_slice(slices.theta);
        parameters::start_covariance(&mut slices, levels, method);
        least_squares::restart(&mut slices);
    }
}

fn refuse_negative<T: Real>(levels: usize, weights: &[T]) -> Result<(), Error> {
    match everett::check(levels, weights)? {
        Some(which) => Err(Error::NegativeWeights(which)),
        None => Ok(()),
    }
}
