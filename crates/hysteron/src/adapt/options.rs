//! What the options of an adaptation come to: defaults follow from the model and the recording.

use crate::adapt::adaptive::Adaptive;
use crate::adapt::basis::DriftBasis;
use crate::adapt::learner::{AdaptOptions, Learner};
use crate::adapt::load::AdaptiveLoad;
use crate::adapt::mixture::AutoOptions;
use crate::adapt::refit::Refit;
use crate::error::{Error, Result};
use crate::model::{Model, Start};
use crate::recording::Recording;
use crate::series::noise::noise;
use crate::series::range;
use hysteron_core::{Adaptation, Method, ShiftOptions};

/// Share of an increment's error that is removed.
const GAIN: f64 = 0.3;
/// Levels between two updates from increments.
const SPAN: f64 = 1.0;
/// Forgetting factor of least squares, for weights and for coefficients.
const FORGETTING: [f64; 2] = [0.999, 0.9999];
/// Error of a reading as a share of the output's range, for weights and for coefficients. It is
/// larger for coefficients, because a few coefficients fit less well and their errors are
/// correlated between samples.
const MISFIT: [f64; 2] = [0.02, 0.05];
/// How freely the offset moves beside increments, relative to all weights together.
const OFFSET: f64 = 0.2;
/// Correlation length of the weights' deviations, in levels.
const CORRELATION: f64 = 1.0;
/// Standard deviation of the output with every operator on, as a share of its range.
const DEVIATION: f64 = 0.3;
/// Standard deviation of each coefficient.
const SHARE: f64 = 0.5;

/// The options that a learner runs with, all of them known.
// A handful of these exist at a time, and copying is what they are for.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EstimatorOptions {
    /// Nothing learns.
    Fixed,
    /// Those of several learners side by side.
    Auto(AutoOptions),
    /// Those of an estimator of weights or coefficients, from sample to sample.
    Weights(Adaptation<f64>),
    /// Those of a windowed refit.
    Refit(Refit),
    /// Those of the estimator of the shift.
    Shift(ShiftOptions<f64>),
}

/// Most operators of a model that [`Learner::Auto`] takes a matrix for: 44 levels have 990.
const SQUARED: usize = 1000;

impl AdaptOptions {
    /// The options of the learner for `model` on `recording`.
    ///
    /// # Errors
    /// [`Error::Fit`] for a field that is set but that the learner does not use. Values out of
    /// range are refused when a learner is made.
    pub fn resolve(&self, model: &Model, recording: &Recording) -> Result<EstimatorOptions> {
        let output = &recording.output;
        self.resolved(model, noise(output), usual_range(output))
    }

    /// The options of an estimator for `model` before any measurement. `Y` is the model's range,
    /// and the output is assumed to have no noise.
    ///
    /// # Errors
    /// As [`AdaptOptions::resolve`]; [`Error::Fit`] for [`Learner::Auto`], [`Learner::Fixed`],
    /// [`Learner::Refit`] and [`Learner::Load`], which are no estimators of weights.
    pub fn before(&self, model: &Model) -> Result<Adaptation<f64>> {
        self.resolved(model, 0.0, 0.0)?.estimator()
    }

    /// A learner for `model` in a loop, with the options of [`AdaptOptions::before`]. An unknown
    /// start is taken as off.
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
    /// As [`AdaptOptions::resolve`], [`Adaptive::new`] and [`Adaptive::of_basis`].
    pub fn adaptive(&self, model: &Model) -> Result<Adaptive> {
        self.begun(model, self.resolved(model, 0.0, 0.0)?)
    }

    /// As [`AdaptOptions::adaptive`], but a mixture has no refit: no sample takes much longer than
    /// the others.
    ///
    /// # Errors
    /// As [`AdaptOptions::adaptive`].
    pub fn adaptive_in_time(&self, model: &Model) -> Result<Adaptive> {
        let mut options = self.resolved(model, 0.0, 0.0)?;
        if let EstimatorOptions::Auto(auto) = &mut options {
            auto.refit = None;
        }
        self.begun(model, options)
    }

