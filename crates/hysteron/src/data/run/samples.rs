//! Samples of a model from the rows of a table.

use super::Around;
use crate::data::recording::{Repair, quantity};
use crate::data::table::{Block, Column, TableReader};
use crate::error::{Error, Result};
use crate::model::{Model, Sample, needs_time, no_load};
use crate::recording::Quantity;
use crate::remedy::{Remedy, Setting};
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
    /// Whether there is a time, and whether the model depends on it.
    clock: bool,
    timed: bool,
    loaded: bool,
    repair: Repair,
    before: Option<f64>,
}

/// A row as the model sees it.
pub(super) struct Next {
    pub(super) sample: Sample,
    /// Whether another recording begins with it.
    pub(super) anew: bool,
}

impl Samples {
    pub(super) fn new(
        model: &Model,
        table: &mut TableReader,
        (name, expected): (&str, &Quantity),
        around: Around<'_>,
    ) -> Result<Self> {
        let value = table.column(name)?;
        expected.check_unit("model", &quantity(table, name, value))?;
        let timed = model.is_timed();
        let name = match (timed, around.time) {
            (true, None) => return Err(needs_time()),
            (_, name) => name,
        };
        let time = name.map(|name| table.time_column(name)).transpose()?;
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
            clock: time.is_some(),
            timed,
            loaded: load.is_some(),
            repair: around.repair,
            before: None,
        })
    }

    /// The times of a block, where there is a clock.
    pub(super) fn time<'b>(&self, block: &'b Block) -> Option<&'b [f64]> {
        self.clock.then(|| block.numbers()[0].as_slice())
    }

    /// Whether samples are inputs alone, so that a model without stages may run over all at once.
    pub(super) fn are_plain(&self) -> bool {
        !self.clock && !self.loaded
    }

    /// The sample of a row, which follows the one before.
    ///
    /// # Errors
    /// [`Error::Recording`] for a clock that goes back, if that is no other recording.
    pub(super) fn next(&mut self, block: &Block, row: usize) -> Result<Next> {
        let at = |column: usize| block.numbers()[column][row];
        let now = self.clock.then(|| at(0));
        let step = now.map(|now| now - self.before.replace(now).unwrap_or(now));
        let anew = step.is_some_and(|step| step < 0.0);
        if let (true, Repair::Refuse, Some(now), Some(step)) = (anew, self.repair, now, step) {
            let problem = format!("time goes back from {} to {now}", now - step);
            let fault = self.fault_at(block, row, Some(0), problem);
            let words = "mend the row, or let the model begin anew there with {}";
            return Err(fault.remedied(Remedy::new(words, [Setting::on("repair")])));
        }
        let sample = Sample {
            input: at(self.value),
            dt: step.filter(|_| self.timed).map(|step| step.max(0.0)),
            load: self.loaded.then(|| at(self.value + 1)),
        };
        Ok(Next { sample, anew })
    }

    /// The error with the row and the column that it comes from.
    pub(super) fn fault(&self, block: &Block, row: usize, error: &Error) -> Error {
        let at = match error.parts().0 {
            Error::Thermal(_) => self.clock.then_some(0),
            Error::Fit(_) => self.loaded.then_some(self.value + 1),
            _ => Some(self.value),
        };
        self.fault_at(block, row, at, error.to_string())
    }

    fn fault_at(&self, block: &Block, row: usize, at: Option<usize>, problem: String) -> Error {
        Error::Recording {
            path: Some(self.path.clone()),
            row: block.place(row),
            column: at.map(|at| self.names[at].clone()),
            problem,
        }
    }
}
