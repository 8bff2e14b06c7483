//! The runs: every run of every test vector, and the runs that are measured.
//!
//! The build script writes them as Rust constants; `host` writes them for C, with model files. The
//! build script has no access to `hysteron-core`, so this file does not use it.

use serde_json::Value;
use std::path::Path;

/// Numbers of levels of the models that are measured.
pub const LEVELS: [usize; 3] = [10, 20, 40];

/// Kind of a step: a forward step with an input. Otherwise an inverse step with a target, and the
/// kind is the policy: *hold* (0) or *anticipate* (±1).
pub const FORWARD: i8 = 2;

pub struct Model {
    /// A C identifier.
    pub name: String,
    pub operator: String,
    pub min: f64,
    pub max: f64,
    pub levels: usize,
    pub offset: f64,
    pub sign: f64,
    pub weights: Vec<f64>,
    /// The model file.
    pub json: Value,
}

pub struct Run {
    pub name: String,
    /// Index of the model.
    pub model: usize,
    pub tolerance: f64,
    /// Kind and value of each step: input or target.
    pub steps: Vec<(i8, f64)>,
    /// Results that a vector expects: input or output, status, and the tolerance of the result.
    pub expected: Option<(Vec<f64>, Vec<i8>, f64)>,
    /// Largest difference from the output of the definition that is allowed in double.
    pub output_tolerance: f64,
}

pub fn all(vectors: &Path) -> (Vec<Model>, Vec<Run>) {
    let (mut models, mut runs) = (Vec::new(), Vec::new());
    // Version 2 has models with stages: `staged.rs`.
    for (name, file) in files(vectors, 1) {
        for run in file["runs"].as_array().expect("runs") {
            runs.push(vector(&name, models.len(), &file, run));
        }
        models.push(model(&name.replace('-', "_"), file["model"].clone()));
    }
    for levels in LEVELS {
        let number = models.len();
        models.push(bench_model(levels));
        runs.extend(bench_runs(&models[number], number));
    }
    (models, runs)
}

/// Name and content of each vector of a version.
pub fn files(vectors: &Path, version: u8) -> Vec<(String, Value)> {
    let files = std::fs::read_dir(vectors).expect("the folder of the vectors");
    let mut files: Vec<_> = files.map(|entry| entry.expect("a file").path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "json"));
    files.sort();
    let read = |path: std::path::PathBuf| {
        let text = std::fs::read_to_string(&path).expect("a vector file");
        let file: Value = serde_json::from_str(&text).expect("JSON");
        let name = path.file_stem().expect("a name").to_string_lossy();
        (name.into_owned(), file)
    };
    let files = files.into_iter().map(read);
    files
        .filter(|(_, file)| file["version"] == version)
        .collect()
}

pub fn numbers(value: &Value) -> Vec<f64> {
    let values = value.as_array().map(Vec::as_slice).unwrap_or_default();
    values.iter().map(number).collect()
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

pub fn model(name: &str, json: Value) -> Model {
    Model {
        name: name.into(),
        operator: json["operator"].as_str().expect("an operator").into(),
        min: number(&json["plane"]["min"]),
        max: number(&json["plane"]["max"]),
        levels: number(&json["plane"]["levels"]) as usize,
        offset: number(&json["output"]["offset"]),
        sign: number(&json["output"]["sign"]),
        weights: numbers(&json["weights"]),
        json,
    }
}

fn vector(name: &str, model: usize, file: &Value, run: &Value) -> Run {
    let forward = file["kind"] == "forward";
    let (values, results, unit) = if forward {
        ("input", "output", "output")
    } else {
        ("target", "input", "input")
    };
    let values = numbers(&run[values]);
    let headings = if forward {
        vec![f64::from(FORWARD); values.len()]
    } else {
        numbers(&run["heading"])
    };
    let status = if forward {
        vec![0; values.len()]
    } else {
        numbers(&run["status"]).iter().map(|&s| s as i8).collect()
    };
    Run {
        name: format!("{name}: {}", run["name"].as_str().expect("a name")),
        model,
        tolerance: run["tolerance"].as_f64().unwrap_or(0.0),
        steps: headings.iter().map(|&h| h as i8).zip(values).collect(),
        expected: Some((
            numbers(&run[results]),
            status,
            number(&file["tolerance"][unit]),
        )),
        output_tolerance: number(&file["tolerance"]["output"]),
    }
}

/// Xorshift (Marsaglia 2003), in `[0, 1)`. It gives the same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        for (left, by) in [(true, 13), (false, 7), (true, 17)] {
            self.0 ^= if left { self.0 << by } else { self.0 >> by };
        }
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Rounds to a multiple of 1/1024, so that single precision has the same numbers.
pub fn short(value: f64) -> f64 {
    (value * 1024.0).round() / 1024.0
}

/// An MKP model with weights from 1/8 to 9/8, in multiples of 1/64. Weights on the diagonal are
/// zero, which makes dead bands.
pub fn bench_model(levels: usize) -> Model {
    let mut random = Random(0x9e37_79b9_7f4a_7c15 + levels as u64);
    let places = (1..=levels).flat_map(|j| (1..=j).map(move |i| (i, j)));
    let weights: Vec<f64> = places
        .map(|(i, j)| {
            let weight = (8.0 + (64.0 * random.next()).floor()) / 64.0;
            if i == j { 0.0 } else { weight }
        })
        .collect();
    let json = serde_json::json!({
        "format": "hysteron-model", "version": 1, "operator": "mkp",
        "plane": {"min": 20.0, "max": 80.0, "levels": levels},
        "input": {"name": "temperature", "unit": "degC"},
        "output": {"name": "displacement", "unit": "mm", "offset": 0.0, "sign": 1},
        "weights": weights,
    });
    model(&format!("bench_{levels}"), json)
}

