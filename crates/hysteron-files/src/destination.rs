//! The destination of a result, and the files that it may replace.

use crate::error::{Error, Result};
use std::fs::{File, Metadata};
use std::io::{self, BufReader, Read};
use std::path::Path;
use std::time::SystemTime;

/// How to recognise that an existing file is ours: a result of hysteron that nobody has changed.
#[derive(Debug, Clone, Copy)]
pub enum Own {
    /// Every result of this kind carries a mark. The function looks for it.
    Marked(fn(&Path) -> io::Result<bool>),
    /// Some results of this kind carry no mark. A file without a mark counts as ours if it already
    /// holds the bytes to be written.
    Unmarked(fn(&Path) -> io::Result<bool>),
}

impl Own {
    /// For results that never carry a mark.
    pub const SAME_BYTES: Self = Self::Unmarked(|_| Ok(false));
}

/// The path of a result, and the rules for replacing a file there.
///
/// A path alone, as in `Destination::from(path)`, replaces any existing file. This is the usual
/// behaviour of library functions that take a path.
#[derive(Debug, Clone, Copy)]
pub struct Destination<'a> {
    path: &'a Path,
    inputs: &'a [&'a Path],
    keep_foreign: bool,
}

impl<'a, P: AsRef<Path> + ?Sized> From<&'a P> for Destination<'a> {
    fn from(path: &'a P) -> Self {
        Self {
            path: path.as_ref(),
            inputs: &[],
            keep_foreign: false,
        }
    }
}

impl<'a> Destination<'a> {
    /// A path where only a result of ours is replaced, or any file with `force`.
    #[must_use]
    pub fn keeping_foreign(path: &'a Path, force: bool) -> Self {
        Self {
            keep_foreign: !force,
            ..Self::from(path)
        }
    }

    /// Names the files that the result is computed from. None of them is replaced, even if `path`
    /// reaches it under another name. `-` is standard input.
    #[must_use]
    pub fn made_from(self, inputs: &'a [&'a Path]) -> Self {
        Self { inputs, ..self }
    }

    /// The path as given.
    #[must_use]
    pub fn path(&self) -> &'a Path {
        self.path
    }

    pub(crate) fn inputs(&self) -> &'a [&'a Path] {
        self.inputs
    }

    pub(crate) fn keeps_foreign(&self) -> bool {
        self.keep_foreign
    }

    /// Refuses a wrong destination before any work is done: one of the inputs, or a file that must
    /// be kept.
    ///
    /// # Errors
    /// [`Error`].
    pub(crate) fn claim(&self, own: Own) -> Result<Claim> {
        self.try_claim(own).map_err(|source| Error {
            path: self.path.to_owned(),
            source,
        })
    }

    fn try_claim(&self, own: Own) -> io::Result<Claim> {
        let there = match std::fs::metadata(self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Claim::Nothing),
            there => there?,
        };
        if !there.is_file() {
            return Ok(Claim::Whatever);
        }
        for input in self.inputs {
            if is_same(input, self.path)? {
                return Err(io::Error::other(
                    "this would replace a file that is read: name another one",
                ));
            }
        }
        if !self.keep_foreign {
            return Ok(Claim::Whatever);
        }
        if there.permissions().readonly() {
            return Err(foreign("this file must not be written to"));
        }
        match own {
            Own::Marked(is_ours) | Own::Unmarked(is_ours) if is_ours(self.path)? => {
                Ok(Claim::Ours(Stamp::of(&there)))
            }
            Own::Unmarked(_) => Ok(Claim::Same),
            Own::Marked(_) => Err(foreign(FOREIGN)),
        }
    }
}

pub(crate) const FOREIGN: &str = "this file is not a result of hysteron, or it was changed since";

/// The error for a file that must be kept. Its kind differs from other errors, so that a surface
/// can explain how to force it.
pub(crate) fn foreign(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::AlreadyExists, what)
}

/// Whether two paths lead to the same regular file. Anything else, such as a pipe, is not opened.
fn is_same(input: &Path, there: &Path) -> io::Result<bool> {
    if input == Path::new("-") {
        return Ok(same_file::Handle::stdin()? == same_file::Handle::from_path(there)?);
    }
    match std::fs::metadata(input) {
        Ok(about) if about.is_file() => same_file::is_same_file(input, there),
        _ => Ok(false),
    }
}

/// Refuses two results with the same path.
///
/// # Errors
/// [`Error`] with the second path.
pub fn refuse_one_file(first: &Path, second: &Path) -> Result<()> {
    let name = |path: &Path| {
        let name = path
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        // On these systems, names that differ only in case mean the same file.
        name.map(|name| match cfg!(any(windows, target_os = "macos")) {
            true => name.to_lowercase(),
            false => name,
        })
    };
    let regular = |path: &Path| path.metadata().map_or(true, |about| about.is_file());
    let one = regular(first)
        && regular(second)
        && (same_file::is_same_file(first, second).unwrap_or(false)
            || name(first) == name(second)
                && same_file::is_same_file(folder_of(first), folder_of(second)).unwrap_or(false));
    match one {
        false => Ok(()),
        true => Err(Error {
            path: second.to_owned(),
            source: io::Error::other("two results would be this one file: name another one"),
        }),
    }
}

/// The folder that contains a path.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// What was at the destination when the work began. It decides what may be replaced when the result
/// is complete.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Claim {
    /// There was no file.
    Nothing,
    /// There was a result of ours.
    Ours(Stamp),
    /// There was a file that may be replaced by the same bytes only.
    Same,
    /// Anything may be replaced, or the destination is not a regular file.
    Whatever,
}

impl Claim {
    /// Checks that `new` may take the place now. The file there may have changed since the work
    /// began.
    pub(crate) fn holds(self, new: &Path, place: &Path) -> io::Result<()> {
        let holds = match self {
            Self::Whatever => true,
            Self::Nothing => std::fs::symlink_metadata(place).is_err(),
            Self::Ours(stamp) => match std::fs::metadata(place) {
                Ok(there) => Stamp::of(&there) == stamp,
                Err(error) => error.kind() == io::ErrorKind::NotFound,
            },
            Self::Same => has_same_bytes(new, place)?,
        };
        match holds {
            true => Ok(()),
            false => Err(foreign(FOREIGN)),
        }
    }
}

/// Identifies the state of a file. It changes with every modification that changes the length or
/// the time of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Stamp(u64, Option<SystemTime>);

impl Stamp {
    fn of(file: &Metadata) -> Self {
        Self(file.len(), file.modified().ok())
    }
}

fn has_same_bytes(one: &Path, other: &Path) -> io::Result<bool> {
    let (one, other) = (File::open(one)?, File::open(other)?);
    if one.metadata()?.len() != other.metadata()?.len() {
        return Ok(false);
    }
    let mut others = BufReader::new(other).bytes();
    for byte in BufReader::new(one).bytes() {
        if others.next().transpose()? != Some(byte?) {
            return Ok(false);
        }
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn bytes_are_compared_to_the_last() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            path
        };
        let long = vec![7; 100_000];
        let one = at("one", &long);
        assert!(has_same_bytes(&one, &at("same", &long)).unwrap());
        assert!(!has_same_bytes(&one, &at("shorter", &long[1..])).unwrap());
        for n in [0, 65_536, 99_999] {
            let mut other = long.clone();
            other[n] = 8;
            assert!(!has_same_bytes(&one, &at("other", &other)).unwrap());
        }
    }
}
