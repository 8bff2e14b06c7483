//! `Model`.

use crate::error::Raise;
use crate::judge;
use crate::plane::{levels_of, on_plane, weights_of};
use crate::said::told;
use crate::whole::Whole;
use crate::word::{self, operator_name};
use hysteron::{Plane, Quantity, Sign};
use numpy::{PyArray1, PyArray2};
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
/// >>> import pyhysteron
/// >>> model = pyhysteron.Model([1.0, 0.5, 1.0, 0.0, 0.5, 1.0], (20, 80), offset=10)
/// >>> model.simulate([20, 80, 50])
/// array([11., 14., 13.])
#[pyclass(frozen, module = "pyhysteron", from_py_object)]
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
        let plane = Plane::new(range.0, range.1, levels_of(weights.len())).raise()?;
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
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> model.save(path)
    /// >>> pyhysteron.Model.load(path) == model
    /// True
    #[classmethod]
    fn load(_class: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        Ok(hysteron::Model::read(&path).raise()?.into())
    }

    /// Write the model file, whole or not at all. A file that is there already is replaced.
    ///
    /// Parameters
    /// ----------
    /// path : str or path-like
    ///
    /// Raises
    /// ------
    /// FileError
    ///
    /// Examples
    /// --------
    /// >>> import os, tempfile
    /// >>> path = os.path.join(tempfile.mkdtemp(), 'model.json')
    /// >>> pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).save(path)
    fn save(&self, path: PathBuf) -> PyResult<()> {
        self.inner.write(&path).raise()
    }

    /// The model that the text of a model file says.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ModelFileError
    ///
    /// Examples
    /// --------
    /// >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    /// >>> pyhysteron.Model.from_json(model.to_json()) == model
    /// True
    #[classmethod]
    fn from_json(_class: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        Ok(hysteron::Model::from_json(text).raise()?.into())
    }

    /// The text of the model file.
    ///
    /// Returns
    /// -------
    /// str
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).to_json()[:38]
    /// '{"format":"hysteron-model","version":1'
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

    /// The weights ``μ_ij``, shape (K, K), in the output's unit: ``weights[i-1, j-1]``, NaN below the diagonal. Where they
    /// depend on a load these are those at the middle of its range, as are `offset` and `output_range`.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        on_plane(py, self.inner.weights())
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

    /// How the model was obtained: what the model file says under `fit`; None where it was not identified.
    ///
    /// A dict: the options 'solver', 'smooth' and 'start'; 'samples', and the errors over them, 'rmse' and 'max_abs' in the output's
    /// unit and 'nrmse_percent' of its range; 'weights_not_zero'; 'open_at_start', operators that the first input leaves open;
    /// 'simulated'; where it is from a file, 'file' and its 'sha256'; 'validation', what a choice by itself tried; and 'confidence', for which
    /// the attribute `confidence` is easier to read.
    #[getter]
    fn fit<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        told(py, &self.inner.fit)
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

    /// What the load is, with its unit; None where the model does not depend on one.
    #[getter]
    fn load_name(&self) -> Option<String> {
        let load = self.inner.load.as_ref();
        load.map(|load| load.quantity.to_column())
    }

    /// Size, range of the output, widest loop, and what the data said of the weights, in short.
    ///
    /// Returns
    /// -------
    /// dict
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).summary()['widest_loop']
    /// 2.0
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        told(py, &hysteron::inspect_model(&self.inner).raise()?)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.inner == other.inner
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((slf.get_type().getattr("from_json")?, (slf.get().to_json(),)))
    }

    pub(crate) fn __repr__(&self) -> String {
        let (low, high) = self.range();
        let (operator, levels) = (self.operator(), self.levels());
        let (input, output) = (self.input(), self.output());
        let model = &self.inner;
        let body = model
            .thermal
            .as_ref()
            .map_or("", |_| " behind a thermal body");
        let load = self.load_name().map(|name| format!(" under {name}"));
        let load = load.unwrap_or_default();
        format!(
            "<Model {operator}, {levels} levels, {low} to {high}: {input}{load} → {output}{body}>"
        )
    }
}

pub(crate) fn sign_of(sign: Whole) -> PyResult<Sign> {
    sign.one_of(
        "sign",
        "1 or -1",
        &[(1, Sign::Positive), (-1, Sign::Negative)],
    )
}
