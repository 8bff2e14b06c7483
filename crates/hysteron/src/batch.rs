//! Many actuators at once: a fleet, an ensemble, or one model with many inputs.

use crate::error::{Error, Result};
use crate::model::{Model, State, Surroundings, no_load};
use crate::parallel;
use hysteron_core::{ClippedCount, Error as CoreError};
use std::sync::Arc;

/// A thread is given as many samples as this or more: some 50 µs of work.
const SAMPLES_OF_A_THREAD: usize = 1 << 14;

/// A number of lanes beyond this is a mistake, whose memory would end the program.
const MOST_LANES: usize = 1 << 24;

/// Many models with a state each, which move together. A *lane* is one model with its state.
///
/// The lanes may have models of their own, with other planes, operators and stages, or share one
/// model. Each gives the same outputs and the same state as its model alone ([`Model::run_in`]), to
/// the last bit. Many samples are divided among all threads, lane by lane.
///
/// Inputs and outputs are row by row: first all samples of lane 0, then all of lane 1. The inputs
/// are those that act: a lane knows no dead time ([`Model::acting`]).
///
/// ```
/// use hysteron::{BatchModel, Model, Operator, Plane, Sign};
/// let plane = Plane::new(20.0, 80.0, 3)?; // degC
/// let weights = vec![1.0, 0.5, 1.0, 0.0, 0.5, 1.0];
/// let model = Model::new(Operator::Mkp, plane, weights, 10.0, Sign::Positive)?;
///
/// let mut batch = BatchModel::new(model, 2)?; // one model, two inputs
/// let inputs = [20.0, 80.0, 50.0, /* lane 1 */ 80.0, 50.0, 80.0];
/// let mut outputs = [0.0; 6];
/// batch.run(&inputs, &mut outputs)?;
/// assert_eq!(outputs, [11.0, 14.0, 13.0, 14.0, 13.0, 14.0]);
///
/// batch.step(&[80.0, 20.0], &mut outputs[..2])?; // one input for each lane
/// assert_eq!(outputs[..2], [14.0, 11.5]);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BatchModel {
    lanes: Vec<Lane>,
}

#[derive(Debug, Clone, PartialEq)]
struct Lane {
    model: Arc<Model>,
    state: State,
}

impl<M: Into<Arc<Model>>> FromIterator<M> for BatchModel {
    /// A lane for each model, at its start ([`Model::start`]). Models in an [`Arc`] are shared.
    ///
    /// ```
    /// # use hysteron::{BatchModel, Model, Operator, Plane, Sign};
    /// let model = |max| -> hysteron::Result<Model> {
    ///     let plane = Plane::new(0.0, max, 2)?;
    ///     Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)
    /// };
    /// let mut batch: BatchModel = [model(1.0)?, model(2.0)?].into_iter().collect();
    /// let mut outputs = [0.0; 2];
    /// batch.step(&[1.0, 1.0], &mut outputs)?;
    /// assert_eq!(outputs, [3.0, 2.0]);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    fn from_iter<I: IntoIterator<Item = M>>(models: I) -> Self {
        let lane = |model: M| {
            let model = model.into();
            let state = model.start();
            Lane { model, state }
        };
        Self {
            lanes: models.into_iter().map(lane).collect(),
        }
    }
}

impl BatchModel {
    /// As many lanes of one model, each at its start ([`Model::start`]).
    ///
    /// # Errors
    /// [`Error::Fit`] for more than 2²⁴ lanes.
    pub fn new(model: impl Into<Arc<Model>>, lanes: usize) -> Result<Self> {
        if lanes > MOST_LANES {
            return Err(Error::Fit(format!(
                "{lanes} lanes: a batch has at most {MOST_LANES}"
            )));
        }
        let model = model.into();
        Ok(std::iter::repeat_n(model, lanes).collect())
    }

    /// The number of lanes.
    #[must_use]
    pub fn lanes(&self) -> usize {
        self.lanes.len()
    }

