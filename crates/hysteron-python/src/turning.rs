//! `branches` and `remembered`.

use crate::array::samples;
use crate::error::finite;
use hysteron::NOISE;
use numpy::PyArray1;
use pyo3::prelude::*;

/// For each sample of an input the branch that it lies on.
///
/// A branch ends where the input turns by more than `band`; the turning point belongs to the branch before it.
///
/// Parameters
/// ----------
/// input : array_like, shape (n,)
/// band : float, optional
///     Reversals up to this are noise, in the input's unit; by default 1 % of its range, as in a fit.
///
/// Returns
/// -------
/// ndarray of int64, shape (n,)
///     Counted from 0.
///
/// Examples
/// --------
/// >>> hysteron.branches([0, 2, 4, 3.99, 4, 1, 3])
/// array([0, 0, 0, 1, 1, 1, 2])
#[pyfunction]
#[pyo3(signature = (input, *, band=None))]
pub(crate) fn branches<'py>(
    py: Python<'py>,
    input: &Bound<'py, PyAny>,
    band: Option<f64>,
) -> PyResult<Bound<'py, PyArray1<i64>>> {
    let input = samples(input, "input")?;
    let input = input.as_slice()?;
    finite("input", input)?;
    let (low, high) = input.iter().fold((f64::MAX, f64::MIN), |(low, high), x| {
        (low.min(*x), high.max(*x))
    });
    let band = match band {
        Some(band) => crate::word::width(band)?,
        None => NOISE * (high - low),
    };
    let found = hysteron::branches(input, band);
    Ok(PyArray1::from_iter(py, found.iter().map(|b| *b as i64)))
}

/// The samples of an input that the operators still remember at its end, ascending.
///
/// These alone leave every operator where the whole input leaves it, from all off or all on (return-point memory).
///
/// Parameters
/// ----------
/// input : array_like, shape (n,)
///
/// Returns
/// -------
/// ndarray of int64, shape (m,)
///     Indices into `input`, its last sample among them.
///
/// Examples
/// --------
/// >>> hysteron.remembered([0, 5, 2, 4, 1, 3, 2.5])
/// array([0, 1, 4, 5, 6])
#[pyfunction]
pub(crate) fn remembered<'py>(
    py: Python<'py>,
    input: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray1<i64>>> {
    let input = samples(input, "input")?;
    let input = input.as_slice()?;
    finite("input", input)?;
    let found = hysteron::remembered(input);
    Ok(PyArray1::from_iter(py, found.iter().map(|n| *n as i64)))
}
