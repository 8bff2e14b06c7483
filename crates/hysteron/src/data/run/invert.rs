//! Inverts tables.

use super::pipeline::{Work, through};
use super::samples::{Next, Samples};
use super::{Around, Counts};
use crate::data::output::{Added, AddedCells, TableWriter};
use crate::data::table::{Block, TableReader};
use crate::error::{Error, Result};
use crate::model::{Bounds, Inverse, Model, OperatorState, Policy};
use crate::model::{Preview, Sample, State, Surroundings, Wanted};
use crate::remedy::{Remedy, Setting};
use crate::series::Headings;
use hysteron_core::{Solution, StageState, Status};
use std::collections::VecDeque;

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
/// wanted output, from `state`. It is given early by the dead time of the model. Status and bounds
/// are those of the row's own target: the first ones are [`Status::Limited`], because no input of
/// the table acts so soon. For a model with a thermal body the input is the drive to hold since the
/// row before, and `temperature_model` follows it. A model that knows how far it errs
/// ([`Model::bounds`]) also gets the columns `output_low` and `output_high`: where the output may
/// really be with this input, also where the status is `ok`. Where the clock goes back the model
/// begins from `state` again ([`Around::repair`]). `out` is finished at the end. `progress` gets the
/// bytes read.
///
/// # Errors
/// As [`crate::simulate_table`]; [`crate::Error::Core`] for a model with negative weights;
/// [`crate::Error::Fit`] for a range of drives that is not in order, and for a horizon or a preview
/// without a thermal body.
pub fn invert_table(
    model: &Model,
    state: State,
    table: &mut TableReader,
    what: Invert<'_>,
    out: Option<TableWriter>,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let samples = Samples::new(model, table, (what.target, &model.output), what.around)?;
    let columns = samples.columns.clone();
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
    if !heated && (what.horizon > 0.0 || what.preview.is_some()) {
        let what = "horizon and preview are for a thermal body, and the model has none".to_owned();
        let options = [Setting::any("horizon"), Setting::any("preview")];
        return Err(Error::Fit(what).remedied(Remedy::new("leave out {} and {}", options)));
    }
    let around_output = match model.bounds()? {
        Some(bounds) => Some(AroundOutput::new(model, bounds, &state)?),
        None => None,
    };
    let bounded = around_output.is_some();
    let names = [
        ("input_model", true),
        ("temperature_model", heated),
        ("output_low", bounded),
        ("output_high", bounded),
    ];
    let numbers = names.into_iter().filter(|(_, there)| *there);
    let numbers = numbers.map(|(name, _)| Added::Numbers(name));
    let added: Vec<Added> = numbers.chain([Added::Words("status")]).collect();
    let inverse = model
        .inverse()?
        .drive_range(drive.0, drive.1)?
        .horizon(what.horizon)?;
    let headings = match what.policy {
        Policy::Hold => None,
        Policy::Anticipate => Some(Headings::new(what.tolerance, what.look_ahead)),
    };
    let work = Inverting {
        model,
        samples,
        tolerance: what.tolerance,
        begin: Begin {
            headings: headings.clone(),
            state: state.clone(),
            preview: preview.clone(),
            around_output: around_output.clone(),
        },
        headings,
        unheaded: VecDeque::new(),
        solving: Solving {
            inverse,
            state,
            preview,
            heated,
            around_output,
            early: Early::default(),
            counts: Counts::default(),
        },
    };
    through(table, &columns, out, &added, work, progress)
}

/// Where each recording of a table begins.
#[derive(Clone)]
struct Begin<'m> {
    headings: Option<Headings>,
    state: State,
    preview: Option<Preview<'m>>,
    around_output: Option<AroundOutput<'m>>,
}

/// Gives each target its heading, then solves it.
struct Inverting<'m> {
    model: &'m Model,
    samples: Samples,
    tolerance: f64,
    begin: Begin<'m>,
    headings: Option<Headings>,
    /// The targets that wait for their heading.
    unheaded: VecDeque<Sample>,
    solving: Solving<'m>,
}

impl Work for Inverting<'_> {
    fn rows(&mut self, block: &Block, cells: &mut AddedCells) -> Result<()> {
        let delay = self.model.delay();
        let early = &mut self.solving.early;
        early.rows.get_or_insert(delay.on(self.samples.time(block)));
        let plain = self.model.is_plain();
        // Without bounds, which have a state of their own.
        let bounded = self.solving.around_output.is_some();
        if plain
            && self.samples.are_plain()
            && self.headings.is_none()
            && !bounded
            && delay.is_none()
        {
            let targets = &block.numbers()[self.samples.value];
            if self.solving.series(targets, self.tolerance, cells).is_ok() {
                return Ok(());
            }
            // Nothing was solved: the rows before the fault are solved one by one.
        }
        for row in 0..block.len() {
            let Next { sample, anew } = self.samples.next(block, row)?;
            if anew {
                // What waits belongs to the recording before.
                self.rest(cells)?;
                let begin = self.begin.clone();
                self.headings = begin.headings;
                self.solving.state = begin.state;
                self.solving.preview = begin.preview;
                self.solving.around_output = begin.around_output;
                self.solving.counts.anew += 1;
            }
            // A time or a load that cannot be is told with its row.
            if !plain {
                let accepted = accepts(self.model, sample);
                accepted.map_err(|error| self.samples.fault(block, row, &error))?;
            }
            let Some(headings) = &mut self.headings else {
                let wanted = Wanted::new(sample, None, self.tolerance);
                self.solving.row(wanted, cells)?;
                continue;
            };
            self.unheaded.push_back(sample);
            for (heading, count) in headings.push(sample.input) {
                for sample in self.unheaded.drain(..count) {
                    let wanted = Wanted::new(sample, heading, self.tolerance);
                    self.solving.row(wanted, cells)?;
                }
            }
        }
        Ok(())
    }

    fn rest(&mut self, cells: &mut AddedCells) -> Result<()> {
        if let Some(headings) = self.headings.take() {
            let (heading, count) = headings.finish();
            for sample in self.unheaded.drain(..count) {
                let wanted = Wanted::new(sample, heading, self.tolerance);
                self.solving.row(wanted, cells)?;
            }
        }
        self.solving.rest(cells)
    }

    fn counts(&self) -> Counts {
        self.solving.counts
    }
}

