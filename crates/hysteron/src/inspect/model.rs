//! Summary of a model: its plane, its weights, its widest loop and its confidence.

use crate::error::Result;
use crate::inspect::stages::{StageSummary, stages_of};
use crate::model::{Confidence, Excitation, Model};
use crate::series::range;
use hysteron_core::operators;
use serde::Serialize;
use std::collections::BTreeMap;

/// Summary of a model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelSummary {
    /// Number of levels of the plane.
    pub levels: usize,
    /// Lowest and highest level, in the unit of the operators' input.
    pub plane: (f64, f64),
    /// Smallest and largest distance between neighbouring levels, in that unit.
    pub steps: (f64, f64),
    /// Number of operators.
    pub operators: usize,
    /// Number of weights that are not zero.
    pub weights_not_zero: usize,
    /// Number of negative weights. If there are any, the model has no inverse.
    pub weights_below_zero: usize,
    /// Output with every operator off, and with every operator on.
    pub output: (f64, f64),
    /// Width of the widest loop: the largest difference between the falling and the rising major
    /// branch, in the output's unit.
    pub widest_loop: f64,
    /// The input at which the loop is widest.
    pub widest_loop_at: f64,
    /// The load that the weights depend on, if they do.
    pub load: Option<LoadSummary>,
    /// Dead time of the actuator, s; absent where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay_s: Option<f64>,
    /// Its stages, in the order of the signal.
    pub stages: Vec<StageSummary>,
    /// Confidence in the weights, if the fit estimated it.
    pub confidence: Option<ConfidenceSummary>,
}

/// The load that the weights of a model depend on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoadSummary {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Smallest load that the model was identified at.
    pub min: f64,
    /// Largest load that the model was identified at.
    pub max: f64,
    /// Order of the weights as a function of the load.
    pub order: usize,
}

/// Short form of [`Confidence`]: how well the data determine the weights.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConfidenceSummary {
    /// Number of operators in each class, from the least known to the best known.
    pub excitation: BTreeMap<Excitation, usize>,
    /// Number of combinations of unknowns that the data determine.
    pub rank: usize,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Condition number: ratio of the best to the worst determined combination.
    pub condition: f64,
    /// Standard deviation of the residuals, in the output's unit.
    pub noise: f64,
    /// Number of bootstrap replicates.
    pub replicates: usize,
    /// Standard error of the offset, in the output's unit.
    pub offset_error: f64,
    /// The weights with the largest standard errors, largest first.
    pub least_certain: Vec<Uncertain>,
}

/// A weight and its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Uncertain {
    /// Index `i` of the level of `α`, from 1.
    pub i: usize,
    /// Index `j` of the level of `β`, from `i`.
    pub j: usize,
    /// The weight `μ_ij`.
    pub weight: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// Number of weights listed in `least_certain`.
const NAMED: usize = 5;

impl ConfidenceSummary {
    fn new(model: &Model, confidence: &Confidence) -> Self {
        let weights = model.weights().iter().zip(&confidence.standard_error);
        let mut least_certain: Vec<Uncertain> = operators(model.plane().levels())
            .zip(weights)
            .map(|((i, j), (&weight, &standard_error))| Uncertain {
                i,
                j,
                weight,
                standard_error,
            })
            .collect();
        least_certain.sort_by(|a, b| b.standard_error.total_cmp(&a.standard_error));
        least_certain.truncate(NAMED);
        Self {
            excitation: Excitation::ALL
                .map(|class| (class, confidence.count(class)))
                .into(),
            rank: confidence.rank,
            unknowns: confidence.unknowns,
            condition: confidence.condition,
            noise: confidence.noise,
            replicates: confidence.replicates,
            offset_error: confidence.offset_error,
            least_certain,
        }
    }
}

/// Summarises `model`.
///
/// # Errors
/// None for a model made by this crate.
pub fn inspect_model(model: &Model) -> Result<ModelSummary> {
    let plane = model.plane();
    let levels = plane.levels();
    // The major branches bend only at the levels, so the widest loop is at one of them.
    let ladder: Vec<f64> = (0..=levels).map(|k| plane.level(k)).collect();
    let inputs = match model.spacing() {
        [] => &ladder[..],
        corners => corners,
    };
    let steps: Vec<f64> = inputs.windows(2).skip(1).map(|w| w[1] - w[0]).collect();
    let operators = model.operators();
    let rising = operators.simulate(&ladder)?;
    let mut falling = vec![0.0; ladder.len()];
    let down: Vec<f64> = ladder.iter().rev().copied().collect();
    operators.run(&mut operators.saturated(), &down, &mut falling)?;
    falling.reverse();
    let gap = |k: &usize| (falling[*k] - rising[*k]).abs();
    let widest = (0..=levels)
        .max_by(|a, b| gap(a).total_cmp(&gap(b)))
        .unwrap_or(0);
    Ok(ModelSummary {
        levels,
        plane: (inputs[1], inputs[levels]),
        steps: range(&steps),
        operators: plane.operators(),
        weights_not_zero: model.weights().iter().filter(|mu| **mu != 0.0).count(),
        weights_below_zero: model.weights().iter().filter(|mu| **mu < 0.0).count(),
        output: model.output_range(),
        widest_loop: gap(&widest),
        widest_loop_at: inputs[widest],
        load: model.load.as_ref().map(|load| LoadSummary {
            name: load.quantity.name.clone(),
            unit: load.quantity.unit.clone(),
            min: load.range().0,
            max: load.range().1,
            order: load.parts().len().saturating_sub(1),
        }),
        delay_s: Some(model.delay().seconds()).filter(|seconds| *seconds > 0.0),
        stages: stages_of(model),
        confidence: model
            .fit
            .as_ref()
            .and_then(|fit| fit.confidence.as_ref())
            .map(|confidence| ConfidenceSummary::new(model, confidence)),
    })
}
