//! Models with every stage: the communication step is the time step, and the load is an input.

use crate::api::*;
use hysteron::{Model, Sample, Target, Wanted};
use hysteron_export::Fmi;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::ptr::null_mut;

/// A falling model with every stage and a start, all of its operators moved.
pub fn every_stage() -> Model {
    let file = serde_json::json!({
        "format": "hysteron-model", "version": 2, "operator": "kp",
        "plane": {"min": 1, "max": 4, "levels": 4},
        "input": {"name": "duty"}, "output": {"name": "stroke", "offset": 3.5, "sign": -1},
        "weights": [1.0, 0.5, 1.0, 0.0, 0.5, 1.0, 0.25, 0.0, 0.75, 1.5],
        "thermal": {"kind": "first-order", "ambient": 20.0, "gain": 80.0,
            "tau_heating": 0.4, "tau_cooling": 0.9},
        "drive": {"min": 0.0, "max": 1.0},
        "load": {"name": "stress", "unit": "MPa", "min": 0.0, "max": 200.0,
            "parts": [{"offset": 3.5,
                "weights": [1.0, 0.5, 1.0, 0.0, 0.5, 1.0, 0.25, 0.0, 0.75, 1.5]}],
            "curves": {"loads": [0.0, 100.0, 200.0], "shifts": [0.0, 8.0, 11.0],
                "scales": [1.0, 1.05, 1.0], "gains": [1.0, 1.2, 1.1], "offsets": [0.0, 0.3, 0.2]}},
        "spacing": [30.0, 50.0, 58.0, 62.0, 80.0],
        "creep": [{"coefficient": 0.05, "tau": 2.0}, {"coefficient": 0.02, "tau": 20.0}],
        "lag": 0.05,
        "start": {"turning_points": [3.25, 1.5, 2.0], "input": 2.0},
    });
    Model::from_json(&file.to_string()).unwrap()
}

fn model_without_body() -> Model {
    let mut model = every_stage();
    model.thermal = None;
    model.drive = None;
    model
}

/// Every stage, or none of them, and weights of the order `count - 1` in the load.
fn by_load(seed: u64, count: usize, alone: bool) -> Model {
    let mut rng = StdRng::seed_from_u64(seed);
    let mut file: serde_json::Value = serde_json::from_str(&every_stage().to_json()).unwrap();
    let mut weights = || -> Vec<f64> { (0..10).map(|_| rng.random_range(0.0..1.0)).collect() };
    let parts: Vec<Vec<f64>> = (0..count).map(|_| weights()).collect();
    let part =
        |weights| serde_json::json!({"offset": rng.random_range(2.0..4.0), "weights": weights});
    file["load"]["parts"] = parts.into_iter().map(part).collect();
    at_middle(&mut file);
    if alone {
        for stage in ["thermal", "drive", "spacing", "creep", "lag", "start"] {
            file.as_object_mut().unwrap().remove(stage);
        }
        file["load"].as_object_mut().unwrap().remove("curves");
    }
    Model::from_json(&file.to_string()).unwrap()
}

/// Random samples: signal, load and step size, some of them without length.
fn samples(seed: u64, low: f64, high: f64) -> Vec<(f64, f64, f64)> {
    let mut rng = StdRng::seed_from_u64(seed);
    let sample = |_| {
        let dt = [0.0, 0.01, 0.05, 0.3][rng.random_range(0..4)];
        let load = rng.random_range(0.0..200.0);
        (rng.random_range(low..high), load, dt)
    };
    (0..400).map(sample).collect()
}

/// Feeds the samples: the first as the start, the others as steps. In between, the state goes
/// through bytes into another instance.
fn run(
    fmu: &Unpacked,
    samples: &[(f64, f64, f64)],
    mut expected: impl FnMut(usize) -> (u64, i32, u64),
) {
    let mut instance = fmu.instance();
    let mut time = 0.0;
    for (n, &(signal, load, dt)) in samples.iter().enumerate() {
        if n == 0 {
            assert_eq!(instance.enter(0.0), 0);
        }
        assert_eq!(
            (instance.set(SIGNAL, signal), instance.set(LOAD, load)),
            (0, 0)
        );
        match n {
            0 => assert_eq!(instance.exit(), 0),
            _ => assert_eq!(instance.step(time, dt), 0),
        }
        if n > 0 {
            time += dt;
        }
        let (result, flag, temperature) = expected(n);
        assert_eq!(instance.outputs(), (result, flag), "sample {n}");
        if let Ok(found) = instance.get(TEMPERATURE) {
            assert_eq!(found.to_bits(), temperature, "sample {n}");
        }
        if n % 9 == 4 {
            let mut state = null_mut();
            assert_eq!(instance.save(&mut state), 0);
            assert_eq!(
                (instance.set(SIGNAL, 0.2), instance.step(time, 3.0)),
                (0, 0)
            );
            let bytes = instance.serialise(state);
            let other = fmu.instance();
            let mut there = null_mut();
            assert_eq!(other.deserialise(&bytes, &mut there), 0);
            assert_eq!(other.restore(there), 0);
            instance.free();
            instance = other;
        }
    }
    instance.free();
}

