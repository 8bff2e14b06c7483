//! `Model`.

use crate::array::{samples, zeros};
use crate::error::{Raise, number};
use crate::fit::start_of;
use crate::given::{optional, recording_of};
use crate::inverse::Inverse;
use crate::judge;
use crate::plane::{on_plane, weights_of};
use crate::said::told;
use crate::state::State;
use crate::whole::Whole;
use crate::word::{self, operator_name};
use hysteron::{Plane, Quantity, Sign, Surroundings};
use hysteron_export::Fmi;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use std::path::PathBuf;
use std::sync::Arc;

/// A model of an actuator: ``output = offset + sign · Σ μ_ij γ_ij(input)``.
///
/// A model does not change. What it remembers of its input is a `State`, which `start` makes.
///
/// Parameters
/// ----------
/// weights : array_like, shape (K, K) or (K(K+1)/2,)
///     The weights ``μ_ij`` in the output's unit: ``weights[i-1, j-1]`` with NaN or 0 below the
///     diagonal, or row by row, ``j = 1…K`` and within a row ``i = 1…j``.
/// range : tuple of float
///     Lowest and highest level ``(T_min, T_max)`` of the plane, in the input's unit.
/// operator : {'mkp', 'kp', 'relay'}
///     The elementary operator.
/// offset : float
///     Output with ``Σ μ γ = 0``.
/// sign : {1, -1}
///     -1 where the output falls as the input rises.
/// input, output : str
///     What they are, with their unit in brackets: ``'temperature [degC]'``.
///
/// Raises
/// ------
/// CoreError
///     For a wrong number of weights, one that is not finite, or a range that is empty.
///
/// Examples
/// --------
/// >>> import hysteron
/// >>> model = hysteron.Model([1.0, 0.5, 1.0, 0.0, 0.5, 1.0], (20, 80), offset=10)
/// >>> model.simulate([20, 80, 50])
/// array([11., 14., 13.])
#[pyclass(frozen, module = "hysteron", from_py_object)]
#[derive(Clone)]
pub(crate) struct Model {
    pub(crate) inner: Arc<hysteron::Model>,
}

impl From<hysteron::Model> for Model {
    fn from(model: hysteron::Model) -> Self {
        Self {
            inner: Arc::new(model),
        }
    }
}

