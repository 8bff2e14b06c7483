//! `control.Controller`.

use crate::action::Action;
use crate::adaptive::Adaptive;
use crate::adaptive_load::AdaptiveLoad;
use crate::array::samples;
use crate::choices::POLICIES;
use crate::choices::{choice, direction, none_left};
use crate::device::{events_of, follow};
use crate::error::{Raise, finite, number};
use crate::integer::Integer;
use crate::model::Model;
use crate::pid::Pid;
use crate::plant::SimulatedPlant;
use crate::progress::with_progress;
use crate::shared::Shared;
use crate::trace::Trace;
use hysteron::control::{self, Compensator, Course, Gains, InnerLoop, Reading, Reference, Scheme};
use hysteron_sim::track::course as events_in_order;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// One controller for all schemes: feedforward by the inverse of a model, a PID, or both, and an
/// optional inner loop around the input.
///
/// Without readings of the output nothing is learned, and the feedback holds; beside an inverse,
/// which goes on, only its integral stays (`Pid.relax`). Without readings of the input, the inner
/// loop holds the drive for `stuck_s` and then goes to the lowest drive. A controller cannot be
/// pickled.
///
/// Parameters
/// ----------
/// interval_s : float
///     Time between samples, s.
/// commands : tuple of float
///     Lowest and highest input that may be commanded.
/// model : Model, Adaptive or AdaptiveLoad, optional
///     Feedforward by its inverse. One that learns is copied, and the copy learns here.
/// pid : Pid, optional
///     Feedback of the output, added to the feedforward: a PID with these gains, at rest.
/// policy : {'hold', 'anticipate'}
///     What the inverse does while the target rests; see `pyhysteron.Inverse.run`.
/// tolerance : float
///     Reversals of the target up to this size are noise, and the inverse does not follow them. In
///     the output's unit, from 0 on.
/// bias : float
///     The command at rest, without a model.
/// drives : tuple of float, optional
///     Lowest and highest drive. By default those of the commands.
/// inner : Pid, optional
///     Gains of the inner loop, which brings the input (a temperature) to the command. Without an
///     inner loop, the command is the drive.
/// square_root : bool
///     The drive is the square root of the inner loop's output: a current, which heats with its
///     square.
/// filter_s : float
///     Time constant of the filter on both readings, s, from 0 on.
/// stuck_s : float, optional
///     A sensor whose readings do not change for this time is taken as broken, s, above 0. None
///     for sensors without noise.
/// delay : int, optional
///     Samples until a drive moves the output that is read, up to 1001. The inverse solves for the
///     target of so many samples later, as far as it is told (`step`, `run`). By default one, and
///     the dead time of the model (`Model.delay_s`).
///
/// Raises
/// ------
/// ControlError
///     For an invalid argument, by name.
/// CoreError
///     For a model that has no inverse.
///
/// Examples
/// --------
/// Inverse and PID on a simulated actuator, from a model identified on it:
///
/// >>> model = pyhysteron.Model(np.full(15, 5.0), (10, 150), offset=0)
/// >>> plant = pyhysteron.PreisachPlant()
/// >>> pid = pyhysteron.control.Pid(0.2, integral_s=0.05)
/// >>> controller = pyhysteron.control.Controller(0.01, plant.drives, model=model, pid=pid, filter_s=0.01)
/// >>> for target in np.linspace(10, 40, 400):
/// ...     action = controller.step(target, *plant.read())
/// ...     plant.write(action.drive)
/// ...     plant.advance(0.01)
/// >>> abs(plant.truth()[0] - 40) < 2
/// True
#[pyclass(frozen, module = "pyhysteron.control")]
pub(crate) struct Controller {
    inner: Shared<control::Controller>,
    tolerance: f64,
}

