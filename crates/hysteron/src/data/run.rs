//! Simulates and inverts tables block by block, so that memory does not grow with the file.

use crate::data::output::{Added, Cell, TableWriter};
use crate::data::table::{Block, Column, TableReader};
use crate::error::{Error, Result};
use crate::model::{Band, Inverse, Model, Policy, Preview, Sample, State, Wanted};
use crate::model::{needs_time, no_load};
use crate::series::Headings;
use hysteron_core::Status;
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
    /// Targets that the drive, within its range, cannot reach in time.
    pub limited: u64,
}

/// The columns that a model may need besides its input or target.
#[derive(Debug, Clone, Copy, Default)]
pub struct Around<'a> {
    /// Column of time in seconds, for a model that depends on time.
    pub time: Option<&'a str>,
    /// Column of the load, for a model that depends on one.
    pub load: Option<&'a str>,
}

/// The columns and options of a simulation.
#[derive(Debug, Clone, Copy)]
pub struct Simulate<'a> {
    /// Column of the input.
    pub input: &'a str,
    /// Columns of time and load.
    pub around: Around<'a>,
    /// The band, for the columns `output_low` and `output_high`; `None` for no band.
    pub band: Option<&'a Band>,
}

/// Copies `table` to `out` with an additional column `output_model`: the model's output, from
/// `state`. With a band, the columns `output_low` and `output_high` follow. `out` is finished at the
/// end. `progress` gets the bytes read.
///
/// # Errors
/// - [`crate::Error::File`].
/// - [`crate::Error::Recording`] with line and column.
/// - [`crate::Error::Thermal`] for a model that depends on time without time.
/// - [`crate::Error::Fit`] for a model that depends on a load without its column.
pub fn simulate_table(
    model: &Model,
    mut state: State,
    table: &mut TableReader,
    what: Simulate<'_>,
    out: Option<TableWriter>,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let mut samples = Samples::new(model, table, what.input, what.around)?;
    let names = ["output_model", "output_low", "output_high"].map(Added::Numbers);
    let added = if what.band.is_some() { 3 } else { 1 };
    let mut sink = Sink::start(table, out, &names[..added])?;
    let mut band = match what.band {
        Some(band) => Some((band, band.states(&state)?)),
        None => None,
    };
    let mut outputs = Vec::new();
    while sink.read(table, &samples.columns)? {
        if model.is_plain() && band.is_none() {
            let input = &sink.block.numbers()[samples.value];
            outputs.resize(input.len(), 0.0);
            let clipped = model.run(&mut state, input, &mut outputs)?;
            sink.counts.low += clipped.low as u64;
            sink.counts.high += clipped.high as u64;
            for output in &outputs {
                sink.write(&[Cell::Number(*output)])?;
            }
        } else {
            for row in 0..sink.block.len() {
                let sample = samples.next(&sink.block, row);
                let step = model.step(&mut state, sample);
                let step = step.map_err(|error| samples.fault(table, &sink.block, row, &error))?;
                match step.clipped {
                    None => {}
                    Some(hysteron_core::Clipped::Low) => sink.counts.low += 1,
                    Some(hysteron_core::Clipped::High) => sink.counts.high += 1,
                }
                let output = step.output;
                match &mut band {
                    None => sink.write(&[Cell::Number(output)])?,
                    Some((band, states)) => {
                        let half = band.step(states, state.input())?;
                        sink.write(&[output, output - half, output + half].map(Cell::Number))?;
                    }
                }
            }
        }
        sink.hand_on()?;
        progress(table.bytes_read());
    }
    sink.finish()
}

/// Makes a sample of each row.
struct Samples {
    /// The columns to read, in the order in which a row's faults are told: time, value, load.
    columns: Vec<Column>,
    /// Which of them is the value.
    value: usize,
    timed: bool,
    loaded: bool,
    before: Option<f64>,
}

impl Samples {
    fn new(
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
        Ok(Self {
            columns: time.into_iter().chain([value]).chain(load).collect(),
            value: usize::from(time.is_some()),
            timed: time.is_some(),
            loaded: load.is_some(),
            before: None,
        })
    }

