//! States and learners behind a dead time.

use crate::delay::{MOST, UnderWay};
use crate::fault::Result;
use crate::limits::HysteronLimits;
use crate::memory::{Lent, Size};
use crate::objects::{Learns, Moves, Start, too_many};
use crate::shift_options::HysteronShift;
use hysteron::control::Compensator;
use hysteron::{Learning, Model, Sample, Wanted};
use hysteron_core::{Output, STATE_NUMBERS, Solution};

/// What takes the inputs as they act, behind a dead time.
pub(crate) struct Late<T: ?Sized, B> {
    object: Box<T>,
    under_way: UnderWay<B>,
    kept: UnderWay<B>,
}

impl<T: ?Sized, B: AsRef<[f64]> + AsMut<[f64]>> Late<T, B> {
    fn around(model: &Model, object: Box<T>, mut memory: impl FnMut() -> B) -> Self {
        Self {
            object,
            under_way: UnderWay::new(dead(model), memory()),
            kept: UnderWay::new(dead(model), memory()),
        }
    }

    /// Passes on the input that acts. After an error nothing is under way that was not before.
    fn pass<R>(
        &mut self,
        sample: Sample,
        step: impl FnOnce(&mut T, Sample) -> Result<R>,
    ) -> Result<R> {
        let acting = match sample.input.is_finite() {
            true => self.under_way.acting(sample.input, sample.dt),
            false => sample.input,
        };
        let input = sample.input;
        let done = step(
            &mut self.object,
            Sample {
                input: acting,
                ..sample
            },
        )?;
        self.under_way.push(input, sample.dt);
        Ok(done)
    }
}

/// The dead time of a model: samples, and s.
fn dead(model: &Model) -> (usize, f64) {
    let delay = model.delay();
    (delay.samples(), delay.seconds())
}

/// The inputs under way of a lane.
pub(crate) fn under_way(model: &Model) -> UnderWay<Vec<f64>> {
    let room = if model.delay().is_none() { 0 } else { MOST };
    UnderWay::new(dead(model), vec![0.0; room])
}

/// Memory of a dead time.
pub(crate) fn size(model: &Model) -> Size {
    let numbers = if model.delay().is_none() { 0 } else { 2 * MOST };
    Size { numbers, turns: 0 }
}

/// The object behind the dead time of its model: itself where there is none. `late` makes an object
/// of the same kind of both.
fn behind<T: ?Sized, B: AsRef<[f64]> + AsMut<[f64]>>(
    model: &Model,
    object: Box<T>,
    memory: impl FnMut() -> B,
    late: fn(Late<T, B>) -> Box<T>,
) -> Box<T> {
    match model.delay().is_none() {
        true => object,
        false => late(Late::around(model, object, memory)),
    }
}

/// A state behind the dead time of its model.
pub(crate) fn moves(model: &Model, state: Box<dyn Moves>) -> Box<dyn Moves> {
    behind(model, state, || vec![0.0; MOST], |late| Box::new(late))
}

/// The same in memory of the caller.
pub(crate) fn moves_of_caller(
    model: &Model,
    state: Box<dyn Moves>,
    lent: &mut Lent,
) -> Box<dyn Moves> {
    behind(model, state, || lent.numbers(MOST), |late| Box::new(late))
}

/// A learner behind the dead time of its model.
pub(crate) fn learns(model: &Model, learner: Box<dyn Learns>) -> Box<dyn Learns> {
    behind(model, learner, || vec![0.0; MOST], |late| Box::new(late))
}

/// The same in memory of the caller.
pub(crate) fn learns_of_caller(
    model: &Model,
    learner: Box<dyn Learns>,
    lent: &mut Lent,
) -> Box<dyn Learns> {
    behind(model, learner, || lent.numbers(MOST), |late| Box::new(late))
}

impl<B: AsRef<[f64]> + AsMut<[f64]> + Send> Moves for Late<dyn Moves, B> {
    fn model(&self) -> &Model {
        self.object.model()
    }

    fn step(&mut self, sample: Sample) -> Result<Output<f64>> {
        self.pass(sample, |state, sample| state.step(sample))
    }

    fn run(&mut self, input: &[f64], output: &mut [f64]) -> Result<()> {
        for (output, input) in output.iter_mut().zip(input) {
            *output = self.step((*input).into())?.output;
        }
        Ok(())
    }

    fn solve(&mut self, wanted: Wanted, limits: Option<HysteronLimits>) -> Result<Solution<f64>> {
        let solution = self.object.solve(wanted, limits)?;
        self.under_way.clear();
        Ok(solution)
    }

    fn start(&mut self, start: Start) -> Result<()> {
        self.object.start(start)?;
        self.under_way.clear();
        Ok(())
    }

    fn input(&self) -> f64 {
        self.object.input()
    }

    fn turning_points(&self, each: &mut dyn FnMut(f64)) -> usize {
        self.object.turning_points(each)
    }

    fn restore(&mut self, turning_points: &[f64], input: f64) -> Result<()> {
        self.object.restore(turning_points, input)?;
        self.under_way.clear();
        Ok(())
    }

    fn stage_numbers(&self) -> [f64; STATE_NUMBERS] {
        self.object.stage_numbers()
    }

    fn restore_stages(&mut self, numbers: &[f64; STATE_NUMBERS]) -> Result<()> {
        self.object.restore_stages(numbers)
    }

    fn under_way(&self, each: &mut dyn FnMut(f64)) -> usize {
        self.under_way.inputs().map(each).count()
    }

    fn restore_under_way(&mut self, inputs: &[f64]) -> Result<()> {
        match self.under_way.restore(inputs) {
            true => Ok(()),
            false => too_many(),
        }
    }

    fn half_width(&self) -> Result<Option<f64>> {
        self.object.half_width()
    }

    fn keep(&mut self) {
        self.object.keep();
        self.kept.follow(&self.under_way);
    }

    fn undo(&mut self) {
        self.object.undo();
        self.under_way.follow(&self.kept);
    }
}

impl<B: AsRef<[f64]> + AsMut<[f64]> + Send> Learns for Late<dyn Learns, B> {
    fn step(&mut self, sample: Sample, measured: f64) -> Result<Learning<f64>> {
        self.pass(sample, |learner, sample| learner.step(sample, measured))
    }

    fn simulate(&mut self, sample: Sample) -> Result<f64> {
        self.pass(sample, |learner, sample| learner.simulate(sample))
    }

    fn solve(&mut self, wanted: Wanted) -> Result<Solution<f64>> {
        self.object.solve(wanted)
    }

    fn model(&self) -> Result<Model> {
        self.object.model()
    }

    fn reset(&mut self) -> Result<()> {
        self.object.reset()?;
        self.under_way.clear();
        Ok(())
    }

    fn align(&mut self) -> Result<()> {
        self.object.align()
    }

    fn freeze(&mut self, frozen: bool) {
        self.object.freeze(frozen);
    }

    fn keep(&mut self) -> Result<()> {
        self.object.keep()
    }

    fn roll_back(&mut self) -> Result<()> {
        self.object.roll_back()
    }

    fn shift(&self) -> Result<HysteronShift> {
        self.object.shift()
    }

    /// A loop has its own inputs under way.
    fn in_loop(&self) -> Result<Compensator> {
        self.object.in_loop()
    }
}
