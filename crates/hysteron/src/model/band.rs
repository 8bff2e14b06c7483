//! The 95 % band around the modelled output, from the uncertainty of the weights and from what that
//! does not explain.

use crate::error::{Error, Result};
use crate::model::confidence::{Confidence, INTERVAL, band_name};
use crate::model::load::LoadPart;
use crate::model::{Model, OperatorState, Operators, State, Surroundings};
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use serde::Serialize;

/// The 95 % prediction band of a model with confidence.
///
/// A factor `f` of the confidence is a joint deviation of offset and weights by one standard
/// deviation. The resulting deviation of the output is a forward run with these weights, so each
/// factor takes `O(1)` per sample. The factors and the noise `ν` are independent, so their squares
/// add: half the width is `1.96 · √(Σ_f (δ_f + Σ δμ_f γ)² + ν²)`.
///
/// ```
/// use hysteron::{FitOptions, Recording, Fit};
/// let input: Vec<f64> = (0..300).map(|n| 50.0 - 30.0 * (f64::from(n) * 0.1).cos()).collect();
/// let noisy = |(n, t): (usize, &f64)| 0.5 * t + 0.1 * (n as f64 * 7.0).sin();
/// let output = input.iter().enumerate().map(noisy).collect();
/// let options = FitOptions { levels: 5, bootstrap: 50, ..FitOptions::plain() };
/// let model = Fit::from(&options).run(&Recording::new(input, output)?)?;
/// let band = model.band()?.ok_or("a bootstrap was asked for")?;
/// let half_width = band.run(&model.off(), &[20.0, 60.0, 40.0])?;
/// assert!(half_width.iter().all(|h| (0.1..1.0).contains(h)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Band {
    factors: Vec<Operators>,
    noise: f64,
    sessions: usize,
}

