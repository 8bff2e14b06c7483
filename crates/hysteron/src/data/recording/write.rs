//! Writes recordings as tables.

use crate::data::output::TableWriter;
use crate::error::Result;
use crate::recording::{Origin, Recording};
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
        self.write_with(table, &[], |_| [])
    }

    /// As [`Recording::write_to`], with additional columns.
    pub(crate) fn write_with<const N: usize>(
        &self,
        mut table: TableWriter,
        added: &[&str; N],
        more: impl Fn(usize) -> [String; N],
    ) -> Result<()> {
        self.check()?;
        let simulated = self.origin == Origin::Simulated;
        let names = [
            self.time.as_ref().map(|_| "time [s]".to_owned()),
            Some(self.input_quantity.to_column()),
            Some(self.output_quantity.to_column()),
            self.load.as_ref().map(|_| self.load_quantity.to_column()),
            simulated.then(|| "simulated".to_owned()),
        ];
        let added = added.map(str::to_owned);
        table.row(names.iter().flatten().chain(&added))?;
        for (n, (input, output)) in self.input.iter().zip(&self.output).enumerate() {
            let cells = [
                self.time.as_ref().map(|time| time[n].to_string()),
                Some(input.to_string()),
                Some(output.to_string()),
                self.load.as_ref().map(|load| load[n].to_string()),
                simulated.then(|| "1".to_owned()),
            ];
            table.row(cells.iter().flatten().chain(&more(n)))?;
        }
        table.finish()
    }
}
