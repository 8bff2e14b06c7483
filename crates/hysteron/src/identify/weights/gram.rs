//! A Gram matrix over weights, dense or sparse over Everett corners.

use crate::error::Result;
use crate::identify::weights::corner_gram::CornerGram;
use crate::identify::weights::room::{MOST_BYTES, check_dense};
use std::borrow::Cow;
use std::sync::Arc;

/// With fewer columns than this all elements are held.
pub(crate) const MANY: usize = 300;

/// With fewer columns than this a dense factor takes less time than a sparse one: it is that of the
/// weights above zero alone, and needs no search for a structure.
const FACTORED: usize = 500;

/// Elements of a matrix are kept sparse if they are less than this share of those of a dense
/// factor. So are elements of a factor.
const SPARSE: f64 = 0.25;

/// `Aᵀ A` of some samples.
#[derive(Debug, Clone)]
pub(crate) enum Gram {
    /// Row by row.
    Dense(Vec<f64>),
    Corners(Arc<CornerGram>),
}

impl Gram {
    /// The matrices of groups over the same corners, in the form that is faster.
    ///
    /// # Errors
    /// [`crate::Error::Fit`] if no form has room.
    pub(crate) fn of_corners(mut all: Vec<CornerGram>) -> Result<Vec<Self>> {
        let Some(mut whole) = all.first().cloned() else {
            return Ok(Vec::new());
        };
        all[1..].iter().for_each(|other| whole.combine(1.0, other));
        let columns = whole.layout.count;
        let dense = (columns as f64).powi(2) / 2.0;
        let few = |count: usize| (count as f64) < SPARSE * dense && 8 * count as u128 <= MOST_BYTES;
        let is_sparse = few(whole.places.len());
        // The structure is found only where it is likely to be small.
        let is_factored = is_sparse
            && columns >= FACTORED
            && whole.pattern().is_some_and(|pattern| few(pattern.fill()));
        if !is_factored {
            check_dense(columns)?;
        }
        let form = |mut gram: CornerGram| {
            gram.is_factored = is_factored;
            if is_factored {
                gram.share_pattern(&whole);
            }
            // All elements of a whole plane are found at once, and need not be held.
            match is_factored || (is_sparse && whole.layout.whole_plane().is_some()) {
                true => Self::Corners(Arc::new(gram)),
                false => Self::Dense(gram.dense()),
            }
        };
        Ok(all.drain(..).map(form).collect())
    }

    /// All elements, row by row.
    pub(crate) fn dense(&self) -> Cow<'_, [f64]> {
        match self {
            Self::Dense(gram) => Cow::Borrowed(gram),
            Self::Corners(gram) => Cow::Owned(gram.dense()),
        }
    }

    /// As [`Gram::dense`].
    pub(crate) fn into_dense(self) -> Vec<f64> {
        match self {
            Self::Dense(gram) => gram,
            Self::Corners(gram) => gram.dense(),
        }
    }

    pub(crate) fn diagonal(&self, count: usize) -> Vec<f64> {
        match self {
            Self::Dense(gram) => (0..count).map(|n| gram[n * count + n]).collect(),
            Self::Corners(gram) => gram.diagonal().to_vec(),
        }
    }

    /// This matrix plus `factor` times the other.
    pub(crate) fn combine(&mut self, factor: f64, other: &Self) {
        match (self, other) {
            (Self::Corners(own), Self::Corners(other)) => {
                Arc::make_mut(own).combine(factor, other);
            }
            (Self::Dense(own), other) => {
                let other = other.dense();
                own.iter_mut()
                    .zip(other.iter())
                    .for_each(|(t, f)| *t += factor * f);
            }
            (own, other) => {
                *own = Self::Dense(own.dense().into_owned());
                own.combine(factor, other);
            }
        }
    }

    /// `xᵀ G x`.
    pub(crate) fn quadratic(&self, x: &[f64]) -> f64 {
        match self {
            Self::Dense(gram) => gram
                .chunks_exact(x.len())
                .zip(x)
                .filter(|(_, x)| **x != 0.0)
                .map(|(row, own)| own * dot(row, x))
                .sum(),
            Self::Corners(gram) => dot(&gram.times(x), x),
        }
    }
}

/// The sum of the products.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
