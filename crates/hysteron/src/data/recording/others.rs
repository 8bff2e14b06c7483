//! Keeps the columns of a file that a recording does not use, so that they can be written again.

use crate::data::output::TableWriter;
use crate::data::table::{Column, Row, TableReader};
use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::series::interpolate::interpolate;

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
    pub(super) fn new(table: &TableReader, columns: [Option<Column>; 4]) -> Self {
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

    /// Writes recordings together with the other columns, one after the other. `read` are the
    /// recordings that were read with these columns, and `prepared` the same ones after
    /// [`crate::prepare()`]. Each series goes to its own column. If a recording was resampled,
    /// columns of numbers are interpolated and other columns are omitted. Returns the names of those
    /// omitted.
    ///
    /// # Errors
    /// [`Error::File`], and [`Error::Recording`] as for [`Recording::check`].
    pub fn write_to(
        &self,
        prepared: &[Recording],
        read: &[Recording],
        mut table: TableWriter,
    ) -> Result<Vec<String>> {
        prepared.iter().chain(read).try_for_each(Recording::check)?;
        let rows: usize = read.iter().map(Recording::len).sum();
        if self.rows.len() != rows || prepared.len() != read.len() {
            let (rows, read) = (self.rows.len(), read.len());
            return Err(Error::Recording {
                path: None,
                row: None,
                column: None,
                problem: format!("{rows} rows and {read} recordings were read, others are written"),
            });
        }
        let mut pairs = prepared.iter().zip(read);
        let resampled = pairs.any(|(prepared, read)| prepared.time != read.time);
        let mut left_out = Vec::new();
        let mut columns = Vec::new();
        for (n, name) in self.header.iter().enumerate() {
            let cells = match self.series(prepared, n) {
                Some(series) => Some(Cells::Numbers(series)),
                None if !resampled => Some(Cells::Read(n)),
                None => self.interpolated(prepared, read, n).map(Cells::Numbers),
            };
            match cells {
                Some(cells) => columns.push((name, cells)),
                None => left_out.push(name.clone()),
            }
        }
        table.row(columns.iter().map(|(name, _)| name))?;
        for n in 0..prepared.iter().map(Recording::len).sum() {
            table.row(columns.iter().map(|(_, cells)| match cells {
                Cells::Numbers(numbers) => numbers[n].to_string().into_bytes(),
                Cells::Read(column) => self.cell(n, *column).to_vec(),
            }))?;
        }
        table.finish()?;
        Ok(left_out)
    }

    /// The series of the recordings that belongs in a column.
    fn series(&self, recordings: &[Recording], column: usize) -> Option<Vec<f64>> {
        let mut places = self.places.iter();
        let place = places.position(|place| *place == Some(column))?;
        let each = recordings.iter().map(|recording| match place {
            0 => Some(&recording.input),
            1 => Some(&recording.output),
            2 => recording.time.as_ref(),
            _ => recording.load.as_ref(),
        });
        Some(
            each.collect::<Option<Vec<_>>>()?
                .into_iter()
                .flatten()
                .copied()
                .collect(),
        )
    }

    /// A column of numbers at the times of the prepared recordings; `None` if it is not a column of
    /// numbers.
    fn interpolated(
        &self,
        prepared: &[Recording],
        read: &[Recording],
        column: usize,
    ) -> Option<Vec<f64>> {
        let (mut begin, mut all) = (0, Vec::new());
        for (prepared, read) in prepared.iter().zip(read) {
            let end = begin + read.len();
            let number = |n| {
                std::str::from_utf8(self.cell(n, column))
                    .ok()?
                    .trim()
                    .parse()
                    .ok()
            };
            let numbers: Option<Vec<f64>> = (begin..end).map(number).collect();
            let (times, wanted) = (read.time.as_deref()?, prepared.time.as_deref()?);
            all.extend(interpolate(times, &numbers?, wanted));
            begin = end;
        }
        Some(all)
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
