//! `fit` and `left_out`.

use crate::choices::{another_kind, choice, named, no_argument, operator, start_of};
use crate::convert::{result, warn};
use crate::error::{Raise, spelt};
use crate::inputs::{recordings_alone, recordings_of};
use crate::integer::Integer;
use crate::model::{Model, sign_of};
use crate::prior::WeightPrior;
use crate::progress::with_progress;
use hysteron::{
    Auto, Candidates, Choice, Dynamics, Fit, FitOptions, HeldOut, HoldOut, LoadLaw, Smooth, Solver,
    Spacing, Thermal,
};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySequence, PyString};

/// Identify a model: the weights and offset that minimise the squared error over the recording.
///
/// Ctrl-C ends it. `HysteronWarning` reports inputs outside the plane, an output that falls as
/// the input rises, operators whose state at the first sample is unknown, and simple predictors
/// that are better on what was left out or held out.
///
/// Parameters
/// ----------
/// recording : Recording, list of Recording, or array_like of shape (n,)
///     A list is one experiment: each recording starts from its own initial state. An array is
///     the input, and `output` is needed.
/// output : array_like, shape (n,), optional
/// levels : int or 'auto'
///     Number of levels ``K`` of the plane, from 2 on; it has ``K (K + 1) / 2`` operators. 'auto'
///     chooses it by the error on branches left out, or by the evidence where there are few.
/// range : tuple of float, optional
///     Lowest and highest level, in the input's unit. By default the active range is that of the
///     input.
/// operator : {'mkp', 'kp', 'relay'}
///     With an identified offset, 'kp' fits as 'mkp' does: they differ by an offset.
/// solver : {'nnls', 'ols'}
///     'nnls': weights from zero on; the model has an inverse. 'ols': plain least squares; as a
///     rule without an inverse.
/// smooth : float, tuple of float, or 'auto'
///     Strength of the smoothness along the diagonal of the plane, or a pair of strengths along and
///     across it, from 0 on; 1e-10 to 1e-4 and 1e-10 to 1e-7 are usual. 'auto' chooses them as
///     `levels`.
/// ridge : float
///     Pulls weights that the data hardly move to zero, 0 to 1; relative to the mean diagonal
///     element of the Gram matrix.
/// robust : bool
///     Whether outliers, which stand out from their neighbours, are found and left out of the fit.
/// start : {'auto', 'off', 'on', 'rest', 'unknown'}
///     State of the operators before the first sample. 'rest': all off, then at an input that the
///     fit finds. 'auto': 'rest', unless 'unknown' predicts clearly better.
/// sign : {None, 1, -1}
///     Direction of the output; None for the one that fits better.
/// offset : float, optional
///     Output with every operator off; by default identified.
/// load_law : {'auto', 'shift', 'weights'}
///     What a load changes, where the recordings have one. 'shift': it shifts the axis of the
///     operators, as stress shifts the temperatures of a shape-memory alloy, and weights and offset
///     follow with `load_degree`. 'weights': weights and offset only. 'auto': the one that predicts
///     loads left out best, of these and a registration, which moves the thresholds of rising and of
///     falling input each along a curve; that one, where there is no load to leave out.
/// load_degree : int or 'auto'
///     Order of the weights as a function of the load, 0 to 5. 'auto': the one that predicts loads
///     left out, of three or more, and otherwise 1.
/// spacing : {'auto', 'uniform'}
///     Where the levels are. 'auto': close together where the output moves, if that is better.
/// delay : int, 'auto' or 'off'
///     Dead time: samples from an input to the output that answers it, up to 1000. 'auto' looks for
///     up to 60 and takes them only where they predict parts of the recording that were left out
///     clearly better; none without `time` at equal distances, with a load, and where `creep` or
///     `lag` is asked for. See `Model.delay_s`.
/// creep : int, 'auto' or 'off'
///     Terms of a creep after the operators, 0 to 4. 'auto' takes creep only where it predicts
///     parts of the recording that were left out. Needs `time`.
/// lag : float, 'auto' or 'off'
///     Time constant of a lag after the operators, s, from 0 on; 'auto' as for `creep`. Needs
///     `time`.
/// dynamics : {'auto', 'off', 'lag', 'ring'}
///     What happens behind the operators in time. 'auto': a ring, which is a resonance of the second
///     order, where `time` is given and the recording excites one that predicts parts left out, or
///     a lag, or a thermal body in front of the operators; nothing where there is a load, or
///     `creep`, `lag` or `thermal` is asked for. 'lag' as ``lag='auto'``.
///     'ring': the best ring, excited or not; needs `time`.
/// curve : int, 'auto' or 'off'
///     Pieces of an output curve behind the operators, up to 100. 'auto' takes a curve only where it
///     predicts parts of the recordings that were left out.
/// bootstrap : int, optional
///     Replicates for standard errors and the prediction band, 0 for none. By default 200, from 25
///     levels on 60, from 45 on 0.
/// repeats : Recording or list of Recording, optional
///     Other recordings of the same actuator. The weights are not fitted to them. The band is
///     widened to what changes between sessions.
/// hold_out : str, Recording or list of them, optional
///     What takes no part in the fit, and tests it beside a straight line and interpolation:
///     ``'branches:20%'`` (a share up to 33 %, spread over the recording, with time the last ones),
///     ``'rows:100-200'`` or ``'rows:1-9,100-200'`` (counted from 1), or other recordings. A list
///     may hold one such text beside recordings. `FitSummary.hold_out` has the errors there.
/// thermal : {None, 'first-order', 'auto', True, False}
///     None leaves it to `dynamics`; False looks for none.
///     Identify a thermal body in front of the operators, for an input that heats: 'first-order' or
///     True. 'auto' adds heat that the operators bind where that predicts what is left out. The
///     input has to be proportional to the power, as a duty cycle is: give the square of a current
///     or a voltage. Each sample of it was held since the sample before. Needs `time`.
/// prior : WeightPrior, optional
///     What other actuators of the same kind tell; see `pyhysteron.fleet`. Plane, spacing, operator
///     and sign are then theirs, and there is neither smoothness nor a bootstrap.
/// time, load : array_like, shape (n,), optional
///     For an input and an output given as arrays. `time` as in `Recording`.
/// progress : callable, bool or None
///     Called about 20 times a second with the name of the stage and the share done (None where
///     unknown). What it raises ends the work. True shows a tqdm bar.
///
/// Returns
/// -------
/// Model
///
/// Raises
/// ------
/// RecordingError
///     For invalid samples, or samples that never change.
/// FitError, CoreError, ThermalError
///     For invalid options, or options that do not fit the recording.
///
/// Examples
/// --------
/// >>> t = np.linspace(0, 20, 400)
/// >>> input = 50 - 30 * np.cos(t) * np.exp(-t / 20)
/// >>> truth = pyhysteron.Model(np.full(15, 0.2), (30, 80))
/// >>> model = pyhysteron.fit(input, truth.simulate(input), levels=8, bootstrap=0)
/// >>> model.fit.nrmse_percent < 1
/// True
///
/// >>> options = {'levels': 8, 'bootstrap': 0, 'hold_out': 'branches:20%'}
/// >>> tested = pyhysteron.fit(input, truth.simulate(input), **options)
/// >>> line = tested.fit.hold_out.rivals[0]
/// >>> line.name, line.rmse > 5 * tested.fit.hold_out.model.rmse
/// ('straight line', True)
#[pyfunction]
#[pyo3(signature = (
    recording, output=None, *, bootstrap=None, repeats=None, hold_out=None, thermal=None, prior=None, time=None,
    load=None, progress=None, **options,
), text_signature = "(recording, output=None, *, levels='auto', range=None, operator='mkp', solver='nnls', smooth='auto', ridge=1e-6, robust=True, start='auto', sign=None, offset=None, load_law='auto', load_degree='auto', spacing='auto', delay='auto', creep='off', lag='off', dynamics='auto', curve='off', bootstrap=None, repeats=None, hold_out=None, thermal=None, prior=None, time=None, load=None, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn fit(
    py: Python<'_>,
    recording: &Bound<'_, PyAny>,
    output: Option<&Bound<'_, PyAny>>,
    bootstrap: Option<Integer>,
    repeats: Option<&Bound<'_, PyAny>>,
    hold_out: Option<&Bound<'_, PyAny>>,
    thermal: Option<&Bound<'_, PyAny>>,
    prior: Option<PyRef<'_, WeightPrior>>,
    time: Option<&Bound<'_, PyAny>>,
    load: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Model> {
    let names = [
        "bootstrap",
        "repeats",
        "hold_out",
        "thermal",
        "prior",
        "time",
        "load",
        "progress",
    ];
    let mut fit = fit_with("fit", &names, (bootstrap, thermal, prior), options)?;
    let recordings = recordings_of(recording, output, time, load)?;
    let repeats = repeats.map(|repeats| recordings_alone("repeats", repeats));
    let hold_out = hold_out.map(hold_out_of).transpose()?;
    fit = fit.repeats(repeats.transpose()?.unwrap_or_default());
    let (model, advice) = with_progress(py, progress, |progress| {
        let fit = fit.progress(progress);
        let (model, held_out) = match &hold_out {
            None => (fit.run(&recordings)?, None),
            Some(what) => {
                let (model, held_out) = hysteron::fit_holding_out(&fit, &recordings, what)?;
                (model, Some(held_out))
            }
        };
        let mut advice = hysteron::advice(&model, recordings.as_ref())?;
        advice.extend(held_out.iter().flat_map(HeldOut::advice));
        Ok((model, advice))
    })?;
    for advice in advice {
        warn(py, &format!("{advice}: {}", spelt(&advice.remedy())))?;
    }
    Ok(model.into())
}

