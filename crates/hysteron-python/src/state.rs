//! `State`.

use crate::around::{self, Around};
use crate::array::{filled, like, samples};
use crate::error::{Raise, number};
use crate::model::Model;
use crate::plane::on_plane;
use crate::shared::Shared;
use hysteron::Sample;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// The memory of a model, made by `Model.start`.
///
/// Threads may share a state: each call ends before the next one begins.
///
/// Examples
/// --------
/// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
/// >>> [state.step(x) for x in (0.5, 1.0, 0.5)]
/// [4.0, 7.0, 5.0]
/// >>> state.turning_points
/// array([2. , 1.5])
#[pyclass(frozen, module = "pyhysteron")]
pub(crate) struct State {
    model: Model,
    pub(crate) inner: Shared<hysteron::State>,
}

impl State {
    pub(crate) fn new(model: Model, state: hysteron::State) -> Self {
        let inner = Shared::new(state);
        Self { model, inner }
    }
}

/// A state as plain data.
pub(crate) fn saved<'py>(
    py: Python<'py>,
    model: &hysteron::Model,
    state: &hysteron::State,
) -> PyResult<Bound<'py, PyDict>> {
    let saved = PyDict::new(py);
    let points = PyArray1::from_vec(py, state.turning_points().collect());
    saved.set_item("turning_points", points)?;
    saved.set_item("input", state.input())?;
    if !model.is_plain() {
        let stages = PyArray1::from_slice(py, &state.stage_numbers());
        saved.set_item("stages", stages)?;
    }
    Ok(saved)
}

#[pymethods]
impl State {
    /// The model that this is a state of.
    #[getter]
    fn model(&self) -> Model {
        self.model.clone()
    }

    /// Move by one sample and return the output.
    ///
    /// Parameters
    /// ----------
    /// input : float
    ///     With a thermal body the drive, held since the sample before.
    /// dt : float, optional
    ///     Time since the sample before, s. Needed for a model that depends on time from the
    ///     second sample on.
    /// load : float, optional
    ///     For a model that depends on a load.
    ///
    /// Returns
    /// -------
    /// float
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For numbers that are NaN or infinite.
    /// ThermalError
    ///     For a `dt` that is needed and missing, or below zero.
    /// FitError
    ///     For a load that is missing, outside its range, or given to a model that has none. The
    ///     state is unchanged after any error.
    ///
    /// Examples
    /// --------
    /// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
    /// >>> state.step(0.5)
    /// 4.0
    #[pyo3(signature = (input, *, dt=None, load=None))]
    pub(crate) fn step(
        &self,
        py: Python<'_>,
        input: f64,
        dt: Option<f64>,
        load: Option<f64>,
    ) -> PyResult<f64> {
        let input = number("input", input)?;
        let (dt, load) = around::step(dt, load)?;
        let step = |state: &mut _| self.model.inner.step(state, Sample { input, dt, load });
        Ok(self.inner.with(py, step).raise()?.output)
    }

