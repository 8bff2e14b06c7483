//! Products of the regressor over groups of samples. A fit to some groups, and its error on others,
//! follow from these sums alone, so that a candidate needs no pass over the samples.

use crate::error::Result;
use crate::identify::options::Prior;
use crate::identify::weights::problem::Problem;
use crate::identify::weights::solve::{Penalised, not_definite};
use crate::model::{Sign, Solver};
use crate::progress::Progress;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// Sums over a group of samples, with `A` the regressor, `Z` the free columns and `y` the target.
#[derive(Clone)]
pub(super) struct Sums {
    /// `Aᵀ A`, row by row.
    gram: Vec<f64>,
    /// `Aᵀ z` for each free column `z`.
    mixed: Vec<Vec<f64>>,
    /// `Aᵀ y`.
    right: Vec<f64>,
    /// `Zᵀ Z`, `Zᵀ y` and `yᵀ y`.
    free: Vec<Vec<f64>>,
    free_right: Vec<f64>,
    squares: f64,
    pub(super) samples: f64,
}

/// Coefficients of the regressor's columns and of the free columns.
pub(super) struct Coefficients {
    pub(super) x: Vec<f64>,
    free: Vec<f64>,
}

impl Sums {
    /// The sums over the samples with weight 1 in `of`. `target` should have no large offset,
    /// because squares of it are subtracted from each other.
    pub(super) fn new(
        problem: &Problem,
        target: &[f64],
        of: &[f64],
        progress: Progress<'_>,
    ) -> Result<Self> {
        let (regressor, experiment) = (&problem.regressor, &problem.experiment);
        let weighed = |values: &[f64]| -> Vec<f64> {
            values
                .iter()
                .zip(of)
                .map(|(value, of)| value * of)
                .collect()
        };
        let columns = match problem.options.offset {
            Some(_) => Vec::new(),
            None => experiment.offsets.clone(),
        };
        let own: Vec<Vec<f64>> = columns.iter().map(|z| weighed(z)).collect();
        let y = weighed(target);
        Ok(Self {
            gram: regressor.gram(experiment, Some(of), progress)?,
            mixed: own
                .iter()
                .map(|z| regressor.adjoint(experiment, z))
                .collect::<Result<_>>()?,
            right: regressor.adjoint(experiment, &y)?,
            free: own
                .iter()
                .map(|z| columns.iter().map(|other| dot(z, other)).collect())
                .collect(),
            free_right: own.iter().map(|z| dot(z, target)).collect(),
            squares: dot(&y, target),
            samples: of.iter().sum(),
        })
    }

    /// The sums of both groups.
    pub(super) fn add(&mut self, other: &Self) {
        self.combine(other, 1.0);
    }

    /// The sums without those of a group that is part of this one.
    pub(super) fn without(&self, other: &Self) -> Self {
        let mut rest = self.clone();
        rest.combine(other, -1.0);
        rest
    }

    fn combine(&mut self, other: &Self, factor: f64) {
        let add = |to: &mut Vec<f64>, from: &Vec<f64>| {
            to.iter_mut().zip(from).for_each(|(t, f)| *t += factor * f);
        };
        add(&mut self.gram, &other.gram);
        add(&mut self.right, &other.right);
        add(&mut self.free_right, &other.free_right);
        for (to, from) in self.mixed.iter_mut().zip(&other.mixed) {
            add(to, from);
        }
        for (to, from) in self.free.iter_mut().zip(&other.free) {
            add(to, from);
        }
        self.squares += factor * other.squares;
        self.samples += factor * other.samples;
    }

