//! Identification: the weights of a model from recordings.

mod advice;
mod choose;
mod doubt;
mod monotone;
mod options;
mod stages;
mod weights;

pub use advice::{Advice, advice};
pub use choose::chosen::{Open, identify};
pub use choose::left_out::{LeftOut, left_out};
pub use choose::validate::{Candidates, cross_validate};
pub(crate) use doubt::excitation::Unresolved;
pub use doubt::excitation::excitation;
pub use monotone::{AGAINST_INPUT, way_against_input};
pub use options::FitOptions;
pub use stages::body::fit_thermal;
pub use weights::experiment::plane_of;
pub(crate) use weights::initial::simulate_from_unknown;
pub(crate) use weights::sparse::Initial;

use crate::error::Result;
use crate::model::{FitSummary, LoadDependence, LoadPart, Model};
use crate::progress::Watch;
use crate::recording::Recording;
use crate::series::Errors;
use doubt::confidence;
use weights::problem::Problem;

/// Identifies a model: the weights and offset that minimise the squared error over the recording.
///
/// Never forms the `n × N` matrix of operator states. The Gram matrix takes `O(N²)` memory and `O(n + N²)`
/// time, for inputs with few turning points at once; the weights, `O(N p + p²)` for each of some `p` steps, `p` being those not zero.
///
/// ```
/// use hysteron::{FitOptions, Recording, fit};
/// let input: Vec<f64> = (0..200).map(|n| (1.0 - (f64::from(n) * 0.1).cos()) * 30.0).collect();
/// let output = input.iter().map(|t| 0.5 * t).collect(); // no hysteresis at all
/// let options = FitOptions { levels: 5, ..FitOptions::default() };
/// let model = fit(&Recording::new(input, output)?, &options)?;
/// assert!(model.fit.as_ref().is_some_and(|fit| fit.nrmse_percent < 1e-6));
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::Recording`] for a recording that cannot be worked with or whose input never changes;
/// [`crate::Error::Core`] for a plane that cannot be; [`crate::Error::Fit`] for options that contradict each other.
pub fn fit(recording: &Recording, options: &FitOptions) -> Result<Model> {
    fit_experiment(std::slice::from_ref(recording), options, &|_, _| Ok(()))
}

/// As [`fit`], from several recordings at once, each of which starts from its own initial state; with
/// a load in them, weights that depend on it.
///
/// # Errors
/// As [`fit`], and what `watch` returns.
pub fn fit_experiment(
    recordings: &[Recording],
    options: &FitOptions,
    watch: Watch<'_>,
) -> Result<Model> {
    let mut problem = Problem::new(recordings, options)?;
    let fitted = problem.solve(None, watch)?;
    let plane = *problem.regressor.plane();
    let sign = fitted.sign;
    let parts = problem.load_parts(&fitted.solution.x, &fitted.solution.free, sign);
    let first = &recordings[0];
    let load = problem.experiment.load_range.map(|(min, max)| {
        LoadDependence::new(first.load_quantity.clone(), (min, max), parts.clone())
    });
    let whole = LoadPart::at_middle(&parts);
    let mut model = Model::new(options.operator, plane, whole.weights, whole.offset, sign)?;
    model.input = first.input_quantity.clone();
    model.output = first.output_quantity.clone();
    model.load = load;
    let confidence = confidence::of(&problem, &fitted, watch)?;

    let residual = &fitted.solution.residual;
    let measured = &problem.experiment.output;
    let modelled: Vec<f64> = measured
        .iter()
        .zip(residual)
        .map(|(y, r)| y - sign.factor() * r)
        .collect();
    let errors = Errors::between(measured, &modelled, |_| true)
        .ok_or_else(|| crate::error::Error::Fit("no samples".into()))?;
    let path = |r: &Recording| r.source.as_ref().map(|s| s.path.display().to_string());
    model.fit = Some(FitSummary {
        solver: options.solver,
        smooth: options.smooth,
        start: options.start,
        open_at_start: problem.regressor.open_at_start,
        samples: errors.samples,
        rmse: errors.rmse,
        max_abs: errors.max_abs,
        nrmse_percent: errors.nrmse_percent.unwrap_or_default(),
        weights_not_zero: model.weights().iter().filter(|mu| **mu != 0.0).count(),
        simulated: recordings
            .iter()
            .any(|r| r.origin == crate::recording::Origin::Simulated),
        file: path(first),
        sha256: first.source.as_ref().map(|s| s.sha256.clone()),
        other_files: recordings[1..].iter().filter_map(path).collect(),
        validation: None,
        confidence,
        other: std::collections::BTreeMap::new(),
    });
    Ok(model)
}
