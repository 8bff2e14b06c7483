//! Simulation and inversion of tables row by row: memory does not grow with the file.

use crate::data::output::{Added, Cell, TableWriter};
use crate::data::table::TableReader;
use crate::data::table::{Column, Row};
use crate::error::{Error, Result};
use crate::model::{Band, FirstOrder, Inverse, LoadDependence, Model, State, ThermalState};
use crate::model::{Policy, needs_time};
use crate::series::Headings;
use hysteron_core::{Direction, Status, Target};
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
    /// Targets inside a jump of a relay model, which the output passes.
    pub passed: u64,
}

/// What a simulation reads from a table, and what it adds to it.
#[derive(Debug, Clone, Copy)]
pub struct Simulate<'a> {
    /// Column of the input.
    pub input: &'a str,
    /// Column of time in seconds, for a model with a thermal body.
    pub time: Option<&'a str>,
    /// Column of the load, for a model that depends on one.
    pub load: Option<&'a str>,
    /// The band for the columns `output_low` and `output_high`.
    pub band: Option<&'a Band>,
}

/// Copies `table` to `out`, which is ended, with a column `output_model`, the model's output, from every operator off;
/// with a band, with `output_low` and `output_high` too. `progress` is told the bytes read.
///
/// # Errors
/// [`crate::Error::File`], [`crate::Error::Recording`] with line and column; [`crate::Error::Thermal`] for a model with a
/// thermal body without time, [`crate::Error::Fit`] for one that depends on a load without its column.
pub fn simulate_table(
    model: &Model,
    table: &mut TableReader,
    what: Simulate<'_>,
    out: Option<TableWriter>,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let column = table.column(what.input)?;
    let mut heating = Heating::new(model, table, what.time)?;
    let mut loaded = Loaded::new(model, table, what.load)?;
    let names = ["output_model", "output_low", "output_high"].map(Added::Numbers);
    let added = if what.band.is_some() { 3 } else { 1 };
    let mut sink = Sink::start(table, out, &names[..added])?;
    let mut state = model.start();
    let mut band = what.band.map(|band| (band, band.start()));
    while table.advance()? {
        let mut input = table.number(column)?;
        if let Some(heating) = &mut heating {
            input = heating.step(table, input)?;
        }
        let mut step = model.step(&mut state, input)?;
        if let Some(loaded) = &mut loaded {
            step.output = loaded.step(table, input)?;
        }
        match step.clipped {
            None => {}
            Some(hysteron_core::Clipped::Low) => sink.counts.low += 1,
            Some(hysteron_core::Clipped::High) => sink.counts.high += 1,
        }
        let output = step.output;
        match &mut band {
            None => sink.write(table.row(), &[Cell::Number(output)])?,
            Some((band, states)) => {
                let half = band.step(states, input)?;
                let cells = [output, output - half, output + half].map(Cell::Number);
                sink.write(table.row(), &cells)?;
            }
        }
        progress(table.bytes_read());
    }
    sink.finish()
}

/// A model under a load that changes from row to row: each part of its load dependence runs beside the others.
struct Loaded<'m> {
    dependence: &'m LoadDependence,
    load: Column,
    parts: Vec<(Model, State)>,
}

impl<'m> Loaded<'m> {
    fn new(model: &'m Model, table: &mut TableReader, load: Option<&str>) -> Result<Option<Self>> {
        let Some(dependence) = &model.load else {
            return match load {
                None => Ok(None),
                Some(_) => Err(crate::model::no_load()),
            };
        };
        let Some(load) = load else {
            return Err(Error::Fit(format!(
                "the model depends on the load `{}`: name its column, or take the model at one load",
                dependence.quantity.name
            )));
        };
        let parts = model.load_parts()?.into_iter();
        Ok(Some(Self {
            dependence,
            load: table.column(load)?,
            parts: parts
                .map(|part| {
                    let start = part.start();
                    (part, start)
                })
                .collect(),
        }))
    }