    /// The problem with the free columns eliminated.
    pub(super) fn reduced(self) -> Result<Reduced> {
        let (count, free) = (self.right.len(), self.free.len());
        // Groups may have one load only. A small ridge makes the matrix definite, as in the fit.
        let matrix = Mat::from_fn(free, free, |a, b| {
            let own = self.free[a][b];
            if a == b {
                own * (1.0 + 1e-14) + f64::MIN_POSITIVE
            } else {
                own
            }
        });
        let factor = matrix.llt(Side::Lower).map_err(|_| not_definite())?;
        let inverse = factor.solve(&Mat::<f64>::identity(free, free));
        let solved = |values: &[f64]| -> Vec<f64> {
            let row = |a: usize| (0..free).map(|b| inverse[(a, b)] * values[b]).sum();
            (0..free).map(row).collect()
        };
        let largest = (0..count)
            .map(|n| self.gram[n * count + n])
            .fold(0.0, f64::max);
        let mut gram = self.gram.clone();
        for (a, left) in self.mixed.iter().enumerate() {
            for (b, other) in self.mixed.iter().enumerate() {
                for (row, x) in gram.chunks_exact_mut(count).zip(left) {
                    let scale = inverse[(a, b)] * x;
                    row.iter_mut().zip(other).for_each(|(g, y)| *g -= scale * y);
                }
            }
        }
        let level = solved(&self.free_right);
        let mut right = self.right.clone();
        for (mixed, level) in self.mixed.iter().zip(&level) {
            right
                .iter_mut()
                .zip(mixed)
                .for_each(|(r, m)| *r -= level * m);
        }
        let squares = (self.squares - dot(&level, &self.free_right)).max(0.0);
        let moved: Vec<Vec<f64>> = (0..count)
            .map(|n| solved(&self.mixed.iter().map(|m| m[n]).collect::<Vec<_>>()))
            .collect();
        Ok(Reduced {
            gram,
            right,
            squares,
            samples: self.samples,
            level,
            moved,
            largest,
        })
    }

    /// The sum of squared errors of these coefficients over the group.
    pub(super) fn error(&self, at: &Coefficients) -> f64 {
        let count = at.x.len();
        let quadratic: f64 = self
            .gram
            .chunks_exact(count)
            .zip(&at.x)
            .filter(|(_, x)| **x != 0.0)
            .map(|(row, x)| x * dot(row, &at.x))
            .sum();
        let mixed: f64 = self
            .mixed
            .iter()
            .zip(&at.free)
            .map(|(m, f)| f * dot(m, &at.x))
            .sum();
        let free: f64 = self
            .free
            .iter()
            .zip(&at.free)
            .map(|(row, f)| f * dot(row, &at.free))
            .sum();
        let linear = dot(&self.right, &at.x) + dot(&self.free_right, &at.free);
        (self.squares - 2.0 * linear + quadratic + 2.0 * mixed + free).max(0.0)
    }
}

/// A least-squares problem for the weights alone.
pub(super) struct Reduced {
    gram: Vec<f64>,
    right: Vec<f64>,
    /// Sum of squares of the target, without its best free part.
    pub(super) squares: f64,
    pub(super) samples: f64,
    /// The free coefficients are `level − movedᵀ x`.
    level: Vec<f64>,
    moved: Vec<Vec<f64>>,
    largest: f64,
}

impl Reduced {
    pub(super) fn penalised(&self, prior: Prior, problem: &Problem) -> Penalised {
        Penalised::new(
            self.gram.clone(),
            self.largest,
            self.samples,
            prior,
            &problem.regressor,
        )
    }

    /// The weights of least penalised error, searched from `start`.
    pub(super) fn solve(
        &self,
        penalised: &Penalised,
        solver: Solver,
        start: &[f64],
        progress: Progress<'_>,
    ) -> Result<Coefficients> {
        let factor = match solver {
            Solver::Ols => Some(penalised.factor()?),
            Solver::Nnls => None,
        };
        let x = penalised.minimum(&self.right, start, factor.as_ref(), progress)?;
        let mut free = self.level.clone();
        for (moved, x) in self.moved.iter().zip(&x) {
            free.iter_mut().zip(moved).for_each(|(f, m)| *f -= m * x);
        }
        Ok(Coefficients { x, free })
    }

    /// The penalised sum of squared errors at `x`.
    pub(super) fn objective(&self, penalised: &Penalised, x: &[f64]) -> f64 {
        let quadratic = dot(&penalised.times(x), x);
        (self.squares - 2.0 * dot(&self.right, x) + quadratic).max(0.0)
    }

    /// Subtracts the Gram matrix, so that the prior's matrix is left.
    pub(super) fn take_off(&self, matrix: &mut [f64]) {
        matrix.iter_mut().zip(&self.gram).for_each(|(m, g)| *m -= g);
    }

    /// Number of free columns.
    pub(super) fn free(&self) -> f64 {
        self.level.len() as f64
    }
}

/// The target of a problem without its mean.
pub(super) fn centred(problem: &Problem, sign: Sign) -> Vec<f64> {
    let mut target = problem.target(sign);
    if problem.options.offset.is_none() {
        let mean = target.iter().sum::<f64>() / target.len() as f64;
        target.iter_mut().for_each(|y| *y -= mean);
    }
    target
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
