//! The files of models with stages: each stage alone, and all of them.

use super::chain::{Aim, Chain, Sample, size};
use super::make::{GRAIN, array, file, model, short, uniform};
use hysteron::{Model, Operator, Result, Sign};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde_json::{Value, json};

const SAMPLES: usize = 60;
/// The step of runs with a fixed one, in seconds.
const DT: f64 = 0.125;
/// The range of loads. The curves begin and end within it.
const LOADS: (f64, f64) = (0.0, 200.0);

#[derive(Clone, Copy, PartialEq)]
enum Stage {
    Body,
    /// Heat that is bound, of a body.
    Latent,
    Load,
    Spacing,
    Creep,
    Lag,
    Curve,
    Registration,
    Ring,
    /// Weights and offset of the second order in the load.
    Weights,
}

const EVERY: [Stage; 5] = [
    Stage::Body,
    Stage::Load,
    Stage::Spacing,
    Stage::Creep,
    Stage::Lag,
];

/// Name and text of each file.
pub fn all() -> Result<Vec<(String, String)>> {
    use Operator::{Kp, Mkp, Relay};
    use Sign::{Negative, Positive};
    let mut files = Vec::new();
    let mut both = |name: &str, operator, stages: &[Stage], line| -> Result<()> {
        let model = with(operator, stages, line)?;
        files.push((format!("forward-{name}.json"), forward_file(&model)?));
        // Relays have no inverse here: see the page beside the vectors.
        if operator != Relay {
            files.push((format!("inverse-{name}.json"), inverse_file(&model)?));
        }
        Ok(())
    };
    let line = (0.0, Positive);
    both("body-mkp-5", Mkp, &[Stage::Body], line)?;
    both("latent-mkp-5", Mkp, &[Stage::Body, Stage::Latent], line)?;
    both("load-mkp-5", Mkp, &[Stage::Load], line)?;
    both("spacing-mkp-5", Mkp, &[Stage::Spacing], line)?;
    both("creep-mkp-5", Mkp, &[Stage::Creep], line)?;
    both("lag-mkp-5", Mkp, &[Stage::Lag], line)?;
    both("curve-mkp-5", Mkp, &[Stage::Curve], line)?;
    both("registration-mkp-5", Mkp, &[Stage::Registration], line)?;
    both("ring-mkp-5", Mkp, &[Stage::Ring], line)?;
    both("chain-mkp-5", Mkp, &EVERY, line)?;
    both("chain-kp-5", Kp, &EVERY, (-3.5, Negative))?;
    both("chain-relay-5", Relay, &EVERY, line)?;
    let curved = [&EVERY[..], &[Stage::Curve]].concat();
    both("chain-curve-mkp-5", Mkp, &curved, line)?;
    both("chain-curve-kp-5", Kp, &curved, (-3.5, Negative))?;
    let registered = [&EVERY[..], &[Stage::Registration]].concat();
    both("chain-registration-mkp-5", Mkp, &registered, line)?;
    both("chain-registration-kp-5", Kp, &registered, (-3.5, Negative))?;
    let ringing = [&EVERY[..], &[Stage::Ring]].concat();
    both("chain-ring-kp-5", Kp, &ringing, (-3.5, Negative))?;
    let bound = [&registered[..], &[Stage::Latent]].concat();
    both("chain-latent-kp-5", Kp, &bound, (-3.5, Negative))?;
    both("weights-mkp-5", Mkp, &[Stage::Weights], line)?;
    let whole = [&EVERY[..], &[Stage::Weights]].concat();
    both("chain-weights-mkp-5", Mkp, &whole, line)?;
    both("chain-weights-kp-5", Kp, &whole, (-3.5, Negative))?;
    Ok(files)
}

