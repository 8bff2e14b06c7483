//! `control.Pid`.

use crate::array::samples;
use crate::error::{Raise, number};
use crate::integer::Integer;
use crate::shared::Shared;
use hysteron::control::{self, Gains};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Refuses what can be no time between samples.
pub(crate) fn interval(name: &str, seconds: f64) -> PyResult<f64> {
    match seconds > 0.0 && seconds.is_finite() {
        true => Ok(seconds),
        false => Err(PyValueError::new_err(format!(
            "`{name}` is {seconds}: a time above 0 is needed, in seconds"
        ))),
    }
}

fn ordered(limits: Option<(f64, f64)>) -> PyResult<(f64, f64)> {
    let (low, high) = limits.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    match low < high {
        true => Ok((low, high)),
        false => Err(PyValueError::new_err(format!(
            "`limits` are {low} and {high}: the lower one comes first"
        ))),
    }
}

/// A PID controller for samples, ``u = gain · (e + ∫e dt / integral_s + derivative_s · de/dt)``.
///
/// It stays within limits: while the output stands at one, the integral does not grow in that
/// direction. The derivative is filtered with an eighth of its time.
///
/// Parameters
/// ----------
/// gain : float
///     In units of the controller's output for each unit of the error.
/// integral_s, derivative_s : float
///     Integral and derivative time, s, from 0 on; 0 for none.
///
/// Raises
/// ------
/// ControlError
///     For a gain that is not finite and times below zero.
///
/// Examples
/// --------
/// >>> pid = pyhysteron.control.Pid(2.0, integral_s=1.0)
/// >>> pid.step(1.0, 0.1)
/// 2.2
/// >>> pid.step(100.0, 0.1, limits=(0, 10))
/// 10.0
#[pyclass(frozen, module = "pyhysteron.control")]
pub(crate) struct Pid {
    pub(crate) gains: Gains,
    inner: Shared<control::Pid>,
}

impl Pid {
    pub(crate) fn from_gains(gains: Gains) -> Self {
        let inner = Shared::new(control::Pid::new(gains));
        Self { gains, inner }
    }
}

#[pymethods]
impl Pid {
    #[new]
    #[pyo3(signature = (gain, *, integral_s=0.0, derivative_s=0.0))]
    fn new(gain: f64, integral_s: f64, derivative_s: f64) -> PyResult<Self> {
        let gains = Gains {
            gain,
            integral_s,
            derivative_s,
        };
        gains.check().raise()?;
        Ok(Self::from_gains(gains))
    }

    /// Gains by Tyreus & Luyben 1992, as `RelayTest.gains` gives.
    ///
    /// Parameters
    /// ----------
    /// ultimate_gain : float
    /// period_s : float
    ///
    /// Returns
    /// -------
    /// Pid
    ///
    /// Raises
    /// ------
    /// ControlError
    ///     For numbers that no gains follow from.
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.control.Pid.from_oscillation(3.2, 1.0)
    /// Pid(1, integral_s=2.2, derivative_s=0)
    #[staticmethod]
    pub(crate) fn from_oscillation(ultimate_gain: f64, period_s: f64) -> PyResult<Self> {
        let gains = Gains::from_oscillation(ultimate_gain, period_s);
        gains.check().raise()?;
        Ok(Self::from_gains(gains))
    }

    /// Gains by SIMC (Skogestad 2003) from a step test on one branch.
    ///
    /// Parameters
    /// ----------
    /// output : array_like, shape (n,)
    ///     What was measured.
    /// begin : int
    ///     The sample from which on the command is larger by `step`; before, it rests.
    /// step : float
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
    ///     Where the output does not answer by more than its noise, and for a `begin` or an
    ///     `interval_s` that cannot be.
    ///
    /// Examples
    /// --------
    /// >>> late = np.maximum(0.1 * (np.arange(400) - 55), 0)  # a lag of 2 s, 0.5 s late
    /// >>> pid = pyhysteron.control.Pid.from_step(3 * (1 - np.exp(-late / 2)), 50, 1.0, 0.1)
    /// >>> round(pid.gain, 1)
    /// 0.7
    #[staticmethod]
    fn from_step(
        output: &Bound<'_, PyAny>,
        begin: Integer,
        step: f64,
        interval_s: f64,
    ) -> PyResult<Self> {
        let output = samples(output, "output")?;
        let interval_s = interval("interval_s", interval_s)?;
        let gains = Gains::from_step(
            output.as_slice()?,
            begin.convert("begin")?,
            step,
            interval_s,
        );
        let gains = gains.ok_or_else(|| {
            PyValueError::new_err("`output` does not answer the step by more than its noise, so that no PID can be tuned")
        })?;
        gains.check().raise()?;
        Ok(Self::from_gains(gains))
    }

    /// The proportional gain.
    #[getter]
    fn gain(&self) -> f64 {
        self.gains.gain
    }

