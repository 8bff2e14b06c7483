//! The report of a preparation: what each step did.

use crate::prepare::judge::Judged;
use serde::Serialize;

/// Number of repaired samples that are listed.
const NAMED: usize = 10;

/// What [`crate::prepare()`] did, step by step. `None` for a step that was off, or for resampling
/// that was not needed. A step that was judged and not taken has done nothing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Preparation {
    /// Number of samples before.
    pub samples_before: usize,
    /// Number of samples after.
    pub samples: usize,
    /// Standard deviation of the white noise on the input after spikes were removed, in its unit;
    /// see [`crate::noise`].
    pub input_noise: f64,
    /// Standard deviation of the white noise on the output after spikes were removed, in its unit.
    pub output_noise: f64,
    /// Repaired signs and removed spikes.
    pub spikes: Option<Spikes>,
    /// The time between samples after resampling, s.
    pub resampled: Option<f64>,
    /// The low-pass filter.
    pub low_pass: Option<LowPass>,
    /// The sensor's lag.
    pub lag: Option<SensorLag>,
    /// The dead band.
    pub dead_band: Option<DeadBand>,
    /// What each step that was left to the data gained, in their order.
    pub judged: Vec<Judged>,
}

/// Repaired signs and removed spikes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Spikes {
    /// A sample is a spike if it is more than this many median absolute deviations from its
    /// neighbours; `None` if only signs were restored.
    pub deviations: Option<f64>,
    /// Repairs of the input.
    pub input: Repairs,
    /// Repairs of the output.
    pub output: Repairs,
}

/// Repaired samples of one series.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Repairs {
    /// Number of samples whose sign was restored.
    pub signs: usize,
    /// Number of samples that were replaced by linear interpolation between their neighbours.
    pub spikes: usize,
    /// The first ten of both, counted from 1 in the recording before the preparation.
    pub first: Vec<usize>,
}

impl Repairs {
    /// From indices counted from 0.
    pub(super) fn new(signs: &[usize], spikes: &[usize]) -> Self {
        let mut first: Vec<usize> = signs.iter().chain(spikes).map(|n| n + 1).collect();
        first.sort_unstable();
        first.truncate(NAMED);
        Self {
            signs: signs.len(),
            spikes: spikes.len(),
            first,
        }
    }
}

/// The zero-phase low-pass filter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LowPass {
    /// Filter of the input; `None` if there was too little noise.
    pub input: Option<Smoothed>,
    /// Filter of the output; `None` if there was too little noise.
    pub output: Option<Smoothed>,
    /// Whether the cut-offs are in Hz; otherwise they are in cycles per sample.
    pub in_hertz: bool,
}

/// The low-pass filter of one series.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Smoothed {
    /// The frequency at which its gain is ½.
    pub cutoff: f64,
    /// Root mean square of the part removed, in the unit of the series.
    pub removed: f64,
}

/// The lag of the input's sensor.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct SensorLag {
    /// The time constant that was undone, s; `None` if no lag improved the fit enough.
    pub undone: Option<f64>,
    /// The time constant that gives the best fit of a static model, s, if it was estimated.
    pub estimate: Option<f64>,
    /// RMSE of the static model before, in the output's unit.
    pub rmse_before: Option<f64>,
    /// RMSE of the static model with the estimated lag undone, in the output's unit.
    pub rmse_after: Option<f64>,
    /// The speed of the input per second, if a lag was estimated where all was recorded at about the
    /// same. A lag and a wider loop are then alike, so at other speeds it may be wrong.
    pub one_speed: Option<f64>,
}

/// The dead band for reversals of the input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DeadBand {
    /// Largest reversal that is taken as noise, in the input's unit.
    pub size: f64,
    /// Number of reversals removed.
    pub false_reversals: usize,
    /// Number of samples changed.
    pub samples_changed: usize,
    /// Largest change of a sample, in the input's unit.
    pub largest_change: f64,
}