    fn step(&mut self, table: &TableReader, input: f64) -> Result<f64> {
        let factors = self
            .dependence
            .factors(table.number(self.load)?)
            .map_err(|error| table.fault(Some(self.load), error.to_string()))?;
        let mut output = 0.0;
        for ((part, state), factor) in self.parts.iter_mut().zip(factors) {
            output += factor * part.step(state, input)?.output;
        }
        Ok(output)
    }
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
        let time = table.time_column(time.ok_or_else(needs_time)?)?;
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

/// What an inversion reads from a table, and how it is done.
#[derive(Debug, Clone, Copy)]
pub struct Invert<'a> {
    /// Column of the output wanted.
    pub target: &'a str,
    /// What the input does where the target rests.
    pub policy: Policy,
    /// Reversals of the target up to this size are not followed, in its unit.
    pub tolerance: f64,
    /// Rows to look ahead at most for [`Policy::Anticipate`]; further on the input rests.
    pub look_ahead: usize,
}

/// Copies `table` to `out`, which is ended, with the columns `input_model` and `status`, the input that gives the
/// wanted output, from every operator off. `progress` is told the bytes read.
///
/// # Errors
/// As [`simulate_table`], and [`crate::Error::Core`] for a model with weights below zero.
pub fn invert_table(
    model: &Model,
    table: &mut TableReader,
    what: Invert<'_>,
    out: Option<TableWriter>,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let column = table.column(what.target)?;
    let mut inverting = Inverting {
        inverse: model.inverse()?,
        state: model.start(),
        tolerance: what.tolerance,
        sink: Sink::start(
            table,
            out,
            &[Added::Numbers("input_model"), Added::Words("status")],
        )?,
    };
    match what.policy {
        Policy::Hold => {
            while table.advance()? {
                let target = table.number(column)?;
                inverting.row(table.row(), target, None)?;
                progress(table.bytes_read());
            }
        }
        Policy::Anticipate => {
            let mut waiting: VecDeque<(Row, f64)> = VecDeque::new();
            let mut headings = Headings::new(what.tolerance, what.look_ahead);
            let mut release =
                |waiting: &mut VecDeque<(Row, f64)>, heading: Option<Direction>, count: usize| {
                    for (row, target) in waiting.drain(..count) {
                        inverting.row(&row, target, heading)?;
                    }
                    Ok::<(), Error>(())
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
    inverting.sink.finish()
}

struct Inverting<'m> {
    inverse: Inverse<'m>,
    state: State,
    tolerance: f64,
    sink: Sink,
}

impl Inverting<'_> {
    fn row(&mut self, row: &Row, target: f64, heading: Option<Direction>) -> Result<()> {
        let target = Target::new(target)
            .heading(heading)
            .tolerance(self.tolerance);
        let solution = self.inverse.step(&mut self.state, target)?;
        let hysteron_core::Solution { input, status } = solution;
        match status {
            Status::Ok => {}
            Status::Low => self.sink.counts.low += 1,
            Status::High => self.sink.counts.high += 1,
            Status::Passed => self.sink.counts.passed += 1,
        }
        let cells = [Cell::Number(input), Cell::Word(status.name())];
        self.sink.write(row, &cells)
    }
}

struct Sink {
    out: Option<TableWriter>,
    counts: Counts,
}

impl Sink {
    fn start(table: &TableReader, out: Option<TableWriter>, added: &[Added]) -> Result<Self> {
        let mut names = added.iter().map(Added::name);
        if let Some(name) = names.find(|name| table.header().iter().any(|h| h == name)) {
            let problem =
                format!("there is a column `{name}` already: rename it, or name another file");
            return Err(table.fault(None, problem));
        }
        Ok(Self {
            out: out.map(|out| out.begin(table, added)).transpose()?,
            counts: Counts::default(),
        })
    }

    fn write(&mut self, row: &Row, cells: &[Cell<'_>]) -> Result<()> {
        self.counts.samples += 1;
        match &mut self.out {
            Some(out) => out.extend_row(row, cells),
            None => Ok(()),
        }
    }

    fn finish(self) -> Result<Counts> {
        self.out.map_or(Ok(()), TableWriter::finish)?;
        Ok(self.counts)
    }
}
