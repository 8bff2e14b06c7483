//! Samples of a model from the rows of a table.

use super::Around;
use crate::data::table::{Block, Column, TableReader};
use crate::error::{Error, Result};
use crate::model::{Model, Sample, needs_time, no_load};
use std::path::PathBuf;

/// Makes a sample of each row.
pub(super) struct Samples {
    /// The columns to read, in the order in which a row's faults are told: time, value, load.
    pub(super) columns: Vec<Column>,
    /// For errors: the file, and the names of those columns.
    path: PathBuf,
    names: Vec<String>,
    /// Which of them is the value.
    pub(super) value: usize,
    timed: bool,
    loaded: bool,
    before: Option<f64>,
}

impl Samples {
    pub(super) fn new(
        model: &Model,
        table: &mut TableReader,
        value: &str,
        around: Around<'_>,
    ) -> Result<Self> {
        let value = table.column(value)?;
        let time = match (model.is_timed(), around.time) {
            (false, _) => None,
            (true, name) => Some(table.time_column(name.ok_or_else(needs_time)?)?),
        };
        let load = match (&model.load, around.load) {
            (Some(dependence), None) => return Err(dependence.one_is_needed()),
            (None, Some(_)) => return Err(no_load()),
            (_, name) => name.map(|name| table.column(name)).transpose()?,
        };
        let columns: Vec<Column> = time.into_iter().chain([value]).chain(load).collect();
        let name = |column: &Column| table.header()[column.place()].clone();
        Ok(Self {
            path: table.path().to_owned(),
            names: columns.iter().map(name).collect(),
            columns,
            value: usize::from(time.is_some()),
            timed: time.is_some(),
            loaded: load.is_some(),
            before: None,
        })
    }

    /// The sample of a row, which follows the one before.
    pub(super) fn next(&mut self, block: &Block, row: usize) -> Sample {
        let at = |column: usize| block.numbers()[column][row];
        let now = self.timed.then(|| at(0));
        Sample {
            input: at(self.value),
            dt: now.map(|now| now - self.before.replace(now).unwrap_or(now)),
            load: self.loaded.then(|| at(self.value + 1)),
        }
    }

    /// The error with the row and the column that it comes from.
    pub(super) fn fault(&self, block: &Block, row: usize, error: &Error) -> Error {
        let at = match error.parts().0 {
            Error::Thermal(_) => self.timed.then_some(0),
            Error::Fit(_) => self.loaded.then_some(self.value + 1),
            _ => Some(self.value),
        };
        Error::Recording {
            path: Some(self.path.clone()),
            row: block.place(row),
            column: at.map(|at| self.names[at].clone()),
            problem: error.to_string(),
        }
    }
}
