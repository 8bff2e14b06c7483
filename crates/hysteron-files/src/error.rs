//! The error of this crate.

use std::io;
use std::path::{Path, PathBuf};

/// A result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// A file that cannot be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {source}", path.display())]
pub struct Error {
    /// The file.
    pub path: PathBuf,
    /// What the operating system reported. Its kind is [`io::ErrorKind::AlreadyExists`] if an
    /// existing file is not ours and is kept.
    pub source: io::Error,
}

/// An error that may be one of a file.
pub trait OfFile: From<Error> {
    /// The same error; one of a file is that of the file at `path`.
    #[must_use]
    fn placed(self, path: &Path) -> Self;
}

impl OfFile for Error {
    fn placed(self, path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            ..self
        }
    }
}
