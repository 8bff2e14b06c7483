//! What a preparation did.

use serde::Serialize;

/// How many places are named.
const NAMED: usize = 10;

/// What [`crate::prepare`] did, step by step; `None` for a step that was off, or for resampling
/// that was not needed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Preparation {
    /// Samples of the recording as it came.
    pub samples_before: usize,
    /// Samples of the result.
    pub samples: usize,
    /// Standard deviation of the white noise on the input, without spikes, in its unit: see
    /// [`crate::noise`].
    pub input_noise: f64,
    /// The same of the output.
    pub output_noise: f64,
    /// Lost signs and isolated spikes.
    pub spikes: Option<Spikes>,
    /// The time between samples that was taken, s.
    pub resampled: Option<f64>,
    /// The low-pass.
    pub low_pass: Option<LowPass>,
    /// The sensor's lag.
    pub lag: Option<SensorLag>,
    /// The dead band.
    pub dead_band: Option<DeadBand>,
}

/// Lost signs and isolated spikes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Spikes {
    /// How many median absolute deviations from its neighbours make a spike.
    pub deviations: f64,
    /// Those of the input.
    pub input: Repairs,
    /// Those of the output.
    pub output: Repairs,
}

/// Repaired samples of one series.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Repairs {
    /// Samples that were given their sign back.
    pub signs: usize,
    /// Samples that were replaced by the line between their neighbours.
    pub spikes: usize,
    /// The first ten of both, counted from 1 in the recording as it came.
    pub first: Vec<usize>,
}

impl Repairs {
    /// From places counted from 0.
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

/// The zero-phase low-pass.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LowPass {
    /// That of the input; `None` where there was too little noise to ask for one.
    pub input: Option<Smoothed>,
    /// That of the output.
    pub output: Option<Smoothed>,
    /// Whether the cut-offs are in Hz; otherwise they are in cycles a sample.
    pub in_hertz: bool,
}

/// The low-pass of one series.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Smoothed {
    /// Where its gain is ½.
    pub cutoff: f64,
    /// Root mean square of what it took away, in the unit of the series.
    pub removed: f64,
}

/// The lag of the input's sensor.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct SensorLag {
    /// The time constant that was undone, s; `None` where none was worth while.
    pub undone: Option<f64>,
    /// The time constant with which a static model fits best, s, where it was looked for.
    pub estimate: Option<f64>,
    /// RMSE of the static model before, in the output's unit.
    pub rmse_before: Option<f64>,
    /// RMSE with the estimated lag undone.
    pub rmse_after: Option<f64>,
}

/// The dead band for reversals of the input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DeadBand {
    /// Reversals up to this are none, in the input's unit.
    pub size: f64,
    /// Reversals that went.
    pub false_reversals: usize,
    /// Samples that were moved.
    pub samples_changed: usize,
    /// The furthest that one was, in the input's unit.
    pub largest_change: f64,
}
