//! `adapt`.

use crate::choices::{LOOP_STARTS, STARTS, choice, learner, named, no_argument};
use crate::convert::{result, to_python};
use crate::error::Raise;
use crate::inputs::recordings_of;
use crate::integer::Integer;
use crate::learning::outcomes;
use crate::model::Model;
use crate::progress::with_progress;
use hysteron::{ADAPT_OPTIONS, AdaptOptionKind, AdaptOptions, AdaptValue};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// The result of an adaptation to a recording.
#[pyclass(frozen, get_all, module = "pyhysteron")]
pub(crate) struct Adapted {
    /// The model with the last weights that are not on probation. `model.fit` has its errors over
    /// the whole recording.
    model: Model,
    /// A table, as pandas takes it: arrays of shape (n,).
    ///
    /// 'input', 'output', 'output_model' (before the sample was learned from), 'error' (measured
    /// less modelled) and 'outcome' (as in `Learning`).
    table: Py<PyDict>,
    /// Errors of the model that learned beside those of the fixed model: a
    /// `results.AdaptedComparison`.
    comparison: Py<PyAny>,
}

#[pymethods]
impl Adapted {
    #[new]
    fn new(model: Model, table: Py<PyDict>, comparison: Py<PyAny>) -> Self {
        Self {
            model,
            table,
            comparison,
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, of) = (slf.py(), slf.get());
        let fields = (of.model.clone(), of.table.bind(py), of.comparison.bind(py));
        (slf.get_type(), fields).into_pyobject(py)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let whole = self.comparison.bind(py).getattr("whole")?;
        let rmse = |of| whole.getattr(of)?.getattr("rmse")?.extract::<f64>();
        Ok(format!(
            "<Adapted: RMSE {:.4} adapting, {:.4} fixed>",
            rmse("adapting")?,
            rmse("fixed")?
        ))
    }
}

