//! Products of the regressor over groups of samples. A fit to some groups, and its error on others,
//! follow from these sums alone, so that a candidate needs no pass over the samples.

use crate::error::Result;
use crate::identify::options::Prior;
use crate::identify::weights::free::Mixed;
use crate::identify::weights::gram::{Gram, dot};
use crate::identify::weights::not_definite::not_definite;
use crate::identify::weights::of_load::OfLoad;
use crate::identify::weights::problem::Problem;
use crate::identify::weights::solve::Penalised;
use crate::model::{Sign, Solver};
use crate::parallel;
use crate::progress::Progress;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use std::ops::Range;

/// Sums over a group of samples, with `A` the regressor, `Z` the free columns and `y` the target.
#[derive(Clone)]
pub(crate) struct Sums {
    /// `Aᵀ A`.
    gram: Gram,
    /// `Aᵀ z` for each free column `z`.
    mixed: Vec<Vec<f64>>,
    /// `Aᵀ y`.
    right: Vec<f64>,
    /// `Zᵀ Z`, `Zᵀ y` and `yᵀ y`.
    free: Vec<Vec<f64>>,
    free_right: Vec<f64>,
    squares: f64,
    pub(crate) samples: f64,
}

/// Coefficients of the regressor's columns and of the free columns.
pub(crate) struct Coefficients {
    pub(crate) x: Vec<f64>,
    pub(crate) free: Vec<f64>,
}

/// Largest size of the Gram matrices that are summed in one pass, in bytes. More groups take
/// further passes.
const PASS_BYTES: usize = 256 << 20;

impl Sums {
    /// The sums over the samples of each of `count` groups. `group` has the group of each sample,
    /// `None` for samples that do not count. `target` gives the target at a sample. The targets
    /// should have no large offset, because their squares are subtracted from each other.
    pub(crate) fn of_groups(
        problem: &Problem,
        target: impl Fn(usize) -> f64 + Sync,
        group: impl Fn(usize) -> Option<usize> + Sync,
        count: usize,
        progress: Progress<'_>,
    ) -> Result<Vec<Self>> {
        let passes = Self::passes(problem, count);
        let all = parallel::map(passes.len(), |n| {
            Self::of_some(problem, &target, &group, passes[n].clone(), progress)
        })?;
        Ok(all.into_iter().flatten().collect())
    }

    /// The groups of each pass, so that their Gram matrices take no more than 256 MiB.
    pub(crate) fn passes(problem: &Problem, count: usize) -> Vec<Range<usize>> {
        let columns = problem.regressor.columns().len();
        let matrix = columns.saturating_mul(columns).saturating_mul(8);
        let at_once = (PASS_BYTES / matrix.max(1)).clamp(1, count.max(1));
        let starts = (0..count).step_by(at_once);
        starts.map(|n| n..(n + at_once).min(count)).collect()
    }

    /// As [`Sums::of_groups`], for a range of the groups.
    pub(crate) fn of_some(
        problem: &Problem,
        target: impl Fn(usize) -> f64,
        group: impl Fn(usize) -> Option<usize>,
        groups: Range<usize>,
        progress: Progress<'_>,
    ) -> Result<Vec<Self>> {
        let (regressor, experiment) = (&problem.regressor, &problem.experiment);
        let columns: &[OfLoad] = match problem.options.offset {
            Some(_) => &[],
            None => &experiment.offsets,
        };
        let count = groups.len();
        let own = |n: usize| {
            let group = group(n)?.checked_sub(groups.start)?;
            (group < count).then_some(group)
        };
        let grams = regressor.compact_grams(experiment, count, own, progress)?;
        let rights = regressor.adjoints(experiment, &target, count, own)?;
        let mut all: Vec<Self> = grams
            .into_iter()
            .zip(rights)
            .map(|(gram, right)| Self {
                gram,
                right,
                mixed: Vec::new(),
                free: vec![vec![0.0; columns.len()]; columns.len()],
                free_right: vec![0.0; columns.len()],
                squares: 0.0,
                samples: 0.0,
            })
            .collect();
        for z in columns {
            let mixed = regressor.adjoints(experiment, |n| z[n], count, own)?;
            all.iter_mut()
                .zip(mixed)
                .for_each(|(own, m)| own.mixed.push(m));
        }
        for n in 0..experiment.output.len() {
            let Some(sums) = own(n).map(|group| &mut all[group]) else {
                continue;
            };
            let y = target(n);
            sums.squares += y * y;
            sums.samples += 1.0;
            for (a, left) in columns.iter().enumerate() {
                sums.free_right[a] += left[n] * y;
                for (b, right) in columns.iter().enumerate() {
                    sums.free[a][b] += left[n] * right[n];
                }
            }
        }
        Ok(all)
    }

