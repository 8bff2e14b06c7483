//! Recordings and inputs as calls take them: as such, or as arrays.

use crate::array::series;
use crate::choices::named;
use crate::error::finite;
use crate::recording::Recording;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use std::sync::Arc;

/// A recording, or arrays that make one.
pub(crate) fn recording_of(
    value: &Bound<'_, PyAny>,
    output: Option<&Bound<'_, PyAny>>,
    time: Option<&Bound<'_, PyAny>>,
    load: Option<&Bound<'_, PyAny>>,
) -> PyResult<Recording> {
    match (value.cast::<Recording>(), output) {
        (Ok(recording), None) if time.is_none() && load.is_none() => Ok(recording.get().clone()),
        (Ok(_), _) => Err(PyTypeError::new_err(
            "a Recording has its own output, time and load: leave these out",
        )),
        (Err(_), Some(output)) => {
            let names = ("input", "output", "load");
            Recording::of_arrays(value, output, time, load, names, false)
        }
        (Err(_), None) => Err(PyTypeError::new_err(
            "a Recording is needed, or an input and its output",
        )),
    }
}

/// One recording, or several of one experiment.
pub(crate) enum Recordings {
    One(Arc<hysteron::Recording>),
    Several(Vec<hysteron::Recording>),
}

impl AsRef<[hysteron::Recording]> for Recordings {
    fn as_ref(&self) -> &[hysteron::Recording] {
        match self {
            Self::One(recording) => std::slice::from_ref(recording),
            Self::Several(recordings) => recordings,
        }
    }
}

/// One recording, as [`recording_of`], or a list of them.
pub(crate) fn recordings_of(
    value: &Bound<'_, PyAny>,
    output: Option<&Bound<'_, PyAny>>,
    time: Option<&Bound<'_, PyAny>>,
    load: Option<&Bound<'_, PyAny>>,
) -> PyResult<Recordings> {
    if output.is_none()
        && let Ok(several) = value.extract::<Vec<Recording>>()
    {
        if time.is_some() || load.is_some() {
            return Err(PyTypeError::new_err(
                "recordings have their own time and load: leave these out",
            ));
        }
        let several = several.iter().map(|r| (*r.inner).clone());
        return Ok(Recordings::Several(several.collect()));
    }
    let recording = recording_of(value, output, time, load)?;
    Ok(Recordings::One(recording.inner))
}

/// One recording or a list of them; arrays are not taken.
pub(crate) fn recordings_alone(
    argument: &str,
    value: &Bound<'_, PyAny>,
) -> PyResult<Vec<hysteron::Recording>> {
    if let Ok(one) = value.cast::<Recording>() {
        return Ok(vec![(*one.get().inner).clone()]);
    }
    let several: Vec<Recording> = named(argument, "a Recording or a list of Recording", value)?;
    Ok(several.iter().map(|r| (*r.inner).clone()).collect())
}

/// One input, or a list of inputs, each an array or that of a recording.
pub(crate) fn inputs_of(value: &Bound<'_, PyAny>, argument: &str) -> PyResult<Vec<Vec<f64>>> {
    inputs_seen(value, argument, |input, _| Ok(input.to_vec()))
}

/// As [`inputs_of`], each as `see` gives it, from the input and the recording that it is of.
pub(crate) fn inputs_seen(
    value: &Bound<'_, PyAny>,
    argument: &str,
    see: impl Fn(&[f64], Option<&hysteron::Recording>) -> PyResult<Vec<f64>>,
) -> PyResult<Vec<Vec<f64>>> {
    let input_of = |one: &Bound<'_, PyAny>, place: &str| match one.cast::<Recording>() {
        Ok(recording) => {
            let recording = &*recording.get().inner;
            see(&recording.input, Some(recording))
        }
        Err(_) => {
            let input = series(one, place)?;
            finite(place, &input)?;
            see(&input, None)
        }
    };
    let listed = value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>();
    match value.extract::<Vec<Bound<'_, PyAny>>>() {
        Ok(several) if listed && several.first().is_none_or(|first| first.len().is_ok()) => {
            let several = several.iter().enumerate();
            several
                .map(|(k, one)| input_of(one, &format!("{argument}[{k}]")))
                .collect()
        }
        _ => Ok(vec![input_of(value, argument)?]),
    }
}
