//! `control.Action`.

use hysteron::control;
use pyo3::prelude::*;

/// What a `Controller` does with a sample.
#[pyclass(frozen, get_all, module = "pyhysteron.control")]
pub(crate) struct Action {
    /// The commanded input.
    command: f64,
    /// The drive to write to the device.
    drive: f64,
    /// The output that the model expected before it learned; NaN without a model.
    prediction: f64,
    /// The output as filtered; NaN where there is nothing new to be believed.
    output: f64,
    /// The input as filtered; NaN where there is nothing new to be believed, None where it is not
    /// known.
    input: Option<f64>,
    /// Whether the drive or the command stood at a limit.
    saturated: bool,
    /// Whether the target lay out of the model's reach; the nearest end was aimed at.
    out_of_reach: bool,
    /// Whether a reading was missing, or stuck.
    sensor_fault: bool,
    /// Whether the model learned from the sample.
    adapted: bool,
    /// Reading rejected: too far from what was expected to be learned from.
    rejected: bool,
    /// A channel stands still while the other one moves, so the model does not learn.
    stuck: bool,
}

impl From<control::Action> for Action {
    fn from(action: control::Action) -> Self {
        Self {
            command: action.command,
            drive: action.drive,
            prediction: action.prediction,
            output: action.filtered.output,
            input: action.filtered.input,
            saturated: action.status.saturated,
            out_of_reach: action.status.out_of_reach,
            sensor_fault: action.status.sensor_fault,
            adapted: action.status.adapted,
            rejected: action.status.rejected,
            stuck: action.status.stuck,
        }
    }
}

#[pymethods]
impl Action {
    fn __repr__(&self) -> String {
        let Self {
            command,
            drive,
            prediction,
            ..
        } = self;
        format!("<Action: command {command}, drive {drive}, prediction {prediction}>")
    }
}
