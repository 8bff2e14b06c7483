//! Free columns: regressor columns whose coefficients may have any sign. They model the output with
//! every operator off, for each function of the load. They are eliminated, because for given
//! weights their best coefficients follow directly.

use crate::error::Result;
use crate::identify::weights::experiment::Experiment;
use crate::identify::weights::gram::dot;
use crate::identify::weights::not_definite::not_definite;
use crate::identify::weights::of_load::OfLoad;
use crate::identify::weights::regressor::Regressor;
use crate::identify::weights::units::Units;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// A Gram matrix from which free columns are to be eliminated: `Aᵀ z` of each, and `(Zᵀ Z)⁻¹`.
pub(crate) struct Mixed {
    pub(crate) columns: Vec<Vec<f64>>,
    pub(crate) inverse: Vec<Vec<f64>>,
}

/// `Z`, the free columns at the samples kept, and `(Zᵀ Z)⁻¹`.
pub(crate) struct FreeColumns {
    columns: Vec<OfLoad>,
    inverse: Vec<Vec<f64>>,
}

impl FreeColumns {
    /// No free columns.
    pub(crate) fn none() -> Self {
        Self {
            columns: Vec::new(),
            inverse: Vec::new(),
        }
    }

    /// `parts` are the functions of the load. `kept` is 1 for samples that count and 0 for others.
    pub(crate) fn new(parts: &[OfLoad], kept: Option<&[f64]>) -> Result<Self> {
        let columns: Vec<OfLoad> = parts.iter().map(|part| part.at_kept(kept)).collect();
        let count = columns.len();
        let product = |a: usize, b: usize| -> f64 {
            let pairs = columns[a].iter().zip(columns[b].iter());
            pairs.map(|(a, b)| a * b).sum()
        };
        let mut gram = Mat::from_fn(count, count, product);
        // With few different loads the functions may be linearly dependent. A small ridge makes the
        // matrix definite.
        for n in 0..count {
            gram[(n, n)] = gram[(n, n)] * (1.0 + 1e-14) + f64::MIN_POSITIVE;
        }
        let factor = gram.llt(Side::Lower).map_err(|_| not_definite())?;
        let inverse = factor.solve(&Mat::<f64>::identity(count, count));
        let inverse = (0..count)
            .map(|a| (0..count).map(|b| inverse[(a, b)]).collect())
            .collect();
        Ok(Self { columns, inverse })
    }

    /// Fits the free columns to `residual`, subtracts them from it, and returns their coefficients.
    pub(crate) fn take_off(&self, residual: &mut [f64]) -> Vec<f64> {
        let values = self.values(&self.products(residual));
        for (z, value) in self.columns.iter().zip(&values) {
            for (r, z) in residual.iter_mut().zip(z.iter()) {
                *r -= value * z;
            }
        }
        values
    }

    /// `Aᵀ z` for each free column `z`, and the inverse.
    pub(crate) fn mixed(&self, regressor: &Regressor, experiment: &Experiment) -> Result<Mixed> {
        let columns = self.columns.iter();
        let columns = columns.map(|z| regressor.adjoint(experiment, |n| z[n]));
        Ok(Mixed {
            columns: columns.collect::<Result<_>>()?,
            inverse: self.inverse.clone(),
        })
    }

    /// `Zᵀ r`.
    pub(crate) fn products(&self, residual: &[f64]) -> Vec<f64> {
        let product = |z: &OfLoad| z.iter().zip(residual).map(|(z, r)| z * r).sum();
        self.columns.iter().map(product).collect()
    }

    /// `Zᵀ r` over the samples of each unit.
    pub(crate) fn unit_products(&self, residual: &[f64], units: &Units) -> Vec<Vec<f64>> {
        let of = |z: &OfLoad| {
            let mut sums = vec![0.0; units.count];
            for (n, (z, r)) in z.iter().zip(residual).enumerate() {
                if let Some(unit) = units.unit(n) {
                    sums[unit] += z * r;
                }
            }
            sums
        };
        self.columns.iter().map(of).collect()
    }

    /// The coefficients `(Zᵀ Z)⁻¹ p` for the products `p = Zᵀ r`.
    pub(crate) fn values(&self, products: &[f64]) -> Vec<f64> {
        self.inverse.iter().map(|row| dot(row, products)).collect()
    }
}
