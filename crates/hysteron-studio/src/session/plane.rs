//! The plane of a fit, and one sample of a file.

use super::fault::Fault;
use super::id::Id;
use super::state::Session;
use super::thinned::when;
use hysteron::{Model, Recording, State, Surroundings, operators};
use serde::{Deserialize, Serialize};

/// What is shown of each operator of the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PlaneKind {
    /// Its weight.
    Weights,
    /// How well the recording determines it: 0 never, 1 once, 2 not told apart, 3 well.
    Excitation,
    /// The standard error of its weight.
    Errors,
    /// Its state at a sample, 0 to 1.
    States,
}

/// The plane of a fit.
#[derive(Debug, Clone, Serialize)]
pub struct PlaneView {
    /// What is shown: the weights, where it is the states at a sample that there are none at.
    pub kind: PlaneKind,
    /// The levels, in the input's unit.
    pub levels: Vec<f64>,
    /// For each level of `β`, for each level of `α` up to it, the value; `None` beyond.
    pub values: Vec<Vec<Option<f64>>>,
    /// The input, with its unit.
    pub unit: String,
    /// The unit of the values.
    pub of: String,
    /// The line between the operators that are on and off at the sample pointed at, as points of
    /// `α` and `β`. One unit is one cell, and cell `n` ends at `n`: [`hysteron::State::staircase`].
    pub staircase: Vec<[f64; 2]>,
    /// The sample pointed at.
    pub sample: Option<SampleView>,
    /// Why there are no states at the sample asked for: the fit cannot be run on its file.
    pub left_out: Option<Fault>,
}

/// A sample of a file.
#[derive(Debug, Clone, Serialize)]
pub struct SampleView {
    /// Its number among the samples of the file, counted from 1.
    pub number: usize,
    /// Where it stands in the file, as `line 12`; `None` where a preparation has made other
    /// samples.
    pub place: Option<String>,
    /// Its time in seconds, or its number from 1.
    pub time: f64,
    /// Its input.
    pub input: f64,
    /// The measured output.
    pub output: f64,
    /// The modelled output of each fit.
    pub modelled: Vec<(Id, f64)>,
}

impl Session {
    /// The sample nearest to a time.
    pub(super) fn sample(&mut self, file: Id, fits: &[Id], at: f64) -> Result<SampleView, Fault> {
        let n = nearest(self.file(file)?.recording()?, at);
        self.sample_at(file, fits, n)
    }

    /// The sample `n`, counted from 0.
    pub(super) fn sample_at(
        &mut self,
        file: Id,
        fits: &[Id],
        n: usize,
    ) -> Result<SampleView, Fault> {
        let parts = self.file(file)?.parts()?;
        let (recording, place) = (parts.shown.clone(), parts.place(n));
        let (courses, _) = self.courses(fits, file)?;
        let modelled = courses.iter().map(|(fit, course)| (*fit, course[n]));
        let modelled = modelled.collect();
        Ok(SampleView {
            number: n + 1,
            place: place.map(|place| place.to_string()),
            time: when(&recording, n),
            input: recording.input[n],
            output: recording.output[n],
            modelled,
        })
    }