    /// Move through `input` and return the outputs.
    ///
    /// Parameters
    /// ----------
    /// input : array_like, shape (n,)
    ///     As it acts: a state knows no dead time (`Model.delay_s`).
    /// time : array_like, shape (n,) or (n + 1,), optional
    ///     As for `Model.simulate`. The time step of the first sample is 0. To go on from earlier
    ///     samples, give one more time: that of the last of them, before the others.
    /// load : float, or array_like of shape (n,), optional
    ///     As for `Model.simulate`.
    ///
    /// Returns
    /// -------
    /// ndarray or pandas.Series, shape (n,)
    ///     In the output's unit. A Series gives a Series with the same index.
    ///
    /// Raises
    /// ------
    /// CoreError, ThermalError, FitError
    ///     As `Model.simulate`. The state is unchanged then.
    ///
    /// Examples
    /// --------
    /// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
    /// >>> state.run([0.5, 1.0]), state.run([0.5])
    /// (array([4., 7.]), array([5.]))
    #[pyo3(signature = (input, *, time=None, load=None))]
    pub(crate) fn run<'py>(
        &self,
        py: Python<'py>,
        input: &Bound<'py, PyAny>,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let array = samples(input, "input")?;
        let samples = array.as_slice()?;
        let model = &self.model.inner;
        let around = Around::new(model, samples.len(), time, load)?;
        let output = filled(py, samples.len(), |output| {
            let run = |state: &mut hysteron::State| {
                if model.is_plain() {
                    return model.run_in(state, samples, around.lent(), output);
                }
                // An error in the middle leaves the state where it was.
                let mut moved = state.clone();
                let clipped = model.run_in(&mut moved, samples, around.lent(), output)?;
                *state = moved;
                Ok(clipped)
            };
            let run = self.inner.with_detached(run);
            run.raise_of("input", samples).map(|_| ())
        })?;
        like(input, output, &self.model.output())
    }

    /// Return to where the model starts, or every operator off or on.
    ///
    /// Parameters
    /// ----------
    /// on : bool, optional
    ///     As for `Model.start`.
    ///
    /// Examples
    /// --------
    /// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
    /// >>> state.reset(on=True)
    /// >>> state.operators
    /// array([[ 1.,  1.],
    ///        [nan,  1.]])
    #[pyo3(signature = (*, on=None))]
    fn reset(&self, py: Python<'_>, on: Option<bool>) {
        let begin = self.model.begin(on);
        self.inner.with(py, |state| *state = begin);
    }

    /// The state as plain data. `Model.restore` makes the same state of it, bit for bit.
    ///
    /// Returns
    /// -------
    /// dict
    ///     With 'turning_points' (ndarray) and 'input' (float). For a model with stages also with
    ///     'stages' (ndarray): 0 or 1 for whether there was a sample, the temperature, and what each
    ///     stage behind the operators remembers.
    ///
    /// Examples
    /// --------
    /// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
    /// >>> _ = state.run([1.0, 0.5])
    /// >>> state.save()
    /// {'turning_points': array([2. , 1.5]), 'input': 0.5}
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        // One look at it: another thread may move it in between.
        let state = self.inner.with(py, |state| state.clone());
        saved(py, &self.model.inner, &state)
    }

    /// The turning points ``M_1, m_1, M_2, …`` as positions in ``[0, K]``, the present position
    /// last.
    #[getter]
    fn turning_points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let points = |state: &mut hysteron::State| state.turning_points().collect();
        PyArray1::from_vec(py, self.inner.with(py, points))
    }

    /// The operators' states ``γ_ij`` from 0 to 1, shape (K, K): ``[i-1, j-1]``, NaN below the
    /// diagonal.
    #[getter]
    fn operators<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let model = &self.model.inner;
        let gamma = self.inner.with(py, |state| model.operator_states(state));
        on_plane(py, &gamma.raise()?)
    }

    /// The last input of the operators.
    ///
    /// With a thermal body it is made from the temperature; a load shifts and stretches it, and with
    /// unequal levels it is on the grid of the plane.
    #[getter]
    fn input(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |state| state.input())
    }

    /// The temperature of the thermal body after the last sample; without a body the last input.
    #[getter]
    fn temperature(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |state| state.temperature())
    }

    /// An independent copy.
    ///
    /// Returns
    /// -------
    /// State
    ///
    /// Examples
    /// --------
    /// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
    /// >>> other = state.copy()
    /// >>> state.step(1.0), other.step(0.5)
    /// (7.0, 4.0)
    fn copy(&self, py: Python<'_>) -> Self {
        Self::new(
            self.model.clone(),
            self.inner.with(py, |state| state.clone()),
        )
    }

    fn __copy__(&self, py: Python<'_>) -> Self {
        self.copy(py)
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Self {
        self.copy(py)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, state) = (slf.py(), slf.get());
        let restore = state.model().into_pyobject(py)?.getattr("restore")?;
        (restore, (state.save(py)?,)).into_pyobject(py)
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let (input, points) = self
            .inner
            .with(py, |state| (state.input(), state.turning_points().count()));
        format!("<State at {input}, {points} turning points>")
    }
}
