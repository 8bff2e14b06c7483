//! Identification: the weights of a model from a recording.

mod cholesky;
mod excitation;
mod nnls;
mod solve;
mod sparse;

pub(crate) use excitation::Unresolved;
pub use excitation::{Excitation, excitation};

use crate::recording::range;
use crate::{Error, Errors, Model, Operator, Plane, Recording, Result, Sign};
use serde::{Deserialize, Serialize};
use solve::NormalEquations;
use sparse::SparseForm;

/// How the weights are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Solver {
    /// Non-negative least squares: a monotone model, which has an inverse.
    #[default]
    Nnls,
    /// Plain least squares, the chapter's; of all solutions that of smallest norm.
    Ols,
}

/// What a fit may choose.
///
/// | field | default | range | purpose |
/// | --- | --- | --- | --- |
/// | `operator` | MKP | MKP, KP, relay | the elementary operator |
/// | `levels` | 20 | from 2 on; the Gram matrix takes `8 N²` bytes, `N = K(K + 1)/2` | how fine the plane is |
/// | `range` | from the data | finite, in order | the plane's lowest and highest level |
/// | `solver` | NNLS | NNLS, OLS | see [`Solver`] |
/// | `sign` | the better one | ± | direction of the output |
/// | `offset` | free | finite | output with every operator off |
#[derive(Debug, Clone, PartialEq)]
pub struct FitOptions {
    /// The elementary operator.
    pub operator: Operator,
    /// Number of levels `K`.
    pub levels: usize,
    /// Lowest and highest level; `None` for a plane whose active range is that of the input.
    pub range: Option<(f64, f64)>,
    /// How the weights are found.
    pub solver: Solver,
    /// Direction of the output; `None` for the one that fits better.
    pub sign: Option<Sign>,
    /// Output with every operator off; `None` to identify it.
    pub offset: Option<f64>,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            operator: Operator::Mkp,
            levels: 20,
            range: None,
            solver: Solver::Nnls,
            sign: None,
            offset: None,
        }
    }
}

/// How a model was obtained; it goes into the model file.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct FitSummary {
    /// How the weights were found.
    pub solver: Solver,
    /// Samples fitted.
    pub samples: usize,
    /// Root mean squared error over them, in the output's unit.
    pub rmse: f64,
    /// Largest absolute error, in the output's unit.
    pub max_abs: f64,
    /// `rmse` in percent of the measured range.
    pub nrmse_percent: f64,
    /// Weights that are not zero.
    pub weights_not_zero: usize,
    /// Whether the data came from a simulated plant.
    pub simulated: bool,
    /// The file fitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// SHA-256 of its bytes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// What else a model file says of its fit.
    #[serde(flatten)]
    pub other: std::collections::BTreeMap<String, serde_json::Value>,
}

/// Ranges below this have squares of zero.
const SMALLEST: f64 = 1e-140;

/// Most memory that the Gram matrix may take.
const GRAM_BYTES: u128 = 4 << 30;

/// Identifies a model: the weights and offset that minimise the squared error over the recording,
/// with every operator off before its first sample.
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
/// [`Error::Recording`] for a recording that cannot be worked with or whose input never changes;
/// [`Error::Core`] for a plane that cannot be; [`Error::Fit`] for options that contradict each other.
pub fn fit(recording: &Recording, options: &FitOptions) -> Result<Model> {
    recording.check()?;
    let plane = choose_plane(recording, options)?;
    check_gram(plane)?;
    if let Some(offset) = options
        .offset
        .filter(|offset| offset.is_nan() || offset.abs() > 1e140)
    {
        return Err(Error::Fit(format!(
            "the offset {offset} is not a number to work with"
        )));
    }

    let form = SparseForm::new(plane, options.operator, &recording.input)?;
    let equations = NormalEquations::new(&form, options.offset.is_none())?;
    let signs = match options.sign {
        Some(sign) => vec![sign],
        // Without a constraint both signs give the same output.
        None if options.solver == Solver::Ols => vec![Sign::Positive],
        None => vec![Sign::Positive, Sign::Negative],
    };
    let mut best: Option<(solve::Solution, Sign)> = None;
    for sign in signs {
        let target: Vec<f64> = recording
            .output
            .iter()
            .map(|y| sign.factor() * (y - options.offset.unwrap_or(0.0)))
            .collect();
        let solution = equations.solve(&target, options.solver)?;
        if best
            .as_ref()
            .is_none_or(|(other, _)| solution.squares < other.squares)
        {
            best = Some((solution, sign));
        }
    }
    let (mut solution, mut sign) = best.ok_or_else(|| Error::Fit("no sign to try".into()))?;
    // Weights mostly below zero say that the output falls: turn both round.
    if options.sign.is_none() && solution.weights.iter().sum::<f64>() < 0.0 {
        solution.weights.iter_mut().for_each(|mu| *mu = -*mu);
        solution.offset = -solution.offset;
        sign = Sign::Negative;
    }
    finish(recording, options, plane, solution, sign)
}