    /// The models, one for each lane.
    pub fn models(&self) -> impl ExactSizeIterator<Item = &Arc<Model>> {
        self.lanes.iter().map(|lane| &lane.model)
    }

    /// The states, one for each lane.
    pub fn states(&self) -> impl ExactSizeIterator<Item = &State> {
        self.lanes.iter().map(|lane| &lane.state)
    }

    /// Brings all lanes back to their start ([`Model::start`]).
    pub fn reset(&mut self) {
        for lane in &mut self.lanes {
            lane.state = lane.model.start();
        }
    }

    /// Moves every lane through its row of `inputs` and writes the outputs to `outputs`: lanes ×
    /// samples numbers each, in the units of the models. For models that need neither time nor
    /// load. Returns how many inputs were clipped.
    ///
    /// # Errors
    /// As [`BatchModel::run_in`].
    pub fn run(&mut self, inputs: &[f64], outputs: &mut [f64]) -> Result<ClippedCount> {
        self.run_in(inputs, Surroundings::default(), outputs)
    }

    /// As [`BatchModel::run`], for any models. The time in seconds is that of all lanes, one number
    /// for a sample or one more as in [`Surroundings`]. The loads are lanes × samples numbers. A
    /// lane that does not depend on one of them takes no notice of it.
    ///
    /// ```
    /// # use hysteron::{BatchModel, FirstOrder, Model, Operator, Plane, Sign, Surroundings};
    /// let plane = Plane::new(1.0, 2.0, 2)?;
    /// let plain = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    /// let mut heated = plain.clone();
    /// heated.thermal = Some(FirstOrder { gain: 2.0, ..FirstOrder::default() });
    /// let mut batch: BatchModel = [plain, heated].into_iter().collect();
    /// let around = Surroundings { time: Some(&[0.0, 50.0]), load: None, rest: None };
    /// let mut outputs = [0.0; 4];
    /// batch.run_in(&[0.0, 1.0, 0.0, 1.0], around, &mut outputs)?;
    /// assert_eq!(outputs, [0.0, 1.0, 0.0, 3.0]); // the body is at twice the drive
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// - [`Error::Fit`] for inputs, outputs, times or loads whose number does not fit, and for
    ///   loads that no lane depends on.
    /// - [`Error::Lane`] with the number of the lane and its error, one of those of
    ///   [`Model::run_in`]: an input that is not finite, a time or a load that is missing or
    ///   refused. Of several lanes with an error it is the first with an input that is not finite,
    ///   or else the first one.
    ///
    /// After an error all states are as before. The outputs then have no meaning.
    pub fn run_in(
        &mut self,
        inputs: &[f64],
        surroundings: Surroundings<'_>,
        outputs: &mut [f64],
    ) -> Result<ClippedCount> {
        let samples = self.samples(inputs, surroundings, outputs.len())?;
        if samples == 0 {
            return Ok(ClippedCount::default());
        }
        if surroundings.rest.is_some_and(|rest| !rest.is_finite()) {
            return Err(CoreError::InputNotFinite { index: 0 }.into());
        }
        if let Some(n) = inputs.iter().position(|input| !input.is_finite()) {
            let index = n % samples;
            return Err(Error::from(CoreError::InputNotFinite { index }).in_lane(n / samples));
        }
        let rows = inputs
            .chunks_exact(samples)
            .zip(outputs.chunks_exact_mut(samples));
        let jobs = self.lanes.iter_mut().zip(rows).enumerate();
        let jobs = jobs.map(|(number, (Lane { model, state }, (input, output)))| {
            let rows = number * samples..(number + 1) * samples;
            let load = surroundings.load.filter(|_| model.load.is_some());
            Job {
                number,
                model,
                state,
                input,
                load: load.map(|load| &load[rows]),
                output,
            }
        });
        let (mut plain, mut staged): (Vec<_>, Vec<_>) = jobs.partition(|job| job.model.is_plain());
        let least = SAMPLES_OF_A_THREAD.div_ceil(samples);
        // A stage can refuse a sample in the middle. So these lanes move in copies of their states.
        let moved = parallel::map_mut(&mut staged, least, |job| {
            let mut state = job.state.clone();
            let clipped = job.run(&mut state, surroundings)?;
            Ok((state, clipped))
        });
        let moved = moved.into_iter().collect::<Result<Vec<_>>>()?;
        // These have been checked: from here on nothing is refused.
        let clipped = parallel::map_mut(&mut plain, least, |job| {
            let around = Surroundings {
                rest: surroundings.rest,
                ..Surroundings::default()
            };
            let run = job.model.run_in(job.state, job.input, around, job.output);
            run.map_err(|error| error.in_lane(job.number))
        });
        let mut all = clipped.into_iter().collect::<Result<Vec<_>>>()?;
        for (job, (state, clipped)) in staged.into_iter().zip(moved) {
            *job.state = state;
            all.push(clipped);
        }
        Ok(ClippedCount {
            low: all.iter().map(|count| count.low).sum(),
            high: all.iter().map(|count| count.high).sum(),
        })
    }

