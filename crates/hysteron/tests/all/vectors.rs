//! The test vectors: the façade reproduces them, and the files are what their example makes.

#[path = "../../examples/vectors/chain.rs"]
mod chain;
#[path = "../../examples/vectors/make.rs"]
mod make;
#[path = "../../examples/vectors/plain.rs"]
mod plain;
#[path = "../../examples/vectors/staged.rs"]
mod staged;

use hysteron::{Direction, Model, Sample, Target, Wanted};
use serde::Deserialize;
use std::path::{Path, PathBuf};

#[derive(Deserialize)]
struct File {
    kind: String,
    model: serde_json::Value,
    tolerance: Tolerance,
    runs: Vec<Run>,
}

#[derive(Deserialize)]
struct Tolerance {
    #[serde(default)]
    input: f64,
    output: f64,
}

#[derive(Deserialize)]
struct Run {
    name: String,
    input: Vec<f64>,
    #[serde(default)]
    output: Vec<f64>,
    #[serde(default)]
    tolerance: f64,
    #[serde(default)]
    dt: Option<Vec<f64>>,
    #[serde(default)]
    load: Option<Vec<f64>>,
    #[serde(default)]
    drive_range: Option<(f64, f64)>,
    #[serde(default)]
    horizon: f64,
    #[serde(default)]
    heading: Vec<i8>,
    #[serde(default)]
    target: Vec<f64>,
    #[serde(default)]
    status: Vec<i8>,
}

impl Run {
    /// Time and load of a sample with this input or target.
    fn sample(&self, n: usize, input: f64) -> Sample {
        let at = |series: &Option<Vec<f64>>| series.as_ref().map(|series| series[n]);
        Sample {
            input,
            dt: at(&self.dt),
            load: at(&self.load),
        }
    }

    /// The definition's outputs for these inputs.
    fn defined(&self, model: &Model, inputs: &[f64]) -> Vec<f64> {
        let at = |series: &Option<Vec<f64>>, n: usize| series.as_ref().map_or(0.0, |s| s[n]);
        let sample = |(n, &value): (usize, &f64)| chain::Sample {
            value,
            dt: at(&self.dt, n),
            load: at(&self.load, n),
        };
        let samples: Vec<_> = inputs.iter().enumerate().map(sample).collect();
        chain::Chain::new(model).unwrap().forward(&samples).unwrap()
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors")
}

fn forward(model: &Model, tolerance: &Tolerance, run: &Run) -> f64 {
    let mut state = model.start();
    let outputs: Vec<f64> = (run.input.iter().enumerate())
        .map(|(n, &input)| model.step(&mut state, run.sample(n, input)).unwrap().output)
        .collect();
    assert_eq!(outputs.len(), run.output.len());
    if let (None, None) = (&run.dt, &run.load) {
        assert_eq!(model.simulate(&run.input).unwrap(), outputs);
    }
    let pairs = outputs.iter().zip(&run.output);
    pairs
        .map(|(a, b)| (a - b).abs() / tolerance.output)
        .fold(0.0, f64::max)
}

fn inverse(model: &Model, tolerance: &Tolerance, run: &Run) -> f64 {
    let (low, high) = run.drive_range.unwrap_or_else(|| model.drive_range());
    let inverse = model.inverse().unwrap().drive_range(low, high).unwrap();
    let inverse = inverse.horizon(run.horizon).unwrap();
    let mut state = model.start();
    let mut worst = 0.0_f64;
    let mut inputs = Vec::new();
    for (n, &target) in run.target.iter().enumerate() {
        let heading = match run.heading[n] {
            0 => None,
            way if way > 0 => Some(Direction::Rising),
            _ => Some(Direction::Falling),
        };
        let wanted = Target::new(target)
            .heading(heading)
            .tolerance(run.tolerance);
        let Sample { dt, load, .. } = run.sample(n, target);
        let wanted = Wanted {
            dt,
            load,
            ..wanted.into()
        };
        let solution = inverse.step(&mut state, wanted).unwrap();
        assert_eq!(
            solution.status.number(),
            run.status[n],
            "{}, sample {n}",
            run.name
        );
        worst = worst.max((solution.input - run.input[n]).abs() / tolerance.input);
        inputs.push(solution.input);
    }
    // H(H⁻¹(y)) = y by the definition.
    let outputs = run.defined(model, &inputs);
    for (n, output) in outputs.iter().enumerate() {
        if run.status[n] == 0 {
            let error = (output - run.target[n]).abs() - run.tolerance;
            worst = worst.max(error / tolerance.output);
        }
    }
    worst
}

#[test]
fn the_facade_reproduces_the_vectors() {
    for (name, _) in make::all().unwrap() {
        let text = std::fs::read_to_string(folder().join(&name)).unwrap();
        let file: File = serde_json::from_str(&text).unwrap();
        let model = Model::from_json(&file.model.to_string()).unwrap();
        for run in &file.runs {
            let worst = match file.kind.as_str() {
                "forward" => forward(&model, &file.tolerance, run),
                _ => inverse(&model, &file.tolerance, run),
            };
            println!("{name}, {}: {worst:.1e} of the tolerance", run.name);
            assert!(
                worst <= 1.0,
                "{name}, {}: {worst} times the tolerance",
                run.name
            );
        }
    }
}

#[test]
fn the_files_are_what_the_example_makes() {
    let files = make::all().unwrap();
    for (name, text) in &files {
        let found = std::fs::read_to_string(folder().join(name)).unwrap();
        assert!(
            found == *text,
            "{name} differs: run `cargo run -p hysteron --example vectors -- vectors`"
        );
        assert!(text.len() <= 40_000, "{name}: {} bytes", text.len());
    }
    let there = std::fs::read_dir(folder()).unwrap();
    let json = |name: &PathBuf| name.extension().is_some_and(|e| e == "json");
    let there = there.map(|e| e.unwrap().path()).filter(json).count();
    assert_eq!(there, files.len(), "a file in vectors/ is made by nothing");
}

/// Where the drive is limited and time stands still, the files say so, and reach every status.
#[test]
fn the_stages_reach_every_status() {
    let mut found = [0; 4];
    let (mut still, mut jumps) = (0, 0);
    for (name, text) in make::all().unwrap() {
        let file: File = serde_json::from_str(&text).unwrap();
        for run in file.runs.iter().filter(|run| run.dt.is_some()) {
            let steps = &run.dt.as_ref().unwrap()[1..];
            still += steps.iter().filter(|dt| **dt == 0.0).count();
            jumps += steps.iter().filter(|dt| **dt >= 1e3).count();
            for status in &run.status {
                let place = [-1, 0, 1, 3].iter().position(|s| s == status);
                assert!(place.is_some(), "{name}: {status}");
                found[place.unwrap()] += 1;
            }
        }
    }
    assert!(found.iter().all(|count| *count >= 50), "{found:?}");
    assert!(still >= 20 && jumps >= 20, "{still}, {jumps}");
}
