//! What the data say of the weights, and what not: excitation, rank, standard errors, and a band around
//! the output.

use super::excitation::{Excitation, Unresolved};
use super::problem::{Fitted, Problem};
use super::solve::{NormalEquations, not_definite};
use super::sparse::Initial;
use super::{Start, Watch, bootstrap};
use crate::{LoadPart, Result};
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use serde::{Deserialize, Serialize};

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

/// `None` without replicates.
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
    let solution = &fitted.solution;
    let samples = solution.residual.len() as f64;
    // Fitted residuals are smaller than the errors behind them.
    let used = degrees_of_freedom(&solution.x, &equations, plain.as_ref()) + free_count;
    let left = (samples - used).max(1.0);
    let squares: f64 = solution.residual.iter().map(|r| r * r).sum();

    let replicates = bootstrap::replicates(problem, fitted, &equations, &free, watch)?;
    let (standard, factors) = bootstrap::spread(
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
