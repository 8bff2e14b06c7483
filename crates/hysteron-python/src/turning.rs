//! Where a series turns: `branches`, `remembered` and `control.headings`.

use crate::array::samples;
use crate::error::finite;
use crate::word::{direction_name, width};
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
/// Raises
/// ------
/// CoreError
///     For a sample that is NaN or infinite.
/// ValueError
///     For a band below zero.
///
/// Examples
/// --------
/// >>> pyhysteron.branches([0, 2, 4, 3.99, 4, 1, 3])
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
    let band = match band {
        Some(band) => width(band)?,
        None => hysteron::usual_tolerance(input),
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
/// Raises
/// ------
/// CoreError
///     For a sample that is NaN or infinite.
///
/// Examples
/// --------
/// >>> pyhysteron.remembered([0, 5, 2, 4, 1, 3, 2.5])
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

/// Where a series goes next, for 'anticipate'.
///
/// Parameters
/// ----------
/// series : array_like, shape (n,)
/// band : float
///     Reversals up to this size are noise.
///
/// Returns
/// -------
/// list of {None, 'rising', 'falling'}
///
/// Raises
/// ------
/// CoreError
///     For a sample that is NaN or infinite.
/// ValueError
///     For a band below zero.
///
/// Examples
/// --------
/// >>> pyhysteron.control.headings([0, 1, 2, 1])
/// ['rising', 'rising', 'rising', 'falling']
#[pyfunction]
#[pyo3(signature = (series, band=0.0))]
pub(crate) fn headings(
    series: &Bound<'_, PyAny>,
    band: f64,
) -> PyResult<Vec<Option<&'static str>>> {
    let series = samples(series, "series")?;
    let series = series.as_slice()?;
    finite("series", series)?;
    let headings = hysteron::headings(series, width(band)?);
    let names = headings
        .into_iter()
        .map(|heading| heading.map(direction_name));
    Ok(names.collect())
}
