//! Samples from Python: float64 arrays as they are in memory, everything else converted.

use numpy::PyUntypedArrayMethods;
use numpy::ndarray::Dimension;
use numpy::{
    PyArray, PyArray1, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray, PyReadonlyArray1,
    PyReadonlyArray2, PyUntypedArray,
};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// One-dimensional samples from an array, a pandas series, a list, or anything that NumPy converts.
///
/// # Errors
/// `TypeError` for complex numbers, dates, texts and objects that are no numbers; `ValueError` for
/// another shape.
pub(crate) fn samples<'py>(
    value: &Bound<'py, PyAny>,
    argument: &str,
) -> PyResult<PyReadonlyArray1<'py, f64>> {
    numbers(value, argument, "one dimension is needed")
}

/// As [`samples`], in rows: each row is contiguous, and follows the one before it.
pub(crate) fn rows<'py>(
    value: &Bound<'py, PyAny>,
    argument: &str,
) -> PyResult<PyReadonlyArray2<'py, f64>> {
    numbers(value, argument, "two dimensions are needed")
}

fn numbers<'py, D: Dimension + 'py>(
    value: &Bound<'py, PyAny>,
    argument: &str,
    needed: &str,
) -> PyResult<PyReadonlyArray<'py, f64, D>> {
    // By its name: `recording.rs` builds on this file.
    if value.get_type().name()? == "Recording" && value.hasattr("input_name")? {
        let text =
            format!("`{argument}` is a Recording: give one of its series, as `recording.input`");
        return Err(PyTypeError::new_err(text));
    }
    let numpy = value.py().import("numpy")?;
    // A masked array is a subclass, and its mask counts.
    if let Ok(array) = value.cast::<PyArray<f64, D>>()
        && value.get_type().is(&numpy.getattr("ndarray")?)
    {
        let array = array.try_readonly()?;
        // There is a slice in the order of Fortran too, and none where it is not aligned.
        if array.is_c_contiguous() && array.as_slice().is_ok() {
            return Ok(array);
        }
    }
    let array = array(value).map_err(|error| {
        PyTypeError::new_err(format!("`{argument}`: no array of numbers: {error}"))
    })?;
    let array = array.cast::<PyUntypedArray>()?;
    let kind = array.dtype().kind();
    if !matches!(kind, b'f' | b'i' | b'u' | b'O') {
        let dtype = array.dtype();
        let remedy = match kind {
            b'M' | b'm' => ". Dates and durations go to `time`",
            _ => "",
        };
        let text = format!("`{argument}`: real numbers are needed, not {dtype}{remedy}");
        return Err(PyTypeError::new_err(text));
    }
    if D::NDIM != Some(array.ndim()) {
        let shape = array.shape();
        let text = format!("`{argument}`: {needed}, not the shape {shape:?}");
        return Err(PyValueError::new_err(text));
    }
    let converted = numpy
        .call_method1("require", (array, "float64", ("C", "ALIGNED")))
        .map_err(|error| {
            PyTypeError::new_err(format!("`{argument}`: not all are real numbers: {error}"))
        })?;
    Ok(converted.cast::<PyArray<f64, D>>()?.try_readonly()?)
}

/// An array of whatever `value` holds; masked entries are NaN.
pub(crate) fn array<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let numpy = value.py().import("numpy")?;
    if value.is_instance(&numpy.getattr("ma")?.getattr("MaskedArray")?)? {
        let numbers = value.call_method1("astype", ("float64",))?;
        return numbers.call_method1("filled", (f64::NAN,));
    }
    numpy.call_method1("asarray", (value,))
}

/// A copy of samples.
pub(crate) fn series(value: &Bound<'_, PyAny>, argument: &str) -> PyResult<Vec<f64>> {
    Ok(samples(value, argument)?.as_slice()?.to_vec())
}

/// A copy of samples that may be absent.
pub(crate) fn optional(
    value: Option<&Bound<'_, PyAny>>,
    argument: &str,
) -> PyResult<Option<Vec<f64>>> {
    value.map(|value| series(value, argument)).transpose()
}

/// Time in seconds. Dates and durations are converted by `pyhysteron._convert.seconds`.
pub(crate) fn times(value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Vec<f64>>> {
    let Some(value) = value else {
        return Ok(None);
    };
    let half = value.py().import("pyhysteron._convert")?;
    let seconds = half.call_method1("seconds", (value,))?;
    series(&seconds, "time").map(Some)
}

/// `result` as a pandas series with the index of `input`, where `input` is one; otherwise as it is.
pub(crate) fn like<'py>(
    input: &Bound<'py, PyAny>,
    result: impl IntoPyObject<'py>,
    name: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let py = input.py();
    let result = result.into_bound_py_any(py)?;
    if input.is_instance_of::<PyUntypedArray>() {
        return Ok(result);
    }
    let half = py.import("pyhysteron._convert")?;
    half.call_method1("like", (input, result, name))
}

/// Runs `work` on new samples, without the interpreter's lock.
pub(crate) fn filled<'py>(
    py: Python<'py>,
    count: usize,
    work: impl FnOnce(&mut [f64]) -> PyResult<()> + Send,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let array = PyArray1::zeros(py, count, false);
    let mut values = array.try_readwrite()?;
    let slice = values.as_slice_mut()?;
    py.detach(|| work(slice))?;
    drop(values);
    Ok(array)
}
