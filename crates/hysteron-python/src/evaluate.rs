//! `Model.confidence`, `Model.evaluate` and `excitation`.

use crate::convert::{result, to_python};
use crate::error::Raise;
use crate::inputs::{Recordings, inputs_of, inputs_seen};
use crate::integer::Integer;
use crate::plane::on_plane;
use crate::pool::detached;
use hysteron::{Excitation, InverseRun, Model, Operator, Plane, Start, Surroundings, Verdict};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

pub(crate) fn confidence<'py>(
    py: Python<'py>,
    model: &Model,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let Some(found) = model.fit.as_ref().and_then(|fit| fit.confidence.as_ref()) else {
        return Ok(None);
    };
    let plane = model.plane();
    let dict = PyDict::new(py);
    let levels = (1..=plane.levels()).map(|k| plane.level(k));
    dict.set_item("levels", PyArray1::from_iter(py, levels))?;
    let errors = on_plane(py, &found.standard_error)?;
    dict.set_item("standard_error", errors)?;
    dict.set_item("offset_error", found.offset_error)?;
    let classes = classes(py, &found.excitation)?;
    dict.set_item("excitation", classes)?;
    dict.set_item("rank", found.rank)?;
    dict.set_item("unknowns", found.unknowns)?;
    dict.set_item("condition", found.condition)?;
    dict.set_item("noise", found.noise)?;
    dict.set_item("sensor", found.sensor)?;
    dict.set_item("band_name", found.band_name())?;
    dict.set_item("branches", found.branches)?;
    dict.set_item("replicates", found.replicates)?;
    Ok(Some(dict))
}

/// Classes on the plane as their numbers in [`Excitation::ALL`].
pub(crate) fn classes<'py>(
    py: Python<'py>,
    classes: &[Excitation],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let number = |class: &Excitation| {
        let place = Excitation::ALL.iter().position(|other| other == class);
        place.unwrap_or_default() as f64
    };
    on_plane(py, &classes.iter().map(number).collect::<Vec<_>>())
}

/// How well inputs determine each operator of a plane, whatever the output was.
///
/// Parameters
/// ----------
/// input : array_like of shape (n,), Recording, or list of these
///     Each starts with every operator off.
/// range : tuple of float
///     Lowest and highest level of the plane, in the input's unit.
/// levels : int
/// operator : {'mkp', 'kp', 'relay'}
///
/// Returns
/// -------
/// ndarray, shape (K, K)
///     ``[i-1, j-1]``, NaN below the diagonal. 0: the operator never moves. 1: it moves on one
///     branch only. 2: it moves on several branches, but cannot be separated from others. 3: its
///     weight follows from the output.
///
/// Raises
/// ------
/// CoreError
///     For a sample that is NaN or infinite, or an invalid plane.
///
/// Examples
/// --------
/// >>> pyhysteron.excitation([0, 1, 2], (1, 2), 2)
/// array([[ 3.,  1.],
///        [nan,  1.]])
/// >>> pyhysteron.excitation([0, 1, 2, 1], (1, 2), 2)
/// array([[ 3.,  3.],
///        [nan,  3.]])
#[pyfunction]
#[pyo3(signature = (input, range, levels, *, operator="mkp"))]
pub(crate) fn excitation<'py>(
    py: Python<'py>,
    input: &Bound<'py, PyAny>,
    range: (f64, f64),
    levels: Integer,
    operator: &str,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let plane = Plane::new(range.0, range.1, levels.convert("levels")?).raise()?;
    let operator = crate::choices::operator(operator)?;
    excited(py, &inputs_of(input, "input")?, plane, operator)
}

/// What inputs say about the operators of a model, as its stages hand them on.
pub(crate) fn excited_within<'py>(
    py: Python<'py>,
    model: &Model,
    input: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let see = |input: &[f64], recording: Option<&hysteron::Recording>| {
        let around = recording.map(|recording| Surroundings::from_recording(model, recording));
        let seen = model.seen(input, around.unwrap_or_default()).raise()?;
        Ok(seen.into_owned())
    };
    let inputs = inputs_seen(input, "input", see)?;
    excited(py, &inputs, *model.plane(), model.operator())
}

fn excited<'py>(
    py: Python<'py>,
    inputs: &[Vec<f64>],
    plane: Plane,
    operator: Operator,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
    let found = detached(py, || hysteron::excitation(&slices, plane, operator)).raise()?;
    classes(py, &found)
}

pub(crate) fn evaluate<'py>(
    py: Python<'py>,
    model: &Model,
    recordings: &Recordings,
    start: Start,
) -> PyResult<Bound<'py, PyAny>> {
    let found = detached(py, || hysteron::evaluate_from(model, recordings, start)).raise()?;
    let dict = PyDict::new(py);
    dict.set_item("forward", to_python(py, &found.forward)?)?;
    let verdict = Verdict::of_evaluation(model, recordings, &found).raise()?;
    dict.set_item("verdict", to_python(py, &verdict)?)?;
    dict.set_item("clipped", found.clipped)?;
    dict.set_item("estimated_from", found.estimated_from)?;
    dict.set_item("rests", &found.rests)?;
    dict.set_item("was_fitted", found.was_fitted)?;
    dict.set_item("seen_for_band", found.seen_for_band)?;
    let band = match &found.band {
        None => None,
        Some(band) => {
            let (lower, upper) = band.ends(&found.output_model);
            let dict = PyDict::new(py);
            dict.set_item("coverage_percent", band.coverage_percent)?;
            dict.set_item("name", band.name())?;
            dict.set_item("lower", PyArray1::from_vec(py, lower))?;
            dict.set_item("upper", PyArray1::from_vec(py, upper))?;
            Some(dict)
        }
    };
    dict.set_item("band", band)?;
    let (inverse, refused) = match &found.inverse {
        Err(reason) => (None, Some(reason)),
        Ok(inverse) => {
            let dict = PyDict::new(py);
            let moving = inverse.moving.iter().copied();
            dict.set_item("moving", PyArray1::from_iter(py, moving))?;
            dict.set_item("hold", run(py, &inverse.hold)?)?;
            dict.set_item("anticipate", run(py, &inverse.anticipate)?)?;
            (Some(dict), None)
        }
    };
    dict.set_item("inverse", inverse)?;
    dict.set_item("inverse_refused", refused)?;
    dict.set_item("output_model", PyArray1::from_vec(py, found.output_model))?;
    result(py, "Evaluation", dict)
}

fn run<'py>(py: Python<'py>, run: &InverseRun) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("all", to_python(py, &run.all)?)?;
    dict.set_item("moving", to_python(py, &run.moving)?)?;
    dict.set_item("dead_band", to_python(py, &run.dead_band)?)?;
    dict.set_item("out_of_reach", run.out_of_reach)?;
    dict.set_item("input_model", PyArray1::from_slice(py, &run.input_model))?;
    Ok(dict)
}
