//! Writes a designed input profile as a table.

use crate::data::ReadOptions;
use crate::data::output::TableWriter;
use crate::design::Design;
use crate::error::Result;
use std::path::Path;

impl Design {
    /// Writes the profile as CSV with the columns `time [s]` and `input`. An existing file is
    /// replaced.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File).
    pub fn write_csv(&self, path: &Path) -> Result<()> {
        self.write_to(TableWriter::plain(Some(path.into()))?)
    }

    /// As [`Design::write_csv`], to a table that is already open.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File).
    pub fn write_to(&self, mut table: TableWriter) -> Result<()> {
        self.fill(&mut table)?;
        table.finish()
    }

    /// The bytes that [`Design::write_csv`] writes.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File).
    pub fn to_csv(&self) -> Result<Vec<u8>> {
        let memory = ReadOptions::usual_memory().into();
        let mut table = TableWriter::in_memory("profile.csv", &memory)?;
        self.fill(&mut table)?;
        table.into_bytes()
    }

    fn fill(&self, table: &mut TableWriter) -> Result<()> {
        table.row(["time [s]", "input"])?;
        for (time, input) in self.time.iter().zip(&self.input) {
            table.row([time.to_string(), input.to_string()])?;
        }
        Ok(())
    }
}
