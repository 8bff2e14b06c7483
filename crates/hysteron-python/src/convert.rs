//! Values of the library converted to Python and back, through JSON.

use crate::choices::{another_kind, did_you_mean};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Plain data: dictionaries, lists, numbers and texts.
pub(crate) fn to_python<'py>(
    py: Python<'py>,
    value: &impl Serialize,
) -> PyResult<Bound<'py, PyAny>> {
    let text =
        serde_json::to_string(value).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}

/// Plain data as a dataclass of `pyhysteron.results`, nested ones included.
pub(crate) fn result<'py>(
    py: Python<'py>,
    class: &str,
    data: impl IntoPyObject<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let half = py.import("pyhysteron.results")?;
    let class = half.getattr(class)?;
    half.call_method1("_make", (class, data))
}

/// [`to_python`] and [`result`] in one.
pub(crate) fn result_of<'py>(
    py: Python<'py>,
    class: &str,
    value: &impl Serialize,
) -> PyResult<Bound<'py, PyAny>> {
    result(py, class, to_python(py, value)?)
}

/// Keyword arguments without those that are `None`, which stands for the default.
///
/// Those of `nested` have to be dictionaries: [`options`] would accept a sequence as well.
pub(crate) fn arguments<'py>(
    py: Python<'py>,
    keywords: Option<&Bound<'py, PyDict>>,
    nested: &[&str],
) -> PyResult<Bound<'py, PyDict>> {
    let arguments = PyDict::new(py);
    for (name, value) in keywords
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
/// `TypeError` and `ValueError` name the call and the option.
pub(crate) fn options<T: DeserializeOwned>(of: &str, values: &Bound<'_, PyAny>) -> PyResult<T> {
    let py = values.py();
    let keywords = PyDict::new(py);
    keywords.set_item("allow_nan", false)?;
    // NumPy's numbers are not those of Python.
    let item = py
        .import("operator")?
        .call_method1("methodcaller", ("item",))?;
    keywords.set_item("default", item)?;
    let text = py
        .import("json")?
        .call_method("dumps", (values,), Some(&keywords));
    let reason = |error: PyErr| error.value(py).to_string();
    let text: String = text
        .map_err(|error| match error.is_instance_of::<PyValueError>(py) {
            true => PyValueError::new_err(format!(
                "{of}: every number must be finite: {}",
                reason(error)
            )),
            false => PyTypeError::new_err(format!(
                "{of}: numbers, tuples and dictionaries of them are needed: {}",
                reason(error)
            )),
        })?
        .extract()?;
    serde_json::from_str(&text).map_err(|error| {
        let text = error.to_string();
        let text = text.split(" at line ").next().unwrap_or_default();
        match text.starts_with("unknown field") {
            true => {
                // serde: unknown field `a`, expected one of `b`, `c`
                let names: Vec<&str> = text.split('`').skip(1).step_by(2).collect();
                let meant = did_you_mean(names[0], &names[1..], "`");
                PyTypeError::new_err(format!("{of}: {text}{meant}"))
            }
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
