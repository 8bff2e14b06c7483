//! The files: models, inputs and targets, and what the definition says of them.

use super::plain::{Search, Wanted, forward};
use super::staged;
use hysteron::{Model, Operator, Plane, Result, Sign, operators};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const RANGE: (f64, f64) = (20.0, 80.0);
const SAMPLES: usize = 80;

/// Name and text of each file.
pub fn all() -> Result<Vec<(String, String)>> {
    let mut files = Vec::new();
    let operators = [
        (Operator::Mkp, "mkp"),
        (Operator::Kp, "kp"),
        (Operator::Relay, "relay"),
    ];
    for (operator, name) in operators {
        for levels in [2, 5, 20] {
            let model = model(operator, levels, 0, (0.0, Sign::Positive))?;
            files.push((
                format!("forward-{name}-{levels}.json"),
                forward_file(&model)?,
            ));
        }
    }
    let model_down = model(Operator::Mkp, 5, 0, (-3.5, Sign::Negative))?;
    files.push((
        "forward-mkp-5-negative.json".into(),
        forward_file(&model_down)?,
    ));
    for levels in [2, 5, 20] {
        let model = model(Operator::Mkp, levels, 1, (0.0, Sign::Positive))?;
        files.push((format!("inverse-mkp-{levels}.json"), inverse_file(&model)?));
    }
    let model_kp = model(Operator::Kp, 5, 1, (0.0, Sign::Positive))?;
    files.push(("inverse-kp-5.json".into(), inverse_file(&model_kp)?));
    let model_down = model(Operator::Mkp, 5, 2, (-3.5, Sign::Negative))?;
    files.push((
        "inverse-mkp-5-negative.json".into(),
        inverse_file(&model_down)?,
    ));
    files.extend(staged::all()?);
    Ok(files)
}

/// Weights in 1/64, from 1/8 to 9/8; those with `j − i` below `still` are zero, which makes dead
/// bands.
pub fn model(operator: Operator, levels: usize, still: usize, line: (f64, Sign)) -> Result<Model> {
    let mut random = ChaCha8Rng::seed_from_u64(levels as u64);
    let weights = operators(levels).map(|(i, j)| {
        let weight = f64::from(8 + random.next_u32() % 64) / 64.0;
        if j - i < still { 0.0 } else { weight }
    });
    let plane = Plane::new(RANGE.0, RANGE.1, levels)?;
    Model::new(operator, plane, weights.collect(), line.0, line.1)
}

/// Numbers that inputs and targets are multiples of, so that they are short in the file and the
/// same in single precision.
pub const GRAIN: f64 = 1.0 / 1024.0;

pub fn short(value: f64) -> f64 {
    (value / GRAIN).round() * GRAIN
}

pub fn uniform(random: &mut ChaCha8Rng) -> f64 {
    f64::from(random.next_u32()) / f64::from(u32::MAX)
}

fn inputs(plane: &Plane) -> Vec<(&'static str, Vec<f64>)> {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let (min, max, step) = (plane.min(), plane.max(), plane.step());
    let (middle, half) = ((min + max) / 2.0, (max - min) / 2.0);
    let time = |n: usize| n as f64 / SAMPLES as f64;
    let samples =
        |value: &mut dyn FnMut(usize) -> f64| (0..SAMPLES).map(|n| short(value(n))).collect();
    let mut walk = middle;
    vec![
        (
            "smooth: loops that shrink",
            samples(&mut |n| middle - half * (1.0 - 0.8 * time(n)) * (25.0 * time(n)).cos()),
        ),
        (
            "random walk",
            samples(&mut |_| {
                walk = (walk + (uniform(&mut random) - 0.5) * half).clamp(min - step, max);
                walk
            }),
        ),
        (
            "oscillations nested in one grid cell",
            samples(&mut |n| {
                let side = if n % 2 == 0 { 0.48 } else { -0.48 };
                min + step * (0.5 + side * (1.0 - time(n)))
            }),
        ),
        (
            "out of range, on levels and standing still",
            samples(&mut |n| match n % 8 {
                0 => min - 3.0 * step,
                1 | 6 => min,
                2 | 3 => max,
                4 => max + 1e6,
                5 => middle,
                _ => min - step + (max - min) * time(n),
            }),
        ),
    ]
}

fn forward_file(model: &Model) -> Result<String> {
    let runs = inputs(model.plane()).into_iter().map(|(name, input)| {
        let output = forward(model, &input)?;
        Ok(format!(
            r#"{{"name": "{name}", "input": {}, "output": {}}}"#,
            array(&input),
            array(&output)
        ))
    });
    let runs = runs.collect::<Result<Vec<_>>>()?;
    let size = model.weights().iter().sum::<f64>() + model.offset().abs();
    let tolerance = format!(
        r#"{{"output": {:e}, "reason": "1e-13 of the sum of the weights: the definition adds K(K+1)/2 products, another way fewer, and they round differently"}}"#,
        1e-13 * size
    );
    Ok(file(1, "forward", model, &tolerance, &runs))
}

