//! The signal path of a model over memory of the caller: operators, stages and state. Nothing is
//! allocated after it was made, with success and with errors.

use crate::fault::Result;
use crate::limits::HysteronLimits;
use crate::memory::{Lent, Size};
use crate::objects::{Moves, Start};
use hysteron::{Model, NOISE, Sample, Wanted};
use hysteron_core::{
    Error, Output, Parts, Placed, STATE_NUMBERS, Solution, StageState, Stages, State, Turn,
    table_len, turn_capacity,
};
use std::sync::Arc;

pub(crate) type Core = hysteron_core::Model<f64, &'static mut [f64]>;
pub(crate) type CoreState = State<f64, &'static mut [Turn<f64>]>;

/// A state, and the operators that move it.
pub(crate) struct Path {
    pub(crate) model: Arc<Model>,
    core: Core,
    /// Weights that depend on the load, and the load that the operators are at.
    by_load: Option<(Parts<'static, f64>, Option<Placed<f64>>)>,
    state: CoreState,
    stages: StageState<f64>,
    kept: Kept,
}

/// Where a state was: its turning points, its input, and what the stages remembered.
struct Kept {
    points: &'static mut [f64],
    count: usize,
    input: f64,
    stages: StageState<f64>,
}

/// How many parts the weights have that depend on the load; 0 for weights that do not.
fn parts(model: &Model) -> usize {
    let parts = model.load.as_ref().map_or(0, |load| load.parts().len());
    if parts > 1 { parts } else { 0 }
}

impl Path {
    pub(crate) fn size(model: &Model) -> Size {
        let (levels, parts) = (model.plane().levels(), parts(model));
        let (table, turns) = (table_len(levels), turn_capacity(levels));
        let numbers = table * (1 + parts) + parts + turns;
        Size { numbers, turns }
    }

    /// A path at its start, in memory of [`Path::size`].
    pub(crate) fn new(model: &Arc<Model>, lent: &mut Lent) -> Result<Self> {
        let (plane, operator) = (*model.plane(), model.operator());
        let (table, turns) = (table_len(plane.levels()), turn_capacity(plane.levels()));
        let core = Core::new(plane, operator, model.weights(), lent.numbers(table))?;
        let by_load = model.load.as_ref().filter(|_| parts(model) > 0);
        let by_load = by_load.map(|load| {
            let count = load.parts().len();
            let (tables, offsets) = (lent.numbers(count * table), lent.numbers(count));
            let each = load.parts().iter().zip(tables.chunks_mut(table));
            for ((part, table), offset) in each.zip(offsets.iter_mut()) {
                hysteron_core::Model::new(plane, operator, &part.weights, table)?;
                *offset = part.offset;
            }
            let range = load.range();
            let parts = Parts {
                range,
                offsets,
                tables,
            };
            parts.check(&core)?;
            Ok::<_, Error>((parts, None))
        });
        let mut path = Self {
            model: model.clone(),
            by_load: by_load.transpose()?,
            state: core.state(lent.turns(turns))?,
            core,
            stages: StageState::default(),
            kept: Kept {
                points: lent.numbers(turns),
                count: 0,
                input: 0.0,
                stages: StageState::default(),
            },
        };
        path.start(Start::Fitted)?;
        Ok(path)
    }

    /// Calls `run` with the operators and stages at a load.
    pub(crate) fn at<R>(
        &mut self,
        load: Option<f64>,
        run: impl FnOnce(
            &Stages<'_, f64>,
            &Core,
            &mut CoreState,
            &mut StageState<f64>,
        ) -> std::result::Result<R, Error>,
    ) -> Result<R> {
        let mut stages = self.model.stages();
        if let Some((parts, placed)) = &mut self.by_load {
            stages.offset = parts.place(&mut self.core, &mut self.state, placed, load)?;
        }
        Ok(run(&stages, &self.core, &mut self.state, &mut self.stages)?)
    }

    /// Refuses a sample that the model cannot take, as the library does.
    pub(crate) fn accepts(&self, sample: Sample) -> Result<()> {
        self.model.stages().accepts(&self.stages, sample)?;
        let within = match (&self.model.load, sample.load) {
            (None, None) => true,
            (Some(dependence), Some(load)) => {
                let (low, high) = dependence.range();
                let rounding = NOISE * (high - low);
                (low - rounding..=high + rounding).contains(&load)
            }
            _ => false,
        };
        if within {
            Ok(())
        } else {
            Err(Error::Load.into())
        }
    }

