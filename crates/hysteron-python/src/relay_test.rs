//! `control.RelayTest`.

use crate::error::Raise;
use crate::pid::{Pid, interval};
use crate::shared::Shared;
use hysteron::control;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The relay test (Åström & Hägglund 1984): a relay in place of the controller makes the loop
/// oscillate.
///
/// Once a sample: bring the input to `command`, read the output, `push` it. It crosses the
/// hysteresis, which a step test on one branch does not see.
///
/// Parameters
/// ----------
/// commands : tuple of float
///     The relay's two commands, the lower one first.
/// middle : float
///     Output at which it switches.
/// hysteresis : float
///     How far beyond `middle` the output has to go before it switches, from 0 on: more than the
///     noise.
///
/// Raises
/// ------
/// ControlError
///
/// Examples
/// --------
/// >>> plant = pyhysteron.PreisachPlant()
/// >>> test = pyhysteron.control.RelayTest((40, 110), 36.0, hysteresis=0.5)
/// >>> while not test.done:
/// ...     plant.write(test.command)
/// ...     plant.advance(0.01)
/// ...     test.push(plant.read()[0])
/// >>> pid = test.gains(0.01)
/// >>> pid.gain > 0 and pid.integral_s > 0
/// True
#[pyclass(frozen, module = "pyhysteron.control")]
pub(crate) struct RelayTest {
    inner: Shared<control::RelayTest>,
}

#[pymethods]
impl RelayTest {
    #[new]
    #[pyo3(signature = (commands, middle, *, hysteresis=0.0))]
    fn new(commands: (f64, f64), middle: f64, hysteresis: f64) -> PyResult<Self> {
        let test = control::RelayTest::new(commands, middle, hysteresis);
        let inner = Shared::new(test.raise()?);
        Ok(Self { inner })
    }

    /// The command for the sample that comes.
    #[getter]
    fn command(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |test| test.command())
    }

    /// Whether there were periods enough.
    #[getter]
    fn done(&self, py: Python<'_>) -> bool {
        self.inner.with(py, |test| test.is_done())
    }

    /// Lowest and highest output so far, None before the first.
    #[getter]
    fn outputs(&self, py: Python<'_>) -> Option<(f64, f64)> {
        self.inner.with(py, |test| test.outputs())
    }

    /// Take the output that followed the command.
    ///
    /// Parameters
    /// ----------
    /// output : float
    ///     NaN for a lost reading.
    ///
    /// Examples
    /// --------
    /// >>> test = pyhysteron.control.RelayTest((40, 110), 36.0, hysteresis=0.5)
    /// >>> before = test.command
    /// >>> test.push(40.0)  # beyond middle and hysteresis
    /// >>> before, test.command
    /// (110.0, 40.0)
    fn push(&self, py: Python<'_>, output: f64) {
        self.inner.with(py, |test| test.push(output));
    }

    /// Ultimate gain and period, once the test is done.
    ///
    /// Parameters
    /// ----------
    /// interval_s : float
    ///     Time between samples.
    ///
    /// Returns
    /// -------
    /// tuple of float, or None
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For a time of zero and less.
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.control.RelayTest((40, 110), 36.0).oscillation(0.01) is None  # not done
    /// True
    fn oscillation(&self, py: Python<'_>, interval_s: f64) -> PyResult<Option<(f64, f64)>> {
        let interval_s = interval("interval_s", interval_s)?;
        let found = self.inner.with(py, |test| test.oscillation());
        Ok(found.map(|(gain, period)| (gain, period * interval_s)))
    }

    /// A PID with the gains that follow, by Tyreus & Luyben 1992.
    ///
    /// Parameters
    /// ----------
    /// interval_s : float
    ///     Time between samples.
    ///
    /// Returns
    /// -------
    /// Pid
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     Before the test is done.
    ///
    /// Examples
    /// --------
    /// >>> plant, test = pyhysteron.PreisachPlant(), pyhysteron.control.RelayTest((40, 110), 36.0, hysteresis=0.5)
    /// >>> while not test.done:
    /// ...     plant.write(test.command)
    /// ...     plant.advance(0.01)
    /// ...     test.push(plant.read()[0])
    /// >>> test.gains(0.01).derivative_s  # a PI controller
    /// 0.0
    fn gains(&self, py: Python<'_>, interval_s: f64) -> PyResult<Pid> {
        match self.oscillation(py, interval_s)? {
            Some((gain, period_s)) => Pid::from_oscillation(gain, period_s),
            None => Err(PyValueError::new_err(
                "the test is not done: go on until `done`",
            )),
        }
    }
}
