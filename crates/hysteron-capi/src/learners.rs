//! What learns behind a handle: learners of the library, and the same over memory of the caller.

use crate::fault::Result;
use crate::memory::{Lent, Size};
use crate::objects::{Learns, Moves, Start};
use crate::path::{Core, CoreState, Path};
use crate::shift_options::HysteronShift;
use hysteron::control::Compensator;
use hysteron::{Adaptation, Adaptive, AdaptiveLoad, Learning, Method, Model, Sample, Wanted};
use hysteron_core::{
    Error, Estimator, ShiftEstimator, ShiftOptions, Solution, StageState, Stages, estimator_len,
    table_len, turn_capacity,
};
use std::sync::Arc;

impl Learns for Adaptive {
    fn step(&mut self, sample: Sample, measured: f64) -> Result<Learning<f64>> {
        Ok(Adaptive::step(self, sample, measured)?)
    }

    fn simulate(&mut self, sample: Sample) -> Result<f64> {
        Ok(Adaptive::simulate(self, sample)?)
    }

    fn solve(&mut self, wanted: Wanted) -> Result<Solution<f64>> {
        Ok(Adaptive::solve(self, wanted)?)
    }

    fn model(&self) -> Result<Model> {
        Ok(Adaptive::model(self)?)
    }

    fn reset(&mut self) -> Result<()> {
        Ok(Adaptive::reset(self)?)
    }

    fn align(&mut self) -> Result<()> {
        Adaptive::align(self);
        Ok(())
    }

    fn freeze(&mut self, frozen: bool) {
        Adaptive::freeze(self, frozen);
    }

    fn keep(&mut self) -> Result<()> {
        Adaptive::keep(self);
        Ok(())
    }

    fn roll_back(&mut self) -> Result<()> {
        Ok(Adaptive::roll_back(self)?)
    }

    fn in_loop(&self) -> Result<Compensator> {
        Ok(Compensator::adaptive(self.clone()))
    }
}

impl Learns for AdaptiveLoad {
    fn step(&mut self, sample: Sample, measured: f64) -> Result<Learning<f64>> {
        Ok(AdaptiveLoad::step(self, sample, measured)?)
    }

    fn simulate(&mut self, sample: Sample) -> Result<f64> {
        Ok(AdaptiveLoad::simulate(self, sample)?)
    }

    fn solve(&mut self, wanted: Wanted) -> Result<Solution<f64>> {
        Ok(AdaptiveLoad::solve(self, wanted)?)
    }

    fn model(&self) -> Result<Model> {
        Ok(AdaptiveLoad::model(self)?)
    }

    fn reset(&mut self) -> Result<()> {
        AdaptiveLoad::reset(self);
        Ok(())
    }

    fn align(&mut self) -> Result<()> {
        AdaptiveLoad::align(self);
        Ok(())
    }

    fn freeze(&mut self, frozen: bool) {
        AdaptiveLoad::freeze(self, frozen);
    }

    fn shift(&self) -> Result<HysteronShift> {
        Ok(HysteronShift {
            shift: AdaptiveLoad::shift(self),
            deviation: self.deviation(),
            load: self.load().unwrap_or(f64::NAN),
        })
    }

    fn in_loop(&self) -> Result<Compensator> {
        Ok(Compensator::load(self.clone()))
    }
}

/// As [`Adaptive`], over memory of the caller.
pub(crate) struct WeightsOfCaller {
    model: Arc<Model>,
    core: Core,
    state: CoreState,
    /// State of the inverse.
    wanted: CoreState,
    estimator: Estimator<f64, &'static mut [f64]>,
    /// Room for the turning points of a state.
    points: &'static mut [f64],
}

fn tables(method: Method<f64>) -> usize {
    match method {
        Method::Increments { .. } => 2,
        _ => 1,
    }
}

impl WeightsOfCaller {
    pub(crate) fn size(model: &Model, method: Method<f64>) -> Result<Size> {
        let levels = model.plain()?.plane().levels();
        let turns = turn_capacity(levels);
        let numbers = tables(method) * table_len(levels) + estimator_len(levels, method) + turns;
        Ok(Size {
            numbers,
            turns: 2 * turns,
        })
    }

