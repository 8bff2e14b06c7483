//! Simulation and inversion of tables row by row: memory does not grow with the file.

use crate::table::{Column, Row};
use crate::thermal::needs_time;
use crate::turning::Headings;
use crate::{
    Direction, FirstOrder, Inverse, Model, Policy, Result, State, Status, TableReader, TableWriter,
    ThermalState,
};
use serde::Serialize;
use std::collections::VecDeque;

/// What came of the rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Counts {
    /// Rows read and written.
    pub samples: u64,
    /// Inputs above or targets beyond the range, taken as its upper end.
    pub high: u64,
    /// Inputs below or targets short of the range, taken as its lower end.
    pub low: u64,
}

/// Copies `table` to `out` with a column `output_model`, the model's output for column `input`, from
/// every operator off. `progress` is told the bytes read. A model with a thermal body needs the column of `time` in seconds.
///
/// # Errors
/// [`crate::Error::File`], [`crate::Error::Recording`] with line and column; [`crate::Error::Thermal`] for a model with a
/// thermal body without `time`.
pub fn simulate_table(
    model: &Model,
    table: &mut TableReader,
    input: &str,
    time: Option<&str>,
    out: Option<&mut TableWriter>,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let column = table.column(input)?;
    let mut heating = Heating::new(model, table, time)?;
    let mut sink = Sink::start(table, out, &["output_model"])?;
    let mut state = model.start();
    while table.advance()? {
        let mut input = table.number(column)?;
        if let Some(heating) = &mut heating {
            input = heating.step(table, input)?;
        }
        let step = model.step(&mut state, input)?;
        match step.clipped {
            None => {}
            Some(crate::Clipped::Low) => sink.counts.low += 1,
            Some(crate::Clipped::High) => sink.counts.high += 1,
        }
        sink.write(table.row(), &[&step.output.to_string()])?;
        progress(table.bytes_read());
    }
    Ok(sink.counts)
}

/// A model's thermal body on its way through a table.
struct Heating {
    body: FirstOrder,
    time: Column,
    state: Option<ThermalState>,
}

impl Heating {
    fn new(model: &Model, table: &mut TableReader, time: Option<&str>) -> Result<Option<Self>> {
        let Some(body) = model.thermal else {
            return Ok(None);
        };
        let time = table.column(time.ok_or_else(needs_time)?)?;
        Ok(Some(Self {
            body,
            time,
            state: None,
        }))
    }

    /// The temperature at the current row of the table.
    fn step(&mut self, table: &TableReader, drive: f64) -> Result<f64> {
        let time = table.number(self.time)?;
        let rest = || self.body.at_rest(time, drive);
        let state = self.state.get_or_insert_with(rest);
        self.body
            .step(state, time, drive)
            .map_err(|error| table.fault(Some(self.time), error.to_string()))
    }
}

/// How a table of targets is inverted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Invert {
    /// The input rests while the target rests.
    Hold {
        /// Reversals of the target up to this size are not followed, in its unit.
        band: f64,
    },
    /// The dead band is crossed as soon as the target is known to reverse.
    Anticipate {
        /// Reversals of the target up to this size are not followed, in its unit.
        band: f64,
        /// How many rows to look ahead at most; further on the input rests.
        rows: usize,
    },
}

/// Copies `table` to `out` with the columns `input_model` and `status`, the input that gives the
/// target in column `target`, from every operator off. `progress` is told the bytes read.
///
/// # Errors
/// As [`simulate_table`], and [`crate::Error::Core`] for a model with weights below zero.
pub fn invert_table(
    model: &Model,
    table: &mut TableReader,
    target: &str,
    how: Invert,
    out: Option<&mut TableWriter>,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let column = table.column(target)?;
    let mut inverting = Inverting {
        inverse: model.inverse()?,
        state: model.start(),
        sink: Sink::start(table, out, &["input_model", "status"])?,
    };
    match how {
        Invert::Hold { band } => {
            let policy = Policy::Hold { tolerance: band };
            while table.advance()? {
                let target = table.number(column)?;
                inverting.row(table.row(), target, policy)?;
                progress(table.bytes_read());
            }
        }
        Invert::Anticipate { band, rows } => {
            let mut waiting: VecDeque<(Row, f64)> = VecDeque::new();
            let mut headings = Headings::new(band, rows);
            let mut release =
                |waiting: &mut VecDeque<(Row, f64)>, heading: Option<Direction>, count: usize| {
                    let tolerance = band;
                    let policy = match heading {
                        Some(heading) => Policy::Anticipate { heading, tolerance },
                        None => Policy::Hold { tolerance },
                    };
                    for (row, target) in waiting.drain(..count) {
                        inverting.row(&row, target, policy)?;
                    }
                    Ok::<(), crate::Error>(())
                };
            while table.advance()? {
                let target = table.number(column)?;
                waiting.push_back((table.row().clone(), target));
                for (heading, count) in headings.push(target) {
                    release(&mut waiting, heading, count)?;
                }
                progress(table.bytes_read());
            }
            let (heading, count) = headings.finish();
            release(&mut waiting, heading, count)?;
        }
    }
    Ok(inverting.sink.counts)
}

struct Inverting<'m, 'w> {
    inverse: Inverse<'m>,
    state: State,
    sink: Sink<'w>,
}

impl Inverting<'_, '_> {
    fn row(&mut self, row: &Row, target: f64, policy: Policy<f64>) -> Result<()> {
        let solution = self.inverse.step(&mut self.state, target, policy)?;
        let status = match solution.status {
            Status::Ok => "ok",
            Status::Low => {
                self.sink.counts.low += 1;
                "low"
            }
            Status::High => {
                self.sink.counts.high += 1;
                "high"
            }
        };
        self.sink.write(row, &[&solution.input.to_string(), status])
    }
}

struct Sink<'w> {
    out: Option<&'w mut TableWriter>,
    counts: Counts,
}

impl<'w> Sink<'w> {
    fn start(
        table: &TableReader,
        mut out: Option<&'w mut TableWriter>,
        names: &[&str],
    ) -> Result<Self> {
        if let Some(name) = names
            .iter()
            .find(|name| table.header().iter().any(|h| h == *name))
        {
            let problem =
                format!("there is a column `{name}` already: rename it, or name another file");
            return Err(table.fault(None, problem));
        }
        if let Some(out) = &mut out {
            let names = names.iter().map(|name| (*name).to_owned());
            out.row(table.header().iter().cloned().chain(names))?;
        }
        Ok(Self {
            out,
            counts: Counts::default(),
        })
    }

    fn write(&mut self, row: &Row, cells: &[&str]) -> Result<()> {
        self.counts.samples += 1;
        match &mut self.out {
            Some(out) => out.extend_row(row, cells),
            None => Ok(()),
        }
    }
}