/// Number of samples of the runs over which means are taken.
pub const SAMPLES: usize = 500;

fn bench_runs(model: &Model, number: usize) -> Vec<Run> {
    let total: f64 = model.weights.iter().sum();
    let run = |name: &str, steps: Vec<(i8, f64)>| Run {
        name: format!("{}: {name}", model.name),
        model: number,
        tolerance: 0.0,
        steps,
        expected: None,
        // The tolerances of the vectors: 1e-13 of the sum of the weights forward, 1e-12 for the
        // inverse.
        output_tolerance: if name.starts_with("forward") {
            1e-13
        } else {
            1e-12
        } * total,
    };
    // Both shapes as fractions of a range, of the input and of the output.
    let smooth = |n: usize| {
        let time = n as f64 / SAMPLES as f64;
        0.5 - 0.5 * (1.0 - 0.8 * time) * (30.0 * time).cos()
    };
    let mut random = Random(7);
    let mut place: f64 = 0.5;
    let walk: Vec<f64> = (0..SAMPLES)
        .map(|_| {
            place = (place + (random.next() - 0.5) * 0.5).clamp(0.0, 1.0);
            place
        })
        .collect();
    let input = |share: f64| (FORWARD, short(model.min + share * (model.max - model.min)));
    let target = |share: f64| (0, short(share * total));
    vec![
        run(
            "forward, smooth",
            (0..SAMPLES).map(smooth).map(input).collect(),
        ),
        run("forward, walk", walk.iter().copied().map(input).collect()),
        run(
            "inverse, smooth",
            (0..SAMPLES).map(smooth).map(target).collect(),
        ),
        run("inverse, walk", walk.iter().copied().map(target).collect()),
        run("forward, adversary", forward_adversary(model)),
        run("inverse, adversary", inverse_adversary(model, total)),
    ]
}

/// The input at a normalised position.
fn at(model: &Model, x: f64) -> (i8, f64) {
    let step = (model.max - model.min) / (model.levels - 1) as f64;
    (FORWARD, short(model.min + (x - 1.0) * step))
}

/// Nested loops that fill the staircase with as many corners as a state can have: 2K, two for each
/// grid cell that it crosses. Each loop is narrower than the one before by a quarter of a cell at
/// both ends, and the ends reach a new cell in turn. The last loop lies inside what is left.
fn staircase(model: &Model) -> Vec<(i8, f64)> {
    let mut steps = Vec::new();
    let (mut high, mut low) = (model.levels as f64 - 0.125, 0.625);
    while high > low {
        steps.extend([at(model, high), at(model, low)]);
        (high, low) = (high - 0.25, low + 0.25);
    }
    (high, low) = (high + 0.1875, low - 0.1875);
    steps.extend([high, low, (high + low) / 2.0].map(|x| at(model, x)));
    steps
}

/// One jump over a full staircase, to each position where it could cost most. Then a random search.
fn forward_adversary(model: &Model) -> Vec<(i8, f64)> {
    let top = model.levels as f64;
    let mut steps = Vec::new();
    for back in 0..3 {
        for x in [
            top,
            top + 5.0,
            top - 0.2,
            0.0,
            -5.0,
            0.1,
            top / 2.0 + 3.3,
            top / 2.0 - 3.3,
        ] {
            let stairs = staircase(model);
            // A full staircase, or one or two turning points fewer: the jump turns the input or
            // does not.
            steps.extend(&stairs[..stairs.len() - back]);
            steps.push(at(model, x));
        }
    }
    let mut random = Random(11);
    let mut x = 0.0;
    for n in 0..2000 {
        x = match (random.next() * 4.0) as usize {
            // In the same cell, which makes corners merge; on a level; in the next cell; anywhere.
            0 => f64::floor(x) + random.next(),
            1 => (random.next() * top).round(),
            2 => x + random.next() - 0.5,
            // Loops that become narrower at both ends.
            _ => top * (0.5 + if n % 2 == 0 { 0.5 } else { -0.5 } * random.next()),
        };
        x = x.clamp(0.0, top);
        steps.push(at(model, x));
    }
    steps
}

/// Targets all over the range, with each policy, from a full staircase. Then random forward and
/// inverse steps.
fn inverse_adversary(model: &Model, total: f64) -> Vec<(i8, f64)> {
    let mut steps = Vec::new();
    for back in 0..3 {
        for share in [-0.1, 0.0, 0.02, 0.3, 0.6, 0.9, 0.998, 1.0, 1.1] {
            for policy in [0, 1, -1] {
                let stairs = staircase(model);
                steps.extend(&stairs[..stairs.len() - back]);
                steps.push((policy, short(share * total)));
            }
        }
    }
    let mut random = Random(13);
    for _ in 0..500 {
        let share = random.next();
        steps.push(match (random.next() * 4.0) as i8 {
            3 => at(model, share * model.levels as f64),
            policy => (policy - 1, short(share * total)),
        });
    }
    steps
}
