//! Simulates any model, together with the series that it may need besides its input: time and load.

use crate::error::{Error, Result};
use crate::model::body::needs_time;
use crate::model::{Model, Sample, State};
use crate::recording::Recording;
use hysteron_core::Error as CoreError;
use hysteron_core::{Clipped, ClippedCount};
use std::borrow::Cow;

/// What accompanies an input. Each series is as long as the input. The time may have one number more
/// at its beginning: the time of the sample before the first one, to go on from a state that has
/// moved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Surroundings<'a> {
    /// Time in seconds; needed by a model that depends on it.
    pub time: Option<&'a [f64]>,
    /// The load; needed by a model that depends on one.
    pub load: Option<&'a [f64]>,
    /// The input long before the first sample: all stages were at rest with it. `None` if it was
    /// that of the first sample, and to go on from a state that has moved.
    pub rest: Option<f64>,
}

impl Model {
    /// The outputs for `input`, from the model's start ([`Model::start`]), for any model. `input`
    /// is what is given at each sample: it acts after the dead time of the model
    /// ([`Model::delay`]), in samples of the time, or of its own interval where there is no time.
    ///
    /// ```
    /// use hysteron::{FirstOrder, Model, Operator, Plane, Sign, Surroundings};
    /// let plane = Plane::new(1.0, 2.0, 2)?;
    /// let mut model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    /// model.thermal = Some(FirstOrder { gain: 2.0, ..FirstOrder::default() });
    /// let surroundings = Surroundings { time: Some(&[0.0, 1.0, 50.0]), load: None, rest: None };
    /// let output = model.simulate_in(&[0.0, 0.0, 1.0], surroundings)?;
    /// assert_eq!(output, [0.0, 0.0, 3.0]); // held for 49 s
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Model::run_in`].
    pub fn simulate_in(&self, input: &[f64], surroundings: Surroundings<'_>) -> Result<Vec<f64>> {
        let acting = self.acting(input, surroundings)?;
        let mut output = vec![0.0; input.len()];
        self.run_in(&mut self.start(), &acting, surroundings, &mut output)?;
        Ok(output)
    }

    /// The outputs for `input`, from the model's start ([`Model::start`]), behind its dead time.
    ///
    /// # Errors
    /// As [`Model::simulate_in`], which is for models that need time or load.
    pub fn simulate(&self, input: &[f64]) -> Result<Vec<f64>> {
        self.simulate_in(input, Surroundings::default())
    }

    /// The inputs that act at each sample of a series, from those given there: behind the dead time
    /// of the model ([`Model::delay`]). [`Model::run_in`] takes these.
    ///
    /// # Errors
    /// [`Error::Core`] for an input that is not finite, with its index, where there is a delay.
    pub fn acting<'i>(
        &self,
        input: &'i [f64],
        surroundings: Surroundings<'_>,
    ) -> Result<Cow<'i, [f64]>> {
        if self.delay().is_none() {
            return Ok(Cow::Borrowed(input));
        }
        match input.iter().position(|x| !x.is_finite()) {
            Some(index) => Err(CoreError::InputNotFinite { index }.into()),
            None => Ok(self
                .delay()
                .acting_after(surroundings.rest, input, surroundings.time)),
        }
    }

    /// Moves `state` through `input` and writes the outputs to `output`, which is at least as long.
    /// Returns how many inputs were clipped. For models that need neither time nor load.
    ///
    /// # Errors
    /// As [`Model::run_in`].
    pub fn run(
        &self,
        state: &mut State,
        input: &[f64],
        output: &mut [f64],
    ) -> Result<ClippedCount> {
        self.run_in(state, input, Surroundings::default(), output)
    }

    /// The outputs over a recording from `state`, and how many inputs were clipped. Whatever is
    /// said of a model on a recording comes from here: the error of its fit, of `evaluate`, of what
    /// was held out.
    pub(crate) fn run_over(
        &self,
        state: &mut State,
        recording: &Recording,
    ) -> Result<(Vec<f64>, ClippedCount)> {
        if let Some(load) = &self.load {
            load.check(recording)?;
        }
        let mut output = vec![0.0; recording.len()];
        let around = Surroundings::from_recording(self, recording);
        let clipped = self.run_in(state, &recording.input, around, &mut output)?;
        Ok((output, clipped))
    }

    /// Moves `state` through `input` and writes the outputs to `output`, which is at least as long.
    /// Returns how many inputs of the operators were clipped. The inputs are those that act: a
    /// state knows no dead time, so a caller shifts them ([`Model::acting`]). The time step of the
    /// first sample is zero, if `surroundings` does not tell the time before it.
    ///
    /// # Errors
    /// - [`Error::Core`] for an input that is not finite, with its index, a short `output`, and a
    ///   state of another model.
    /// - [`Error::Thermal`] for a model that depends on time without time, and for times that go
    ///   back.
    /// - [`Error::Fit`] for a model that depends on a load without a load, for a load with a model
    ///   that has none, and for series of different lengths.
    pub fn run_in(
        &self,
        state: &mut State,
        input: &[f64],
        surroundings: Surroundings<'_>,
        output: &mut [f64],
    ) -> Result<ClippedCount> {
        self.rest_at(state, surroundings)?;
        if self.is_plain() && surroundings.load.is_none() {
            return self.operators().run(&mut state.operators, input, output);
        }
        if output.len() < input.len() {
            let (needed, found) = (input.len(), output.len());
            return Err(CoreError::MemoryTooSmall { needed, found }.into());
        }
        let mut count = ClippedCount::default();
        for (sample, output) in surroundings.samples(self, input)?.zip(output) {
            let (index, sample) = sample;
            let step = self
                .step(state, sample)
                .map_err(|error| at_index(error, index))?;
            *output = step.output;
            match step.clipped {
                None => {}
                Some(Clipped::Low) => count.low += 1,
                Some(Clipped::High) => count.high += 1,
            }
        }
        Ok(count)
    }

    /// The inputs as the operators see them, from the model's start on: behind the thermal body,
    /// shifted by the load, behind the registration, on the uniform grid of the plane. The inputs
    /// are those that act ([`Model::acting`]).
    ///
    /// # Errors
    /// As [`Model::run_in`].
    pub fn seen<'i>(
        &self,
        input: &'i [f64],
        surroundings: Surroundings<'_>,
    ) -> Result<Cow<'i, [f64]>> {
        if self.is_plain() && surroundings.load.is_none() {
            return Ok(Cow::Borrowed(input));
        }
        Ok(Cow::Owned(self.along(input, surroundings, State::input)?))
    }

    /// The recording with the temperature as its input: behind the thermal body, if the model has
    /// one.
    ///
    /// # Errors
    /// [`Error::Thermal`] for a recording without time if there is a body. As [`Model::run_in`], if
    /// heat is bound.
    pub fn behind_body<'r>(&self, recording: &'r Recording) -> Result<Cow<'r, Recording>> {
        match &self.thermal {
            None => Ok(Cow::Borrowed(recording)),
            Some(body) if self.latent() == 0.0 => Ok(Cow::Owned(body.behind(recording)?)),
            Some(_) => {
                let around = Surroundings::from_recording(self, recording);
                Ok(Cow::Owned(Recording {
                    input: self.along(&recording.input, around, State::temperature)?,
                    rest: None,
                    ..recording.clone()
                }))
            }
        }
    }

    /// Moves `state` to where the series begin, at rest with the input before them, if there was
    /// another.
    pub(crate) fn rest_at(&self, state: &mut State, surroundings: Surroundings<'_>) -> Result<()> {
        let Some(input) = surroundings.rest else {
            return Ok(());
        };
        state.forget_stages();
        let first = surroundings.load.and_then(|load| load.first());
        let (dt, load) = (None, first.copied());
        self.step(state, Sample { input, dt, load })?;
        Ok(())
    }

    /// What the state shows after each sample, from the model's start on.
    fn along(
        &self,
        input: &[f64],
        surroundings: Surroundings<'_>,
        shown: impl Fn(&State) -> f64,
    ) -> Result<Vec<f64>> {
        let mut state = self.start();
        self.rest_at(&mut state, surroundings)?;
        let samples = surroundings.samples(self, input)?.map(|(index, sample)| {
            self.step(&mut state, sample)
                .map_err(|error| at_index(error, index))?;
            Ok(shown(&state))
        });
        samples.collect()
    }
}

impl<'a> Surroundings<'a> {
    /// Time, load and rest of a recording, as far as `model` needs them.
    #[must_use]
    pub fn from_recording(model: &Model, recording: &'a Recording) -> Self {
        Self {
            time: recording.time.as_deref().filter(|_| model.reads_time()),
            load: recording.load.as_deref().filter(|_| model.load.is_some()),
            rest: recording.rest.filter(|_| model.thermal.is_some()),
        }
    }

    /// The samples of `input` for `model`, numbered from 0.
    pub(crate) fn samples<'i>(
        self,
        model: &Model,
        input: &'i [f64],
    ) -> Result<impl Iterator<Item = (usize, Sample)> + use<'a, 'i>> {
        let time = match (model.is_timed(), self.time) {
            (false, _) => None,
            (true, None) => return Err(needs_time()),
            (true, Some(time)) => Some(time),
        };
        let before = usize::from(time.is_some_and(|time| time.len() == input.len() + 1));
        let of_samples = time.map(|time| &time[before..]);
        for (name, series) in [("times", of_samples), ("loads", self.load)] {
            if let Some(series) = series.filter(|series| series.len() != input.len()) {
                let (found, inputs) = (series.len(), input.len());
                return Err(Error::Fit(format!("{found} {name} for {inputs} samples")));
            }
        }
        let load = self.load;
        Ok(input.iter().enumerate().map(move |(n, &input)| {
            let at = n + before;
            let dt = time.map(|time| time[at] - time[at.saturating_sub(1)]);
            let load = load.map(|load| load[n]);
            (n, Sample { input, dt, load })
        }))
    }
}

/// The same error with the index of the sample, where it is one of a sample.
pub(crate) fn at_index(error: Error, index: usize) -> Error {
    match error {
        Error::Core(CoreError::InputNotFinite { .. }) => CoreError::InputNotFinite { index }.into(),
        other => other,
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
            ..FitOptions::plain()
        };
        let model = Fit::from(&options).run(&recording).unwrap();
        let around = Surroundings {
            time: None,
            load: Some(&load),
            rest: None,
        };
        let found = model.simulate_in(&input, around).unwrap();
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