    /// Goes to where another state of the model is.
    pub(crate) fn follow(&mut self, other: &Self) -> Result<()> {
        self.kept.count = 0;
        other.turning_points(&mut |point| self.kept.push(point));
        (self.kept.input, self.kept.stages) = (other.input(), other.stages);
        self.go_back()
    }

    /// Goes to where the state was kept.
    fn go_back(&mut self) -> Result<()> {
        let points = &self.kept.points[..self.kept.count];
        self.core
            .restore(&mut self.state, points, self.kept.input)?;
        self.stages = self.kept.stages;
        Ok(())
    }
}

impl Kept {
    fn push(&mut self, point: f64) {
        if let Some(place) = self.points.get_mut(self.count) {
            *place = point;
            self.count += 1;
        }
    }
}

impl Moves for Path {
    fn model(&self) -> &Model {
        &self.model
    }

    fn step(&mut self, sample: Sample) -> Result<Output<f64>> {
        self.accepts(sample)?;
        self.at(sample.load, |stages, core, state, memory| {
            stages.step(core, state, memory, sample)
        })
    }

    fn run(&mut self, input: &[f64], output: &mut [f64]) -> Result<()> {
        if self.model.is_plain() {
            self.core.run(&mut self.state, input, output)?;
            let (offset, sign) = (self.model.offset(), self.model.sign().factor());
            output.iter_mut().for_each(|y| *y = offset + sign * *y);
            return Ok(());
        }
        for (output, input) in output.iter_mut().zip(input) {
            *output = self.step((*input).into())?.output;
        }
        Ok(())
    }

    fn solve(&mut self, wanted: Wanted, limits: Option<HysteronLimits>) -> Result<Solution<f64>> {
        // Refuses weights below zero.
        self.model.inverse()?;
        self.accepts(Sample {
            input: wanted.target.output,
            dt: wanted.dt,
            load: wanted.load,
        })?;
        let wanted = hysteron_core::Wanted {
            target: wanted.target,
            dt: wanted.dt,
            load: wanted.load,
            drive: limits.map_or_else(|| self.model.drive_range(), |limits| limits.drive()),
            horizon: limits.map_or(0.0, |limits| limits.horizon),
            temperature: wanted.temperature,
        };
        self.at(wanted.load, |stages, core, state, memory| {
            stages.invert(&core.inverse()?, state, memory, wanted)
        })
    }

    fn start(&mut self, start: Start) -> Result<()> {
        match start {
            Start::Fitted => match self.model.fitted() {
                Some(fitted) => {
                    let points: Vec<f64> = fitted.turning_points().collect();
                    self.core
                        .restore(&mut self.state, &points, fitted.input())?;
                }
                None => self.core.reset_off(&mut self.state)?,
            },
            Start::Off => self.core.reset_off(&mut self.state)?,
            Start::On => self.core.reset_on(&mut self.state)?,
        }
        self.stages = StageState::default();
        Ok(())
    }

    fn input(&self) -> f64 {
        self.state.input()
    }

    fn turning_points(&self, each: &mut dyn FnMut(f64)) -> usize {
        self.state.turning_points().for_each(each);
        self.state.held() + 1
    }

    fn restore(&mut self, turning_points: &[f64], input: f64) -> Result<()> {
        self.core.restore(&mut self.state, turning_points, input)?;
        self.stages = StageState::default();
        Ok(())
    }

    fn stage_numbers(&self) -> [f64; STATE_NUMBERS] {
        self.stages.to_numbers()
    }

    fn restore_stages(&mut self, numbers: &[f64; STATE_NUMBERS]) -> Result<()> {
        self.stages = StageState::from_numbers(numbers)?;
        Ok(())
    }

    fn half_width(&self) -> Result<Option<f64>> {
        let Some(bounds) = self.model.bounds()? else {
            return Ok(None);
        };
        let points: Vec<f64> = self.state.turning_points().collect();
        let state = self.model.restore(&points, self.input())?;
        let state = state.with_stage_numbers(&self.stage_numbers())?;
        Ok(Some(bounds.at(&state)?))
    }

    fn keep(&mut self) {
        self.kept.count = 0;
        let points = self.state.turning_points();
        points.for_each(|point| self.kept.push(point));
        (self.kept.input, self.kept.stages) = (self.state.input(), self.stages);
    }

    fn undo(&mut self) {
        // What was kept is a state of this model.
        let _ = self.go_back();
    }
}
