//! Folders that appear complete or not at all.

use crate::atomic::sync_folder;
use crate::destination::{Destination, Own, folder_of, foreign};
use crate::error::{Error, OfFile, Result};
use crate::manifest::{self, Manifest};
use crate::moves::Moves;
use crate::unfinished::{Workshop, unfinished};
use crate::{AtomicFile, destination};
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Subfolders of the temporary folder: new files, and old files until all is done.
const NEW: &str = "new";
const OLD: &str = "old";

/// A folder whose files are written under a temporary name and appear together. If it is dropped
/// before, nothing is left.
///
/// Files in the folder that are not ours are kept. If one of them has the name of a new file, the
/// work is refused, unless the target allows replacing it.
///
/// If every file in the folder is ours and the program does not run in the folder, the new folder
/// replaces the old one in a single step. Otherwise the files are replaced one after the other, and
/// after an error the old files are restored.
pub struct AtomicFolder {
    target: PathBuf,
    inputs: Vec<PathBuf>,
    keep_foreign: bool,
    own: Option<Own>,
    /// `place` is the folder, or the first missing folder on the way to it. `below` is the rest of
    /// the path.
    place: PathBuf,
    below: PathBuf,
    workshop: Workshop,
    /// Paths relative to the folder.
    files: Vec<PathBuf>,
    /// Those of files that are not to be there.
    gone: Vec<PathBuf>,
}

impl AtomicFolder {
    /// Opens a folder for `target`. Missing folders above it are created. `own` decides which of
    /// the existing files are ours. With `None`, a list of digests decides, which is written
    /// together with the files.
    ///
    /// # Errors
    /// [`Error`].
    pub fn create<'a>(target: impl Into<Destination<'a>>, own: Option<Own>) -> Result<Self> {
        let target = target.into();
        let path = target.path();
        Self::start(&target, own).map_err(|source| Error {
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
            gone: Vec::new(),
        })
    }

    /// Removes a file of an earlier work when the new ones appear, and its folder if that is empty
    /// then. One that is not ours is refused, as where a new file has its name.
    ///
    /// # Errors
    /// [`Error`].
    pub fn without(&mut self, name: impl Into<PathBuf>) -> Result<()> {
        let name = name.into();
        self.check(&name)?;
        self.gone.push(name);
        Ok(())
    }

    /// Refuses files with these names before any work, if they would be refused at the end.
    ///
    /// # Errors
    /// [`Error`].
    pub fn claim<N: AsRef<Path>>(&self, names: impl IntoIterator<Item = N>) -> Result<()> {
        names
            .into_iter()
            .try_for_each(|name| self.check(name.as_ref()))
    }

    /// The path of the folder, as given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.target
    }

    /// Lets `write` write one file. The function gets the path to write to.
    ///
    /// # Errors
    /// The error of the function, with the final path of the file; [`Error`].
    pub fn file<T, E: OfFile>(
        &mut self,
        name: impl AsRef<Path>,
        write: impl FnOnce(&Path) -> std::result::Result<T, E>,
    ) -> std::result::Result<T, E> {
        let name = name.as_ref();
        let path = self.stage().join(name);
        fs::create_dir_all(folder_of(&path)).map_err(|source| self.fault(name, source))?;
        let written = write(&path).map_err(|error| error.placed(&self.target.join(name)))?;
        self.files.push(name.to_owned());
        Ok(written)
    }

    /// Gives the folder and its files their names. Old files of ours that are not among the new
    /// ones are removed.
    ///
    /// # Errors
    /// [`Error`]; then the folder is unchanged.
    pub fn commit(mut self) -> Result<()> {
        if self.own.is_none() {
            self.write_manifests()?;
        }
        self.claim(self.files.iter().chain(&self.gone))?;
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
        Error { path, source }
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

    /// Refuses a file that would replace one that is not ours.
    fn check(&self, name: &Path) -> Result<()> {
        let path = self.target.join(name);
        let refused = |source| self.fault(name, source);
        for folder in path.ancestors().skip(1).take(name.components().count()) {
            if folder.is_file() {
                let source = io::Error::other("this is a file, where a folder is needed");
                return Err(Error {
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
        // A signal that ends the program must wait until all files have their names.
        let _unfinished = unfinished();
        let mut moves = Moves::new(self.workshop.path().join(OLD))?;
        let put = self.put(&mut moves, &new, &self.place);
        if let Err(error) = put.and_then(|()| self.remove_gone(&mut moves)) {
            moves.undo();
            return Err(error);
        }
        sync_folder(&self.place);
        sync_folder(folder_of(&self.place));
        Ok(())
    }

    fn remove_gone(&self, moves: &mut Moves) -> io::Result<()> {
        for path in self.gone.iter().map(|name| self.target.join(name)) {
            if fs::symlink_metadata(&path).is_err() {
                continue;
            }
            moves.remove(&path)?;
            let folder = folder_of(&path);
            let list = folder.join(manifest::NAME);
            let all = Manifest::read(folder);
            if list.exists() && !all.names().any(|name| folder.join(name).exists()) {
                moves.remove(&list)?;
                // A folder with files of others stays.
                let _ = fs::remove_dir(folder);
            }
        }
        Ok(())
    }

    /// Moves a new file or folder to its place.
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

/// Chooses where the temporary folder is. If the old folder may be exchanged for a new one, it is
/// beside it. Otherwise it is inside, and also if files cannot be moved between the two (for
/// example, if a disk is mounted at the folder).
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

/// The first missing folder on the way to `path`, and the rest of the way.
fn first_missing(path: &Path) -> (PathBuf, PathBuf) {
    let missing = path
        .ancestors()
        .take_while(|folder| **folder != *Path::new("") && !folder.exists());
    let first = missing.last().unwrap_or(path);
    let rest = path.strip_prefix(first).unwrap_or(Path::new(""));
    (first.to_owned(), rest.to_owned())
}

/// Whether the folder may be exchanged for a new one. Everything in it must be ours, and no program
/// may run in it (as far as can be known), because its working folder would disappear.
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

/// Flushes the names in a folder and its subfolders. The files themselves were flushed when they
/// were written.
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
