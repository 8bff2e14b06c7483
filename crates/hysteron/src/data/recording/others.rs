//! Keeps the columns of a file that a recording does not use, so that they can be written again.

use crate::data::output::TableWriter;
use crate::data::table::{Column, Row, TableReader};
use crate::error::{Error, Result};
use crate::recording::Recording;

/// All columns of the file that a recording was read from, in their order and with their names. A
/// unit from a row of units is appended to the name. A time in another unit has been converted to
/// seconds.
#[derive(Debug, Clone, Default)]
pub struct Others {
    header: Vec<String>,
    /// Index of the columns of input, output, time and load.
    places: [Option<usize>; 4],
    rows: Vec<Row>,
}

impl Others {
    /// No rows yet. `columns` are the recording's input, output, time and load in the table.
    pub(super) fn of(table: &TableReader, columns: [Option<Column>; 4]) -> Self {
        Self {
            header: table.names_with_units(),
            places: columns.map(|column| column.map(Column::place)),
            rows: Vec::new(),
        }
    }

    pub(super) fn push(&mut self, row: Row) {
        self.rows.push(row);
    }

    /// Keeps these rows, in this order.
    pub(super) fn keep(&mut self, order: &[usize]) {
        if !self.rows.is_empty() {
            self.rows = order.iter().map(|&n| self.rows[n].clone()).collect();
        }
    }

    /// Writes `recording` together with the other columns. `recording` is the one that was read
    /// with these columns, after [`crate::prepare()`]; `before` are its times before that. Each
    /// series goes to its own column. If the recording was resampled, columns of numbers are
    /// interpolated and other columns are omitted. Returns the names of those omitted.
    ///
    /// # Errors
    /// [`Error::File`], and [`Error::Recording`] as for [`Recording::check`].
    pub fn write_to(
        &self,
        recording: &Recording,
        before: Option<&[f64]>,
        mut table: TableWriter,
    ) -> Result<Vec<String>> {
        recording.check()?;
        let resampled = recording.time.as_deref() != before;
        if !resampled && self.rows.len() != recording.len() {
            let problem = format!(
                "{} rows beside {} samples",
                self.rows.len(),
                recording.len()
            );
            return Err(Error::Recording {
                path: None,
                row: None,
                column: None,
                problem,
            });
        }
        let mut left_out = Vec::new();
        let mut columns = Vec::new();
        for (n, name) in self.header.iter().enumerate() {
            let source = match self.series(recording, n) {
                Some((name, series)) => Some((name, Cells::Numbers(series.to_vec()))),
                None if !resampled => Some((name.clone(), Cells::Read(n))),
                None => self
                    .at(recording, before, n)
                    .map(|cells| (name.clone(), cells)),
            };
            match source {
                Some(source) => columns.push(source),
                None => left_out.push(name.clone()),
            }
        }
        table.row(columns.iter().map(|(name, _)| name))?;
        for n in 0..recording.len() {
            table.row(columns.iter().map(|(_, cells)| match cells {
                Cells::Numbers(numbers) => numbers[n].to_string().into_bytes(),
                Cells::Read(column) => self.cell(n, *column).to_vec(),
            }))?;
        }
        table.finish()?;
        Ok(left_out)
    }

    /// The series of the recording that belongs in a column, and the name of that column.
    fn series<'r>(&self, recording: &'r Recording, column: usize) -> Option<(String, &'r [f64])> {
        let name = self.header[column].clone();
        let place = self
            .places
            .iter()
            .position(|place| *place == Some(column))?;
        match place {
            0 => Some((name, &recording.input)),
            1 => Some((name, &recording.output)),
            2 => Some((name, recording.time.as_deref()?)),
            _ => Some((name, recording.load.as_deref()?)),
        }
    }

    /// A column of numbers at the times of the recording; `None` if it is not a column of numbers.
    fn at(&self, recording: &Recording, before: Option<&[f64]>, column: usize) -> Option<Cells> {
        let number = |n| {
            std::str::from_utf8(self.cell(n, column))
                .ok()?
                .trim()
                .parse()
                .ok()
        };
        let numbers: Option<Vec<f64>> = (0..self.rows.len()).map(number).collect();
        let wanted = recording.time.as_deref()?;
        let values = super::samples::interpolate(before?, &numbers?, wanted);
        Some(Cells::Numbers(values))
    }

    fn cell(&self, row: usize, column: usize) -> &[u8] {
        self.rows[row].cells().nth(column).unwrap_or_default()
    }
}

/// Where the cells of a column come from.
enum Cells {
    Numbers(Vec<f64>),
    /// A column of the file.
    Read(usize),
}