/// A model with these stages. Constants are multiples of 1/1024, as inputs and targets are.
fn with(operator: Operator, stages: &[Stage], line: (f64, Sign)) -> Result<Model> {
    let plain = model(operator, 5, 1, line)?;
    let mut text: Value = serde_json::from_str(&plain.to_json()).unwrap_or_default();
    text["version"] = 2.into();
    for stage in stages {
        match stage {
            Stage::Body => {
                text["thermal"] = json!({
                    "kind": "first-order", "ambient": -8.0, "gain": 128.0,
                    "tau_heating": 0.25, "tau_cooling": 0.375,
                });
                text["drive"] = json!({"min": 0.0, "max": 1.0});
            }
            Stage::Latent => {
                text["version"] = 3.into();
                text["stages"]["latent"] = json!([48.0]);
            }
            Stage::Load => {
                text["load"] = json!({
                    "name": "stress", "unit": "MPa", "min": LOADS.0, "max": LOADS.1,
                    "parts": [{"offset": plain.offset(), "weights": plain.weights()}],
                    "curves": {
                        "loads": [25.0, 100.0, 175.0], "shifts": [0.0, 6.0, 15.0],
                        "scales": [1.0, 1.0625, 1.0], "gains": [1.0, 1.25, 1.375],
                        "offsets": [0.0, 0.5, 0.25],
                    },
                });
            }
            Stage::Spacing => text["spacing"] = json!([2.0, 20.0, 38.0, 44.0, 50.0, 82.0]),
            Stage::Creep => {
                text["creep"] = json!([
                    {"coefficient": 0.0625, "tau": 0.5}, {"coefficient": 0.03125, "tau": 8.0},
                ]);
            }
            Stage::Lag => text["lag"] = 0.0625.into(),
            Stage::Curve => {
                text["version"] = 3.into();
                // From the middle of the sums of these operators to beyond them.
                let total: f64 = plain.weights().iter().sum();
                let knots = [0.125, 0.375, 0.5, 1.25].map(|share| short(share * total));
                let outputs = [0.0, 0.5, 0.625, 1.5].map(|share| short(share * total));
                text["stages"] = json!({"curve_sums": knots, "curve_outputs": outputs});
            }
            Stage::Registration => {
                text["version"] = 3.into();
                // A row for each load of the curves.
                let loads = if text["load"].is_null() { 1 } else { 3 };
                let up = [
                    [16.0, 38.0, 60.0, 80.0],
                    [20.0, 40.0, 58.0, 84.0],
                    [14.0, 36.0, 62.0, 82.0],
                ];
                let down = [
                    [10.0, 24.0, 44.0, 70.0],
                    [8.0, 28.0, 50.0, 72.0],
                    [14.0, 30.0, 40.0, 66.0],
                ];
                text["stages"] = json!({
                    "knots": [10.0, 30.0, 50.0, 74.0],
                    "rising": up[..loads].concat(), "falling": down[..loads].concat(),
                });
            }
            Stage::Ring => {
                text["version"] = 3.into();
                text["stages"] = json!({"ring_frequency": [1.0], "ring_damping": [0.125]});
            }
            Stage::Weights => {
                let offset = |part: usize| plain.offset() + [0.0, 1.5, -0.25][part];
                let weights = |part: usize| -> Vec<f64> {
                    let factor = |n: usize| 1.0 + ((n + 3 * part) % 4) as f64 / 4.0;
                    let weights = plain.weights().iter().enumerate();
                    weights.map(|(n, mu)| factor(n) * mu).collect()
                };
                let part = |part| json!({"offset": offset(part), "weights": weights(part)});
                // The file says them a second time, in the middle of the loads.
                let middle = |of: [f64; 3]| (of[0] + 2.0 * of[1] + of[2]) / 4.0;
                let all = [0, 1, 2].map(weights);
                let weight = |n: usize| middle([0, 1, 2].map(|part: usize| all[part][n]));
                text["weights"] = (0..all[0].len()).map(weight).collect();
                text["output"]["offset"] = middle([0, 1, 2].map(offset)).into();
                let load = &mut text["load"];
                if load.is_null() {
                    *load = json!({"name": "stress", "unit": "MPa"});
                    (load["min"], load["max"]) = (LOADS.0.into(), LOADS.1.into());
                }
                load["parts"] = (0..3).map(part).collect();
            }
        }
    }
    Model::from_json(&text.to_string())
}

/// Steps of time for runs in which the time stands still and jumps. Zero first.
fn times(random: &mut ChaCha8Rng, still: bool) -> Vec<f64> {
    let steps = [DT, DT / 2.0, 0.0, 2.0, 1e3, 0.75];
    let steps = if still {
        &steps[..]
    } else {
        &[DT, 0.5, 2.0, 1e3]
    };
    let step = |n: usize| match n {
        0 => 0.0,
        _ => steps[(uniform(random) * (steps.len() as f64 - 0.001)) as usize],
    };
    (0..SAMPLES).map(step).collect()
}

fn fixed() -> Vec<f64> {
    let step = |n: usize| if n == 0 { 0.0 } else { DT };
    (0..SAMPLES).map(step).collect()
}

/// A load that rises and falls, on and between those of the curves, and beyond them.
fn slow_loads() -> Vec<f64> {
    let (low, high) = LOADS;
    let share = |n: usize| 0.5 - 0.5 * (n as f64 / 9.0).cos();
    (0..SAMPLES)
        .map(|n| short(low + (high - low) * share(n)))
        .collect()
}