/// Whether the Gram matrix of a plane fits into memory.
fn check_gram(plane: Plane) -> Result<()> {
    let bytes = 8 * (plane.operators() as u128).pow(2);
    if bytes > GRAM_BYTES {
        return Err(Error::Fit(format!(
            "{} levels are {} operators, whose Gram matrix takes {:.1} GiB, more than the {} GiB allowed: take fewer levels",
            plane.levels(),
            plane.operators(),
            bytes as f64 / f64::from(1 << 30),
            GRAM_BYTES >> 30
        )));
    }
    Ok(())
}

/// From states in `[0, 1]` to the operator's own outputs, and the errors of the result.
fn finish(
    recording: &Recording,
    options: &FitOptions,
    plane: Plane,
    solution: solve::Solution,
    sign: Sign,
) -> Result<Model> {
    let mut weights = solution.weights;
    let mut offset = options.offset.unwrap_or(sign.factor() * solution.offset);
    if options.operator != Operator::Mkp {
        // μ γ = (μ/2) (2γ − 1) + μ/2
        weights.iter_mut().for_each(|mu| *mu *= 0.5);
        offset += sign.factor() * weights.iter().sum::<f64>();
    }
    let mut model = Model::new(options.operator, plane, weights, offset, sign)?;
    model.input = recording.input_quantity.clone();
    model.output = recording.output_quantity.clone();
    let modelled = model.simulate(&recording.input)?;
    let errors = Errors::between(&recording.output, &modelled, |_| true)
        .ok_or_else(|| Error::Fit("no samples".into()))?;
    model.fit = Some(FitSummary {
        solver: options.solver,
        samples: errors.samples,
        rmse: errors.rmse,
        max_abs: errors.max_abs,
        nrmse_percent: errors.nrmse_percent.unwrap_or_default(),
        weights_not_zero: model.weights().iter().filter(|mu| **mu != 0.0).count(),
        simulated: recording.origin == crate::Origin::Simulated,
        file: recording
            .source
            .as_ref()
            .map(|source| source.path.display().to_string()),
        sha256: recording
            .source
            .as_ref()
            .map(|source| source.sha256.clone()),
        other: std::collections::BTreeMap::new(),
    });
    Ok(model)
}

fn choose_plane(recording: &Recording, options: &FitOptions) -> Result<Plane> {
    let series = [
        (&recording.input, &recording.input_quantity),
        (&recording.output, &recording.output_quantity),
    ];
    for (values, quantity) in series {
        let (low, high) = range(values);
        if high - low < SMALLEST {
            return Err(Error::Recording {
                path: recording.source.as_ref().map(|source| source.path.clone()),
                row: None,
                column: Some(quantity.name.clone()),
                problem: match high > low {
                    true => format!("it moves by {:e} only: use another unit", high - low),
                    false => format!("it is {low} throughout: nothing can be identified from it"),
                },
            });
        }
    }
    let Some((min, max)) = options.range else {
        return plane_of(recording, options.levels);
    };
    let plane = Plane::new(min, max, options.levels)?;
    let (low, high) = range(&recording.input);
    if plane.normalise(low) >= plane.normalise(high) {
        return Err(Error::Fit(format!(
            "the input, from {low} to {high}, moves no operator of a plane from {min} to {max}: take another range"
        )));
    }
    Ok(plane)
}

/// The plane of `levels` levels whose active range `[T_min − ΔT, T_max]` is that of the recording's
/// input: the lowest ridge starts one step below the lowest level.
///
/// # Errors
/// [`Error::Core`] for a number of levels that cannot be, or an input that never changes.
pub fn plane_of(recording: &Recording, levels: usize) -> Result<Plane> {
    let (low, high) = range(&recording.input);
    if low >= high {
        return Err(Error::Recording {
            path: recording.source.as_ref().map(|source| source.path.clone()),
            row: None,
            column: Some(recording.input_quantity.name.clone()),
            problem: format!("it is {low} throughout: no plane follows from it, give a range"),
        });
    }
    let step = (high - low) / levels.max(1) as f64;
    let mut plane = Plane::new(low + step, high, levels)?;
    // Rounding must not leave the lowest input outside.
    for _ in 0..4 {
        if plane.bottom() > low {
            plane = Plane::new(plane.min().next_down(), high, levels)?;
        }
    }
    Ok(plane)
}
