//! How the plant's model is identified, what the loops share, and what learns in them.

use hysteron::control::Compensator;
use hysteron::{AdaptOptions, Learner, Model, Plane, Result};
use serde::Deserialize;
use std::path::PathBuf;

/// The plane, and the experiment that its weights are identified from.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelOptions {
    /// Number of levels, from 2 to 100.
    pub levels: usize,
    /// Lowest and highest level, in the input's unit. For a wire, the lowest and the highest drive
    /// of the tests; the levels of its temperature follow from the recording.
    pub range: (f64, f64),
    /// Strength of the smoothness across, from 0; see [`Smooth`](hysteron::Smooth). Default 0.
    #[serde(default)]
    pub smooth: f64,
    /// How fast the input rises and falls in the experiment, in its unit per second; both above 0.
    pub rates: (f64, f64),
    /// A model file to use instead of an experiment. Its plane must be the one named here.
    pub file: Option<PathBuf>,
}

impl ModelOptions {
    /// The plane.
    ///
    /// # Errors
    /// As [`Plane::new`].
    pub(super) fn plane(&self) -> Result<Plane> {
        Ok(Plane::new(self.range.0, self.range.1, self.levels)?)
    }
}

/// What all controllers share.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LoopOptions {
    /// Time constant of the filter on the readings, s, from 0. Default 0: none.
    pub filter_s: f64,
    /// The inverse does not follow reversals of the reference up to this size, in the output's
    /// unit, from 0. Default 0.
    pub tolerance: f64,
    /// How long before it is due the controllers are told the reference, s, from 0. Default 0. An
    /// inverse of a model with a thermal body uses it: it heats or cools in time.
    pub preview_s: f64,
    /// Samples until a drive moves the output that is read, up to 1001. By default one, and the
    /// dead time of the model. The inverse solves for the reference of so many samples later.
    pub delay: Option<usize>,
    /// Test and rule that the PID is tuned by. Default `relay`.
    pub tuning: Tuning,
    /// How many times faster than the test asks `pi-rls` makes the closed loop, above 0. Default 1.
    pub speed: Option<f64>,
}

/// Test and rule that the gains of the PID come from, the same for all controllers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tuning {
    /// Relay test, Tyreus & Luyben 1992.
    #[default]
    Relay,
    /// Step test on the rising branch, SIMC (Skogestad 2003).
    Step,
    /// Simulation of the loop around the model of each run ([`joint`](crate::joint)), with the
    /// inverse where the controller has one. So each controller has gains of its own.
    Model,
}

/// A model that learns in the loop of the adaptive controllers.
///
/// # Errors
/// As [`AdaptOptions::adaptive`] and [`AdaptOptions::adaptive_load`].
pub fn compensator(options: &AdaptOptions, model: &Model) -> Result<Compensator> {
    Ok(match options.learner {
        Learner::Load => Compensator::load(options.adaptive_load(model)?),
        _ => Compensator::adaptive(options.adaptive(model)?),
    })
}
