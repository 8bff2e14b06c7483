//! `Model.simulate`, `band`, `evaluate`, `start` and `inverse`.

use crate::array::{like, optional, samples, times};
use crate::choices::none_left;
use crate::error::{Raise, number};
use crate::evaluate;
use crate::fit::start_of;
use crate::inputs::recording_of;
use crate::inverse::Inverse;
use crate::model::Model;
use crate::pool::detached;
use crate::state::State;
use hysteron::Surroundings;
use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl Model {
    /// The outputs for `input`, starting with every operator off.
    ///
    /// Parameters
    /// ----------
    /// input : array_like, shape (n,)
    ///     In the input's unit. Values beyond the plane act as its ends.
    /// time : array_like, shape (n,), optional
    ///     Needed for a model with a thermal body, ignored otherwise. As in `Recording`.
    /// load : array_like, shape (n,), optional
    ///     For a model that depends on a load. For a constant load see `at_load`.
    ///
    /// Returns
    /// -------
    /// ndarray or pandas.Series, shape (n,)
    ///     In the output's unit. A Series gives a Series with the same index.
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For a sample that is NaN or infinite.
    /// ThermalError
    ///     For a model with a thermal body without time, or time that goes back.
    /// FitError
    ///     For a model that depends on a load without it, and the other way round.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> model.simulate([0.5, 1.0, 0.5])
    /// array([4., 7., 5.])
    #[pyo3(signature = (input, *, time=None, load=None))]
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        input: &Bound<'py, PyAny>,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.inner;
        if model.thermal.is_none() && model.load.is_none() && load.is_none() {
            // Without a copy: straight into NumPy's array.
            return self.started(false).run(py, input);
        }
        let run = |input: &_, around: Surroundings<'_>| model.simulate_in(input, around);
        let output = surrounded(py, input, time, load, run)?;
        like(input, output.into_pyarray(py), &self.output())
    }

    /// The 95 % band around `simulate`: uncertainty of the weights and noise.
    ///
    /// Parameters
    /// ----------
    /// input, time, load
    ///     As for `simulate`.
    ///
    /// Returns
    /// -------
    /// lower, upper : ndarray or pandas.Series, shape (n,)
    ///     In the output's unit, as `simulate`.
    ///
    /// Raises
    /// ------
    /// FitError
    ///     For a model that was fitted without a bootstrap; otherwise as `simulate`.
    ///
    /// Examples
    /// --------
    /// >>> temperature = 50 - 30 * np.cos(np.linspace(0, 40, 800))
    /// >>> lift = 0.1 * temperature + 0.01 * np.sin(np.arange(800))
    /// >>> model = pyhysteron.fit(temperature, lift, levels=6)
    /// >>> lower, upper = model.band(temperature)
    /// >>> bool(np.mean((lower <= lift) & (lift <= upper)) > 0.9)
    /// True
    #[pyo3(signature = (input, *, time=None, load=None))]
    #[allow(clippy::type_complexity)]
    fn band<'py>(
        &self,
        py: Python<'py>,
        input: &Bound<'py, PyAny>,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let run = |input: &_, around: Surroundings<'_>| self.inner.band_in(input, around);
        let (low, high) = surrounded(py, input, time, load, run)?;
        Ok((
            like(input, low.into_pyarray(py), "lower")?,
            like(input, high.into_pyarray(py), "upper")?,
        ))
    }

    /// Forward and inverse tests on a recording.
    ///
    /// Parameters
    /// ----------
    /// recording : Recording, or array_like of shape (n,)
    ///     An array is the input, and `output` is needed.
    /// output : array_like, shape (n,), optional
    /// start : {'off', 'on', 'unknown'}
    ///     State of the operators before the first sample.
    /// time, load : array_like, shape (n,), optional
    ///     For an input and an output given as arrays.
    ///
    /// Returns
    /// -------
    /// results.Evaluation
    ///
    /// Raises
    /// ------
    /// RecordingError, ThermalError, FitError
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> found = model.evaluate([0.5, 1.0, 0.5], [4.0, 7.0, 5.5])
    /// >>> found.forward.max_abs
    /// 0.5
    #[pyo3(signature = (recording, output=None, *, start="off", time=None, load=None, **unknown),
        text_signature = "($self, recording, output=None, *, start='off', time=None, load=None)")]
    #[allow(clippy::too_many_arguments)]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        recording: &Bound<'py, PyAny>,
        output: Option<&Bound<'py, PyAny>>,
        start: &str,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
        unknown: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        none_left("Model.evaluate", unknown, &["start", "time", "load"])?;
        let recording = recording_of(recording, output, time, load)?;
        evaluate::evaluate(py, &self.inner, &recording, start_of(start)?)
    }

    /// How well inputs determine each operator of this model's plane.
    ///
    /// Parameters
    /// ----------
    /// input : array_like of shape (n,), Recording, or list of these
    ///
    /// Returns
    /// -------
    /// ndarray, shape (K, K)
    ///     As `pyhysteron.excitation`.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> model.excitation([0.0, 1.0, 0.0])
    /// array([[ 0.,  3.],
    ///        [nan,  3.]])
    fn excitation<'py>(
        &self,
        py: Python<'py>,
        input: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        evaluate::excited(py, input, *self.inner.plane(), self.inner.operator())
    }

    /// A state with every operator off, or on.
    ///
    /// Parameters
    /// ----------
    /// on : bool
    ///
    /// Returns
    /// -------
    /// State
    ///
    /// Raises
    /// ------
    /// ThermalError, FitError
    ///     For a model with a thermal body, and for a model that depends on a load: use `at_load`.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> model.start(on=True).step(0.5)
    /// 5.0
    #[pyo3(signature = (*, on=false))]
    fn start(&self, on: bool) -> PyResult<State> {
        self.inner.plain().raise()?;
        Ok(self.started(on))
    }

    /// The state that `State.save` returned.
    ///
    /// Parameters
    /// ----------
    /// saved : dict
    ///     With 'turning_points' and 'input'.
    ///
    /// Returns
    /// -------
    /// State
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For turning points that do not nest.
    /// ThermalError, FitError
    ///     As `start`.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> state = model.start()
    /// >>> _ = state.run([1.0, 0.2, 0.6])
    /// >>> again = model.restore(state.save())
    /// >>> again.step(0.4) == state.step(0.4)
    /// True
    fn restore(&self, saved: &Bound<'_, PyAny>) -> PyResult<State> {
        self.inner.plain().raise()?;
        let entry = |name| {
            saved.get_item(name).map_err(|_| {
                PyTypeError::new_err(
                    "`saved`: a dictionary with 'turning_points' and 'input' is needed",
                )
            })
        };
        let points = entry("turning_points")?;
        let points = samples(&points, "turning_points")?;
        let input = number("input", entry("input")?.extract()?)?;
        let state = self.inner.restore(points.as_slice()?, input).raise()?;
        Ok(State::new(self.clone(), state))
    }

    /// The exact inverse.
    ///
    /// Returns
    /// -------
    /// Inverse
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     Where a weight is below zero: the output is then not monotone.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> inputs, status = model.inverse().run([4.0, 7.0, 5.0])
    /// >>> inputs
    /// array([0.5, 1. , 0.5])
    fn inverse(&self) -> PyResult<Inverse> {
        Inverse::new(self.clone())
    }

    /// The model at one load, of a model that depends on a load.
    ///
    /// Parameters
    /// ----------
    /// load : float
    ///     Within the range that the model was fitted on.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FitError
    ///
    /// Examples
    /// --------
    /// >>> temperature = 50 - 30 * np.cos(np.linspace(0, 20, 400))
    /// >>> runs = [pyhysteron.Recording(temperature, (9 - load) * temperature, load=np.full(400, load)) for load in (3.0, 6.0)]
    /// >>> model = pyhysteron.fit(runs, levels=6, bootstrap=0)
    /// >>> model.load_range
    /// (3.0, 6.0)
    /// >>> low, high = model.at_load(4.5).output_range
    /// >>> round(high - low)
    /// 270
    fn at_load(&self, load: f64) -> PyResult<Self> {
        Ok(self.inner.at_load(load).raise()?.into())
    }
}

impl Model {
    fn started(&self, on: bool) -> State {
        let state = if on {
            self.inner.saturated()
        } else {
            self.inner.start()
        };
        State::new(self.clone(), state)
    }
}

/// Does `work` on an input and what goes with its samples, without the interpreter's lock.
fn surrounded<T: Send>(
    py: Python<'_>,
    input: &Bound<'_, PyAny>,
    time: Option<&Bound<'_, PyAny>>,
    load: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&[f64], Surroundings<'_>) -> hysteron::Result<T> + Send,
) -> PyResult<T> {
    let input = samples(input, "input")?;
    let input = input.as_slice()?;
    let (time, load) = (times(time)?, optional(load, "load")?);
    let around = Surroundings {
        time: time.as_deref(),
        load: load.as_deref(),
    };
    detached(py, || work(input, around)).raise_of("input", input)
}
