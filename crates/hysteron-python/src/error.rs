//! Errors of the façade as Python exceptions, one class for each kind: `hysteron.errors`.

use hysteron::Error;
use pyo3::prelude::*;

/// The result of a function of the façade, for `?` in functions that return a [`PyResult`].
pub(crate) trait Raise<T> {
    /// As an exception.
    fn raise(self) -> PyResult<T>;
    /// As an exception that names the argument, and tells the value of a sample that is not finite.
    fn raise_of(self, argument: &str, samples: &[f64]) -> PyResult<T>;
}

impl<T, E: Into<Error>> Raise<T> for Result<T, E> {
    fn raise(self) -> PyResult<T> {
        self.map_err(|error| exception(&error.into()))
    }

    fn raise_of(self, argument: &str, samples: &[f64]) -> PyResult<T> {
        self.map_err(|error| match error.into() {
            Error::Core(hysteron::CoreError::InputNotFinite { index }) => {
                let value = samples.get(index).copied().unwrap_or(f64::NAN);
                let place = if samples.len() == 1 {
                    String::new()
                } else {
                    format!("[{index}]")
                };
                let text =
                    format!("`{argument}`{place} is {value}: every sample must be a finite number");
                new("CoreError", &text, 7)
            }
            other => exception(&other),
        })
    }
}

/// Refuses samples that are not finite, as [`Raise::raise_of`] does.
pub(crate) fn finite(argument: &str, samples: &[f64]) -> PyResult<()> {
    let fault = samples.iter().position(|x| !x.is_finite());
    let refused = fault.map(|index| Err(hysteron::CoreError::InputNotFinite { index }));
    refused.unwrap_or(Ok(())).raise_of(argument, samples)
}

fn exception(error: &Error) -> PyErr {
    let class = match error {
        Error::Core(_) => "CoreError",
        Error::File { .. } => "FileError",
        Error::ModelFile { .. } => "ModelFileError",
        Error::Recording { .. } => "RecordingError",
        Error::Fit(_) => "FitError",
        Error::Filter(_) => "FilterError",
        Error::Rig(_) => "RigError",
        Error::Preparation(_) => "PreparationError",
        Error::Design(_) => "DesignError",
        Error::Thermal(_) => "ThermalError",
        Error::Scenario { .. } => "ScenarioError",
        Error::Control(_) => "ControlError",
        Error::Export(_) => "ExportError",
        _ => "HysteronError",
    };
    new(class, &error.to_string(), error.code())
}

/// A text of the façade with options named as arguments: `--load-degree 2` is `load_degree` 2 here. Paths stay as they are.
pub(crate) fn in_python(text: &str) -> String {
    let mut parts = text.split("--");
    let mut result = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let before = result.chars().next_back();
        if !matches!(before, None | Some(' ' | '(' | '`')) {
            result = result + "--" + part;
            continue;
        }
        let quote = if before == Some('`') { "" } else { "`" };
        let name = part.find(|c: char| c != '-' && !c.is_ascii_alphabetic());
        let (name, rest) = part.split_at(name.unwrap_or(part.len()));
        result += &format!("{quote}{}{quote}{rest}", name.replace('-', "_"));
    }
    result
}

fn new(class: &str, text: &str, code: i32) -> PyErr {
    let made = Python::attach(|py| {
        let class = py.import("hysteron.errors")?.getattr(class)?;
        let error = class.call1((in_python(text),))?;
        error.setattr("code", code)?;
        Ok(PyErr::from_value(error))
    });
    made.unwrap_or_else(|error| error)
}
