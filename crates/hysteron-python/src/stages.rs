//! The stages of a `Model` around its operators, and where it starts.

use crate::convert::{result, result_of};
use crate::model::Model;
use crate::state::saved;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

#[pymethods]
impl Model {
    /// The thermal body in front of the operators, a `results.ThermalBody`; None without one.
    #[getter]
    fn thermal<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let body = self.inner.thermal.as_ref();
        body.map(|body| result_of(py, "ThermalBody", body))
            .transpose()
    }

    /// Lowest and highest drive of the recordings fitted, where there is a thermal body. The inverse
    /// stays between them.
    #[getter]
    fn drive(&self) -> Option<(f64, f64)> {
        self.inner.drive
    }

    /// The inputs between which the operators move, at the middle of the loads: temperatures, where
    /// there is a thermal body.
    #[getter]
    fn active_range(&self) -> (f64, f64) {
        self.inner.active_range()
    }

    /// The inputs at the corners of the grid, shape (K + 1,), ascending: level 0, which is the bottom
    /// of the plane, to level ``K``. None for levels at equal distances.
    #[getter]
    fn spacing<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let spacing = self.inner.spacing();
        (!spacing.is_empty()).then(|| PyArray1::from_slice(py, spacing))
    }

    /// The constants of all stages, a dict of their names and arrays of numbers; without those of
    /// stages that are not there.
    #[getter]
    fn constants<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (constant, numbers) in self.inner.constants().iter() {
            if !numbers.is_empty() {
                dict.set_item(constant.name, PyArray1::from_slice(py, numbers))?;
            }
        }
        Ok(dict)
    }

    /// The terms of the creep after the operators, a tuple of `results.CreepTerm`; empty without
    /// creep.
    #[getter]
    fn creep<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let terms = self.inner.creep();
        let terms = terms.iter().map(|term| result_of(py, "CreepTerm", term));
        PyTuple::new(py, terms.collect::<PyResult<Vec<_>>>()?)
    }

    /// Time constant of the lag after the operators, s; 0 for none.
    #[getter]
    fn lag(&self) -> f64 {
        self.inner.lag()
    }

    /// Dead time of the actuator, s; 0 for none. Fits, `evaluate`, `simulate`, `Inverse.run` without a
    /// state and controllers take account of it; a state is stepped with the inputs as they act.
    #[getter]
    fn delay_s(&self) -> f64 {
        self.inner.delay().seconds()
    }

    /// Whether the output depends on time.
    #[getter]
    fn is_timed(&self) -> bool {
        self.inner.is_timed()
    }

    /// The state that the fit found before the first sample, as `State.save` has it; None where it
    /// found none. `start` begins there.
    #[getter]
    fn fitted_start<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let fitted = self.inner.fitted();
        fitted
            .map(|state| saved(py, &self.inner, &state))
            .transpose()
    }

    /// Smallest and largest load of the fit; None for a model that does not depend on a load.
    #[getter]
    fn load_range(&self) -> Option<(f64, f64)> {
        self.inner.load.as_ref().map(|load| load.range())
    }

    /// Name and unit of the load; None for a model that does not depend on one.
    #[getter]
    pub(crate) fn load_name(&self) -> Option<String> {
        let load = self.inner.load.as_ref();
        load.map(|load| load.quantity.to_column())
    }

    /// What the load does, a `results.LoadCurves`: shift and stretch of the axis, gain and offset over
    /// the load. None where it changes weights and offset only, or there is no load.
    #[getter]
    fn load_curves<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let load = self.inner.load.as_ref();
        let Some(curves) = load.and_then(|load| load.curves.as_ref()) else {
            return Ok(None);
        };
        let dict = PyDict::new(py);
        for (name, values) in [
            ("loads", &curves.loads),
            ("shifts", &curves.shifts),
            ("scales", &curves.scales),
            ("gains", &curves.gains),
            ("offsets", &curves.offsets),
        ] {
            dict.set_item(name, PyArray1::from_slice(py, values))?;
        }
        result(py, "LoadCurves", dict).map(Some)
    }

    /// Order of the weights as a function of the load; None for a model that does not depend on one.
    #[getter]
    fn load_degree(&self) -> Option<usize> {
        self.inner.load.as_ref().map(|load| load.weights_order())
    }
}