#[pymethods]
impl Controller {
    #[new]
    #[pyo3(signature = (
        interval_s, commands, *, model=None, pid=None, policy="hold", tolerance=0.0, bias=0.0, drives=None, inner=None, square_root=false,
        filter_s=0.0, stuck_s=None, delay=None, **unknown
    ), text_signature = "(interval_s, commands, *, model=None, pid=None, policy='hold', tolerance=0.0, bias=0.0, drives=None, inner=None, square_root=False, filter_s=0.0, stuck_s=None, delay=None)")]
    #[allow(clippy::too_many_arguments)]
    fn new(
        interval_s: f64,
        commands: (f64, f64),
        model: Option<&Bound<'_, PyAny>>,
        pid: Option<&Pid>,
        policy: &str,
        tolerance: f64,
        bias: f64,
        drives: Option<(f64, f64)>,
        inner: Option<&Pid>,
        square_root: bool,
        filter_s: f64,
        stuck_s: Option<f64>,
        delay: Option<Integer>,
        unknown: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        none_left("Controller", unknown, &NAMES)?;
        let gains = |pid: &Pid| -> Gains { pid.gains };
        let scheme = Scheme {
            interval_s,
            compensator: model.map(compensator).transpose()?,
            policy: choice("policy", policy, &POLICIES)?,
            tolerance,
            pid: pid.map(gains),
            bias,
            commands,
            drives: drives.unwrap_or(commands),
            inner: inner.map(|pid| InnerLoop {
                gains: gains(pid),
                square_root,
            }),
            filter_s,
            stuck_s,
            delay: delay.map(|delay| delay.convert("delay")).transpose()?,
            ..Scheme::new(interval_s, commands)
        };
        let inner = Shared::new(control::Controller::new(scheme).raise()?);
        Ok(Self { inner, tolerance })
    }

    /// One sample: from target and readings to the drive.
    ///
    /// Parameters
    /// ----------
    /// target : float
    ///     The output wanted now.
    /// output : float
    ///     The output as measured; NaN where the sensor gave nothing.
    /// input : float, optional
    ///     The input of the hysteresis as measured; NaN where the sensor gave nothing, None where
    ///     the drive itself is the input.
    /// heading : {None, 'rising', 'falling'}
    ///     Where the target goes next, for 'anticipate'; see `headings`.
    /// ahead : array_like, shape (m,), optional
    ///     The targets at the samples after this one, as far as they are known. The inverse solves
    ///     for the one that is `delay` samples later. With a model that has a thermal body, the
    ///     drive starts before they are due. Earlier targets are missed by up to a tenth of the
    ///     range for that.
    ///
    /// Returns
    /// -------
    /// Action
    ///     Its drive is finite and within its limits whatever the readings are.
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For a target that is NaN or infinite; nothing is changed then.
    ///
    /// Examples
    /// --------
    /// >>> pid = pyhysteron.control.Pid(2.0)
    /// >>> controller = pyhysteron.control.Controller(0.01, (0, 10), pid=pid)
    /// >>> controller.step(3.0, 1.0)  # 3 wanted, 1 measured
    /// <Action: command 4, drive 4, prediction NaN>
    #[pyo3(signature = (target, output, input=None, *, heading=None, ahead=None))]
    fn step(
        &self,
        py: Python<'_>,
        target: f64,
        output: f64,
        input: Option<f64>,
        heading: Option<&str>,
        ahead: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Action> {
        let heading = heading.map(direction).transpose()?;
        let target = Reference {
            output: number("target", target)?,
            heading,
        };
        let reading = Reading { output, input };
        let ahead = ahead.map(|ahead| samples(ahead, "ahead")).transpose()?;
        let next = match &ahead {
            Some(ahead) => ahead.as_slice()?,
            None => &[],
        };
        finite("ahead", next)?;
        let step =
            |controller: &mut control::Controller| controller.step_ahead(target, next, reading);
        let action = self.inner.with(py, step);
        Ok(action.raise()?.into())
    }

    /// One sample that brings the input to `command`, whatever the output is: for recordings, relay
    /// and step tests.
    ///
    /// Parameters
    /// ----------
    /// command : float
    /// output, input
    ///     As for `step`.
    ///
    /// Returns
    /// -------
    /// Action
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For a command that is NaN or infinite; nothing is changed then.
    ///
    /// Examples
    /// --------
    /// >>> controller = pyhysteron.control.Controller(0.01, (0, 10), pid=pyhysteron.control.Pid(2.0))
    /// >>> controller.step_command(12.0, 1.0).drive  # within the limits
    /// 10.0
    #[pyo3(signature = (command, output, input=None))]
    fn step_command(
        &self,
        py: Python<'_>,
        command: f64,
        output: f64,
        input: Option<f64>,
    ) -> PyResult<Action> {
        let command = number("command", command)?;
        let reading = Reading { output, input };
        let step = |controller: &mut control::Controller| controller.step_command(command, reading);
        let action = self.inner.with(py, step);
        Ok(action.raise()?.into())
    }

    /// Time between samples, s.
    #[getter]
    fn interval_s(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |controller| controller.interval_s())
    }

    /// What the model in the loop has learned: a copy as it is now; None where none learns.
    #[getter]
    fn adaptive<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let compensator = |controller: &mut control::Controller| controller.compensator().cloned();
        let compensator = self.inner.with(py, compensator);
        let learning = compensator.as_ref().and_then(Compensator::adapting);
        if let Some(adaptive) = learning {
            return Ok(Some(
                Adaptive::from(adaptive.clone()).into_bound_py_any(py)?,
            ));
        }
        let following = compensator.as_ref().and_then(Compensator::following);
        let following = following.map(|found| AdaptiveLoad::from(found.clone()));
        following
            .map(|found| found.into_bound_py_any(py))
            .transpose()
    }

    /// Follow a reference on a device, one sample for each of its values.
    ///
    /// A simulated plant is advanced by `interval_s` for each sample. For any other device this is
    /// the loop `read`, `step`, `write`, and its `read` has to wait for the next sample. What the
    /// device raises is raised here, and Ctrl-C too; before, the drive nearest to zero is written.
    ///
    /// Parameters
    /// ----------
    /// device : SpringPlant, PreisachPlant or object
    ///     An object has ``read()``, which returns the output or a pair of output and input (NaN or
    ///     None for a lost reading of the output), and ``write(drive)``; a simulation may have
    ///     ``advance(dt_s)`` too.
    /// reference : array_like, shape (n,)
    ///     In the output's unit. Where it goes next is taken from it, for 'anticipate'.
    /// events : sequence of dict
    ///     What happens to a simulated plant: 'at_s', and what `SimulatedPlant.disturb` knows.
    /// ahead : int
    ///     How many samples of the reference the controller is told ahead; see `step`. It is always
    ///     told the one that is due.
    ///
    /// Returns
    /// -------
    /// Trace
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For a reference that is NaN or infinite.
    /// RigError
    ///     For an event that the plant does not know.
    /// ValueError, TypeError
    ///     For events of a device that is no simulated plant, and for a device that cannot be read
    ///     or written.
    ///
    /// Examples
    /// --------
    /// >>> class Stage:
    /// ...     mm = 0.0
    /// ...     def read(self):
    /// ...         return self.mm
    /// ...     def write(self, volts):
    /// ...         self.mm += 0.1 * (0.5 * volts - self.mm)
    /// >>> pid = pyhysteron.control.Pid(2.0, integral_s=0.1)
    /// >>> trace = pyhysteron.control.Controller(0.01, (0, 10), pid=pid).run(Stage(), np.full(500, 3.0))
    /// >>> bool(abs(trace.output[-1] - 3.0) < 1e-3)
    /// True
    #[pyo3(signature = (device, reference, *, events=None, ahead=0))]
    fn run<'py>(
        &self,
        py: Python<'py>,
        device: &Bound<'py, PyAny>,
        reference: &Bound<'py, PyAny>,
        events: Option<&Bound<'py, PyAny>>,
        ahead: usize,
    ) -> PyResult<Trace> {
        let reference = samples(reference, "reference")?;
        let reference = reference.as_slice()?;
        finite("reference", reference)?;
        let events = events.map_or(Ok(Vec::new()), events_of)?;
        let headings = hysteron::headings(reference, self.tolerance);
        let course = |events| Course {
            reference,
            headings: &headings,
            ahead,
            events,
        };
        if let Ok(plant) = device.cast::<SimulatedPlant>() {
            let plant = plant.get();
            let events = events_in_order(&events, self.interval_s(py));
            let course = course(&events);
            let trace = with_progress(py, None, |progress| {
                plant.inner.with_detached(|plant| {
                    let run = |controller: &mut _| {
                        control::run(plant.as_mut(), controller, &course, progress)
                    };
                    self.inner.with_detached(run)
                })
            })?;
            return Ok(trace.into());
        }
        if !events.is_empty() {
            return Err(PyValueError::new_err(
                "`events` happen to simulated plants only",
            ));
        }
        let trace = follow(py, device, &self.inner, &course(&[]))?;
        Ok(trace.into())
    }
}

const NAMES: [&str; 11] = [
    "model",
    "pid",
    "policy",
    "tolerance",
    "bias",
    "drives",
    "inner",
    "square_root",
    "filter_s",
    "stuck_s",
    "delay",
];

fn compensator(model: &Bound<'_, PyAny>) -> PyResult<Compensator> {
    if let Ok(adaptive) = model.cast::<Adaptive>() {
        return Ok(Compensator::adaptive(adaptive.get().now(model.py())));
    }
    if let Ok(following) = model.cast::<AdaptiveLoad>() {
        return Ok(Compensator::load(following.get().now(model.py())));
    }
    let model = model.cast::<Model>().map_err(|_| {
        PyTypeError::new_err(format!(
            "`model` is {model}: a Model, an Adaptive or an AdaptiveLoad is needed"
        ))
    })?;
    Compensator::fixed(&model.get().inner).raise()
}
