//! Moves files and folders to their places, one after the other, so that all moves can be undone.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The moves done so far.
pub(crate) struct Moves {
    /// The folder where old files are kept until all moves are done.
    aside: PathBuf,
    done: Vec<Move>,
}

enum Move {
    /// A new file or folder was moved to a free place.
    Placed { from: PathBuf, to: PathBuf },
    /// Two folders were exchanged.
    Exchanged { one: PathBuf, other: PathBuf },
    /// The old file of a place was stored in `kept`.
    Replaced { kept: PathBuf, place: PathBuf },
}

impl Moves {
    /// Creates the folder `aside`, where old files will be kept.
    pub(crate) fn new(aside: PathBuf) -> io::Result<Self> {
        fs::create_dir(&aside)?;
        Ok(Self {
            aside,
            done: Vec::new(),
        })
    }

    /// Moves a file or folder to a free place.
    pub(crate) fn place(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)?;
        self.done.push(Move::Placed {
            from: from.to_owned(),
            to: to.to_owned(),
        });
        Ok(())
    }

    /// Exchanges two folders in a single step. Fails if the system cannot do this.
    pub(crate) fn exchange(&mut self, one: &Path, other: &Path) -> io::Result<()> {
        exchange(one, other)?;
        self.done.push(Move::Exchanged {
            one: one.to_owned(),
            other: other.to_owned(),
        });
        Ok(())
    }

    /// Replaces a file by another in a single step.
    pub(crate) fn replace(&mut self, new: &Path, place: &Path) -> io::Result<()> {
        self.keep(place)?;
        fs::rename(new, place)
    }

    /// Removes a file, which is kept aside.
    pub(crate) fn remove(&mut self, place: &Path) -> io::Result<()> {
        self.keep(place)?;
        fs::remove_file(place)
    }

    /// Keeps the old file aside, by a second name (hard link) or as a copy.
    fn keep(&mut self, place: &Path) -> io::Result<()> {
        let kept = self.aside.join(self.done.len().to_string());
        if fs::hard_link(place, &kept).is_err() {
            fs::copy(place, &kept)?;
        }
        self.done.push(Move::Replaced {
            kept,
            place: place.to_owned(),
        });
        Ok(())
    }

    /// Undoes all moves, the last one first.
    pub(crate) fn undo(self) {
        for done in self.done.into_iter().rev() {
            // Ignore errors here: the error that caused the undo is the one to report.
            let _ = match done {
                Move::Placed { from, to } => fs::rename(to, from),
                Move::Exchanged { one, other } => exchange(&one, &other),
                Move::Replaced { kept, place } => fs::rename(kept, place),
            };
        }
    }
}

#[cfg(any(target_os = "linux", target_os = "macos"))]
fn exchange(one: &Path, other: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_os = "linux", target_os = "macos")))]
fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}
