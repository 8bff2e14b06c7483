//! Errors of the library as Python exceptions, one class for each kind: `pyhysteron.errors`.

use hysteron::{Error, Remedy, SettingValue};
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;
use std::io::ErrorKind;
use std::path::Path;

/// The result of a function of the façade, for `?` in functions that return a [`PyResult`].
pub(crate) trait Raise<T> {
    /// As an exception.
    fn raise(self) -> PyResult<T>;
    /// As an exception that names the argument and the value of a sample that is not finite.
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
                not_finite(&format!("{argument}[{index}]"), value)
            }
            other => exception(&other),
        })
    }
}

/// Refuses samples that are not finite, as [`Raise::raise_of`] does.
pub(crate) fn finite(argument: &str, samples: &[f64]) -> PyResult<()> {
    match samples.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(index) => Err(not_finite(&format!("{argument}[{index}]"), samples[index])),
    }
}

/// A finite number.
pub(crate) fn number(argument: &str, value: f64) -> PyResult<f64> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(not_finite(argument, value)),
    }
}

fn not_finite(place: &str, value: f64) -> PyErr {
    let code = hysteron::CoreError::InputNotFinite { index: 0 }.code();
    let text = format!("`{place}` is {value}: a finite number is needed");
    new("CoreError", (text,), code)
}

fn exception(error: &Error) -> PyErr {
    let (error, remedy) = error.parts();
    let of_one = match error {
        Error::Lane { error, .. } => error,
        error => error,
    };
    let class = match of_one {
        Error::Core(_) => "CoreError",
        Error::File { path, source } => match source.raw_os_error() {
            Some(number) => {
                let class = match source.kind() {
                    ErrorKind::NotFound => "FileMissingError",
                    _ => "FileError",
                };
                return of_file(class, path, number, error.code());
            }
            None => "FileError",
        },
        Error::ModelFile { .. } => "ModelFileError",
        Error::Recording { .. } => "RecordingError",
        Error::Fit(_) => "FitError",
        Error::Filter(_) => "FilterError",
        Error::Plant(_) => "RigError",
        Error::Preparation(_) => "PreparationError",
        Error::Design(_) => "DesignError",
        Error::Thermal(_) => "ThermalError",
        Error::Scenario { .. } => "ScenarioError",
        Error::Control(_) => "ControlError",
        Error::Export(_) => "ExportError",
        _ => "HysteronError",
    };
    let text = match remedy {
        Some(remedy) => format!("{error}: {}", spelt(remedy)),
        None => error.to_string(),
    };
    new(class, (text,), error.code())
}

/// An error of the operating system, with Python's text, `errno` and `filename`.
fn of_file(class: &str, path: &Path, number: i32, code: i32) -> PyErr {
    let text = Python::attach(|py| {
        let text = py.import("os")?.call_method1("strerror", (number,))?;
        Ok::<_, PyErr>(text.unbind())
    });
    match text {
        Ok(text) => new(class, (number, text, path.as_os_str()), code),
        Err(error) => error,
    }
}

/// What helps, with options as arguments: `load_degree=2`, `start="unknown"`.
pub(crate) fn spelt(remedy: &Remedy) -> String {
    remedy.spelt(|setting| {
        let name = setting.name.replace('-', "_");
        match setting.value {
            SettingValue::Any => format!("`{name}`"),
            SettingValue::On => format!("`{name}=True`"),
            SettingValue::Word(word) => format!("`{name}=\"{word}\"`"),
            SettingValue::Number(number) => format!("`{name}={number}`"),
        }
    })
}

/// An exception of a class of `pyhysteron.errors`.
pub(crate) fn new(class: &str, arguments: impl for<'py> PyCallArgs<'py>, code: i32) -> PyErr {
    let made = Python::attach(|py| {
        let class = py.import("pyhysteron.errors")?.getattr(class)?;
        let error = class.call1(arguments)?;
        error.setattr("code", code)?;
        Ok(PyErr::from_value(error))
    });
    made.unwrap_or_else(|error| error)
}
