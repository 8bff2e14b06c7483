//! A model that runs: `Model.simulate` and what it is judged, stepped and inverted by.

use crate::array::samples;
use crate::error::{Raise, number};
use crate::fit::start_of;
use crate::given::{optional, recording_of};
use crate::inverse::Inverse;
use crate::judge;
use crate::model::Model;
use crate::pool::detached;
use crate::state::State;
use hysteron::Surroundings;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl Model {
    /// The outputs for `input`, from every operator off.
    ///
    /// Parameters
    /// ----------
    /// input : array_like, shape (n,)
    ///     In the input's unit. What lies beyond the plane acts as its ends.
    /// time : array_like, shape (n,), optional
    ///     Seconds, for a model with a thermal body; without one they are not looked at.
    /// load : array_like, shape (n,), optional
    ///     For a model that depends on a load; for one load throughout see `at_load`.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n,)
    ///     In the output's unit.
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
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let model = &self.inner;
        if model.thermal.is_none() && model.load.is_none() && load.is_none() {
            // Without a copy: straight into NumPy's array.
            return self.started(false).run(py, input);
        }
        let predict = |input: &_, around: Surroundings<'_>| model.predict(input, around);
        let output = surrounded(py, input, time, load, predict)?;
        Ok(PyArray1::from_vec(py, output))
    }

    /// The 95 % prediction band around `simulate`: how far off the weights may put the output, and the noise.
    ///
    /// Parameters
    /// ----------
    /// input, time, load
    ///     As for `simulate`.
    ///
    /// Returns
    /// -------
    /// lower, upper : ndarray, shape (n,)
    ///     In the output's unit.
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
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
        let predict = |input: &_, around: Surroundings<'_>| self.inner.predict_band(input, around);
        let (low, high) = surrounded(py, input, time, load, predict)?;
        Ok((PyArray1::from_vec(py, low), PyArray1::from_vec(py, high)))
    }

    /// Forward and inverse tests on a recording.
    ///
    /// Parameters
    /// ----------
    /// recording : Recording, or array_like of shape (n,)
    ///     Or the input, with the output beside it.
    /// output : array_like, shape (n,), optional
    /// start : {'off', 'on', 'unknown'}
    ///     Where the operators stand before the first sample.
    /// time, load : array_like, shape (n,), optional
    ///     With an input and an output.
    ///
    /// Returns
    /// -------
    /// dict
    ///     'output_model' (ndarray, shape (n,)) and 'forward', its errors: 'rmse' and 'max_abs' in the output's unit, 'nrmse_percent' of the
    ///     measured range, 'samples'; 'clipped', inputs outside the plane; 'band', None without confidence, with 'lower', 'upper' (ndarray,
    ///     shape (n,)) and 'coverage_percent'; 'inverse' with 'moving' (ndarray of bool, shape (n,)), False in the dead band, and for each
    ///     policy, 'hold' and 'anticipate', the 'input_model' (ndarray, shape (n,)), its errors over 'all' samples, over those
    ///     'moving' and in the 'dead_band', and the targets 'out_of_reach'; or None, and 'inverse_refused' says why.
    ///
    /// Raises
    /// ------
    /// RecordingError, ThermalError, FitError
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> found = model.evaluate([0.5, 1.0, 0.5], [4.0, 7.0, 5.5])
    /// >>> found['forward']['max_abs']
    /// 0.5
    #[pyo3(signature = (recording, output=None, *, start="off", time=None, load=None))]
    #[allow(clippy::too_many_arguments)]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        recording: &Bound<'py, PyAny>,
        output: Option<&Bound<'py, PyAny>>,
        start: &str,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let recording = recording_of(recording, output, time, load)?;
        judge::evaluate(py, &self.inner, &recording, start_of(start)?)
    }

    /// What an input, or several, say about each operator of this model's plane: `pyhysteron.excitation`.
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
        judge::excited(py, input, *self.inner.plane(), self.inner.operator())
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
    ///     For a model with a thermal body, and for one that depends on a load: take that at one, `at_load`.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> model.start(on=True).step(0.5)
    /// 5.0
    #[pyo3(signature = (*, on=false))]
    fn start(&self, on: bool) -> PyResult<State> {
        self.inner.runs_by_itself().raise()?;
        Ok(self.started(on))
    }

    /// The state that `State.save` told of.
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
        self.inner.runs_by_itself().raise()?;
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
    let (time, load) = (optional(time, "time")?, optional(load, "load")?);
    let around = Surroundings {
        time: time.as_deref(),
        load: load.as_deref(),
    };
    detached(py, || work(input, around)).raise_of("input", input)
}
