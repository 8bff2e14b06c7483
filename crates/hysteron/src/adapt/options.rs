//! How a model is adapted to a recording, and what follows from both where nothing is said.

use crate::adapt::adaptive::Adaptive;
use crate::adapt::basis::DriftBasis;
use crate::error::{Error, Result};
use crate::model::{Model, Start};
use crate::prepare::noise;
use crate::recording::Recording;
use crate::series::range;
use hysteron_core::{Adaptation, Method};
use serde::Serialize;

/// Gain of the gradient methods.
const GAIN: f64 = 0.3;
/// Levels between two updates from increments.
const SPAN: f64 = 1.0;
/// Forgetting factor of least squares, for weights and for coefficients.
const FORGETTING: [f64; 2] = [0.999, 0.9999];
/// Error of a reading, in parts of the output's range, for weights and for coefficients. So few coefficients err more, and alike from sample to
/// sample.
const MISFIT: [f64; 2] = [0.02, 0.05];
/// Share of the offset in the regressor of the gradient methods, in parts of that of all weights.
const OFFSET: f64 = 0.2;
/// Levels over which deviations of weights go together.
const CORRELATION: f64 = 1.0;
/// By how much the output with every operator on may differ, in parts of its range.
const DEVIATION: f64 = 0.3;
/// By how much a coefficient of a basis may differ.
const SHARE: f64 = 0.5;

/// Which parameters follow the error, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Learner {
    /// All weights by the normalised gradient.
    Gradient,
    /// All weights by the normalised gradient on increments.
    Increments,
    /// All weights by recursive least squares.
    LeastSquares,
    /// The coefficients of [`crate::DriftBasis`] by recursive least squares: with the defaults the one that errs least on measured recordings.
    #[default]
    Drift,
}

/// What [`crate::adapt`] may choose; where a field is `None`, it follows from model and recording. `Y` is the range of the
/// recording's output or that of the model, whichever is larger; single readings far from all
/// others are not of the recording's.
///
/// | field | default | range | purpose |
/// | --- | --- | --- | --- |
/// | `learner` | drift | see [`Learner`] | what follows the error, and how |
/// | `start` | off | off, on, unknown | where the operators stand before the first sample; unknown: off or on, with which the model as it is errs less |
/// | `load` | middle of its range | the model's | load that the coefficients start at, for [`Learner::Drift`] of a model that depends on one |
/// | `gain` | 0.3 | above 0, below 2 | gradient methods: share of a sample's error that is taken away |
/// | `span` | 1 | 1/8 to 8 | increments: levels between two updates |
/// | `forgetting` | weights: 0.999; coefficients: 0.9999 | above 0, up to 1 | least squares: what a sample counts after the next |
/// | `noise` | the output's [`noise`], and at least 2 % of `Y` for weights, 5 % for coefficients | above 0 | least squares: standard deviation of a reading's error, that of the model included; in the output's unit |
/// | `spread` | weights: such that their sum may deviate by 0.3 `Y`; coefficients: 0.5 | above 0 | least squares: standard deviation by which a parameter may differ from its off-line value |
/// | `correlation` | 1 | from 0 on | least squares of weights: levels over which deviations go together |
/// | `dead_zone` | twice the output's [`noise`] | from 0 on | errors up to this are noise; in the output's unit |
/// | `leakage` | 0 | 0 to 1 | share by which the weights return to the off-line ones with each update |
/// | `offset_share` | gradient methods: `0.2 √N`; least squares: such that the offset may deviate by 0.3 `Y` | from 0 on | how freely the offset moves, beside one weight or share |
/// | `movement` | 0.05 | from 0 on | levels that the input has to move before a sample is learned from |
/// | `trial` | 256 | from 1 on | samples after which the weights are judged against the last good ones |
/// | `gate` | 12 | 0, or from 2 on | a reading that surprises so many times more than usual is not learned from; 0: all are learned from |
/// | `burst` | 8 | from 1 on | readings in a row beyond the gate that are learned from, where they agree; samples at the end on probation |
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AdaptOptions {
    /// What follows the error, and how.
    pub learner: Learner,
    /// Where the operators stand before the first sample.
    pub start: Start,
    /// Load that the coefficients start at.
    pub load: Option<f64>,
    /// Gain of the gradient methods.
    pub gain: Option<f64>,
    /// Levels between two updates from increments.
    pub span: Option<f64>,
    /// Forgetting factor of least squares.
    pub forgetting: Option<f64>,
    /// Standard deviation of a reading's error.
    pub noise: Option<f64>,
    /// Standard deviation by which a parameter may differ from its off-line value.
    pub spread: Option<f64>,
    /// Levels over which deviations of weights go together.
    pub correlation: Option<f64>,
    /// Errors up to this are noise.
    pub dead_zone: Option<f64>,
    /// Share by which the weights return to the off-line ones with each update.
    pub leakage: Option<f64>,
    /// How freely the offset moves.
    pub offset_share: Option<f64>,
    /// Levels that the input has to move before a sample is learned from.
    pub movement: Option<f64>,
    /// Samples after which the weights are judged.
    pub trial: Option<u32>,
    /// How many times the usual surprise a reading may be off; see [`Adaptation`].
    pub gate: Option<f64>,
    /// Readings in a row beyond the gate that are a jump.
    pub burst: Option<u32>,
}

