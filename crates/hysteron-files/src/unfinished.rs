//! Temporary files and folders, in which results are written until they are complete.
//!
//! Each has a unique name, and a lock while it is being written. One without a lock was left by a
//! program that was killed. The next program that writes to the same folder removes it.

use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::{NamedTempFile, TempDir};

const PREFIX: &str = ".hysteron-";
const SUFFIX: &str = ".part";
/// Number of random letters and digits between prefix and suffix.
const RANDOM: usize = 12;
/// The file in a temporary folder whose lock protects the whole folder.
const LOCK: &str = "lock";
/// Number of attempts. Another program may remove a new file before it is locked.
const ATTEMPTS: usize = 100;

static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The list of temporary files. While it is held, [`discard_unfinished`] waits.
pub(crate) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    // The list is valid even if a thread panicked while it held the lock.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every temporary file and folder of this process. For a program that is told to end.
pub fn discard_unfinished() {
    for path in unfinished().drain(..) {
        // A file that cannot be removed must not keep the program from ending.
        let _ = match path.is_dir() {
            true => empty(&path).and_then(|()| fs::remove_dir_all(&path)),
            false => fs::remove_file(&path),
        };
    }
}

/// Removes a path from the list, because it got its final name or was removed.
pub(crate) fn finished(path: &Path) {
    unfinished().retain(|other| other != path);
}

/// A new temporary file in `folder`, with the given permissions or the default ones.
pub(crate) fn file_in(folder: &Path, like: Option<fs::Permissions>) -> io::Result<NamedTempFile> {
    sweep(folder);
    let mut builder = builder();
    // The default of new files, not the private mode of temporary files.
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

/// A new temporary folder inside another, to prepare results in.
pub(crate) struct Workshop {
    folder: TempDir,
    _lock: File,
}

impl Workshop {
    pub(crate) fn create_in(folder: &Path) -> io::Result<Self> {
        sweep(folder);
        #[cfg_attr(not(unix), expect(unused_mut))]
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

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }
}

impl Drop for Workshop {
    fn drop(&mut self) {
        // The next program removes what cannot be removed now.
        let _ = empty(self.folder.path());
        finished(self.folder.path());
    }
}

/// Removes everything in a folder, the lock last. If the removal itself is killed, another program
/// can continue it.
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

/// The error without the temporary path, which means nothing to the user.
pub fn bare(error: io::Error) -> io::Error {
    error.kind().into()
}

fn taken_away() -> io::Error {
    io::Error::other("other programs keep removing the temporary files of this one: try again")
}

/// Locks a new file. Returns false if another program has taken it for a leftover and removed it.
fn is_held(file: &File, path: &Path) -> bool {
    match file.try_lock() {
        Ok(()) => path.exists(),
        Err(TryLockError::WouldBlock) => false,
        // Without locks no other program removes anything either.
        Err(TryLockError::Error(_)) => true,
    }
}

/// Removes the leftovers of killed programs from a folder.
fn sweep(folder: &Path) {
    // Ignore what cannot be read or removed: it is hidden, and another program may remove it later.
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
    // Only if it is empty: a new folder has no lock yet.
    fs::remove_dir(path)
}

/// Opens and locks a file whose lock nobody holds.
fn left_behind(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    file.try_lock()
        .map_err(|_| io::Error::from(io::ErrorKind::WouldBlock))?;
    Ok(file)
}

/// Tests the whole pattern, because a hidden file of the user may begin in the same way.
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
