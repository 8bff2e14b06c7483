//! Arguments: words that stand for a choice, and values by their name.

use crate::error::{Raise, number};
use hysteron::{Direction, Learner, Operator, Policy, Start, Target};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The value that `name` stands for, of those that `argument` allows.
pub(crate) fn choice<T: Copy>(argument: &str, name: &str, choices: &[(&str, T)]) -> PyResult<T> {
    let found = choices.iter().find(|(other, _)| *other == name);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
        let quoted: Vec<_> = names.iter().map(|name| format!("'{name}'")).collect();
        let meant = did_you_mean(name, &names, "'");
        PyValueError::new_err(format!(
            "`{argument}` is '{name}': one of {} is needed{meant}",
            quoted.join(", ")
        ))
    })
}

/// `. Did you mean 'increments'?`, or nothing where no name is similar.
///
/// `pyhysteron._convert.did_you_mean` decides, for the Python half as well.
pub(crate) fn did_you_mean(name: &str, names: &[&str], quote: &str) -> String {
    Python::attach(|py| {
        let half = py.import("pyhysteron._convert")?;
        half.call_method1("did_you_mean", (name, names.to_vec(), quote))?
            .extract()
    })
    .unwrap_or_default()
}

const OPERATORS: [(&str, Operator); 3] = [
    ("mkp", Operator::Mkp),
    ("kp", Operator::Kp),
    ("relay", Operator::Relay),
];

pub(crate) fn operator(name: &str) -> PyResult<Operator> {
    choice("operator", name, &OPERATORS)
}

pub(crate) fn operator_name(operator: Operator) -> &'static str {
    name_of(operator, &OPERATORS)
}

/// The learner of this name.
pub(crate) fn learner(name: &str) -> PyResult<Learner> {
    if name == "gradient" {
        // Says what to take in its place.
        return name.parse().raise();
    }
    let learners = Learner::ALL.map(|learner| (learner.name(), learner));
    choice("method", name, &learners)
}

const HEADINGS: [(&str, Direction); 2] = [
    ("rising", Direction::Rising),
    ("falling", Direction::Falling),
];

/// Where a target goes next.
pub(crate) fn direction(name: &str) -> PyResult<Direction> {
    choice("heading", name, &HEADINGS)
}

pub(crate) fn direction_name(direction: Direction) -> &'static str {
    name_of(direction, &HEADINGS)
}

/// The name of a value.
fn name_of<T: PartialEq>(value: T, choices: &[(&'static str, T)]) -> &'static str {
    let found = choices.iter().find(|(_, other)| *other == value);
    found.map_or("", |(name, _)| name)
}

/// A size of reversals, from 0 on: a tolerance or a dead band.
pub(crate) fn size(argument: &str, value: f64) -> PyResult<f64> {
    if value >= 0.0 {
        return Ok(value);
    }
    Err(PyValueError::new_err(format!(
        "`{argument}` is {value}: a number from 0 on is needed"
    )))
}

/// A target for one step: where it goes next, or `None` to hold it.
pub(crate) fn target(output: f64, heading: Option<&str>, tolerance: f64) -> PyResult<Target<f64>> {
    Ok(Target {
        output: number("target", output)?,
        heading: heading.map(direction).transpose()?,
        tolerance: size("tolerance", tolerance)?,
    })
}

/// The policies by name.
pub(crate) const POLICIES: [(&str, Policy); 2] =
    [("hold", Policy::Hold), ("anticipate", Policy::Anticipate)];

/// Where the operators of a model stand before the first sample.
pub(crate) const STARTS: [(&str, Start); 5] = [
    ("fitted", Start::Fitted),
    ("off", Start::Off),
    ("on", Start::On),
    ("rest", Start::Rest),
    ("unknown", Start::Unknown),
];

/// Those of a loop, which has no recording to find one from.
pub(crate) const LOOP_STARTS: [(&str, Start); 2] = [("off", Start::Off), ("on", Start::On)];

/// The same before there is a model that starts somewhere.
pub(crate) fn start_of(name: &str) -> PyResult<Start> {
    choice("start", name, &STARTS[1..])
}

/// The value of a keyword argument, converted by its type alone.
pub(crate) fn named<T>(argument: &str, needed: &str, value: &Bound<'_, PyAny>) -> PyResult<T>
where
    T: for<'a, 'py> FromPyObject<'a, 'py>,
{
    value
        .extract()
        .map_err(|_| another_kind(argument, needed, value))
}

/// `TypeError` for a value of another kind than is needed.
pub(crate) fn another_kind(argument: &str, needed: &str, value: &Bound<'_, PyAny>) -> PyErr {
    match value.repr() {
        Ok(value) => PyTypeError::new_err(format!("`{argument}` is {value}: {needed} is needed")),
        Err(error) => error,
    }
}

/// `TypeError` for a keyword argument that `call` does not have.
pub(crate) fn no_argument(call: &str, name: &str, names: &[&str]) -> PyErr {
    let meant = did_you_mean(name, names, "`");
    PyTypeError::new_err(format!("{call}: there is no argument `{name}`{meant}"))
}

/// Refuses keyword arguments that are left over.
pub(crate) fn none_left(
    call: &str,
    unknown: Option<&Bound<'_, PyDict>>,
    names: &[&str],
) -> PyResult<()> {
    match unknown.and_then(|unknown| unknown.keys().into_iter().next()) {
        None => Ok(()),
        Some(name) => Err(no_argument(call, &name.to_string(), names)),
    }
}