#[test]
#[cfg_attr(miri, ignore = "it is about digits, and takes Miri hours")]
fn the_model_with_every_stage_to_the_last_bit() {
    for (model, low, high) in [
        (every_stage(), -0.1, 1.1),
        (model_without_body(), 20.0, 95.0),
        (by_load(1, 2, false), -0.1, 1.1),
        (by_load(2, 8, false), -0.1, 1.1),
        (by_load(3, 3, true), 0.0, 4.5),
    ] {
        for fmi in [Fmi::V2, Fmi::V3] {
            let fmu = Unpacked::new(&model, false, fmi);
            let samples = samples(1, low, high);
            let mut state = model.start();
            run(&fmu, &samples, |n| {
                let (input, load, dt) = samples[n];
                let (dt, load) = (Some(dt), Some(load));
                let step = model.step(&mut state, Sample { input, dt, load }).unwrap();
                let clipped = step.clipped.map_or(0, |end| match end {
                    hysteron::Clipped::Low => -1,
                    hysteron::Clipped::High => 1,
                });
                (
                    step.output.to_bits(),
                    clipped,
                    state.temperature().to_bits(),
                )
            });
        }
    }
}

#[test]
#[cfg_attr(miri, ignore = "it is about digits, and takes Miri hours")]
fn its_inverse_to_the_last_bit() {
    for model in [
        every_stage(),
        model_without_body(),
        by_load(4, 2, false),
        by_load(5, 6, false),
        by_load(6, 4, true),
    ] {
        let (a, b) = model.output_range();
        for fmi in [Fmi::V2, Fmi::V3] {
            let fmu = Unpacked::new(&model, true, fmi);
            let samples = samples(2, a.min(b) - 0.5, a.max(b) + 0.5);
            let inverse = model.inverse().unwrap();
            let mut state = model.start();
            let mut seen = [false; 5];
            run(&fmu, &samples, |n| {
                let (output, load, dt) = samples[n];
                let (dt, load) = (Some(dt), Some(load));
                let target = Target::new(output);
                let wanted = Wanted {
                    dt,
                    load,
                    ..target.into()
                };
                let found = inverse.step(&mut state, wanted).unwrap();
                let status = i32::from(found.status.number());
                seen[usize::try_from(status + 1).unwrap()] = true;
                (found.input.to_bits(), status, state.temperature().to_bits())
            });
            let limited = seen[4] || !model.is_timed();
            assert!(seen[1] && limited, "reached and limited: {seen:?}");
        }
    }
}

/// What the description says is what the binary begins with.
#[test]
fn start_values_and_what_is_refused() {
    for inverse in [false, true] {
        for fmi in [Fmi::V2, Fmi::V3] {
            let c = Unpacked::new(&every_stage(), inverse, fmi).instance();
            let first = match inverse {
                false => 0.0,
                true => c.get(SIGNAL).unwrap(),
            };
            assert_eq!((c.get(SIGNAL), c.get(LOAD)), (Ok(first), Ok(100.0)));
            assert_eq!(c.set(TEMPERATURE, 1.0), 3);
            assert_eq!(c.initialise(0.0), 0);
            if !inverse {
                // At rest without drive.
                assert_eq!(c.get(TEMPERATURE), Ok(20.0));
            }
            let before = c.outputs();
            assert_eq!((c.set(LOAD, f64::NAN), c.step(0.0, 0.1)), (0, 3));
            assert_eq!((c.outputs(), c.get(TIME)), (before, Ok(0.0)));
            assert_eq!((c.set(LOAD, 100.0), c.step(0.0, 0.1)), (0, 0));
            c.free();
        }
    }
}

/// Beyond the range of the loads the weights are those of its nearest end.
#[test]
fn loads_outside_act_as_the_ends() {
    let fmu = Unpacked::new(&by_load(7, 3, true), false, Fmi::V3);
    for (load, end) in [(-1e9, 0.0), (200.001, 200.0), (f64::MAX, 200.0)] {
        let at = |load: f64| {
            let c = fmu.instance();
            assert_eq!((c.set(SIGNAL, 2.7), c.set(LOAD, load)), (0, 0));
            assert_eq!(c.initialise(0.0), 0);
            let outputs = c.outputs();
            c.free();
            outputs
        };
        assert_eq!(at(load), at(end));
    }
}

/// Weights and offset of a file that are those in the middle of its parts.
fn at_middle(file: &mut serde_json::Value) {
    let parts = file["load"]["parts"].as_array().unwrap().clone();
    let mut factors = vec![0.0; parts.len()];
    hysteron_core::bernstein(0.5, &mut factors);
    let sum = |of: &dyn Fn(&serde_json::Value) -> f64| -> f64 {
        let pairs = factors.iter().zip(&parts);
        pairs.map(|(f, part)| f * of(part)).sum()
    };
    let count = parts[0]["weights"].as_array().unwrap().len();
    let weight = |n: usize| sum(&|part| part["weights"][n].as_f64().unwrap());
    file["weights"] = (0..count).map(weight).collect();
    file["output"]["offset"] = sum(&|part| part["offset"].as_f64().unwrap()).into();
}
