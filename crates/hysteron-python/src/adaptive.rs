//! `Adaptive`.

use crate::adapt::adapt_options;
use crate::adaptive_load::sample;
use crate::around;
use crate::array::samples;
use crate::choices;
use crate::error::{Raise, finite, number};
use crate::learning::{Learning, outcomes, side};
use crate::model::Model;
use crate::plane::on_plane;
use crate::pool::detached;
use crate::progress::with_progress;
use crate::shared::Shared;
use hysteron::Wanted;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A model that learns while it runs: its weights and offset follow the plant.
///
/// It holds two states. That of the model follows the measured input. That of the inverse follows
/// the inputs that `solve` returned. Threads may share an Adaptive: each call ends before the next
/// one begins. An Adaptive cannot be pickled; what it has learned can, as `model()`.
///
/// Parameters
/// ----------
/// model : Model
///     The off-line model. It stays as it is.
/// method : {'auto', 'fixed', 'refit', 'drift', 'least-squares', 'increments'}
///     'auto': all of the others side by side; their mean is the model, each weighted by how well it
///     has predicted lately (Herbster and Warmuth 1998).
///     'refit': all weights, by least squares over the last cycle of the input, again and again.
///     'drift': coefficients of a few patterns in which weights change under load and drift, by
///     least squares. 'least-squares': all weights, by recursive least squares. 'increments': all
///     weights, by the normalised gradient on increments. 'fixed': nothing learns.
/// start : {'off', 'on'}
///     State of the operators.
/// window : str, optional
///     'refit': the samples to fit to, 'cycles:2' for the last two cycles of the input, 'samples:500'
///     for the last 500 samples. By default 'cycles:1'.
/// every : int, optional
///     'refit': samples between two refits, 1 or more. By default a refit follows at each turning
///     point of the input, and where an eighth of the window is new.
/// ridge : float, optional
///     'refit': strength of the ridge that holds the weights where they are, relative to the
///     window's matrix, above 0 and up to 1. By default 0.1.
/// gain : float, optional
///     'increments': the share of an increment's error to remove, above 0 and below 2. By default
///     0.3.
/// span : float, optional
///     'increments': levels between two updates, from 1/8 to 8. By default 1.
/// forgetting : float, optional
///     Least squares: the weight of a sample relative to the next one, above 0 and up to 1. By
///     default 0.999, and 0.9999 with 'drift'.
/// noise : float, optional
///     Least squares: standard deviation of a reading's error, model error included, in the
///     output's unit, above 0. By default 2 % of the model's range, 5 % with 'drift'.
/// spread : float, optional
///     Least squares: standard deviation of a weight (or coefficient) around its off-line value,
///     above 0. By default such that the sum of the weights may deviate by 30 % of the model's
///     range; 0.5 for coefficients.
/// correlation : float, optional
///     'least-squares': correlation length of the deviations, in levels, from 0 on. By default 1.
/// offset_share : float, optional
///     How freely the offset moves, relative to one weight or coefficient, from 0 on. By default
///     0.2 √N for N weights with 'increments'; with least squares such that the offset may
///     deviate by 30 % of the model's range.
/// dead_zone : float, optional
///     Errors up to this are noise, in the output's unit, from 0 on. By default 0.
/// leakage : float, optional
///     Share by which the weights return to the off-line weights with each update, from 0 to 1.
///     By default 0.
/// movement : float, optional
///     Levels that the input has to move before the model learns again, from 0 on. By default
///     0.05.
/// trial : int, optional
///     Samples after which the weights are compared with the last good ones, 1 or more. By
///     default 256.
/// gate : float, optional
///     Reject a reading whose error exceeds this many times the usual error, from 2 on; 0 accepts
///     all. By default 12.
/// burst : int, optional
///     After this many consecutive readings beyond the gate that agree, the plant has jumped and
///     they are learned from. 1 or more, by default 8.
/// load : float, optional
///     'auto', 'refit' and 'drift' with a model that depends on a load: the load at the start. By default the middle
///     of its range.
///
/// Raises
/// ------
/// CoreError
///     For an option out of range and for negative weights.
/// FitError
///     For an option that the method does not have, a model that depends on a load (with another
///     method than 'auto', 'refit' or 'drift'), and too many levels for the memory of the method.
///
/// Examples
/// --------
/// >>> model = pyhysteron.Model(np.full(15, 1.0), (20, 80))
/// >>> plant = pyhysteron.Model(np.full(15, 1.5), (20, 80)).start()
/// >>> adaptive = pyhysteron.Adaptive(model, method='least-squares', noise=0.01)
/// >>> for n in range(1000):
/// ...     temperature = 50 - 40 * np.cos(0.05 * n)
/// ...     learning = adaptive.step(temperature, plant.step(temperature))
/// >>> abs(learning.error) < 0.01
/// True
/// >>> round(adaptive.model().output_range[1], 1)
/// 22.5
#[pyclass(frozen, module = "pyhysteron")]
pub(crate) struct Adaptive {
    inner: Shared<hysteron::Adaptive>,
}