/// A load that jumps, and rests between.
fn jumping_loads(random: &mut ChaCha8Rng) -> Vec<f64> {
    let mut load = 100.0;
    let mut next = |_| {
        if uniform(random) < 0.3 {
            load = short(LOADS.0 + (LOADS.1 - LOADS.0) * uniform(random));
        }
        load
    };
    (0..SAMPLES).map(&mut next).collect()
}

/// The inputs at which the operators of the middle load are all off and all on: drives, with a
/// body.
fn span(model: &Model) -> (f64, f64) {
    let (low, high) = model.active_range();
    match model.thermal {
        Some(body) => (
            (low - body.ambient) / body.gain,
            (high - body.ambient) / body.gain,
        ),
        None => (low, high),
    }
}

struct Series {
    name: &'static str,
    input: Vec<f64>,
    dt: Vec<f64>,
    load: Vec<f64>,
}

fn inputs(model: &Model) -> Vec<Series> {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let (low, high) = span(model);
    let at = |share: f64| short(low + share * (high - low));
    let time = |n: usize| n as f64 / SAMPLES as f64;
    let smooth = |n| at(0.5 - 0.55 * (1.0 - 0.8 * time(n)) * (25.0 * time(n)).cos());
    let mut place = 0.5;
    let mut walk = |random: &mut ChaCha8Rng| {
        place = (place + (uniform(random) - 0.5) * 0.8).clamp(-0.05, 1.05);
        at(place)
    };
    let fixed_walk = (0..SAMPLES).map(|_| walk(&mut random)).collect();
    let mut all = vec![
        Series {
            name: "a fixed step: loops that shrink",
            input: (0..SAMPLES).map(smooth).collect(),
            dt: fixed(),
            load: slow_loads(),
        },
        Series {
            name: "a fixed step: random walk",
            input: fixed_walk,
            dt: fixed(),
            load: jumping_loads(&mut random),
        },
    ];
    if model.is_timed() {
        all.push(Series {
            name: "random walk in times that stand still and jump",
            input: (0..SAMPLES).map(|_| walk(&mut random)).collect(),
            dt: times(&mut random, true),
            load: jumping_loads(&mut random),
        });
    }
    if model.load.is_some() {
        all.push(Series {
            name: "a fixed step: the input rests and the load moves",
            input: (0..SAMPLES).map(|n| at([0.3, 0.8, 0.5][n / 20])).collect(),
            dt: fixed(),
            load: (0..SAMPLES)
                .map(|n| {
                    short(
                        LOADS.0
                            + (LOADS.1 - LOADS.0) * (0.5 - 0.5 * (0.9 * time(n) * n as f64).cos()),
                    )
                })
                .collect(),
        });
    }
    all
}

fn samples(values: &[f64], dt: &[f64], load: &[f64]) -> Vec<Sample> {
    let series = values.iter().zip(dt).zip(load);
    let sample = |((&value, &dt), &load)| Sample { value, dt, load };
    series.map(sample).collect()
}

