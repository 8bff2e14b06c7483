//! Stages with constants of any size: those that are taken give numbers, and what the inverse says
//! is reached, is reached.

use crate::given::{Input, Number, Setup};
use arbitrary::Arbitrary;
use hysteron_core::{Sample, StageState, Stages, Status, Target, Wanted};

/// The part of the range by which a target that is reached may be missed, beside its tolerance.
const ROUNDING: f64 = 1e-3;
/// Inputs and steps of time are within this: only constants are of any size.
const LARGEST: f64 = 1e9;

#[derive(Arbitrary, Debug)]
pub struct Chain {
    setup: Setup,
    /// A list for each constant that the stages declare.
    constants: Vec<Vec<Number>>,
    offset: Number,
    falling: bool,
    calls: Vec<(Call, Number)>,
}

#[derive(Arbitrary, Debug, Clone, Copy)]
enum Call {
    Step(Input),
    To(u16),
}

impl Chain {
    pub fn check(&self) {
        let Some(plane) = self.setup.plane() else {
            return;
        };
        let mut weights = self.setup.weights(plane.levels());
        weights.iter_mut().for_each(|mu| *mu = mu.abs());
        let Some((model, mut state)) = self.setup.build(&weights) else {
            return;
        };
        let lists = self.constants.iter();
        let lists = lists.map(|list| list.iter().map(|number| number.get()).collect());
        let lists: Vec<Vec<f64>> = lists.collect();
        let mut next = lists.iter();
        let Ok(stages) = Stages::of_lists(|| next.next().map_or(&[][..], Vec::as_slice)) else {
            return;
        };
        let stages = Stages {
            offset: self.offset.get(),
            falling: self.falling,
            ..stages
        };
        if stages.check(&model).is_err() {
            return;
        }
        let mut memory = StageState::default();
        let (low, high) = model.output_range();
        let gains = stages.axis.load.gains.iter();
        let gain = gains.fold(1.0, |most: f64, gain| most.max(*gain));
        let range = stages.behind.settled(gain * high) - stages.behind.settled(gain * low);
        for (call, dt) in &self.calls {
            let dt = Some(dt.get().clamp(-1.0, LARGEST));
            match call {
                Call::Step(input) => {
                    let input = input.on(&plane).clamp(-LARGEST, LARGEST);
                    let sample = Sample {
                        input,
                        dt,
                        load: Some(0.0),
                    };
                    if let Ok(found) = stages.step(&model, &mut state, &mut memory, sample) {
                        assert!(found.output.is_finite(), "{found:?} of {sample:?}");
                    }
                }
                Call::To(share) => {
                    let share = Number::Share(*share).get();
                    let target = stages.offset + low + share * (high - low);
                    let Ok(inverse) = model.inverse() else { return };
                    let (mut before, mut past) = (state.clone(), memory);
                    let wanted = Wanted {
                        dt,
                        load: Some(0.0),
                        ..Target::new(target).into()
                    };
                    let found = stages.invert(&inverse, &mut state, &mut memory, wanted);
                    let Ok(found) = found else { continue };
                    assert!(found.input.is_finite(), "{found:?} of {wanted:?}");
                    if found.status == Status::Ok {
                        let sample = Sample {
                            input: found.input,
                            dt,
                            load: Some(0.0),
                        };
                        let there = stages.step(&model, &mut before, &mut past, sample);
                        let missed = (there.expect("a drive").output - target).abs();
                        assert!(missed <= ROUNDING * range, "{missed}: {found:?}");
                    }
                }
            }
        }
    }
}
