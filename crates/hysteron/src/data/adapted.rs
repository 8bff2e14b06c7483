//! Writes the result of an adaptation as a table.

use crate::adapt::Adapted;
use crate::data::output::TableWriter;
use crate::data::recording::write_all;
use crate::error::{Error, Result};
use crate::recording::Recording;

impl Adapted {
    /// Writes the recordings, one after the other, as a table with three more columns: `output_model` (expected before the
    /// sample was learned from), `error` (measured minus expected) and `outcome` (`learned`,
    /// `waiting`, `at-rest`, `frozen`, `rolled-back`, `rejected`, `output-stuck`,
    /// `input-stuck`). With [`crate::Learner::Load`] also
    /// `shift_model` (the shift before the sample was learned from) and, if the model's load tells
    /// it, `load_model`.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Recording`] if `recordings` do not have as many samples as those
    /// adapted to.
    pub fn write_table(
        &self,
        recordings: &(impl AsRef<[Recording]> + ?Sized),
        table: TableWriter,
    ) -> Result<()> {
        let recordings = recordings.as_ref();
        let samples: usize = recordings.iter().map(Recording::len).sum();
        if samples != self.outcomes.len() {
            let source = recordings.first().and_then(|first| first.source.as_ref());
            return Err(Error::Recording {
                path: source.map(|source| source.path.clone()),
                row: None,
                column: None,
                problem: format!(
                    "{samples} samples, where the model was adapted to {}",
                    self.outcomes.len()
                ),
            });
        }
        let errors = self.errors(recordings);
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
            return write_all(recordings, table, &added, of);
        };
        let shift = |n: usize| found.shifts[n].to_string();
        let Some(loads) = &found.loads else {
            let added = [output, error, outcome, "shift_model"];
            return write_all(recordings, table, &added, |n| {
                let [output, error, outcome] = of(n);
                [output, error, outcome, shift(n)]
            });
        };
        let added = [output, error, outcome, "shift_model", "load_model"];
        write_all(recordings, table, &added, |n| {
            let [output, error, outcome] = of(n);
            [output, error, outcome, shift(n), loads[n].to_string()]
        })
    }
}
