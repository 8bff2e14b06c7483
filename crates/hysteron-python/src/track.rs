//! `track`.

use crate::convert::result_of;
use crate::error::Raise;
use crate::integer::Integer;
use crate::model::Model;
use crate::pid::Pid;
use crate::pool::detached;
use crate::progress::with_progress;
use crate::trace::Trace;
use hysteron_sim::track::{Comparison as Found, Scenario, Score};
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Controllers compared on a simulated plant: what `track` found.
#[pyclass(frozen, module = "pyhysteron")]
pub(crate) struct Comparison {
    inner: Found,
}

#[pymethods]
impl Comparison {
    /// The scenario's title.
    #[getter]
    fn title(&self) -> &str {
        &self.inner.title
    }

    /// Always True: nothing was measured.
    #[getter]
    fn simulated(&self) -> bool {
        true
    }

    /// Names of the controllers, in order.
    #[getter]
    fn controllers(&self) -> Vec<&'static str> {
        self.inner
            .controllers
            .iter()
            .map(|kind| kind.name())
            .collect()
    }

    /// A table, as pandas takes it: a row for each controller, seed and window.
    ///
    /// Lists: 'controller' and 'window'. Arrays: 'seed', 'from_s', 'to_s', 'rmse', 'max_abs',
    /// 'prediction_rmse' (model against output, before it learned), 'frozen_rmse' (the same without
    /// learning in the window), 'lag_s' (after reversals), 'drive_travel', 'saturated' and 'faults'
    /// (shares). NaN where a value does not exist.
    #[getter]
    fn scores<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let inner = &self.inner;
        let mut rows = Vec::new();
        for (kind, seeds) in inner.controllers.iter().zip(&inner.scores) {
            for (seed, windows) in seeds.iter().enumerate() {
                let windows = inner.windows.iter().zip(windows);
                rows.extend(windows.map(|(window, score)| (kind.name(), seed + 1, window, score)));
            }
        }
        let table = PyDict::new(py);
        table.set_item("controller", PyList::new(py, rows.iter().map(|row| row.0))?)?;
        table.set_item(
            "seed",
            PyArray1::from_iter(py, rows.iter().map(|row| row.1 as i64)),
        )?;
        table.set_item(
            "window",
            PyList::new(py, rows.iter().map(|row| &row.2.name))?,
        )?;
        table.set_item(
            "from_s",
            PyArray1::from_iter(py, rows.iter().map(|row| row.2.from_s)),
        )?;
        table.set_item(
            "to_s",
            PyArray1::from_iter(py, rows.iter().map(|row| row.2.to_s)),
        )?;
        type Of = fn(&Score) -> f64;
        let columns: [(&str, Of); 8] = [
            ("rmse", |s| s.rmse),
            ("max_abs", |s| s.max_abs),
            ("prediction_rmse", |s| s.prediction_rmse),
            ("frozen_rmse", |s| s.frozen_rmse),
            ("lag_s", |s| s.lag_s),
            ("drive_travel", |s| s.drive_travel),
            ("saturated", |s| s.saturated),
            ("faults", |s| s.faults),
        ];
        for (name, of) in columns {
            table.set_item(
                name,
                PyArray1::from_iter(py, rows.iter().map(|row| of(row.3))),
            )?;
        }
        Ok(table)
    }

    /// Medians over the seeds: a `results.Median` for each window and controller.
    #[getter]
    fn medians<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        results(py, "Median", &self.inner.medians())
    }

    /// Inverse and PID against PID, and adaptive against fixed inverse: a `results.Ratio` for each
    /// settled window.
    #[getter]
    fn ratios<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        results(py, "Ratio", &self.inner.ratios())
    }

    /// Each controller's run of the first seed, by its name.
    #[getter]
    fn traces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let traces = PyDict::new(py);
        for (kind, trace) in self.inner.controllers.iter().zip(&self.inner.traces) {
            traces.set_item(kind.name(), Trace::from(trace.clone()))?;
        }
        Ok(traces)
    }

    /// The model identified for the first seed.
    #[getter]
    fn model(&self) -> Model {
        self.inner.model.clone().into()
    }

    /// A PID with the gains that all had; None where no controller has one, or each has gains from
    /// its model.
    #[getter]
    fn pid(&self) -> Option<Pid> {
        self.inner.gains.map(Pid::from_gains)
    }

    /// Where each has gains from its model (`tuning = "model"`), for the first seed, by the name of
    /// the controller: its PID, and the factor that the gains may grow by before the simulated loop
    /// is restless.
    #[getter]
    fn tuned<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tuned = PyDict::new(py);
        for (kind, seeds) in self.inner.controllers.iter().zip(&self.inner.tuned) {
            if let Some(Some(found)) = seeds.first() {
                tuned.set_item(kind.name(), (Pid::from_gains(found.gains), found.margin))?;
            }
        }
        Ok(tuned)
    }

    /// A PID with the gains of the loop around the temperature; None where there is none.
    #[getter]
    fn inner_pid(&self) -> Option<Pid> {
        self.inner.inner_gains.map(Pid::from_gains)
    }

    /// Write the table of all scores.
    ///
    /// Parameters
    /// ----------
    /// path : str or path-like
    ///
    /// Raises
    /// ------
    /// FileError
    fn to_csv(&self, path: PathBuf) -> PyResult<()> {
        self.inner.write_scores(&path).raise()
    }

    fn __repr__(&self) -> String {
        let names = self.controllers().join(", ");
        format!("<Comparison, simulated: {}: {names}>", self.title())
    }
}