/// Cross-validate: leave out groups of branches in turn, fit the rest, and predict what was left
/// out.
///
/// Parameters
/// ----------
/// recording, output, levels, range, operator, solver, smooth, ridge, start, sign, offset, load_degree, time, load, progress
///     As for `fit`, with the load law 'weights', a `load_degree` of 1 for 'auto', and without the
///     stages around the operators. 'auto' of `levels` and `smooth` chooses again for each group,
///     without its branches.
///
/// Returns
/// -------
/// results.LeftOut
///
/// Raises
/// ------
/// FitError
///     For an input of a single branch; otherwise as `fit`.
///
/// Examples
/// --------
/// >>> input = 50 - 30 * np.cos(np.linspace(0, 20, 400))
/// >>> found = pyhysteron.left_out(input, 0.5 * input, levels=5)
/// >>> found.branches, found.nrmse_percent < 1
/// (7, True)
#[pyfunction]
#[pyo3(signature = (
    recording, output=None, *, time=None, load=None, progress=None, **options,
), text_signature = "(recording, output=None, *, levels='auto', range=None, operator='mkp', solver='nnls', smooth='auto', ridge=1e-6, start='auto', sign=None, offset=None, load_degree='auto', time=None, load=None, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn left_out<'py>(
    py: Python<'py>,
    recording: &Bound<'py, PyAny>,
    output: Option<&Bound<'py, PyAny>>,
    time: Option<&Bound<'py, PyAny>>,
    load: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let names = ["time", "load", "progress"];
    let (mut options, auto) = fit_options("left_out", &names, FitOptions::plain(), options)?;
    let candidates = (auto.levels || auto.smooth).then(|| {
        Candidates::new(
            (!auto.levels).then_some(options.levels),
            (!auto.smooth).then_some(options.smooth),
        )
    });
    let recordings = recordings_of(recording, output, time, load)?;
    let found = with_progress(py, progress, |progress| {
        if auto.start {
            options = hysteron::usual_start(recordings.as_ref(), &options)?;
        }
        hysteron::left_out(recordings.as_ref(), &options, candidates.as_ref(), progress)
    })?;
    let dict = PyDict::new(py);
    dict.set_item("predicted", PyArray1::from_slice(py, &found.predicted))?;
    let fold = found.fold.iter().map(|fold| *fold as i64);
    dict.set_item("fold", PyArray1::from_iter(py, fold))?;
    dict.set_item("nrmse_percent", found.nrmse_percent)?;
    dict.set_item("training_nrmse_percent", found.training_nrmse_percent)?;
    dict.set_item("branches", found.branches)?;
    let chosen = found.chosen.iter();
    let chosen = chosen.map(|(levels, smooth)| (*levels, (smooth.along, smooth.across)));
    dict.set_item("chosen", chosen.collect::<Vec<_>>())?;
    result(py, "LeftOut", dict)
}

