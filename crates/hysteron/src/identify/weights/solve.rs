//! Least squares on the normal equations, refined to full accuracy with the sparse form.
//!
//! The Gram matrix is usually singular: some operators are never excited, or always move together.
//! A tiny ridge makes it definite. Proximal steps `min |A(x + δ) − y|² + ε |δ|²` (Rockafellar
//! 1976) then remove the effect of the ridge. The residual of each step is computed by a run of the
//! model, not from the Gram matrix. Started from zero, the steps converge to the solution of
//! smallest norm.

use crate::error::Result;
use crate::identify::options::Prior;
use crate::identify::weights::corner_system::{CornerSystem, eliminate};
use crate::identify::weights::definite::Definite;
use crate::identify::weights::experiment::Experiment;
use crate::identify::weights::free::{FreeColumns, Mixed};
use crate::identify::weights::gram::Gram;
use crate::identify::weights::nested::Squares;
use crate::identify::weights::not_definite::not_definite;
use crate::identify::weights::regressor::Regressor;
use crate::identify::weights::smoothness::Smoothness;
use crate::identify::weights::{nnls, pivoting};
use crate::model::Solver;
use crate::progress::Progress;
use std::borrow::Cow;
use std::sync::Arc;

/// Ridge relative to the mean diagonal element of the Gram matrix. It is small compared with the
/// singular values that matter, and large compared with the rounding.
const RIDGE: f64 = 1e-11;

/// Rounding error left after centring, relative to the diagonal before it, because large numbers
/// cancel.
const ROUNDING: f64 = 1e-13;

/// Proximal steps end when one improves the objective by less than this share of it.
const ENOUGH: f64 = 1e-12;

/// Proximal steps also end when the error is this small relative to the data. The rest is rounding.
const NOTHING_LEFT: f64 = 1e-26;

/// The strongest smoothness for which rounding leaves determinants over Everett corners four digits
/// after the point.
const STRONG: f64 = 1e-3;

/// Stronger ones are solved with all elements over weights, up to so many columns.
const DENSE: usize = 5000;

/// Largest number of proximal steps of a fit.
pub(crate) const STEPS: usize = 200;

/// A solution and its residual.
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    /// Coefficient of each column of the regressor.
    pub(crate) x: Vec<f64>,
    /// Coefficients of the free columns.
    pub(crate) free: Vec<f64>,
    /// Residual at every sample; zero for samples that were not kept.
    pub(crate) residual: Vec<f64>,
    /// Sum of squared residuals plus penalty.
    pub(crate) objective: f64,
}

/// A Gram matrix plus the prior of the weights.
pub(crate) struct Penalised {
    smoothness: Smoothness,
    /// The ridge of the prior. Proximal steps do not remove it.
    shrink: f64,
    /// The matrix with both ridges.
    matrix: Matrix,
    /// The sum of both ridges.
    pub(crate) ridge: f64,
    /// Where a search of smooth weights from zero begins.
    squares: Arc<Squares>,
    /// Whether the smoothness is stronger than [`STRONG`].
    strong: bool,
}

enum Matrix {
    /// `C × C`, row by row.
    Dense(Vec<f64>),
    Corners(Box<CornerSystem>),
}

/// The factor of the whole matrix, for weights of either sign.
pub(crate) enum WholeFactor {
    Dense(Definite),
    /// Computed where it is used, because it is sparse.
    Corners,
}

