//! Weights that depend on the load, in memory of the caller.

use crate::fault::Result;
use hysteron_core::{
    Error, MAX_LEVELS, MAX_PARTS, Model, NegativeWeights, Parts, Placed, State, Turn,
    operator_count, table_len,
};

/// The largest number of parts of weights that depend on the load.
pub const HYSTERON_PARTS: usize = 8;

const _: () = assert!(HYSTERON_PARTS == MAX_PARTS);

/// Parts as the caller gives them.
pub(crate) struct GivenParts<'a> {
    pub(crate) range: (f64, f64),
    pub(crate) offsets: &'a [f64],
    /// Those of all parts, one after the other.
    pub(crate) weights: &'a [f64],
    /// How many weights a part has.
    pub(crate) each: usize,
}

impl GivenParts<'_> {
    /// How many numbers the parts take; `None` where there are no such parts.
    pub(crate) fn numbers(&self) -> Option<usize> {
        // K from K (K + 1) / 2.
        let levels = (8_usize.checked_mul(self.each)?.checked_add(1)?.isqrt() - 1) / 2;
        let count = self.offsets.len();
        let fits = (2..=MAX_LEVELS).contains(&levels)
            && operator_count(levels) == self.each
            && count <= MAX_PARTS;
        fits.then(|| count * (1 + table_len(levels)))
    }

    /// The parts in `place`, which has [`GivenParts::numbers`] elements, for operators as those of
    /// `model`.
    pub(crate) fn built<C: AsRef<[f64]>>(
        &self,
        model: &Model<f64, C>,
        place: &'static mut [f64],
    ) -> Result<ByLoad> {
        let (offsets, tables) = place.split_at_mut(self.offsets.len());
        offsets.copy_from_slice(self.offsets);
        let (plane, operator) = (*model.plane(), model.operator());
        let mut negative = None;
        let len = table_len(plane.levels());
        let each = self.weights.chunks(self.each).zip(tables.chunks_mut(len));
        for (weights, table) in each {
            let part = Model::new(plane, operator, weights, table)?;
            negative = negative.or(part.negative_weights());
        }
        let parts = Parts {
            range: self.range,
            offsets,
            tables,
        };
        parts.check(model)?;
        Ok(ByLoad {
            parts,
            negative,
            placed: None,
        })
    }
}

/// Weights that depend on the load, and the load that the model is at.
pub(crate) struct ByLoad {
    parts: Parts<'static, f64>,
    negative: Option<NegativeWeights>,
    placed: Option<Placed<f64>>,
}

impl ByLoad {
    /// As [`Parts::place`].
    pub(crate) fn place(
        &mut self,
        model: &mut Model<f64, &'static mut [f64]>,
        state: &mut State<f64, &'static mut [Turn<f64>]>,
        load: Option<f64>,
    ) -> Result<f64> {
        Ok(self.parts.place(model, state, &mut self.placed, load)?)
    }

    /// Smallest and largest load.
    pub(crate) fn range(&self) -> (f64, f64) {
        self.parts.range
    }

    /// Refuses the inverse where a part has weights below zero.
    pub(crate) fn check_inverse(&self) -> Result<()> {
        match self.negative {
            Some(which) => Err(Error::NegativeWeights(which).into()),
            None => Ok(()),
        }
    }
}
