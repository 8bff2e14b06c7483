//! The functions of an FMU's binary, FMI 2.0 and 3.0, called as a tool does.
#![allow(clippy::unwrap_used)]

mod api;
mod control;
mod delay;
mod misuse;
mod staged;
mod states;

use api::*;
use hysteron::{Direction, Model, Sample, Target, Wanted};
use hysteron_export::Fmi;

/// The library's own numbers, to be met bit for bit.
fn expected(model: &Model, kind: &str, run: &serde_json::Value) -> Vec<(u64, i32)> {
    let mut state = model.start();
    if kind == "forward" {
        let step = |(n, input): (usize, f64)| {
            let sample = Sample {
                input,
                dt: around(run, "dt", n),
                load: around(run, "load", n),
            };
            let step = model.step(&mut state, sample).unwrap();
            let clipped = step.clipped.map_or(0, |end| match end {
                hysteron::Clipped::Low => -1,
                hysteron::Clipped::High => 1,
            });
            (step.output.to_bits(), clipped)
        };
        let inputs = numbers(run, "input").into_iter();
        return inputs.enumerate().map(step).collect();
    }
    let inverse = model.inverse().unwrap();
    let tolerance = run["tolerance"].as_f64().unwrap();
    let pairs = numbers(run, "target")
        .into_iter()
        .zip(numbers(run, "heading"));
    let step = |(n, (target, heading)): (usize, (f64, f64))| {
        let heading = match heading as i32 {
            0 => None,
            1 => Some(Direction::Rising),
            _ => Some(Direction::Falling),
        };
        let target = Target::new(target).heading(heading).tolerance(tolerance);
        let wanted = Wanted {
            dt: around(run, "dt", n),
            load: around(run, "load", n),
            ..target.into()
        };
        let solution = inverse.step(&mut state, wanted).unwrap();
        (
            solution.input.to_bits(),
            i32::from(solution.status.number()),
        )
    };
    pairs.enumerate().map(step).collect()
}

/// Time step or load of a sample, where the run has them.
fn around(run: &serde_json::Value, what: &str, n: usize) -> Option<f64> {
    run[what][n].as_f64()
}

/// Sets what a sample of a vector needs.
fn feed(instance: Instance, kind: &str, run: &serde_json::Value, n: usize) {
    let column = if kind == "forward" { "input" } else { "target" };
    assert_eq!(instance.set(SIGNAL, numbers(run, column)[n]), 0);
    if let Some(load) = around(run, "load", n) {
        assert_eq!(instance.set(LOAD, load), 0);
    }
    if kind == "inverse" {
        assert_eq!(
            instance.set_integer(HEADING, numbers(run, "heading")[n] as i32),
            0
        );
    }
}

#[test]
#[cfg_attr(miri, ignore = "it is about digits, and takes Miri hours")]
fn every_vector_through_both_standards() {
    let mut samples = 0;
    for vector in vectors() {
        let (model, kind) = (model(&vector), vector["kind"].as_str().unwrap());
        let result = if kind == "forward" { "output" } else { "input" };
        let tolerance = vector["tolerance"][result].as_f64().unwrap();
        for fmi in [Fmi::V2, Fmi::V3] {
            let fmu = Unpacked::new(&model, kind == "inverse", fmi);
            for run in vector["runs"].as_array().unwrap() {
                if run.get("drive_range").is_some() {
                    continue; // a block has the model's own limits
                }
                let mut time = 0.0;
                let expected = expected(&model, kind, run);
                let instance = fmu.instance();
                if kind == "inverse" {
                    assert_eq!(
                        instance.set(TOLERANCE, run["tolerance"].as_f64().unwrap()),
                        0
                    );
                }
                // The first sample is the start input, the others are steps.
                for (n, wanted) in numbers(run, result).into_iter().enumerate() {
                    if n == 0 {
                        assert_eq!(instance.enter(0.0), 0);
                        feed(instance, kind, run, 0);
                        assert_eq!(instance.exit(), 0);
                    } else {
                        feed(instance, kind, run, n);
                        let dt = around(run, "dt", n).unwrap_or(1.0);
                        assert_eq!(instance.step(time, dt), 0);
                        time += dt;
                    }
                    let found = instance.outputs();
                    assert_eq!(found, expected[n], "{kind}, {}, sample {n}", run["name"]);
                    assert!((f64::from_bits(found.0) - wanted).abs() <= tolerance);
                    samples += 1;
                }
                assert_eq!(instance.terminate(), 0);
                instance.free();
            }
        }
    }
    assert!(samples > 11_000, "{samples}");
}

