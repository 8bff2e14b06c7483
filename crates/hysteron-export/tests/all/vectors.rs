//! The test vectors through exported C: within their tolerance, and the core's digits.

use crate::common::programs::has;
use crate::common::reference::{Call, Number, script};
use crate::common::{Exported, answers, here, same};
use hysteron::{Model, Operator};
use hysteron_export::CReal;
use serde_json::Value;
use std::process::Command;

struct Run {
    name: String,
    calls: Vec<Call>,
    /// The outputs or inputs expected and, of an inverse, the statuses.
    expected: Vec<f64>,
    statuses: Vec<i64>,
    /// How far a target may go back, which the output may miss it by.
    tolerance: f64,
}

struct File {
    name: String,
    model: Model,
    tolerance: Value,
    runs: Vec<Run>,
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().into_iter().flatten();
    list.map(|x| x.as_f64().unwrap()).collect()
}

fn files() -> Vec<File> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(here("../../vectors")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|end| end != "json") {
            continue;
        }
        let file: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        if file["version"] != 1 {
            continue; // models with stages: `vectors_staged.rs`
        }
        let forward = file["kind"] == "forward";
        let runs = file["runs"].as_array().unwrap().iter().map(|run| {
            let tolerance = run["tolerance"].as_f64().unwrap_or(0.0);
            let (input, target) = (numbers(&run["input"]), numbers(&run["target"]));
            let heading = numbers(&run["heading"]);
            let inverse = |(&y, &way): (&f64, &f64)| Call::Inverse(y, way as i32, tolerance);
            Run {
                name: run["name"].as_str().unwrap().to_owned(),
                calls: match forward {
                    true => input.iter().map(|&x| Call::Step(x)).collect(),
                    false => target.iter().zip(&heading).map(inverse).collect(),
                },
                expected: if forward {
                    numbers(&run["output"])
                } else {
                    input
                },
                statuses: numbers(&run["status"]).iter().map(|&s| s as i64).collect(),
                tolerance,
            }
        });
        files.push(File {
            name: path.file_stem().unwrap().to_str().unwrap().to_owned(),
            model: Model::from_json(&file["model"].to_string()).unwrap(),
            tolerance: file["tolerance"].clone(),
            runs: runs.collect(),
        });
    }
    assert!(files.len() >= 15, "{} files", files.len());
    files
}

/// The numbers that the driver printed, and the statuses after them.
fn read<T: Number>(answers: &str) -> Vec<(f64, Option<i64>)> {
    let rows = answers
        .lines()
        .map(|line| line.split(' ').collect::<Vec<_>>());
    let rows = rows.filter(|row| row[0] != "m");
    rows.map(|row| {
        assert_eq!(row[1], "0");
        let bits = u64::from_str_radix(row[2], 16).unwrap();
        (
            T::from_bits(bits).wide(),
            row.get(3).map(|s| s.parse().unwrap()),
        )
    })
    .collect()
}

fn every_vector<T: Number>(real: CReal, check: impl Fn(&File, &Run, &[(f64, Option<i64>)])) {
    let files = files();
    let models: Vec<&Model> = files.iter().map(|file| &file.model).collect();
    let exported = Exported::new(&models, real);
    let program = exported.compile("cc", &["-O2"], "driver.c");
    for (n, file) in files.iter().enumerate() {
        for run in &file.runs {
            let (commands, expected) = script::<T>(n, &file.model, &run.calls);
            let found = answers(&mut Command::new(&program), &commands);
            same(
                &commands,
                &expected,
                &found,
                &format!("{}, {}", file.name, run.name),
            );
            check(file, run, &read::<T>(&found));
        }
    }
}

#[test]
fn in_double() {
    if !has("cc") {
        return;
    }
    every_vector::<f64>(CReal::Double, |file, run, found| {
        let forward = run.statuses.is_empty();
        let tolerance = &file.tolerance[if forward { "output" } else { "input" }];
        let tolerance = tolerance.as_f64().unwrap();
        for (n, (number, status)) in found.iter().enumerate() {
            let error = (number - run.expected[n]).abs();
            let what = format!("{}, {}, sample {n}", file.name, run.name);
            assert!(
                error <= tolerance,
                "{what}: {error:e}, allowed {tolerance:e}"
            );
            assert_eq!(*status, run.statuses.get(n).copied(), "{what}");
        }
    });
}

/// In single precision a position on the plane is off by a few of its rounding units, `K ε`, and
/// the output by as much of the sum of the weights, once for each corner that is remembered: some
/// ten in these runs.
fn output_tolerance(model: &Model) -> f64 {
    let total: f64 = model.weights().iter().map(|mu| mu.abs()).sum();
    let sure = if model.operator() == Operator::Mkp {
        1.0
    } else {
        2.0
    };
    let size = sure * total + model.offset().abs();
    8.0 * f64::from(f32::EPSILON) * model.plane().levels() as f64 * size
}

#[test]
fn in_float() {
    if !has("cc") {
        return;
    }
    every_vector::<f32>(CReal::Float, |file, run, found| {
        let tolerance = output_tolerance(&file.model);
        let what = format!("{}, {}", file.name, run.name);
        let (numbers, statuses): (Vec<f64>, Vec<_>) = found.iter().copied().unzip();
        if run.statuses.is_empty() {
            for (n, (number, expected)) in numbers.iter().zip(&run.expected).enumerate() {
                let error = (number - expected).abs();
                assert!(
                    error <= tolerance,
                    "{what}, sample {n}: {error:e}, allowed {tolerance:e}"
                );
            }
            return;
        }
        // Where the output hardly changes, inputs far apart give it: what counts is the output that
        // the inputs found give.
        let outputs = file.model.simulate(&numbers).unwrap();
        for (n, output) in outputs.iter().enumerate() {
            let Call::Inverse(target, ..) = run.calls[n] else {
                unreachable!()
            };
            assert_eq!(statuses[n], Some(run.statuses[n]), "{what}, sample {n}");
            if run.statuses[n] == 0 {
                let error = (output - target).abs() - run.tolerance;
                assert!(
                    error <= tolerance,
                    "{what}, sample {n}: {error:e}, allowed {tolerance:e}"
                );
            }
        }
    });
}
