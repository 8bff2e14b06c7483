//! Reads and writes model files.

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
    /// [`Error::File`]; [`Error::ModelFile`] for an unknown version and for a field that is
    /// missing, of the wrong type or out of range. The error names the field.
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

    /// Writes this model's file. It is complete before it replaces another one. A target that is
    /// only a path replaces any existing file.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write<'a>(&self, target: impl Into<Destination<'a>>) -> Result<()> {
        Self::file(target)?.commit_with(self.to_json().as_bytes())
    }

    /// Opens the file of a model that is not identified yet. So a path that cannot be written is
    /// refused before the work.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn file<'a>(target: impl Into<Destination<'a>>) -> Result<AtomicFile> {
        AtomicFile::create(target, Own::Marked(is_our_model))
    }
}
