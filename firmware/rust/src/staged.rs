//! Models with stages, and their runs: those of the test vectors that have a fixed time step, and
//! those that are measured.

use crate::data::{
    FORWARD, Model, Random, SAMPLES, bench_model, files, model, number, numbers, short,
};
use serde_json::{Value, json};
use std::path::Path;

/// The stages that are measured, each alone, and all of them.
pub const MEASURED: [&str; 7] = ["body", "load", "weights", "spacing", "creep", "lag", "all"];
/// The levels of the models that are measured.
pub const STAGED_LEVELS: usize = 20;
/// The time step of the runs that are measured, in seconds.
const DT: f64 = 0.125;

pub struct StagedModel {
    pub model: Model,
    /// The constants of all stages, by the names that they declare.
    pub constants: Vec<(String, Vec<f64>)>,
    /// Offset and weights of each part and the range of the load, where the weights depend on it.
    pub parts: Vec<(f64, Vec<f64>)>,
    pub range: (f64, f64),
    /// The range of the drive, where it is limited.
    pub drive: Option<(f64, f64)>,
    /// The time step; `None` for a model that does not depend on time.
    pub dt: Option<f64>,
}

pub struct StagedRun {
    pub name: String,
    pub model: usize,
    pub tolerance: f64,
    /// Kind, value and load of each step.
    pub steps: Vec<(i8, f64, f64)>,
    /// As for a run without stages.
    pub expected: Option<(Vec<f64>, Vec<i8>, f64)>,
}

pub fn all(vectors: &Path) -> (Vec<StagedModel>, Vec<StagedRun>) {
    let (mut models, mut runs) = (Vec::new(), Vec::new());
    for (name, file) in files(vectors, 2) {
        let before = runs.len();
        let all = file["runs"].as_array().expect("runs").iter();
        let mut dt = None;
        for run in all.filter(|run| fixed(run).is_some()) {
            dt = fixed(run);
            runs.push(vector(&name, models.len(), &file, run));
        }
        assert!(
            runs.len() > before,
            "{name} has no run with a fixed time step"
        );
        // Names in C have at most 31 letters.
        let c_name = name.replace('-', "_").replace("registration", "reg");
        models.push(staged(&c_name, file["model"].clone(), dt));
    }
    for what in MEASURED {
        let staged = measured(what);
        runs.extend(measured_runs(&staged, models.len()));
        models.push(staged);
    }
    (models, runs)
}

/// The time step of a run after its first sample; `None` where it changes, or where the drive has
/// other limits than the model's.
fn fixed(run: &Value) -> Option<f64> {
    let dt = numbers(&run["dt"]);
    let step = dt.get(1).copied().unwrap_or(DT);
    let same = dt.iter().skip(1).all(|dt| *dt == step);
    (same && run["drive_range"].is_null()).then_some(step)
}

fn staged(name: &str, json: Value, dt: Option<f64>) -> StagedModel {
    let load = &json["load"];
    let parts = load["parts"].as_array().into_iter().flatten();
    let parts: Vec<_> = parts
        .map(|part| (number(&part["offset"]), numbers(&part["weights"])))
        .collect();
    let varies = parts.len() > 1;
    let constants = constants(&json);
    let timed = constants
        .iter()
        .any(|(name, _)| TIMED.contains(&name.as_str()));
    let drive = &json["drive"];
    StagedModel {
        constants,
        range: match varies {
            true => (number(&load["min"]), number(&load["max"])),
            false => (0.0, 0.0),
        },
        parts: if varies { parts } else { Vec::new() },
        drive: (!drive.is_null()).then(|| (number(&drive["min"]), number(&drive["max"]))),
        dt: dt.filter(|_| timed),
        model: model(name, json),
    }
}

/// Constants of stages that depend on time.
const TIMED: [&str; 4] = ["tau_heating", "creep_taus", "lag", "ring_frequency"];

/// The constants of a model file, by their names; those of version 3 as they stand there.
fn constants(json: &Value) -> Vec<(String, Vec<f64>)> {
    let single = |value: &Value| value.as_f64().into_iter().collect::<Vec<f64>>();
    let terms: Vec<&Value> = json["creep"].as_array().into_iter().flatten().collect();
    let terms = |what: &str| terms.iter().map(|term| number(&term[what])).collect();
    let thermal = &json["thermal"];
    let body = ["gain", "tau_heating", "tau_cooling"].map(|name| (name, single(&thermal[name])));
    let ambient = match thermal.is_null() {
        true => Vec::new(),
        false => vec![thermal["ambient"].as_f64().unwrap_or(0.0)],
    };
    let curves = &json["load"]["curves"];
    let curves = ["loads", "shifts", "scales", "gains", "offsets"]
        .map(|name| (name, numbers(&curves[name])));
    let others = [
        ("ambient", ambient),
        ("spacing", numbers(&json["spacing"])),
        ("creep", terms("coefficient")),
        ("creep_taus", terms("tau")),
        ("lag", single(&json["lag"])),
    ];
    let of_version_3 = json["stages"].as_object().into_iter().flatten();
    let of_version_3 = of_version_3.map(|(name, list)| (name.clone(), numbers(list)));
    let all = body.into_iter().chain(curves).chain(others);
    all.map(|(name, list)| (name.to_owned(), list))
        .chain(of_version_3)
        .filter(|(_, list)| !list.is_empty())
        .collect()
}

