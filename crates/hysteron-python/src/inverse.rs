//! `Inverse`.

use crate::around::{self, Around};
use crate::array::{like, samples};
use crate::choices::{self, POLICIES, choice, direction, none_left, size};
use crate::error::Raise;
use crate::model::Model;
use crate::pool::detached;
use crate::state::State;
use hysteron::{Policy, Wanted};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// The exact inverse of a model: the input that gives a wanted output. Made by `Model.inverse`.
///
/// Examples
/// --------
/// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
/// >>> inputs, status = model.inverse().run([4.0, 6.0, 5.0, 9.0])
/// >>> model.simulate(inputs)
/// array([4., 6., 5., 7.])
/// >>> status
/// array([0, 0, 0, 1], dtype=int8)
#[pyclass(frozen, module = "pyhysteron")]
pub(crate) struct Inverse {
    model: Model,
    drive_range: Option<(f64, f64)>,
    horizon: f64,
}

impl Inverse {
    pub(crate) fn new(
        model: Model,
        drive_range: Option<(f64, f64)>,
        horizon: f64,
    ) -> PyResult<Self> {
        let inverse = Self {
            model,
            drive_range,
            horizon,
        };
        inverse.inner().raise()?;
        Ok(inverse)
    }

    fn inner(&self) -> hysteron::Result<hysteron::Inverse<'_>> {
        let inverse = self.model.inner.inverse()?.horizon(self.horizon)?;
        match self.drive_range {
            None => Ok(inverse),
            Some((low, high)) => inverse.drive_range(low, high),
        }
    }
}

#[pymethods]
impl Inverse {
    /// The model that this is the inverse of.
    #[getter]
    fn model(&self) -> Model {
        self.model.clone()
    }

    /// The lowest and the highest input that it may ask for, in the input's unit.
    #[getter]
    fn drive_range(&self) -> (f64, f64) {
        self.drive_range
            .unwrap_or_else(|| self.model.inner.drive_range())
    }

    /// The seconds in which it reaches a temperature; 0 for one sample.
    #[getter]
    fn horizon(&self) -> f64 {
        self.horizon
    }

