//! Arguments: words that stand for a choice, and values by their name.

use hysteron::{Direction, Learner, Operator, Policy};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// The value that `word` stands for, of those that `argument` may be.
pub(crate) fn choice<T: Copy>(argument: &str, word: &str, words: &[(&str, T)]) -> PyResult<T> {
    words
        .iter()
        .find(|(name, _)| *name == word)
        .map(|(_, value)| *value)
        .ok_or_else(|| {
            let names: Vec<_> = words.iter().map(|(name, _)| format!("'{name}'")).collect();
            PyValueError::new_err(format!(
                "`{argument}` is '{word}': one of {} is needed",
                names.join(", ")
            ))
        })
}

const OPERATORS: [(&str, Operator); 3] = [
    ("mkp", Operator::Mkp),
    ("kp", Operator::Kp),
    ("relay", Operator::Relay),
];

pub(crate) fn operator(word: &str) -> PyResult<Operator> {
    choice("operator", word, &OPERATORS)
}

pub(crate) fn operator_name(operator: Operator) -> &'static str {
    name_of(operator, &OPERATORS)
}

/// What follows the error.
pub(crate) fn learner(word: &str) -> PyResult<Learner> {
    let learners = [
        ("gradient", Learner::Gradient),
        ("increments", Learner::Increments),
        ("least-squares", Learner::LeastSquares),
        ("drift", Learner::Drift),
    ];
    choice("method", word, &learners)
}

const HEADINGS: [(&str, Direction); 2] = [
    ("rising", Direction::Rising),
    ("falling", Direction::Falling),
];

/// Where a target goes next.
pub(crate) fn direction(word: &str) -> PyResult<Direction> {
    choice("heading", word, &HEADINGS)
}

pub(crate) fn direction_name(direction: Direction) -> &'static str {
    name_of(direction, &HEADINGS)
}

/// The word that stands for a value.
fn name_of<T: PartialEq>(value: T, words: &[(&'static str, T)]) -> &'static str {
    let found = words.iter().find(|(_, other)| *other == value);
    found.map_or("", |(word, _)| word)
}

/// A band of noise around a target.
pub(crate) fn width(band: f64) -> PyResult<f64> {
    if band >= 0.0 {
        return Ok(band);
    }
    Err(PyValueError::new_err(format!(
        "`band` is {band}: a number from 0 on is needed"
    )))
}

/// A policy for one step: where the target goes next, or `None` to hold.
pub(crate) fn policy(heading: Option<&str>, band: f64) -> PyResult<Policy<f64>> {
    let tolerance = width(band)?;
    let Some(word) = heading else {
        return Ok(Policy::Hold { tolerance });
    };
    let heading = direction(word)?;
    Ok(Policy::Anticipate { heading, tolerance })
}

/// The value of a keyword argument that is taken as it comes.
pub(crate) fn named<T>(argument: &str, needed: &str, value: &Bound<'_, PyAny>) -> PyResult<T>
where
    T: for<'a, 'py> FromPyObject<'a, 'py>,
{
    value
        .extract()
        .map_err(|_| another_kind(argument, needed, value))
}

/// `TypeError` for a value that is not what is needed.
pub(crate) fn another_kind(argument: &str, needed: &str, value: &Bound<'_, PyAny>) -> PyErr {
    match value.repr() {
        Ok(value) => PyTypeError::new_err(format!("`{argument}` is {value}: {needed} is needed")),
        Err(error) => error,
    }
}

/// A keyword argument that there is none of.
pub(crate) fn no_argument(name: &str) -> PyErr {
    PyTypeError::new_err(format!("there is no argument `{name}`"))
}
