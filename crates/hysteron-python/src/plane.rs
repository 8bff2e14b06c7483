//! Values of operators as square arrays: operator `(i, j)` at `[i-1, j-1]`, nothing below the
//! diagonal.

use crate::array::samples;
use hysteron::operator_index;
use numpy::PyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Levels of the plane that has so many operators, ``K (K + 1) / 2``; those that come nearest where
/// none has.
pub(crate) fn levels_of(operators: usize) -> usize {
    (2.0 * operators as f64).sqrt() as usize
}

/// Values of operators, row by row, on their plane, with NaN below its diagonal.
pub(crate) fn on_plane<'py>(
    py: Python<'py>,
    values: &[f64],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let levels = levels_of(values.len());
    let at = |i: usize, j: usize| match i > j {
        true => f64::NAN,
        false => values[operator_index(i, j)],
    };
    let rows = (1..=levels).map(|i| (1..=levels).map(|j| at(i, j)).collect());
    Ok(PyArray2::from_vec2(py, &rows.collect::<Vec<Vec<f64>>>())?)
}

/// Weights row by row, from those or from a square with nothing below its diagonal.
pub(crate) fn weights_of(value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = crate::array::array(value)?;
    if array.getattr("ndim")?.extract::<usize>()? != 2 {
        return Ok(samples(&array, "weights")?.as_slice()?.to_vec());
    }
    let (rows, levels): (usize, usize) = array.getattr("shape")?.extract()?;
    if rows != levels {
        let text = format!("`weights` has the shape ({rows}, {levels}): a square is needed");
        return Err(PyValueError::new_err(text));
    }
    let square = samples(&array.call_method1("reshape", (-1,))?, "weights")?;
    let square = square.as_slice()?;
    let mut weights = Vec::with_capacity(levels * (levels + 1) / 2);
    for j in 0..levels {
        for i in 0..levels {
            let weight = square[i * levels + j];
            if i <= j {
                weights.push(weight);
            } else if !(weight.is_nan() || weight == 0.0) {
                let text = format!(
                    "`weights[{i}, {j}]` is {weight}: below the diagonal there is NaN or 0"
                );
                return Err(PyValueError::new_err(text));
            }
        }
    }
    Ok(weights)
}