impl AdaptOptions {
    /// The estimator's options for `model` on `recording`.
    ///
    /// # Errors
    /// [`Error::Fit`] for a field that is given and that the learner does not use. What is out of range is refused
    /// when an estimator is made.
    pub fn adaptation(&self, model: &Model, recording: &Recording) -> Result<Adaptation<f64>> {
        let output = &recording.output;
        self.resolved(model, noise(output), usual_range(output))
    }

    /// The estimator's options for `model` before anything was measured: `Y` is the model's range, and the output is taken to
    /// have no noise.
    ///
    /// # Errors
    /// As [`AdaptOptions::adaptation`].
    pub fn before(&self, model: &Model) -> Result<Adaptation<f64>> {
        self.resolved(model, 0.0, 0.0)
    }

    /// An estimator for `model` in a loop, with the options of [`AdaptOptions::before`]. An unknown start is off.
    ///
    /// ```
    /// use hysteron::{AdaptOptions, Model, Operator, Plane, Sign};
    /// let plane = Plane::new(20.0, 80.0, 5)?;
    /// let model = Model::new(Operator::Mkp, plane, vec![1.0; 15], 0.0, Sign::Positive)?;
    /// let mut adaptive = AdaptOptions::default().adaptive(&model)?;
    /// let learning = adaptive.step(80.0, 16.0)?;
    /// assert_eq!(learning.error, 1.0);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`AdaptOptions::adaptation`], [`Adaptive::new`] and [`Adaptive::of_basis`].
    pub fn adaptive(&self, model: &Model) -> Result<Adaptive> {
        let mut adaptive = self.estimator(model, self.before(model)?)?;
        if self.start == Start::On {
            adaptive.saturate()?;
        }
        Ok(adaptive)
    }

    /// An estimator of weights or coefficients, as the learner asks for.
    pub(super) fn estimator(&self, model: &Model, adaptation: Adaptation<f64>) -> Result<Adaptive> {
        match self.learner {
            Learner::Drift => DriftBasis::of(model, self.load)?.adaptive(adaptation),
            _ => Adaptive::new(model, adaptation),
        }
    }