/// Finds the input of one target after the other.
struct Solving<'m> {
    inverse: Inverse<'m>,
    state: State,
    preview: Option<Preview<'m>>,
    heated: bool,
    around_output: Option<AroundOutput<'m>>,
    early: Early,
    counts: Counts,
}

/// What is known of the dead time: each input is given early by it. So the inputs of the first rows
/// come before the table, and the last one is held at its end.
#[derive(Debug, Clone, Default)]
struct Early {
    /// Rows; `None` before the first one, whose clock tells how many.
    rows: Option<usize>,
    /// Number of solutions of this recording so far, up to these rows.
    passed: usize,
    /// What rows say of their targets whose input comes with a later one.
    waiting: VecDeque<(Option<[f64; 2]>, Status)>,
    /// The last input, and the temperature behind it.
    last: (f64, Option<f64>),
}

impl Early {
    /// Writes the next row with the last input.
    fn write(&mut self, cells: &mut AddedCells) {
        let Some((bounds, status)) = self.waiting.pop_front() else {
            return;
        };
        let (input, temperature) = self.last;
        let mut numbers = [input, 0.0, 0.0, 0.0];
        let mut count = 1;
        for number in temperature.into_iter().chain(bounds.into_iter().flatten()) {
            numbers[count] = number;
            count += 1;
        }
        cells.push(&numbers[..count]);
        cells.words.push(status.name());
    }
}

/// Follows the inputs found, and says where the output may really be.
#[derive(Clone)]
struct AroundOutput<'m> {
    model: &'m Model,
    bounds: Bounds,
    state: State,
    of_bounds: Vec<OperatorState>,
}

impl<'m> AroundOutput<'m> {
    fn new(model: &'m Model, bounds: Bounds, state: &State) -> Result<Self> {
        let of_bounds = bounds.states(state)?;
        Ok(Self {
            model,
            bounds,
            state: state.clone(),
            of_bounds,
        })
    }

    /// The modelled output for the next input, and half the width around it.
    fn step(&mut self, sample: Sample) -> Result<(f64, f64)> {
        let output = self.model.step(&mut self.state, sample)?.output;
        let half = self.bounds.step(&mut self.of_bounds, self.state.input())?;
        Ok((output, half))
    }
}

impl Solving<'_> {
    fn row(&mut self, wanted: Wanted, cells: &mut AddedCells) -> Result<()> {
        let Some(preview) = &mut self.preview else {
            return self.solve(wanted, wanted.target.output, cells);
        };
        for (wanted, asked) in preview.push(wanted)? {
            self.solve(wanted, asked, cells)?;
        }
        Ok(())
    }

    /// All at once, for a model without stages.
    fn series(&mut self, targets: &[f64], tolerance: f64, cells: &mut AddedCells) -> Result<()> {
        let Self {
            inverse,
            state,
            counts,
            ..
        } = self;
        let take = |solution: Solution<f64>| {
            counts.add(solution.status);
            cells.push(&[solution.input]);
            cells.words.push(solution.status.name());
        };
        inverse.each_headed(
            state,
            targets,
            &[],
            tolerance,
            Surroundings::default(),
            take,
        )
    }

    fn rest(&mut self, cells: &mut AddedCells) -> Result<()> {
        while let Some((wanted, asked)) = self.preview.as_mut().and_then(Preview::next) {
            self.solve(wanted, asked, cells)?;
        }
        while !self.early.waiting.is_empty() {
            self.early.write(cells);
        }
        self.early.passed = 0;
        Ok(())
    }

    /// `asked` is the output that the row asks for; a preview may want a little less of it.
    fn solve(&mut self, wanted: Wanted, asked: f64, cells: &mut AddedCells) -> Result<()> {
        let Solution { input, status } = match &self.preview {
            Some(preview) => preview.step(&self.inverse, &mut self.state, wanted, asked)?,
            None => self.inverse.step(&mut self.state, wanted)?,
        };
        let too_soon = self.early.passed < self.early.rows.unwrap_or_default();
        let status = match status {
            Status::Ok if too_soon => Status::Limited,
            status => status,
        };
        self.counts.add(status);
        let bounds = match &mut self.around_output {
            None => None,
            Some(around_output) => {
                let Wanted { dt, load, .. } = wanted;
                let (output, half) = around_output.step(Sample { input, dt, load })?;
                let widest = self.counts.half_width.unwrap_or_default();
                self.counts.half_width = Some(widest.max(half));
                Some([output - half, output + half])
            }
        };
        let early = &mut self.early;
        early.last = (input, self.heated.then(|| self.state.temperature()));
        early.waiting.push_back((bounds, status));
        match too_soon {
            true => early.passed += 1,
            false => early.write(cells),
        }
        Ok(())
    }
}

/// Whether time and load of a sample can be, whatever the state is.
fn accepts(model: &Model, sample: Sample) -> Result<()> {
    let accepted = model.stages().accepts(&StageState::default(), sample);
    accepted.map_err(|error| model.worded(error))?;
    match (&model.load, sample.load) {
        (Some(dependence), Some(load)) => dependence.factors(load).map(|_| ()),
        _ => Ok(()),
    }
}