impl Penalised {
    /// From the Gram matrix of `samples`.
    pub(crate) fn new(
        gram: Gram,
        mixed: Mixed,
        samples: f64,
        prior: Prior,
        regressor: &Regressor,
    ) -> Self {
        let count = regressor.columns().len();
        let largest = gram.diagonal(count).into_iter().fold(0.0, f64::max);
        let smoothness = Smoothness::new(regressor.plane().levels(), prior.smooth, samples);
        let ridges = |mean: f64, with_penalty: f64| {
            let shrink = prior.ridge * mean;
            let tiny = RIDGE * with_penalty + ROUNDING * largest;
            (shrink, shrink + tiny.max(f64::MIN_POSITIVE))
        };
        let strong = prior.smooth.along.max(prior.smooth.across) > STRONG;
        let (matrix, (shrink, ridge)) = match gram {
            Gram::Corners(gram) if gram.is_factored && !(strong && count <= DENSE) => {
                let system = CornerSystem::new(gram, mixed.columns, mixed.inverse);
                let before = system.mean_diagonal();
                let mut penalty = vec![0.0; count];
                smoothness.add_diagonal(&mut penalty, regressor.columns());
                let mean = before + penalty.iter().sum::<f64>() / count as f64;
                let ridges = ridges(before, mean);
                let own = Smoothness::new(regressor.plane().levels(), prior.smooth, samples);
                (
                    Matrix::Corners(Box::new(system.with(own, ridges.1))),
                    ridges,
                )
            }
            gram => {
                let mut matrix = gram.into_dense();
                eliminate(&mut matrix, &mixed.columns, &mixed.inverse);
                let mean = |matrix: &[f64]| {
                    let diagonal = (0..count).map(|n| matrix[n * count + n]);
                    diagonal.sum::<f64>() / count as f64
                };
                let before = mean(&matrix);
                smoothness.add_to(&mut matrix, regressor.columns());
                let ridges = ridges(before, mean(&matrix));
                for n in 0..count {
                    matrix[n * count + n] += ridges.1;
                }
                (Matrix::Dense(matrix), ridges)
            }
        };
        let squares = match &matrix {
            Matrix::Dense(_) if smoothness.is_any() => regressor.squares(),
            _ => Arc::default(),
        };
        Self {
            squares,
            smoothness,
            shrink,
            matrix,
            ridge,
            strong,
        }
    }

    /// The elements, row by row; `None` if they are not stored.
    pub(crate) fn elements(&self) -> Option<&[f64]> {
        match &self.matrix {
            Matrix::Dense(matrix) => Some(matrix),
            Matrix::Corners(_) => None,
        }
    }

    /// One row of the matrix.
    pub(crate) fn row_of(&self, n: usize) -> Vec<f64> {
        match &self.matrix {
            Matrix::Dense(matrix) => {
                let count = matrix.len().isqrt();
                matrix[n * count..(n + 1) * count].to_vec()
            }
            Matrix::Corners(system) => system.row(n).to_vec(),
        }
    }

    /// Half the logarithms of the determinants of the prior alone, and of the whole matrix.
    pub(crate) fn half_log_determinants(&self, regressor: &Regressor) -> Result<(f64, f64)> {
        let matrix = match &self.matrix {
            Matrix::Dense(matrix) => Cow::Borrowed(matrix),
            Matrix::Corners(system) => match system.half_log_determinants() {
                Some(found) if !self.strong => return Ok(found),
                _ => Cow::Owned(system.dense()?),
            },
        };
        let count = regressor.columns().len();
        let mut prior = vec![0.0; count * count];
        self.smoothness.add_to(&mut prior, regressor.columns());
        (0..count).for_each(|n| prior[n * count + n] += self.ridge);
        Ok((
            dense_factor(&prior)?.half_log_determinant(),
            dense_factor(&matrix)?.half_log_determinant(),
        ))
    }

    /// The minimum of `½ xᵀ M x − bᵀ x`. With a `factor` of `M` it is over all `x`. Without a
    /// factor it is over `x ≥ 0`, starting from `start`.
    pub(crate) fn minimum(
        &self,
        right: &[f64],
        start: &[f64],
        factor: Option<&WholeFactor>,
        progress: Progress<'_>,
    ) -> Result<Vec<f64>> {
        match (factor, &self.matrix) {
            (Some(WholeFactor::Dense(factor)), _) => return Ok(factor.solve(right)),
            (Some(WholeFactor::Corners), Matrix::Corners(system)) => {
                let all: Vec<usize> = (0..right.len()).collect();
                return match system.free_minimum(right, &all) {
                    Some(x) => Ok(x),
                    None => Ok(dense_factor(&system.dense()?)?.solve(right)),
                };
            }
            _ => {}
        }
        // Then `½ xᵀ M x − bᵀ x` is nowhere below zero. So it is with one sign of most fits.
        if right.iter().all(|b| *b <= 0.0) {
            return Ok(vec![0.0; right.len()]);
        }
        // With smoothness most weights are not zero, so try block pivoting first.
        let (mut x, exact) = match (self.smoothness.is_any(), &self.matrix) {
            (false, _) => (start.iter().map(|x| x.max(0.0)).collect(), false),
            (true, Matrix::Dense(matrix)) => {
                let near = match start.iter().all(|x| *x == 0.0) {
                    true => Cow::Owned(self.squares.start(matrix, right)),
                    false => Cow::Borrowed(start),
                };
                pivoting::minimum(matrix, right, &near)
            }
            (true, Matrix::Corners(system)) => {
                let gradient = |members: &[usize], values: &[f64]| {
                    let mut x = vec![0.0; right.len()];
                    members
                        .iter()
                        .zip(values)
                        .for_each(|(n, value)| x[*n] = *value);
                    let moved = system.times(&x);
                    right.iter().zip(moved).map(|(b, m)| b - m).collect()
                };
                let free = |members: &[usize]| system.free_minimum(right, members);
                pivoting::minimum_by(right, start, free, gradient)
            }
        };
        if !exact {
            match &self.matrix {
                Matrix::Dense(matrix) => nnls::solve(matrix, right, &mut x, progress)?,
                Matrix::Corners(system) => nnls::minimise(&**system, right, &mut x, progress)?,
            }
        }
        Ok(x)
    }