    /// As [`AdaptOptions::adaptive`], with the options that follow from a recording of the plant.
    /// It learns nothing from it.
    ///
    /// # Errors
    /// As [`AdaptOptions::adaptive`].
    pub fn adaptive_after(&self, model: &Model, recording: &Recording) -> Result<Adaptive> {
        self.begun(model, self.resolve(model, recording)?)
    }

    fn begun(&self, model: &Model, options: EstimatorOptions) -> Result<Adaptive> {
        let mut adaptive = self.learner(model, options)?;
        if self.start == Start::On {
            adaptive.saturate()?;
        }
        Ok(adaptive)
    }

    /// An estimator of the shift of `model`'s axis in a loop: of a load that nobody measures. The
    /// learner has to be [`Learner::Load`].
    ///
    /// # Errors
    /// [`Error::Fit`] for another learner, for options that this one does not use, and as
    /// [`AdaptiveLoad::new`].
    pub fn adaptive_load(&self, model: &Model) -> Result<AdaptiveLoad> {
        let options = self.resolved(model, 0.0, 0.0)?.shift()?;
        let mut adaptive = AdaptiveLoad::new(model, self.load, options)?;
        if self.start == Start::On {
            adaptive.saturate();
        }
        Ok(adaptive)
    }

    /// What learns the weights or the coefficients.
    pub(super) fn learner(&self, model: &Model, options: EstimatorOptions) -> Result<Adaptive> {
        match options {
            EstimatorOptions::Refit(refit) => {
                return Adaptive::refitting(&DriftBasis::of(model, self.load)?.model, refit);
            }
            EstimatorOptions::Fixed => return Adaptive::fixed(model),
            EstimatorOptions::Auto(options) => {
                return Adaptive::mixing(DriftBasis::of(model, self.load)?, options);
            }
            EstimatorOptions::Weights(_) | EstimatorOptions::Shift(_) => {}
        }
        let adaptation = options.estimator()?;
        match self.learner {
            Learner::Drift => DriftBasis::of(model, self.load)?.adaptive(adaptation),
            _ => Adaptive::new(model, adaptation),
        }
    }

    fn resolved(&self, model: &Model, rough: f64, range: f64) -> Result<EstimatorOptions> {
        self.refuse_unused()?;
        if self.load.is_some() && model.load.is_none() {
            let what = "`load`: this model does not depend on a load: leave it out";
            return Err(Error::Fit(what.into()));
        }
        Ok(match self.learner {
            Learner::Fixed => EstimatorOptions::Fixed,
            Learner::Auto => {
                let of = |learner| Self { learner, ..*self }.weights(model, rough, range);
                let few = model.plane().operators() <= SQUARED;
                EstimatorOptions::Auto(AutoOptions {
                    drift: of(Learner::Drift),
                    increments: of(Learner::Increments),
                    least_squares: few.then(|| of(Learner::LeastSquares)),
                    refit: few.then(|| self.windowed()),
                })
            }
            Learner::Refit => EstimatorOptions::Refit(self.windowed()),
            Learner::Load => EstimatorOptions::Shift(self.shift(model, rough, range)),
            _ => EstimatorOptions::Weights(self.weights(model, rough, range)),
        })
    }

    /// The options of a refit.
    fn windowed(&self) -> Refit {
        let usual = Refit::default();
        Refit {
            window: self.window.unwrap_or(usual.window),
            every: self.every,
            ridge: self.ridge.unwrap_or(usual.ridge),
            movement: self.movement.unwrap_or(usual.movement),
            gate: self.gate.unwrap_or(usual.gate),
            burst: self.burst.unwrap_or(usual.burst),
        }
    }

    /// The options of the estimator of the shift.
    fn shift(&self, model: &Model, rough: f64, range: f64) -> ShiftOptions<f64> {
        let usual = AdaptiveLoad::usual_options(model);
        let misfit = rough.max(usual.noise).max(MISFIT[1] * range);
        ShiftOptions {
            noise: self.noise.unwrap_or(misfit),
            spread: self.spread.unwrap_or(usual.spread),
            dead_zone: self.dead_zone.unwrap_or(2.0 * rough),
            movement: self.movement.unwrap_or(usual.movement),
            gate: self.gate.unwrap_or(usual.gate),
            burst: self.burst.unwrap_or(usual.burst),
            ..usual
        }
    }

