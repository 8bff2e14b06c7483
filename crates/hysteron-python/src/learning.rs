//! `Learning`, and outcomes of learning as arrays.

use crate::choices::choice;
use hysteron::{Clipped, Outcome};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// What a sample taught an `Adaptive`.
#[pyclass(frozen, get_all, module = "pyhysteron")]
pub(crate) struct Learning {
    /// Output that was expected before anything was learned from the sample.
    output: f64,
    /// Measured less expected.
    error: f64,
    /// What was done: 'learned', 'waiting' (error within the dead zone, or an increment not
    /// finished), 'at-rest' (the input did not move), 'frozen', 'rolled-back' (the weights went
    /// back to the last good ones), 'rejected' (the reading is too far from what was expected),
    /// 'output-stuck' or 'input-stuck' (a channel stands still while the other one moves; what was
    /// learned since is undone).
    outcome: &'static str,
    /// -1 or 1 where the input lay below or above the plane, else 0.
    clipped: i8,
}

impl From<hysteron::Learning<f64>> for Learning {
    fn from(learning: hysteron::Learning<f64>) -> Self {
        Self {
            output: learning.output,
            error: learning.error,
            outcome: learning.outcome.name(),
            clipped: side(learning.clipped),
        }
    }
}

#[pymethods]
impl Learning {
    #[new]
    fn new(output: f64, error: f64, outcome: &str, clipped: i8) -> PyResult<Self> {
        let outcomes = Outcome::ALL.map(|outcome| (outcome.name(), outcome.name()));
        Ok(Self {
            output,
            error,
            outcome: choice("outcome", outcome, &outcomes)?,
            clipped,
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let of = slf.get();
        let fields = (of.output, of.error, of.outcome, of.clipped);
        (slf.get_type(), fields).into_pyobject(slf.py())
    }

    fn __repr__(&self) -> String {
        let Self {
            output,
            error,
            outcome,
            clipped,
        } = self;
        format!("Learning(output={output}, error={error}, outcome='{outcome}', clipped={clipped})")
    }
}

/// Outcomes as an array of their names.
pub(crate) fn outcomes<'py>(
    py: Python<'py>,
    outcomes: impl Iterator<Item = Outcome>,
) -> PyResult<Bound<'py, PyAny>> {
    let place = |outcome| Outcome::ALL.iter().position(|o| *o == outcome).unwrap_or(0);
    let places: Vec<usize> = outcomes.map(place).collect();
    let names = Outcome::ALL.map(Outcome::name);
    let names = py.import("numpy")?.call_method1("array", (names,))?;
    names.get_item(PyArray1::from_vec(py, places))
}

pub(crate) fn side(clipped: Option<Clipped>) -> i8 {
    match clipped {
        None => 0,
        Some(Clipped::Low) => -1,
        Some(Clipped::High) => 1,
    }
}