    /// The minimum over `x ≥ 0`, searched from zero, and by how much it reduces the penalised sum of
    /// squares.
    pub(crate) fn nonnegative(
        &self,
        right: &[f64],
        progress: Progress<'_>,
    ) -> Result<(Vec<f64>, f64)> {
        let x = self.minimum(right, &vec![0.0; right.len()], None, progress)?;
        let moved = self.times(&x);
        let gains = x.iter().zip(right).zip(&moved);
        let gain = gains.map(|((x, b), m)| x * (2.0 * b - m)).sum();
        Ok((x, gain))
    }

    /// The factor of the whole matrix, where the solver allows weights of either sign.
    pub(crate) fn factor(&self, solver: Solver) -> Result<Option<WholeFactor>> {
        if solver == Solver::Nnls {
            return Ok(None);
        }
        let matrix = match &self.matrix {
            Matrix::Dense(matrix) => Cow::Borrowed(matrix),
            Matrix::Corners(system) if system.can_factor() => {
                return Ok(Some(WholeFactor::Corners));
            }
            Matrix::Corners(system) => Cow::Owned(system.dense()?),
        };
        Ok(Some(WholeFactor::Dense(dense_factor(&matrix)?)))
    }

    /// The tiny ridge that only makes the matrix definite.
    pub(crate) fn rounding(&self) -> f64 {
        self.ridge - self.shrink
    }

    pub(crate) fn times(&self, vector: &[f64]) -> Vec<f64> {
        let row_times = |row: &[f64]| row.iter().zip(vector).map(|(a, b)| a * b).sum();
        match &self.matrix {
            Matrix::Dense(matrix) => matrix.chunks_exact(vector.len()).map(row_times).collect(),
            Matrix::Corners(system) => system.times(vector),
        }
    }

    /// A random vector whose covariance is the matrix of the prior, from numbers of variance 1.
    pub(crate) fn draw(&self, regressor: &Regressor, mut normal: impl FnMut() -> f64) -> Vec<f64> {
        let mut drawn = self.smoothness.draw(regressor.columns(), &mut normal);
        let size = self.shrink.sqrt();
        drawn.iter_mut().for_each(|d| *d += size * normal());
        drawn
    }

    /// `P x`, half the gradient of the penalty.
    pub(crate) fn slopes(&self, x: &[f64], regressor: &Regressor) -> Vec<f64> {
        let mut slopes = self.smoothness.times(x, regressor.columns());
        let shrunk = slopes.iter_mut().zip(x);
        shrunk.for_each(|(slope, x)| *slope += self.shrink * x);
        slopes
    }
}

/// `Aᵀ A` of the samples kept, with the free columns eliminated, plus the prior.
pub(crate) struct NormalEquations<'a> {
    pub(super) regressor: &'a Regressor,
    pub(super) experiment: &'a Experiment<'a>,
    pub(super) free: &'a FreeColumns,
    pub(super) kept: Option<&'a [f64]>,
    pub(crate) penalised: Arc<Penalised>,
}

impl<'a> NormalEquations<'a> {
    /// `kept` is 1 for samples that count and 0 for others.
    pub(crate) fn new(
        regressor: &'a Regressor,
        experiment: &'a Experiment<'a>,
        free: &'a FreeColumns,
        kept: Option<&'a [f64]>,
        prior: Prior,
        progress: Progress<'_>,
    ) -> Result<Self> {
        let group = |n: usize| kept.is_none_or(|kept| kept[n] != 0.0).then_some(0);
        let gram = regressor.compact_grams(experiment, 1, group, progress)?;
        let gram = gram.into_iter().next().unwrap_or(Gram::Dense(Vec::new()));
        Self::of_gram(regressor, experiment, free, kept, prior, gram)
    }

