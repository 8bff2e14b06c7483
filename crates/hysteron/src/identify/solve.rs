//! Least squares on the normal equations, made exact by refinement against the sparse form.
//!
//! The Gram matrix is singular as a rule: operators that were never excited, or always together. A
//! small ridge makes it definite, and proximal steps `min |Φ(μ + δ) − y|² + ε |δ|²` (Rockafellar 1976)
//! take the ridge's effect away again: the residual of each step is computed by a run of the model,
//! not from the Gram matrix. From zero on they lead to the solution of smallest norm.

use super::sparse::SparseForm;
use super::{Solver, nnls};
use crate::Result;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// Ridge relative to the mean of the Gram matrix' diagonal: small beside singular values that matter,
/// large beside its rounding.
const RIDGE: f64 = 1e-11;

/// Rounding that centring leaves, relative to the diagonal before it: what cancels there stays here.
const ROUNDING: f64 = 1e-13;

/// Proximal steps end when one improves the squared error by less than this part of it.
const ENOUGH: f64 = 1e-12;

/// Or when the error is this small beside the data: nothing but rounding is left.
const NOTHING_LEFT: f64 = 1e-26;

/// Most proximal steps.
const STEPS: usize = 200;

/// Weights and what they leave.
pub(super) struct Solution {
    pub(super) weights: Vec<f64>,
    /// The constant that is best with them, 0 where it is not free.
    pub(super) offset: f64,
    /// Sum of squared residuals.
    pub(super) squares: f64,
}

/// `Φᵀ Φ` of a recording, centred where a constant is free, with its ridge.
pub(super) struct NormalEquations<'a> {
    form: &'a SparseForm<'a>,
    gram: Vec<f64>,
    offset_free: bool,
}

impl<'a> NormalEquations<'a> {
    pub(super) fn new(form: &'a SparseForm<'a>, offset_free: bool) -> Result<Self> {
        let count = form.operators();
        let mut gram = form.gram()?;
        let largest = (0..count).map(|n| gram[n * count + n]).fold(0.0, f64::max);
        if offset_free {
            // A free constant is eliminated by taking the mean off every column.
            let samples = form.samples() as f64;
            let sums = form.adjoint(&vec![1.0; form.samples()])?;
            for (row, a) in gram.chunks_exact_mut(count).zip(&sums) {
                for (element, b) in row.iter_mut().zip(&sums) {
                    *element -= a * b / samples;
                }
            }
        }
        let trace: f64 = (0..count).map(|n| gram[n * count + n]).sum();
        let ridge = (RIDGE * trace / count as f64 + ROUNDING * largest).max(f64::MIN_POSITIVE);
        for n in 0..count {
            gram[n * count + n] += ridge;
        }
        Ok(Self {
            form,
            gram,
            offset_free,
        })
    }

    /// The weights that bring `Φ μ` (and a constant, where free) closest to `target`.
    pub(super) fn solve(&self, target: &[f64], solver: Solver) -> Result<Solution> {
        let count = self.form.operators();
        let element = |i: usize, j: usize| self.gram[i * count + j];
        let full = match solver {
            Solver::Ols => {
                let matrix = Mat::from_fn(count, count, element);
                Some(matrix.llt(Side::Lower).map_err(|_| nnls::not_definite())?)
            }
            Solver::Nnls => None,
        };
        let mut best = self.residual(target, vec![0.0; count])?;
        let nothing = NOTHING_LEFT * target.iter().map(|y| y * y).sum::<f64>();
        for _ in 0..STEPS {
            let (ref solution, ref residual) = best;
            let gradient = self.form.adjoint(residual)?;
            let weights = match &full {
                Some(factor) => {
                    let step = factor.solve(&Mat::from_fn(count, 1, |n, _| gradient[n]));
                    (0..count)
                        .map(|n| solution.weights[n] + step[(n, 0)])
                        .collect()
                }
                None => {
                    let moved = self.times(&solution.weights);
                    let right: Vec<f64> = gradient.iter().zip(&moved).map(|(g, m)| g + m).collect();
                    let mut weights = solution.weights.clone();
                    nnls::solve(&self.gram, &right, &mut weights)?;
                    weights
                }
            };
            let next = self.residual(target, weights)?;
            let (before, after) = (best.0.squares, next.0.squares);
            if after < before {
                best = next;
            }
            if after >= before * (1.0 - ENOUGH) || after <= nothing {
                break;
            }
        }
        Ok(best.0)
    }

    /// What `weights` leave of `target`, with the best constant taken off.
    fn residual(&self, target: &[f64], weights: Vec<f64>) -> Result<(Solution, Vec<f64>)> {
        let modelled = self.form.forward(&weights)?;
        let mut residual: Vec<f64> = target.iter().zip(&modelled).map(|(y, h)| y - h).collect();
        let mut offset = 0.0;
        if self.offset_free {
            offset = residual.iter().sum::<f64>() / residual.len() as f64;
            residual.iter_mut().for_each(|r| *r -= offset);
        }
        let squares = residual.iter().map(|r| r * r).sum();
        let solution = Solution {
            weights,
            offset,
            squares,
        };
        Ok((solution, residual))
    }

    fn times(&self, vector: &[f64]) -> Vec<f64> {
        let row_times = |row: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum();
        self.gram
            .chunks_exact(vector.len())
            .map(row_times)
            .collect()
    }
}
