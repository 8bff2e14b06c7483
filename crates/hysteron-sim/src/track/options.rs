//! How the plant's model is identified, what the loops share, and how they learn.

use hysteron::control::Compensator;
use hysteron::{AdaptOptions, Adaptation, Adaptive, Learner, Model, Plane, Result};
use serde::Deserialize;
use std::path::PathBuf;

/// The plane, and the experiment that its weights are identified from.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelOptions {
    /// Number of levels, from 2 to 100.
    pub levels: usize,
    /// Lowest and highest level, in the input's unit. For the wire, the lowest and the highest drive
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
    /// Test and rule that the PID is tuned by. Default `relay`.
    pub tuning: Tuning,
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
}

/// How the adaptive controllers learn.
///
/// What is left out has the default of [`AdaptOptions`](hysteron::AdaptOptions), which follows from
/// the model that was identified. Ranges are those given there, too.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AdaptationOptions {
    /// What follows the error, and how. Default `least-squares`.
    pub method: MethodName,
    /// Gain of the gradient methods. Default 0.3.
    pub gain: Option<f64>,
    /// Levels between two updates of `increments`. Default 1.
    pub span: Option<f64>,
    /// Forgetting factor of `least-squares`. Default 0.999.
    pub forgetting: Option<f64>,
    /// Standard deviation of the error of a reading, in the output's unit. Default 2 % of the
    /// model's range.
    pub noise: Option<f64>,
    /// Standard deviation by which a weight may differ from the off-line one, in the output's unit.
    /// Default such that the sum of the weights may deviate by 30 % of the model's range.
    pub spread: Option<f64>,
    /// Distance, in levels, over which deviations of weights go together. Default 1.
    pub correlation: Option<f64>,
    /// How freely the offset moves, beside one weight. Default 0.2 √N for N weights with the
    /// gradient methods; with `least-squares` such that the offset may deviate by 30 % of the
    /// model's range.
    pub offset_share: Option<f64>,
    /// Errors up to this are noise, in the output's unit. Default 0.
    pub dead_zone: Option<f64>,
    /// Share by which weights return to the off-line ones with each update. Default 0.
    pub leakage: Option<f64>,
    /// Levels that the input has to move before a sample is learned from. Default 0.05.
    pub movement: Option<f64>,
    /// Samples after which the weights are judged against the last good ones. Default 256.
    pub trial: Option<u32>,
    /// How many times the usual surprise a reading may be off to be learned from; 0: any. Default
    /// 12.
    pub gate: Option<f64>,
    /// Readings in a row beyond the gate that are learned from, where they agree. Default 8.
    pub burst: Option<u32>,
}

/// Name of a method of adaptation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MethodName {
    /// [`Learner::Gradient`].
    Gradient,
    /// [`Learner::Increments`].
    Increments,
    /// [`Learner::LeastSquares`].
    #[default]
    LeastSquares,
    /// [`Learner::Load`].
    Load,
}

impl From<MethodName> for Learner {
    fn from(name: MethodName) -> Self {
        match name {
            MethodName::Gradient => Self::Gradient,
            MethodName::Increments => Self::Increments,
            MethodName::LeastSquares => Self::LeastSquares,
            MethodName::Load => Self::Load,
        }
    }
}

impl AdaptationOptions {
    /// The estimator's options for `model`. The method [`Load`](MethodName::Load) has none of this
    /// kind.
    ///
    /// # Errors
    /// [`hysteron::Error::Fit`] for an option that the method does not use. What is out of range is
    /// refused when an estimator is made.
    pub fn resolve(&self, model: &Model) -> Result<Adaptation<f64>> {
        self.options().before(model)
    }

    /// A model that learns in the loop.
    ///
    /// # Errors
    /// As [`AdaptationOptions::resolve`], and for options out of range.
    pub(super) fn compensator(&self, model: &Model) -> Result<Compensator> {
        Ok(match self.method {
            MethodName::Load => Compensator::load(self.options().adaptive_load(model)?),
            _ => Compensator::adaptive(Adaptive::new(model, self.resolve(model)?)?),
        })
    }

    fn options(&self) -> AdaptOptions {
        AdaptOptions {
            learner: self.method.into(),
            gain: self.gain,
            span: self.span,
            forgetting: self.forgetting,
            noise: self.noise,
            spread: self.spread,
            correlation: self.correlation,
            dead_zone: self.dead_zone,
            leakage: self.leakage,
            offset_share: self.offset_share,
            movement: self.movement,
            trial: self.trial,
            gate: self.gate,
            burst: self.burst,
            ..AdaptOptions::default()
        }
    }
}
