//! Model files on disk.

use crate::data::output::AtomicFile;
use crate::data::output::is_our_model;
use crate::data::output::{Destination, Own};
use crate::error::{Error, Result};
use crate::model::Model;
use std::path::Path;

impl Model {
    /// Reads a model file.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::ModelFile`] naming the field that is missing, of another type, out
    /// of range, or of an unknown version.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|source| Error::File {
            path: path.to_owned(),
            source,
        })?;
        Self::from_json(&text).map_err(|error| match error {
            Error::ModelFile { field, problem, .. } => Error::ModelFile {
                path: Some(path.to_owned()),
                field,
                problem,
            },
            other => other,
        })
    }

    /// Writes this model's file, beside its place first. A path alone replaces whatever file is
    /// there.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write<'a>(&self, target: impl Into<Destination<'a>>) -> Result<()> {
        Self::file(target)?.commit_with(self.to_json().as_bytes())
    }

    /// Starts the file of a model that is not there yet: a place that cannot be is refused before
    /// the work.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn file<'a>(target: impl Into<Destination<'a>>) -> Result<AtomicFile> {
        AtomicFile::create(target, Own::Marked(is_our_model))
    }
}
