//! Weights that depend on the load, as parts and the load that a model is at.

use crate::branch::Turn;
use crate::error::Error;
use crate::everett::table_len;
use crate::memory::Memory;
use crate::model::Model;
use crate::scalar::Real;
use crate::stages::constant::Range;
use crate::stages::mix::mix;
use crate::state::State;

/// The largest number of parts.
pub const MAX_PARTS: usize = 8;

/// Writes the values of the Bernstein polynomials at `s` in `[0, 1]`, by de Casteljau's algorithm.
/// Their degree is one less than the number of `values`.
///
/// They are not negative and sum to one. So non-negative coefficients give non-negative weights at
/// every load in the range (Farouki 2012).
///
/// ```
/// let mut values = [0.0; 3];
/// hysteron_core::bernstein(0.5, &mut values);
/// assert_eq!(values, [0.25, 0.5, 0.25]);
/// ```
pub fn bernstein<T: Real>(s: T, values: &mut [T]) {
    for n in 0..values.len() {
        let Some(before) = n.checked_sub(1) else {
            values[0] = T::ONE;
            continue;
        };
        values[n] = s * values[before];
        for k in (1..n).rev() {
            values[k] = s * values[k - 1] + (T::ONE - s) * values[k];
        }
        values[0] = (T::ONE - s) * values[0];
    }
}

/// Weights and offset that depend on the load: `Σ_k μ_k B_k(σ)` with the
/// [Bernstein polynomials](bernstein) of the load, scaled to its range.
///
/// The first part is the model at the smallest load, the last one that at the largest.
///
/// ```
/// use hysteron_core::{Model, Operator, Parts, Plane, Turn, table_len, turn_capacity};
/// let plane = Plane::new(1.0, 2.0, 2)?;
/// const N: usize = table_len(2);
/// let mut tables = [0.0; 2 * N];
/// Model::new(plane, Operator::Mkp, &[1.0; 3], &mut tables[..N])?;
/// Model::new(plane, Operator::Mkp, &[3.0; 3], &mut tables[N..])?;
/// let parts = Parts { range: (0.0, 100.0), offsets: &[0.0, 1.0], tables: &tables };
/// let mut model = Model::new(plane, Operator::Mkp, &[0.0; 3], [0.0; N])?;
/// parts.check(&model)?;
///
/// let mut state = model.state([Turn::default(); turn_capacity(2)])?;
/// let mut placed = None;
/// model.step(&mut state, 2.0)?; // all operators on
/// let offset = parts.place(&mut model, &mut state, &mut placed, Some(50.0))?;
/// assert_eq!((offset, model.output(&state)), (0.5, 6.0));
/// # Ok::<(), hysteron_core::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parts<'a, T> {
    /// Smallest and largest load.
    pub range: (T, T),
    /// The output of each part where its sum is zero.
    pub offsets: &'a [T],
    /// The Everett tables ([`Model::table`]) of the parts, one after the other.
    pub tables: &'a [T],
}

/// The load that a model is at, by [`Parts::place`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed<T> {
    load: T,
    offset: T,
    stamp: u64,
}

impl<T: Real> Parts<'_, T> {
    /// Checks the parts, for operators on the plane of `model`.
    ///
    /// # Errors
    /// [`Error::Stage`] with `parts`, or with `load` for a range that is empty.
    pub fn check<C: AsRef<[T]>>(&self, model: &Model<T, C>) -> Result<(), Error> {
        let (low, high) = self.range;
        let count = self.offsets.len();
        let sizes = |numbers: &[T]| numbers.iter().all(|number| Range::Size.has(*number));
        if !(Range::Size.has(low) && Range::Size.has(high) && Range::Slope.has(high - low)) {
            return Err(Error::Stage { stage: "load" });
        }
        let fits = (1..=MAX_PARTS).contains(&count)
            && self.tables.len() == count * table_len(model.plane().levels());
        match fits && sizes(self.offsets) && sizes(self.tables) {
            true => Ok(()),
            false => Err(Error::Stage { stage: "parts" }),
        }
    }

    /// Makes `model` that of a load, brings `state` along, and returns the offset at that load.
    /// Loads outside the range act as its ends.
    ///
    /// `placed` is what the call before left there, `None` at first. The weights are mixed only
    /// where the load has changed: `O(d K²)` for `d` parts. Otherwise a call costs `O(1)`. The
    /// operators in `state` stay as they are.
    ///
    /// # Errors
    /// [`Error::Load`] where the load is missing or not finite, [`Error::StateMismatch`], and as
    /// [`Parts::check`] for the number of parts.
    pub fn place<C, S>(
        &self,
        model: &mut Model<T, C>,
        state: &mut State<T, S>,
        placed: &mut Option<Placed<T>>,
        load: Option<T>,
    ) -> Result<T, Error>
    where
        C: Memory<T>,
        S: Memory<Turn<T>>,
    {
        let load = load.filter(|load| load.is_finite()).ok_or(Error::Load)?;
        model.fits(state)?;
        if let Some(at) = placed.filter(|at| at.load == load && at.stamp == model.stamp()) {
            // Another state may have brought the model here.
            if model.check(state).is_err() {
                model.rebase(state)?;
            }
            return Ok(at.offset);
        }
        let count = self.offsets.len();
        let (mut factors, mut tables) = ([T::ZERO; MAX_PARTS], [&[] as &[T]; MAX_PARTS]);
        let (Some(factors), Some(tables)) = (factors.get_mut(..count), tables.get_mut(..count))
        else {
            return Err(Error::Stage { stage: "parts" });
        };
        let each = self.tables.chunks_exact(table_len(model.plane().levels()));
        for (place, table) in tables.iter_mut().zip(each) {
            *place = table;
        }
        let (low, high) = self.range;
        bernstein(
            ((load - low) / (high - low)).clamp(T::ZERO, T::ONE),
            factors,
        );
        *placed = None;
        mix(model, state, tables, factors)?;
        let each = factors.iter().zip(self.offsets);
        let offset = each.fold(T::ZERO, |sum, (&factor, &offset)| sum + factor * offset);
        let stamp = model.stamp();
        *placed = Some(Placed {
            load,
            offset,
            stamp,
        });
        Ok(offset)
    }
}
