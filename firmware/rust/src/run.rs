//! All runs, one after the other, in one number type.

use crate::port::{count, depth, note, say};
use crate::run_staged;
use core::hint::black_box;
use hysteron_core::{
    Direction, Error, Inverse, Model, Operator, Plane, Real, State, Target, Turn, table_len,
    turn_capacity,
};

/// The model as in the model file.
pub struct ModelData {
    pub operator: Operator,
    pub min: f64,
    pub max: f64,
    pub levels: usize,
    pub offset: f64,
    pub sign: f64,
    pub weights: &'static [f64],
}

/// Steps, from all operators off: kind (2 for forward, otherwise the heading of an inverse step)
/// and value.
pub struct Run {
    pub name: &'static str,
    pub model: usize,
    pub tolerance: f64,
    pub steps: &'static [(i8, f64)],
}

pub mod made {
    use super::{ModelData as Model, Operator, Run};
    use crate::run_staged::{Staged, StagedRun};
    include!(concat!(env!("OUT_DIR"), "/runs.rs"));
}

pub const FORWARD: i8 = 2;
/// The largest number of levels for which there is memory.
pub const MOST: usize = 40;

/// `f32` or `f64`.
pub trait Number: Real {
    const NAME: &'static str;
    fn of(value: f64) -> Self;
}

impl Number for f32 {
    const NAME: &'static str = "float";
    fn of(value: f64) -> Self {
        value as f32
    }
}

impl Number for f64 {
    const NAME: &'static str = "double";
    fn of(value: f64) -> Self {
        value
    }
}

pub fn all<T: Number>() -> Result<(), Error> {
    made::RUNS.iter().try_for_each(one::<T>)?;
    made::STAGED_RUNS.iter().try_for_each(run_staged::one::<T>)
}

pub type Core<'a, T> = Model<T, &'a mut [T]>;
pub type Memory<'a, T> = State<T, &'a mut [Turn<T>]>;

/// The output in the model's unit, `offset + sign · Σ μ γ`, as the library computes it.
struct Line<T> {
    offset: T,
    sign: T,
}

/// A forward step as an application calls it.
#[inline(never)]
fn forward<T: Number>(
    model: &Core<'_, T>,
    line: &Line<T>,
    state: &mut Memory<'_, T>,
    input: T,
) -> Result<(T, i8), Error> {
    let step = model.step(state, input)?;
    Ok((line.offset + line.sign * step.output, 0))
}

/// An inverse step as an application calls it: the input and the status.
#[inline(never)]
fn inverse<T: Number>(
    inverse: &Inverse<'_, T, &mut [T]>,
    line: &Line<T>,
    state: &mut Memory<'_, T>,
    target: T,
    heading: i8,
    tolerance: T,
) -> Result<(T, i8), Error> {
    let negative = line.sign < T::ZERO;
    let heading = match heading {
        0 => None,
        way if (way > 0) != negative => Some(Direction::Rising),
        _ => Some(Direction::Falling),
    };
    let target = Target {
        output: line.sign * (target - line.offset),
        heading,
        tolerance,
    };
    let solution = inverse.step(state, target)?;
    let status = match negative {
        true => solution.status.mirrored(),
        false => solution.status,
    };
    Ok((solution.input, status.number()))
}

/// Model and inverse, ready to step.
struct Subject<'a, T> {
    model: &'a Core<'a, T>,
    inverse: Inverse<'a, T, &'a mut [T]>,
    line: Line<T>,
    tolerance: T,
}

impl<T: Number> Subject<'_, T> {
    /// Result, status and number of instructions of one step. Inlined, so that the stack has
    /// nothing between the measurement and the step.
    #[inline(always)]
    fn step(
        &self,
        state: &mut Memory<'_, T>,
        (kind, value): (i8, f64),
    ) -> (Result<(T, i8), Error>, u32) {
        let value = T::of(value);
        if kind == FORWARD {
            count(|| forward(self.model, &self.line, state, value))
        } else {
            let tolerance = self.tolerance;
            count(|| inverse(&self.inverse, &self.line, state, value, kind, tolerance))
        }
    }
}

/// The cost of the steps of one kind.
#[derive(Default)]
pub struct Tally {
    steps: u32,
    instructions: u64,
    most: u32,
    /// Index of the step that took most.
    which: usize,
}

impl Tally {
    pub fn add(&mut self, instructions: u32, step: usize) {
        self.steps += 1;
        self.instructions += u64::from(instructions);
        if instructions > self.most {
            (self.most, self.which) = (instructions, step);
        }
    }
}

pub fn note_all(tallies: [Tally; 2], number: &str, name: &str) {
    for (kind, tally) in ["forward", "inverse"].iter().zip(tallies) {
        let Tally {
            steps,
            instructions,
            most,
            which,
        } = tally;
        if steps > 0 {
            note!("steps\t{number}\t{name}\t{kind}\t{steps}\t{instructions}\t{most}\t{which}");
        }
    }
}

fn one<T: Number>(run: &Run) -> Result<(), Error> {
    let (name, number) = (run.name, T::NAME);
    let data = &made::MODELS[run.model];
    let mut weights = [T::ZERO; MOST * (MOST + 1) / 2];
    for (place, &weight) in weights.iter_mut().zip(data.weights) {
        *place = T::of(weight);
    }
    let plane = Plane::new(T::of(data.min), T::of(data.max), data.levels)?;
    let mut table = [T::ZERO; table_len(MOST)];
    let weights = &weights[..data.weights.len()];
    let model = Model::new(plane, data.operator, weights, &mut table[..])?;
    let subject = Subject {
        model: &model,
        inverse: model.inverse()?,
        line: Line {
            offset: T::of(data.offset),
            sign: T::of(data.sign),
        },
        tolerance: T::of(run.tolerance),
    };

    let mut turns = [Turn::default(); turn_capacity(MOST)];
    let mut other_turns = turns;
    let mut points = [T::ZERO; turn_capacity(MOST)];
    let mut state = model.state(&mut turns[..])?;
    let mut tallies: [Tally; 2] = Default::default();
    say!("{number} {name}");
    for (n, &step) in run.steps.iter().enumerate() {
        // A state that was saved and restored before this step has to give the same result.
        let mut restored = model.state(&mut other_turns[..])?;
        let mut held = 0;
        for x in state.turning_points() {
            points[held] = x;
            held += 1;
        }
        model.restore(&mut restored, &points[..held], state.input())?;

        let (result, instructions) = subject.step(&mut state, step);
        let (result, status) = result?;
        let (other, other_status) = subject.step(&mut restored, step).0?;
        tallies[usize::from(step.0 != FORWARD)].add(instructions, n);
        let digits = 2 * size_of::<T>();
        say!("{:0digits$x} {status}", result.bits());
        if (other.bits(), other_status) != (result.bits(), status) {
            say!("restored: {:0digits$x} {other_status}", other.bits());
        }
    }
    note_all(tallies, number, name);

    // Again without printing, for the stack.
    model.reset_off(&mut state)?;
    let used = depth(|| {
        for &step in run.steps {
            // Errors were reported above.
            let _ = black_box(subject.step(&mut state, step));
        }
    });
    note!("stack\t{number}\t{name}\t{used}");
    let model_size = size_of_val(&model) + table_len(data.levels) * size_of::<T>();
    let state_size = size_of_val(&state) + turn_capacity(data.levels) * size_of::<Turn<T>>();
    note!("ram\t{number}\t{name}\t{model_size}\t{state_size}");
    Ok(())
}
