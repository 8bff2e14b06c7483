//! Files written whole or not at all, and tables written row by row.

use crate::table::Row;
use crate::{Error, Result};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Files being written beside their places.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of paths is whole whatever a thread that held it was doing.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every file that is still being written, for a program that is told to end.
pub fn discard_unfinished() {
    for path in unfinished().drain(..) {
        // One that cannot be removed is no reason not to end.
        let _ = std::fs::remove_file(path);
    }
}

/// A file that is written beside its place and takes its name when it is whole; dropped before, it leaves nothing.
///
/// A link is followed, and refused where it leads to no file; what is no regular file, such as a pipe or `/dev/null`, is written to as it is.
pub struct AtomicFile {
    path: PathBuf,
    to: Place,
}

enum Place {
    Beside(tempfile::NamedTempFile),
    There(File),
}

impl AtomicFile {
    /// Starts a file that will be at `path`.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn create(path: &Path) -> Result<Self> {
        let place = Self::place(path);
        let (path, to) = place.map_err(|source| Error::File {
            path: path.to_owned(),
            source,
        })?;
        Ok(Self { path, to })
    }

    fn place(path: &Path) -> std::io::Result<(PathBuf, Place)> {
        let path = match std::fs::metadata(path) {
            Ok(there) if there.is_dir() => return Err(std::io::Error::other("this is a folder")),
            Ok(there) if !there.is_file() => {
                let file = File::options().write(true).open(path)?;
                return Ok((path.to_owned(), Place::There(file)));
            }
            Ok(_) => path.canonicalize()?,
            Err(_) if path.is_symlink() => {
                return Err(std::io::Error::other(
                    "this is a link that leads to no file",
                ));
            }
            Err(_) => path.to_owned(),
        };
        let before = std::fs::metadata(&path).map(|there| there.permissions());
        let folder = match path.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        // As a plain new file would have, not the private mode of temporary ones.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        if let Ok(permissions) = before {
            builder.permissions(permissions);
        }
        let beside =
            builder
                .prefix(".hysteron-")
                .tempfile_in(folder)
                .map_err(|error| match error.kind() {
                    std::io::ErrorKind::NotFound => {
                        let text = format!("there is no folder {} to write to", folder.display());
                        std::io::Error::new(error.kind(), text)
                    }
                    // Without the name of the file beside, which says nothing to anyone.
                    kind => kind.into(),
                })?;
        unfinished().push(beside.path().to_owned());
        Ok((path, Place::Beside(beside)))
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn commit(self) -> Result<()> {
        let path = self.path;
        let kept = match self.to {
            Place::There(_) => Ok(()),
            Place::Beside(beside) => {
                unfinished().retain(|other| other != beside.path());
                match beside.persist(&path) {
                    Ok(_) => Ok(()),
                    Err(error) => Err(error.error),
                }
            }
        };
        kept.map_err(|source| Error::File { path, source })
    }

    /// Writes a whole file at once.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write_all(path: &Path, bytes: &[u8]) -> Result<()> {
        let mut file = Self::create(path)?;
        let written = Write::write_all(&mut file, bytes).and_then(|()| file.flush());
        written.map_err(|source| Error::File {
            path: path.to_owned(),
            source,
        })?;
        file.commit()
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match &mut self.to {
            Place::Beside(file) => file.write(bytes),
            Place::There(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match &mut self.to {
            Place::Beside(file) => file.flush(),
            Place::There(file) => file.flush(),
        }
    }
}

/// Writes a CSV table, to standard output or to a file that appears only when it is whole.
pub struct TableWriter {
    path: PathBuf,
    csv: csv::Writer<Sink>,
}

enum Sink {
    Stdout(BufWriter<std::io::Stdout>),
    Beside(BufWriter<AtomicFile>),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match self {
            Sink::Stdout(out) => out.write(bytes),
            Sink::Beside(out) => out.write(bytes),
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match self {
            Sink::Stdout(out) => out.flush(),
            Sink::Beside(out) => out.flush(),
        }
    }
}

impl TableWriter {
    /// A table to `path`, or to standard output without one or with `-`.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn create(path: Option<&Path>) -> Result<Self> {
        let path = path.filter(|path| *path != Path::new("-"));
        let sink = match path {
            None => Sink::Stdout(BufWriter::new(std::io::stdout())),
            Some(path) => Sink::Beside(BufWriter::new(AtomicFile::create(path)?)),
        };
        Ok(Self {
            path: path.unwrap_or(Path::new("standard output")).to_owned(),
            csv: csv::WriterBuilder::new().flexible(true).from_writer(sink),
        })
    }

    /// Writes a row as it was read, and further cells after it.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn extend_row(&mut self, row: &Row, cells: &[&str]) -> Result<()> {
        let cells = cells.iter().map(|cell| cell.as_bytes());
        self.write(row.cells().chain(cells))
    }

    /// Writes a row of cells.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn row<C: AsRef<[u8]>>(&mut self, cells: impl IntoIterator<Item = C>) -> Result<()> {
        self.write(cells.into_iter())
    }

    fn write<C: AsRef<[u8]>>(&mut self, cells: impl Iterator<Item = C>) -> Result<()> {
        let written = self.csv.write_record(cells);
        written.map_err(|error| Error::File {
            path: self.path.clone(),
            source: match error.into_kind() {
                csv::ErrorKind::Io(source) => source,
                other => std::io::Error::other(format!("{other:?}")),
            },
        })
    }

    /// Ends the table; a file takes its name now.
    ///
    /// # Errors
    /// [`Error::File`], the system's.
    pub fn finish(self) -> Result<()> {
        let path = self.path;
        let written = |source| Error::File {
            path: path.clone(),
            source,
        };
        match self.csv.into_inner().map_err(|e| written(e.into_error()))? {
            Sink::Stdout(mut out) => out.flush().map_err(written),
            Sink::Beside(out) => match out.into_inner() {
                Ok(file) => file.commit(),
                Err(error) => Err(written(error.into_error())),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_folder_that_is_missing_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing");
        let error = AtomicFile::write_all(&missing.join("a"), b"a").unwrap_err();
        let expected = format!("there is no folder {}", missing.display());
        assert!(error.to_string().contains(&expected), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_nothing_stays_one() {
        let folder = tempfile::tempdir().unwrap();
        let (link, target) = (folder.path().join("link"), folder.path().join("target"));
        std::os::unix::fs::symlink(&target, &link).unwrap();
        assert!(AtomicFile::write_all(&link, b"a").is_err());
        assert!(link.is_symlink());
        std::fs::write(&target, b"b").unwrap();
        AtomicFile::write_all(&link, b"a").unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&target).unwrap(), b"a");
    }
}
