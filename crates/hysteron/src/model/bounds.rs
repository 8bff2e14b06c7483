//! Where the output may really be, whatever the model says: its band, and its error on data that
//! its fit did not see.

use crate::error::{Error, Result};
use crate::model::band::Band;
use crate::model::surroundings::at_index;
use crate::model::{INTERVAL, Model, OperatorState, State, Surroundings};
use crate::remedy::{Remedy, Setting};

/// Bounds around a modelled output, within which the output of the actuator may really be.
///
/// Half the width is the larger of two numbers, in the output's unit:
///
/// - that of the 95 % band ([`Model::band`]), where the fit made one;
/// - 1.96 times the root mean squared error on what was held out ([`FitSummary::held_out`]).
///
/// So a target that an inverse reports as reached is reached by the model. The actuator misses it by
/// as much as the model errs.
///
/// ```
/// use hysteron::{Fit, HoldOut, Recording, Target, fit_holding_out};
/// let input: Vec<f64> = (0..900).map(|n| 50.0 - 30.0 * (f64::from(n) * 0.05).cos()).collect();
/// let output = input.iter().enumerate().map(|(n, t)| 0.5 * t + (n as f64 * 7.0).sin()).collect();
/// let fit = Fit::new().levels(5).bootstrap(0);
/// let recording = Recording::new(input, output)?;
/// let (model, held_out) = fit_holding_out(&fit, &recording, &HoldOut::Branches(0.2))?;
/// let bounds = model.bounds()?.ok_or("there was something held out")?;
/// let mut state = model.start();
/// model.inverse()?.step(&mut state, Target::new(25.0))?; // really between 25 - half and 25 + half
/// let half = bounds.at(&state)?;
/// assert!(half >= 1.95 * held_out.model.rmse);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// [`FitSummary::held_out`]: crate::FitSummary::held_out
#[derive(Debug, Clone)]
pub struct Bounds {
    band: Option<Band>,
    /// Half the width from what was held out; 0 where nothing was.
    held_out: f64,
}

impl Model {
    /// Where the output may really be. `None` for a model that has neither a band nor an error on
    /// data that its fit did not see.
    ///
    /// # Errors
    /// As [`Model::band`].
    pub fn bounds(&self) -> Result<Option<Bounds>> {
        let band = self.band()?;
        let held_out = self.fit.as_ref().and_then(|fit| fit.held_out());
        Ok((band.is_some() || held_out.is_some()).then(|| Bounds {
            band,
            held_out: INTERVAL * held_out.unwrap_or_default(),
        }))
    }

    /// The lower and the upper end of the bounds at each sample of `input`, from `state` on.
    /// `input` is what acts, as for [`Model::run_in`].
    ///
    /// # Errors
    /// As [`Model::run_in`]; [`Error::Fit`] for a model that has no bounds.
    pub fn bounds_in(
        &self,
        state: &State,
        input: &[f64],
        surroundings: Surroundings<'_>,
    ) -> Result<(Vec<f64>, Vec<f64>)> {
        let Some(bounds) = self.bounds()? else {
            let what = "the model has neither a 95 % band nor an error on data not fitted";
            let bootstrap = Setting::number("bootstrap", 200);
            let remedy = Remedy::new("fit it again with {}", [bootstrap]);
            return Err(Error::Fit(what.into()).remedied(remedy));
        };
        let mut state = state.clone();
        self.rest_at(&mut state, surroundings)?;
        let mut states = bounds.states(&state)?;
        let mut ends = (Vec::new(), Vec::new());
        for (index, sample) in surroundings.samples(self, input)? {
            let step = self.step(&mut state, sample);
            let output = step.map_err(|error| at_index(error, index))?.output;
            let half = bounds.step(&mut states, state.input())?;
            ends.0.push(output - half);
            ends.1.push(output + half);
        }
        Ok(ends)
    }
}

