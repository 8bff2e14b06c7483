//! Folders written whole or not at all.

use super::atomic::sync_folder;
use super::destination::{Destination, Own, folder_of, foreign};
use super::manifest::{self, Manifest};
use super::moves::Moves;
use super::unfinished::{Workshop, unfinished};
use super::{AtomicFile, destination};
use crate::error::{Error, Result};
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// In the workshop: what is new, and old files until all is done.
const NEW: &str = "new";
const OLD: &str = "old";

/// A folder whose files are written beside its place and appear together; dropped before, it leaves
/// nothing.
///
/// Files of others that are in the folder stay. One that is in the way is refused, unless the
/// target says otherwise. Where every file of the folder is ours, and it is not where the program
/// runs, the new folder takes the place of the old one at once. Otherwise one file after the other
/// does, and a fault brings the old ones back.
pub struct AtomicFolder {
    target: PathBuf,
    inputs: Vec<PathBuf>,
    keep_foreign: bool,
    own: Option<Own>,
    /// The folder, or the first above it that is missing, and what is missing below that one.
    place: PathBuf,
    below: PathBuf,
    workshop: Workshop,
    /// Relative to the folder.
    files: Vec<PathBuf>,
}

impl AtomicFolder {
    /// Starts a folder at `target`; folders above it are made with it. `own` tells which of the
    /// files there are ours. Without it, a list of digests that is written with the files does.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn create<'a>(target: impl Into<Destination<'a>>, own: Option<Own>) -> Result<Self> {
        let target = target.into();
        let path = target.path();
        Self::start(&target, own).map_err(|source| Error::File {
            path: path.to_owned(),
            source,
        })
    }

    fn start(target: &Destination<'_>, own: Option<Own>) -> io::Result<Self> {
        let path = target.path();
        let (place, below) = match fs::metadata(path) {
            Ok(there) if there.is_dir() => (path.canonicalize()?, PathBuf::new()),
            Ok(_) => return Err(io::Error::other("this is a file: name a folder")),
            Err(_) => first_missing(path),
        };
        let workshop = match place.exists() {
            false => Workshop::create_in(folder_of(&place))?,
            true => workshop_for(&place, own.is_none())?,
        };
        fs::create_dir_all(workshop.path().join(NEW).join(&below))?;
        Ok(Self {
            target: path.to_owned(),
            inputs: target
                .inputs()
                .iter()
                .map(|path| path.to_path_buf())
                .collect(),
            keep_foreign: target.keeps_foreign(),
            own,
            place,
            below,
            workshop,
            files: Vec::new(),
        })
    }

    /// Refuses files of these names before any work, where they would be refused in the end.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn claim<N: AsRef<Path>>(&self, names: impl IntoIterator<Item = N>) -> Result<()> {
        names
            .into_iter()
            .try_for_each(|name| self.check(name.as_ref()))
    }

    /// The folder's path, as it was given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.target
    }

    /// Has a file written, by a function that is told where.
    ///
    /// # Errors
    /// What the function returns, with the place that the file was to have; [`Error::File`].
    pub fn file<T>(
        &mut self,
        name: impl AsRef<Path>,
        write: impl FnOnce(&Path) -> Result<T>,
    ) -> Result<T> {
        let name = name.as_ref();
        let path = self.stage().join(name);
        let placed = |error| match error {
            Error::File { source, .. } => self.fault(name, source),
            other => other,
        };
        fs::create_dir_all(folder_of(&path)).map_err(|source| self.fault(name, source))?;
        let written = write(&path).map_err(placed)?;
        self.files.push(name.to_owned());
        Ok(written)
    }

    /// Gives the folder and its files their names. Files of ours that are not among the new ones
    /// are removed.
    ///
    /// # Errors
    /// [`Error::File`]; the folder is then as it was.
    pub fn commit(mut self) -> Result<()> {
        if self.own.is_none() {
            self.write_manifests()?;
        }
        self.claim(&self.files)?;
        let moved = self.take_places();
        moved.map_err(|source| self.fault(Path::new(""), source))
    }

    fn stage(&self) -> PathBuf {
        self.workshop.path().join(NEW).join(&self.below)
    }

    fn fault(&self, name: &Path, source: io::Error) -> Error {
        let path = match name == Path::new("") {
            true => self.target.clone(),
            false => self.target.join(name),
        };
        Error::File { path, source }
    }

    fn write_manifests(&mut self) -> Result<()> {
        let folders: BTreeSet<PathBuf> = self
            .files
            .iter()
            .filter_map(|name| name.parent())
            .map(Path::to_owned)
            .collect();
        for folder in folders {
            let mut manifest = Manifest::default();
            let stage = self.stage().join(&folder);
            let names = self
                .files
                .iter()
                .filter(|name| name.parent() == Some(&folder));
            for name in names.filter_map(|name| name.file_name()?.to_str()) {
                manifest
                    .add(&stage, name)
                    .map_err(|source| self.fault(&folder, source))?;
            }
            let text = manifest.text();
            self.file(folder.join(manifest::NAME), |path| {
                AtomicFile::create(path, Own::SAME_BYTES)?.commit_with(text.as_bytes())
            })?;
        }
        Ok(())
    }

    /// Refuses a file that would replace one of others.
    fn check(&self, name: &Path) -> Result<()> {
        let path = self.target.join(name);
        let refused = |source| self.fault(name, source);
        for folder in path.ancestors().skip(1).take(name.components().count()) {
            if folder.is_file() {
                let source = io::Error::other("this is a file, where a folder is needed");
                return Err(Error::File {
                    path: folder.to_owned(),
                    source,
                });
            }
        }
        let Ok(there) = fs::symlink_metadata(&path) else {
            return Ok(());
        };
        if there.is_dir() {
            return Err(refused(io::Error::other(
                "this is a folder, where a file is needed",
            )));
        }
        let inputs: Vec<&Path> = self.inputs.iter().map(PathBuf::as_path).collect();
        Destination::from(&path)
            .made_from(&inputs)
            .claim(Own::SAME_BYTES)?;
        match !self.keep_foreign || self.is_ours(&path).map_err(refused)? {
            true => Ok(()),
            false => Err(refused(foreign(destination::FOREIGN))),
        }
    }

    fn is_ours(&self, path: &Path) -> io::Result<bool> {
        match (self.own, path.file_name().and_then(|name| name.to_str())) {
            (Some(Own::Marked(is_ours) | Own::Unmarked(is_ours)), _) => is_ours(path),
            (None, Some(name)) => Manifest::read(folder_of(path)).owns(folder_of(path), name),
            (None, None) => Ok(false),
        }
    }

    fn take_places(&self) -> io::Result<()> {
        let new = self.workshop.path().join(NEW);
        sync_tree(&new)?;
        // A signal that ends the program waits until all have their places.
        let _unfinished = unfinished();
        let mut moves = Moves::new(self.workshop.path().join(OLD))?;
        if let Err(error) = self.put(&mut moves, &new, &self.place) {
            moves.undo();
            return Err(error);
        }
        sync_folder(&self.place);
        sync_folder(folder_of(&self.place));
        Ok(())
    }

    /// Puts a new file or folder in its place.
    fn put(&self, moves: &mut Moves, new: &Path, place: &Path) -> io::Result<()> {
        if fs::symlink_metadata(place).is_err() {
            return moves.place(new, place);
        }
        if !new.is_dir() {
            return moves.replace(new, place);
        }
        if self.own.is_none() && may_be_exchanged(place)? {
            fs::set_permissions(new, fs::metadata(place)?.permissions())?;
            if moves.exchange(new, place).is_ok() {
                return Ok(());
            }
        }
        let before = Manifest::read(place);
        for name in before.names().filter(|name| !new.join(name).exists()) {
            if before.owns(place, name).unwrap_or(false) {
                moves.remove(&place.join(name))?;
            }
        }
        for entry in fs::read_dir(new)? {
            let entry = entry?;
            self.put(moves, &entry.path(), &place.join(entry.file_name()))?;
        }
        Ok(())
    }
}

