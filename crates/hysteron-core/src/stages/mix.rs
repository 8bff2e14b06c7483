//! Weights that depend on the load.

use crate::branch::Turn;
use crate::error::Error;
use crate::memory::Memory;
use crate::model::Model;
use crate::scalar::Real;
use crate::state::State;

/// Makes `model` that of `Σ_k factors[k] · parts[k]`, and brings `state` along: its operators stay
/// as they are. `O(d K²)` for `d` parts.
///
/// `parts` are Everett tables ([`Model::table`]) of models on the same plane without negative
/// weights. `factors` are not negative; the Bernstein polynomials of a load are such factors
/// (Farouki 2012). So the sum has no negative weights either, and its inverse exists.
///
/// # Errors
/// [`Error::MemoryTooSmall`] where a part is shorter than a table, [`Error::WeightNotFinite`] for
/// a sum that overflows, [`Error::StateMismatch`]. Model and state then stay as they were, but for
/// the overflow, where the model has the weights of no load.
pub fn mix<T, C, S, P>(
    model: &mut Model<T, C>,
    state: &mut State<T, S>,
    parts: &[P],
    factors: &[T],
) -> Result<(), Error>
where
    T: Real,
    C: Memory<T>,
    S: Memory<Turn<T>>,
    P: AsRef<[T]>,
{
    model.fits(state)?;
    let levels = model.plane().levels();
    let needed = crate::everett::table_len(levels);
    for part in parts {
        let found = part.as_ref().len();
        if found < needed {
            return Err(Error::MemoryTooSmall { needed, found });
        }
    }
    model.blend(parts, factors);
    if !model.is_finite() {
        return Err(Error::WeightNotFinite { index: 0 });
    }
    model.rebase(state)
}
