//! `AdaptiveLoad`.

use crate::adapt::adapt_options;
use crate::around;
use crate::choices;
use crate::error::{Raise, number};
use crate::learning::Learning;
use crate::model::Model;
use crate::pool::detached;
use crate::shared::Shared;
use hysteron::{Sample, Wanted};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A model under a load that nobody measures: it follows the load while it runs.
///
/// When the weight on the hook changes, the input axis shifts. This follows the shift alone, one
/// number, and leaves the weights as they are. It runs any model, also one with a thermal body. Of a
/// model that depends on a load, the shift tells the load, and offset, stroke and weights are those
/// of that load.
///
/// It holds two states. That of the model follows the measured input. That of the inverse follows
/// the inputs that `solve` returned. Threads may share an AdaptiveLoad: each call ends before the
/// next one begins.
///
/// Parameters
/// ----------
/// model : Model
///     It stays as it is.
/// load : float, optional
///     Of a model that depends on a load: the load to start at. By default the middle of its range.
/// start : {'off', 'on'}
///     State of the operators.
/// noise : float, optional
///     Standard deviation of a reading's error, model error included, in the output's unit, above
///     0. By default 5 % of the model's range.
/// spread : float, optional
///     Standard deviation of the shift at the start and after a jump, in the input's unit (with a
///     thermal body that of the temperature), above 0. By default half of the largest shift: half of
///     the plane's width, or the range of the model's shifts, whichever is more.
/// dead_zone : float, optional
///     Errors up to this are noise, in the output's unit, from 0 on. By default 0.
/// movement : float, optional
///     Levels that the temperature has to move before it learns again, from 0 on. By default 0.05.
/// gate : float, optional
///     As for `Adaptive`. By default 12.
/// burst : int, optional
///     As for `Adaptive`. By default 8.
///
/// Raises
/// ------
/// CoreError
///     For an option out of range and for negative weights.
/// FitError
///     For a load outside the model's range, or of a model that depends on none.
///
/// Examples
/// --------
/// >>> model = pyhysteron.Model(np.full(15, 1.0), (20, 80))
/// >>> plant = pyhysteron.Model(np.full(15, 1.0), (28, 88)).start()  # heavier: 8 K higher
/// >>> adaptive = pyhysteron.AdaptiveLoad(model)
/// >>> for n in range(500):
/// ...     temperature = 55 - 45 * np.cos(0.05 * n)
/// ...     learning = adaptive.step(temperature, plant.step(temperature))
/// >>> abs(adaptive.shift - 8) < 0.1
/// True
#[pyclass(frozen, module = "pyhysteron")]
pub(crate) struct AdaptiveLoad {
    inner: Shared<hysteron::AdaptiveLoad>,
}

impl From<hysteron::AdaptiveLoad> for AdaptiveLoad {
    fn from(adaptive: hysteron::AdaptiveLoad) -> Self {
        let inner = Shared::new(adaptive);
        Self { inner }
    }
}

impl AdaptiveLoad {
    /// The library's, as it is now.
    pub(crate) fn now(&self, py: Python<'_>) -> hysteron::AdaptiveLoad {
        self.inner.with(py, |adaptive| adaptive.clone())
    }
}

