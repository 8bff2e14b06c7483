//! The options of a preparation.

use crate::error::{Error, Result};

/// What a step of the preparation does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Step {
    /// Use the value that follows from the data.
    #[default]
    Auto,
    /// Skip the step.
    Off,
    /// Use this value.
    Value(f64),
}

/// The steps of [`prepare`](crate::prepare()), in their order.
///
/// A step that is `auto` is taken only if it lowers the error of a model on parts of the recording
/// that the model was not fitted to; a low-pass, only if it does so on a simulated recording like
/// this one, with the noise found. A step with a value is taken as it is.
///
/// | field | default | value | unit |
/// | --- | --- | --- | --- |
/// | `signs` | off | on, off | |
/// | `spikes` | auto | above 0 | median absolute deviations |
/// | `resample` | auto | above 0 | s |
/// | `low_pass` | auto | above 0, below half the sampling rate | Hz; without time cycles/sample |
/// | `lag` | off | above 0 | s |
/// | `dead_band` | auto | 0 or more | unit of the input |
/// | `believe` | off | on, off | |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrepareOptions {
    /// Restoration of lost signs: some meters show only the magnitude just below zero. It turns
    /// good readings over where no sign was lost, so it is done only where it is asked for.
    pub signs: bool,
    /// Removal of spikes. The value is the number of deviations from which on a sample is a spike.
    /// Auto: 4, or more in a long recording, so that noise is no spike; and also bursts of wrong
    /// readings, and readings that were held while the series moved on.
    pub spikes: Step,
    /// Resampling to equal time steps of this length. Auto: the median step, and only if the time
    /// is irregular and a filter needs equal steps.
    pub resample: Step,
    /// Zero-phase low-pass filter; the value is the cut-off for both series. Auto: for each series,
    /// the cut-off that removes as much as the noise. No filter if the noise is below 0.05 % of the
    /// range.
    pub low_pass: Step,
    /// Compensation of the lag of the input's sensor; the value is its time constant. Auto: the
    /// time constant that gives the best fit of a static model, if that fit is 10 % better. This is
    /// valid only if the material does not depend on rate.
    pub lag: Step,
    /// Dead band: reversals of the input up to this are noise. Auto: the largest reversal that
    /// noise causes in this number of samples, `2√(2 ln n) σ`.
    pub dead_band: Step,
    /// Prepares also what cannot be believed, see [`doubts`](crate::doubts). Otherwise such a
    /// recording is refused.
    pub believe: bool,
}

impl Default for PrepareOptions {
    fn default() -> Self {
        Self {
            lag: Step::Off,
            believe: false,
            ..Self::all(Step::Auto)
        }
    }
}

impl PrepareOptions {
    /// The same choice for every step, without the restoration of signs. The recording is
    /// believed.
    #[must_use]
    pub fn all(step: Step) -> Self {
        Self {
            signs: false,
            spikes: step,
            resample: step,
            low_pass: step,
            lag: step,
            dead_band: step,
            believe: true,
        }
    }

    pub(super) fn check(&self) -> Result<()> {
        let above_zero = [
            (self.spikes, "the deviations that make a spike"),
            (self.resample, "the step of resampling"),
            (self.low_pass, "the cut-off of the low-pass"),
            (self.lag, "the time constant of the sensor"),
        ];
        for (step, name) in above_zero {
            match step {
                Step::Value(value) if !(value.is_finite() && value > 0.0) => {
                    return Err(Error::Preparation(format!(
                        "{name} must be a number above zero, not {value}"
                    )));
                }
                _ => {}
            }
        }
        match self.dead_band {
            Step::Value(band) if !(band.is_finite() && band >= 0.0) => Err(Error::Preparation(
                format!("the dead band must be zero or above, not {band}"),
            )),
            _ => Ok(()),
        }
    }
}