impl Model {
    /// The prediction band. `None` for a model without confidence or without factors. If the model
    /// depends on a load, the band is that of the middle of the load range.
    ///
    /// # Errors
    /// [`Error::ModelFile`] if a factor does not have as many weights as the model.
    pub fn band(&self) -> Result<Option<Band>> {
        match self.fit.as_ref().and_then(|fit| fit.confidence.as_ref()) {
            Some(confidence) if !confidence.factors.is_empty() => {
                Band::new(self, confidence).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// The lower and the upper end of the 95 % band around [`Model::simulate_in`].
    ///
    /// # Errors
    /// As [`Model::simulate_in`]; [`Error::Fit`] for a model without a band.
    pub fn band_in(
        &self,
        input: &[f64],
        surroundings: Surroundings<'_>,
    ) -> Result<(Vec<f64>, Vec<f64>)> {
        let Some(band) = self.band()? else {
            let what = "the model has no 95 % band";
            let bootstrap = Setting::number("bootstrap", 200);
            let remedy = Remedy::new("fit it again with {}", [bootstrap]);
            return Err(Error::Fit(what.into()).remedied(remedy));
        };
        let output = self.simulate_in(input, surroundings)?;
        let acting = self.acting(input, surroundings)?;
        let half = band.run(&self.start(), &self.seen(&acting, surroundings)?)?;
        Ok(ends(&output, &half))
    }
}

impl Band {
    fn new(model: &Model, confidence: &Confidence) -> Result<Self> {
        let factor = |(n, part): (usize, &LoadPart)| {
            let weights = part.weights.clone();
            Operators::new(
                model.operator(),
                *model.plane(),
                weights,
                part.offset,
                model.sign(),
            )
            .map_err(|error| Error::ModelFile {
                path: None,
                field: format!("fit.confidence.factors[{n}]"),
                problem: error.to_string(),
            })
        };
        let factors = confidence.factors.iter().enumerate();
        Ok(Self {
            factors: factors.map(factor).collect::<Result<_>>()?,
            noise: confidence.noise,
            sessions: confidence.sessions,
        })
    }

    /// The states of all factors where the model is in `state`: they have the same history.
    ///
    /// # Errors
    /// As [`Model::restore`], for the state of another plane.
    pub fn states(&self, state: &State) -> Result<Vec<OperatorState>> {
        let history: Vec<f64> = state.turning_points().collect();
        let of_factor = |factor: &Operators| match history.is_empty() {
            true => Ok(factor.start()),
            false => factor.restore(&history, state.input()),
        };
        self.factors.iter().map(of_factor).collect()
    }

    /// Moves `states` to `input` and returns half the width of the band there, in the output's
    /// unit.
    ///
    /// # Errors
    /// As [`Model::step`].
    pub fn step(&self, states: &mut [OperatorState], input: f64) -> Result<f64> {
        let mut variance = self.noise * self.noise;
        for (factor, state) in self.factors.iter().zip(states) {
            variance += factor.step(state, input)?.output.powi(2);
        }
        Ok(INTERVAL * variance.sqrt())
    }

    /// Half the width of the band at each sample of `input`, in the output's unit, from `state` on.
    /// `input` is what the operators see, see [`Model::seen`].
    ///
    /// # Errors
    /// As [`Model::run`] and [`Band::states`].
    pub fn run(&self, state: &State, input: &[f64]) -> Result<Vec<f64>> {
        if let Some(index) = input.iter().position(|x| !x.is_finite()) {
            return Err(hysteron_core::Error::InputNotFinite { index }.into());
        }
        let mut variance = vec![self.noise * self.noise; input.len()];
        for (factor, mut state) in self.factors.iter().zip(self.states(state)?) {
            add_variance(factor, &mut state, input, &mut variance)?;
        }
        let half_width = |variance: f64| INTERVAL * variance.sqrt();
        Ok(variance.into_iter().map(half_width).collect())
    }
}

/// Samples of a block.
const BLOCK: usize = 4096;

/// Adds the variance of the output that a factor causes, at each sample of `input`, which is finite.
pub(crate) fn add_variance(
    factor: &Operators,
    state: &mut OperatorState,
    input: &[f64],
    variance: &mut [f64],
) -> Result<()> {
    // In blocks, because a whole output would take as much memory as the input.
    let mut output = vec![0.0; BLOCK.min(input.len())];
    for (input, variance) in input.chunks(BLOCK).zip(variance.chunks_mut(BLOCK)) {
        let output = &mut output[..input.len()];
        factor.run(state, input, output)?;
        for (variance, deviation) in variance.iter_mut().zip(&*output) {
            *variance += deviation * deviation;
        }
    }
    Ok(())
}

/// Lower and upper end of the band around a modelled output.
pub(crate) fn ends(output_model: &[f64], half_width: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let pairs = output_model.iter().zip(half_width);
    pairs.map(|(y, half)| (y - half, y + half)).unzip()
}

/// The prediction band over a recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BandEvaluation {
    /// Half the width at each sample, in the output's unit.
    pub half_width: Vec<f64>,
    /// Share of the measured samples inside the band, in percent. About 95 if the recording is
    /// similar to those fitted.
    pub coverage_percent: f64,
    /// Number of sessions that the band knows, as in [`Confidence::sessions`].
    pub sessions: usize,
}

impl BandEvaluation {
    /// What the band is called wherever it is drawn or written: a band of one session promises
    /// nothing for another.
    #[must_use]
    pub fn name(&self) -> String {
        band_name(self.sessions)
    }

    /// Lower and upper end of the band around the modelled output.
    #[must_use]
    pub fn ends(&self, output_model: &[f64]) -> (Vec<f64>, Vec<f64>) {
        ends(output_model, &self.half_width)
    }

    /// The band of `model` on `recording` from the state `begin` on. `output_model` is the modelled
    /// output.
    pub(crate) fn new(
        model: &Model,
        begin: &State,
        recording: &Recording,
        output_model: &[f64],
    ) -> Result<Option<Self>> {
        let Some(band) = model.band()? else {
            return Ok(None);
        };
        let around = Surroundings::from_recording(model, recording);
        let half_width = band.run(begin, &model.seen(&recording.input, around)?)?;
        let modelled = output_model.iter().zip(&half_width);
        let inside = recording
            .output
            .iter()
            .zip(modelled)
            .filter(|(y, (h, half))| (*y - *h).abs() <= **half)
            .count();
        Ok(Some(Self {
            sessions: band.sessions,
            coverage_percent: 100.0 * inside as f64 / recording.len() as f64,
            half_width,
        }))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::model::Plane;
    use crate::model::Sign;
    use crate::model::summary::FitSummary;
    use hysteron_core::Definition;
    use hysteron_core::Operator;
    use rand::{RngExt, SeedableRng};

    /// A model with random `factors`, and an input that moves over and beyond its plane.
    fn uncertain(operator: Operator, sign: Sign, factors: usize) -> (Model, Vec<f64>) {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(factors as u64);
        let plane = Plane::new(20.0, 80.0, 7).unwrap();
        let mut draw = |count: usize| -> Vec<f64> {
            (0..count).map(|_| rng.random_range(-1.0..1.0)).collect()
        };
        let mut model = Model::new(operator, plane, vec![1.0; 28], 3.0, sign).unwrap();
        let factors = (0..factors).map(|_| LoadPart {
            offset: draw(1)[0],
            weights: draw(28),
        });
        model.fit = Some(FitSummary {
            confidence: Some(Confidence {
                noise: 0.25,
                factors: factors.collect(),
                ..Confidence::default()
            }),
            ..FitSummary::default()
        });
        let input = draw(2 * BLOCK + 300)
            .into_iter()
            .map(|x| 50.0 + 45.0 * x)
            .collect();
        (model, input)
    }

    #[test]
    fn equals_the_definition_summed_over_the_factors() {
        for operator in [Operator::Mkp, Operator::Kp, Operator::Relay] {
            for sign in [Sign::Positive, Sign::Negative] {
                let (model, input) = uncertain(operator, sign, 5);
                let band = model.band().unwrap().unwrap();
                let found = band.run(&model.off(), &input).unwrap();
                let mut states = band.states(&model.off()).unwrap();
                let factors = &model
                    .fit
                    .as_ref()
                    .unwrap()
                    .confidence
                    .as_ref()
                    .unwrap()
                    .factors;
                let mut variance = vec![0.25 * 0.25; input.len()];
                for factor in factors {
                    let mut gamma = vec![0.0; 28];
                    let plane = *model.plane();
                    let mut plain =
                        Definition::new(plane, operator, &factor.weights, &mut gamma).unwrap();
                    for (variance, &t) in variance.iter_mut().zip(&input) {
                        let sum = plain.step(t).unwrap();
                        *variance += (factor.offset + sign.factor() * sum).powi(2);
                    }
                }
                for (n, &t) in input.iter().enumerate() {
                    let expected = INTERVAL * variance[n].sqrt();
                    // Rounding of sums of 28 weights.
                    assert!((found[n] - expected).abs() < 1e-12, "{operator:?}, {n}");
                    assert!((band.step(&mut states, t).unwrap() - expected).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn from_any_state_the_band_goes_on_as_after_its_history() {
        for operator in [Operator::Mkp, Operator::Kp, Operator::Relay] {
            let (model, input) = uncertain(operator, Sign::Positive, 4);
            let band = model.band().unwrap().unwrap();
            let whole = band.run(&model.off(), &input).unwrap();
            for cut in [1, 7, 100, 250] {
                let mut state = model.off();
                for &t in &input[..cut] {
                    model.step(&mut state, t).unwrap();
                }
                let rest = band.run(&state, &input[cut..]).unwrap();
                for (a, b) in rest.iter().zip(&whole[cut..]) {
                    // The sums of the history are added in another order.
                    assert!((a - b).abs() < 1e-12, "{operator:?}, {cut}");
                }
            }
        }
    }

    #[test]
    fn an_input_that_is_no_number_is_named() {
        let (model, mut input) = uncertain(Operator::Mkp, Sign::Positive, 2);
        input[BLOCK + 7] = f64::NAN;
        let band = model.band().unwrap().unwrap();
        let error = band.run(&model.off(), &input).unwrap_err();
        let at = hysteron_core::Error::InputNotFinite { index: BLOCK + 7 };
        assert_eq!(error.to_string(), crate::Error::from(at).to_string());
    }

    #[test]
    fn the_coverage_counts_the_samples_inside() {
        let (model, input) = uncertain(Operator::Mkp, Sign::Positive, 3);
        let half = model
            .band()
            .unwrap()
            .unwrap()
            .run(&model.off(), &input)
            .unwrap();
        let modelled = model.simulate(&input).unwrap();
        // Every fourth sample is just outside, the others are just inside, above and below in turn.
        let output = (0..input.len())
            .map(|n| {
                let share = if n % 4 == 0 { 1.001 } else { 0.999 };
                modelled[n] + half[n] * if n % 2 == 0 { share } else { -share }
            })
            .collect();
        let recording = Recording::new(input, output).unwrap();
        let band = crate::evaluate::evaluate(&model, &recording)
            .unwrap()
            .band
            .unwrap();
        assert_eq!(band.coverage_percent, 75.0);
        assert_eq!(band.half_width, half);
    }

    #[test]
    fn there_is_none_without_factors_and_wrong_ones_are_named() {
        let (mut model, _) = uncertain(Operator::Mkp, Sign::Positive, 0);
        assert!(model.band().unwrap().is_none());
        model.fit = None;
        assert!(model.band().unwrap().is_none());
        let (mut model, _) = uncertain(Operator::Mkp, Sign::Positive, 2);
        let confidence = model.fit.as_mut().unwrap().confidence.as_mut().unwrap();
        confidence.factors[1].weights.pop();
        let error = model.band().unwrap_err().to_string();
        assert!(
            error.contains("fit.confidence.factors[1]") && error.contains("28"),
            "{error}"
        );
    }
}
