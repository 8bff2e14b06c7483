//! The errors of this crate, with a stable code for each kind.

use crate::remedy::Remedy;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// The position of a row in a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Place {
    /// The row begins on this line of a text file, counted from 1.
    Line(u64),
    /// The number of the row, counted from 1, in a file without lines.
    Row(u64),
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Line(n) => write!(f, "line {n}"),
            Self::Row(n) => write!(f, "row {n}"),
        }
    }
}

/// Why a call was refused. When an error is returned, nothing has been changed and no file is
/// half-written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The core refused a plane, weights, an input or an option.
    #[error(transparent)]
    Core(#[from] hysteron_core::Error),
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the operating system reported.
        source: std::io::Error,
    },
    /// A field of a model file has an invalid value.
    #[error("model file{}: field `{field}`: {problem}", place(.path))]
    ModelFile {
        /// The file, if the model was read from one.
        path: Option<PathBuf>,
        /// The field, as a path into the JSON; `.` for the whole file.
        field: String,
        /// What is wrong with it, and what is expected.
        problem: String,
    },
    /// A recording cannot be used as it is.
    #[error("recording{}{}: {problem}", place(.path), at(*.row, .column))]
    Recording {
        /// The file, if the recording was read from one.
        path: Option<PathBuf>,
        /// The row, if the problem is in a single row.
        row: Option<Place>,
        /// Name of the column, if the problem is in a single column.
        column: Option<String>,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// The options of a fit contradict each other or the data.
    #[error("{0}")]
    Fit(String),
    /// A step of the preparation cannot be done with these options.
    #[error("preparation: {0}")]
    Preparation(String),
    /// No experiment can be designed from these options.
    #[error("design: {0}")]
    Design(String),
    /// A thermal body cannot be simulated or identified.
    #[error("{0}")]
    Thermal(String),
    /// A controller cannot be made with these settings.
    #[error("controller: {0}")]
    Control(String),
    /// A field of a scenario has an invalid value.
    #[error("scenario{}{}: `{field}`: {problem}", place(.path), at(line.map(Place::Line), &None))]
    Scenario {
        /// The file, if the scenario was read from one.
        path: Option<PathBuf>,
        /// The line of the file, if it is known.
        line: Option<u64>,
        /// The field; `.` for the whole scenario.
        field: String,
        /// What is wrong with it, and what is expected.
        problem: String,
    },
    /// A model cannot be exported to the target.
    #[error("export: {0}")]
    Export(String),
    /// The arguments of a filter do not fit the data.
    #[error(transparent)]
    Filter(#[from] crate::series::filter::FilterError),
    /// A simulated plant was asked for something that it cannot do.
    #[error(transparent)]
    Plant(Box<dyn std::error::Error + Send + Sync>),
    /// One lane of a batch refused its samples.
    #[error("lane number {lane} (from 0): {error}")]
    Lane {
        /// Number of the lane, from 0.
        lane: usize,
        /// What is wrong in it.
        error: Box<Error>,
    },
    /// Another error, with a remedy for it. [`Error::parts`] separates the two.
    #[error("{error}: {remedy}")]
    Remedied {
        /// What is wrong, and where.
        error: Box<Error>,
        /// What to do.
        remedy: Remedy,
    },
}

#[cfg(feature = "files")]
impl From<hysteron_files::Error> for Error {
    fn from(hysteron_files::Error { path, source }: hysteron_files::Error) -> Self {
        Self::File { path, source }
    }
}

#[cfg(feature = "files")]
impl hysteron_files::OfFile for Error {
    fn placed(self, at: &std::path::Path) -> Self {
        match self {
            Self::File { source, .. } => Self::File {
                path: at.to_owned(),
                source,
            },
            other => other,
        }
    }
}

impl Error {
    /// A number for each kind of error. It never changes. The codes of the core are below 20. A lane
    /// of a batch has the code of its error.
    #[must_use]
    pub fn code(&self) -> i32 {
        match self {
            Error::Core(error) => error.code(),
            Error::File { .. } => 20,
            Error::ModelFile { .. } => 21,
            Error::Recording { .. } => 22,
            Error::Fit(_) => 23,
            Error::Filter(_) => 24,
            Error::Plant(_) => 25,
            Error::Preparation(_) => 26,
            Error::Design(_) => 27,
            Error::Thermal(_) => 28,
            Error::Scenario { .. } => 29,
            Error::Control(_) => 30,
            Error::Export(_) => 31,
            Error::Lane { error, .. } | Error::Remedied { error, .. } => error.code(),
        }
    }

    /// What is wrong and, if known, the remedy. For surfaces that spell options in their own way.
    #[must_use]
    pub fn parts(&self) -> (&Error, Option<&Remedy>) {
        match self {
            Error::Remedied { error, remedy } => (error, Some(remedy)),
            error => (error, None),
        }
    }

    /// This error with a remedy for it.
    #[must_use]
    pub fn remedied(self, remedy: Remedy) -> Self {
        let error = Box::new(self);
        Error::Remedied { error, remedy }
    }
}

impl Error {
    /// This error as that of a lane. A remedy stays outermost.
    pub(crate) fn in_lane(self, lane: usize) -> Self {
        match self {
            Error::Remedied { error, remedy } => error.in_lane(lane).remedied(remedy),
            error => Error::Lane {
                lane,
                error: Box::new(error),
            },
        }
    }
}

fn place(path: &Option<PathBuf>) -> String {
    path.as_ref()
        .map_or(String::new(), |path| format!(" {}", path.display()))
}

fn at(row: Option<Place>, column: &Option<String>) -> String {
    let row = row.map(|row| format!(", {row}"));
    let column = column.as_ref().map(|column| format!(", column `{column}`"));
    row.unwrap_or_default() + &column.unwrap_or_default()
}
