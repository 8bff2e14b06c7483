//! What the data say of the weights, and what not: excitation, rank, standard errors, and a band around
//! the output.

use super::excitation::{Excitation, Unresolved};
use super::problem::{Fitted, Problem};
use super::solve::{NormalEquations, not_definite};
use super::sparse::Initial;
use super::{Solver, Start, Watch};
use crate::{LoadPart, Result};
use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// With fewer branches than this, parts of branches take their place.
const ENOUGH_BRANCHES: usize = 16;

/// Most fits that leave something out: of more units, several are left out together.
const GROUPS: usize = 40;

/// Part of the variance that factors keep, and how many there are at most.
const KEPT: f64 = 0.99;
const FACTORS: usize = 12;

/// Eigenvalues below this part of the largest are what rounding leaves of zero.
const ROUNDING: f64 = 1e-12;

/// What the data say of the weights, and what not.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct Confidence {
    /// Branches of the input.
    pub branches: usize,
    /// How many combinations of weights (and initial states, where these are unknown) the data determine at all.
    pub rank: usize,
    /// How many there are.
    pub unknowns: usize,
    /// Ratio of the best to the worst determined of them, singular values of the centred regressor.
    pub condition: f64,
    /// Standard deviation of what the model leaves, in the output's unit.
    pub noise: f64,
    /// Replicates of the bootstrap.
    pub replicates: usize,
    /// What the input says of each operator, in the order of the weights.
    pub excitation: Vec<Excitation>,
    /// Standard error of each weight, in the output's unit; with a load, at the middle of its range.
    pub standard_error: Vec<f64>,
    /// Standard error of the offset.
    pub offset_error: f64,
    /// The main joint deviations of offset and weights, each one standard deviation long.
    pub factors: Vec<LoadPart>,
}

impl Confidence {
    /// The first entry that cannot be, of a model with `operators` operators, and why.
    pub(crate) fn fault(&self, operators: usize) -> Option<(String, String)> {
        let lengths = [
            ("excitation", self.excitation.len()),
            ("standard_error", self.standard_error.len()),
        ];
        let factors = self.factors.iter().enumerate();
        let of_factors = factors.map(|(n, f)| (format!("factors[{n}].weights"), f.weights.len()));
        let lengths = lengths.map(|(name, length)| (name.to_owned(), length));
        for (name, length) in lengths.into_iter().chain(of_factors) {
            if length != operators {
                return Some((name, format!("{length} entries for {operators} operators")));
            }
        }
        let sizes = [
            ("condition", self.condition),
            ("noise", self.noise),
            ("offset_error", self.offset_error),
        ];
        let errors = self.standard_error.iter().map(|e| ("standard_error", *e));
        let factors = self.factors.iter();
        let deviations = factors.flat_map(|f| f.weights.iter().chain([&f.offset]));
        let deviations = deviations.map(|d| ("factors", d.abs()));
        let mut numbers = sizes.into_iter().chain(errors).chain(deviations);
        // Their squares are summed.
        numbers
            .find(|(_, value)| !(0.0..=1e140).contains(value))
            .map(|(name, value)| {
                (
                    name.to_owned(),
                    format!("{value:e} is not a number from zero on that can be squared"),
                )
            })
    }

    /// How many operators are in a class.
    #[must_use]
    pub fn count(&self, class: Excitation) -> usize {
        self.excitation.iter().filter(|e| **e == class).count()
    }
}

/// Half the width of a 95 % interval in standard errors of a normal distribution.
pub const INTERVAL: f64 = 1.959_963_984_540_054;

