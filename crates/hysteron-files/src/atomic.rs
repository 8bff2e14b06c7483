//! Files that appear complete or not at all.

use crate::destination::{Claim, Destination, Own, folder_of};
use crate::error::{Error, Result};
use crate::unfinished::{file_in, finished};
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A file that is written under a temporary name and gets its real name when it is complete. If it
/// is dropped before, nothing is left.
///
/// A link is followed; it is refused if it leads to no file. A target that is not a regular file,
/// such as a pipe or `/dev/null`, is written to directly. The data are flushed to the disk before
/// the file gets its name.
pub struct AtomicFile {
    /// The path as given, for error messages.
    path: PathBuf,
    to: Place,
}

enum Place {
    Beside(Beside),
    There(File),
}

struct Beside {
    file: NamedTempFile,
    /// The real path, after following links.
    place: PathBuf,
    claim: Claim,
}

impl AtomicFile {
    /// Opens a file for `target`. `own` decides whether an existing file is ours and may be
    /// replaced.
    ///
    /// # Errors
    /// [`Error`]. Its source has the kind [`io::ErrorKind::AlreadyExists`] if an existing
    /// file is not ours and is kept.
    pub fn create<'a>(target: impl Into<Destination<'a>>, own: Own) -> Result<Self> {
        let target = target.into();
        let claim = target.claim(own)?;
        let path = target.path().to_owned();
        match Self::place(&path, claim) {
            Ok(to) => Ok(Self { path, to }),
            Err(source) => Err(Error { path, source }),
        }
    }

    fn place(path: &Path, claim: Claim) -> io::Result<Place> {
        let place = match std::fs::metadata(path) {
            Ok(there) if there.is_dir() => return Err(io::Error::other("this is a folder")),
            Ok(there) if !there.is_file() => {
                let file = File::options().write(true).open(path)?;
                return Ok(Place::There(file));
            }
            Ok(_) => path.canonicalize()?,
            Err(_) if path.is_symlink() => {
                return Err(io::Error::other("this is a link that leads to no file"));
            }
            Err(_) => path.to_owned(),
        };
        let before = std::fs::metadata(&place).map(|there| there.permissions());
        let folder = folder_of(&place);
        let file = file_in(folder, before.ok()).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => {
                let text = format!("there is no folder {} to write to", folder.display());
                io::Error::new(error.kind(), text)
            }
            _ => error,
        })?;
        Ok(Place::Beside(Beside { file, place, claim }))
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// [`Error`].
    pub fn commit(self) -> Result<()> {
        let path = self.path;
        let kept = match self.to {
            Place::There(_) => Ok(()),
            Place::Beside(beside) => beside.keep(),
        };
        kept.map_err(|source| Error { path, source })
    }

    /// Writes the rest of the file and gives it its name.
    ///
    /// # Errors
    /// [`Error`].
    pub fn commit_with(mut self, bytes: &[u8]) -> Result<()> {
        match self.write_all(bytes).and_then(|()| self.flush()) {
            Ok(()) => self.commit(),
            Err(source) => Err(Error {
                path: self.path,
                source,
            }),
        }
    }
}

impl Beside {
    fn keep(self) -> io::Result<()> {
        let Self { file, place, claim } = self;
        let hidden = file.path().to_owned();
        let kept = file
            .as_file()
            .sync_all()
            .and_then(|()| claim.holds(&hidden, &place))
            .and_then(|()| Ok(file.persist(&place)?));
        finished(&hidden);
        kept?;
        sync_folder(folder_of(&place));
        Ok(())
    }
}

/// Flushes the names in a folder to the disk, on systems where this is possible.
///
/// The file already has its name at this point. So a file system that cannot do this is not an
/// error.
pub(crate) fn sync_folder(folder: &Path) {
    #[cfg(unix)]
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    #[cfg(not(unix))]
    let _ = folder;
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.to {
            Place::Beside(beside) => beside.file.as_file_mut().write(bytes),
            Place::There(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.to {
            Place::Beside(beside) => beside.file.as_file_mut().flush(),
            Place::There(file) => file.flush(),
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
        let error = AtomicFile::create(&missing.join("a"), Own::SAME_BYTES)
            .err()
            .unwrap();
        let expected = format!("there is no folder {}", missing.display());
        assert!(error.to_string().contains(&expected), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_nothing_stays_one() {
        let folder = tempfile::tempdir().unwrap();
        let (link, target) = (folder.path().join("link"), folder.path().join("target"));
        std::os::unix::fs::symlink(&target, &link).unwrap();
        assert!(AtomicFile::create(&link, Own::SAME_BYTES).is_err());
        assert!(link.is_symlink());
        std::fs::write(&target, b"b").unwrap();
        let file = AtomicFile::create(&link, Own::SAME_BYTES).unwrap();
        file.commit_with(b"a").unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&target).unwrap(), b"a");
    }
}