    fn resolved(&self, model: &Model, rough: f64, range: f64) -> Result<Adaptation<f64>> {
        self.refuse_unused(model)?;
        let (off, on) = model.output_range();
        let span = (on - off).abs().max(range);
        let usual = Adaptation::default();
        let drift = usize::from(self.learner == Learner::Drift);
        // An error of zero would be certainty.
        let misfit = rough.max(MISFIT[drift] * span).max(f64::EPSILON);
        let least_squares = |spread: f64, correlation| Method::LeastSquares {
            forgetting: self.forgetting.unwrap_or(FORGETTING[drift]),
            noise: self.noise.unwrap_or(misfit),
            spread: self.spread.unwrap_or(spread.max(f64::EPSILON)),
            correlation,
        };
        let gain = self.gain.unwrap_or(GAIN);
        let method = match self.learner {
            Learner::Gradient => Method::Gradient { gain },
            Learner::Increments => Method::Increments {
                gain,
                span: self.span.unwrap_or(SPAN),
            },
            Learner::LeastSquares => {
                let correlation = self.correlation.unwrap_or(CORRELATION);
                let spread =
                    DEVIATION * span / together(model.plane().levels(), correlation).sqrt();
                least_squares(spread, correlation)
            }
            Learner::Drift => least_squares(SHARE, 0.0),
        };
        let offset_share = match method {
            Method::LeastSquares { spread, .. } => DEVIATION * span / spread,
            _ => OFFSET * (model.plane().operators() as f64).sqrt(),
        };
        Ok(Adaptation {
            method,
            offset_share: self.offset_share.unwrap_or(offset_share),
            dead_zone: self.dead_zone.unwrap_or(2.0 * rough),
            leakage: self.leakage.unwrap_or(usual.leakage),
            movement: self.movement.unwrap_or(usual.movement),
            trial: self.trial.unwrap_or(usual.trial),
            gate: self.gate.unwrap_or(usual.gate),
            burst: self.burst.unwrap_or(usual.burst),
        })
    }

    fn refuse_unused(&self, model: &Model) -> Result<()> {
        use Learner::{Drift, Gradient, Increments, LeastSquares};
        let steps = matches!(self.learner, Gradient | Increments);
        let given = [
            ("gain", self.gain.is_some(), steps),
            ("span", self.span.is_some(), self.learner == Increments),
            ("forgetting", self.forgetting.is_some(), !steps),
            ("noise", self.noise.is_some(), !steps),
            ("spread", self.spread.is_some(), !steps),
            (
                "correlation",
                self.correlation.is_some(),
                self.learner == LeastSquares,
            ),
            (
                "load",
                self.load.is_some(),
                self.learner == Drift && model.load.is_some(),
            ),
        ];
        match given.iter().find(|(_, given, used)| *given && !used) {
            Some((name, ..)) => Err(Error::Fit(format!(
                "`{name}` means nothing to this method of adaptation: leave it out"
            ))),
            None => Ok(()),
        }
    }
}

/// The range of the values without those that lie further outside of the middle nine tenths than
/// these are wide: wrong readings.
fn usual_range(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let cut = sorted.len() / 20;
    let (low, high) = range(&sorted[cut..sorted.len() - cut]);
    let width = high - low;
    let near = |value: &f64| (low - width..=high + width).contains(value);
    let kept: Vec<f64> = sorted.into_iter().filter(near).collect();
    let (low, high) = range(&kept);
    high - low
}

/// The variance of the sum of all weights, for a variance of one of each and the estimator's correlation between them.
fn together(levels: usize, correlation: f64) -> f64 {
    // Pairs of operators that are `along` and `across` apart: as many as places for one of them from which the other is
    // on the triangle too.
    let levels = levels as isize;
    let mut sum = 0.0;
    for along in -levels..=levels {
        for across in -levels..=levels {
            let lowest = 1.max(1 - across);
            let highest = levels.min(levels - across);
            // For row j: i from max(1, 1 − along) to min(j, j + across − along).
            let places: isize = (lowest..=highest)
                .map(|j| (j.min(j + across - along) - 1.max(1 - along) + 1).max(0))
                .sum();
            let squared = (along * along + across * across) as f64;
            let goes = match squared == 0.0 {
                true => 1.0,
                false if correlation > 0.0 => 1.0 / (1.0 + squared / (correlation * correlation)),
                false => 0.0,
            };
            sum += places as f64 * goes;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::together;
    use hysteron_core::operators;

    #[test]
    fn the_variance_of_the_sum_is_that_of_all_pairs() {
        let all: Vec<_> = operators(6).collect();
        let mut sum = 0.0;
        for (i, j) in &all {
            for (k, l) in &all {
                let squared = i.abs_diff(*k).pow(2) + j.abs_diff(*l).pow(2);
                sum += 1.0 / (1.0 + squared as f64 / 4.0);
            }
        }
        // A few hundred terms in another order.
        assert!((together(6, 2.0) / sum - 1.0).abs() < 1e-12);
        assert_eq!(together(6, 0.0), 21.0);
    }
}
