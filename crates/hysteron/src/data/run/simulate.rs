//! Simulates tables.

use super::pipeline::{Work, through};
use super::samples::{Next, Samples};
use super::{Around, Counts};
use crate::data::output::{Added, AddedCells, TableWriter};
use crate::data::table::{Block, TableReader};
use crate::error::Result;
use crate::model::{Band, Model, OperatorState, Sample, State, UnderWay};

/// The columns and options of a simulation.
#[derive(Debug, Clone, Copy)]
pub struct Simulate<'a> {
    /// Column of the input.
    pub input: &'a str,
    /// Columns of time and load.
    pub around: Around<'a>,
    /// The input long before the first row, at which all was at rest; `None` for that of the first.
    pub rest: Option<f64>,
    /// The band, for the columns `output_low` and `output_high`; `None` for no band.
    pub band: Option<&'a Band>,
}

/// Copies `table` to `out` with an additional column `output_model`: the model's output, from
/// `state`, behind its dead time. Where the clock goes back it begins there again
/// ([`Around::repair`]). With a band, the columns `output_low` and `output_high` follow. `out` is
/// finished at the end. `progress` gets the bytes read.
///
/// # Errors
/// - [`crate::Error::File`].
/// - [`crate::Error::Recording`] with line and column.
/// - [`crate::Error::Thermal`] for a model that depends on time without time.
/// - [`crate::Error::Fit`] for a model that depends on a load without its column.
pub fn simulate_table(
    model: &Model,
    state: State,
    table: &mut TableReader,
    what: Simulate<'_>,
    out: Option<TableWriter>,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let samples = Samples::new(model, table, (what.input, &model.input), what.around)?;
    let columns = samples.columns.clone();
    let names = ["output_model", "output_low", "output_high"].map(Added::Numbers);
    let added = if what.band.is_some() { 3 } else { 1 };
    let band = match what.band {
        Some(band) => Some((band, band.states(&state)?)),
        None => None,
    };
    let work = Simulating {
        model,
        begin: state.clone(),
        state,
        samples,
        rest: what.rest,
        is_rested: what.rest.is_none(),
        band,
        under_way: None,
        counts: Counts::default(),
    };
    through(table, &columns, out, &names[..added], work, progress)
}

struct Simulating<'a> {
    model: &'a Model,
    /// Where each recording begins.
    begin: State,
    state: State,
    samples: Samples,
    rest: Option<f64>,
    /// Whether the state has been at that rest.
    is_rested: bool,
    band: Option<(&'a Band, Vec<OperatorState>)>,
    /// The inputs of the dead time; `None` before the first row, whose clock tells how many.
    under_way: Option<UnderWay<f64>>,
    counts: Counts,
}

impl Work for Simulating<'_> {
    fn rows(&mut self, block: &Block, cells: &mut AddedCells) -> Result<()> {
        let delay = self.model.delay();
        let plain = self.model.is_plain() && self.samples.are_plain() && delay.is_none();
        if plain && self.band.is_none() && self.is_rested {
            let input = &block.numbers()[self.samples.value];
            let outputs = &mut cells.numbers[0];
            outputs.resize(input.len(), 0.0);
            let clipped = self.model.run(&mut self.state, input, outputs);
            let clipped = clipped.inspect_err(|_| outputs.clear())?;
            self.counts.low += clipped.low as u64;
            self.counts.high += clipped.high as u64;
            self.counts.samples += block.len() as u64;
            return Ok(());
        }
        for row in 0..block.len() {
            let Next { mut sample, anew } = self.samples.next(block, row)?;
            if anew {
                self.state.clone_from(&self.begin);
                if let Some((band, states)) = &mut self.band {
                    *states = band.states(&self.begin)?;
                }
                self.under_way = None;
                self.counts.anew += 1;
                self.is_rested = self.rest.is_none();
            }
            if let Some(rest) = self.rest.filter(|_| !self.is_rested) {
                let before = Sample {
                    input: rest,
                    dt: None,
                    load: sample.load,
                };
                let step = self.model.step(&mut self.state, before);
                step.map_err(|error| self.samples.fault(block, row, &error))?;
                self.is_rested = true;
            }
            let late = || {
                let mut late = UnderWay::new(delay.on(self.samples.time(block)));
                if let Some(rest) = self.rest {
                    late.push(rest);
                }
                late
            };
            sample.input = self.under_way.get_or_insert_with(late).push(sample.input);
            let step = self.model.step(&mut self.state, sample);
            let step = step.map_err(|error| self.samples.fault(block, row, &error))?;
            match step.clipped {
                None => {}
                Some(hysteron_core::Clipped::Low) => self.counts.low += 1,
                Some(hysteron_core::Clipped::High) => self.counts.high += 1,
            }
            let output = step.output;
            match &mut self.band {
                None => cells.push(&[output]),
                Some((band, states)) => {
                    let half = band.step(states, self.state.input())?;
                    cells.push(&[output, output - half, output + half]);
                }
            }
            self.counts.samples += 1;
        }
        Ok(())
    }

    fn rest(&mut self, _: &mut AddedCells) -> Result<()> {
        Ok(())
    }

    fn counts(&self) -> Counts {
        self.counts
    }
}