/// The bootstrap, the body and the prior, which are arguments of their own.
type Named<'a, 'py> = (
    Option<Integer>,
    Option<&'a Bound<'py, PyAny>>,
    Option<PyRef<'py, WeightPrior>>,
);

/// A fit with these and all other options.
pub(crate) fn fit_with(
    call: &str,
    names: &[&str],
    (bootstrap, thermal, prior): Named<'_, '_>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Fit<'static>> {
    let defaults = FitOptions {
        robust: true,
        spacing: Spacing::Auto,
        delay: Choice::Auto,
        dynamics: Dynamics::Auto,
        ..FitOptions::plain()
    };
    let names = [names, &STAGES[..]].concat();
    let (options, auto) = fit_options(call, &names, defaults, options)?;
    let mut fit = Fit::from(options);
    if auto.levels {
        fit = fit.levels(Auto);
    }
    if auto.smooth {
        fit = fit.smooth(Auto);
    }
    if auto.start {
        fit = fit.start(Auto);
    }
    if let Some(thermal) = thermal {
        fit = fit.thermal(thermal_of(thermal)?);
    }
    if let Some(prior) = prior {
        fit = fit.prior(prior.inner.clone());
    }
    Ok(match bootstrap {
        None => fit.bootstrap(Auto),
        Some(count) => fit.bootstrap(count.convert::<usize>("bootstrap")?),
    })
}