/// Let a model learn from a recording, sample by sample: first simulate, then learn.
///
/// Of a model with stages around its operators, the weights learn and the stages stay. Errors are then
/// those of the operators, in front of the stages behind them.
///
/// Parameters
/// ----------
/// model : Model
/// recording : Recording, list of Recording, or array_like of shape (n,)
///     In the model's units; of arrays, the input. A list is one experiment: the operators start
///     anew in each recording, and what was learned goes on.
/// output : array_like, shape (n,), optional
///     Where `recording` is the input.
/// time : array_like, shape (n,), optional
///     As in `Recording`. Needed for a model that depends on time, otherwise only checked for going
///     back.
/// method : {'auto', 'fixed', 'refit', 'drift', 'least-squares', 'increments', 'load'}
///     What learns; see `Adaptive`. 'load' follows the
///     shift of the input axis alone, by a load that nobody measures, and runs any model; then the
///     table also has 'shift_model', in the input's unit, and 'load_model', if the model's shift
///     tells a load.
/// start : {'fitted', 'off', 'on', 'rest', 'unknown'}
///     State of the operators before the first sample. 'fitted': the one that the model's fit
///     found, all off if it found none. 'rest': all off, then at rest at an input or two that are
///     found. 'unknown': 'fitted', unless the model as it is errs 1.5 times less from another.
/// progress : callable, bool or None
///     As for `fit`. Ctrl-C ends the work in any case.
/// window, every, ridge, gain, span, forgetting, noise, spread, correlation, offset_share, dead_zone, leakage, movement, trial, gate, burst, load : optional
///     As for `Adaptive`. Defaults follow from model and recording. The noise is that of the
///     output, and at least 2 % (with 'drift' and 'load' 5 %) of the larger of the ranges of output and
///     model. The dead zone is twice the output's noise.
///
/// Returns
/// -------
/// Adapted
///     With 'model', 'table' and 'comparison'.
///
/// Raises
/// ------
/// RecordingError
///     For different lengths, samples that are not finite, and time that goes back.
/// FitError, CoreError
///     As for `Adaptive`.
///
/// Examples
/// --------
/// >>> model = pyhysteron.Model(np.full(15, 1.0), (20, 80))
/// >>> temperature = 50 - 40 * np.cos(0.05 * np.arange(1000))
/// >>> measured = pyhysteron.Model(np.full(15, 1.5), (20, 80)).simulate(temperature)
/// >>> adapted = pyhysteron.adapt(model, temperature, measured)
/// >>> last = adapted.comparison.thirds[-1]
/// >>> last.adapting.rmse < 0.05 * last.fixed.rmse
/// True
#[pyfunction]
#[pyo3(
    signature = (model, recording, output=None, *, time=None, method="auto", start="unknown", progress=None, **options),
    text_signature = "(model, recording, output=None, *, time=None, method='auto', start='unknown', window=None, every=None, ridge=None, gain=None, span=None, forgetting=None, noise=None, spread=None, correlation=None, offset_share=None, dead_zone=None, leakage=None, movement=None, trial=None, gate=None, burst=None, load=None, progress=None)"
)]
#[allow(clippy::too_many_arguments)]
pub(crate) fn adapt<'py>(
    py: Python<'py>,
    model: &Model,
    recording: &Bound<'py, PyAny>,
    output: Option<&Bound<'py, PyAny>>,
    time: Option<&Bound<'py, PyAny>>,
    method: &str,
    start: &str,
    progress: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Adapted> {
    let names = ["time", "progress"];
    let options = adapt_options(("adapt", &names), method, start, options)?;
    let recordings = recordings_of(recording, output, time, None)?;
    let model = &model.inner;
    let adapted = with_progress(py, progress, |progress| {
        hysteron::adapt(model, &recordings, &options, progress)
    })?;
    let errors = PyArray1::from_vec(py, adapted.errors(&recordings));
    let table = PyDict::new(py);
    let each = recordings.as_ref().iter();
    let input = each.clone().flat_map(|r| r.input.iter().copied());
    table.set_item("input", PyArray1::from_iter(py, input))?;
    let output = each.flat_map(|r| r.output.iter().copied());
    table.set_item("output", PyArray1::from_iter(py, output))?;
    table.set_item("error", errors)?;
    table.set_item("outcome", outcomes(py, adapted.outcomes.iter().copied())?)?;
    let comparison = PyDict::new(py);
    comparison.set_item("whole", to_python(py, &adapted.whole)?)?;
    comparison.set_item("thirds", to_python(py, &adapted.thirds)?)?;
    comparison.set_item("late", to_python(py, &adapted.late)?)?;
    comparison.set_item("worse", adapted.worse)?;
    comparison.set_item("probation", adapted.probation)?;
    comparison.set_item("again", to_python(py, &adapted.again)?)?;
    comparison.set_item("again_late", to_python(py, &adapted.again_late)?)?;
    comparison.set_item("again_first", to_python(py, &adapted.again_first)?)?;
    comparison.set_item("late_spread", adapted.late_spread)?;
    comparison.set_item("counts", to_python(py, &adapted.counts)?)?;
    comparison.set_item("drift", to_python(py, &adapted.drift)?)?;
    comparison.set_item("stuck", to_python(py, &adapted.stuck)?)?;
    comparison.set_item("cut_off", to_python(py, &adapted.cut_off)?)?;
    comparison.set_item("start", to_python(py, &adapted.start)?)?;
    comparison.set_item("covered", adapted.covered)?;
    comparison.set_item("session", adapted.session)?;
    comparison.set_item("one_load", adapted.one_load)?;
    table.set_item("output_model", PyArray1::from_vec(py, adapted.output_model))?;
    if let Some(found) = adapted.shift {
        table.set_item("shift_model", PyArray1::from_vec(py, found.shifts))?;
        if let Some(loads) = found.loads {
            table.set_item("load_model", PyArray1::from_vec(py, loads))?;
        }
    }
    Ok(Adapted {
        model: adapted.model.into(),
        table: table.unbind(),
        comparison: result(py, "AdaptedComparison", comparison)?.unbind(),
    })
}

/// The options of `Adaptive` and `adapt`. `names` are those that only `call` has.
pub(crate) fn adapt_options(
    (call, names): (&str, &[&str]),
    method: &str,
    start: &str,
    keywords: Option<&Bound<'_, PyDict>>,
) -> PyResult<AdaptOptions> {
    let mut options = AdaptOptions {
        learner: learner(method)?,
        start: match call {
            "adapt" => choice("start", start, &STARTS)?,
            _ => choice("start", start, &LOOP_STARTS)?,
        },
        ..AdaptOptions::default()
    };
    for (name, value) in keywords.into_iter().flatten() {
        let name: String = name.extract()?;
        let Some(option) = ADAPT_OPTIONS.iter().find(|option| option.name == name) else {
            let own = ADAPT_OPTIONS.iter().map(|option| option.name);
            let known = names.iter().copied().chain(["method", "start"]).chain(own);
            return Err(no_argument(call, &name, &known.collect::<Vec<_>>()));
        };
        if value.is_none() {
            continue;
        }
        let value = match option.kind {
            AdaptOptionKind::Number => AdaptValue::Number(named(&name, "a number", &value)?),
            AdaptOptionKind::Count => {
                let count: Integer = value.extract()?;
                AdaptValue::Count(count.convert(&name)?)
            }
            AdaptOptionKind::Window => {
                let window: String = named(&name, "a text", &value)?;
                option.kind.parse(&window).raise()?
            }
        };
        options.set(&name, value).raise()?;
    }
    Ok(options)
}
