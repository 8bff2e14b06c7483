//! Where a result goes, and what it may replace there.

use crate::error::{Error, Result};
use std::fs::{File, Metadata};
use std::io::{self, BufReader, Read};
use std::path::Path;
use std::time::SystemTime;

/// How a file that is there is known to be a result of ours of one kind, unchanged as far as that
/// can be told.
#[derive(Debug, Clone, Copy)]
pub enum Own {
    /// Every result of this kind carries a mark, which the function looks for.
    Marked(fn(&Path) -> io::Result<bool>),
    /// Some carry none. A file without a mark is ours where it holds the bytes that are to be
    /// written.
    Unmarked(fn(&Path) -> io::Result<bool>),
}

impl Own {
    /// Results that never carry a mark.
    pub const SAME_BYTES: Self = Self::Unmarked(|_| Ok(false));
}

/// A place for a result, with what it may replace.
///
/// A path alone, as in `Destination::from(path)`, replaces whatever file is there, as a call of a
/// library that names a file does.
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
    /// A place whose file is replaced only where it is a result of ours, or with `force` whatever
    /// it is.
    #[must_use]
    pub fn keeping_foreign(path: &'a Path, force: bool) -> Self {
        Self {
            keep_foreign: !force,
            ..Self::from(path)
        }
    }

    /// The files that are read. None of them is replaced, whatever its name here; `-` is standard
    /// input.
    #[must_use]
    pub fn made_from(self, inputs: &'a [&'a Path]) -> Self {
        Self { inputs, ..self }
    }

    /// The path, as it was given.
    #[must_use]
    pub fn path(&self) -> &'a Path {
        self.path
    }

    pub(super) fn inputs(&self) -> &'a [&'a Path] {
        self.inputs
    }

    pub(super) fn keeps_foreign(&self) -> bool {
        self.keep_foreign
    }

    /// Refuses a place that can be seen to be wrong before any work: one of the inputs, or a file
    /// that is not replaced.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(super) fn claim(&self, own: Own) -> Result<Claim> {
        self.try_claim(own).map_err(|source| Error::File {
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

pub(super) const FOREIGN: &str = "this file is not a result of hysteron, or it was changed since";

/// A refusal to replace something. Its kind tells it from other faults, so that a surface can say
/// how to insist.
pub(super) fn foreign(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::AlreadyExists, what)
}

/// Whether two paths lead to one regular file. What is no file, such as a pipe, is not opened.
fn is_same(input: &Path, there: &Path) -> io::Result<bool> {
    if input == Path::new("-") {
        return Ok(same_file::Handle::stdin()? == same_file::Handle::from_path(there)?);
    }
    match std::fs::metadata(input) {
        Ok(about) if about.is_file() => same_file::is_same_file(input, there),
        _ => Ok(false),
    }
}

/// Refuses two results that would be one file.
///
/// # Errors
/// [`Error::File`] with the second path.
pub fn refuse_one_file(first: &Path, second: &Path) -> Result<()> {
    let name = |path: &Path| {
        let name = path
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        // Where names differ in nothing but case, these systems mean one file.
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
        true => Err(Error::File {
            path: second.to_owned(),
            source: io::Error::other("two results would be this one file: name another one"),
        }),
    }
}

/// The folder that a path is in.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// What stood at a place when it was claimed, and so what may be replaced when the result is whole.
#[derive(Debug, Clone, Copy)]
pub(super) enum Claim {
    /// There was nothing.
    Nothing,
    /// A result of ours.
    Ours(Stamp),
    /// A file that only the same bytes replace.
    Same,
    /// Anything may be replaced, or it is no regular file.
    Whatever,
}

impl Claim {
    /// Whether `new` may take the place now; what stands there may have changed since it was
    /// claimed.
    pub(super) fn holds(self, new: &Path, place: &Path) -> io::Result<()> {
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

/// Changes with every change of a file, but for one that keeps its length and time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp(u64, Option<SystemTime>);

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
