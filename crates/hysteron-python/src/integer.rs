//! Integers from Python, of any size. What is no integer, or does not fit, is refused by name.

use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// An argument that should be an integer.
#[derive(Clone)]
pub(crate) struct Integer {
    kind: Kind,
    text: String,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Number(i64),
    /// Of more bits than any count.
    Large,
    /// No integer.
    Other,
}

impl Integer {
    /// As the number type that is needed.
    ///
    /// # Errors
    /// `TypeError` for what is no integer, `ValueError` for one that does not fit.
    pub(crate) fn convert<T: TryFrom<i64>>(&self, argument: &str) -> PyResult<T> {
        let fits = match self.kind {
            Kind::Number(number) => T::try_from(number).ok(),
            _ => None,
        };
        fits.ok_or_else(|| match self.text.starts_with('-') {
            true => self.refused(argument, "a whole number from 0 on is needed"),
            false => self.refused(argument, "a smaller number is needed"),
        })
    }

    /// What it stands for, of a few.
    pub(crate) fn one_of<T: Copy>(
        &self,
        argument: &str,
        needed: &str,
        values: &[(i64, T)],
    ) -> PyResult<T> {
        let found = values
            .iter()
            .find(|(number, _)| self.kind == Kind::Number(*number));
        found
            .map(|(_, value)| *value)
            .ok_or_else(|| self.refused(argument, &format!("{needed} is needed")))
    }

    fn refused(&self, argument: &str, needed: &str) -> PyErr {
        let text = &self.text;
        match self.kind {
            Kind::Other => {
                PyTypeError::new_err(format!("`{argument}` is {text}: a whole number is needed"))
            }
            _ => PyValueError::new_err(format!("`{argument}` is {text}: {needed}")),
        }
    }
}

impl<'py> FromPyObject<'_, 'py> for Integer {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let py = value.py();
        let Ok(index) = py.import("operator")?.call_method1("index", (value,)) else {
            let (kind, text) = (Kind::Other, value.repr()?.to_string());
            return Ok(Self { kind, text });
        };
        let kind = match index.extract::<i64>() {
            Ok(number) => Kind::Number(number),
            Err(error) if error.is_instance_of::<PyOverflowError>(py) => Kind::Large,
            Err(error) => return Err(error),
        };
        let text = match index.str() {
            Ok(text) => text.to_string(),
            // Python writes out no number of more than some thousand digits.
            Err(_) => if index.lt(0)? { "-…" } else { "…" }.into(),
        };
        Ok(Self { kind, text })
    }
}
