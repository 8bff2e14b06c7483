//! Writes the run of a control loop as a table.

use crate::control::Trace;
use crate::data::output::TableWriter;
use crate::error::Result;
use std::path::Path;

impl Trace {
    /// Writes the run as CSV, one row per sample. An existing file is replaced.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn write_csv(&self, path: &Path) -> Result<()> {
        let mut table = TableWriter::plain(Some(path.into()))?;
        table.row([
            "time_s",
            "reference",
            "output",
            "measured",
            "input",
            "command",
            "drive",
            "prediction",
            "saturated",
            "out_of_reach",
            "sensor_fault",
            "adapted",
            "rejected",
            "stuck",
        ])?;
        for n in 0..self.time.len() {
            let numbers = [
                &self.time,
                &self.reference,
                &self.output,
                &self.measured,
                &self.input,
                &self.command,
                &self.drive,
                &self.prediction,
            ];
            let status = self.status[n];
            let flags = [
                status.saturated,
                status.out_of_reach,
                status.sensor_fault,
                status.adapted,
                status.rejected,
                status.stuck,
            ];
            let flags = flags.map(|flag| u8::from(flag).to_string());
            table.row(
                numbers
                    .map(|series| cell(series[n]))
                    .into_iter()
                    .chain(flags),
            )?;
        }
        table.finish()
    }
}

/// A number, or an empty cell if there is none.
fn cell(value: f64) -> String {
    match value.is_nan() {
        true => String::new(),
        false => value.to_string(),
    }
}