    /// The sample of a row, which follows the one before.
    fn next(&mut self, block: &Block, row: usize) -> Sample {
        let at = |column: usize| block.numbers()[column][row];
        let now = self.timed.then(|| at(0));
        Sample {
            input: at(self.value),
            dt: now.map(|now| now - self.before.replace(now).unwrap_or(now)),
            load: self.loaded.then(|| at(self.value + 1)),
        }
    }

    /// The error with the row and the column that it comes from.
    fn fault(&self, table: &TableReader, block: &Block, row: usize, error: &Error) -> Error {
        let at = match error.parts().0 {
            Error::Thermal(_) => self.timed.then_some(0),
            Error::Fit(_) => self.loaded.then_some(self.value + 1),
            _ => Some(self.value),
        };
        let column = at.map(|at| self.columns[at]);
        table.fault_in((block, row), column, error.to_string())
    }
}

/// The columns and options of an inversion.
#[derive(Debug, Clone, Copy)]
pub struct Invert<'a> {
    /// Column of the wanted output.
    pub target: &'a str,
    /// Columns of time and load.
    pub around: Around<'a>,
    /// Whether the inverse holds the input or crosses the dead band when the target reverses.
    pub policy: Policy,
    /// Reversals of the target up to this size are noise and are not followed; in its unit.
    pub tolerance: f64,
    /// Largest number of rows to look ahead for [`Policy::Anticipate`]. If the next turning point
    /// is further away, the input is held.
    pub look_ahead: usize,
    /// The range of the drive; `None` for that of the model ([`Model::drive_range`]).
    pub drive_range: Option<(f64, f64)>,
    /// Time in which a temperature is to be reached, s ([`Inverse::horizon`]).
    pub horizon: f64,
    /// For a model with a thermal body: how many seconds ahead of a target the drive may start;
    /// `None` for twice the longer time constant.
    pub preview: Option<f64>,
}

/// Copies `table` to `out` with the columns `input_model` and `status`: the input that gives the
/// wanted output, from `state`. For a model with a thermal body the input is the drive to hold since
/// the row before, and `temperature_model` follows it. `out` is finished at the end. `progress` gets
/// the bytes read.
///
/// # Errors
/// As [`simulate_table`]; [`crate::Error::Core`] for a model with negative weights;
/// [`crate::Error::Fit`] for a range of drives that is not in order.
pub fn invert_table(
    model: &Model,
    state: State,
    table: &mut TableReader,
    what: Invert<'_>,
    out: Option<TableWriter>,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let mut samples = Samples::new(model, table, what.target, what.around)?;
    let drive = what.drive_range.unwrap_or_else(|| model.drive_range());
    let inner = model.without_body();
    let usual = model
        .thermal
        .map(|body| 2.0 * body.tau_heating.max(body.tau_cooling));
    let seconds = what.preview.or(usual).unwrap_or_default();
    let preview = match model.thermal.filter(|_| seconds > 0.0) {
        None => None,
        Some(_) => Some(Preview::new(model, &inner, drive, seconds, state.clone())?),
    };
    let heated = model.thermal.is_some();
    let added = match heated {
        false => vec![Added::Numbers("input_model"), Added::Words("status")],
        true => vec![
            Added::Numbers("input_model"),
            Added::Numbers("temperature_model"),
            Added::Words("status"),
        ],
    };
    let inverse = model
        .inverse()?
        .drive_range(drive.0, drive.1)?
        .horizon(what.horizon)?;
    let mut inverting = Inverting {
        inverse,
        state,
        preview,
        heated,
        sink: Sink::start(table, out, &added)?,
    };
    let mut headings = match what.policy {
        Policy::Hold => None,
        Policy::Anticipate => Some(Headings::new(what.tolerance, what.look_ahead)),
    };
    let mut unheaded: VecDeque<Sample> = VecDeque::new();
    let release =
        |inverting: &mut Inverting<'_>, waiting: &mut VecDeque<Sample>, heading, count: usize| {
            for sample in waiting.drain(..count) {
                inverting.row(Wanted::of(sample, heading, what.tolerance))?;
            }
            Ok::<(), Error>(())
        };
    while inverting.sink.read(table, &samples.columns)? {
        for row in 0..inverting.sink.block.len() {
            let block = &inverting.sink.block;
            let sample = samples.next(block, row);
            // A time or a load that cannot be is told with its row.
            model
                .accepts(sample)
                .map_err(|error| samples.fault(table, block, row, &error))?;
            match &mut headings {
                None => inverting.row(Wanted::of(sample, None, what.tolerance))?,
                Some(headings) => {
                    unheaded.push_back(sample);
                    for (heading, count) in headings.push(sample.input) {
                        release(&mut inverting, &mut unheaded, heading, count)?;
                    }
                }
            }
        }
        inverting.sink.hand_on()?;
        progress(table.bytes_read());
    }
    if let Some(headings) = headings {
        let (heading, count) = headings.finish();
        release(&mut inverting, &mut unheaded, heading, count)?;
    }
    inverting.finish()
}

