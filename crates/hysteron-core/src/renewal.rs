//! Weights that change while a model runs.

use crate::branch::Turn;
use crate::error::Error;
use crate::everett;
use crate::memory::Memory;
use crate::model::Model;
use crate::plane::operator_index;
use crate::scalar::Real;
use crate::state::State;

impl<T: Real, C: Memory<T>> Model<T, C> {
    /// Replaces the weights. `O(K²)`. States of the model have to be [rebased](Model::rebase)
    /// afterwards.
    ///
    /// # Errors
    /// As [`Model::new`] for the weights. The model then stays as it is.
    ///
    /// ```
    /// use hysteron_core::{Model, Operator, Plane, Turn, table_len, turn_capacity};
    /// let plane = Plane::new(0.0, 1.0, 2)?;
    /// let mut model = Model::new(plane, Operator::Mkp, &[1.0, 2.0, 4.0], [0.0; table_len(2)])?;
    /// let mut state = model.state([Turn::default(); turn_capacity(2)])?;
    /// model.step(&mut state, 1.0)?;
    /// model.set_weights(&[1.0, 1.0, 1.0])?;
    /// model.rebase(&mut state)?; // the operators stay as they are
    /// assert_eq!(model.output(&state), 3.0);
    /// # Ok::<(), hysteron_core::Error>(())
    /// ```
    pub fn set_weights(&mut self, weights: &[T]) -> Result<(), Error> {
        let levels = self.plane().levels();
        self.negative = everett::check(levels, weights)?;
        self.renewed = 1;
        everett::fill(levels, weights, &mut self.table.as_mut()[self.base..]);
        self.changed();
        Ok(())
    }

    /// Writes the whole table: `row(p, above, row)` computes row `p` from the row above it.
    ///
    /// The weights of the new table must not be negative. They may overflow; [`Model::is_finite`]
    /// tells whether they did.
    pub(crate) fn rewrite(&mut self, mut row: impl FnMut(usize, &[T], &mut [T])) {
        let levels = self.plane().levels();
        let table = &mut self.table.as_mut()[self.base..];
        for p in 1..=levels {
            let (above, here) = everett::rows(table, p);
            row(p, above, here);
        }
        self.negative = None;
        self.renewed = 1;
        self.changed();
    }

    /// Makes the table `Σ_k factors[k] · parts[k]`, entry by entry, for factors from 0 on. Rounding
    /// keeps the order of entries, so the inverse stays exact.
    pub(crate) fn blend<P: AsRef<[T]>>(&mut self, parts: &[P], factors: &[T]) {
        let len = everett::table_len(self.plane().levels());
        let base = self.base;
        let table = &mut self.table.as_mut()[base..base + len];
        table.fill(T::ZERO);
        // Part by part, so that the compiler can vectorise it. Each entry has the same sum.
        for (part, &factor) in parts.iter().zip(factors) {
            for (entry, &own) in table.iter_mut().zip(part.as_ref()) {
                *entry = *entry + factor * own;
            }
        }
        self.changed();
    }

    /// Writes the next row of the second table. After the last row the model uses that table.
    /// Returns whether it changed over. `O(K)`.
    ///
    /// Until then the model keeps its table. So at each instant it is the model of weights that are
    /// finite and not negative. Each table is summed from the weights, so rounding errors do not
    /// add up from table to table.
    ///
    /// # Errors
    /// [`Error::WeightNotFinite`] where the weights of the rows so far overflow. The next call
    /// starts with the first row again.
    pub(crate) fn renew_row(
        &mut self,
        mut row: impl FnMut(usize, &[T], &mut [T]),
    ) -> Result<bool, Error> {
        let levels = self.plane().levels();
        let len = everett::table_len(levels);
        let other = len - self.base;
        let table = &mut self.table.as_mut()[other..other + len];
        table[0] = T::ZERO;
        let (above, here) = everett::rows(table, self.renewed);
        row(self.renewed, above, here);
        if !(here[0] + here[0]).is_finite() {
            let index = operator_index(1, self.renewed);
            self.renewed = 1;
            return Err(Error::WeightNotFinite { index });
        }
        self.renewed += 1;
        if self.renewed <= levels {
            return Ok(false);
        }
        self.base = other;
        self.renewed = 1;
        self.negative = None;
        self.changed();
        Ok(true)
    }

    /// Whether the memory holds the second table that [`Model::renew_row`] needs.
    pub(crate) fn check_renewable(&self) -> Result<(), Error> {
        let needed = 2 * everett::table_len(self.plane().levels());
        let found = self.table.as_ref().len();
        if found < needed {
            return Err(Error::MemoryTooSmall { needed, found });
        }
        Ok(())
    }

    fn changed(&mut self) {
        // With an odd increment, 2⁶⁴ changes pass before a stamp comes again. This increment
        // spreads the stamps (Knuth 1997, section 6.4).
        self.stamp = self.stamp.wrapping_add(0x9e37_79b9_7f4a_7c15);
    }
}

impl<T: Real, C: AsRef<[T]>> Model<T, C> {
    /// Recomputes the outputs in `state` with the weights of this model. The operators stay as they
    /// are. `O(K)`.
    ///
    /// The state may be of this model before its weights changed, or of a model with other weights
    /// on the same plane.
    ///
    /// # Errors
    /// [`Error::StateMismatch`] for a state of another size or operator.
    pub fn rebase<S>(&self, state: &mut State<T, S>) -> Result<(), Error>
    where
        S: Memory<Turn<T>>,
    {
        self.fits(state)?;
        state.rebase(self.table(), self.stamp);
        Ok(())
    }

    /// Whether no output can overflow. For models without negative weights.
    pub(crate) fn is_finite(&self) -> bool {
        (self.total() + self.total()).is_finite()
    }
}
