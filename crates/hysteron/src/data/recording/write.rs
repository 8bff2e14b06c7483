//! Writes recordings as tables.

use crate::data::output::TableWriter;
use crate::data::recording::samples::MARK;
use crate::error::Result;
use crate::recording::{Origin, Recording, no_recordings};
use std::path::Path;

impl Recording {
    /// Writes a CSV file with a header row; units follow the names in brackets. A simulated
    /// recording has a last column that marks it as simulated. An existing file is replaced.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File), and [`Error::Recording`](crate::Error::Recording) as for [`Recording::check`].
    pub fn write_csv(&self, path: &Path) -> Result<()> {
        self.write_to(TableWriter::plain(Some(path.into()))?)
    }

    /// As [`Recording::write_csv`], to a table that is already open.
    ///
    /// # Errors
    /// As [`Recording::write_csv`].
    pub fn write_to(&self, table: TableWriter) -> Result<()> {
        write_all(std::slice::from_ref(self), table, &[], |_| [])
    }
}

/// Writes recordings one after the other, with additional columns. `more` gets the number of the row
/// among all.
pub(crate) fn write_all<const N: usize>(
    recordings: &[Recording],
    mut table: TableWriter,
    added: &[&str; N],
    more: impl Fn(usize) -> [String; N],
) -> Result<()> {
    recordings.iter().try_for_each(Recording::check)?;
    let first = recordings.first().ok_or_else(no_recordings)?;
    let simulated = first.origin == Origin::Simulated;
    let names = [
        first.time.as_ref().map(|_| "time [s]".to_owned()),
        Some(first.input_quantity.to_column()),
        Some(first.output_quantity.to_column()),
        first.load.as_ref().map(|_| first.load_quantity.to_column()),
        simulated.then(|| MARK.to_owned()),
    ];
    let added = added.map(str::to_owned);
    table.row(names.iter().flatten().chain(&added))?;
    let mut row = 0;
    for recording in recordings {
        for (n, (input, output)) in recording.input.iter().zip(&recording.output).enumerate() {
            let cells = [
                recording.time.as_ref().map(|time| time[n].to_string()),
                Some(input.to_string()),
                Some(output.to_string()),
                recording.load.as_ref().map(|load| load[n].to_string()),
                simulated.then(|| "1".to_owned()),
            ];
            table.row(cells.iter().flatten().chain(&more(row)))?;
            row += 1;
        }
    }
    table.finish()
}
