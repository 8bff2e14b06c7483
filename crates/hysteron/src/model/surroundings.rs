//! Simulates any model, together with the series that it may need besides its input: the time, for
//! a thermal body, and the load. Also computes the band around that output.

use crate::error::{Error, Result};
use crate::model::Model;
use crate::model::band::ends;
use crate::model::body::needs_time;
use crate::remedy::{Remedy, Setting};
use std::borrow::Cow;

/// The series that accompany an input. Each is as long as the input.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Surroundings<'a> {
    /// Time in seconds; needed by a model with a thermal body.
    pub time: Option<&'a [f64]>,
    /// The load; needed by a model that depends on one.
    pub load: Option<&'a [f64]>,
}

impl Model {
    /// The outputs for `input`, from every operator off, for any model. The input passes through
    /// the thermal body, if there is one, and the load is taken into account. For a plain model
    /// this equals [`Model::simulate`].
    ///
    /// ```
    /// use hysteron::{FirstOrder, Model, Operator, Plane, Sign, Surroundings};
    /// let plane = Plane::new(1.0, 2.0, 2)?;
    /// let mut model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    /// model.thermal = Some(FirstOrder { gain: 2.0, tau_heating: 1.0, tau_cooling: 1.0 });
    /// let surroundings = Surroundings { time: Some(&[0.0, 1.0, 50.0]), load: None };
    /// let output = model.simulate_in(&[0.0, 1.0, 1.0], surroundings)?;
    /// assert_eq!(output, [0.0, 0.0, 3.0]); // a held drive heats for as long as it is held
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// - As [`Model::run`].
    /// - [`Error::Thermal`] for a model with a thermal body without time, and for times that go
    ///   back.
    /// - [`Error::Fit`] for a model that depends on a load without a load, and for a load with a
    ///   model that has none.
    pub fn simulate_in(&self, input: &[f64], surroundings: Surroundings<'_>) -> Result<Vec<f64>> {
        self.at(&self.seen(input, surroundings)?, surroundings)
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
            let what = "the model does not say how certain it is";
            let bootstrap = Setting::number("bootstrap", 200);
            let remedy = Remedy::new("fit it again with {}", [bootstrap]);
            return Err(Error::Fit(what.into()).remedied(remedy));
        };
        let seen = self.seen(input, surroundings)?;
        let output = self.at(&seen, surroundings)?;
        let half = band.run(&seen)?;
        Ok(ends(&output, &half))
    }

    /// The input as the operators see it: behind the thermal body.
    fn seen<'i>(&self, input: &'i [f64], around: Surroundings<'_>) -> Result<Cow<'i, [f64]>> {
        let Some(body) = &self.thermal else {
            return Ok(Cow::Borrowed(input));
        };
        let time = around.time.ok_or_else(needs_time)?;
        Ok(Cow::Owned(body.respond(time, input)?))
    }

    fn at(&self, seen: &[f64], around: Surroundings<'_>) -> Result<Vec<f64>> {
        match (&self.load, around.load) {
            (None, None) => self.operators().simulate(seen),
            (_, Some(load)) => self.simulate_under_load(seen, load),
            (Some(dependence), None) => Err(dependence.one_is_needed()),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::identify::{Fit, FitOptions};
    use crate::recording::Recording;

    fn swings() -> Vec<f64> {
        (0..400)
            .map(|n| 50.0 - 30.0 * (f64::from(n) * 0.1).cos())
            .collect()
    }

    #[test]
    fn a_load_is_followed_and_asked_for() {
        let input = swings();
        let load: Vec<f64> = (0..400).map(|n| f64::from(n % 40)).collect();
        let output = input.iter().zip(&load).map(|(t, s)| t * (1.0 + s / 40.0));
        let mut recording = Recording::new(input.clone(), output.collect()).unwrap();
        recording.load = Some(load.clone());
        let options = FitOptions {
            levels: 5,
            bootstrap: 10,
            ..FitOptions::default()
        };
        let model = Fit::from(&options).run(&recording).unwrap();
        let around = Surroundings {
            time: None,
            load: Some(&load),
        };
        let found = model.simulate_in(&input, around).unwrap();
        assert_eq!(found, model.simulate_under_load(&input, &load).unwrap());
        let sample = crate::model::Sample {
            load: Some(load[0]),
            ..input[0].into()
        };
        let stepped = model.step(&mut model.start(), sample).unwrap().output;
        assert_eq!(stepped, found[0]);
        let mut without_parts = model.operators().start().into();
        assert!(model.step(&mut without_parts, sample).is_err());
        let (low, high) = model.band_in(&input, around).unwrap();
        let inside = |n: usize| low[n] < found[n] && found[n] < high[n];
        assert!((0..400).all(inside));
        let refused = model
            .simulate_in(&input, Surroundings::default())
            .unwrap_err();
        assert!(refused.to_string().contains("`load`"), "{refused}");
        let plain = model.at_load(3.0).unwrap();
        assert!(plain.simulate_in(&input, around).is_err());
        assert_eq!(
            plain.simulate_in(&input, Surroundings::default()).unwrap(),
            plain.simulate(&input).unwrap()
        );
    }
}