struct Inverting<'m> {
    inverse: Inverse<'m>,
    state: State,
    preview: Option<Preview<'m>>,
    heated: bool,
    sink: Sink,
}

impl Inverting<'_> {
    fn row(&mut self, wanted: Wanted) -> Result<()> {
        let Some(preview) = &mut self.preview else {
            return self.write(wanted, wanted.target.output);
        };
        for (wanted, asked) in preview.push(wanted)? {
            self.write(wanted, asked)?;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Counts> {
        while let Some((wanted, asked)) = self.preview.as_mut().and_then(Preview::next) {
            self.write(wanted, asked)?;
        }
        self.sink.finish()
    }

    /// `asked` is the output that the row asks for; a preview may want a little less of it.
    fn write(&mut self, wanted: Wanted, asked: f64) -> Result<()> {
        let hysteron_core::Solution { input, status } = match &self.preview {
            Some(preview) => preview.step(&self.inverse, &mut self.state, wanted, asked)?,
            None => self.inverse.step(&mut self.state, wanted)?,
        };
        match status {
            Status::Ok => {}
            Status::Low => self.sink.counts.low += 1,
            Status::High => self.sink.counts.high += 1,
            Status::Passed => self.sink.counts.passed += 1,
            Status::Limited => self.sink.counts.limited += 1,
        }
        let (input, status) = (Cell::Number(input), Cell::Word(status.name()));
        match self.heated {
            true => {
                let temperature = Cell::Number(self.state.temperature());
                self.sink.write(&[input, temperature, status])
            }
            false => self.sink.write(&[input, status]),
        }
    }
}

/// Takes the rows of a table, and pairs them with the cells that come for them in the same order.
struct Sink {
    out: Option<TableWriter>,
    counts: Counts,
    /// The rows read last.
    block: Block,
    /// The blocks before it whose cells have not all come yet, and a used one.
    earlier: VecDeque<Block>,
    spare: Option<Block>,
    /// The next row to be written in the first of all blocks.
    at: usize,
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
            block: Block::default(),
            earlier: VecDeque::new(),
            spare: None,
            at: 0,
        })
    }

    /// Reads the next block of rows with the numbers of `columns`; false at the end.
    fn read(&mut self, table: &mut TableReader, columns: &[Column]) -> Result<bool> {
        let text = self.out.as_ref().is_some_and(|out| !out.copies());
        if !text {
            table.read_only(columns.iter().copied());
        }
        if self.at < self.block.len() || !self.earlier.is_empty() {
            let next = self.spare.take().unwrap_or_default();
            self.earlier
                .push_back(std::mem::replace(&mut self.block, next));
        } else {
            self.at = 0;
        }
        table.fill(&mut self.block, columns, text)?;
        Ok(self.block.len() > 0)
    }

    /// Writes the cells that follow the next row.
    #[inline]
    fn write(&mut self, cells: &[Cell<'_>]) -> Result<()> {
        self.counts.samples += 1;
        while let Some(first) = self.earlier.front()
            && self.at >= first.len()
        {
            self.spare = self.earlier.pop_front();
            self.at = 0;
        }
        let block = self.earlier.front().unwrap_or(&self.block);
        let row = self.at;
        self.at += 1;
        match &mut self.out {
            Some(out) => out.extend_row(block.row(row), cells),
            None => Ok(()),
        }
    }

    /// Hands the rows so far on to whoever reads the result.
    fn hand_on(&mut self) -> Result<()> {
        self.out.as_mut().map_or(Ok(()), TableWriter::hand_on)
    }

    fn finish(self) -> Result<Counts> {
        self.out.map_or(Ok(()), TableWriter::finish)?;
        Ok(self.counts)
    }
}
