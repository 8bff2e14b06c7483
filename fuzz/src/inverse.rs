//! The inverse: whatever it says is reached, is reached.

use crate::given::{Input, Number, Owned, Setup};
use arbitrary::Arbitrary;
use hysteron_core::{Direction, Error, Operator, Status};

#[derive(Arbitrary, Debug)]
pub struct Walk {
    setup: Setup,
    calls: Vec<Call>,
}

#[derive(Arbitrary, Debug, Clone, Copy)]
enum Call {
    Move(Input),
    To {
        target: Target,
        heading: Option<bool>,
        tolerance: Number,
    },
}

#[derive(Arbitrary, Debug, Clone, Copy)]
enum Target {
    /// A part of the way through the range of the output, and a little beyond it.
    Within(u16),
    /// The present output, and so far from it.
    Near(Number),
    Number(Number),
}

impl Walk {
    pub fn check(&self) {
        let Some(plane) = self.setup.plane() else {
            return;
        };
        let mut weights = self.setup.weights(plane.levels());
        weights.iter_mut().for_each(|mu| *mu = mu.abs());
        let Some(mut owned) = self.setup.build(&weights) else {
            return;
        };
        for &call in &self.calls {
            match call {
                Call::Move(input) => {
                    let _ = owned.0.step(&mut owned.1, input.on(&plane));
                }
                Call::To {
                    target,
                    heading,
                    tolerance,
                } => follow(&mut owned, target, heading, tolerance.get()),
            }
        }
    }
}

fn follow((model, state): &mut Owned, target: Target, heading: Option<bool>, tolerance: f64) {
    let (low, high) = model.output_range();
    let now = model.output(state);
    let target = match target {
        Target::Within(n) => low + (1.2 * Number::Share(n).get() - 0.1) * (high - low),
        Target::Near(number) => now + number.get(),
        Target::Number(number) => number.get(),
    };
    let heading = heading.map(|rising| match rising {
        true => Direction::Rising,
        false => Direction::Falling,
    });
    let wanted = hysteron_core::Target {
        output: target,
        heading,
        tolerance,
    };
    let inverse = model.inverse().expect("weights that are not negative");
    let before = state.clone();
    let solution = match inverse.step(state, wanted) {
        Ok(solution) => solution,
        Err(error) => {
            assert_eq!(error, Error::InputNotFinite { index: 0 });
            assert!(!target.is_finite() && *state == before);
            return;
        }
    };
    assert!(solution.input.is_finite());
    let plane = model.plane();
    // The input is rounded to its own unit: on a plane that is narrow for its distance from zero
    // that is a part of a step.
    let largest = plane.max().abs().max(plane.bottom().abs());
    let rounding =
        (1e-12 + 4.0 * f64::EPSILON * largest / plane.step()) * (high - low) + f64::MIN_POSITIVE;
    let allowed = tolerance.max(0.0) + rounding;
    let reached = model.output(state);
    match solution.status {
        Status::Low => assert!(target < low, "{target:e} is not below {low:e}"),
        Status::High => assert!(target > high, "{target:e} is not above {high:e}"),
        Status::Passed => {
            assert_eq!(model.operator(), Operator::Relay, "only relays jump");
            let short = if target > now {
                target - reached
            } else {
                reached - target
            };
            assert!(short <= 0.0, "{reached:e} lies before {target:e}");
        }
        Status::Limited => panic!("operators alone have no limits"),
        Status::Ok => {
            let off = (reached - target).abs();
            assert!(
                off <= allowed,
                "{reached:e} for {target:e}: off by {off:e} of {allowed:e}"
            );
        }
    }
}