fn targets(model: &Model) -> Vec<(&'static str, Vec<Wanted>)> {
    let (off, on) = model.output_range();
    let at = |share: f64| short(off.min(on) + share * (on - off).abs());
    let mut random = ChaCha8Rng::seed_from_u64(9);
    // Up and down with rests between, in which a dead band can be crossed.
    let corners = [0.0625, 0.875, 0.25, 0.75, 0.375, 0.9375, 0.125];
    let shares: Vec<f64> = (1..corners.len() * 10)
        .map(|n| {
            let (from, to) = (corners[(n / 10).max(1) - 1], corners[(n / 10).max(1)]);
            from + (to - from) * (n % 10).min(6) as f64 / 6.0
        })
        .collect();
    let ways = |n: usize| {
        let next = shares[n..].iter().find(|share| **share != shares[n]);
        next.map_or(0, |next| if *next > shares[n] { 1 } else { -1 })
    };
    let ramps = |anticipate: bool| {
        let wanted = |n: usize| Wanted {
            target: at(shares[n]),
            heading: if anticipate { ways(n) } else { 0 },
            tolerance: 0.0,
        };
        (0..shares.len()).map(wanted).collect()
    };
    let mut noisy = |tolerance: f64| {
        let noise = |n: usize| Wanted {
            target: at(0.5 - 0.375 * (0.2 * n as f64).cos() + 0.03 * (uniform(&mut random) - 0.5)),
            heading: 0,
            tolerance,
        };
        (0..SAMPLES).map(noise).collect()
    };
    // Between two multiples: a target that goes back by just the tolerance would be for rounding to
    // decide.
    let noisy = noisy(short(0.02 * (on - off).abs()) + GRAIN / 2.0);
    let anywhere = |_| Wanted {
        target: at(1.3 * uniform(&mut random) - 0.15),
        heading: 0,
        tolerance: 0.0,
    };
    let anywhere = (0..SAMPLES).map(anywhere).collect();
    // Jumps among a few targets, so that many are those at which a branch began or a target rested.
    let tolerance = short(0.01 * (on - off).abs()) + GRAIN / 2.0;
    let mut told = |tolerance: f64| {
        let jump = |_| Wanted {
            target: at((uniform(&mut random) * 7.99).floor() / 6.0 - 0.0625),
            heading: (uniform(&mut random) * 2.999) as i8 - 1,
            tolerance,
        };
        (0..SAMPLES).map(jump).collect()
    };
    let (jumps, loose) = (told(0.0), told(tolerance));
    vec![
        ("hold: ramps with rests", ramps(false)),
        ("anticipate: the same ramps", ramps(true)),
        ("hold with a tolerance: a noisy target", noisy),
        ("hold: anywhere, also out of reach", anywhere),
        ("any heading: jumps among a few targets", jumps),
        (
            "any heading, with a tolerance: jumps among a few targets",
            loose,
        ),
    ]
}

fn inverse_file(model: &Model) -> Result<String> {
    let runs = targets(model).into_iter().map(|(name, wanted)| {
        let mut search = Search::new(model)?;
        let found = wanted.iter().map(|wanted| search.step(wanted));
        let found = found.collect::<Result<Vec<_>>>()?;
        let target: Vec<f64> = wanted.iter().map(|wanted| wanted.target).collect();
        let heading: Vec<i8> = wanted.iter().map(|wanted| wanted.heading).collect();
        let input: Vec<f64> = found.iter().map(|found| found.0).collect();
        let status: Vec<i8> = found.iter().map(|found| found.1).collect();
        Ok(format!(
            r#"{{"name": "{name}", "tolerance": {:?}, "heading": {heading:?}, "target": {}, "input": {}, "status": {status:?}}}"#,
            wanted[0].tolerance,
            array(&target),
            array(&input)
        ))
    });
    let runs = runs.collect::<Result<Vec<_>>>()?;
    let (off, on) = model.output_range();
    let tolerance = format!(
        r#"{{"input": {:e}, "output": {:e}, "reason": "output: 1e-12 of the range, the inverse's promise; input: 1e-10 of the distance between levels, the output's rounding over the least slope with room for a hundred steps"}}"#,
        1e-10 * model.plane().step(),
        1e-12 * (on - off).abs()
    );
    Ok(file(1, "inverse", model, &tolerance, &runs))
}

pub fn array(values: &[f64]) -> String {
    format!("{values:?}")
}

/// Written out by hand, so that the order of the fields stays.
pub fn file(version: u8, kind: &str, model: &Model, tolerance: &str, runs: &[String]) -> String {
    format!(
        "{{\"format\": \"hysteron-vectors\", \"version\": {version}, \"kind\": \"{kind}\",\n\"model\": {},\n\"tolerance\": {tolerance},\n\"runs\": [\n{}\n]}}\n",
        model.to_json().trim_end(),
        runs.join(",\n")
    )
}
