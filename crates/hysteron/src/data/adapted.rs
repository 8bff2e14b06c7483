//! Writes the result of an adaptation as a table.

use crate::adapt::Adapted;
use crate::data::output::TableWriter;
use crate::error::{Error, Result};
use crate::recording::Recording;

impl Adapted {
    /// Writes the recording as a table with three more columns: `output_model` (expected before the
    /// sample was learned from), `error` (measured minus expected) and `outcome` (`learned`,
    /// `waiting`, `at-rest`, `frozen`, `rolled-back`, `rejected`, `output-stuck`,
    /// `input-stuck`). With [`crate::Learner::Load`] also
    /// `shift_model` (the shift before the sample was learned from) and, if the model's load tells
    /// it, `load_model`.
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
        let errors = self.errors(recording);
        let of = |n: usize| {
            [
                self.output_model[n].to_string(),
                errors[n].to_string(),
                self.outcomes[n].name().to_owned(),
            ]
        };
        let added = ["output_model", "error", "outcome"];
        let [output, error, outcome] = added;
        let Some(found) = &self.shift else {
            return recording.write_with(table, &added, of);
        };
        let shift = |n: usize| found.shifts[n].to_string();
        let Some(loads) = &found.loads else {
            return recording.write_with(table, &[output, error, outcome, "shift_model"], |n| {
                let [output, error, outcome] = of(n);
                [output, error, outcome, shift(n)]
            });
        };
        let added = [output, error, outcome, "shift_model", "load_model"];
        recording.write_with(table, &added, |n| {
            let [output, error, outcome] = of(n);
            [output, error, outcome, shift(n), loads[n].to_string()]
        })
    }
}
