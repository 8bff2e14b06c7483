//! What the façade tells as JSON, as dictionaries, and back.

use crate::word::another_kind;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A dictionary with the same entries.
pub(crate) fn told<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text =
        serde_json::to_string(value).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

/// Keyword arguments without those that are `None`: these are what they are by default. Those of `nested` are dictionaries, since
/// [`options`] would take their values from a sequence as well.
pub(crate) fn arguments<'py>(
    py: Python<'py>,
    given: Option<&Bound<'py, PyDict>>,
    nested: &[&str],
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    for (name, value) in given
        .into_iter()
        .flatten()
        .filter(|(_, value)| !value.is_none())
    {
        let text = name.to_string();
        if nested.contains(&text.as_str()) && !value.is_instance_of::<PyDict>() {
            return Err(another_kind(&text, "a dictionary", &value));
        }
        arguments.set_item(name, value)?;
    }
    Ok(arguments)
}

/// The options that keyword arguments, or a dictionary, stand for.
///
/// # Errors
/// `TypeError` and `ValueError` say of whose options, and which is wrong.
pub(crate) fn options<T: DeserializeOwned>(of: &str, given: &Bound<'_, PyAny>) -> PyResult<T> {
    let py = given.py();
    let keywords = PyDict::new(py);
    keywords.set_item("allow_nan", false)?;
    // NumPy's numbers are not those of Python.
    let item = py
        .import("operator")?
        .call_method1("methodcaller", ("item",))?;
    keywords.set_item("default", item)?;
    let text = py
        .import("json")?
        .call_method("dumps", (given,), Some(&keywords));
    let said = |error: PyErr| error.value(py).to_string();
    let text: String = text
        .map_err(|error| match error.is_instance_of::<PyValueError>(py) {
            true => PyValueError::new_err(format!(
                "{of}: every number must be finite: {}",
                said(error)
            )),
            false => PyTypeError::new_err(format!(
                "{of}: numbers, tuples and dictionaries of them are needed: {}",
                said(error)
            )),
        })?
        .extract()?;
    serde_json::from_str(&text).map_err(|error| {
        let text = error.to_string();
        let text = text.split(" at line ").next().unwrap_or_default();
        match text.starts_with("unknown field") {
            true => PyTypeError::new_err(format!("{of}: {text}")),
            false => PyValueError::new_err(format!("{of}: {text}")),
        }
    })
}

/// A warning that Python users may filter: `HysteronWarning`.
pub(crate) fn warn(py: Python<'_>, text: &str) -> PyResult<()> {
    let class = py.import("pyhysteron.errors")?.getattr("HysteronWarning")?;
    py.import("warnings")?
        .call_method1("warn", (text, class, 1))
        .map(|_| ())
}
