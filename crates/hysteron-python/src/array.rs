//! Samples from Python: arrays of float64 as they lie in memory, everything else converted to one.

use crate::recording::Recording;
use numpy::PyUntypedArrayMethods;
use numpy::{PyArray1, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray1, PyUntypedArray};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// One-dimensional samples, from an array, a pandas series, a list or whatever NumPy makes an array of.
///
/// # Errors
/// `TypeError` for complex numbers, texts and objects that are no numbers; `ValueError` for another shape.
pub(crate) fn samples<'py>(
    value: &Bound<'py, PyAny>,
    argument: &str,
) -> PyResult<PyReadonlyArray1<'py, f64>> {
    if value.is_instance_of::<Recording>() {
        let text =
            format!("`{argument}` is a Recording: give one of its series, as `recording.input`");
        return Err(PyTypeError::new_err(text));
    }
    let numpy = value.py().import("numpy")?;
    // A masked array is one as well, and its mask counts.
    if let Ok(array) = value.cast::<PyArray1<f64>>()
        && value.get_type().is(&numpy.getattr("ndarray")?)
    {
        let array = array.try_readonly()?;
        if array.as_slice().is_ok() {
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
        let text = format!("`{argument}`: real numbers are needed, not {dtype}");
        return Err(PyTypeError::new_err(text));
    }
    if array.ndim() != 1 {
        let shape = array.shape();
        let text = format!("`{argument}`: one dimension is needed, not the shape {shape:?}");
        return Err(PyValueError::new_err(text));
    }
    let converted = numpy
        .call_method1("require", (array, "float64", ("C", "ALIGNED")))
        .map_err(|error| {
            PyTypeError::new_err(format!("`{argument}`: not all are real numbers: {error}"))
        })?;
    Ok(converted.cast::<PyArray1<f64>>()?.try_readonly()?)
}

/// As an array of whatever it holds; what is masked is NaN.
pub(crate) fn array<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let numpy = value.py().import("numpy")?;
    if value.is_instance(&numpy.getattr("ma")?.getattr("MaskedArray")?)? {
        let numbers = value.call_method1("astype", ("float64",))?;
        return numbers.call_method1("filled", (f64::NAN,));
    }
    numpy.call_method1("asarray", (value,))
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