    /// The options of an estimator of weights or coefficients.
    fn weights(&self, model: &Model, rough: f64, range: f64) -> Adaptation<f64> {
        // Of the operators: what is behind them is undone before anything is learned.
        let (off, on) = match model.load {
            None => model.within().output_range(),
            Some(_) => model.output_range(),
        };
        let span = (on - off).abs().max(range);
        let usual = Adaptation::default();
        let drift = usize::from(self.learner == Learner::Drift);
        // An error of zero would mean certainty and stop all learning.
        let misfit = rough.max(MISFIT[drift] * span).max(f64::EPSILON);
        let least_squares = |spread: f64, correlation| Method::LeastSquares {
            forgetting: self.forgetting.unwrap_or(FORGETTING[drift]),
            noise: self.noise.unwrap_or(misfit),
            spread: self.spread.unwrap_or(spread.max(f64::EPSILON)),
            correlation,
        };
        let method = match self.learner {
            Learner::LeastSquares => {
                let correlation = self.correlation.unwrap_or(CORRELATION);
                let spread =
                    DEVIATION * span / variance_of_sum(model.plane().levels(), correlation).sqrt();
                least_squares(spread, correlation)
            }
            Learner::Drift => least_squares(SHARE, 0.0),
            // The others do not estimate weights by themselves.
            Learner::Increments
            | Learner::Auto
            | Learner::Fixed
            | Learner::Refit
            | Learner::Load => Method::Increments {
                gain: self.gain.unwrap_or(GAIN),
                span: self.span.unwrap_or(SPAN),
            },
        };
        let offset_share = match method {
            Method::LeastSquares { spread, .. } => DEVIATION * span / spread,
            _ => OFFSET * (model.plane().operators() as f64).sqrt(),
        };
        Adaptation {
            method,
            offset_share: self.offset_share.unwrap_or(offset_share),
            dead_zone: self.dead_zone.unwrap_or(2.0 * rough),
            leakage: self.leakage.unwrap_or(usual.leakage),
            movement: self.movement.unwrap_or(usual.movement),
            trial: self.trial.unwrap_or(usual.trial),
            gate: self.gate.unwrap_or(usual.gate),
            burst: self.burst.unwrap_or(usual.burst),
        }
    }
}

impl EstimatorOptions {
    fn estimator(self) -> Result<Adaptation<f64>> {
        match self {
            Self::Weights(adaptation) => Ok(adaptation),
            Self::Fixed | Self::Auto(_) | Self::Refit(_) | Self::Shift(_) => Err(Error::Fit(
                "this needs a learner that estimates weights: `drift`, `least-squares` or \
                 `increments`"
                    .into(),
            )),
        }
    }

    pub(super) fn shift(self) -> Result<ShiftOptions<f64>> {
        match self {
            Self::Shift(options) => Ok(options),
            _ => Err(Error::Fit(
                "only the learner `load` estimates the shift".into(),
            )),
        }
    }

    /// Whether a learner with these looks for channels that stand still.
    pub(super) fn watches(self) -> bool {
        self.gate().0 > 0.0
    }

    /// The gate, and the readings in a row that pass it where they agree.
    pub(super) fn gate(self) -> (f64, u32) {
        match self {
            Self::Fixed => (0.0, 0),
            Self::Auto(AutoOptions { drift, .. }) => (drift.gate, drift.burst),
            Self::Weights(Adaptation { gate, burst, .. }) => (gate, burst),
            Self::Refit(Refit { gate, burst, .. }) => (gate, burst),
            Self::Shift(ShiftOptions { gate, burst, .. }) => (gate, burst),
        }
    }
}

/// The range of the values without wrong readings. The middle nine tenths of the values span a
/// width; a value is wrong if it is more than this width outside.
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

/// The variance of the sum of all weights, for a variance of one of each weight and the estimator's
/// correlation between them.
fn variance_of_sum(levels: usize, correlation: f64) -> f64 {
    // The number of pairs of operators that are `along` and `across` apart: the number of positions
    // of the first one for which the second is inside the triangle.
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
    use super::variance_of_sum;
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
        // A few hundred terms, summed in another order.
        assert!((variance_of_sum(6, 2.0) / sum - 1.0).abs() < 1e-12);
        assert_eq!(variance_of_sum(6, 0.0), 21.0);
    }
}
