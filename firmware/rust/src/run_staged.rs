//! The runs of models with stages, in one number type.

use crate::port::{count, depth, note, say};
use crate::run::{Core, FORWARD, MOST, Memory, ModelData, Number, Tally, made, note_all};
use core::hint::black_box;
use hysteron_core::{
    Direction, Error, Model, Parts, Placed, Plane, Rates, StageState, Stages, Target, Turn, Wanted,
    table_len, turn_capacity,
};

/// Model and stages as in the model file.
pub struct Staged {
    pub model: ModelData,
    /// The constants of all stages, by the names that they declare.
    pub constants: &'static [(&'static str, &'static [f64])],
    /// Offset and weights of each part, where the weights depend on the load.
    pub parts: &'static [(f64, &'static [f64])],
    pub range: (f64, f64),
    pub drive: Option<(f64, f64)>,
    pub dt: Option<f64>,
}

/// Kind, value and load of each step.
pub struct StagedRun {
    pub name: &'static str,
    pub model: usize,
    pub tolerance: f64,
    pub steps: &'static [(i8, f64, f64)],
}

/// Room for the constants of the stages, beside the spacing.
const ROOM: usize = 64;

/// The constants of the stages in the number type, one list after the other.
struct Numbers<T>([T; ROOM + MOST + 1]);

fn fill<T: Number>(place: &mut [T], numbers: &[f64]) {
    for (place, &number) in place.iter_mut().zip(numbers) {
        *place = T::of(number);
    }
}

impl<T: Number> Numbers<T> {
    fn of(data: &Staged) -> Self {
        let mut all = Self([T::ZERO; ROOM + MOST + 1]);
        let mut at = 0;
        for (_, list) in data.constants {
            fill(&mut all.0[at..at + list.len()], list);
            at += list.len();
        }
        all
    }

    fn stages(&self, data: &Staged) -> Result<Stages<'_, T>, Error> {
        let list = |name: &str| {
            let mut at = 0;
            for (known, list) in data.constants {
                if *known == name {
                    return &self.0[at..at + list.len()];
                }
                at += list.len();
            }
            &[]
        };
        Ok(Stages {
            offset: T::of(data.model.offset),
            falling: data.model.sign < 0.0,
            ..Stages::with_constants(|constant| list(constant.name))?
        })
    }
}

/// The largest number of parts for which there is memory.
const PARTS: usize = 3;

/// The parts of the weights in the number type.
struct ByLoad<T> {
    offsets: [T; PARTS],
    tables: [T; PARTS * table_len(MOST)],
}

impl<T: Number> ByLoad<T> {
    /// `weights` is room for those of one part.
    fn of(data: &Staged, plane: Plane<T>, weights: &mut [T]) -> Result<Self, Error> {
        let mut all = Self {
            offsets: [T::ZERO; PARTS],
            tables: [T::ZERO; PARTS * table_len(MOST)],
        };
        let tables = all.tables.chunks_exact_mut(table_len(data.model.levels));
        for ((place, table), (offset, part)) in all.offsets.iter_mut().zip(tables).zip(data.parts) {
            *place = T::of(*offset);
            fill(weights, part);
            Model::new(plane, data.model.operator, &weights[..part.len()], table)?;
        }
        Ok(all)
    }

    fn parts(&self, data: &Staged) -> Option<Parts<'_, T>> {
        let count = data.parts.len();
        (count > 0).then(|| Parts {
            range: (T::of(data.range.0), T::of(data.range.1)),
            offsets: &self.offsets[..count],
            tables: &self.tables[..count * table_len(data.model.levels)],
        })
    }
}

/// Model and stages, ready to step.
struct Subject<'a, T> {
    model: Core<'a, T>,
    parts: Option<Parts<'a, T>>,
    placed: Option<Placed<T>>,
    stages: Stages<'a, T>,
    rates: Rates<T>,
    drive: (T, T),
    tolerance: T,
}

