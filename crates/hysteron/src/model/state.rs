//! The state of a model, and the sample that moves it.

use crate::error::Result;
use crate::model::body::{ThermalState, needs_time};
use crate::model::load::no_load;
use crate::model::{Model, OperatorState, Operators};
use hysteron_core::Output;

/// One input sample of a model. A plain number converts to a sample with that input only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The input; for a model with a thermal body, its drive.
    pub input: f64,
    /// Time since the sample before, s; needed by a model with a thermal body.
    pub dt: Option<f64>,
    /// The load; needed by a model that depends on one.
    pub load: Option<f64>,
}

impl From<f64> for Sample {
    fn from(input: f64) -> Self {
        Self {
            input,
            dt: None,
            load: None,
        }
    }
}

/// The state of a model: of its operators, and of its thermal body.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    pub(crate) operators: OperatorState,
    /// States of the operators of each part of a load dependence.
    parts: Vec<OperatorState>,
    /// `None` before the first sample. At that sample the body is at rest.
    body: Option<ThermalState>,
}

impl From<OperatorState> for State {
    fn from(operators: OperatorState) -> Self {
        Self {
            operators,
            parts: Vec::new(),
            body: None,
        }
    }
}

impl State {
    pub(super) fn new(model: &Model, begin: fn(&Operators) -> OperatorState) -> Self {
        let parts = model.load.iter().flat_map(|load| load.operators());
        Self {
            operators: begin(model.operators()),
            parts: parts.map(begin).collect(),
            body: None,
        }
    }

    /// The last input of the operators. For a model with a thermal body, this is the temperature.
    #[must_use]
    pub fn input(&self) -> f64 {
        self.operators.input()
    }

    /// The turning points that the operators remember, normalised to the plane.
    pub fn turning_points(&self) -> impl Iterator<Item = f64> + '_ {
        self.operators.turning_points()
    }

    /// Whether the operators' input is rising.
    #[must_use]
    pub fn is_rising(&self) -> bool {
        self.operators.is_rising()
    }

    pub(super) fn step(&mut self, model: &Model, sample: Sample) -> Result<Output<f64>> {
        let Sample { input, dt, load } = sample;
        let (input, body) = match (&model.thermal, self.body) {
            (None, _) => (input, None),
            (Some(body), None) => {
                let state = body.at_rest(input);
                (state.temperature(), Some(state))
            }
            (Some(body), Some(mut state)) => {
                let dt = dt.ok_or_else(needs_time)?;
                (body.step(&mut state, dt, input)?, Some(state))
            }
        };
        let factors = match (&model.load, load) {
            (None, None) => Vec::new(),
            (None, Some(_)) => return Err(no_load()),
            (Some(dependence), None) => return Err(dependence.one_is_needed()),
            (Some(dependence), Some(load)) => dependence.factors(load)?,
        };
        // A state of the operators alone has no parts: without this check the sum would lack them.
        if self.parts.len() != factors.len() {
            return Err(hysteron_core::Error::StateMismatch.into());
        }
        let mut step = model.operators().step(&mut self.operators, input)?;
        self.body = body;
        if let Some(dependence) = &model.load {
            let parts = dependence.operators().zip(&mut self.parts);
            step.output = 0.0;
            for ((part, state), factor) in parts.zip(factors) {
                step.output += factor * part.step(state, input)?.output;
            }
        }
        Ok(step)
    }
}
