//! Fits weights, offset and sign of a model with fixed options, and summarises the fit.

use crate::error::{Error, Result};
use crate::identify::doubt::confidence;
use crate::identify::options::FitOptions;
use crate::identify::weights::problem::{Fitted, Problem};
use crate::model::{FitSummary, LoadDependence, LoadPart, Model, Outlier, SeenFile};
use crate::progress::Progress;
use crate::recording::{Origin, Recording};
use crate::series::Errors;

/// Identifies a model from recordings, each with its own initial state. If they have a load, the
/// weights depend on it.
pub(crate) fn fit_weights(
    recordings: &[Recording],
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<Model> {
    fit_weights_without(recordings, options, &[], progress)
}

/// Fits again with the output of each outlier put where the model is, so that it has no influence.
/// A few times are enough: what one sample moves is a small share of its distance.
const AGAIN: usize = 4;

/// As [`fit_weights`], with no weight for the `outliers`.
pub(crate) fn fit_weights_without(
    recordings: &[Recording],
    options: &FitOptions,
    outliers: &[Outlier],
    progress: Progress<'_>,
) -> Result<Model> {
    let mut problem = Problem::new(recordings, options)?;
    let mut fitted = problem.solve(None, progress)?;
    for _ in 0..if outliers.is_empty() { 0 } else { AGAIN } {
        for outlier in outliers {
            let place = problem.experiment.recordings[outlier.recording].start + outlier.sample;
            let residual = fitted.solution.residual[place];
            problem.experiment.output.to_mut()[place] -= fitted.sign.factor() * residual;
        }
        fitted = problem.solve(None, progress)?;
    }
    let mut model = described(&problem, &fitted, recordings)?;
    let confidence = confidence::estimate(&problem, &fitted, progress)?;
    if let Some(fit) = &mut model.fit {
        fit.confidence = confidence;
    }
    Ok(model)
}

/// The model that was fitted, with the errors of the fit.
pub(crate) fn described(
    problem: &Problem,
    fitted: &Fitted,
    recordings: &[Recording],
) -> Result<Model> {
    let options = &problem.options;
    let plane = *problem.regressor.plane();
    let sign = fitted.sign;
    let parts = problem.load_parts(&fitted.solution.x, &fitted.solution.free, sign);
    let first = &recordings[0];
    let whole = LoadPart::at_middle(&parts);
    let mut model = Model::new(options.operator, plane, whole.weights, whole.offset, sign)?;
    model.input = first.input_quantity.clone();
    model.output = first.output_quantity.clone();
    if let Some(range) = problem.experiment.load_range {
        let quantity = first.load_quantity.clone();
        let load = LoadDependence::new(quantity, range, parts, model.operators());
        model.load = Some(load.map_err(|(_, error)| error)?);
    }

    let residual = &fitted.solution.residual;
    let measured = &problem.experiment.output;
    let modelled = measured.iter().zip(residual);
    let modelled = modelled.map(|(y, r)| y - sign.factor() * r);
    let errors = Errors::of_each(measured, modelled, |_| true)
        .ok_or_else(|| Error::Fit("no samples".into()))?;
    let file = SeenFile::from_recording(first);
    let others: Vec<SeenFile> = recordings[1..]
        .iter()
        .filter_map(SeenFile::from_recording)
        .collect();
    model.fit = Some(FitSummary {
        solver: options.solver,
        smooth: options.smooth,
        ridge: options.ridge,
        start: options.start,
        open_at_start: problem.regressor.open_at_start,
        samples: errors.samples,
        rmse: errors.rmse,
        max_abs: errors.max_abs,
        nrmse_percent: errors.nrmse_percent.unwrap_or_default(),
        weights_not_zero: model.weights().iter().filter(|mu| **mu != 0.0).count(),
        outliers: Vec::new(),
        simulated: recordings.iter().any(|r| r.origin == Origin::Simulated),
        sha256: file.as_ref().map(|seen| seen.sha256.clone()),
        file: file.map(|seen| seen.file),
        other_sha256: others.iter().map(|seen| seen.sha256.clone()).collect(),
        other_files: others.into_iter().map(|seen| seen.file).collect(),
        repeats: Vec::new(),
        validation: None,
        confidence: None,
        other: std::collections::BTreeMap::new(),
    });
    Ok(model)
}