    /// A learner at its start, in memory of [`WeightsOfCaller::size`].
    pub(crate) fn new(
        model: &Arc<Model>,
        options: Adaptation<f64>,
        lent: &mut Lent,
    ) -> Result<Self> {
        let (plane, operator) = (*model.plane(), model.operator());
        let levels = plane.levels();
        let table = lent.numbers(tables(options.method) * table_len(levels));
        let mut core = Core::new(plane, operator, model.weights(), table)?;
        let memory = lent.numbers(estimator_len(levels, options.method));
        let offset = model.sign().factor() * model.offset();
        let estimator = Estimator::new(options, &mut core, model.weights(), offset, memory)?;
        let turns = turn_capacity(levels);
        Ok(Self {
            model: model.clone(),
            state: core.state(lent.turns(turns))?,
            wanted: core.state(lent.turns(turns))?,
            points: lent.numbers(turns),
            core,
            estimator,
        })
    }

    fn factor(&self) -> f64 {
        self.model.sign().factor()
    }
}

impl Learns for WeightsOfCaller {
    fn step(&mut self, sample: Sample, measured: f64) -> Result<Learning<f64>> {
        let factor = self.factor();
        let (core, state) = (&mut self.core, &mut self.state);
        let learning = self
            .estimator
            .step(core, state, sample.input, factor * measured)?;
        Ok(Learning {
            output: factor * learning.output,
            error: factor * learning.error,
            ..learning
        })
    }

    fn simulate(&mut self, sample: Sample) -> Result<f64> {
        let sum = self.core.step(&mut self.state, sample.input)?.output;
        Ok(self.factor() * (sum + self.estimator.offset()))
    }

    fn solve(&mut self, wanted: Wanted) -> Result<Solution<f64>> {
        let stages = Stages {
            offset: self.factor() * self.estimator.offset(),
            falling: self.factor() < 0.0,
            ..Stages::NONE
        };
        self.core.rebase(&mut self.wanted)?;
        let (inverse, memory) = (self.core.inverse()?, &mut StageState::default());
        Ok(stages.invert(&inverse, &mut self.wanted, memory, wanted.target.into())?)
    }

    fn model(&self) -> Result<Model> {
        let (weights, offset) = (self.estimator.parameters(), self.estimator.offset());
        let (operator, plane) = (self.model.operator(), *self.model.plane());
        let (offset, sign) = (self.factor() * offset, self.model.sign());
        let model = Model::new(operator, plane, weights.to_vec(), offset, sign)?;
        let mut model = model.with_delay(self.model.delay());
        (model.input, model.output) = (self.model.input.clone(), self.model.output.clone());
        Ok(model)
    }

    fn reset(&mut self) -> Result<()> {
        self.estimator.realign();
        self.core.reset_off(&mut self.state)?;
        Ok(self.core.reset_off(&mut self.wanted)?)
    }

    fn align(&mut self) -> Result<()> {
        let mut count = 0;
        for (place, point) in self.points.iter_mut().zip(self.state.turning_points()) {
            *place = point;
            count += 1;
        }
        let (points, input) = (&self.points[..count], self.state.input());
        Ok(self.core.restore(&mut self.wanted, points, input)?)
    }

    fn freeze(&mut self, frozen: bool) {
        self.estimator.freeze(frozen);
    }

    fn keep(&mut self) -> Result<()> {
        self.estimator.keep();
        Ok(())
    }

    fn roll_back(&mut self) -> Result<()> {
        self.estimator.roll_back(&mut self.core);
        Ok(self.core.rebase(&mut self.state)?)
    }
}

/// As [`AdaptiveLoad`], over memory of the caller.
pub(crate) struct LoadOfCaller {
    estimator: ShiftEstimator<f64>,
    /// The load that the shift departs from, and the load that the weights are those of.
    told: Option<f64>,
    placed: Option<f64>,
    path: Path,
    /// The path of the inverse.
    wanted: Path,
    /// The path of the model left alone.
    alone: Path,
}