/// Start values can be tried in any order before the first step, and parameters act.
#[test]
fn initialisation() {
    let model = model(&vector("inverse-mkp-5-negative"));
    let (off, on) = model.output_range();
    for fmi in [Fmi::V2, Fmi::V3] {
        let forward = Unpacked::new(&model, false, fmi).instance();
        assert_eq!(forward.get(SIGNAL), Ok(model.plane().bottom()));
        assert_eq!(
            forward.get(RESULT),
            Ok(off),
            "what follows from the start values"
        );
        assert_eq!(forward.enter(5.0), 0);
        assert_eq!(forward.set(SIGNAL, model.plane().max() + 1.0), 0);
        assert_eq!(
            (forward.get(RESULT), forward.get_integer(FLAG)),
            (Ok(on), Ok(1))
        );
        assert_eq!(forward.set(SIGNAL, model.plane().bottom()), 0);
        assert_eq!(
            forward.get(RESULT),
            Ok(off),
            "nothing is remembered of what was tried"
        );
        assert_eq!(forward.set_boolean(START_ON, true), 0);
        let middle = (model.plane().bottom() + model.plane().max()) / 2.0;
        assert_eq!(forward.set(SIGNAL, middle), 0);
        assert_eq!(forward.exit(), 0);
        let mut state = model.saturated();
        let cooled = model.step(&mut state, middle).unwrap().output;
        assert_eq!(
            (forward.get(RESULT), forward.get(TIME)),
            (Ok(cooled), Ok(5.0))
        );
        assert_eq!(
            forward.set_boolean(START_ON, false),
            3,
            "fixed from here on"
        );
        assert_eq!(forward.next(middle), 0);
        // Back to the beginning.
        assert_eq!(forward.reset(), 0);
        assert_eq!(
            (forward.get(SIGNAL), forward.get(TIME)),
            (Ok(model.plane().bottom()), Ok(0.0))
        );
        assert_eq!(forward.initialise(0.0), 0);
        assert_eq!(forward.get(RESULT), Ok(off));
        forward.free();

        let inverse = Unpacked::new(&model, true, fmi).instance();
        assert_eq!(inverse.get(SIGNAL), Ok(off));
        assert_eq!(inverse.initialise(0.0), 0);
        assert_eq!(
            (inverse.get(RESULT), inverse.get_integer(FLAG)),
            (Ok(model.plane().bottom()), Ok(0))
        );
        assert_eq!(inverse.set(TOLERANCE, 0.1), 0, "tunable");
        inverse.free();
    }
}

#[test]
fn instances_in_threads_do_not_meet() {
    // Miri takes a thousand times as long.
    let (name, threads, rounds, count) = match cfg!(miri) {
        true => ("forward-mkp-2", 3, 2, 10),
        false => ("forward-mkp-20", 8, 20, usize::MAX),
    };
    let vector = vector(name);
    let model = model(&vector);
    let run = &vector["runs"][1];
    let (mut inputs, expected) = (numbers(run, "input"), expected(&model, "forward", run));
    inputs.truncate(count);
    let fmus = [Fmi::V2, Fmi::V3].map(|fmi| Unpacked::new(&model, false, fmi));
    let follow = |instance: Instance| {
        for (input, expected) in inputs.iter().zip(&expected) {
            assert_eq!(instance.next(*input), 0);
            assert_eq!(instance.outputs(), *expected);
        }
    };
    std::thread::scope(|scope| {
        for n in 0..threads {
            let (fmu, follow) = (&fmus[n % 2], &follow);
            scope.spawn(move || {
                for _ in 0..rounds {
                    let instance = fmu.started();
                    follow(instance);
                    instance.free();
                }
            });
        }
    });
    // And in turns in one thread.
    let [a, b] = fmus.map(|fmu| fmu.started());
    for (n, input) in inputs.iter().enumerate() {
        assert_eq!(
            (a.next(*input), b.next(inputs[inputs.len() - 1 - n])),
            (0, 0)
        );
        assert_eq!(a.outputs(), expected[n]);
    }
}

/// Both blocks in series return the reference.
#[test]
#[cfg_attr(miri, ignore = "it is about digits, and takes Miri hours")]
fn in_series_they_return_the_reference() {
    for name in ["inverse-mkp-20", "inverse-kp-5", "inverse-mkp-5-negative"] {
        let vector = vector(name);
        let model = model(&vector);
        let [inverse, forward] =
            [true, false].map(|inverse| Unpacked::new(&model, inverse, Fmi::V2).started());
        let (off, on) = model.output_range();
        // Out and back in ever smaller loops.
        for n in 0..500 {
            let share = 0.5 + 0.5 * (1.0 - f64::from(n) / 600.0) * (f64::from(n) * 0.1).sin();
            let target = off + share * (on - off);
            assert_eq!(inverse.next(target), 0);
            assert_eq!(inverse.get_integer(FLAG), Ok(0));
            assert_eq!(forward.next(inverse.get(RESULT).unwrap()), 0);
            let error = (forward.get(RESULT).unwrap() - target).abs() / (on - off).abs();
            // The bound that the inverse itself is tested with.
            assert!(error <= 1e-12, "{name}, step {n}: {error:e} of the range");
        }
    }
}
