//! `BatchModel`.

use crate::around::{loads, rows_of_loads};
use crate::array::{filled, rows, samples, times};
use crate::error::{Raise, number};
use crate::integer::Integer;
use crate::model::Model;
use crate::shared::Shared;
use crate::state::State;
use hysteron::Surroundings;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::sync::Arc;

/// Many models with a state each, which move together: a fleet, an ensemble, or one model with many
/// inputs. A *lane* is one model with its state.
///
/// Each lane gives the same outputs as its model alone (`State.run`), bit for bit. So the inputs are
/// those that act: a dead time (`Model.delay_s`) is left to the caller. Many samples are divided
/// among all processors, without the interpreter's lock.
///
/// Threads may share a batch: each call ends before the next one begins.
///
/// Parameters
/// ----------
/// models : Model or list of Model
///     A model for each lane, or one model for all. Each lane begins where its model starts
///     (`Model.start`).
/// count : int, optional
///     The number of lanes of one model.
///
/// Raises
/// ------
/// FitError
///     For more than 2**24 lanes of one model.
///
/// Examples
/// --------
/// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
/// >>> batch = pyhysteron.BatchModel(model, 2)
/// >>> batch.run([[0.5, 1.0, 0.5], [1.0, 0.5, 1.0]])
/// array([[4., 7., 5.],
///        [7., 5., 7.]])
/// >>> batch.step([0.0, 0.5])
/// array([3., 5.])
#[pyclass(frozen, module = "pyhysteron")]
pub(crate) struct BatchModel {
    lanes: usize,
    inner: Shared<hysteron::BatchModel>,
}

#[pymethods]
impl BatchModel {
    #[new]
    #[pyo3(signature = (models, count=None))]
    fn new(models: &Bound<'_, PyAny>, count: Option<Integer>) -> PyResult<Self> {
        let batch = match (models.extract::<Model>(), count) {
            (Ok(model), Some(count)) => {
                hysteron::BatchModel::new(model.inner, count.convert("count")?).raise()?
            }
            (Ok(_), None) => {
                let text = "`count`: the number of lanes of one model is needed";
                return Err(PyTypeError::new_err(text));
            }
            (Err(_), Some(_)) => {
                let text = "`count` is for one model: a list has a model for each lane";
                return Err(PyTypeError::new_err(text));
            }
            (Err(_), None) => {
                let models: Vec<Model> = models.extract().map_err(|_| {
                    PyTypeError::new_err("`models`: a Model or a list of Model is needed")
                })?;
                models.into_iter().map(|model| model.inner).collect()
            }
        };
        let (lanes, inner) = (batch.lanes(), Shared::new(batch));
        Ok(Self { lanes, inner })
    }

    /// Move every lane through its row of `inputs` and return the outputs.
    ///
    /// Parameters
    /// ----------
    /// inputs : array_like, shape (lanes, n)
    ///     In the unit of each model's input. Values beyond a plane act as its ends.
    /// time : array_like, shape (n,) or (n + 1,), optional
    ///     The time of all lanes, s, as for `State.run`. Lanes that do not depend on time take no
    ///     notice of it.
    /// load : float, or array_like of shape (lanes, n), optional
    ///     For lanes that depend on a load.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (lanes, n)
    ///     In the unit of each model's output.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For another shape.
    /// CoreError, ThermalError, FitError
    ///     As `State.run`, with the number of the lane. All states are unchanged then.
    ///
    /// Examples
    /// --------
    /// >>> models = [pyhysteron.Model([1.0, 2.0, 4.0], (0, top)) for top in (1, 2)]
    /// >>> pyhysteron.BatchModel(models).run([[0.5, 1.0], [0.5, 1.0]])
    /// array([[4. , 7. ],
    ///        [2.5, 4. ]])
    #[pyo3(signature = (inputs, *, time=None, load=None))]
    fn run<'py>(
        &self,
        py: Python<'py>,
        inputs: &Bound<'py, PyAny>,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let array = rows(inputs, "inputs")?;
        let [lanes, samples] = [array.shape()[0], array.shape()[1]];
        if lanes != self.lanes {
            let shape = array.shape();
            let text = format!(
                "`inputs` has the shape {shape:?}: a row for each of the {} lanes is needed",
                self.lanes
            );
            return Err(PyValueError::new_err(text));
        }
        let time = times(time)?;
        let load = load.map(|load| rows_of_loads(load, lanes * samples));
        let load = load.transpose()?;
        let around = Surroundings {
            time: time.as_deref(),
            load: load.as_deref(),
            rest: None,
        };
        let inputs = array.as_slice()?;
        let outputs = filled(py, inputs.len(), |outputs| {
            let run = self
                .inner
                .with_detached(|batch| batch.run_in(inputs, around, outputs));
            run.raise().map(|_| ())
        })?;
        outputs.reshape([lanes, samples])
    }

    /// Move every lane by one sample and return the outputs.
    ///
    /// Parameters
    /// ----------
    /// inputs : array_like, shape (lanes,)
    /// dt : float, optional
    ///     Time since the sample before, s. Lanes that depend on time need it, 0 for the first
    ///     sample.
    /// load : float, or array_like of shape (lanes,), optional
    ///     For lanes that depend on a load.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (lanes,)
    ///
    /// Raises
    /// ------
    /// CoreError, ThermalError, FitError
    ///     As `run`; FitError for another number of inputs. All states are unchanged then.
    ///
    /// Examples
    /// --------
    /// >>> batch = pyhysteron.BatchModel(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)), 3)
    /// >>> batch.step([0.0, 0.5, 1.0])
    /// array([1., 4., 7.])
    #[pyo3(signature = (inputs, *, dt=None, load=None))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        inputs: &Bound<'py, PyAny>,
        dt: Option<f64>,
        load: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let array = samples(inputs, "inputs")?;
        let inputs = array.as_slice()?;
        let dt = dt.map(|dt| number("dt", dt)).transpose()?;
        let load = load.map(|load| loads(load, inputs.len()));
        let load = load.transpose()?;
        filled(py, inputs.len(), |outputs| {
            let step = self
                .inner
                .with_detached(|batch| batch.step_in(inputs, dt, load.as_deref(), outputs));
            step.raise().map(|_| ())
        })
    }

    /// Return all lanes to where their models start.
    ///
    /// Examples
    /// --------
    /// >>> batch = pyhysteron.BatchModel(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)), 1)
    /// >>> batch.step([1.0]), batch.step([0.5])
    /// (array([7.]), array([5.]))
    /// >>> batch.reset()
    /// >>> batch.step([0.5])
    /// array([4.])
    fn reset(&self, py: Python<'_>) {
        self.inner.with(py, hysteron::BatchModel::reset);
    }

    /// The models, one for each lane.
    #[getter]
    fn models(&self, py: Python<'_>) -> Vec<Model> {
        let models = |batch: &mut hysteron::BatchModel| batch.models().map(model).collect();
        self.inner.with(py, models)
    }

    /// Copies of the states, one for each lane.
    #[getter]
    fn states(&self, py: Python<'_>) -> Vec<State> {
        self.inner.with(py, |batch| {
            let lanes = batch.models().map(model).zip(batch.states().cloned());
            lanes
                .map(|(model, state)| State::new(model, state))
                .collect()
        })
    }

    fn __len__(&self) -> usize {
        self.lanes
    }

    fn __repr__(&self) -> String {
        format!("<BatchModel, {} lanes>", self.lanes)
    }
}

fn model(inner: &Arc<hysteron::Model>) -> Model {
    let inner = inner.clone();
    Model { inner }
}
