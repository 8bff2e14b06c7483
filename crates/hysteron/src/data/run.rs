//! Simulates and inverts tables row by row, so that memory does not grow with the file.

use crate::data::output::{Added, Cell, TableWriter};
use crate::data::table::Row;
use crate::data::table::TableReader;
use crate::error::{Error, Result};
use crate::model::{Band, Inverse, Model, State};
use crate::model::{Policy, Sample, needs_time, no_load};
use crate::series::Headings;
use hysteron_core::{Direction, Status, Target};
use serde::Serialize;
use std::collections::VecDeque;

/// Counts of the rows processed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Counts {
    /// Rows read and written.
    pub samples: u64,
    /// Rows clipped at the upper end: an input above the range, or a target above it.
    pub high: u64,
    /// Rows clipped at the lower end: an input below the range, or a target below it.
    pub low: u64,
    /// Targets inside a jump of a relay model, which no input reaches exactly.
    pub passed: u64,
}

/// The columns and options of a simulation.
#[derive(Debug, Clone, Copy)]
pub struct Simulate<'a> {
    /// Column of the input.
    pub input: &'a str,
    /// Column of time in seconds, for a model with a thermal body.
    pub time: Option<&'a str>,
    /// Column of the load, for a model that depends on one.
    pub load: Option<&'a str>,
    /// The band, for the columns `output_low` and `output_high`; `None` for no band.
    pub band: Option<&'a Band>,
}

/// Copies `table` to `out` with an additional column `output_model`: the model's output, from every
/// operator off. With a band, the columns `output_low` and `output_high` follow. `out` is finished
/// at the end. `progress` gets the bytes read.
///
/// # Errors
/// - [`crate::Error::File`].
/// - [`crate::Error::Recording`] with line and column.
/// - [`crate::Error::Thermal`] for a model with a thermal body without time.
/// - [`crate::Error::Fit`] for a model that depends on a load without its column.
pub fn simulate_table(
    model: &Model,
    table: &mut TableReader,
    what: Simulate<'_>,
    out: Option<TableWriter>,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let column = table.column(what.input)?;
    let time = match (model.thermal, what.time) {
        (None, _) => None,
        (Some(_), name) => Some(table.time_column(name.ok_or_else(needs_time)?)?),
    };
    if let (Some(dependence), None) = (&model.load, what.load) {
        return Err(dependence.one_is_needed());
    }
    if let (None, Some(_)) = (&model.load, what.load) {
        return Err(no_load());
    }
    let load = what.load.map(|name| table.column(name)).transpose()?;
    let names = ["output_model", "output_low", "output_high"].map(Added::Numbers);
    let added = if what.band.is_some() { 3 } else { 1 };
    let mut sink = Sink::start(table, out, &names[..added])?;
    let (mut state, mut before) = (model.start(), None);
    let mut band = what.band.map(|band| (band, band.start()));
    while table.advance()? {
        let now = time.map(|at| table.number(at)).transpose()?;
        let sample = Sample {
            input: table.number(column)?,
            dt: now.map(|now| now - before.replace(now).unwrap_or(now)),
            load: load.map(|at| table.number(at)).transpose()?,
        };
        let step = model.step(&mut state, sample).map_err(|error| {
            let at = match error {
                Error::Thermal(_) => time,
                _ => load,
            };
            table.fault(at, error.to_string())
        })?;
        match step.clipped {
            None => {}
            Some(hysteron_core::Clipped::Low) => sink.counts.low += 1,
            Some(hysteron_core::Clipped::High) => sink.counts.high += 1,
        }
        let output = step.output;
        match &mut band {
            None => sink.write(table.row(), &[Cell::Number(output)])?,
            Some((band, states)) => {
                let half = band.step(states, state.input())?;
                let cells = [output, output - half, output + half].map(Cell::Number);
                sink.write(table.row(), &cells)?;
            }
        }
        progress(table.bytes_read());
    }
    sink.finish()
}

/// The column and options of an inversion.
#[derive(Debug, Clone, Copy)]
pub struct Invert<'a> {
    /// Column of the wanted output.
    pub target: &'a str,
    /// Whether the inverse holds the input or crosses the dead band when the target reverses.
    pub policy: Policy,
    /// Reversals of the target up to this size are noise and are not followed; in its unit.
    pub tolerance: f64,
    /// Largest number of rows to look ahead for [`Policy::Anticipate`]. If the next turning point
    /// is further away, the input is held.
    pub look_ahead: usize,
}

/// Copies `table` to `out` with the columns `input_model` and `status`: the input that gives the
/// wanted output, from every operator off. `out` is finished at the end. `progress` gets the bytes
/// read.
///
/// # Errors
/// As [`simulate_table`], and [`crate::Error::Core`] for a model with negative weights.
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