#[pymethods]
impl Model {
    #[new]
    #[pyo3(signature = (weights, range, *, operator="mkp", offset=0.0, sign=None, input="input", output="output"),
        text_signature = "(weights, range, *, operator='mkp', offset=0.0, sign=1, input='input', output='output')")]
    #[allow(clippy::too_many_arguments)]
    fn new(
        weights: &Bound<'_, PyAny>,
        range: (f64, f64),
        operator: &str,
        offset: f64,
        sign: Option<Whole>,
        input: &str,
        output: &str,
    ) -> PyResult<Self> {
        let weights = weights_of(weights)?;
        // The levels that come nearest; a count that is none of any plane's is then refused.
        let levels = ((2.0 * weights.len() as f64).sqrt()) as usize;
        let plane = Plane::new(range.0, range.1, levels).raise()?;
        let (operator, sign) = (
            word::operator(operator)?,
            sign.map_or(Ok(Sign::Positive), sign_of)?,
        );
        let mut model = hysteron::Model::new(operator, plane, weights, offset, sign).raise()?;
        model.input = Quantity::from_column(input);
        model.output = Quantity::from_column(output);
        Ok(model.into())
    }

    /// Read a model file.
    ///
    /// Parameters
    /// ----------
    /// path : str or path-like
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// FileError, ModelFileError
    ///
    /// Examples
    /// --------
    /// >>> import os, tempfile
    /// >>> path = os.path.join(tempfile.mkdtemp(), 'model.json')
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> model.save(path)
    /// >>> hysteron.Model.load(path) == model
    /// True
    #[classmethod]
    fn load(_class: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        Ok(hysteron::Model::read(&path).raise()?.into())
    }

    /// Write the model file, whole or not at all.
    ///
    /// Parameters
    /// ----------
    /// path : str or path-like
    ///
    /// Raises
    /// ------
    /// FileError
    fn save(&self, path: PathBuf) -> PyResult<()> {
        self.inner.write(&path).raise()
    }

    /// The model that the text of a model file says.
    ///
    /// Raises
    /// ------
    /// ModelFileError
    ///
    /// Examples
    /// --------
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> hysteron.Model.from_json(model.to_json()) == model
    /// True
    #[classmethod]
    fn from_json(_class: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        Ok(hysteron::Model::from_json(text).raise()?.into())
    }

    /// The text of the model file.
    fn to_json(&self) -> String {
        self.inner.to_json()
    }

    /// The elementary operator: 'mkp', 'kp' or 'relay'.
    #[getter]
    fn operator(&self) -> &'static str {
        operator_name(self.inner.operator())
    }

    /// The number of levels ``K``.
    #[getter]
    fn levels(&self) -> usize {
        self.inner.plane().levels()
    }

    /// Lowest and highest level, in the input's unit.
    #[getter]
    fn range(&self) -> (f64, f64) {
        (self.inner.plane().min(), self.inner.plane().max())
    }

    /// The levels ``α_k = β_k``, shape (K,), in the input's unit.
    #[getter]
    fn plane<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let plane = self.inner.plane();
        PyArray1::from_iter(py, (1..=plane.levels()).map(|k| plane.level(k)))
    }

    /// The weights ``μ_ij``, shape (K, K), in the output's unit: ``weights[i-1, j-1]``, NaN below the diagonal.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        on_plane(py, self.levels(), self.inner.weights())
    }

    /// Output with ``Σ μ γ = 0``.
    #[getter]
    fn offset(&self) -> f64 {
        self.inner.offset()
    }

    /// 1, or -1 where the output falls as the input rises.
    #[getter]
    fn sign(&self) -> i32 {
        self.inner.sign().factor() as i32
    }

    /// The outputs with every operator off and with every operator on.
    #[getter]
    fn output_range(&self) -> (f64, f64) {
        self.inner.output_range()
    }

    /// What the input is, with its unit: 'temperature [degC]'.
    #[getter]
    fn input(&self) -> String {
        self.inner.input.to_column()
    }

    /// What the output is, with its unit.
    #[getter]
    fn output(&self) -> String {
        self.inner.output.to_column()
    }

    /// How the model was obtained, where it was identified: what the model file says under `fit`.
    #[getter]
    fn fit<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let file = py
            .import("json")?
            .call_method1("loads", (self.inner.to_json(),))?;
        file.call_method1("get", ("fit",))
    }

    /// What the data say of the weights, and what not; None for a model that was fitted without a bootstrap.
    ///
    /// A dict: 'standard_error' of each weight, shape (K, K), NaN below the diagonal, in the output's unit, and 'offset_error';
    /// 'excitation', shape (K, K), what the input says of each operator, as `excitation` has it; 'levels', shape (K,), those of the
    /// plane; 'rank' of 'unknowns' combinations of weights that the data determine, and their 'condition'; 'noise', the standard
    /// deviation of what the model leaves; 'branches' of the input; 'replicates' of the bootstrap.
    #[getter]
    fn confidence<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        judge::confidence(py, &self.inner)
    }

    /// The thermal body in front of the operators: its 'gain' and the time constants 'tau_heating' and 'tau_cooling' in seconds; or None.
    #[getter]
    fn thermal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        told(py, &self.inner.thermal)
    }

    /// Smallest and largest load that the model was fitted on; None where it does not depend on one.
    #[getter]
    fn load_range(&self) -> Option<(f64, f64)> {
        self.inner.load.as_ref().map(|load| load.range())
    }

    /// Size, range of the output, widest loop, and what the data said of the weights, in short.
    ///
    /// Returns
    /// -------
    /// dict
    ///
    /// Examples
    /// --------
    /// >>> hysteron.Model([1.0, 2.0, 4.0], (0, 1)).summary()['widest_loop']
    /// 2.0
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        told(py, &hysteron::inspect_model(&self.inner).raise()?)
    }

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
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
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
            return self.started(false).run(py, input);
        }
        let input = samples(input, "input")?;
        let input = input.as_slice()?;
        let (time, load) = (optional(time, "time")?, optional(load, "load")?);
        let around = Surroundings {
            time: time.as_deref(),
            load: load.as_deref(),
        };
        let output = py.detach(|| model.predict(input, around).raise_of("input", input))?;
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
    /// >>> model = hysteron.fit(temperature, lift, levels=6)
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
        let input = samples(input, "input")?;
        let input = input.as_slice()?;
        let (time, load) = (optional(time, "time")?, optional(load, "load")?);
        let around = Surroundings {
            time: time.as_deref(),
            load: load.as_deref(),
        };
        let model = &self.inner;
        let ends = py.detach(|| model.predict_band(input, around).raise_of("input", input));
        let (low, high) = ends?;
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
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
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

    /// What an input, or several, say about each operator of this model's plane: `hysteron.excitation`.
    ///
    /// Examples
    /// --------
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
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
    /// Examples
    /// --------
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> model.start(on=True).step(0.5)
    /// 5.0
    #[pyo3(signature = (*, on=false))]
    fn start(&self, on: bool) -> State {
        self.started(on)
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
    ///
    /// Examples
    /// --------
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
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
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
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
    /// >>> runs = [hysteron.Recording(temperature, (9 - load) * temperature, load=np.full(400, load)) for load in (3.0, 6.0)]
    /// >>> model = hysteron.fit(runs, levels=6, bootstrap=0)
    /// >>> model.load_range
    /// (3.0, 6.0)
    /// >>> low, high = model.at_load(4.5).output_range
    /// >>> round(high - low)
    /// 270
    fn at_load(&self, load: f64) -> PyResult<Self> {
        Ok(self.inner.at_load(load).raise()?.into())
    }

    /// Write the model as C99 for a microcontroller, with the algorithm beside it.
    ///
    /// Parameters
    /// ----------
    /// folder : str or path-like
    /// real : {'float', 'double'}
    ///     The number type that the C computes in.
    /// name : str, optional
    ///     The model's name in C, and of its files. By default 'model'.
    /// adaptation : bool
    ///     Also write what lets the weights follow the plant there, by the gradient method.
    ///
    /// Returns
    /// -------
    /// dict
    ///     'files', 'name', 'inverse' (whether there is one), 'flash_bytes', 'ram_bytes' (for each state), 'step_loop' and
    ///     'inverse_halvings' (turns of the loops of one call at most).
    ///
    /// Raises
    /// ------
    /// ExportError
    ///     For a model that depends on a load or has a thermal body, and for a name that cannot be one in C.
    /// FileError
    ///
    /// Examples
    /// --------
    /// >>> import os, tempfile
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> with tempfile.TemporaryDirectory() as folder:
    /// ...     export = model.export_c(folder, name='wire')
    /// ...     sorted(os.path.basename(file) for file in export['files'])
    /// ['hysteron_mcu.c', 'hysteron_mcu.h', 'hysteron_mcu_internal.h', 'hysteron_mcu_inverse.c', 'wire.c', 'wire.h']
    #[pyo3(signature = (folder, *, real="float", name=None, adaptation=false))]
    fn export_c<'py>(
        &self,
        py: Python<'py>,
        folder: PathBuf,
        real: &str,
        name: Option<&str>,
        adaptation: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        crate::export::c(py, &self.inner, &folder, real, name, adaptation)
    }

    /// Write the model, or its inverse, as a functional mock-up unit for Simulink and other tools.
    ///
    /// Parameters
    /// ----------
    /// path : str or path-like
    ///     Ends with '.fmu'.
    /// inverse : bool
    ///     The inverse, from the wanted output to the input, instead of the model.
    /// fmi : {2, 3}
    ///     The version of the standard.
    /// name : str, optional
    ///     The block's name. By default 'sf_MKP' or 'sf_Inverse_MKP'.
    ///
    /// Returns
    /// -------
    /// dict
    ///     'name', 'token', 'bytes', and the names of the 'inputs', 'outputs' and 'parameters'.
    ///
    /// Raises
    /// ------
    /// ExportError
    ///     For a model that depends on a load or has a thermal body, and for a name or a path that cannot be.
    /// CoreError
    ///     For the inverse of a model with weights below zero.
    /// FileError
    ///
    /// Examples
    /// --------
    /// >>> import os, tempfile
    /// >>> model = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> fmu = model.export_fmu(os.path.join(tempfile.mkdtemp(), 'inverse.fmu'), inverse=True)
    /// >>> fmu['name'], fmu['inputs'], fmu['outputs']
    /// ('sf_Inverse_MKP', ['target', 'heading'], ['input', 'status'])
    #[pyo3(signature = (path, *, inverse=false, fmi=None, name=None), text_signature = "($self, path, *, inverse=False, fmi=2, name=None)")]
    fn export_fmu<'py>(
        &self,
        py: Python<'py>,
        path: PathBuf,
        inverse: bool,
        fmi: Option<Whole>,
        name: Option<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let versions = [(2, Fmi::V2), (3, Fmi::V3)];
        let fmi = fmi.map_or(Ok(Fmi::V2), |fmi| fmi.one_of("fmi", "2 or 3", &versions))?;
        crate::export::fmu(py, &self.inner, &path, inverse, fmi, name)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.inner == other.inner
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((slf.get_type().getattr("from_json")?, (slf.get().to_json(),)))
    }

    fn __repr__(&self) -> String {
        let (low, high) = self.range();
        let (operator, levels) = (self.operator(), self.levels());
        let (input, output) = (self.input(), self.output());
        format!("<Model {operator}, {levels} levels, {low} to {high}: {input} → {output}>")
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

pub(crate) fn sign_of(sign: Whole) -> PyResult<Sign> {
    sign.one_of(
        "sign",
        "1 or -1",
        &[(1, Sign::Positive), (-1, Sign::Negative)],
    )
}

/// Runs `work` on new samples, without the interpreter's lock.
pub(crate) fn filled<'py>(
    py: Python<'py>,
    count: usize,
    work: impl FnOnce(&mut [f64]) -> PyResult<()> + Send,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let array = zeros(py, count);
    let mut values = array.try_readwrite()?;
    let slice = values.as_slice_mut()?;
    py.detach(|| work(slice))?;
    drop(values);
    Ok(array)
}