    /// The sums of all the groups together; `None` without a group.
    pub(crate) fn total(groups: &[Self]) -> Option<Self> {
        let (first, others) = groups.split_first()?;
        let mut total = first.clone();
        others.iter().for_each(|own| total.combine(own, 1.0));
        Some(total)
    }

    /// The sums without those of a group that is part of this one.
    pub(crate) fn without(&self, other: &Self) -> Self {
        let mut rest = self.clone();
        rest.combine(other, -1.0);
        rest
    }

    fn combine(&mut self, other: &Self, factor: f64) {
        let add = |to: &mut Vec<f64>, from: &Vec<f64>| {
            to.iter_mut().zip(from).for_each(|(t, f)| *t += factor * f);
        };
        self.gram.combine(factor, &other.gram);
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
    pub(crate) fn reduced(mut self) -> Result<Reduced> {
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
        let level = solved(&self.free_right);
        let mut right = std::mem::take(&mut self.right);
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
        let inverse = (0..free).map(|a| (0..free).map(|b| inverse[(a, b)]).collect());
        Ok(Reduced {
            gram: self.gram,
            mixed: self.mixed,
            inverse: inverse.collect(),
            right,
            squares,
            samples: self.samples,
            level,
            moved,
        })
    }

    /// The sum of squared errors of these coefficients over the group.
    pub(crate) fn error(&self, at: &Coefficients) -> f64 {
        let quadratic = self.gram.quadratic(&at.x);
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
pub(crate) struct Reduced {
    gram: Gram,
    mixed: Vec<Vec<f64>>,
    inverse: Vec<Vec<f64>>,
    right: Vec<f64>,
    /// Sum of squares of the target, without its best free part.
    pub(crate) squares: f64,
    pub(crate) samples: f64,
    /// The free coefficients are `level − movedᵀ x`.
    level: Vec<f64>,
    moved: Vec<Vec<f64>>,
}

impl Reduced {
    pub(crate) fn penalised(&self, prior: Prior, problem: &Problem) -> Penalised {
        let mixed = Mixed {
            columns: self.mixed.clone(),
            inverse: self.inverse.clone(),
        };
        let gram = self.gram.clone();
        Penalised::new(gram, mixed, self.samples, prior, &problem.regressor)
    }

    /// The weights of least penalised error, searched from `start`.
    pub(crate) fn solve(
        &self,
        penalised: &Penalised,
        solver: Solver,
        start: &[f64],
        progress: Progress<'_>,
    ) -> Result<Coefficients> {
        let factor = penalised.factor(solver)?;
        let x = penalised.minimum(&self.right, start, factor.as_ref(), progress)?;
        Ok(self.with_free(x))
    }

    /// As [`Reduced::solve`], but of all solutions the one closest to `near`.
    pub(crate) fn solve_near(
        &self,
        penalised: &Penalised,
        solver: Solver,
        near: &[f64],
        progress: Progress<'_>,
    ) -> Result<Coefficients> {
        let factor = penalised.factor(solver)?;
        let pull = penalised.rounding();
        let right = self.right.iter().zip(near);
        let right: Vec<f64> = right.map(|(b, x)| b + pull * x).collect();
        let x = penalised.minimum(&right, near, factor.as_ref(), progress)?;
        Ok(self.with_free(x))
    }

    /// With the best free coefficients for `x`.
    fn with_free(&self, x: Vec<f64>) -> Coefficients {
        let mut free = self.level.clone();
        for (moved, x) in self.moved.iter().zip(&x) {
            free.iter_mut().zip(moved).for_each(|(f, m)| *f -= m * x);
        }
        Coefficients { x, free }
    }

    /// The penalised sum of squared errors at `x`.
    pub(crate) fn objective(&self, penalised: &Penalised, x: &[f64]) -> f64 {
        let quadratic = dot(&penalised.times(x), x);
        (self.squares - 2.0 * dot(&self.right, x) + quadratic).max(0.0)
    }

    /// Number of free columns.
    pub(crate) fn free(&self) -> f64 {
        self.level.len() as f64
    }
}

/// The squared error of the best weights over all samples, and these weights, searched from `start`
/// where it has as many.
pub(crate) fn least_squares(
    problem: &Problem,
    sign: Sign,
    start: &[f64],
) -> Result<(f64, Vec<f64>)> {
    let target = centred(problem, sign);
    let all = Sums::of_some(problem, target, |_| Some(0), 0..1, Progress::NONE)?;
    let [all] = <[Sums; 1]>::try_from(all).map_err(|_| not_definite())?;
    let reduced = all.clone().reduced()?;
    let penalised = reduced.penalised(problem.options.prior(), problem);
    let mut from = vec![0.0; problem.regressor.columns().len()];
    if start.len() == from.len() {
        from.copy_from_slice(start);
    }
    let at = reduced.solve(&penalised, problem.options.solver, &from, Progress::NONE)?;
    Ok((all.error(&at), at.x))
}

/// The target of a problem without its mean, at each sample.
pub(crate) fn centred(problem: &Problem, sign: Sign) -> impl Fn(usize) -> f64 + Sync {
    let samples = problem.experiment.output.len();
    let mean = match problem.options.offset {
        Some(_) => 0.0,
        None => problem.targets(sign).sum::<f64>() / samples as f64,
    };
    move |n| problem.target(sign, n) - mean
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::identify::options::FitOptions;
    use crate::recording::Recording;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// The best weights from sums, from any start, against the fit whose residual is a run of the
    /// model: short walks, which excite few operators, and starts that are wrong everywhere.
    #[test]
    fn sums_find_the_error_of_the_fit() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        for round in 0..30 {
            let samples = rng.random_range(4..800);
            let input: Vec<f64> = match round % 3 {
                0 => (0..samples).map(|n| f64::from(n % 2)).collect(),
                _ => (0..samples).map(|_| rng.random_range(0.0..1.0)).collect(),
            };
            let noisy = |x: &f64| 5.0 - x * x + 0.1 * rng.random_range(-1.0..1.0);
            let output = input.iter().map(noisy).collect();
            let recordings = [Recording::new(input, output).unwrap()];
            let smooth = [0.0, 1e-9, 1e-6, 1e-3][round % 4];
            let options = FitOptions {
                levels: [2, 9, 26][round % 3],
                smooth: smooth.into(),
                ..FitOptions::plain()
            };
            let mut problem = Problem::new(&recordings, &options).unwrap();
            let fitted = problem.solve(None, Progress::NONE).unwrap();
            let residual = &fitted.solution.residual;
            let plain: f64 = residual.iter().map(|r| r * r).sum();
            let total: f64 = problem.targets(fitted.sign).map(|y| y * y).sum();
            let count = problem.regressor.columns().len();
            let wrong: Vec<f64> = (0..count).map(|_| rng.random_range(-1.0..2.0)).collect();
            for start in [&[][..], &wrong, &fitted.solution.x] {
                let (squares, x) = least_squares(&problem, fitted.sign, start).unwrap();
                let least = x.iter().copied().fold(f64::INFINITY, f64::min);
                assert!(least >= 0.0, "round {round}: {least}");
                // The ridge that makes the matrix definite pulls a little, and squares that are
                // subtracted from each other leave their rounding.
                let allowed = 1e-5 * plain + 1e-11 * total;
                assert!(
                    (squares - plain).abs() < allowed,
                    "round {round}: {squares} for {plain}"
                );
            }
        }
    }
}
