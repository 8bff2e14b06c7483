//! Errors on branches that were left out of the whole fit, including the choice of levels and
//! smoothness.

use crate::error::{Error, Result};
use crate::identify::changed::{at, enough};
use crate::identify::choose::start::at_rest;
use crate::identify::choose::validate::{Candidates, choose};
use crate::identify::options::{Choice, FitOptions, Spacing};
use crate::identify::weights::experiment::Experiment;
use crate::identify::weights::problem::Problem;
use crate::model::Smooth;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::fair_range;
use std::iter::repeat_n;

/// Largest number of groups of branches that are left out in turn.
const FOLDS: usize = 5;

/// Errors over the branches that were left out, and over those that were fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOut {
    /// For each sample, the group of branches with which it was left out.
    pub fold: Vec<usize>,
    /// Output at each sample, from the fit that left it out.
    pub predicted: Vec<f64>,
    /// Root mean squared error over samples left out, in percent of the measured range.
    pub nrmse_percent: f64,
    /// Root mean squared error over the samples fitted, all folds together, in percent of the
    /// measured range.
    pub training_nrmse_percent: f64,
    /// Number of branches of the input.
    pub branches: usize,
    /// Levels and smoothness of each fold.
    pub chosen: Vec<(usize, Smooth)>,
}

/// Leaves out whole branches in turn and compares them with a fit to the others. The fits use the
/// `options`. With `candidates`, levels and smoothness are chosen by cross-validation of the
/// branches that are not left out.
///
/// The fits are those of the operators alone, because the stages around them are found from whole
/// recordings. A load changes the weights, whatever the load law.
///
/// A rest that is not given is found from all branches.
///
/// # Errors
/// As [`crate::Fit::run`]; [`crate::Error::Fit`] if there is only one branch, and for options that
/// ask for spacing or for stages behind the operators.
pub fn left_out(
    recordings: &[Recording],
    options: &FitOptions,
    candidates: Option<&Candidates>,
    progress: Progress<'_>,
) -> Result<LeftOut> {
    if options.spacing != Spacing::Uniform
        || options.asks_after()
        || options.curve != Choice::Fixed(0)
    {
        return Err(Error::Fit(
            "branches are left out of fits of the operators alone: without spacing and stages behind them"
                .into(),
        ));
    }
    let has_load = recordings.iter().any(|recording| recording.load.is_some());
    let options = &match options.opens_rest() && !has_load {
        true => at_rest(recordings, options)?,
        false => options.clone(),
    };
    let mut problem = Problem::new(recordings, options)?;
    let experiment = &problem.experiment;
    let count = experiment.branches.len().min(FOLDS);
    if count < 2 {
        return Err(Error::Fit(
            "there is only one branch: nothing can be left out".into(),
        ));
    }
    let branches = experiment.branches.iter().enumerate();
    let fold = branches.flat_map(|(branch, samples)| repeat_n(branch % count, samples.len()));
    let fold: Vec<usize> = fold.collect();
    let measured = experiment.output.to_vec();
    let mut predicted = vec![0.0; measured.len()];
    let (mut training, mut chosen) = (0.0, Vec::new());
    for f in 0..count {
        progress.tell("left-out branches", f as f64 / count as f64)?;
        let kept: Vec<f64> = fold.iter().map(|g| f64::from(*g != f)).collect();
        let mut options = options.clone();
        if let Some(candidates) = candidates {
            let report = |_: &'static str, _: f64| {
                progress.tell("left-out branches", f as f64 / count as f64)
            };
            let progress = Progress::new(&report);
            options = choose(
                recordings.into(),
                &options,
                candidates,
                (Some(&kept), None),
                progress,
            )?
            .options;
            problem = Problem::new(recordings, &options)?;
        }
        chosen.push((options.levels, options.smooth));
        let outputs = without(&mut problem, &kept)?;
        for (n, y) in outputs.into_iter().enumerate() {
            if fold[n] == f {
                predicted[n] = y;
            } else {
                training += (measured[n] - y).powi(2);
            }
        }
    }
    let (low, high) = fair_range(&measured);
    let samples = measured.len() as f64;
    let squares: f64 = measured
        .iter()
        .zip(&predicted)
        .map(|(y, p)| (y - p).powi(2))
        .sum();
    let percent = |squares: f64, samples: f64| 100.0 * (squares / samples).sqrt() / (high - low);
    Ok(LeftOut {
        nrmse_percent: percent(squares, samples),
        training_nrmse_percent: percent(training, samples * (count - 1) as f64),
        branches: problem.experiment.branches.len(),
        fold,
        predicted,
        chosen,
    })
}

/// The output at every sample, from a fit to the samples that are kept.
fn without(problem: &mut Problem<'_>, kept: &[f64]) -> Result<Vec<f64>> {
    let fitted = problem.solve(Some(kept), Progress::NONE)?;
    problem.outputs(&fitted)
}

/// The output at each sample of one recording, from the fit that left its fold out. Samples without
/// a fold are in no fit; the first predicts them.
///
/// # Errors
/// As [`crate::Fit::run`].
pub(crate) fn predicted_without(
    recording: &Recording,
    options: &FitOptions,
    fold: &[Option<usize>],
) -> Result<Vec<f64>> {
    let mut predicted = vec![0.0; recording.len()];
    let last = fold.iter().copied().flatten().max().unwrap_or(0);
    let kept = |f: usize, n: usize| f64::from(fold[n].is_some_and(|g| g != f));
    each_kept(recording, options, last + 1, kept, |f, outputs| {
        let own = (0..predicted.len()).filter(|n| fold[*n].unwrap_or(0) == f);
        own.for_each(|n| predicted[n] = outputs[n]);
    })?;
    Ok(predicted)
}

/// The output at each sample of one recording, from a fit to the samples that are `kept`: 1, or 0
/// for those that are not.
///
/// # Errors
/// As [`crate::Fit::run`].
pub(crate) fn predicted_from(
    recording: &Recording,
    options: &FitOptions,
    kept: &[f64],
) -> Result<Vec<f64>> {
    let mut predicted = Vec::new();
    each_kept(
        recording,
        options,
        1,
        |_, n| kept[n],
        |_, outputs| predicted = outputs,
    )?;
    Ok(predicted)
}

/// Hands on the output at every sample from `count` fits, each to the samples that it has `kept`.
/// Of a long recording the fits see as many samples as choices do.
fn each_kept(
    recording: &Recording,
    options: &FitOptions,
    count: usize,
    kept: impl Fn(usize, usize) -> f64,
    mut done: impl FnMut(usize, Vec<f64>),
) -> Result<()> {
    let all = std::slice::from_ref(recording);
    let Some(samples) = enough(recording) else {
        let mut problem = Problem::new(all, options)?;
        for f in 0..count {
            let kept: Vec<f64> = (0..recording.len()).map(|n| kept(f, n)).collect();
            done(f, without(&mut problem, &kept)?);
        }
        return Ok(());
    };
    let few = [at(recording, &samples)];
    let mut problem = Problem::new(&few, options)?;
    let all = Experiment::new(all, options)?;
    for f in 0..count {
        let kept: Vec<f64> = samples.iter().map(|n| kept(f, *n)).collect();
        let fitted = problem.solve(Some(&kept), Progress::NONE)?;
        done(f, problem.outputs_over(&all, &fitted)?);
    }
    Ok(())
}
