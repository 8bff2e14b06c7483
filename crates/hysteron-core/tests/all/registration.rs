//! Two input curves, for rising and for falling input: every operator follows its definition.

use crate::common::stages::{ascending, registration};
use crate::common::{OPERATORS, build, inputs, levels, plane, rng, weights};
use hysteron_core::{
    Axis, Definition, Direction, Load, Loaded, Operator, Plane, Registration, Sample, StageState,
    Stages, Status, Target, Wanted,
};
use rand::RngExt;
use rand::rngs::StdRng;

/// Random loads and curves over them.
struct Curves {
    loads: Vec<f64>,
    shifts: Vec<f64>,
    lists: [Vec<f64>; 3],
}

impl Curves {
    fn random(rng: &mut StdRng, plane: &Plane<f64>) -> Self {
        let span = plane.max() - plane.bottom();
        let loads: usize = rng.random_range(0..5);
        let mut lists = [const { Vec::new() }; 3];
        while lists[0].is_empty() {
            lists = registration(rng, (plane.bottom(), span), loads);
        }
        Self {
            loads: ascending(rng, loads, 0.0, 10.0),
            shifts: (0..loads)
                .map(|_| span * rng.random_range(-0.3..0.3))
                .collect(),
            lists,
        }
    }

    fn stages(&self) -> Stages<'_, f64> {
        let [knots, rising, falling] = &self.lists;
        let axis = Axis {
            load: Load {
                loads: &self.loads,
                shifts: &self.shifts,
                ..Load::NONE
            },
            registration: Registration {
                knots,
                rising,
                falling,
            },
            ..Axis::PLAIN
        };
        Stages {
            axis,
            ..Stages::NONE
        }
    }
}

/// MKP or KP operators one by one, each with two inputs: `γ ← max(r_j(x↑), min(γ, r_i(x↓)))`.
struct Operators {
    operator: Operator,
    plane: Plane<f64>,
    weights: Vec<f64>,
    gammas: Vec<f64>,
}

impl Operators {
    fn step(&mut self, up: f64, down: f64) -> f64 {
        let Self {
            operator,
            plane,
            weights,
            gammas,
        } = self;
        let (up, down) = (plane.normalise(up), plane.normalise(down));
        let ridge = |x: f64, level: usize| (x - (level as f64 - 1.0)).clamp(0.0, 1.0);
        let (mut sum, mut n) = (0.0, 0);
        for j in 1..=plane.levels() {
            for i in 1..=j {
                gammas[n] = f64::max(ridge(up, j), f64::min(gammas[n], ridge(down, i)));
                sum += match operator {
                    Operator::Mkp => weights[n] * gammas[n],
                    _ => weights[n] * (2.0 * gammas[n] - 1.0),
                };
                n += 1;
            }
        }
        sum
    }
}

#[test]
fn every_operator_follows_its_two_curves() {
    for seed in 0..600 {
        let mut rng = rng(40_000 + seed);
        // Relays have jumps, where rounding decides.
        let operator = [Operator::Mkp, Operator::Kp][seed as usize % 2];
        let k = levels(&mut rng, 14);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let (model, mut state) = build(plane, operator, &weights);
        let curves = Curves::random(&mut rng, &plane);
        let (stages, mut memory) = (curves.stages(), StageState::default());
        stages.check(&model).unwrap();
        let mut each = Operators {
            operator,
            plane,
            gammas: vec![0.0; weights.len()],
            weights,
        };
        let size: f64 = each.weights.iter().sum();
        for input in inputs(&mut rng, &plane, 200) {
            let load = Some(rng.random_range(-1.0..11.0));
            let sample = Sample {
                input,
                dt: None,
                load,
            };
            let found = stages.step(&model, &mut state, &mut memory, sample);
            let loaded = stages.axis.load.at(load).unwrap();
            let by = |direction| stages.axis.forward(&plane, loaded, direction, input);
            let (up, down) = (by(Direction::Rising), by(Direction::Falling));
            // No threshold of falling input is above that of rising input, up to rounding.
            assert!(up <= down + 1e-9 * plane.step(), "{seed}");
            let expected = each.step(up, down.max(up));
            let error = found.unwrap().output - expected;
            // Rounding of 200 samples, where a level has the slope of all weights.
            assert!(error.abs() <= 1e-9 * size, "{seed}: off by {error:e}");
        }
    }
}

