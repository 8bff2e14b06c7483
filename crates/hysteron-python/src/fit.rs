//! `fit` and `left_out`.

use crate::given::recordings_of;
use crate::model::{Model, sign_of};
use crate::said::warn;
use crate::watched::watched;
use crate::whole::Whole;
use crate::word::{choice, operator};
use hysteron::{Candidates, FitOptions, Open, Solver, Start};
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

/// Identify a model: the weights and offset that minimise the squared error over the recording.
///
/// Ctrl-C ends it. Warns (`HysteronWarning`) of what speaks against the fit: inputs outside the plane, an output against its
/// input, operators that the first sample leaves open.
///
/// Parameters
/// ----------
/// recording : Recording, list of Recording, or array_like of shape (n,)
///     Several are one experiment, each from its own initial state; or the input, with the output beside it.
/// output : array_like, shape (n,), optional
/// levels : int or 'auto'
///     Number of levels ``K`` of the plane, which has ``K (K + 1) / 2`` operators. 'auto' chooses it by the error on
///     branches left out.
/// range : tuple of float, optional
///     Lowest and highest level, in the input's unit. By default the active range is that of the input.
/// operator : {'mkp', 'kp', 'relay'}
/// solver : {'nnls', 'ols'}
///     Weights from zero on, which have an inverse, or plain least squares, as a rule without one.
/// smooth : float or 'auto'
///     Strength of the smoothness across the plane, 1e-10 to 1e-4 as a rule; 'auto' as for the levels.
/// start : {'off', 'on', 'unknown'}
///     Where the operators stand before the first sample.
/// sign : {None, 1, -1}
///     Direction of the output; None for the one that fits better.
/// offset : float, optional
///     Output with every operator off; by default identified.
/// load_degree : int
///     Order of the weights as a function of the load, where the recordings have one; 0 to 5.
/// bootstrap : int, optional
///     Replicates for standard errors and the prediction band, 0 for none. By default 200, from 45 levels on 0.
/// thermal : {None, 'first-order'}
///     Identify a thermal body in front of the operators too: for an input that heats. It is taken as proportional to the
///     power, as a duty cycle is; of a current or a voltage give the square. Needs time.
/// time, load : array_like, shape (n,), optional
///     With an input and an output.
/// progress : callable, bool or None
///     Called now and then with what is being done and the share that is done, None where that is not known; True for tqdm.
///
/// Returns
/// -------
/// Model
///
/// Raises
/// ------
/// RecordingError
///     For samples that cannot be worked with, or that never change.
/// FitError, CoreError, ThermalError
///     For options that cannot be, or do not go with the recording.
///
/// Examples
/// --------
/// >>> t = np.linspace(0, 20, 400)
/// >>> input = 50 - 30 * np.cos(t) * np.exp(-t / 20)
/// >>> truth = hysteron.Model(np.full(15, 0.2), (30, 80))
/// >>> model = hysteron.fit(input, truth.simulate(input), levels=8, bootstrap=0)
/// >>> model.fit['nrmse_percent'] < 1
/// True
#[pyfunction]
#[pyo3(signature = (
    recording, output=None, *, levels=None, range=None, operator="mkp", solver="nnls", smooth=None, start="off", sign=None,
    offset=None, load_degree=None, bootstrap=None, thermal=None, time=None, load=None, progress=None,
), text_signature = "(recording, output=None, *, levels=20, range=None, operator='mkp', solver='nnls', smooth=0.0, start='off', sign=None, offset=None, load_degree=1, bootstrap=None, thermal=None, time=None, load=None, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn fit(
    py: Python<'_>,
    recording: &Bound<'_, PyAny>,
    output: Option<&Bound<'_, PyAny>>,
    levels: Option<&Bound<'_, PyAny>>,
    range: Option<(f64, f64)>,
    operator: &str,
    solver: &str,
    smooth: Option<&Bound<'_, PyAny>>,
    start: &str,
    sign: Option<Whole>,
    offset: Option<f64>,
    load_degree: Option<Whole>,
    bootstrap: Option<Whole>,
    thermal: Option<&str>,
    time: Option<&Bound<'_, PyAny>>,
    load: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Model> {
    let (options, mut open) = options(
        levels,
        range,
        operator,
        solver,
        smooth,
        start,
        sign,
        offset,
        load_degree,
    )?;
    open.bootstrap = bootstrap.is_none();
    let options = FitOptions {
        bootstrap: bootstrap.map_or(Ok(0), |n| n.of("bootstrap"))?,
        ..options
    };
    let thermal = match thermal {
        None => false,
        Some(word) => choice("thermal", word, &[("first-order", true)])?,
    };
    let recordings = recordings_of(recording, output, time, load)?;
    let (model, advice) = watched(py, progress, |watch| {
        let model = hysteron::identify(&recordings, &options, open, thermal, watch)?;
        let advice = hysteron::advice(&model, &recordings)?;
        Ok((model, advice))
    })?;
    for advice in advice {
        warn(py, &advice.to_string())?;
    }
    Ok(model.into())
}

