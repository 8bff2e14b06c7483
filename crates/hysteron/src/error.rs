//! Everything that can go wrong, with a stable code for each kind.

use crate::remedy::Remedy;
use std::path::PathBuf;

/// A result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Where a row of a table is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// It begins on this line of a text file, counted from 1.
    Line(u64),
    /// It is this row of a file without lines, counted from 1.
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

/// Why a call was refused. Nothing is changed or half-written when an error is returned.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A refusal of the core: a plane, weights, an input.
    #[error(transparent)]
    Core(#[from] hysteron_core::Error),
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A model file says something that cannot be.
    #[error("model file{}: field `{field}`: {problem}", place(.path))]
    ModelFile {
        /// The file, where there is one.
        path: Option<PathBuf>,
        /// The field, as a path into the JSON; `.` for the whole.
        field: String,
        /// What is wrong with it, and what is expected.
        problem: String,
    },
    /// A recording cannot be used as it is.
    #[error("recording{}{}: {problem}", place(.path), at(*.row, .column))]
    Recording {
        /// The file, where there is one.
        path: Option<PathBuf>,
        /// Where the row is, where the fault is in one row.
        row: Option<Place>,
        /// Name of the column, where the fault is in one column.
        column: Option<String>,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// The options of a fit contradict each other or the data.
    #[error("fit: {0}")]
    Fit(String),
    /// A step of the preparation cannot be done as told.
    #[error("preparation: {0}")]
    Preparation(String),
    /// No experiment follows from the options.
    #[error("design: {0}")]
    Design(String),
    /// A thermal body cannot be run or identified.
    #[error("thermal body: {0}")]
    Thermal(String),
    /// A controller cannot be made as told.
    #[error("controller: {0}")]
    Control(String),
    /// A scenario says something that cannot be.
    #[error("scenario{}{}: `{field}`: {problem}", place(.path), at(line.map(Place::Line), &None))]
    Scenario {
        /// The file, where there is one.
        path: Option<PathBuf>,
        /// The line of its text, where that is known.
        line: Option<u64>,
        /// The field; `.` for the whole.
        field: String,
        /// What is wrong with it, and what is expected.
        problem: String,
    },
    /// A model cannot be carried to where it should run.
    #[error("export: {0}")]
    Export(String),
    /// A filter's arguments do not fit the data.
    #[error(transparent)]
    Filter(#[from] crate::series::filter::FilterError),
    /// A plant was asked for something that it cannot do.
    #[error(transparent)]
    Plant(Box<dyn std::error::Error + Send + Sync>),
    /// Another error, and what helps against it; [`Error::parts`] takes them apart.
    #[error("{error}: {remedy}")]
    Remedied {
        /// What is wrong, and where.
        error: Box<Error>,
        /// What to do.
        remedy: Remedy,
    },
}

impl Error {
    /// A number for each kind of error that never changes; those of the core are below 20.
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
            Error::Remedied { error, .. } => error.code(),
        }
    }

    /// What is wrong, and what helps where that is known: for a surface that spells options in its
    /// own way.
    #[must_use]
    pub fn parts(&self) -> (&Error, Option<&Remedy>) {
        match self {
            Error::Remedied { error, remedy } => (error, Some(remedy)),
            error => (error, None),
        }
    }

    /// This error with what helps against it.
    #[must_use]
    pub fn remedied(self, remedy: Remedy) -> Self {
        let error = Box::new(self);
        Error::Remedied { error, remedy }
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
