//! Summaries of a recording and of a model, for users who want to know what a file contains.

mod model;
mod stages;

pub use model::{ConfidenceSummary, LoadSummary, ModelSummary, Uncertain, inspect_model};
pub use stages::{ConstantSummary, StageSummary};

use crate::error::Result;
use crate::identify::determined;
use crate::model::Plane;
use crate::prepare::{Doubt, doubts};
use crate::recording::{GAP, Quantity, Recording, no_recordings, one_after_the_other};
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
    /// Number of recordings: each has a history of its own.
    pub segments: usize,
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
    /// Time of the last sample, in seconds. A clock that was set back may have it before the first.
    pub end: f64,
    /// Median time between samples of one recording, in seconds.
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

/// Summarises `recordings`, and counts the operators of `plane` that they excite and the
/// combinations of their weights that they determine. Several are parts of one experiment, such as
/// the segments of a file.
///
/// # Errors
/// [`crate::Error::Recording`] for an invalid recording, or none.
pub fn inspect_recording(
    recordings: &(impl AsRef<[Recording]> + ?Sized),
    plane: Plane,
) -> Result<RecordingSummary> {
    let recordings = recordings.as_ref();
    recordings.iter().try_for_each(Recording::check)?;
    let joined = one_after_the_other(recordings).ok_or_else(no_recordings)?;
    let series = |of: fn(&Recording) -> &Vec<f64>, quantity: &Quantity| {
        let (min, max) = range(of(&joined));
        let count = |band: f64| {
            let each = recordings.iter().map(|recording| {
                let mut turning = Turning::new(band);
                let turns = of(recording).iter().filter_map(|&v| turning.push(v));
                turns.count().saturating_sub(1) // the start is not a reversal
            });
            each.sum()
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
    let determined = determined(recordings, &joined.output, plane)?;
    let mut before = 0;
    let mut all_doubts = Vec::new();
    for recording in recordings {
        let found = doubts(recording)?.into_iter();
        all_doubts.extend(found.map(|doubt| doubt.after(before)));
        before += recording.len();
    }
    Ok(RecordingSummary {
        samples: joined.len(),
        segments: recordings.len(),
        input: series(|recording| &recording.input, &joined.input_quantity),
        output: series(|recording| &recording.output, &joined.output_quantity),
        time: sampling(recordings),
        levels: plane.levels(),
        plane: (plane.min(), plane.max()),
        operators: plane.operators(),
        excited: excited(recordings, plane),
        rank: determined.map(|(rank, _)| rank),
        determined: determined.map(|(_, against_noise)| against_noise),
        doubts: all_doubts,
    })
}

/// Counts the MKP operators whose states differ between samples of a recording.
///
/// After the first sample, from off, `γ = r_j(x)`. The state changes once some `r_j` is above this
/// value or some `r_i` is below it.
fn excited(recordings: &[Recording], plane: Plane) -> usize {
    let spans = recordings.iter().map(|recording| {
        let (low, high) = range(&recording.input);
        [recording.input[0], low, high].map(|t| plane.normalise(t))
    });
    let spans: Vec<[f64; 3]> = spans.collect();
    let moves = |i: usize, j: usize| {
        spans.iter().any(|&[first, low, high]| {
            let gamma = ridge(first, j);
            ridge(high, j) > gamma || ridge(low, i) < gamma
        })
    };
    (1..=plane.levels())
        .map(|j| (1..=j).filter(|&i| moves(i, j)).count())
        .sum()
}

/// The steps of time within recordings. `None` if one has no time, or none has two samples.
fn sampling(recordings: &[Recording]) -> Option<Sampling> {
    let times = recordings.iter().map(|recording| recording.time.as_deref());
    let times: Vec<&[f64]> = times.collect::<Option<_>>()?;
    let (mut before, mut steps) = (0, Vec::new());
    for time in &times {
        let within = time.windows(2).enumerate();
        steps.extend(within.map(|(n, pair)| (before + n + 1, pair[1] - pair[0])));
        before += time.len();
    }
    let (longest, longest_step) = steps.iter().max_by(|a, b| a.1.total_cmp(&b.1)).copied()?;
    let mut ordered: Vec<f64> = steps.iter().map(|(_, step)| *step).collect();
    let middle = ordered.len() / 2;
    let median_step = *ordered.select_nth_unstable_by(middle, f64::total_cmp).1;
    Some(Sampling {
        start: *times.first()?.first()?,
        end: *times.last()?.last()?,
        median_step,
        longest_step,
        longest_step_before_sample: longest + 1,
        gaps: steps
            .iter()
            .filter(|(_, step)| *step > GAP * median_step)
            .count(),
        repeated: steps.iter().filter(|(_, step)| *step == 0.0).count(),
    })
}