    /// As [`NormalEquations::new`], from a Gram matrix of the samples kept.
    pub(crate) fn of_gram(
        regressor: &'a Regressor,
        experiment: &'a Experiment<'a>,
        free: &'a FreeColumns,
        kept: Option<&'a [f64]>,
        prior: Prior,
        gram: Gram,
    ) -> Result<Self> {
        let mixed = free.mixed(regressor, experiment)?;
        let samples = kept.map_or(experiment.input.len() as f64, |kept| kept.iter().sum());
        Ok(Self {
            regressor,
            experiment,
            free,
            kept,
            penalised: Arc::new(Penalised::new(gram, mixed, samples, prior, regressor)),
        })
    }

    /// Finds `x` for which `A x`, with the best free columns, is closest to `target`. Starts from
    /// `start` and takes at most `steps` proximal steps.
    pub(crate) fn solve(
        &self,
        target: impl Iterator<Item = f64> + Clone,
        solver: Solver,
        start: Option<&[f64]>,
        steps: usize,
        progress: Progress<'_>,
    ) -> Result<Solution> {
        let count = self.regressor.columns().len();
        let full = self.penalised.factor(solver)?;
        let start = start.map_or_else(|| vec![0.0; count], <[f64]>::to_vec);
        let mut best = self.solution(target.clone(), start)?;
        let nothing = NOTHING_LEFT * target.clone().map(|y| y * y).sum::<f64>();
        for _ in 0..steps {
            progress.tell("weights", 0.0)?;
            let gradient = self.descent(&best)?;
            // There is memory for one residual only.
            best.residual = Vec::new();
            let x = match &full {
                Some(_) => {
                    let step =
                        self.penalised
                            .minimum(&gradient, &best.x, full.as_ref(), progress)?;
                    best.x.iter().zip(step).map(|(x, d)| x + d).collect()
                }
                None => {
                    let moved = self.penalised.times(&best.x);
                    let right: Vec<f64> = gradient.iter().zip(&moved).map(|(g, m)| g + m).collect();
                    self.penalised.minimum(&right, &best.x, None, progress)?
                }
            };
            let next = self.solution(target.clone(), x)?;
            let (before, after) = (best.objective, next.objective);
            if after < before {
                best = next;
            }
            let gains = after < before * (1.0 - ENOUGH);
            if !gains || after <= nothing {
                break;
            }
        }
        if best.residual.is_empty() {
            best = self.solution(target, best.x)?;
        }
        Ok(best)
    }

    /// `Aᵀ y` of the target without its free part, and the sum of squares of that.
    pub(crate) fn right(&self, target: impl Iterator<Item = f64>) -> Result<(Vec<f64>, f64)> {
        let none = vec![0.0; self.regressor.columns().len()];
        let residual = self.solution(target, none)?.residual;
        let squares = residual.iter().map(|r| r * r).sum();
        Ok((
            self.regressor.adjoint(self.experiment, |n| residual[n])?,
            squares,
        ))
    }

    /// The solution `x` with its residual from `target`, after the best free columns are
    /// subtracted.
    fn solution(&self, target: impl Iterator<Item = f64>, x: Vec<f64>) -> Result<Solution> {
        let mut residual = self.regressor.forward(self.experiment, &x)?;
        let all = residual.iter_mut().zip(target);
        all.for_each(|(h, y)| *h = y - *h);
        if let Some(kept) = self.kept {
            residual
                .iter_mut()
                .zip(kept)
                .for_each(|(r, kept)| *r *= kept);
        }
        let free = self.free.take_off(&mut residual);
        let slopes = self.slopes(&x);
        let penalty: f64 = x.iter().zip(&slopes).map(|(x, s)| x * s).sum();
        let objective = residual.iter().map(|r| r * r).sum::<f64>() + penalty;
        Ok(Solution {
            x,
            free,
            residual,
            objective,
        })
    }

    /// `P x`, half the gradient of the penalty.
    pub(crate) fn slopes(&self, x: &[f64]) -> Vec<f64> {
        self.penalised.slopes(x, self.regressor)
    }

    /// Half the negative gradient of the objective: `Aᵀ r − P x`.
    pub(crate) fn descent(&self, at: &Solution) -> Result<Vec<f64>> {
        let mut descent = self
            .regressor
            .adjoint(self.experiment, |n| at.residual[n])?;
        let slopes = self.slopes(&at.x);
        descent.iter_mut().zip(slopes).for_each(|(d, s)| *d -= s);
        Ok(descent)
    }
}

pub(crate) fn dense_factor(matrix: &[f64]) -> Result<Definite> {
    Definite::of_rows(matrix).ok_or_else(not_definite)
}