#[test]
fn equal_curves_are_one_axis_to_the_bit() {
    for seed in 0..300 {
        let mut rng = rng(41_000 + seed);
        let operator = OPERATORS[seed as usize % 3];
        let k = levels(&mut rng, 14);
        let plane = plane(&mut rng, k);
        let (model, mut state) = build(plane, operator, &weights(&mut rng, k));
        let mut alone = state.clone();
        let mut once = state.clone();
        let mut curves = Curves::random(&mut rng, &plane);
        curves.lists[2] = curves.lists[1].clone();
        let mut one = curves.stages();
        one.axis.registration.falling = &[];
        let twice = curves.stages();
        let [mut memory, mut memory_once] = [StageState::default(); 2];
        for input in inputs(&mut rng, &plane, 200) {
            let load = Some(rng.random_range(-1.0..11.0));
            let sample = Sample {
                input,
                dt: None,
                load,
            };
            let found = twice.step(&model, &mut state, &mut memory, sample).unwrap();
            let loaded = twice.axis.load.at(load).unwrap();
            let seen = twice.axis.forward(&plane, loaded, Direction::Rising, input);
            assert_eq!(found, model.step(&mut alone, seen).unwrap(), "{seed}");
            let with_one = one.step(&model, &mut once, &mut memory_once, sample);
            assert_eq!(found, with_one.unwrap(), "{seed}");
        }
    }
}

#[test]
fn the_inverse_leads_through_the_curve_of_its_direction() {
    let (mut met, mut missed) = (0, 0);
    for seed in 0..600 {
        let mut rng = rng(42_000 + seed);
        let operator = [Operator::Mkp, Operator::Kp][seed as usize % 2];
        let k = levels(&mut rng, 14);
        let plane = plane(&mut rng, k);
        let (model, mut state) = build(plane, operator, &weights(&mut rng, k));
        let curves = Curves::random(&mut rng, &plane);
        let (stages, inverse) = (curves.stages(), model.inverse().unwrap());
        let (off, on) = model.output_range();
        if on == off {
            continue;
        }
        let mut memory = StageState::default();
        for _ in 0..100 {
            let load = Some(rng.random_range(-1.0..11.0));
            let output = off + rng.random_range(0.0..1.0) * (on - off);
            let heading = [None, Some(Direction::Rising), Some(Direction::Falling)];
            let target = Target::new(output).heading(heading[rng.random_range(0..3)]);
            let wanted = Wanted {
                load,
                ..target.into()
            };
            let (mut again, mut memory_again) = (state.clone(), memory);
            let found = stages
                .invert(&inverse, &mut state, &mut memory, wanted)
                .unwrap();
            let sample = Sample {
                input: found.input,
                dt: None,
                load,
            };
            let step = stages.step(&model, &mut again, &mut memory_again, sample);
            let error = (step.unwrap().output - output).abs();
            let fits = error <= 1e-9 * (on - off);
            assert!(found.status != Status::Ok || fits, "{seed}: {error:e}");
            met += usize::from(fits);
            missed += usize::from(!fits);
        }
    }
    // Every output within the range can be reached at every load, up to rounding.
    assert!(missed == 0, "{missed} of {}", met + missed);
}

#[test]
fn curves_that_do_not_fit_are_named() {
    let plane = Plane::new(1.0, 2.0, 2).unwrap();
    let (model, _) = build(plane, Operator::Mkp, &[1.0; 3]);
    let check = |knots, rising, falling, loads| {
        let axis = Axis {
            load: Load {
                loads,
                ..Load::NONE
            },
            registration: Registration {
                knots,
                rising,
                falling,
            },
            ..Axis::PLAIN
        };
        let stages = Stages {
            axis,
            ..Stages::NONE
        };
        stages.check(&model).map_err(|error| error.to_string())
    };
    let named = |found: Result<(), String>, name: &str| {
        let error = found.unwrap_err();
        assert!(error.contains(&format!("`{name}`")), "{error}");
    };
    let two = &[0.0, 1.0][..];
    assert_eq!(check(two, &[5.0, 6.0], &[4.0, 6.0], &[]), Ok(()));
    assert_eq!(check(two, &[5.0, 6.0], &[], &[7.0]), Ok(()));
    named(check(&[0.0], &[5.0], &[], &[]), "knots");
    named(check(&[1.0, 0.0], &[5.0, 6.0], &[], &[]), "knots");
    named(check(&[], &[5.0, 6.0], &[], &[]), "rising");
    named(check(two, &[], &[], &[]), "rising");
    named(check(two, &[6.0, 5.0], &[], &[]), "rising");
    named(check(two, &[5.0, 6.0], &[], &[1.0, 2.0]), "rising");
    named(check(two, &[5.0, 6.0], &[5.0], &[]), "falling");
    named(check(two, &[5.0, 6.0], &[5.5, 6.0], &[]), "falling");
}

/// The operators of the definition, with one input, are those with two equal ones.
#[test]
fn one_curve_is_the_definition() {
    let mut rng = rng(43_000);
    let plane = plane(&mut rng, 6);
    let weights = weights(&mut rng, 6);
    let mut states = vec![0.0; weights.len()];
    let mut definition = Definition::new(plane, Operator::Mkp, &weights, &mut states).unwrap();
    let mut each = Operators {
        operator: Operator::Mkp,
        plane,
        gammas: vec![0.0; weights.len()],
        weights: weights.clone(),
    };
    for input in inputs(&mut rng, &plane, 500) {
        let seen = Axis::PLAIN.seen(&plane, Loaded::NONE, 0.0, input);
        assert_eq!(definition.step(input).unwrap(), each.step(seen, seen));
    }
}
