//! The runs of models with stages, in one number type.

use crate::port::{count, depth, note, say};
use crate::run::{Core, FORWARD, MOST, Memory, ModelData, Number, Tally, made, note_all};
use core::hint::black_box;
use hysteron_core::{
    Axis, Body, Creep, Direction, Error, Inverse, Load, MAX_CREEP, Model, Plane, Rates, StageState,
    Stages, Target, Turn, Wanted, table_len, turn_capacity,
};

/// Model and stages as in the model file.
pub struct Staged {
    pub model: ModelData,
    pub body: Option<[f64; 4]>,
    pub curves: [&'static [f64]; 5],
    pub spacing: &'static [f64],
    pub creep: [&'static [f64]; 2],
    pub lag: f64,
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

/// The largest number of loads for which there is memory.
const LOADS: usize = 8;

/// The arrays of the stages in the number type.
struct Numbers<T> {
    curves: [[T; LOADS]; 5],
    spacing: [T; MOST + 1],
    creep: [[T; MAX_CREEP]; 2],
}

fn fill<T: Number>(place: &mut [T], numbers: &[f64]) {
    for (place, &number) in place.iter_mut().zip(numbers) {
        *place = T::of(number);
    }
}

impl<T: Number> Numbers<T> {
    fn of(data: &Staged) -> Self {
        let mut all = Self {
            curves: [[T::ZERO; LOADS]; 5],
            spacing: [T::ZERO; MOST + 1],
            creep: [[T::ZERO; MAX_CREEP]; 2],
        };
        for (place, numbers) in all.curves.iter_mut().zip(data.curves) {
            fill(place, numbers);
        }
        fill(&mut all.spacing, data.spacing);
        for (place, numbers) in all.creep.iter_mut().zip(data.creep) {
            fill(place, numbers);
        }
        all
    }

    fn stages(&self, data: &Staged) -> Stages<'_, T> {
        let curve = |k: usize| &self.curves[k][..data.curves[k].len()];
        let creep = |k: usize| &self.creep[k][..data.creep[k].len()];
        Stages {
            body: data.body.map(|body| {
                let [ambient, gain, tau_heating, tau_cooling] = body.map(T::of);
                Body {
                    ambient,
                    gain,
                    tau_heating,
                    tau_cooling,
                }
            }),
            axis: Axis {
                load: Load {
                    loads: curve(0),
                    shifts: curve(1),
                    scales: curve(2),
                    gains: curve(3),
                    offsets: curve(4),
                },
                spacing: &self.spacing[..data.spacing.len()],
            },
            creep: Creep {
                coefficients: creep(0),
                taus: creep(1),
            },
            lag: T::of(data.lag),
            offset: T::of(data.model.offset),
            falling: data.model.sign < 0.0,
        }
    }
}

/// A forward step as an application calls it.
#[inline(never)]
fn forward<T: Number>(
    (stages, rates): (&Stages<'_, T>, &Rates<T>),
    model: &Core<'_, T>,
    state: &mut Memory<'_, T>,
    past: &mut StageState<T>,
    (drive, load): (T, T),
) -> Result<(T, i8), Error> {
    let step = stages.step_at(model, state, past, rates, drive, Some(load))?;
    Ok((step.output, 0))
}

/// An inverse step as an application calls it: the drive and the status.
#[inline(never)]
fn inverse<T: Number>(
    (stages, rates): (&Stages<'_, T>, &Rates<T>),
    inverse: &Inverse<'_, T, &mut [T]>,
    state: &mut Memory<'_, T>,
    past: &mut StageState<T>,
    wanted: Wanted<T>,
) -> Result<(T, i8), Error> {
    let solution = stages.invert_at(inverse, state, past, rates, wanted)?;
    Ok((solution.input, solution.status.number()))
}

/// Model, inverse and stages, ready to step.
struct Subject<'a, T> {
    model: &'a Core<'a, T>,
    inverse: Option<Inverse<'a, T, &'a mut [T]>>,
    stages: Stages<'a, T>,
    rates: Rates<T>,
    drive: (T, T),
    tolerance: T,
}

impl<T: Number> Subject<'_, T> {
    /// As `run::Subject::step`.
    #[inline(always)]
    fn step(
        &self,
        state: &mut Memory<'_, T>,
        past: &mut StageState<T>,
        (kind, value, load): (i8, f64, f64),
    ) -> (Result<(T, i8), Error>, u32) {
        let (value, load) = (T::of(value), T::of(load));
        let around = (&self.stages, &self.rates);
        match &self.inverse {
            Some(core) if kind != FORWARD => {
                let heading = match kind {
                    0 => None,
                    1 => Some(Direction::Rising),
                    _ => Some(Direction::Falling),
                };
                let target = Target {
                    output: value,
                    heading,
                    tolerance: self.tolerance,
                };
                let wanted = Wanted {
                    load: Some(load),
                    drive: self.drive,
                    ..target.into()
                };
                count(|| inverse(around, core, state, past, wanted))
            }
            _ => count(|| forward(around, self.model, state, past, (value, load))),
        }
    }
}

pub fn one<T: Number>(run: &StagedRun) -> Result<(), Error> {
    let (name, number) = (run.name, T::NAME);
    let data = &made::STAGED[run.model];
    let ModelData {
        min, max, levels, ..
    } = data.model;
    let mut weights = [T::ZERO; MOST * (MOST + 1) / 2];
    fill(&mut weights, data.model.weights);
    let plane = Plane::new(T::of(min), T::of(max), levels)?;
    let mut table = [T::ZERO; table_len(MOST)];
    let weights = &weights[..data.model.weights.len()];
    let model = Model::new(plane, data.model.operator, weights, &mut table[..])?;
    let numbers = Numbers::<T>::of(data);
    let stages = numbers.stages(data);
    stages.check(&model)?;
    let (low, high) = data.drive.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let subject = Subject {
        model: &model,
        inverse: model.inverse().ok(),
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
    let mut state = model.state(&mut turns[..])?;
    let mut past = StageState::default();
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
    model.reset_off(&mut state)?;
    past = StageState::default();
    let used = depth(|| {
        for &step in run.steps {
            // Errors were reported above.
            let _ = black_box(subject.step(&mut state, &mut past, step));
        }
    });
    note!("stack\t{number}\t{name}\t{used}");
    let state_size = size_of_val(&state) + turn_capacity(levels) * size_of::<Turn<T>>();
    note!(
        "ram\t{number}\t{name}\t{}\t{state_size}",
        size_of_val(&past)
    );
    Ok(())
}
