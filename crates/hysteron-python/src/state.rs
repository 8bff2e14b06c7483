//! `State`.

use crate::array::{filled, like, samples};
use crate::error::{Raise, number};
use crate::model::Model;
use crate::plane::on_plane;
use crate::shared::Shared;
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

#[pymethods]
impl State {
    /// The model that this is a state of.
    #[getter]
    fn model(&self) -> Model {
        self.model.clone()
    }

    /// Move to `input` and return the output.
    ///
    /// Parameters
    /// ----------
    /// input : float
    ///
    /// Returns
    /// -------
    /// float
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For an input that is NaN or infinite. The state is unchanged then.
    ///
    /// Examples
    /// --------
    /// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
    /// >>> state.step(0.5)
    /// 4.0
    fn step(&self, py: Python<'_>, input: f64) -> PyResult<f64> {
        let (model, input) = (&self.model.inner, number("input", input)?);
        let step = self.inner.with(py, |state| model.step(state, input));
        Ok(step.raise()?.output)
    }

    /// Move through `input` and return the outputs.
    ///
    /// Parameters
    /// ----------
    /// input : array_like, shape (n,)
    ///
    /// Returns
    /// -------
    /// ndarray or pandas.Series, shape (n,)
    ///     In the output's unit. A Series gives a Series with the same index.
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For a sample that is NaN or infinite. The state is unchanged then.
    ///
    /// Examples
    /// --------
    /// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
    /// >>> state.run([0.5, 1.0]), state.run([0.5])
    /// (array([4., 7.]), array([5.]))
    pub(crate) fn run<'py>(
        &self,
        py: Python<'py>,
        input: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let array = samples(input, "input")?;
        let samples = array.as_slice()?;
        let output = filled(py, samples.len(), |output| {
            let run = |state: &mut _| self.model.inner.run(state, samples, output);
            self.inner
                .with_detached(run)
                .raise_of("input", samples)
                .map(|_| ())
        })?;
        like(input, output, &self.model.output())
    }

    /// Every operator off, or on.
    ///
    /// Parameters
    /// ----------
    /// on : bool
    ///
    /// Examples
    /// --------
    /// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
    /// >>> state.reset(on=True)
    /// >>> state.operators
    /// array([[ 1.,  1.],
    ///        [nan,  1.]])
    #[pyo3(signature = (*, on=false))]
    fn reset(&self, py: Python<'_>, on: bool) {
        let model = &self.model.inner;
        let begin = if on { model.saturated() } else { model.start() };
        self.inner.with(py, |state| *state = begin);
    }

    /// The state as plain data. `Model.restore` makes the same state of it, bit for bit.
    ///
    /// Returns
    /// -------
    /// dict
    ///     With 'turning_points' (ndarray) and 'input' (float).
    ///
    /// Examples
    /// --------
    /// >>> state = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).start()
    /// >>> _ = state.run([1.0, 0.5])
    /// >>> state.save()
    /// {'turning_points': array([2. , 1.5]), 'input': 0.5}
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let saved = PyDict::new(py);
        saved.set_item("turning_points", self.turning_points(py))?;
        saved.set_item("input", self.input(py))?;
        Ok(saved)
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

    /// The last input.
    #[getter]
    fn input(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |state| state.input())
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
