//! The test vectors of models with stages through exported C: within their tolerance, and the core's
//! digits. A run counts where its time step is a fixed one.

use crate::common::programs::has;
use crate::common::reference::Number;
use crate::common::staged::{Call, Case, script};
use crate::common::{Exported, REALS, answers, here, same};
use hysteron::{Model, Sample};
use hysteron_export::{CReal, CSampling};
use serde_json::Value;
use std::process::Command;

struct Run {
    name: String,
    calls: Vec<Call>,
    /// The outputs or inputs expected and, of an inverse, the statuses.
    expected: Vec<f64>,
    statuses: Vec<i64>,
    /// How far a target may be missed.
    tolerance: f64,
}

struct File {
    name: String,
    case: Case,
    tolerance: Value,
    runs: Vec<Run>,
}

fn numbers(value: &Value) -> Option<Vec<f64>> {
    let list = value.as_array()?.iter();
    Some(list.map(|x| x.as_f64().unwrap()).collect())
}

/// The time step of a run after its first sample; `None` where it changes. Zero without time.
fn step(run: &Value) -> Option<f64> {
    let dt = numbers(&run["dt"]).unwrap_or(vec![0.0, 0.0]);
    let fixed = dt[2..].iter().all(|step| *step == dt[1]);
    (fixed && run["drive_range"].is_null()).then_some(dt[1])
}

fn read_run(run: &Value) -> Run {
    let count = run["input"].as_array().unwrap().len();
    let tolerance = run["tolerance"].as_f64().unwrap_or(0.0);
    let load = numbers(&run["load"]).unwrap_or(vec![0.0; count]);
    let input = numbers(&run["input"]).unwrap();
    let calls = match (numbers(&run["target"]), numbers(&run["heading"])) {
        (Some(target), Some(heading)) => (0..count)
            .map(|n| Call::Inverse(target[n], heading[n] as i32, tolerance, load[n]))
            .collect(),
        _ => (0..count).map(|n| Call::Step(input[n], load[n])).collect(),
    };
    let statuses = numbers(&run["status"]).unwrap_or_default();
    Run {
        name: run["name"].as_str().unwrap().to_owned(),
        calls,
        expected: numbers(&run["output"]).unwrap_or(input),
        statuses: statuses.iter().map(|&s| s as i64).collect(),
        tolerance,
    }
}

fn files() -> Vec<File> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(here("../../vectors")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|end| end != "json") {
            continue;
        }
        let file: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        if file["version"] == 1 {
            continue;
        }
        let model = Model::from_json(&file["model"].to_string()).unwrap();
        let runs = file["runs"].as_array().unwrap().iter();
        let fixed: Vec<&Value> = runs.filter(|run| step(run).is_some()).collect();
        let dt = step(fixed[0]).filter(|_| model.is_timed());
        let sampling = CSampling {
            dt,
            drive: None,
            ..CSampling::default()
        };
        files.push(File {
            name: path.file_stem().unwrap().to_str().unwrap().to_owned(),
            case: Case::of(model, sampling),
            tolerance: file["tolerance"].clone(),
            runs: fixed.into_iter().map(read_run).collect(),
        });
    }
    assert!(files.len() >= 15, "{} files", files.len());
    files
}

/// The numbers that the driver printed, and the statuses after them.
fn read<T: Number>(answers: &str) -> Vec<(f64, Option<i64>)> {
    let rows = answers.lines().filter(|line| !line.starts_with('m'));
    rows.map(|line| {
        let row: Vec<&str> = line.split(' ').collect();
        assert_eq!(row[1], "0", "{line}");
        let bits = u64::from_str_radix(row[2], 16).unwrap();
        let status = row.get(3).map(|status| status.parse().unwrap());
        (T::from_bits(bits).wide(), status)
    })
    .collect()
}

/// Rounding units of single precision that an output may be off by, of the sum of the weights. A
/// temperature is rounded to some 128 units; the levels are 6 apart where they are closest; a state
/// remembers some ten corners.
const UNITS: f64 = 128.0 / 6.0 * 2.0 * 10.0;

fn check<T: Number>(file: &File, run: &Run, found: &[(f64, Option<i64>)], real: CReal) {
    let model = &file.case.model;
    let total: f64 = model.weights().iter().sum();
    let single = UNITS * f64::from(f32::EPSILON) * total;
    let forward = run.statuses.is_empty();
    let own = |what: &str| file.tolerance[what].as_f64().unwrap();
    let mut state = model.start();
    for (n, &(number, status)) in found.iter().enumerate() {
        let what = format!("{}, {}, {}, sample {n}", file.name, run.name, real.name());
        assert_eq!(status, run.statuses.get(n).copied(), "{what}");
        let error = (number - run.expected[n]).abs();
        let (error, tolerance) = match (real, &run.calls[n]) {
            (CReal::Double, _) if forward => (error, own("output")),
            (CReal::Double, _) => (error, own("input")),
            (CReal::Float, Call::Inverse(target, _, _, load)) => {
                // Where the output hardly changes, drives far apart give it: what counts is the
                // output that the drives found give.
                let sample = Sample {
                    input: number,
                    dt: Some(if n == 0 {
                        0.0
                    } else {
                        file.case.sampling.dt.unwrap_or(0.0)
                    }),
                    load: model.load.as_ref().map(|_| *load),
                };
                let output = model.step(&mut state, sample).unwrap().output;
                let missed = (output - target).abs() - run.tolerance;
                (if status == Some(0) { missed } else { 0.0 }, single)
            }
            (CReal::Float, _) => (error, single),
        };
        assert!(
            error <= tolerance,
            "{what}: {error:e}, allowed {tolerance:e}"
        );
    }
}

fn every_vector<T: Number>(real: CReal) -> usize {
    let files = files();
    let models: Vec<_> = files
        .iter()
        .map(|file| (&file.case.model, file.case.sampling))
        .collect();
    let exported = Exported::staged(&models, real);
    let program = exported.compile("cc", &["-O2"], "staged.c");
    let mut samples = 0;
    for (n, file) in files.iter().enumerate() {
        for run in &file.runs {
            let (commands, expected) = script::<T>(n, &file.case, &run.calls);
            let found = answers(&mut Command::new(&program), &commands);
            let what = format!("{}, {}", file.name, run.name);
            same(&commands, &expected, &found, &what);
            let found = read::<T>(&found);
            assert_eq!(found.len(), run.expected.len());
            check::<T>(file, run, &found, real);
            samples += found.len();
        }
    }
    samples
}

#[test]
fn with_a_fixed_step_in_both_number_types() {
    if !has("cc") {
        return;
    }
    for real in REALS {
        let samples = match real {
            CReal::Float => every_vector::<f32>(real),
            CReal::Double => every_vector::<f64>(real),
        };
        assert!(samples > 2_000, "{samples}");
    }
}