/// The error on branches that were left out of the whole fit in turn, choices included.
///
/// Parameters
/// ----------
/// recording, output, levels, range, operator, solver, smooth, start, sign, offset, load_degree, time, load, progress
///     As for `fit`. What is 'auto' is chosen anew without each group of branches.
///
/// Returns
/// -------
/// dict
///     'predicted' (ndarray, shape (n,)), the output at each sample when it was left out; 'fold' (ndarray of int, shape (n,)),
///     the group of branches that it was left out with; 'nrmse_percent' and 'training_nrmse_percent', errors left out and over
///     what was fitted, in percent of the measured range; 'branches' (int); 'chosen', levels and smoothness of each fold.
///
/// Raises
/// ------
/// FitError
///     For an input of a single branch; otherwise as `fit`.
///
/// Examples
/// --------
/// >>> input = 50 - 30 * np.cos(np.linspace(0, 20, 400))
/// >>> found = hysteron.left_out(input, 0.5 * input, levels=5)
/// >>> found['branches'], found['nrmse_percent'] < 1
/// (7, True)
#[pyfunction]
#[pyo3(signature = (
    recording, output=None, *, levels=None, range=None, operator="mkp", solver="nnls", smooth=None, start="off", sign=None,
    offset=None, load_degree=None, time=None, load=None, progress=None,
), text_signature = "(recording, output=None, *, levels=20, range=None, operator='mkp', solver='nnls', smooth=0.0, start='off', sign=None, offset=None, load_degree=1, time=None, load=None, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn left_out<'py>(
    py: Python<'py>,
    recording: &Bound<'py, PyAny>,
    output: Option<&Bound<'py, PyAny>>,
    levels: Option<&Bound<'py, PyAny>>,
    range: Option<(f64, f64)>,
    operator: &str,
    solver: &str,
    smooth: Option<&Bound<'py, PyAny>>,
    start: &str,
    sign: Option<Whole>,
    offset: Option<f64>,
    load_degree: Option<Whole>,
    time: Option<&Bound<'py, PyAny>>,
    load: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let (options, open) = options(
        levels,
        range,
        operator,
        solver,
        smooth,
        start,
        sign,
        offset,
        load_degree,
    )?;
    let candidates = (open.levels || open.smooth).then(|| {
        Candidates::new(
            (!open.levels).then_some(options.levels),
            (!open.smooth).then_some(options.smooth),
        )
    });
    let recordings = recordings_of(recording, output, time, load)?;
    let found = watched(py, progress, |watch| {
        hysteron::left_out(&recordings, &options, candidates.as_ref(), watch)
    })?;
    let dict = PyDict::new(py);
    dict.set_item("predicted", PyArray1::from_slice(py, &found.predicted))?;
    let fold = found.fold.iter().map(|fold| *fold as i64);
    dict.set_item("fold", PyArray1::from_iter(py, fold))?;
    dict.set_item("nrmse_percent", found.nrmse_percent)?;
    dict.set_item("training_nrmse_percent", found.training_nrmse_percent)?;
    dict.set_item("branches", found.branches)?;
    dict.set_item("chosen", found.chosen)?;
    Ok(dict)
}

#[allow(clippy::too_many_arguments)]
fn options(
    levels: Option<&Bound<'_, PyAny>>,
    range: Option<(f64, f64)>,
    operator_word: &str,
    solver: &str,
    smooth: Option<&Bound<'_, PyAny>>,
    start: &str,
    sign: Option<Whole>,
    offset: Option<f64>,
    load_degree: Option<Whole>,
) -> PyResult<(FitOptions, Open)> {
    let (levels, open_levels) = or_auto("levels", levels, |n| n.extract::<Whole>()?.of("levels"))?;
    let (smooth, open_smooth) = or_auto("smooth", smooth, |strength| strength.extract())?;
    let usual = FitOptions::default();
    let solvers = [("nnls", Solver::Nnls), ("ols", Solver::Ols)];
    let options = FitOptions {
        operator: operator(operator_word)?,
        levels: levels.unwrap_or(usual.levels),
        range,
        solver: choice("solver", solver, &solvers)?,
        sign: sign.map(sign_of).transpose()?,
        offset,
        smooth: smooth.unwrap_or(usual.smooth),
        start: start_of(start)?,
        load_degree: load_degree.map_or(Ok(usual.load_degree), |n| n.of("load_degree"))?,
        bootstrap: 0,
    };
    let open = Open {
        levels: open_levels,
        smooth: open_smooth,
        bootstrap: false,
    };
    Ok((options, open))
}

/// Where the operators stand at first.
pub(crate) fn start_of(word: &str) -> PyResult<Start> {
    let starts = [
        ("off", Start::Off),
        ("on", Start::On),
        ("unknown", Start::Unknown),
    ];
    choice("start", word, &starts)
}

/// A number, or `None` where it is left out or 'auto'; and whether it is 'auto'.
fn or_auto<T>(
    argument: &str,
    value: Option<&Bound<'_, PyAny>>,
    number: impl Fn(&Bound<'_, PyAny>) -> PyResult<T>,
) -> PyResult<(Option<T>, bool)> {
    match value.map(|value| (value, value.cast::<PyString>())) {
        None => Ok((None, false)),
        Some((_, Ok(word))) if *word == "auto" => Ok((None, true)),
        Some((_, Ok(word))) => Err(PyTypeError::new_err(format!(
            "`{argument}` is {}: a number or 'auto' is needed",
            word.repr()?
        ))),
        Some((value, Err(_))) => Ok((Some(number(value)?), false)),
    }
}
