//! Summaries of a recording and of a model, for users who want to know what a file contains.

mod model;

pub use model::{ConfidenceSummary, LoadSummary, ModelSummary, Uncertain, inspect_model};

use crate::error::Result;
use crate::identify::determined;
use crate::model::Plane;
use crate::prepare::{Doubt, doubts};
use crate::recording::Recording;
use crate::recording::gaps;
use crate::series::NOISE;
use crate::series::Turning;
use crate::series::range;
use hysteron_core::ridge;
use serde::Serialize;

/// One series of a recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Series {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Number of turning points, without reversals up to 1 % of the range.
    pub reversals: usize,
    /// Number of turning points of any size. Many more than `reversals` indicate noise.
    pub reversals_of_any_size: usize,
}

/// What is in a recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordingSummary {
    /// Number of samples.
    pub samples: usize,
    /// The input.
    pub input: Series,
    /// The output.
    pub output: Series,
    /// The sampling; `None` without time.
    pub time: Option<Sampling>,
    /// Number of levels of the plane that `excited` is counted on.
    pub levels: usize,
    /// Lowest and highest level of this plane.
    pub plane: (f64, f64),
    /// Number of operators of this plane.
    pub operators: usize,
    /// Number of operators that the input excites. Nothing can be learned about the others.
    pub excited: usize,
    /// Number of combinations of their weights that the recording would determine without noise:
    /// the rank that a fit states. Operators that move together count as one. `None` for more than
    /// 50 levels.
    pub rank: Option<usize>,
    /// Number of these combinations that the noise of the output leaves: their standard error is at
    /// most the weight that each operator has where all share the range of the output evenly.
    pub determined: Option<usize>,
    /// What is not to be believed unasked.
    pub doubts: Vec<Doubt>,
}

/// How a recording was sampled.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sampling {
    /// Time of the first sample, in seconds.
    pub start: f64,
    /// Time of the last sample, in seconds.
    pub end: f64,
    /// Median time between samples, in seconds.
    pub median_step: f64,
    /// Longest time between samples, in seconds.
    pub longest_step: f64,
    /// The sample after the longest step, counted from 1.
    pub longest_step_before_sample: usize,
    /// Number of gaps: steps of more than three times the median.
    pub gaps: usize,
    /// Number of samples with the same time as the sample before.
    pub repeated: usize,
}

/// Summarises `recording`, and counts the operators of `plane` that it excites and the combinations
/// of their weights that it determines.
///
/// # Errors
/// [`crate::Error::Recording`] for an invalid recording.
pub fn inspect_recording(recording: &Recording, plane: Plane) -> Result<RecordingSummary> {
    recording.check()?;
    let series = |values: &[f64], quantity: &crate::recording::Quantity| {
        let (min, max) = range(values);
        let count = |band: f64| {
            let mut turning = Turning::new(band);
            let turns = values.iter().filter_map(|&v| turning.push(v)).count();
            turns.saturating_sub(1) // the start is not a reversal
        };
        Series {
            name: quantity.name.clone(),
            unit: quantity.unit.clone(),
            min,
            max,
            reversals: count(NOISE * (max - min)),
            reversals_of_any_size: count(0.0),
        }
    };
    let determined = determined(recording, plane)?;
    Ok(RecordingSummary {
        samples: recording.len(),
        input: series(&recording.input, &recording.input_quantity),
        output: series(&recording.output, &recording.output_quantity),
        time: recording.time.as_deref().and_then(sampling),
        levels: plane.levels(),
        plane: (plane.min(), plane.max()),
        operators: plane.operators(),
        excited: excited(&recording.input, plane),
        rank: determined.map(|(rank, _)| rank),
        determined: determined.map(|(_, against_noise)| against_noise),
        doubts: doubts(recording)?,
    })
}

/// Counts the MKP operators whose states differ between samples.
///
/// After the first sample, from off, `γ = r_j(x)`. The state changes once some `r_j` is above this
/// value or some `r_i` is below it.
fn excited(input: &[f64], plane: Plane) -> usize {
    let (low, high) = range(input);
    let [first, low, high] = [input[0], low, high].map(|t| plane.normalise(t));
    let moves = |i: usize, j: usize| {
        let gamma = ridge(first, j);
        ridge(high, j) > gamma || ridge(low, i) < gamma
    };
    (1..=plane.levels())
        .map(|j| (1..=j).filter(|&i| moves(i, j)).count())
        .sum()
}

fn sampling(time: &[f64]) -> Option<Sampling> {
    let step = |n: usize| time[n] - time[n - 1];
    let longest = (1..time.len()).max_by(|&a, &b| step(a).total_cmp(&step(b)))?;
    let (median_step, gaps) = gaps(time)?;
    Some(Sampling {
        start: time[0],
        end: time[time.len() - 1],
        median_step,
        longest_step: step(longest),
        longest_step_before_sample: longest + 1,
        gaps: gaps.len(),
        repeated: (1..time.len()).filter(|&n| step(n) == 0.0).count(),
    })
}
