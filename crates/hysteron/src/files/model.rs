//! Reads and writes model files.

use super::{begins_as_model, head::begins_with};
use crate::error::{Error, Result};
use crate::model::{Model, no_model};
use hysteron_files::{AtomicFile, Destination, Own};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The bytes of a file that show what it is.
const HEAD: u64 = 1 << 16;

impl Model {
    /// Reads a model file.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::ModelFile`] for an unknown version and for a field that is
    /// missing, of the wrong type or out of range. The error names the field.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(|source| Error::File {
            path: path.to_owned(),
            source,
        })?;
        let text = std::str::from_utf8(&bytes).map_err(|_| no_model());
        text.and_then(Self::from_json).map_err(|error| match error {
            Error::ModelFile { field, problem, .. } => Error::ModelFile {
                path: Some(path.to_owned()),
                field,
                problem,
            },
            other => other,
        })
    }

    /// Whether a file is there that begins as a model does.
    #[must_use]
    pub fn is_in(path: &Path) -> bool {
        let mut head = Vec::new();
        let file = path.is_file().then(|| File::open(path));
        let read = file.map(|file| file?.take(HEAD).read_to_end(&mut head));
        read.is_some_and(|read| read.is_ok()) && begins_as_model(&head)
    }

    /// Writes this model's file. It is complete before it replaces another one. A target that is
    /// only a path replaces any existing file.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write<'a>(&self, target: impl Into<Destination<'a>>) -> Result<()> {
        Ok(Self::file(target)?.commit_with(self.to_json().as_bytes())?)
    }

    /// Opens the file of a model that is not identified yet. So a path that cannot be written is
    /// refused before the work.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn file<'a>(target: impl Into<Destination<'a>>) -> Result<AtomicFile> {
        Ok(AtomicFile::create(target, Own::Marked(is_our_model))?)
    }
}

/// Whether the file is a model that was fitted or adapted, with exactly the bytes that we would
/// write. A model written by hand has no fit or other spacing.
fn is_our_model(path: &Path) -> io::Result<bool> {
    if !begins_with(path, b"{")? {
        return Ok(false);
    }
    let Ok(text) = String::from_utf8(std::fs::read(path)?) else {
        return Ok(false);
    };
    Ok(Model::from_json(&text).is_ok_and(|model| model.fit.is_some() && model.to_json() == text))
}
