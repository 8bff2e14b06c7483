//! The state of the operators before the first sample.

use crate::error::Result;
use crate::model::OperatorState;
use hysteron_core::{Model, Turn, turn_capacity};

/// State of the operators before the first sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Initial {
    Off,
    On,
    /// Off, and then these inputs one after the other.
    After([f64; 2]),
}

impl Initial {
    /// That state, of a model.
    pub(crate) fn state(self, model: &Model<f64, Vec<f64>>) -> Result<OperatorState> {
        let memory = vec![Turn::default(); turn_capacity(model.plane().levels())];
        let mut state = model.state(memory)?;
        match self {
            Self::Off => {}
            Self::On => model.reset_on(&mut state)?,
            Self::After(inputs) => {
                for input in inputs {
                    model.step(&mut state, input)?;
                }
            }
        }
        Ok(state)
    }
}