    /// Moves every lane by one sample: one of `inputs` and one of `outputs` for each lane. For
    /// models that need neither time nor load. Returns how many inputs were clipped.
    ///
    /// # Errors
    /// As [`BatchModel::run_in`]. After an error all states are as before.
    pub fn step(&mut self, inputs: &[f64], outputs: &mut [f64]) -> Result<ClippedCount> {
        self.step_in(inputs, None, None, outputs)
    }

    /// As [`BatchModel::step`], for any models. `dt` is the time since the sample before, in
    /// seconds; lanes that depend on time need it, 0 for the first sample. `loads` has the load of
    /// each lane.
    ///
    /// # Errors
    /// As [`BatchModel::run_in`]. After an error all states are as before.
    pub fn step_in(
        &mut self,
        inputs: &[f64],
        dt: Option<f64>,
        loads: Option<&[f64]>,
        outputs: &mut [f64],
    ) -> Result<ClippedCount> {
        if inputs.len() != self.lanes() {
            return Err(self.misfit(inputs.len(), "inputs", 1));
        }
        let time = dt.map(|dt| [0.0, dt]);
        let surroundings = Surroundings {
            time: time.as_ref().map(|time| &time[..]),
            load: loads,
            rest: None,
        };
        self.run_in(inputs, surroundings, outputs)
    }

    /// The number of samples of each lane, if all series fit.
    fn samples(
        &self,
        inputs: &[f64],
        surroundings: Surroundings<'_>,
        outputs: usize,
    ) -> Result<usize> {
        let lanes = self.lanes();
        let samples = inputs.len().checked_div(lanes).unwrap_or(0);
        if inputs.len() != lanes * samples {
            return Err(self.misfit(inputs.len(), "inputs", samples));
        }
        if outputs != inputs.len() {
            return Err(self.misfit(outputs, "outputs", samples));
        }
        if let Some(load) = surroundings.load {
            if load.len() != inputs.len() {
                return Err(self.misfit(load.len(), "loads", samples));
            }
            if lanes > 0 && self.models().all(|model| model.load.is_none()) {
                return Err(no_load());
            }
        }
        Ok(samples)
    }

    fn misfit(&self, found: usize, name: &str, samples: usize) -> Error {
        let lanes = self.lanes();
        Error::Fit(format!(
            "{found} {name} for {lanes} lanes of {samples} samples"
        ))
    }
}

/// A lane on its way through a row of samples.
struct Job<'a> {
    number: usize,
    model: &'a Model,
    state: &'a mut State,
    input: &'a [f64],
    load: Option<&'a [f64]>,
    output: &'a mut [f64],
}

impl Job<'_> {
    fn run(&mut self, state: &mut State, around: Surroundings<'_>) -> Result<ClippedCount> {
        let load = self.load;
        let around = Surroundings { load, ..around };
        let run = self.model.run_in(state, self.input, around, self.output);
        run.map_err(|error| error.in_lane(self.number))
    }
}