/// What is `'auto'`.
struct LeftToTheData {
    levels: bool,
    smooth: bool,
    start: bool,
}

impl Default for LeftToTheData {
    fn default() -> Self {
        Self {
            levels: true,
            smooth: true,
            start: true,
        }
    }
}

/// The options that `fit` and `left_out` share.
fn fit_options(
    call: &str,
    names: &[&str],
    mut options: FitOptions,
    keywords: Option<&Bound<'_, PyDict>>,
) -> PyResult<(FitOptions, LeftToTheData)> {
    let mut auto = LeftToTheData::default();
    for (name, value) in keywords.into_iter().flatten() {
        let name: String = name.extract()?;
        let text = || named::<String>(&name, "a text", &value);
        match name.as_str() {
            _ if value.is_none() => {}
            "levels" if is_auto(&value) => auto.levels = true,
            "levels" if value.is_instance_of::<PyString>() => {
                return Err(another_kind(&name, "a whole number or 'auto'", &value));
            }
            "levels" => {
                options.levels = value.extract::<Integer>()?.convert("levels")?;
                auto.levels = false;
            }
            "range" => options.range = Some(named(&name, "a pair of numbers", &value)?),
            "operator" => options.operator = operator(&text()?)?,
            "solver" => options.solver = choice("solver", &text()?, &SOLVERS)?,
            "smooth" if is_auto(&value) => auto.smooth = true,
            "smooth" => {
                options.smooth = smooth_of(&name, &value)?;
                auto.smooth = false;
            }
            "ridge" => options.ridge = named(&name, "a number", &value)?,
            "start" if is_auto(&value) => auto.start = true,
            "start" => {
                options.start = start_of(&text()?)?;
                auto.start = false;
            }
            "sign" => options.sign = Some(sign_of(value.extract()?)?),
            "offset" => options.offset = Some(named(&name, "a number", &value)?),
            "load_degree" if is_auto(&value) => options.load_degree = None,
            "load_degree" if value.is_instance_of::<PyString>() => {
                return Err(another_kind(&name, "a whole number or 'auto'", &value));
            }
            "load_degree" => {
                options.load_degree = Some(value.extract::<Integer>()?.convert("load_degree")?);
            }
            other if !names.contains(&other) => {
                return Err(no_argument(call, &name, &[names, &OPTIONS].concat()));
            }
            "load_law" => options.load_law = choice("load_law", &text()?, &LAWS)?,
            "robust" => options.robust = named(&name, "True or False", &value)?,
            "spacing" => options.spacing = choice("spacing", &text()?, &SPACINGS)?,
            "delay" => {
                let samples =
                    |value: &Bound<'_, PyAny>| value.extract::<Integer>()?.convert("delay");
                options.delay = stage(&name, &value, 0, samples)?;
            }
            "creep" => {
                let terms = |value: &Bound<'_, PyAny>| value.extract::<Integer>()?.convert("creep");
                options.creep = stage(&name, &value, 0, terms)?;
            }
            "lag" => {
                let seconds = |value: &_| named("lag", "a number, 'auto' or 'off'", value);
                options.lag = stage(&name, &value, 0.0, seconds)?;
            }
            "dynamics" => options.dynamics = choice("dynamics", &text()?, &DYNAMICS)?,
            "curve" => {
                let pieces =
                    |value: &Bound<'_, PyAny>| value.extract::<Integer>()?.convert("curve");
                options.curve = stage(&name, &value, 0, pieces)?;
            }
            _ => return Err(no_argument(call, &name, &[names, &OPTIONS].concat())),
        }
    }
    Ok((options, auto))
}