/// Time and load, as far as the model needs them.
fn around(model: &Model, dt: &[f64], load: &[f64]) -> String {
    let mut text = String::new();
    if model.is_timed() {
        text += &format!(r#""dt": {}, "#, array(dt));
    }
    if model.load.is_some() {
        text += &format!(r#""load": {}, "#, array(load));
    }
    text
}

fn forward_file(model: &Model) -> Result<String> {
    let runs = inputs(model).into_iter().map(|series| {
        let Series {
            name,
            input,
            dt,
            load,
        } = series;
        let output = Chain::new(model)?.forward(&samples(&input, &dt, &load))?;
        Ok(format!(
            r#"{{"name": "{name}", {}"input": {}, "output": {}}}"#,
            around(model, &dt, &load),
            array(&input),
            array(&output)
        ))
    });
    let runs = runs.collect::<Result<Vec<_>>>()?;
    let tolerance = format!(
        r#"{{"output": {:e}, "reason": "1e-13 of the largest output: each stage rounds, and the slope of the operators carries that on; exponentials may be off by their last digit"}}"#,
        1e-13 * size(model)
    );
    Ok(file(2, "forward", model, &tolerance, &runs))
}

struct Reference {
    name: &'static str,
    target: Vec<f64>,
    heading: Vec<i8>,
    tolerance: f64,
    dt: Vec<f64>,
    load: Vec<f64>,
    /// Another range of drives than the model's, and a horizon.
    limits: Option<((f64, f64), f64)>,
}

fn references(model: &Model) -> Vec<Reference> {
    let mut random = ChaCha8Rng::seed_from_u64(19);
    let (a, b) = model.output_range();
    let at = |share: f64| short(a.min(b) + share * (b - a).abs());
    let corners = [0.0625, 0.875, 0.25, 0.75, 0.375, 0.9375, 0.125];
    let shares: Vec<f64> = (10..SAMPLES + 10)
        .map(|n| {
            let (from, to) = (corners[n / 10 - 1], corners[n / 10]);
            from + (to - from) * (n % 10).min(7) as f64 / 7.0
        })
        .collect();
    let ways = |n: usize| {
        let next = shares[n..].iter().find(|share| **share != shares[n]);
        next.map_or(0, |next| if *next > shares[n] { 1 } else { -1 })
    };
    let ramps: Vec<f64> = shares.iter().map(|share| at(*share)).collect();
    let hold = || vec![0; SAMPLES];
    let mut anywhere = |_| at(1.4 * uniform(&mut random) - 0.2);
    let (wide, far): (Vec<f64>, Vec<f64>) = (
        (0..SAMPLES).map(&mut anywhere).collect(),
        (0..SAMPLES).map(&mut anywhere).collect(),
    );
    let noisy = |n: usize, noise: f64| at(0.5 - 0.375 * (0.15 * n as f64).cos() + 0.03 * noise);
    let noisy: Vec<f64> = (0..SAMPLES)
        .map(|n| noisy(n, uniform(&mut random) - 0.5))
        .collect();
    let run = |name, target: &[f64], load| Reference {
        name,
        target: target.to_vec(),
        heading: hold(),
        tolerance: 0.0,
        dt: fixed(),
        load,
        limits: None,
    };
    let mut all = vec![
        run("hold, a fixed step: ramps with rests", &ramps, slow_loads()),
        Reference {
            heading: (0..SAMPLES).map(ways).collect(),
            ..run(
                "anticipate, a fixed step: the same ramps",
                &ramps,
                vec![100.0; SAMPLES],
            )
        },
        run(
            "hold, a fixed step: anywhere, also out of reach",
            &wide,
            jumping_loads(&mut random),
        ),
    ];
    if model.is_timed() {
        // A lag that follows a body cannot tell which way to drive while time stands still.
        let rings = !model.constants().get("ring_frequency").is_empty();
        let still = (model.thermal.is_none() || model.lag() == 0.0) && !rings;
        all.push(Reference {
            dt: times(&mut random, still),
            ..run(
                "hold: anywhere, in times that stand still and jump",
                &far,
                jumping_loads(&mut random),
            )
        });
    }
    if model.thermal.is_some() {
        all.push(Reference {
            tolerance: short(0.03 * (b - a).abs()) + GRAIN / 2.0,
            limits: Some(((0.0625, 0.75), 1.0)),
            ..run(
                "hold with a tolerance, a horizon and other limits: a noisy target",
                &noisy,
                slow_loads(),
            )
        });
    }
    all
}

fn inverse_file(model: &Model) -> Result<String> {
    let runs = references(model).into_iter().map(|run| {
        let (drive_range, horizon) = run.limits.unwrap_or((model.drive_range(), 0.0));
        let aims = samples(&run.target, &run.dt, &run.load).into_iter();
        let aims: Vec<Aim> = aims
            .zip(&run.heading)
            .map(|(sample, &heading)| Aim {
                sample,
                heading,
                tolerance: run.tolerance,
                drive_range,
                horizon,
            })
            .collect();
        let found = Chain::new(model)?.inverse(&aims)?;
        let (input, status): (Vec<f64>, Vec<i8>) = found.into_iter().unzip();
        let limits = match run.limits {
            Some(((low, high), horizon)) => {
                format!(r#""drive_range": [{low:?}, {high:?}], "horizon": {horizon:?}, "#)
            }
            None => String::new(),
        };
        Ok(format!(
            r#"{{"name": "{}", "tolerance": {:?}, {limits}{}"heading": {:?}, "target": {}, "input": {}, "status": {status:?}}}"#,
            run.name,
            run.tolerance,
            around(model, &run.dt, &run.load),
            run.heading,
            array(&run.target),
            array(&input),
        ))
    });
    let runs = runs.collect::<Result<Vec<_>>>()?;
    let (low, high) = span(model);
    let (a, b) = model.output_range();
    let tolerance = format!(
        r#"{{"input": {:e}, "output": {:e}, "reason": "output: 1e-11 of the range, the inverse's promise with the rounding of each stage; input: 1e-10 of the range from the lowest to the highest level, the output's rounding over the least slope of the operators, made larger by body and lag, which act within a fraction of their time"}}"#,
        1e-10 * (high - low),
        1e-11 * (b - a).abs()
    );
    Ok(file(2, "inverse", model, &tolerance, &runs))
}