    fn __repr__(&self) -> String {
        format!("<Inverse of {}>", self.model.__repr__())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, of) = (slf.py(), slf.get());
        let inverse = of.model().into_pyobject(py)?.getattr("inverse")?;
        (inverse, (of.drive_range, of.horizon)).into_pyobject(py)
    }

    /// The inputs for a series of targets.
    ///
    /// Parameters
    /// ----------
    /// target : array_like, shape (n,)
    ///     In the output's unit.
    /// time : array_like, shape (n,) or (n + 1,), optional
    ///     As for `State.run`: needed for a model that depends on time.
    /// load : float, or array_like of shape (n,), optional
    ///     As for `State.run`: needed for a model that depends on a load.
    /// policy : {'hold', 'anticipate'}
    ///     What the input does while the target rests. 'hold': it rests too. 'anticipate': it
    ///     crosses the dead band, to where the output starts to move with the target.
    /// tolerance : float, optional
    ///     Reversals of the target up to this size are noise and not followed, in the output's
    ///     unit. A noisy target may be missed by up to twice as much. By default 0 with 'hold', and
    ///     1 % of the model's range with 'anticipate'.
    /// state : State, optional
    ///     The state to start from; it is moved. By default where the model starts.
    /// heading : sequence of {None, 'rising', 'falling'}, shape (n,), optional
    ///     Where the target goes next at each sample, known beforehand. Replaces `policy`.
    ///
    /// Returns
    /// -------
    /// input : ndarray or pandas.Series, shape (n,)
    ///     In the input's unit. With a thermal body it is the drive to hold since the sample before.
    ///     A Series gives a Series with the same index.
    /// status : ndarray of int8 or pandas.Series, shape (n,)
    ///     0 where the input gives the target, up to the tolerance, -1 and 1 where it lies below or
    ///     above every output, 2 where a relay model jumps past it, 3 where the range of the drive
    ///     does not reach it in this sample. It speaks of the model; `Model.bounds` of these inputs
    ///     says where the output may really be.
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For a target that is NaN or infinite, or a state of another model.
    /// ThermalError, FitError
    ///     For time and load as `State.run`. `state` is unchanged after any error.
    /// ValueError
    ///     For a `heading` of another length, unknown names and a `tolerance` below zero.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> inverse, wanted = model.inverse(), [0.0, 6.0, 6.0, 3.0]
    /// >>> inverse.run(wanted)[0]
    /// array([-1.        ,  0.83333333,  0.83333333,  0.08333333])
    /// >>> inverse.run(wanted, policy='anticipate')[0]  # over the dead band at the turn
    /// array([-0.93      ,  0.83333333,  0.81583333,  0.08333333])
    #[pyo3(signature = (target, *, time=None, load=None, policy="hold", tolerance=None, state=None, heading=None, **unknown),
        text_signature = "($self, target, *, time=None, load=None, policy='hold', tolerance=None, state=None, heading=None)")]
    #[allow(clippy::too_many_arguments)]
    fn run<'py>(
        &self,
        py: Python<'py>,
        target: &Bound<'py, PyAny>,
        time: Option<&Bound<'py, PyAny>>,
        load: Option<&Bound<'py, PyAny>>,
        policy: &str,
        tolerance: Option<f64>,
        state: Option<&State>,
        heading: Option<Vec<Option<String>>>,
        unknown: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        none_left(
            "Inverse.run",
            unknown,
            &["time", "load", "policy", "tolerance", "state", "heading"],
        )?;
        let argument = target;
        let target = samples(target, "target")?;
        let target = target.as_slice()?;
        let model = &self.model.inner;
        let around = Around::new(model, target.len(), time, load)?;
        let policy = choice("policy", policy, &POLICIES)?;
        let tolerance = match tolerance {
            None if policy == Policy::Anticipate => model.usual_tolerance(),
            None => 0.0,
            Some(tolerance) => size("tolerance", tolerance)?,
        };
        let known = |name: &Option<String>| name.as_deref().map(direction).transpose();
        let headings = heading.map(|names| names.iter().map(known).collect::<PyResult<Vec<_>>>());
        let headings = headings.transpose()?;
        if let Some(headings) = headings.as_ref().filter(|h| h.len() != target.len()) {
            let (n, m) = (target.len(), headings.len());
            let text = format!("`heading` has {m} entries, `target` {n}");
            return Err(PyValueError::new_err(text));
        }
        let solutions: hysteron::Result<Vec<_>> = detached(py, || {
            let (inverse, around) = (self.inner()?, around.lent());
            let through = |state: &mut hysteron::State| match &headings {
                Some(headings) => inverse.headed_in(state, target, headings, tolerance, around),
                None => inverse.series_in(state, target, policy, tolerance, around),
            };
            let Some(state) = state else {
                let solutions = through(&mut model.start())?;
                return Ok(model.delay().giving(solutions, around.time));
            };
            state.inner.with_detached(|state| {
                // An error in the middle leaves the state where it was.
                let mut moved = state.clone();
                let solutions = through(&mut moved)?;
                *state = moved;
                Ok(solutions)
            })
        });
        let solutions = solutions.raise_of("target", target)?;
        let input = PyArray1::from_iter(py, solutions.iter().map(|solution| solution.input));
        let status = PyArray1::from_iter(py, solutions.iter().map(|s| s.status.number()));
        Ok((
            like(argument, input, &self.model.input())?,
            like(argument, status, "status")?,
        ))
    }

    /// The input for one target; moves `state` there.
    ///
    /// Parameters
    /// ----------
    /// state : State
    /// target : float
    /// dt : float, optional
    ///     Time since the sample before, s, as for `State.step`.
    /// load : float, optional
    ///     As for `State.step`.
    /// heading : {None, 'rising', 'falling'}
    ///     Where the target goes next: the dead band is crossed at once. With None the input rests
    ///     while the target rests.
    /// tolerance : float
    ///     Reversals of the target up to this size are noise, in the output's unit.
    ///
    /// Returns
    /// -------
    /// input : float
    ///     With a thermal body the drive to hold since the sample before. The state goes where it
    ///     leads, also where that is not the target.
    /// status : int
    ///     0 where the input gives the target, -1 and 1 where it lies below or above every
    ///     output, 2 where a relay model jumps past it, 3 where the range of the drive does not
    ///     reach it in this sample.
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For a target that is NaN or infinite, or a state of another model.
    /// ThermalError, FitError
    ///     For `dt` and `load` as `State.step`. The state is unchanged after any error.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> state = model.start()
    /// >>> model.inverse().step(state, 6.0)
    /// (0.8333333333333335, 0)
    /// >>> model.inverse().step(state, 10.0)  # out of reach: the top of the plane
    /// (1.0, 1)
    #[pyo3(signature = (state, target, *, dt=None, load=None, heading=None, tolerance=0.0))]
    #[allow(clippy::too_many_arguments)]
    fn step(
        &self,
        py: Python<'_>,
        state: &State,
        target: f64,
        dt: Option<f64>,
        load: Option<f64>,
        heading: Option<&str>,
        tolerance: f64,
    ) -> PyResult<(f64, i8)> {
        let (dt, load) = around::step(dt, load)?;
        let target = choices::target(target, heading, tolerance)?;
        let wanted = Wanted {
            dt,
            load,
            ..target.into()
        };
        let inverse = self.inner().raise()?;
        let step = |state: &mut _| inverse.step(state, wanted);
        let solution = state.inner.with(py, step).raise()?;
        Ok((solution.input, solution.status.number()))
    }
}
