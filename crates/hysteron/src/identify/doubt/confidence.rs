//! Confidence in the weights of a fit: excitation, rank, standard errors, and factors for the band.

use crate::error::Result;
use crate::identify::doubt::bootstrap::{self, ENOUGH_BRANCHES};
use crate::identify::doubt::calibrate::calibrate;
use crate::identify::doubt::excitation::Unresolved;
use crate::identify::doubt::spectrum::Spectrum;
use crate::identify::options::Prior;
use crate::identify::weights::gram::Gram;
use crate::identify::weights::problem::{Fitted, Problem};
use crate::identify::weights::solve::{NormalEquations, Penalised};
use crate::model::Confidence;
use crate::progress::Progress;
use crate::series::noise::noise;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// With fewer branches than this, the band is for new parts of branches.
const ENOUGH_FOR_BAND: usize = 3;

/// The confidence of a fit; `None` without bootstrap replicates.
pub(crate) fn estimate(
    problem: &Problem,
    fitted: &Fitted,
    progress: Progress<'_>,
) -> Result<Option<Confidence>> {
    let options = &problem.options;
    if options.bootstrap == 0 {
        return Ok(None);
    }
    let experiment = &problem.experiment;
    progress.tell("confidence", 0.0)?;
    let free = problem.free(None)?;
    let regressor = &problem.regressor;
    let group = |_| Some(0);
    let gram = regressor.compact_grams(experiment, 1, group, progress)?;
    let gram = gram.into_iter().next().unwrap_or(Gram::Dense(Vec::new()));
    let dense = Gram::Dense(gram.dense().into_owned());
    let with =
        |prior, gram| NormalEquations::of_gram(regressor, experiment, &free, None, prior, gram);
    let equations = with(options.prior(), gram)?;
    // The matrix without the prior: what the data alone determine.
    let plain = with(Prior::NONE, dense)?;
    let elements = plain.penalised.elements().unwrap_or_default();
    let spectrum = Spectrum::new(elements, plain.penalised.ridge)?;
    let free_count = fitted.solution.free.len() as f64;
    let solution = &fitted.solution;
    let samples = solution.residual.len() as f64;
    // Fitted residuals are smaller than the errors themselves, so correct for the degrees of
    // freedom.
    let shrunk = |n: usize| equations.penalised.row_of(n);
    let used = degrees_of_freedom(&solution.x, shrunk, &plain.penalised) + free_count;
    let left = (samples - used).max(1.0);
    let squares: f64 = solution.residual.iter().map(|r| r * r).sum();

    let spread = (squares / left).sqrt();
    let of_units = |enough| bootstrap::left_out_errors(problem, fitted, enough, progress);
    let left_out = of_units(ENOUGH_BRANCHES)?;
    let replicates = bootstrap::replicates(
        problem,
        fitted,
        &equations,
        &free,
        (&left_out, spread),
        progress,
    )?;
    let (standard, factors) = bootstrap::spread(
        &replicates,
        &problem.at_middle(&solution.x, &solution.free, fitted.sign),
    );
    let own = experiment.recordings.iter();
    let sensor =
        own.map(|range| noise(&solution.residual[range.clone()]).powi(2) * range.len() as f64);
    let sensor = (sensor.sum::<f64>() / samples).sqrt();
    // The band is for new branches.
    let new_branches = if experiment.branches.len() < ENOUGH_BRANCHES {
        drop(left_out);
        of_units(ENOUGH_FOR_BAND)?
    } else {
        left_out
    };
    let errors = new_branches.of_new_branches(problem);
    let width = calibrate(&factors, errors, sensor, problem, fitted.sign)?;
    let inputs: Vec<&[f64]> = experiment
        .recordings
        .iter()
        .map(|range| &experiment.input[range.clone()])
        .collect();
    // With an unknown start, the classes are those from off. Undetermined initial states count
    // among the unknowns.
    let start = options.initial();
    Ok(Some(Confidence {
        branches: experiment.branches.len(),
        rank: spectrum.rank(),
        unknowns: solution.x.len(),
        condition: spectrum.condition(),
        noise: width,
        sensor,
        sessions: 1,
        replicates: options.bootstrap,
        excitation: Unresolved::new(&inputs, *problem.regressor.plane(), options.operator, start)?
            .classes(&inputs)?,
        standard_error: standard.weights,
        offset_error: standard.offset,
        factors,
    }))
}

/// Effective number of parameters: one for each weight above zero, fewer where the penalty ties
/// weights together. `tr (G + P)⁻¹ G` over these weights (Hastie, Tibshirani and Friedman 2009,
/// 7.6).
fn degrees_of_freedom(x: &[f64], row: impl Fn(usize) -> Vec<f64>, plain: &Penalised) -> f64 {
    let above: Vec<usize> = (0..x.len()).filter(|n| x[*n] != 0.0).collect();
    let size = above.len();
    let elements = plain.elements().unwrap_or_default();
    let part = Mat::from_fn(size, size, |i, j| elements[above[i] * x.len() + above[j]]);
    let rows: Vec<Vec<f64>> = above.iter().map(|n| row(*n)).collect();
    match Mat::from_fn(size, size, |i, j| rows[i][above[j]]).llt(Side::Lower) {
        Ok(factor) => {
            let shrunk = factor.solve(&part);
            (0..size).map(|n| shrunk[(n, n)]).sum()
        }
        Err(_) => size as f64,
    }
}