impl LoadOfCaller {
    pub(crate) fn size(model: &Model) -> Size {
        Path::size(model).times(3)
    }

    /// A learner at its start, in memory of [`LoadOfCaller::size`].
    pub(crate) fn new(
        model: &Arc<Model>,
        load: Option<f64>,
        options: Option<ShiftOptions<f64>>,
        lent: &mut Lent,
    ) -> Result<Self> {
        // The library checks, and chooses load and options.
        let checked = AdaptiveLoad::new(model, load, options)?;
        let (told, options) = (checked.told(), *checked.options());
        let mut path = Path::new(model, lent)?;
        let new = |stages: &Stages<'_, f64>, core: &Core, _: &mut _, _: &mut _| {
            ShiftEstimator::new(options, core, stages)
        };
        let mut learner = Self {
            estimator: path.at(told, new)?,
            told,
            placed: told,
            path,
            wanted: Path::new(model, lent)?,
            alone: Path::new(model, lent)?,
        };
        learner.reset()?;
        Ok(learner)
    }

    fn sample(&self, sample: Sample) -> Sample {
        let load = self.told;
        Sample { load, ..sample }
    }
}

impl Learns for LoadOfCaller {
    fn step(&mut self, sample: Sample, measured: f64) -> Result<Learning<f64>> {
        let sample = self.sample(sample);
        if !measured.is_finite() {
            return Err(Error::InputNotFinite { index: 1 }.into());
        }
        self.estimator.expect(self.alone.step(sample)?.output)?;
        let (estimator, told, placed) = (&mut self.estimator, self.told, self.placed);
        let range = self.path.model.load.as_ref().map(|load| load.range());
        let (learning, placed) = self.path.at(placed, |stages, core, state, memory| {
            let learning = estimator.step(stages, core, state, memory, sample, measured)?;
            let placed = match (placed, range) {
                (Some(at), Some(range)) => {
                    Some(estimator.renewed(&stages.axis.load, told, at, range)?)
                }
                _ => placed,
            };
            Ok((learning, placed))
        })?;
        self.placed = placed;
        Ok(learning)
    }

    fn simulate(&mut self, sample: Sample) -> Result<f64> {
        let sample = self.sample(sample);
        self.alone.step(sample)?;
        let estimator = &self.estimator;
        let output = self.path.at(self.placed, |stages, core, state, memory| {
            estimator.simulate(stages, core, state, memory, sample)
        })?;
        Ok(output.output)
    }

    fn solve(&mut self, wanted: Wanted) -> Result<Solution<f64>> {
        let model = &self.path.model;
        // Refuses weights below zero.
        model.inverse()?;
        let wanted = hysteron_core::Wanted {
            target: wanted.target,
            dt: wanted.dt,
            load: self.told,
            drive: model.drive_range(),
            horizon: 0.0,
            temperature: wanted.temperature,
        };
        let estimator = &self.estimator;
        self.wanted.at(self.placed, |stages, core, state, memory| {
            estimator.invert(stages, &core.inverse()?, state, memory, wanted)
        })
    }

    fn model(&self) -> Result<Model> {
        Ok(self.path.model.shifted(self.told, self.estimator.shift())?)
    }

    fn reset(&mut self) -> Result<()> {
        self.estimator.realign();
        self.path.start(Start::Off)?;
        self.wanted.start(Start::Off)?;
        self.alone.start(Start::Off)
    }

    fn align(&mut self) -> Result<()> {
        self.wanted.follow(&self.path)
    }

    fn freeze(&mut self, frozen: bool) {
        self.estimator.freeze(frozen);
    }

    fn shift(&self) -> Result<HysteronShift> {
        let load = &self.path.model.stages().axis.load;
        let told = self.estimator.load(load, self.told)?;
        Ok(HysteronShift {
            shift: self.estimator.shift(),
            deviation: self.estimator.variance().sqrt(),
            load: told.unwrap_or(f64::NAN),
        })
    }
}