#[pymethods]
impl AdaptiveLoad {
    #[new]
    #[pyo3(
        signature = (model, *, start="off", **options),
        text_signature = "(model, *, load=None, start='off', noise=None, spread=None, dead_zone=None, movement=None, gate=None, burst=None)"
    )]
    fn new(
        py: Python<'_>,
        model: &Model,
        start: &str,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let options = adapt_options(("AdaptiveLoad", &[]), "load", start, options)?;
        let model = &model.inner;
        Ok(detached(py, || options.adaptive_load(model))
            .raise()?
            .into())
    }

    /// Move by one sample, and learn from the output `measured` there.
    ///
    /// Parameters
    /// ----------
    /// input, measured : float
    /// dt : float, optional
    ///     As for `State.step`.
    ///
    /// Returns
    /// -------
    /// Learning
    ///
    /// Raises
    /// ------
    /// CoreError, ThermalError
    ///     As `State.step`. Nothing is changed then.
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.AdaptiveLoad(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.step(0.5, 3.5)
    /// Learning(output=4, error=-0.5, outcome='at-rest', clipped=0)
    #[pyo3(signature = (input, measured, *, dt=None))]
    fn step(
        &self,
        py: Python<'_>,
        input: f64,
        measured: f64,
        dt: Option<f64>,
    ) -> PyResult<Learning> {
        let (sample, measured) = (sample(input, dt)?, number("measured", measured)?);
        let step = |adaptive: &mut hysteron::AdaptiveLoad| adaptive.step(sample, measured);
        Ok(self.inner.with(py, step).raise()?.into())
    }

    /// Move by one sample and return the output expected there, without learning.
    ///
    /// Parameters
    /// ----------
    /// input : float
    /// dt : float, optional
    ///     As for `State.step`.
    ///
    /// Returns
    /// -------
    /// float
    ///
    /// Raises
    /// ------
    /// CoreError, ThermalError
    ///     As `State.step`. Nothing is changed then.
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.AdaptiveLoad(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))).simulate(0.5)
    /// 4.0
    #[pyo3(signature = (input, *, dt=None))]
    fn simulate(&self, py: Python<'_>, input: f64, dt: Option<f64>) -> PyResult<f64> {
        let sample = sample(input, dt)?;
        let simulate = |adaptive: &mut hysteron::AdaptiveLoad| adaptive.simulate(sample);
        self.inner.with(py, simulate).raise()
    }

    /// The input that gives `target` at the present shift. Moves the inverse there.
    ///
    /// Parameters
    /// ----------
    /// target : float
    /// dt : float, optional
    ///     As for `State.step`.
    /// heading : {None, 'rising', 'falling'}
    ///     As for `Adaptive.solve`.
    /// tolerance : float
    ///     As for `Adaptive.solve`.
    ///
    /// Returns
    /// -------
    /// input : float
    /// status : int
    ///     As for `Inverse.step`.
    ///
    /// Raises
    /// ------
    /// CoreError, ThermalError
    ///     As `Inverse.step`. Nothing is changed then.
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.AdaptiveLoad(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.solve(4.0)
    /// (0.5, 0)
    #[pyo3(signature = (target, *, dt=None, heading=None, tolerance=0.0))]
    fn solve(
        &self,
        py: Python<'_>,
        target: f64,
        dt: Option<f64>,
        heading: Option<&str>,
        tolerance: f64,
    ) -> PyResult<(f64, i8)> {
        let (dt, _) = around::step(dt, None)?;
        let wanted = Wanted {
            dt,
            ..choices::target(target, heading, tolerance)?.into()
        };
        let solve = |adaptive: &mut hysteron::AdaptiveLoad| adaptive.solve(wanted);
        let solution = self.inner.with(py, solve).raise()?;
        Ok((solution.input, solution.status.number()))
    }

    /// Move the inverse to where the measured input is.
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.AdaptiveLoad(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> _ = adaptive.solve(7.0)  # the inverse goes to the top, the input does not
    /// >>> adaptive.align()
    fn align(&self, py: Python<'_>) {
        self.inner.with(py, |adaptive| adaptive.align());
    }

    /// The shift of the axis from the load that it started at, in the input's unit; with a thermal
    /// body in that of the temperature.
    #[getter]
    fn shift(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |adaptive| adaptive.shift())
    }

    /// Standard deviation of the shift, as the filter believes it.
    #[getter]
    fn deviation(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |adaptive| adaptive.deviation())
    }

    /// The load that the shift tells, at most the outermost one of the model. None for a model whose
    /// shift says nothing of the load.
    #[getter]
    fn load(&self, py: Python<'_>) -> Option<f64> {
        self.inner.with(py, |adaptive| adaptive.load())
    }

    /// The model at the start.
    #[getter]
    fn offline(&self, py: Python<'_>) -> Model {
        self.inner
            .with(py, |adaptive| adaptive.offline().clone())
            .into()
    }

    /// The model as it is now, at one load: with its levels shifted.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.AdaptiveLoad(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))).model().range
    /// (0.0, 1.0)
    fn model(&self, py: Python<'_>) -> PyResult<Model> {
        let model = self.inner.with(py, |adaptive| adaptive.model());
        Ok(model.raise()?.into())
    }

    /// Every operator off, or on, also those of the inverse; the shift stays.
    ///
    /// Parameters
    /// ----------
    /// on : bool
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.AdaptiveLoad(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.reset(on=True)
    #[pyo3(signature = (*, on=false))]
    fn reset(&self, py: Python<'_>, on: bool) {
        self.inner.with(py, |adaptive| match on {
            true => adaptive.saturate(),
            false => adaptive.reset(),
        });
    }

    /// While frozen, `step` moves and nothing is learned.
    ///
    /// Parameters
    /// ----------
    /// frozen : bool
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.AdaptiveLoad(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.freeze()
    /// >>> adaptive.step(0.5, 3.5).outcome
    /// 'frozen'
    #[pyo3(signature = (frozen=true))]
    fn freeze(&self, py: Python<'_>, frozen: bool) {
        self.inner.with(py, |adaptive| adaptive.freeze(frozen));
    }

    /// An independent copy.
    ///
    /// Returns
    /// -------
    /// AdaptiveLoad
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.AdaptiveLoad(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.copy().shift
    /// 0.0
    fn copy(&self, py: Python<'_>) -> Self {
        self.inner.with(py, |adaptive| adaptive.clone()).into()
    }

    fn __copy__(&self, py: Python<'_>) -> Self {
        self.copy(py)
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Self {
        self.copy(py)
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let (levels, shift) = self.inner.with(py, |adaptive| {
            (adaptive.offline().plane().levels(), adaptive.shift())
        });
        format!("<AdaptiveLoad, {levels} levels, shifted by {shift}>")
    }
}

pub(crate) fn sample(input: f64, dt: Option<f64>) -> PyResult<Sample> {
    let (dt, load) = around::step(dt, None)?;
    let input = number("input", input)?;
    Ok(Sample { input, dt, load })
}