impl<'a, T: Number> Subject<'a, T> {
    /// The stages at a load, to which it brings model and state.
    #[inline(always)]
    fn placed(&mut self, state: &mut Memory<'_, T>, load: T) -> Result<Stages<'a, T>, Error> {
        let stages = self.stages;
        let Some(parts) = &self.parts else {
            return Ok(stages);
        };
        let offset = parts.place(&mut self.model, state, &mut self.placed, Some(load))?;
        Ok(Stages { offset, ..stages })
    }

    /// A forward step as an application calls it.
    #[inline(never)]
    fn forward(
        &mut self,
        state: &mut Memory<'_, T>,
        past: &mut StageState<T>,
        (drive, load): (T, T),
    ) -> Result<(T, i8), Error> {
        let stages = self.placed(state, load)?;
        let step = stages.step_at(&self.model, state, past, &self.rates, drive, Some(load))?;
        Ok((step.output, 0))
    }

    /// An inverse step as an application calls it: the drive and the status.
    #[inline(never)]
    fn inverse(
        &mut self,
        state: &mut Memory<'_, T>,
        past: &mut StageState<T>,
        (target, load): (Target<T>, T),
    ) -> Result<(T, i8), Error> {
        let stages = self.placed(state, load)?;
        let wanted = Wanted {
            load: Some(load),
            drive: self.drive,
            ..target.into()
        };
        let inverse = self.model.inverse()?;
        let solution = stages.invert_at(&inverse, state, past, &self.rates, wanted)?;
        Ok((solution.input, solution.status.number()))
    }

    /// As `run::Subject::step`.
    #[inline(always)]
    fn step(
        &mut self,
        state: &mut Memory<'_, T>,
        past: &mut StageState<T>,
        (kind, value, load): (i8, f64, f64),
    ) -> (Result<(T, i8), Error>, u32) {
        let (value, load) = (T::of(value), T::of(load));
        let heading = match kind {
            FORWARD => return count(|| self.forward(state, past, (value, load))),
            0 => None,
            1 => Some(Direction::Rising),
            _ => Some(Direction::Falling),
        };
        let target = Target {
            output: value,
            heading,
            tolerance: self.tolerance,
        };
        count(|| self.inverse(state, past, (target, load)))
    }
}

pub fn one<T: Number>(run: &StagedRun) -> Result<(), Error> {
    let (name, number) = (run.name, T::NAME);
    let data = &made::STAGED[run.model];
    let ModelData {
        min, max, levels, ..
    } = data.model;
    let mut weights = [T::ZERO; MOST * (MOST + 1) / 2];
    let plane = Plane::new(T::of(min), T::of(max), levels)?;
    let by_load = ByLoad::of(data, plane, &mut weights)?;
    fill(&mut weights, data.model.weights);
    let mut table = [T::ZERO; table_len(MOST)];
    let weights = &weights[..data.model.weights.len()];
    let model = Model::new(plane, data.model.operator, weights, &mut table[..])?;
    let numbers = Numbers::<T>::of(data);
    let stages = numbers.stages(data)?;
    stages.check(&model)?;
    let (low, high) = data.drive.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let parts = by_load.parts(data);
    let mut subject = Subject {
        model,
        parts,
        placed: None,
        rates: data
            .dt
            .map(|dt| stages.rates(T::of(dt)))
            .unwrap_or_default(),
        stages,
        drive: (T::of(low), T::of(high)),
        tolerance: T::of(run.tolerance),
    };

    let mut turns = [Turn::default(); turn_capacity(MOST)];
    let mut other_turns = turns;
    let mut points = [T::ZERO; turn_capacity(MOST)];
    let mut state = subject.model.state(&mut turns[..])?;
    let mut past = StageState::default();
    let mut tallies: [Tally; 2] = Default::default();
    say!("{number} {name}");
    for (n, &step) in run.steps.iter().enumerate() {
        // A state that was saved and restored before this step has to give the same result.
        let mut restored = subject.model.state(&mut other_turns[..])?;
        let mut held = 0;
        for x in state.turning_points() {
            points[held] = x;
            held += 1;
        }
        let model = &subject.model;
        model.restore(&mut restored, &points[..held], state.input())?;
        let mut restored_past = StageState::from_numbers(&past.to_numbers())?;

        let (result, instructions) = subject.step(&mut state, &mut past, step);
        let (result, status) = result?;
        let (other, other_status) = subject.step(&mut restored, &mut restored_past, step).0?;
        tallies[usize::from(step.0 != FORWARD)].add(instructions, n);
        let digits = 2 * size_of::<T>();
        say!("{:0digits$x} {status}", result.bits());
        if (other.bits(), other_status) != (result.bits(), status) {
            say!("restored: {:0digits$x} {other_status}", other.bits());
        }
    }
    note_all(tallies, number, name);

    // Again without printing, for the stack.
    subject.model.reset_off(&mut state)?;
    past = StageState::default();
    let used = depth(|| {
        for &step in run.steps {
            // Errors were reported above.
            let _ = black_box(subject.step(&mut state, &mut past, step));
        }
    });
    note!("stack\t{number}\t{name}\t{used}");
    let state_size = size_of_val(&state) + turn_capacity(levels) * size_of::<Turn<T>>();
    let mixed = match subject.parts {
        Some(_) => size_of::<Core<'_, T>>() + table_len(levels) * size_of::<T>(),
        None => 0,
    };
    note!(
        "ram\t{number}\t{name}\t{}\t{state_size}",
        size_of_val(&past) + mixed
    );
    Ok(())
}