fn vector(name: &str, model: usize, file: &Value, run: &Value) -> StagedRun {
    let forward = file["kind"] == "forward";
    let (values, results) = if forward {
        ("input", "output")
    } else {
        ("target", "input")
    };
    let values = numbers(&run[values]);
    let load = numbers(&run["load"]);
    let heading = numbers(&run["heading"]);
    let step = |(n, value)| {
        let kind = heading.get(n).map_or(FORWARD, |heading| *heading as i8);
        (kind, value, load.get(n).copied().unwrap_or(0.0))
    };
    let status = match forward {
        true => vec![0; values.len()],
        false => numbers(&run["status"]).iter().map(|&s| s as i8).collect(),
    };
    StagedRun {
        name: format!("{name}: {}", run["name"].as_str().expect("a name")),
        model,
        tolerance: run["tolerance"].as_f64().unwrap_or(0.0),
        steps: values.into_iter().enumerate().map(step).collect(),
        expected: Some((
            numbers(&run[results]),
            status,
            number(&file["tolerance"][results]),
        )),
    }
}

/// The model that is measured without stages, with one of them or with all.
fn measured(what: &str) -> StagedModel {
    let plain = bench_model(STAGED_LEVELS);
    let mut json = plain.json;
    json["version"] = 2.into();
    let there = |stage: &str| what == stage || what == "all";
    if there("body") {
        json["thermal"] = json!({
            "kind": "first-order", "ambient": 10.0, "gain": 80.0,
            "tau_heating": 0.125, "tau_cooling": 0.1875,
        });
        json["drive"] = json!({"min": 0.0, "max": 1.0});
    }
    let curves = json!({
        "loads": [0.0, 50.0, 100.0, 200.0], "shifts": [0.0, 4.0, 6.0, 12.0],
        "scales": [1.0, 1.0625, 1.0625, 1.0], "gains": [1.0, 1.25, 1.5, 1.5],
        "offsets": [0.0, 0.5, 0.25, 0.0],
    });
    // Three parts: weights that are a parabola of the load.
    let part = |offset: f64, gain: f64| {
        let weights: Vec<f64> = plain.weights.iter().map(|weight| gain * weight).collect();
        json!({"offset": offset, "weights": weights})
    };
    let parts = match there("weights") {
        true => json!([part(0.0, 1.0), part(0.5, 1.25), part(0.25, 0.875)]),
        false => json!([part(0.0, 1.0)]),
    };
    if there("weights") {
        // Those of the file are the parts' in the middle of the loads: 1/4, 1/2 and 1/4 of them.
        let weights = plain.weights.iter().map(|weight| 1.09375 * weight);
        json["weights"] = weights.collect();
        json["output"]["offset"] = 0.3125.into();
    }
    if there("load") || there("weights") {
        json["load"] = json!({"name": "stress", "min": 0.0, "max": 200.0, "parts": parts});
    }
    if there("load") {
        json["load"]["curves"] = curves;
    }
    if there("spacing") {
        let corner = |k: usize| {
            let x = k as f64 / STAGED_LEVELS as f64 - 0.5;
            short(48.0 + 62.0 * (x + 4.0 * x * x * x) / 2.0)
        };
        json["spacing"] = (0..=STAGED_LEVELS).map(corner).collect();
    }
    if there("creep") {
        json["creep"] = json!([
            {"coefficient": 0.0625, "tau": 0.5}, {"coefficient": 0.03125, "tau": 8.0},
        ]);
    }
    if there("lag") {
        json["lag"] = 0.0625.into();
    }
    staged(&format!("stage_{what}"), json, Some(DT))
}

/// A random walk of the drive and one of the target, as for a model without stages. The load
/// changes at each sample.
fn measured_runs(staged: &StagedModel, number: usize) -> Vec<StagedRun> {
    let total: f64 = staged.model.weights.iter().sum();
    let spacing = staged.constants.iter().find(|(name, _)| name == "spacing");
    let (low, high) = match (
        &staged.drive,
        spacing.map(|(_, corners)| corners.as_slice()),
    ) {
        (Some(range), _) => *range,
        (None, Some([low, .., high])) => (*low, *high),
        _ => (staged.model.min, staged.model.max),
    };
    let mut random = Random(7);
    let mut place: f64 = 0.5;
    let walk: Vec<(f64, f64)> = (0..SAMPLES)
        .map(|_| {
            place = (place + (random.next() - 0.5) * 0.5).clamp(0.0, 1.0);
            (place, short(200.0 * random.next()))
        })
        .collect();
    let run = |name: &str, kind: i8, low: f64, high: f64| StagedRun {
        name: format!("{}: {name}", staged.model.name),
        model: number,
        tolerance: 0.0,
        steps: walk
            .iter()
            .map(|(share, load)| (kind, short(low + share * (high - low)), *load))
            .collect(),
        expected: None,
    };
    vec![
        run("forward, walk", FORWARD, low, high),
        run("inverse, walk", 0, 0.0, total),
    ]
}
