//! Files and folders that are written beside their places.
//!
//! Each has a name that nothing else has, and a lock while it is being written. One without a lock
//! was left by a run that was killed, and the next run that writes there removes it.

use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::{NamedTempFile, TempDir};

const PREFIX: &str = ".hysteron-";
const SUFFIX: &str = ".part";
/// Random letters and digits between the two.
const RANDOM: usize = 12;
/// In a folder, the file whose lock counts for all of it.
const LOCK: &str = "lock";
/// How often another run may take what was just begun for left behind.
const ATTEMPTS: usize = 100;

static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// What is being written now. Whoever holds it keeps [`discard_unfinished`] waiting.
pub(super) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of paths is whole whatever a thread that held it was doing.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every file and folder that is still being written, for a program that is told to end.
pub fn discard_unfinished() {
    for path in unfinished().drain(..) {
        // One that cannot be removed is no reason not to end.
        let _ = match path.is_dir() {
            true => empty(&path).and_then(|()| fs::remove_dir_all(&path)),
            false => fs::remove_file(&path),
        };
    }
}

/// Takes a path off the list, because it was given its name or removed.
pub(super) fn finished(path: &Path) {
    unfinished().retain(|other| other != path);
}

/// A new file in `folder`, with these permissions or those of any new file.
pub(super) fn file_in(folder: &Path, like: Option<fs::Permissions>) -> io::Result<NamedTempFile> {
    sweep(folder);
    let mut builder = builder();
    // As a plain new file would have, not the private mode of temporary ones.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    if let Some(permissions) = like {
        builder.permissions(permissions);
    }
    for _ in 0..ATTEMPTS {
        let file = builder.tempfile_in(folder).map_err(bare)?;
        if is_held(file.as_file(), file.path()) {
            unfinished().push(file.path().to_owned());
            return Ok(file);
        }
    }
    Err(taken_away())
}

/// A new folder in another, to prepare in.
pub(super) struct Workshop {
    folder: TempDir,
    _lock: File,
}

impl Workshop {
    pub(super) fn create_in(folder: &Path) -> io::Result<Self> {
        sweep(folder);
        let mut builder = builder();
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        for _ in 0..ATTEMPTS {
            let made = builder.tempdir_in(folder).map_err(bare)?;
            let path = made.path().join(LOCK);
            match File::create_new(&path) {
                Ok(lock) if is_held(&lock, &path) => {
                    unfinished().push(made.path().to_owned());
                    return Ok(Self {
                        folder: made,
                        _lock: lock,
                    });
                }
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        Err(taken_away())
    }

    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }
}

impl Drop for Workshop {
    fn drop(&mut self) {
        // What cannot be removed now is left to the next run.
        let _ = empty(self.folder.path());
        finished(self.folder.path());
    }
}

/// Removes all but the lock of a folder. The lock goes last, so that a removal that is itself
/// killed can be taken up again.
fn empty(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)?.flatten() {
        match entry.file_type()?.is_dir() {
            true => fs::remove_dir_all(entry.path())?,
            false if entry.file_name() == LOCK => {}
            false => fs::remove_file(entry.path())?,
        }
    }
    Ok(())
}

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX).rand_bytes(RANDOM);
    builder
}

/// An error without the name of what is beside, which says nothing to anyone.
pub(super) fn bare(error: io::Error) -> io::Error {
    error.kind().into()
}

fn taken_away() -> io::Error {
    io::Error::other("other runs keep removing what this one begins: try again")
}

/// Locks what was just made; false where another run took it for left behind in the meantime.
fn is_held(file: &File, path: &Path) -> bool {
    match file.try_lock() {
        Ok(()) => path.exists(),
        Err(TryLockError::WouldBlock) => false,
        // Without locks no other run removes anything either.
        Err(TryLockError::Error(_)) => true,
    }
}

/// Removes what runs that were killed left in a folder.
fn sweep(folder: &Path) {
    // What cannot be read or removed does no harm: it is hidden, and another run may remove it.
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| is_temporary(&entry.file_name())) {
        let path = entry.path();
        let _ = match entry.file_type() {
            Ok(kind) if kind.is_dir() => sweep_folder(&path),
            Ok(kind) if kind.is_file() => {
                left_behind(&path).and_then(|_lock| fs::remove_file(&path))
            }
            _ => Ok(()),
        };
    }
}

fn sweep_folder(path: &Path) -> io::Result<()> {
    let lock = path.join(LOCK);
    if lock.exists() {
        let _lock = left_behind(&lock)?;
        empty(path)?;
        fs::remove_file(&lock)?;
    }
    // Only where it is empty: one that was just made has no lock yet.
    fs::remove_dir(path)
}

/// A file whose lock nobody holds, locked.
fn left_behind(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    file.try_lock()
        .map_err(|_| io::Error::from(io::ErrorKind::WouldBlock))?;
    Ok(file)
}

/// The whole pattern counts: a user's own hidden file may begin in the same way.
fn is_temporary(name: &OsStr) -> bool {
    let random = name
        .to_str()
        .and_then(|name| name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX));
    random.is_some_and(|random| {
        random.len() == RANDOM && random.bytes().all(|byte| byte.is_ascii_alphanumeric())
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_lock_outlives_all_else_in_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(".hysteron-abcdefABCD12.part");
        fs::create_dir_all(path.join("new/deep")).unwrap();
        for name in ["a", "new/deep/file", LOCK, "z"] {
            fs::write(path.join(name), "").unwrap();
        }
        empty(&path).unwrap();
        let left = fs::read_dir(&path).unwrap();
        let left: Vec<_> = left.map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, [LOCK]);
        sweep(folder.path());
        assert!(!path.exists());
    }

    #[test]
    fn only_what_nobody_writes_is_swept() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let (file, workshop) = (
            file_in(folder.path(), None).unwrap(),
            Workshop::create_in(folder.path()).unwrap(),
        );
        fs::write(at(".hysteron-abcdefABCD12.part"), "left behind").unwrap();
        fs::create_dir_all(at(".hysteron-abcdefABCD34.part/new/deep")).unwrap();
        fs::write(at(".hysteron-abcdefABCD34.part/lock"), "").unwrap();
        fs::create_dir_all(at(".hysteron-abcdefABCD56.part")).unwrap();
        let foreign = [
            ".hysteron-notes",
            ".hysteron-abcdefABCD12",
            ".hysteron-abcdefABCD1.part",
            ".hysteron-abcdef-BCD12.part",
            "hysteron-abcdefABCD12.part",
        ];
        for name in foreign {
            fs::write(at(name), "foreign").unwrap();
        }
        sweep(folder.path());
        let mut names: Vec<PathBuf> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        names.sort();
        let mut expected: Vec<PathBuf> = foreign.map(at).to_vec();
        expected.extend([file.path().to_owned(), workshop.path().to_owned()]);
        expected.sort();
        assert_eq!(names, expected);
    }
}