    /// The integral time, s; 0 for none.
    #[getter]
    fn integral_s(&self) -> f64 {
        self.gains.integral_s
    }

    /// The derivative time, s; 0 for none.
    #[getter]
    fn derivative_s(&self) -> f64 {
        self.gains.derivative_s
    }

    /// The output for `error`, `dt` seconds after the last.
    ///
    /// Parameters
    /// ----------
    /// error : float
    ///     Wanted less measured.
    /// dt : float
    ///     s, above 0.
    /// bias : float
    ///     Added to the three terms: a feedforward.
    /// limits : tuple of float, optional
    ///     Lowest and highest output. By default none.
    /// held : tuple of bool
    ///     Whether the actuator behind stands at its lower and its upper limit.
    ///
    /// Returns
    /// -------
    /// float
    ///     Within the limits.
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For an error or a bias that is NaN or infinite; nothing is changed then. Without a
    ///     reading there is `hold`.
    /// ValueError
    ///     For a `dt` of zero and less, and limits of which the upper one comes first.
    ///
    /// Examples
    /// --------
    /// >>> pid = pyhysteron.control.Pid(2.0, integral_s=4.0)
    /// >>> pid.step(1.0, 0.5), pid.step(1.0, 0.5, limits=(0, 2))
    /// (2.25, 2.0)
    #[pyo3(signature = (error, dt, *, bias=0.0, limits=None, held=(false, false)),
        text_signature = "($self, error, dt, *, bias=0.0, limits=None, held=(False, False))")]
    fn step(
        &self,
        py: Python<'_>,
        error: f64,
        dt: f64,
        bias: f64,
        limits: Option<(f64, f64)>,
        held: (bool, bool),
    ) -> PyResult<f64> {
        let (error, bias) = (number("error", error)?, number("bias", bias)?);
        let (dt, limits) = (interval("dt", dt)?, ordered(limits)?);
        let step = |pid: &mut control::Pid| pid.step(error, dt, bias, limits, held);
        Ok(self.inner.with(py, step))
    }

    /// The output without a reading: what the terms came to stays, and the derivative starts again.
    ///
    /// Parameters
    /// ----------
    /// bias, limits
    ///     As for `step`.
    ///
    /// Returns
    /// -------
    /// float
    ///
    /// Examples
    /// --------
    /// >>> pid = pyhysteron.control.Pid(2.0)
    /// >>> _ = pid.step(1.0, 0.5)
    /// >>> pid.hold(bias=1.0)
    /// 3.0
    #[pyo3(signature = (*, bias=0.0, limits=None))]
    fn hold(&self, py: Python<'_>, bias: f64, limits: Option<(f64, f64)>) -> PyResult<f64> {
        let (bias, limits) = (number("bias", bias)?, ordered(limits)?);
        Ok(self.inner.with(py, |pid| pid.hold(bias, limits)))
    }

    /// The output without a reading beside a feedforward in `bias`: the integral stays, and the
    /// other terms fade with the integral time. Without an integral term, and while `bias` is at a
    /// limit, all is held as in `hold`.
    ///
    /// Parameters
    /// ----------
    /// dt : float
    ///     Time since the sample before, s.
    /// bias, limits
    ///     As for `step`.
    ///
    /// Returns
    /// -------
    /// float
    ///
    /// Examples
    /// --------
    /// >>> pid = pyhysteron.control.Pid(2.0, integral_s=4.0)
    /// >>> pid.step(1.0, 0.5)
    /// 2.25
    /// >>> pid.relax(4.0), pid.relax(400.0)
    /// (1.25, 0.2599009900990099)
    #[pyo3(signature = (dt, *, bias=0.0, limits=None))]
    fn relax(
        &self,
        py: Python<'_>,
        dt: f64,
        bias: f64,
        limits: Option<(f64, f64)>,
    ) -> PyResult<f64> {
        let (dt, bias) = (interval("dt", dt)?, number("bias", bias)?);
        let limits = ordered(limits)?;
        Ok(self.inner.with(py, |pid| pid.relax(dt, bias, limits)))
    }

    /// At rest again, with nothing integrated.
    ///
    /// Examples
    /// --------
    /// >>> pid = pyhysteron.control.Pid(2.0, integral_s=4.0)
    /// >>> _ = pid.step(1.0, 0.5)
    /// >>> pid.reset()
    /// >>> pid.step(1.0, 0.5)
    /// 2.25
    fn reset(&self, py: Python<'_>) {
        self.inner
            .with(py, |pid| *pid = control::Pid::new(self.gains));
    }

    fn __repr__(&self) -> String {
        let Gains {
            gain,
            integral_s,
            derivative_s,
        } = self.gains;
        format!("Pid({gain}, integral_s={integral_s}, derivative_s={derivative_s})")
    }
}
