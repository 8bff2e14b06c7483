//! How the plant's model is identified, what the loops share, and how they learn.

use hysteron::{Adaptation, Method};
use hysteron::{Plane, Result};
use serde::Deserialize;
use std::path::PathBuf;

/// The plane, and the experiment that its weights are identified from.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelOptions {
    /// Number of levels, from 2 to 100.
    pub levels: usize,
    /// Lowest and highest level, in the input's unit.
    pub range: (f64, f64),
    /// Strength of the smoothness, from 0; see [`FitOptions::smooth`](hysteron::FitOptions::smooth). Default 0.
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
    /// Reversals of the reference up to this size are not followed by the inverse, in the output's unit, from 0. Default 0.
    pub tolerance: f64,
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

/// How the adaptive controllers learn; ranges as for [`Adaptation`] and [`Method`].
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AdaptationOptions {
    /// The method. Default least squares.
    pub method: MethodName,
    /// Gain of the gradient methods. Default 0.3.
    pub gain: f64,
    /// Levels between two updates of `increments`. Default 1.
    pub span: f64,
    /// Forgetting factor of `least-squares`. Default 0.9995.
    pub forgetting: f64,
    /// Standard deviation of the error of a reading, in the output's unit. Default 0.3.
    pub noise: f64,
    /// Standard deviation by which a weight may differ from the off-line one, in the output's unit. Default 0.05.
    pub spread: f64,
    /// Distance, in levels, over which deviations of weights go together. Default 3.
    pub correlation: f64,
    /// How freely the offset moves, beside one weight. Default 10.
    pub offset_share: f64,
    /// Errors up to this are noise, in the output's unit. Default 0.
    pub dead_zone: f64,
    /// Share by which weights return to the off-line ones with each update. Default 0.
    pub leakage: f64,
    /// Levels that the input has to move before a sample is learned from. Default 0.02.
    pub movement: f64,
    /// How many times the usual surprise a reading may be off to be learned from; 0: any. Default
    /// 12.
    pub gate: f64,
    /// Readings in a row beyond the gate that are learned from, where they agree. Default 8.
    pub burst: u32,
}

/// Name of a method of adaptation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MethodName {
    /// [`Method::Gradient`].
    Gradient,
    /// [`Method::Increments`].
    Increments,
    /// [`Method::LeastSquares`].
    LeastSquares,
}

impl Default for AdaptationOptions {
    fn default() -> Self {
        Self {
            method: MethodName::LeastSquares,
            gain: 0.3,
            span: 1.0,
            forgetting: 0.9995,
            noise: 0.3,
            spread: 0.05,
            correlation: 3.0,
            offset_share: 10.0,
            dead_zone: 0.0,
            leakage: 0.0,
            movement: 0.02,
            gate: 12.0,
            burst: 8,
        }
    }
}

impl From<AdaptationOptions> for Adaptation<f64> {
    fn from(options: AdaptationOptions) -> Self {
        let AdaptationOptions {
            gain,
            span,
            forgetting,
            noise,
            spread,
            correlation,
            ..
        } = options;
        let method = match options.method {
            MethodName::Gradient => Method::Gradient { gain },
            MethodName::Increments => Method::Increments { gain, span },
            MethodName::LeastSquares => Method::LeastSquares {
                forgetting,
                noise,
                spread,
                correlation,
            },
        };
        Self {
            method,
            offset_share: options.offset_share,
            dead_zone: options.dead_zone,
            leakage: options.leakage,
            movement: options.movement,
            gate: options.gate,
            burst: options.burst,
            ..Self::default()
        }
    }
}
