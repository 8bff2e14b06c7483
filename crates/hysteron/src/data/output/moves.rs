//! Files and folders taking their places, one after the other, so that all of it can be undone.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// What was moved so far.
pub(super) struct Moves {
    /// Where the old files are kept until all is done.
    aside: PathBuf,
    done: Vec<Move>,
}

enum Move {
    /// A new file or folder took a place where nothing was.
    Placed { from: PathBuf, to: PathBuf },
    /// Two folders changed places.
    Exchanged { one: PathBuf, other: PathBuf },
    /// The old file of a place is kept aside.
    Replaced { kept: PathBuf, place: PathBuf },
}

impl Moves {
    /// Old files will be kept in the folder `aside`, which is made.
    pub(super) fn new(aside: PathBuf) -> io::Result<Self> {
        fs::create_dir(&aside)?;
        Ok(Self {
            aside,
            done: Vec::new(),
        })
    }

    /// Moves a file or folder to where nothing is.
    pub(super) fn place(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)?;
        self.done.push(Move::Placed {
            from: from.to_owned(),
            to: to.to_owned(),
        });
        Ok(())
    }

    /// Puts one folder in the place of another, at once; fails where the system cannot.
    pub(super) fn exchange(&mut self, one: &Path, other: &Path) -> io::Result<()> {
        exchange(one, other)?;
        self.done.push(Move::Exchanged {
            one: one.to_owned(),
            other: other.to_owned(),
        });
        Ok(())
    }

    /// Replaces a file by another, at once.
    pub(super) fn replace(&mut self, new: &Path, place: &Path) -> io::Result<()> {
        self.keep(place)?;
        fs::rename(new, place)
    }

    /// Takes a file away.
    pub(super) fn remove(&mut self, place: &Path) -> io::Result<()> {
        self.keep(place)?;
        fs::remove_file(place)
    }

    /// Gives a file a second name, or a copy, aside.
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

    /// Brings everything back to where it was, the last first.
    pub(super) fn undo(self) {
        for done in self.done.into_iter().rev() {
            // The fault that led here is the one to be told of.
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
