//! `compare`.

use crate::choices::{STARTS, another_kind, choice};
use crate::convert::{result, to_python};
use crate::error::Raise;
use crate::inputs::recordings_of;
use crate::model::Model;
use crate::pool::detached;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Run several models over the same recording, forward only.
///
/// Parameters
/// ----------
/// models : Model, list of Model, or dict of Model
///     The keys of a dictionary are the names of the models. Those of a list are ``'model 1'``,
///     ``'model 2'`` and so on.
/// recording : Recording, list of Recording, or array_like of shape (n,)
///     A list is one experiment: the models start anew in each recording. An array is the input, and
///     `output` is needed.
/// output : array_like, shape (n,), optional
/// start : {'fitted', 'off', 'on', 'rest', 'unknown'}
///     Where the models start, as for `Model.evaluate`.
/// time, load : array_like, shape (n,), optional
///     For an input and an output given as arrays. `time` as in `Recording`.
///
/// Returns
/// -------
/// list of results.Forward
///     In the order of the models.
///
/// Raises
/// ------
/// RecordingError
///     For invalid samples.
/// FitError, ThermalError
///     For a model that needs a load or a time that the recording does not have.
///
/// Examples
/// --------
/// >>> input = 50 - 30 * np.cos(np.linspace(0, 20, 400))
/// >>> models = {f'K = {k}': pyhysteron.fit(input, input**2, levels=k, bootstrap=0) for k in (4, 20)}
/// >>> found = pyhysteron.compare(models, input, input**2)
/// >>> best = min(found, key=lambda run: run.errors.rmse)
/// >>> best.name, best.residual.shape
/// ('K = 20', (400,))
#[pyfunction]
#[pyo3(signature = (models, recording, output=None, *, start="fitted", time=None, load=None))]
pub(crate) fn compare<'py>(
    py: Python<'py>,
    models: &Bound<'py, PyAny>,
    recording: &Bound<'py, PyAny>,
    output: Option<&Bound<'py, PyAny>>,
    start: &str,
    time: Option<&Bound<'py, PyAny>>,
    load: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyList>> {
    let start = choice("start", start, &STARTS)?;
    let recordings = recordings_of(recording, output, time, load)?;
    let found = PyList::empty(py);
    for (name, model) in models_of(models)? {
        let model = model.get();
        let run = detached(py, || hysteron::forward(&model.inner, &recordings, start)).raise()?;
        let measured = recordings.as_ref().iter().flat_map(|r| &r.output);
        let residual = measured.zip(&run.output_model);
        let residual = residual.map(|(measured, modelled)| measured - modelled);
        let dict = PyDict::new(py);
        dict.set_item("name", name)?;
        dict.set_item("errors", to_python(py, &run.errors)?)?;
        dict.set_item("was_fitted", run.was_fitted)?;
        dict.set_item("seen_for_band", run.seen_for_band)?;
        dict.set_item("residual", PyArray1::from_iter(py, residual))?;
        dict.set_item("output_model", PyArray1::from_vec(py, run.output_model))?;
        found.append(result(py, "Forward", dict)?)?;
    }
    Ok(found)
}

/// The models with their names.
fn models_of<'py>(value: &Bound<'py, PyAny>) -> PyResult<Vec<(String, Bound<'py, Model>)>> {
    let model = |value: &Bound<'py, PyAny>| match value.cast::<Model>() {
        Ok(model) => Ok(model.clone()),
        Err(_) => Err(another_kind(
            "models",
            "a Model, or a list or dict of them,",
            value,
        )),
    };
    if let Ok(dict) = value.cast::<PyDict>() {
        let each = dict.iter();
        return each
            .map(|(name, value)| Ok((name.str()?.to_string(), model(&value)?)))
            .collect();
    }
    let several = match value.extract::<Vec<Bound<'py, PyAny>>>() {
        Ok(several) => several,
        Err(_) => vec![value.clone()],
    };
    let each = several.iter().enumerate();
    each.map(|(n, value)| Ok((format!("model {}", n + 1), model(value)?)))
        .collect()
}
