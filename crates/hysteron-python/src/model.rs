//! `Model`.

use crate::choices::{self, operator_name};
use crate::convert::{result, result_of};
use crate::error::Raise;
use crate::evaluate;
use crate::integer::Integer;
use crate::plane::{levels_of, on_plane, weights_of};
use hysteron::{Plane, Quantity, Sign};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use std::path::PathBuf;
use std::sync::Arc;

/// A model of an actuator: ``output = offset + sign · Σ μ_ij γ_ij(input)``.
///
/// `fit` may find stages around these operators: a thermal body (`thermal`), a load that shifts their
/// axis (`load_curves`), levels at unequal distances (`spacing`), and those behind them. `simulate`,
/// `inverse` and `start` run all of them.
///
/// A model is immutable. Its memory of the input is a `State`, made by `start`.
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
///     Names, with the unit in brackets: ``'temperature [degC]'``.
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
    #[pyo3(signature = (weights, range, *, operator="mkp", offset=0.0, sign=None, input="input", output="output", **unknown),
        text_signature = "(weights, range, *, operator='mkp', offset=0.0, sign=1, input='input', output='output')")]
    #[allow(clippy::too_many_arguments)]
    fn new(
        weights: &Bound<'_, PyAny>,
        range: (f64, f64),
        operator: &str,
        offset: f64,
        sign: Option<Integer>,
        input: &str,
        output: &str,
        unknown: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let names = ["operator", "offset", "sign", "input", "output"];
        choices::none_left("Model", unknown, &names)?;
        let weights = weights_of(weights)?;
        // The nearest number of levels. A count that fits no plane is refused below.
        let plane = Plane::new(range.0, range.1, levels_of(weights.len())).raise()?;
        let (operator, sign) = (
            choices::operator(operator)?,
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

    /// Write the model file. An existing file is replaced, in one step.
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

    /// The model from the text of a model file.
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

    /// Lowest and highest level of the plane, in the input's unit: of the temperature behind a thermal
    /// body. With `spacing`, a place on the grid.
    #[getter]
    fn range(&self) -> (f64, f64) {
        (self.inner.plane().min(), self.inner.plane().max())
    }

    /// The levels ``α_k = β_k``, shape (K,), in the unit of `range`.
    #[getter]
    fn plane<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let plane = self.inner.plane();
        PyArray1::from_iter(py, (1..=plane.levels()).map(|k| plane.level(k)))
    }

    /// The weights ``μ_ij``, shape (K, K), in the output's unit: ``weights[i-1, j-1]``.
    ///
    /// NaN below the diagonal. Where the weights depend on a load, these are the weights at the
    /// middle of its range. The same holds for `offset` and `output_range`.
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

    /// Name and unit of the input: 'temperature [degC]'.
    #[getter]
    pub(crate) fn input(&self) -> String {
        self.inner.input.to_column()
    }

    /// Name and unit of the output.
    #[getter]
    pub(crate) fn output(&self) -> String {
        self.inner.output.to_column()
    }

    /// How the model was identified; None for a model that was not identified.
    ///
    /// A `results.FitSummary`: options, samples, errors, files and cross-validation.
    #[getter]
    fn fit<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(fit) = &self.inner.fit else {
            return Ok(None);
        };
        let mut fit = fit.clone();
        fit.confidence = None; // `Model.confidence` has it as arrays
        result_of(py, "FitSummary", &fit).map(Some)
    }

    /// How well the data determine the weights; None for a model that was fitted without bootstrap.
    ///
    /// A `results.Confidence`: standard errors, excitation, rank, condition and noise.
    #[getter]
    fn confidence<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let found = evaluate::confidence(py, &self.inner)?;
        found
            .map(|found| result(py, "Confidence", found))
            .transpose()
    }

    /// Whether the model is good enough, from the record of its fit; None for a model without one.
    ///
    /// A `results.Verdict`. That of `Model.evaluate` also knows the worst sample and the inverse.
    ///
    /// Examples
    /// --------
    /// >>> x = [0.0, 1.0, 0.2, 0.9, 0.1, 1.0, 0.0]
    /// >>> model = pyhysteron.fit(pyhysteron.Recording(x, x), levels=3, smooth=0)
    /// >>> model.verdict.grade
    /// 'untested'
    #[getter]
    fn verdict<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let verdict = hysteron::Verdict::of_record(&self.inner);
        verdict
            .map(|verdict| result_of(py, "Verdict", &verdict))
            .transpose()
    }

    /// Size, output range, widest loop and confidence in short.
    ///
    /// Returns
    /// -------
    /// results.ModelSummary
    ///
    /// Examples
    /// --------
    /// >>> pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).summary().widest_loop
    /// 2.0
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let summary = hysteron::inspect_model(&self.inner).raise()?;
        result_of(py, "ModelSummary", &summary)
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let half = slf.py().import("pyhysteron._html")?;
        half.call_method1("model", (slf,))
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

pub(crate) fn sign_of(sign: Integer) -> PyResult<Sign> {
    sign.one_of(
        "sign",
        "1 or -1",
        &[(1, Sign::Positive), (-1, Sign::Negative)],
    )
}
