//! The files of a fleet, and the actuator that a file is named after.

use crate::error::{Error, Result};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Endings of the tables that are taken from a folder.
const TABLES: [&str; 9] = [
    "csv", "txt", "dat", "tsv", "parquet", "arrow", "arrows", "feather", "mat",
];

/// A table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Source {
    pub(super) path: PathBuf,
    /// The file's name without its ending, with the folders below the one that was named.
    pub(super) name: String,
    pub(super) bytes: u64,
}

/// The tables among files and folders. Those of a folder are in the order of their names; hidden
/// ones, those that begin with `_`, and the file `except` are left out.
///
/// # Errors
/// [`Error::File`] for a path that is not there, and for a folder without tables.
pub(super) fn find(data: &[PathBuf], except: &Path) -> Result<Vec<Source>> {
    let except = except.canonicalize().ok();
    let mut sources = Vec::new();
    for path in data {
        let failed = |source| Error::File {
            path: path.clone(),
            source,
        };
        let about = fs::metadata(path).map_err(failed)?;
        if !about.is_dir() {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            sources.push(Source {
                path: path.clone(),
                name: name.into_owned(),
                bytes: about.len(),
            });
            continue;
        }
        let before = sources.len();
        walk(path, "", except.as_deref(), &mut sources).map_err(failed)?;
        if sources.len() == before {
            let endings = TABLES.join(", ");
            let text = format!("there is no table in this folder: {endings} are looked for");
            return Err(failed(io::Error::other(text)));
        }
    }
    Ok(sources)
}

fn walk(
    folder: &Path,
    above: &str,
    except: Option<&Path>,
    sources: &mut Vec<Source>,
) -> io::Result<()> {
    let entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
    let mut entries: Vec<_> = entries
        .into_iter()
        .map(|entry| (entry.file_name(), entry.path()))
        .collect();
    entries.sort();
    for (name, path) in entries {
        let text = name.to_string_lossy();
        if text.starts_with(['.', '_']) {
            continue;
        }
        let about = fs::metadata(&path)?;
        if about.is_dir() {
            walk(&path, &format!("{above}{text}/"), except, sources)?;
            continue;
        }
        let ending = path.extension().map(|ending| ending.to_string_lossy());
        let is_table =
            ending.is_some_and(|ending| TABLES.iter().any(|t| ending.eq_ignore_ascii_case(t)));
        let is_result = || except.is_some() && path.canonicalize().ok().as_deref() == except;
        if is_table && !is_result() {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            sources.push(Source {
                name: format!("{above}{stem}"),
                bytes: about.len(),
                path,
            });
        }
    }
    Ok(())
}