/// Beside a folder that may be exchanged for a new one, otherwise in it. In it as well where
/// nothing can be moved from one to the other, as where a disk is mounted here.
fn workshop_for(folder: &Path, listed: bool) -> io::Result<Workshop> {
    let exchanged = listed && may_be_exchanged(folder)?;
    let inside = Workshop::create_in(folder)?;
    fs::create_dir(inside.path().join(NEW))?;
    if exchanged
        && let Ok(beside) = Workshop::create_in(folder_of(folder))
        && fs::rename(inside.path().join(NEW), beside.path().join(NEW)).is_ok()
    {
        return Ok(beside);
    }
    Ok(inside)
}

/// The first folder on the way to `path` that is missing, and the rest of the way.
fn first_missing(path: &Path) -> (PathBuf, PathBuf) {
    let missing = path
        .ancestors()
        .take_while(|folder| **folder != *Path::new("") && !folder.exists());
    let first = missing.last().unwrap_or(path);
    let rest = path.strip_prefix(first).unwrap_or(Path::new(""));
    (first.to_owned(), rest.to_owned())
}

/// Whether another folder may take the place of this one: all in it is ours, and no program that
/// runs in it, as far as this one can know, would find itself in a folder that is gone.
fn may_be_exchanged(folder: &Path) -> io::Result<bool> {
    let here = std::env::current_dir().and_then(|here| here.canonicalize());
    let runs_here = here.is_ok_and(|here| {
        folder
            .canonicalize()
            .is_ok_and(|folder| here.starts_with(folder))
    });
    let is_link = fs::symlink_metadata(folder)?.is_symlink();
    Ok(!runs_here
        && !is_link
        && !fs::metadata(folder)?.permissions().readonly()
        && Manifest::owns_all(folder)?)
}

/// Flushes the names in a folder and in those below it; the files were flushed when they were
/// written.
fn sync_tree(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            sync_tree(&entry.path())?;
        }
    }
    sync_folder(folder);
    Ok(())
}
