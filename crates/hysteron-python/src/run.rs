//! `Model.simulate`, `band`, `evaluate`, `start` and `inverse`.

use crate::around::{Around, loads};
use crate::array::{like, samples};
use crate::choices::{STARTS, choice, none_left};
use crate::error::{Raise, finite, number};
use crate::evaluate;
use crate::inputs::recordings_of;
use crate::inverse::Inverse;
use crate::model::Model;
use crate::pool::detached;
use crate::state::State;
use hysteron::Surroundings;
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Where a simulation begins, for [`Model::begin`].
const BEGINS: [(&str, Option<bool>); 3] =
    [("fitted", None), ("off", Some(false)), ("on", Some(true))];

#[pymethods]
impl Model {
    /// The outputs for `input`.
    ///
    /// Parameters
    /// ----------
    /// input : array_like, shape (n,)
    ///     In the input's unit. With a thermal body it is the drive, each sample held since the one
    ///     before. Values beyond the plane act as its ends. Each acts after the dead time of the
    ///     model (`delay_s`); a `State` takes the inputs as they act.
    /// time : array_like, shape (n,), optional
    ///     Needed for a model that depends on time (`is_timed`). With a dead time it says how many
    ///     samples that is; without it they are as many as in the recording. Ignored otherwise.
    ///     As in `Recording`.
    /// load : float, or array_like of shape (n,), optional
    ///     For a model that depends on a load. One number is the load of all samples.
    /// start : {'fitted', 'off', 'on'}
    ///     State of the operators before the first sample. 'fitted': where the model starts, which
    ///     is `fitted_start`, and every operator off where there is none. All stages are at rest
    ///     with the first sample, or with `rest`.
    /// rest : float, optional
    ///     Input long before the first sample, at which all was at rest: a wire that was warm, say.
    ///     By default that of the first sample. `evaluate` finds it (`rests`).
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
    ///     For a model that depends on time without it, or time that goes back.
    /// FitError
    ///     For a model that depends on a load without it, and the other way round; for a load
    ///     outside the range that was fitted, where the weights depend on it.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> model.simulate([0.5, 1.0, 0.5])
    /// array([4., 7., 5.])
    /// >>> model.simulate([0.5], start='on')
    /// array([5.])
    #[pyo3(signature = (input, *, time=None, load=None, start="fitted", rest=None))]
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        input: &Bound<'py, PyAny>,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
        start: &str,
        rest: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let state = self.start(choice("start", start, &BEGINS)?);
        if let Some(rest) = rest {
            let first = load.map(|load| loads(load, 1)).transpose()?;
            state.step(py, rest, None, first.and_then(|all| all.first().copied()))?;
        }
        if self.inner.delay().is_none() {
            return state.run(py, input, time, load);
        }
        let acting = {
            let array = samples(input, "input")?;
            let samples = array.as_slice()?;
            let around = Around::new(&self.inner, samples.len(), time, load)?;
            let lent = Surroundings {
                rest,
                ..around.lent()
            };
            let acting = self.inner.acting(samples, lent);
            acting
                .raise_of("input", samples)?
                .into_owned()
                .into_pyarray(py)
        };
        let output = state.run(py, acting.as_any(), time, load)?;
        like(input, output.cast_into::<PyArray1<f64>>()?, &self.output())
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
        let array = samples(input, "input")?;
        let samples = array.as_slice()?;
        let around = Around::new(&self.inner, samples.len(), time, load)?;
        let band = detached(py, || self.inner.band_in(samples, around.lent()));
        let (low, high) = band.raise_of("input", samples)?;
        Ok((
            like(input, low.into_pyarray(py), "lower")?,
            like(input, high.into_pyarray(py), "upper")?,
        ))
    }

    /// Where the output may really be around `simulate`, and where `Inverse.run` reports a target
    /// as reached: the wider of `band` and 1.96 times the error on what was held out.
    ///
    /// Parameters
    /// ----------
    /// input, time, load, start
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
    ///     For a model that was fitted without a bootstrap, with nothing held out and nothing left
    ///     to the data; otherwise as `simulate`.
    ///
    /// Examples
    /// --------
    /// >>> temperature = 50 - 30 * np.cos(np.linspace(0, 40, 800))
    /// >>> lift = 0.1 * temperature + 0.01 * np.sin(np.arange(800))
    /// >>> options = {'levels': 6, 'bootstrap': 0, 'hold_out': 'branches:20%'}
    /// >>> model = pyhysteron.fit(pyhysteron.Recording(temperature, lift), **options)
    /// >>> inputs, status = model.inverse().run(lift)
    /// >>> lower, upper = model.bounds(inputs)
    /// >>> half = (upper - lower) / 2
    /// >>> bool(np.all(half >= 1.95 * model.fit.hold_out.model.rmse))
    /// True
    #[pyo3(signature = (input, *, time=None, load=None, start="fitted"))]
    #[allow(clippy::type_complexity)]
    fn bounds<'py>(
        &self,
        py: Python<'py>,
        input: &Bound<'py, PyAny>,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
        start: &str,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let begin = self.begin(choice("start", start, &BEGINS)?);
        let array = samples(input, "input")?;
        let samples = array.as_slice()?;
        let around = Around::new(&self.inner, samples.len(), time, load)?;
        let bounds = detached(py, || {
            let acting = self.inner.acting(samples, around.lent())?;
            self.inner.bounds_in(&begin, &acting, around.lent())
        });
        let (low, high) = bounds.raise_of("input", samples)?;
        Ok((
            like(input, low.into_pyarray(py), "lower")?,
            like(input, high.into_pyarray(py), "upper")?,
        ))
    }

    /// Forward and inverse tests on a recording.
    ///
    /// Parameters
    /// ----------
    /// recording : Recording, list of Recording, or array_like of shape (n,)
    ///     A list is one experiment: the model starts anew in each recording, series follow each
    ///     other, and errors are over all. An array is the input, and `output` is needed.
    /// output : array_like, shape (n,), optional
    /// start : {'fitted', 'off', 'on', 'rest', 'unknown'}
    ///     State of the operators before the first sample. 'fitted': as for `simulate`. 'rest':
    ///     all off, then at the input that explains the beginning of the recording best. 'unknown':
    ///     the state that does.
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
    #[pyo3(signature = (recording, output=None, *, start="fitted", time=None, load=None, **unknown),
        text_signature = "($self, recording, output=None, *, start='fitted', time=None, load=None)")]
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
        let recordings = recordings_of(recording, output, time, load)?;
        evaluate::evaluate(
            py,
            &self.inner,
            &recordings,
            choice("start", start, &STARTS)?,
        )
    }

    /// How well inputs determine each operator of this model's plane.
    ///
    /// Parameters
    /// ----------
    /// input : array_like of shape (n,), Recording, or list of these
    ///     For a model that depends on time or on a load, recordings that have it.
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
        evaluate::excited_within(py, &self.inner, input)
    }

    /// A state to run from.
    ///
    /// Parameters
    /// ----------
    /// on : bool, optional
    ///     Every operator on, or off. By default where the model starts: `fitted_start`, and every
    ///     operator off where there is none.
    ///
    /// Returns
    /// -------
    /// State
    ///     All stages are at rest with its first sample.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> model.start().step(0.5), model.start(on=True).step(0.5)
    /// (4.0, 5.0)
    #[pyo3(signature = (*, on=None))]
    fn start(&self, on: Option<bool>) -> State {
        State::new(self.clone(), self.begin(on))
    }

    /// The state that `State.save` returned.
    ///
    /// Parameters
    /// ----------
    /// saved : dict
    ///     With 'turning_points' and 'input', and with 'stages' of a model that has stages. Without
    ///     'stages', all stages are at rest with the next sample.
    ///
    /// Returns
    /// -------
    /// State
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For turning points that do not nest, and numbers that are NaN or infinite.
    /// ValueError
    ///     For 'stages' of another length than 7.
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
        let mut state = self.inner.restore(points.as_slice()?, input).raise()?;
        if let Ok(stages) = saved.get_item("stages") {
            let stages = samples(&stages, "stages")?;
            let stages = stages.as_slice()?;
            let numbers = stages.try_into().map_err(|_| {
                let found = stages.len();
                let needed = state.stage_numbers().len();
                PyValueError::new_err(format!("`stages` has {found} numbers: {needed} are needed"))
            })?;
            finite("stages", stages)?;
            state = state.with_stage_numbers(numbers).raise()?;
        }
        Ok(State::new(self.clone(), state))
    }

    /// The exact inverse.
    ///
    /// Parameters
    /// ----------
    /// drive_range : tuple of float, optional
    ///     The lowest and the highest input that it may ask for. By default the drives fitted of a
    ///     model with a thermal body (`drive`), and no limits without one.
    /// horizon : float
    ///     With a thermal body: the seconds in which it reaches a temperature, from 0 on. 0: within
    ///     one sample. With more, noise of the target does not send the drive from one end to the
    ///     other, and the output follows late.
    ///
    /// Returns
    /// -------
    /// Inverse
    ///
    /// Raises
    /// ------
    /// CoreError, FitError
    ///     Where a weight is below zero: the output is then not monotone.
    /// FitError
    ///     For a range that is not in order, and a horizon below zero.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> inputs, status = model.inverse().run([4.0, 7.0, 5.0])
    /// >>> inputs
    /// array([0.5, 1. , 0.5])
    /// >>> model.inverse(drive_range=(0, 0.8)).run([4.0, 7.0])
    /// (array([0.5, 0.8]), array([0, 3], dtype=int8))
    #[pyo3(signature = (drive_range=None, horizon=0.0))]
    fn inverse(&self, drive_range: Option<(f64, f64)>, horizon: f64) -> PyResult<Inverse> {
        Inverse::new(self.clone(), drive_range, horizon)
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
    /// >>> model = pyhysteron.fit(runs, levels=6, load_law='weights', bootstrap=0)
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
    /// The state that a model starts from, or every operator off or on.
    pub(crate) fn begin(&self, on: Option<bool>) -> hysteron::State {
        match on {
            None => self.inner.start(),
            Some(false) => self.inner.off(),
            Some(true) => self.inner.saturated(),
        }
    }
}