impl Bounds {
    /// What [`Bounds::step`] moves, where the model is in `state`.
    ///
    /// # Errors
    /// As [`Band::states`].
    pub fn states(&self, state: &State) -> Result<Vec<OperatorState>> {
        self.band
            .as_ref()
            .map_or(Ok(Vec::new()), |band| band.states(state))
    }

    /// Moves `states` to `input`, which is what the operators see ([`State::input`]), and returns
    /// half the width there, in the output's unit.
    ///
    /// # Errors
    /// As [`Band::step`].
    pub fn step(&self, states: &mut [OperatorState], input: f64) -> Result<f64> {
        let of_band = match &self.band {
            Some(band) => band.step(states, input)?,
            None => 0.0,
        };
        Ok(of_band.max(self.held_out))
    }

    /// Half the width where the model is in `state`, in the output's unit.
    ///
    /// # Errors
    /// As [`Bounds::states`].
    pub fn at(&self, state: &State) -> Result<f64> {
        self.step(&mut self.states(state)?, state.input())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::model::summary::FitSummary;
    use crate::model::{Confidence, LoadPart, Plane, Sign};
    use hysteron_core::Operator;
    use rand::{RngExt, SeedableRng};

    /// A model whose weights are certain to within `factor` of each.
    fn model(factor: Option<f64>, held_out: serde_json::Value) -> Model {
        let plane = Plane::new(20.0, 80.0, 7).unwrap();
        let mut model =
            Model::new(Operator::Mkp, plane, vec![1.0; 28], 3.0, Sign::Positive).unwrap();
        let confidence = factor.map(|factor| Confidence {
            noise: 0.25,
            factors: vec![LoadPart {
                offset: 0.1,
                weights: vec![factor; 28],
            }],
            ..Confidence::default()
        });
        let mut fit = FitSummary {
            confidence,
            ..FitSummary::default()
        };
        fit.other.insert("hold_out".into(), held_out);
        model.fit = Some(fit);
        model
    }

    fn errors(rmse: f64) -> serde_json::Value {
        serde_json::json!({"model": {"rmse": rmse}, "rivals": []})
    }

    #[test]
    fn they_are_the_wider_of_band_and_held_out_error_in_any_state() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        for rmse in [0.0, 0.2, 0.5, 5.0] {
            let model = model(Some(0.05), errors(rmse));
            let (band, bounds) = (model.band().unwrap().unwrap(), model.bounds().unwrap());
            let bounds = bounds.unwrap();
            let mut state = model.start();
            let mut stepped = bounds.states(&state).unwrap();
            let mut of_band = band.states(&state).unwrap();
            for _ in 0..300 {
                model
                    .step(&mut state, rng.random_range(10.0..90.0))
                    .unwrap();
                let wider = band.step(&mut of_band, state.input()).unwrap();
                let wider = wider.max(INTERVAL * rmse);
                assert_eq!(bounds.step(&mut stepped, state.input()).unwrap(), wider);
                // The history is added up in another order.
                assert!((bounds.at(&state).unwrap() - wider).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_model_that_does_not_know_its_error_has_none() {
        let strange = [
            serde_json::json!(null),
            serde_json::json!("8 %"),
            serde_json::json!({"model": {"rmse": "8"}}),
            errors(-1.0),
            errors(1e300),
        ];
        for entry in strange {
            assert!(model(None, entry).bounds().unwrap().is_none());
        }
        let known = model(None, errors(0.5));
        let bounds = known.bounds().unwrap().unwrap();
        assert_eq!(bounds.at(&known.start()).unwrap(), INTERVAL * 0.5);
        let around = Surroundings::default();
        let (low, high) = known.bounds_in(&known.start(), &[50.0], around).unwrap();
        let output = known.simulate(&[50.0]).unwrap()[0];
        let half = INTERVAL * 0.5;
        assert_eq!((low[0], high[0]), (output - half, output + half));
        let unknown = model(None, errors(-1.0));
        let refused = unknown.bounds_in(&unknown.start(), &[50.0], around);
        assert!(
            refused
                .unwrap_err()
                .to_string()
                .contains("neither a 95 % band")
        );
    }
}