impl From<hysteron::Adaptive> for Adaptive {
    fn from(adaptive: hysteron::Adaptive) -> Self {
        let inner = Shared::new(adaptive);
        Self { inner }
    }
}

impl Adaptive {
    /// The façade's, as it is now.
    pub(crate) fn now(&self, py: Python<'_>) -> hysteron::Adaptive {
        self.inner.with(py, |adaptive| adaptive.clone())
    }
}

#[pymethods]
impl Adaptive {
    #[new]
    #[pyo3(
        signature = (model, *, method="auto", start="off", **options),
        text_signature = "(model, *, method='auto', start='off', window=None, every=None, ridge=None, gain=None, span=None, forgetting=None, noise=None, spread=None, correlation=None, offset_share=None, dead_zone=None, leakage=None, movement=None, trial=None, gate=None, burst=None, load=None)"
    )]
    fn new(
        py: Python<'_>,
        model: &Model,
        method: &str,
        start: &str,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let options = adapt_options(("Adaptive", &[]), method, start, options)?;
        let model = &model.inner;
        Ok(detached(py, || options.adaptive(model)).raise()?.into())
    }

    /// Move to `input`, and learn from the output `measured` there.
    ///
    /// Parameters
    /// ----------
    /// input, measured : float
    /// dt : float, optional
    ///     As for `State.step`.
    ///
    /// Returns
    /// -------
    /// Learning
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For numbers that are NaN or infinite. Nothing is changed then.
    /// ThermalError
    ///     For a `dt` that is needed and missing, or zero for a model with a lag.
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.step(0.5, 4.5)
    /// Learning(output=4, error=0.5, outcome='learned', clipped=0)
    #[pyo3(signature = (input, measured, *, dt=None))]
    fn step(
        &self,
        py: Python<'_>,
        input: f64,
        measured: f64,
        dt: Option<f64>,
    ) -> PyResult<Learning> {
        let (sample, measured) = (sample(input, dt)?, number("measured", measured)?);
        let step = |adaptive: &mut hysteron::Adaptive| adaptive.step(sample, measured);
        Ok(self.inner.with(py, step).raise()?.into())
    }

    /// Simulate each sample, then learn from it, with a model that does not depend on time. Ctrl-C ends it; what was learned so far stays.
    ///
    /// Parameters
    /// ----------
    /// input, measured : array_like, shape (n,)
    ///
    /// Returns
    /// -------
    /// dict of ndarray, shape (n,)
    ///     'output', 'error', 'outcome' and 'clipped', as in `Learning`.
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For samples that are NaN or infinite; nothing is changed then.
    /// ValueError
    ///     For two lengths.
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.run([0.5, 1.0], [4.5, 7.0])['outcome']
    /// array(['learned', 'learned'], dtype='<U12')
    fn run<'py>(
        &self,
        py: Python<'py>,
        input: &Bound<'py, PyAny>,
        measured: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (input, measured) = (samples(input, "input")?, samples(measured, "measured")?);
        let (input, measured) = (input.as_slice()?, measured.as_slice()?);
        if input.len() != measured.len() {
            let (n, m) = (input.len(), measured.len());
            let text = format!("`measured` has {m} samples, `input` {n}");
            return Err(PyValueError::new_err(text));
        }
        finite("input", input)?;
        finite("measured", measured)?;
        let learned = with_progress(py, None, |progress| {
            let run = |adaptive: &mut hysteron::Adaptive| adaptive.run(input, measured, progress);
            self.inner.with_detached(run)
        })?;
        let table = PyDict::new(py);
        table.set_item(
            "output",
            PyArray1::from_iter(py, learned.iter().map(|l| l.output)),
        )?;
        table.set_item(
            "error",
            PyArray1::from_iter(py, learned.iter().map(|l| l.error)),
        )?;
        table.set_item("outcome", outcomes(py, learned.iter().map(|l| l.outcome))?)?;
        let clipped = learned.iter().map(|l| side(l.clipped));
        table.set_item("clipped", PyArray1::from_iter(py, clipped))?;
        Ok(table)
    }

    /// Move to `input` and return the output expected there, without learning.
    ///
    /// Parameters
    /// ----------
    /// input : float
    /// dt : float, optional
    ///     As for `State.step`.
    ///
    /// Returns
    /// -------
    /// float
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For an input that is NaN or infinite; nothing is changed then.
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))).simulate(0.5)
    /// 4.0
    #[pyo3(signature = (input, *, dt=None))]
    fn simulate(&self, py: Python<'_>, input: f64, dt: Option<f64>) -> PyResult<f64> {
        let sample = sample(input, dt)?;
        let simulate = |adaptive: &mut hysteron::Adaptive| adaptive.simulate(sample);
        self.inner.with(py, simulate).raise()
    }

    /// The input that gives `target`, by the present weights. Moves the inverse there.
    ///
    /// Parameters
    /// ----------
    /// target : float
    /// dt : float, optional
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
    /// status : int
    ///     0 where the input gives the target, -1 and 1 where it lies below or above every
    ///     output, 2 where a relay model jumps past it.
    ///
    /// Raises
    /// ------
    /// CoreError
    ///     For a target that is NaN or infinite; nothing is changed then.
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.solve(4.0)
    /// (0.5, 0)
    #[pyo3(signature = (target, *, dt=None, heading=None, tolerance=0.0))]
    fn solve(
        &self,
        py: Python<'_>,
        target: f64,
        dt: Option<f64>,
        heading: Option<&str>,
        tolerance: f64,
    ) -> PyResult<(f64, i8)> {
        let (dt, _) = around::step(dt, None)?;
        let wanted = Wanted {
            dt,
            ..choices::target(target, heading, tolerance)?.into()
        };
        let solve = |adaptive: &mut hysteron::Adaptive| adaptive.solve(wanted);
        let solution = self.inner.with(py, solve).raise()?;
        Ok((solution.input, solution.status.number()))
    }

    /// Move the inverse to where the measured input is.
    ///
    /// The inverse remembers turning points that came from older weights, until larger swings wipe
    /// them out. A loop may call this where its target turns and the model expects what is
    /// measured.
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> _ = adaptive.solve(7.0)  # the inverse goes to the top, the input does not
    /// >>> adaptive.align()
    /// >>> adaptive.solve(2.0)
    /// (0.16666666666666674, 0)
    fn align(&self, py: Python<'_>) {
        self.inner.with(py, |adaptive| adaptive.align());
    }

    /// The output expected where the input is now.
    #[getter]
    fn output(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |adaptive| adaptive.output())
    }

    /// The weights as they are now, shape (K, K), in the output's unit, NaN below the diagonal.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        on_plane(py, &self.inner.with(py, |adaptive| adaptive.weights()))
    }

    /// The output with every operator off, as it is now.
    #[getter]
    fn offset(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |adaptive| adaptive.offset())
    }

    /// The model at the start. Of a model that depends on a load, the model at `load`.
    #[getter]
    fn offline(&self, py: Python<'_>) -> Model {
        self.inner
            .with(py, |adaptive| adaptive.offline().clone())
            .into()
    }

    /// The turning points of the measured input, as those of `State`.
    #[getter]
    fn turning_points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let points = |adaptive: &mut hysteron::Adaptive| -> Vec<f64> {
            adaptive.state().turning_points().collect()
        };
        let points = self.inner.with(py, points);
        PyArray1::from_vec(py, points)
    }

    /// The last input.
    #[getter]
    fn input(&self, py: Python<'_>) -> f64 {
        self.inner.with(py, |adaptive| adaptive.state().input())
    }

    /// The model as it is now.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))).model().weights
    /// array([[ 1.,  2.],
    ///        [nan,  4.]])
    fn model(&self, py: Python<'_>) -> PyResult<Model> {
        let model = self.inner.with(py, |adaptive| adaptive.model());
        Ok(model.raise()?.into())
    }

    /// Every operator off, or on, also those of the inverse; the weights stay.
    ///
    /// Parameters
    /// ----------
    /// on : bool
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.reset(on=True)
    /// >>> adaptive.output
    /// 7.0
    #[pyo3(signature = (*, on=false))]
    fn reset(&self, py: Python<'_>, on: bool) -> PyResult<()> {
        let reset = |adaptive: &mut hysteron::Adaptive| match on {
            true => adaptive.saturate(),
            false => adaptive.reset(),
        };
        self.inner.with(py, reset).raise()
    }

    /// Refit now, with what has come since the last refit. Other methods have learned all of it.
    ///
    /// Call it before what was learned is used for long: at the end of a cycle, or before `model`.
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> adaptive = pyhysteron.Adaptive(model, method='refit', every=100)
    /// >>> _ = adaptive.step(0.5, 4.5)
    /// >>> adaptive.output
    /// 4.0
    /// >>> adaptive.refit()
    /// >>> adaptive.output
    /// 4.5
    fn refit(&self, py: Python<'_>) -> PyResult<()> {
        self.inner.with(py, |adaptive| adaptive.refit()).raise()
    }

    /// While frozen, `step` moves and nothing is learned.
    ///
    /// Parameters
    /// ----------
    /// frozen : bool
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.freeze()
    /// >>> adaptive.step(0.5, 4.5).outcome
    /// 'frozen'
    #[pyo3(signature = (frozen=true))]
    fn freeze(&self, py: Python<'_>, frozen: bool) {
        self.inner.with(py, |adaptive| adaptive.freeze(frozen));
    }

    /// Take the present weights and offset as the last good ones.
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> _ = adaptive.step(0.5, 4.5)
    /// >>> adaptive.keep()
    fn keep(&self, py: Python<'_>) {
        self.inner.with(py, |adaptive| adaptive.keep());
    }

    /// Return to the last good weights and offset: those last kept, or that passed a trial since.
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> adaptive.keep()
    /// >>> _ = adaptive.step(0.5, 40.0)  # a reading that was wrong
    /// >>> adaptive.roll_back()
    /// >>> adaptive.output
    /// 4.0
    fn roll_back(&self, py: Python<'_>) -> PyResult<()> {
        self.inner.with(py, |adaptive| adaptive.roll_back()).raise()
    }

    /// An independent copy.
    ///
    /// Returns
    /// -------
    /// Adaptive
    ///
    /// Examples
    /// --------
    /// >>> adaptive = pyhysteron.Adaptive(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)))
    /// >>> other = adaptive.copy()
    /// >>> _ = adaptive.step(1.0, 7.5)  # all on, however it began
    /// >>> adaptive.output > 7 and other.simulate(1.0) == 7
    /// True
    fn copy(&self, py: Python<'_>) -> Self {
        self.now(py).into()
    }

    fn __copy__(&self, py: Python<'_>) -> Self {
        self.copy(py)
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Self {
        self.copy(py)
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let (levels, input, output) = self.inner.with(py, |adaptive| {
            let levels = adaptive.offline().plane().levels();
            (levels, adaptive.state().input(), adaptive.output())
        });
        format!("<Adaptive, {levels} levels, at {input}: {output} expected>")
    }
}