    pub(super) fn plane(
        &mut self,
        fit: Id,
        kind: PlaneKind,
        at: Option<(Id, f64)>,
    ) -> Result<PlaneView, Fault> {
        let model = self.fitted(fit)?.model.clone();
        let confidence = model.fit.as_ref().and_then(|fit| fit.confidence.as_ref());
        let unknown = || {
            Fault::missing(
                "standard errors were not estimated for this fit",
                "fit with “bootstrap” 60",
            )
        };
        let (mut sample, mut state, mut left_out) = (None, None, None);
        if let Some((file, time)) = at {
            let found = self.sample(file, &[fit], time)?;
            match self.course(fit, file) {
                Ok(_) => state = Some(self.state_at(fit, file, found.number)?),
                Err(why) => left_out = Some(why),
            }
            sample = state.is_some().then_some(found);
        }
        let kind = match (kind, &left_out) {
            (PlaneKind::States, Some(_)) => PlaneKind::Weights,
            _ => kind,
        };
        let values: Vec<f64> = match kind {
            PlaneKind::Weights => model.weights().to_vec(),
            PlaneKind::Errors => confidence.ok_or_else(unknown)?.standard_error.clone(),
            PlaneKind::Excitation => {
                let classes = confidence.ok_or_else(unknown)?.excitation.iter();
                classes.map(|class| f64::from(*class as u8)).collect()
            }
            PlaneKind::States => {
                let state = state.as_ref().ok_or_else(|| {
                    Fault::missing("no sample is chosen", "point at a sample over time")
                })?;
                model.operator_states(state)?
            }
        };
        let count = model.plane().levels();
        let levels = match model.spacing() {
            [] => (1..=count).map(|k| model.plane().level(k)).collect(),
            [_, levels @ ..] => levels.to_vec(),
        };
        Ok(PlaneView {
            kind,
            levels,
            values: cells(count, values.into_iter()),
            unit: model.input.to_column(),
            of: match kind {
                PlaneKind::Weights => format!("weight{}", unit_of(&model)),
                PlaneKind::Errors => format!("standard error{}", unit_of(&model)),
                PlaneKind::Excitation => "how well determined".into(),
                PlaneKind::States => "state".into(),
            },
            staircase: state.map_or(Vec::new(), |state| state.staircase()),
            sample,
            left_out,
        })
    }

    /// The state of a model after the first `count` rows of a file, from where the last of their
    /// recordings begins. It goes on from the state that
    /// was asked for before, where that is no later: a play through the time takes each row once.
    fn state_at(&mut self, fit: Id, file: Id, count: usize) -> Result<State, Fault> {
        let parts = self.file(file)?.parts()?.clone();
        let recording = &parts.shown;
        let begin = parts.begins().take_while(|begin| *begin < count).last();
        let begin = begin.unwrap_or_default();
        let fitted = self.fits.iter_mut().find(|other| other.id == fit);
        let fitted = fitted.ok_or_else(|| Fault::gone("fit", fit))?;
        let reached = fitted.reached.take();
        // A model that depends on time has to see each step of it.
        let goes_on = |(of, at, _): &(Id, usize, State)| {
            *of == file && (begin..=count).contains(at) && !fitted.model.is_timed()
        };
        let reached = reached.filter(goes_on);
        let (from, mut state) = match reached {
            Some((_, at, state)) => (at, state),
            None => (begin, fitted.model.start()),
        };
        let rows = from..count;
        let model = &fitted.model;
        let recording = &*model.rested(recording)?;
        let around = Surroundings::from_recording(model, recording);
        let acting = model.acting(&recording.input, around)?;
        let around = Surroundings {
            time: around.time.map(|time| &time[rows.clone()]),
            load: around.load.map(|load| &load[rows.clone()]),
            rest: around.rest.filter(|_| from == begin),
        };
        model.run_in(
            &mut state,
            &acting[rows.clone()],
            around,
            &mut vec![0.0; rows.len()],
        )?;
        fitted.reached = Some((file, count, state.clone()));
        Ok(state)
    }
}

fn unit_of(model: &Model) -> String {
    let unit = model.output.unit.as_ref();
    unit.map_or(String::new(), |unit| format!(" [{unit}]"))
}

/// Values of operators, for each level of `β`, for each level of `α` up to it.
pub(super) fn cells(count: usize, values: impl Iterator<Item = f64>) -> Vec<Vec<Option<f64>>> {
    let mut rows = vec![vec![None; count]; count];
    for ((i, j), value) in operators(count).zip(values) {
        rows[j - 1][i - 1] = Some(value);
    }
    rows
}

/// The sample nearest to a time; NaN is the first.
pub(super) fn nearest(recording: &Recording, time: f64) -> usize {
    let last = recording.len() - 1;
    match &recording.time {
        Some(times) => {
            let after = times.partition_point(|t| *t < time).min(last);
            let before = after.saturating_sub(1);
            match (times[after] - time).abs() < (time - times[before]).abs() {
                true => after,
                false => before,
            }
        }
        // `as` saturates.
        None => ((time - 1.0).round().max(0.0) as usize).min(last),
    }
}
