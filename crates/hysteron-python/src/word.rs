//! Words that stand for a choice.

use hysteron::{Direction, Learner, Operator, Policy};
use pyo3::exceptions::PyValueError;
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
    OPERATORS
        .iter()
        .find(|(_, value)| *value == operator)
        .map_or("mkp", |(name, _)| name)
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

/// Where a target goes next.
pub(crate) fn direction(word: &str) -> PyResult<Direction> {
    let headings = [
        ("rising", Direction::Rising),
        ("falling", Direction::Falling),
    ];
    choice("heading", word, &headings)
}

/// A band of noise around a target.
pub(crate) fn width(band: f64) -> PyResult<f64> {
    if band >= 0.0 {
        return Ok(band);
    }
    Err(PyValueError::new_err(format!(
        "`band` is {band}: it is 0 or more, in the output's unit"
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
