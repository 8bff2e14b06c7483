//! Control loops on a device that is a Python object, and what happens to a plant meanwhile.

use crate::choices::another_kind;
use crate::convert::options;
use crate::error::Raise;
use crate::shared::Shared;
use hysteron::control::{Controller, Course, Reading, Trace};
use hysteron_sim::track::Event;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The loop of `read`, `step`, `write`, one sample for each value of the reference. What is raised in
/// it leaves the device at rest.
pub(crate) fn follow(
    py: Python<'_>,
    device: &Bound<'_, PyAny>,
    controller: &Shared<Controller>,
    course: &Course<'_>,
) -> PyResult<Trace> {
    if !(device.hasattr("read")? && device.hasattr("write")?) {
        let needed = "an object with read() and write(drive)";
        return Err(another_kind("device", needed, device));
    }
    let followed = each(py, device, controller, course);
    if followed.is_err() {
        let rest = controller.with(py, |controller| controller.rest_drive());
        // The device may be gone, and the first error is the one to tell.
        let _ = device.call_method1("write", (rest,));
    }
    followed
}

fn each(
    py: Python<'_>,
    device: &Bound<'_, PyAny>,
    controller: &Shared<Controller>,
    course: &Course<'_>,
) -> PyResult<Trace> {
    let (dt_s, due) = controller.with(py, |controller| (controller.interval_s(), controller.due()));
    let (count, advance) = (course.reference.len(), device.getattr_opt("advance")?);
    let mut trace = Trace::default();
    for (n, &output) in course.reference.iter().enumerate() {
        py.check_signals()?;
        let (target, next) = course.target(n, due);
        let reading = reading(&device.call_method0("read")?)?;
        let step = |controller: &mut Controller| {
            let action = controller.step_ahead(target, next, reading)?;
            trace.record(count, output, (reading, reading), (controller, &action));
            hysteron::Result::Ok(action.drive)
        };
        let drive = controller.with(py, step).raise()?;
        device.call_method1("write", (drive,))?;
        if let Some(advance) = &advance {
            advance.call1((dt_s,))?;
        }
    }
    Ok(trace)
}

/// What happens to a plant in a run.
pub(crate) fn events_of(value: &Bound<'_, PyAny>) -> PyResult<Vec<Event>> {
    let events: Vec<Bound<'_, PyDict>> = value.extract().map_err(|_| {
        PyTypeError::new_err("`events`: a sequence of dictionaries is needed, each with 'at_s'")
    })?;
    let events = events.iter().enumerate();
    let events = events.map(|(n, event)| {
        let of = format!("`events[{n}]`");
        let event: Event = options(&of, event.as_any())?;
        if event.at_s < 0.0 {
            let text = format!("{of}: 'at_s' is {}: a time from 0 on is needed", event.at_s);
            return Err(PyValueError::new_err(text));
        }
        Ok(event)
    });
    events.collect()
}

/// What a device's `read` returned.
fn reading(read: &Bound<'_, PyAny>) -> PyResult<Reading> {
    let (output, input): (Option<f64>, Option<f64>) = match read.extract() {
        Ok(both) => both,
        Err(_) => {
            let output = read.extract::<Option<f64>>().map_err(|_| {
                PyTypeError::new_err(format!("`device.read()` gave {read}: the output is needed, or a pair of output and input"))
            })?;
            (output, None)
        }
    };
    Ok(Reading {
        output: output.unwrap_or(f64::NAN),
        input,
    })
}
