//! A Gram matrix over weights, dense or sparse over Everett corners.

use crate::identify::weights::corner_gram::CornerGram;
use std::borrow::Cow;

/// With fewer columns than this a dense factor takes no time.
pub(crate) const MANY: usize = 300;

/// The sparse form is used if its factor has less than this share of the elements of a dense one.
const SPARSE: f64 = 0.25;

/// `Aᵀ A` of some samples.
#[derive(Debug, Clone)]
pub(crate) enum Gram {
    /// Row by row.
    Dense(Vec<f64>),
    Corners(CornerGram),
}

impl Gram {
    /// The matrices of groups over the same corners, in the form that solves faster.
    pub(crate) fn of_corners(mut all: Vec<CornerGram>) -> Vec<Self> {
        let Some(mut whole) = all.first().cloned() else {
            return Vec::new();
        };
        all[1..].iter().for_each(|other| whole.combine(1.0, other));
        let dense = whole.layout.count.pow(2) as f64 / 2.0;
        let few = |count: usize| (count as f64) < SPARSE * dense;
        // The structure is found only where it is likely to be small.
        let sparse =
            few(whole.places.len()) && whole.pattern().is_some_and(|pattern| few(pattern.fill()));
        let form = |mut gram: CornerGram| {
            gram.share_pattern(&whole);
            match sparse {
                true => Self::Corners(gram),
                false => Self::Dense(gram.dense()),
            }
        };
        all.drain(..).map(form).collect()
    }

    /// All elements, row by row.
    pub(crate) fn dense(&self) -> Cow<'_, [f64]> {
        match self {
            Self::Dense(gram) => Cow::Borrowed(gram),
            Self::Corners(gram) => Cow::Owned(gram.dense()),
        }
    }

    pub(crate) fn diagonal(&self, count: usize) -> Vec<f64> {
        match self {
            Self::Dense(gram) => (0..count).map(|n| gram[n * count + n]).collect(),
            Self::Corners(gram) => gram.diagonal(),
        }
    }

    /// This matrix plus `factor` times the other.
    pub(crate) fn combine(&mut self, factor: f64, other: &Self) {
        match (self, other) {
            (Self::Corners(own), Self::Corners(other)) => own.combine(factor, other),
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
