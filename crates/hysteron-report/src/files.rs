//! Files that appear complete or not at all.

use crate::error::ReportError;
use std::ffi::OsString;
use std::path::Path;
use std::{fs, io};

pub(crate) fn make_directory(dir: &Path) -> Result<(), ReportError> {
    fs::create_dir_all(dir).map_err(|source| ReportError::Write {
        path: dir.to_owned(),
        source,
    })
}

/// Writes beside `path`, then renames over it.
pub(crate) fn write(path: &Path, contents: &[u8]) -> Result<(), ReportError> {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.part", std::process::id()));
    let part = path.with_file_name(name);
    fs::write(&part, contents)
        .and_then(|()| fs::rename(&part, path))
        .map_err(|source| {
            // Whatever is left of the part is of no use; that it may not be removable is secondary to `source`.
            let _ = fs::remove_file(&part);
            ReportError::Write {
                path: path.to_owned(),
                source,
            }
        })
}

/// Removes a figure that an earlier report wrote and this one does not have.
pub(crate) fn remove_stale(path: &Path) -> Result<(), ReportError> {
    match fs::remove_file(path) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => Err(ReportError::Write {
            path: path.to_owned(),
            source,
        }),
        _ => Ok(()),
    }
}