/// By a wild bootstrap over branches (Wu 1986; Cameron, Gelbach and Miller 2008): what the fit leaves is put back with the
/// sign of whole branches turned at random, and fitted again. Errors that are alike along a branch, as those of
/// a model are, then count as what they are. `None` without replicates.
pub(super) fn of(
    problem: &Problem,
    fitted: &Fitted,
    watch: Watch<'_>,
) -> Result<Option<Confidence>> {
    let options = &problem.options;
    if options.bootstrap == 0 {
        return Ok(None);
    }
    let experiment = &problem.experiment;
    watch("confidence", 0.0)?;
    let free = problem.free(None)?;
    let equations = NormalEquations::new(
        &problem.regressor,
        experiment,
        &free,
        None,
        options.smooth,
        watch,
    )?;
    // What the data say without the penalty.
    let plain = match options.smooth > 0.0 {
        true => Some(NormalEquations::new(
            &problem.regressor,
            experiment,
            &free,
            None,
            0.0,
            watch,
        )?),
        false => None,
    };
    let (rank, condition) = rank(plain.as_ref().unwrap_or(&equations))?;
    let free_count = fitted.solution.free.len() as f64;
    let factor = match options.solver {
        Solver::Ols => Some(equations.factor()?),
        Solver::Nnls => None,
    };
    let solution = &fitted.solution;
    let samples = solution.residual.len() as f64;
    // Fitted residuals are smaller than the errors behind them.
    let used = degrees_of_freedom(&solution.x, &equations, plain.as_ref()) + free_count;
    let left = (samples - used).max(1.0);
    let squares: f64 = solution.residual.iter().map(|r| r * r).sum();

    let (unit, units, _) = experiment.units(None, ENOUGH_BRANCHES);
    let errors = left_out_errors(problem, fitted, &unit, units, watch)?;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let replicates: Vec<LoadPart> = (0..options.bootstrap)
        .into_par_iter()
        .map(|seed| {
            let count = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            watch("confidence", count as f64 / options.bootstrap as f64)?;
            let mut rng = ChaCha8Rng::seed_from_u64(seed as u64);
            let signs: Vec<f64> = (0..units)
                .map(|_| if rng.next_u32() & 1 == 1 { 1.0 } else { -1.0 })
                .collect();
            let turned = errors.iter().zip(&unit);
            let mut noise: Vec<f64> = turned
                .map(|(r, unit)| unit.map_or(0.0, |unit| signs[unit] * r))
                .collect();
            let moved = free.take_off(&mut noise);
            let x = replicate(&equations, factor.as_ref(), problem, &solution.x, &noise)?;
            // The free columns follow: those of the noise, and what the columns leave to them.
            let difference: Vec<f64> = x.iter().zip(&solution.x).map(|(a, b)| a - b).collect();
            let mut left = problem.regressor.forward(experiment, &difference)?;
            let taken = free.take_off(&mut left);
            let free_values: Vec<f64> = (0..moved.len())
                .map(|n| solution.free[n] + moved[n] - taken[n])
                .collect();
            Ok(problem.at_middle(&x, &free_values, fitted.sign))
        })
        .collect::<Result<_>>()?;
    let (standard, factors) = spread(
        &replicates,
        &problem.at_middle(&solution.x, &solution.free, fitted.sign),
    );
    let inputs: Vec<&[f64]> = experiment
        .recordings
        .iter()
        .map(|range| &experiment.input[range.clone()])
        .collect();
    // Where it is not known, the classes are those from off; what is open then counts among the unknowns.
    let start = match options.start {
        Start::On => Initial::On,
        Start::Off | Start::Unknown => Initial::Off,
    };
    Ok(Some(Confidence {
        branches: experiment.branches(),
        rank,
        unknowns: solution.x.len(),
        condition,
        noise: (squares / left).sqrt(),
        replicates: options.bootstrap,
        excitation: Unresolved::of(&inputs, *problem.regressor.plane(), options.operator, start)?
            .classes(&inputs)?,
        standard_error: standard.weights,
        offset_error: standard.offset,
        factors,
    }))
}

/// The error at each sample of a fit without its unit. A fit bends towards each branch, the more the fewer others
/// speak of the same weights; these errors do not (the residuals of MacKinnon, Nielsen and Webb 2023).
fn left_out_errors(
    problem: &Problem,
    fitted: &Fitted,
    unit: &[Option<usize>],
    units: usize,
    watch: Watch<'_>,
) -> Result<Vec<f64>> {
    let groups = units.min(GROUPS);
    let target = problem.target(fitted.sign);
    let of_group = |group: usize| -> Result<Vec<(usize, f64)>> {
        watch("confidence", 0.0)?;
        let inside = |n: &usize| unit[*n].is_some_and(|unit| unit % groups == group);
        let kept: Vec<f64> = (0..unit.len()).map(|n| f64::from(!inside(&n))).collect();
        let free = problem.free(Some(&kept))?;
        let equations = NormalEquations::new(
            &problem.regressor,
            &problem.experiment,
            &free,
            Some(&kept),
            problem.options.smooth,
            &|_, _| Ok(()),
        )?;
        let start = Some(&fitted.solution.x[..]);
        let solution =
            equations.solve(&target, problem.options.solver, start, 1, &|_, _| Ok(()))?;
        let predicted = problem.predict(&solution)?;
        let errors = (0..unit.len())
            .filter(inside)
            .map(|n| (n, target[n] - predicted[n]));
        Ok(errors.collect())
    };
    let all: Vec<Vec<(usize, f64)>> = (0..groups)
        .into_par_iter()
        .map(of_group)
        .collect::<Result<_>>()?;
    let mut errors = vec![0.0; unit.len()];
    for (n, error) in all.into_iter().flatten() {
        errors[n] = error;
    }
    Ok(errors)
}

