//! Writes the result of an adaptation as a table.

use crate::adapt::Adapted;
use crate::data::output::TableWriter;
use crate::error::{Error, Result};
use crate::recording::Recording;

impl Adapted {
    /// Writes the recording as a table with three more columns: `output_model` (expected before the
    /// sample was learned from), `error` (measured minus expected) and `outcome` (`learned`,
    /// `waiting`, `at-rest`, `frozen`, `rolled-back`, `rejected`).
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Recording`] if `recording` does not have as many samples as the
    /// one adapted to.
    pub fn write_table(&self, recording: &Recording, table: TableWriter) -> Result<()> {
        if recording.len() != self.outcomes.len() {
            return Err(Error::Recording {
                path: recording.source.as_ref().map(|source| source.path.clone()),
                row: None,
                column: None,
                problem: format!(
                    "{} samples, where the model was adapted to {}",
                    recording.len(),
                    self.outcomes.len()
                ),
            });
        }
        let added = ["output_model", "error", "outcome"];
        let errors = self.errors(recording);
        recording.write_with(table, &added, |n| {
            let outcome = self.outcomes[n].name().to_owned();
            [
                self.output_model[n].to_string(),
                errors[n].to_string(),
                outcome,
            ]
        })
    }
}