/// Compare controllers on a simulated plant, as ``hysteron track`` does.
///
/// For each seed a model is identified from an experiment of its own, and every controller runs
/// over the same reference with the same disturbances. The gains of all PIDs come from one test on
/// the same plant. Ctrl-C ends it.
///
/// Parameters
/// ----------
/// scenario : str or path-like
///     Name of a built-in scenario (`scenarios`), a TOML file, or the text of one (which has more
///     than one line).
/// seeds : int, optional
///     How many runs, each with its own noise, instead of what the scenario says.
/// progress : callable or bool, optional
///     Called with 'runs' and the share that is done; True for tqdm.
///
/// Returns
/// -------
/// Comparison
///
/// Raises
/// ------
/// ScenarioError
///     For an invalid scenario, with line or field.
/// FileError, RigError, FitError
///
/// Examples
/// --------
/// >>> comparison = pyhysteron.track('''
/// ... title = "A sine on a simulated piezo-like actuator"
/// ... duration_s = 8
/// ... interval_s = 0.01
/// ... settle_s = 2
/// ... seeds = 1
/// ... plant = { kind = "preisach", levels = 60 }
/// ... model = { levels = 10, range = [8, 150], rates = [200, 200] }
/// ... loop = { filter_s = 0.01, tolerance = 0.5 }
/// ... controllers = ["pid", "inverse-pid"]
/// ... reference = [{ kind = "constant", value = 36 }, { kind = "sine", amplitude = 24, period_s = 2 }]
/// ... ''')
/// >>> rmse = comparison.scores['rmse']  # two controllers, one seed, two windows
/// >>> bool(rmse[2] < rmse[0])
/// True
/// >>> comparison.traces['inverse-pid']
/// <Trace, 800 samples to 7.99 s>
/// >>> import os, tempfile
/// >>> comparison.to_csv(os.path.join(tempfile.mkdtemp(), 'scores.csv'))
#[pyfunction]
#[pyo3(signature = (scenario, *, seeds=None, progress=None))]
pub(crate) fn track(
    py: Python<'_>,
    scenario: &Bound<'_, PyAny>,
    seeds: Option<Integer>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Comparison> {
    let mut scenario = scenario_of(scenario)?;
    if let Some(seeds) = seeds {
        scenario.seeds = seeds.convert("seeds")?;
    }
    let inner = with_progress(py, progress, |progress| {
        hysteron_sim::track::track(&scenario, progress)
    })?;
    Ok(Comparison { inner })
}

/// The gains that a scenario's test gives, the same for all its controllers.
///
/// Parameters
/// ----------
/// scenario : str or path-like
///     As for `pyhysteron.track`.
///
/// Returns
/// -------
/// pid : Pid or None
///     Feedback of the output; None where no controller has one, or each has gains from its model.
/// inner : Pid or None
///     The loop around the temperature, whose drive is a square root; None where there is none.
///
/// Raises
/// ------
/// ScenarioError
///     For an invalid scenario, with line or field, and for a plant that does not answer the test.
/// FileError, RigError
///
/// Examples
/// --------
/// >>> outer, inner = pyhysteron.control.tune('sine')  # a spring, heated by a current
/// >>> outer.gain > 0 and inner.gain > 0
/// True
#[pyfunction]
pub(crate) fn tune(
    py: Python<'_>,
    scenario: &Bound<'_, PyAny>,
) -> PyResult<(Option<Pid>, Option<Pid>)> {
    let scenario = scenario_of(scenario)?;
    let (scheme, gains) = detached(py, || hysteron_sim::track::tune(&scenario)).raise()?;
    Ok((
        gains.map(Pid::from_gains),
        scheme.inner.map(|inner| Pid::from_gains(inner.gains)),
    ))
}

/// The built-in scenarios: their names, and their text to start one's own from.
///
/// Returns
/// -------
/// dict of str
///
/// Examples
/// --------
/// >>> print(*sorted(pyhysteron.scenarios()))
/// bouc-wen drift faults latent-wire load-step load-step-preisach sine staircase wire
#[pyfunction]
pub(crate) fn scenarios(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for name in Scenario::names() {
        all.set_item(name, Scenario::text(name))?;
    }
    Ok(all)
}

fn results<'py>(
    py: Python<'py>,
    class: &str,
    values: &[impl Serialize],
) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for value in values {
        list.append(result_of(py, class, value)?)?;
    }
    Ok(list)
}

fn scenario_of(scenario: &Bound<'_, PyAny>) -> PyResult<Scenario> {
    if let Ok(text) = scenario.extract::<String>() {
        return match text.trim().contains('\n') {
            true => Scenario::parse(&text, Path::new("")).raise(),
            false => Scenario::load(&text).raise(),
        };
    }
    let path: PathBuf = scenario.extract().map_err(|_| {
        PyTypeError::new_err(format!(
            "`scenario` is {scenario}: a name, a path or a text is needed"
        ))
    })?;
    Scenario::load(&path.to_string_lossy()).raise()
}
