//! The errors of this crate.

use std::path::PathBuf;

/// A result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a run cannot begin. Once it has begun, it comes to an [`End`](crate::End).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A key of the file has a value that no run can have.
    #[error("{}{}: `{field}`: {problem}", path.display(), at(*.line))]
    Config {
        /// The file.
        path: PathBuf,
        /// The line, if it is known.
        line: Option<u64>,
        /// The key, as `limits.drive`; `.` for the whole file.
        field: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// The device cannot be reached, or is not what the file needs.
    #[error("device {name}: {problem}")]
    Device {
        /// The command, the port or the address.
        name: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// Somebody stopped it before the device had said who it is.
    #[error("stopped before the device had said who it is")]
    Stopped,
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] hysteron_files::Error),
    /// A file cannot be read, or the library refused a model, a table or a controller.
    #[error(transparent)]
    Hysteron(#[from] hysteron::Error),
}

/// An error about a file.
pub(crate) fn of_file(path: &std::path::Path, source: std::io::Error) -> Error {
    let path = path.to_owned();
    hysteron_files::Error { path, source }.into()
}

fn at(line: Option<u64>) -> String {
    line.map_or(String::new(), |line| format!(", line {line}"))
}