/// Columns for the fitted output with `noise` on it, free columns taken off.
fn replicate(
    equations: &NormalEquations<'_>,
    factor: Option<&Llt<f64>>,
    problem: &Problem,
    x: &[f64],
    noise: &[f64],
) -> Result<Vec<f64>> {
    let moved = problem.regressor.adjoint(&problem.experiment, noise)?;
    let mut right = equations.times(x);
    // The penalty shrinks what is fitted again; taking it off here keeps the replicates around the fit.
    right.iter_mut().zip(&moved).for_each(|(b, m)| *b += m);
    equations.minimum(&right, x, factor, &|_, _| Ok(()))
}

/// How many parameters the fit has: one for each weight above zero, less as far as the penalty ties them together,
/// `tr (G + P)⁻¹ G` over these (Hastie, Tibshirani and Friedman 2009, 7.6).
fn degrees_of_freedom(
    x: &[f64],
    equations: &NormalEquations<'_>,
    plain: Option<&NormalEquations<'_>>,
) -> f64 {
    let above: Vec<usize> = (0..x.len()).filter(|n| x[*n] != 0.0).collect();
    let size = above.len();
    let Some(plain) = plain else {
        return size as f64;
    };
    let part = |of: &NormalEquations<'_>| {
        Mat::from_fn(size, size, |i, j| of.matrix[above[i] * x.len() + above[j]])
    };
    match part(equations).llt(Side::Lower) {
        Ok(factor) => {
            let shrunk = factor.solve(&part(plain));
            (0..size).map(|n| shrunk[(n, n)]).sum()
        }
        Err(_) => size as f64,
    }
}

/// Rank of the centred regressor, and the ratio of its largest to its smallest singular value.
fn rank(equations: &NormalEquations<'_>) -> Result<(usize, f64)> {
    let count = equations.matrix.len().isqrt();
    let element = |i: usize, j: usize| equations.matrix[i * count + j];
    let matrix = Mat::from_fn(count, count, element);
    let values = matrix
        .self_adjoint_eigenvalues(Side::Lower)
        .map_err(|_| not_definite())?;
    let largest = values.iter().copied().fold(0.0, f64::max);
    let above: Vec<f64> = values
        .into_iter()
        .map(|value| value - equations.ridge)
        .filter(|value| *value > ROUNDING * largest)
        .collect();
    let smallest = above.iter().copied().fold(f64::INFINITY, f64::min);
    let condition = if above.is_empty() {
        1.0
    } else {
        (largest / smallest).sqrt()
    };
    Ok((above.len(), condition))
}

/// Root mean squared deviations of the replicates from the fit, and their main joint ones (principal components).
///
/// From the fit, not from the replicates' mean: where a weight is zero, all of them lie on one side.
fn spread(replicates: &[LoadPart], fit: &LoadPart) -> (LoadPart, Vec<LoadPart>) {
    let count = fit.weights.len() + 1;
    let value = |part: &LoadPart, n: usize| match n {
        0 => part.offset,
        n => part.weights[n - 1],
    };
    let scale = 1.0 / (replicates.len() as f64).sqrt();
    let deviation = |r: usize, n: usize| scale * (value(&replicates[r], n) - value(fit, n));
    let part = |values: &dyn Fn(usize) -> f64| LoadPart {
        offset: values(0),
        weights: (1..count).map(values).collect(),
    };
    let variance =
        |n: usize| -> f64 { (0..replicates.len()).map(|r| deviation(r, n).powi(2)).sum() };
    let standard = part(&|n| variance(n).sqrt());
    let matrix = Mat::from_fn(count, replicates.len(), |n, r| deviation(r, n));
    let Ok(svd) = matrix.thin_svd() else {
        return (standard, Vec::new());
    };
    let sizes: Vec<f64> = (0..svd.S().column_vector().nrows())
        .map(|k| svd.S().column_vector()[k])
        .collect();
    let total: f64 = sizes.iter().map(|s| s * s).sum();
    let mut kept = 0.0;
    let mut factors = Vec::new();
    for (k, size) in sizes.iter().enumerate().take(FACTORS) {
        if total == 0.0 || kept >= KEPT * total {
            break;
        }
        kept += size * size;
        factors.push(part(&|n| size * svd.U()[(n, k)]));
    }
    // What is left out is spread over those that are kept, so that the band is not too narrow.
    let stretch = if kept > 0.0 {
        (total / kept).sqrt()
    } else {
        1.0
    };
    for factor in &mut factors {
        factor.offset *= stretch;
        factor.weights.iter_mut().for_each(|mu| *mu *= stretch);
    }
    (standard, factors)
}
