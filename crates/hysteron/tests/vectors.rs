//! The test vectors: the façade reproduces them, and the files are what their example makes.
#![allow(clippy::unwrap_used)]

#[path = "../examples/vectors/make.rs"]
mod make;
#[path = "../examples/vectors/plain.rs"]
mod plain;

use hysteron::{Direction, Model, Target};
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
    heading: Vec<i8>,
    #[serde(default)]
    target: Vec<f64>,
    #[serde(default)]
    status: Vec<i8>,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors")
}

fn forward(model: &Model, tolerance: &Tolerance, run: &Run) -> f64 {
    let outputs = model.simulate(&run.input).unwrap();
    assert_eq!(outputs.len(), run.output.len());
    let pairs = outputs.iter().zip(&run.output);
    pairs
        .map(|(a, b)| (a - b).abs() / tolerance.output)
        .fold(0.0, f64::max)
}

fn inverse(model: &Model, tolerance: &Tolerance, run: &Run) -> f64 {
    let inverse = model.inverse().unwrap();
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
    let outputs = plain::forward(model, &inputs).unwrap();
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
