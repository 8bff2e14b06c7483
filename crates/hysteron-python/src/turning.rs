//! Turning points: `branches`, `remembered` and `control.headings`.

use crate::array::samples;
use crate::choices::{direction_name, size};
use crate::error::finite;
use numpy::PyArray1;
use pyo3::prelude::*;

/// The branch of each sample of an input.
///
/// A branch ends where the input turns by more than `dead_band`; the turning point belongs to the
/// branch before it.
///
/// Parameters
/// ----------
/// input : array_like, shape (n,)
/// dead_band : float, optional
///     Reversals up to this size are noise, in the input's unit. By default 1 % of its range, as
///     in a fit.
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
///     For a dead band below zero.
///
/// Examples
/// --------
/// >>> pyhysteron.branches([0, 2, 4, 3.99, 4, 1, 3])
/// array([0, 0, 0, 1, 1, 1, 2])
#[pyfunction]
#[pyo3(signature = (input, *, dead_band=None))]
pub(crate) fn branches<'py>(
    py: Python<'py>,
    input: &Bound<'py, PyAny>,
    dead_band: Option<f64>,
) -> PyResult<Bound<'py, PyArray1<i64>>> {
    let input = samples(input, "input")?;
    let input = input.as_slice()?;
    finite("input", input)?;
    let dead_band = match dead_band {
        Some(dead_band) => size("dead_band", dead_band)?,
        None => hysteron::usual_tolerance(input),
    };
    let found = hysteron::branches(input, dead_band);
    Ok(PyArray1::from_iter(py, found.iter().map(|b| *b as i64)))
}

/// The samples of an input that the operators still remember at its end, ascending.
///
/// These samples alone leave every operator in the same state as the whole input does, from all off
/// or all on (return-point memory).
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
/// tolerance : float
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
///     For a tolerance below zero.
///
/// Examples
/// --------
/// >>> pyhysteron.control.headings([0, 1, 2, 1])
/// ['rising', 'rising', 'rising', 'falling']
#[pyfunction]
#[pyo3(signature = (series, tolerance=0.0))]
pub(crate) fn headings(
    series: &Bound<'_, PyAny>,
    tolerance: f64,
) -> PyResult<Vec<Option<&'static str>>> {
    let series = samples(series, "series")?;
    let series = series.as_slice()?;
    finite("series", series)?;
    let headings = hysteron::headings(series, size("tolerance", tolerance)?);
    let names = headings
        .into_iter()
        .map(|heading| heading.map(direction_name));
    Ok(names.collect())
}
