//! The files of a report: each appears complete or not at all.

use crate::error::ReportError;
use std::fs;
use std::io;
use std::path::Path;

pub(crate) fn make_directory(path: &Path) -> Result<(), ReportError> {
    fs::create_dir_all(path).map_err(|source| in_the_way(path, source))
}

pub(crate) fn write(path: &Path, content: &[u8]) -> Result<(), ReportError> {
    Ok(hysteron::AtomicFile::write_all(path, content)?)
}

/// Removes what an earlier report may have left.
pub(crate) fn remove_stale(path: &Path) -> Result<(), ReportError> {
    match fs::remove_file(path) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => Err(in_the_way(path, source)),
        _ => Ok(()),
    }
}

fn in_the_way(path: &Path, source: io::Error) -> ReportError {
    ReportError::Write(hysteron::Error::File {
        path: path.to_owned(),
        source,
    })
}