const OPTIONS: [&str; 10] = [
    "levels",
    "range",
    "operator",
    "solver",
    "smooth",
    "ridge",
    "start",
    "sign",
    "offset",
    "load_degree",
];

/// The options of the stages around the operators, which only `fit` has.
const STAGES: [&str; 8] = [
    "load_law", "robust", "spacing", "delay", "creep", "lag", "dynamics", "curve",
];

const DYNAMICS: [(&str, Dynamics); 4] = [
    ("auto", Dynamics::Auto),
    ("off", Dynamics::Off),
    ("lag", Dynamics::Lag),
    ("ring", Dynamics::Ring),
];

const LAWS: [(&str, LoadLaw); 3] = [
    ("auto", LoadLaw::Auto),
    ("shift", LoadLaw::Shift),
    ("weights", LoadLaw::Weights),
];

const SPACINGS: [(&str, Spacing); 2] = [("uniform", Spacing::Uniform), ("auto", Spacing::Auto)];

const SOLVERS: [(&str, Solver); 2] = [("nnls", Solver::Nnls), ("ols", Solver::Ols)];

/// A strength along the diagonal, or a pair of strengths along and across it.
fn smooth_of(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Smooth> {
    match value.extract::<(f64, f64)>() {
        Ok(strengths) => Ok(strengths.into()),
        Err(_) => {
            named::<f64>(name, "a number, a pair of numbers or 'auto'", value).map(Smooth::from)
        }
    }
}

fn is_auto(value: &Bound<'_, PyAny>) -> bool {
    value.cast::<PyString>().is_ok_and(|text| *text == "auto")
}

/// A stage that is off, left to the data, or given by its value.
fn stage<'py, T: Copy>(
    name: &str,
    value: &Bound<'py, PyAny>,
    off: T,
    given: impl FnOnce(&Bound<'py, PyAny>) -> PyResult<T>,
) -> PyResult<Choice<T>> {
    match value.cast::<PyString>() {
        Ok(word) => {
            let words = [("off", Choice::Fixed(off)), ("auto", Choice::Auto)];
            choice(name, &word.to_string(), &words)
        }
        Err(_) => given(value).map(Choice::Fixed),
    }
}

/// What takes no part in a fit: a part of the recordings in words, other recordings, or a list of
/// both.
pub(crate) fn hold_out_of(value: &Bound<'_, PyAny>) -> PyResult<HoldOut> {
    let (mut words, mut recordings) = (Vec::new(), Vec::new());
    let mut take = |one: &Bound<'_, PyAny>| match one.cast::<PyString>() {
        Ok(text) => text
            .to_string()
            .parse()
            .raise()
            .map(|part| words.push(part)),
        Err(_) => recordings_alone("hold_out", one).map(|all| recordings.extend(all)),
    };
    // A text is a sequence, too.
    let sequence = value.cast::<PySequence>().ok();
    match sequence.filter(|_| !value.is_instance_of::<PyString>()) {
        Some(several) => several.try_iter()?.try_for_each(|one| take(&one?))?,
        None => take(value)?,
    }
    if words.len() > 1 {
        let problem =
            "`hold_out` is two parts of the recordings: one is needed, and any recordings";
        return Err(PyValueError::new_err(problem));
    }
    // An empty list is refused by the fit.
    let nothing = HoldOut::Recordings(Vec::new());
    Ok(HoldOut::together(words.pop(), recordings).unwrap_or(nothing))
}

/// What thermal body is to be identified.
fn thermal_of(value: &Bound<'_, PyAny>) -> PyResult<Thermal> {
    match value.extract::<bool>() {
        Ok(body) => Ok(body.into()),
        Err(_) => {
            let name: String = named("thermal", "'first-order', 'auto' or True", value)?;
            let names = [
                ("first-order", Thermal::FirstOrder),
                ("auto", Thermal::Auto),
            ];
            choice("thermal", &name, &names)
        }
    }
}
