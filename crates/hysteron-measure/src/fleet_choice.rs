//! What it costs and what it gains that a fleet shares its choices, on **simulated** actuators.
//! Prints the tables of `docs/fleet.md`:
//! `cargo run --release -p hysteron-measure -- fleet-choice [COUNT [LEVELS]]`

use crate::material::{FINE, RANGE, bell};
use crate::result::Result;
use hysteron::{
    Columns, Destination, Fit, FleetChoice, FleetFitted, FleetOptions, Model, Operator, Plane,
    Progress, Sign, fit_fleet, read_fleet,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Samples of a recording.
const SAMPLES: usize = 500;
/// Harm to an actuator is an error of so many times that of its own choice.
const HARM: f64 = 1.3;

/// A kind of actuators: means of its random constants, and how it is recorded.
#[derive(Clone, Copy)]
struct Kind {
    /// Middle and half width of the loop, and the spread of either, in the input's unit.
    middle: f64,
    half: f64,
    spread: f64,
    width: f64,
    /// Standard deviation of the noise, as a share of the stroke.
    noise: f64,
    /// Swings of a recording.
    swings: f64,
    /// Whether a recording begins in the middle of a loop.
    begins_inside: bool,
}

/// A wire: a broad loop, ten swings, from below.
const WIRE: Kind = Kind {
    middle: 55.0,
    half: 8.0,
    spread: 5.0,
    width: 2.5,
    noise: 0.002,
    swings: 10.0,
    begins_inside: false,
};

/// A stack: a slim loop that is measured well, four swings, from its middle.
const STACK: Kind = Kind {
    middle: 52.0,
    half: 2.5,
    spread: 18.0,
    width: 1.2,
    noise: 0.0003,
    swings: 4.0,
    begins_inside: true,
};

/// A snap: it switches within a few degrees.
const SNAP: Kind = Kind {
    middle: 60.0,
    half: 12.0,
    spread: 1.0,
    width: 0.8,
    noise: 0.001,
    swings: 7.0,
    begins_inside: false,
};

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let count = arguments.first().map_or(Ok(100), |text| text.parse())?;
    let levels = arguments.get(1).map(|text| text.parse()).transpose()?;
    let fit = levels.map_or(Fit::new(), |levels: usize| Fit::new().levels(levels));
    let fleets: [(&str, &dyn Fn(usize) -> Kind); 4] = [
        ("wires", &|_| WIRE),
        ("stacks", &|_| STACK),
        ("wires and stacks, in turn", &|n| {
            if n % 2 == 0 { WIRE } else { STACK }
        }),
        ("wires, one snap in twenty", &|n| {
            if n % 20 == 7 { SNAP } else { WIRE }
        }),
    ];
    let folder = std::env::temp_dir().join(format!("hysteron-fleet-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    println!(
        "| Fleet | Choice | Kinds | Pilots | Time of an actuator | with the bootstrap | \
         Left out: median | worst | Above {HARM} times its own | By themselves |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (name, kind) in fleets {
        let table = folder.join("fleet.csv");
        std::fs::write(&table, recorded(count, kind)?)?;
        let each = measured(&table, FleetChoice::Each, &fit)?;
        let pilots = measured(&table, FleetChoice::Pilots, &fit)?;
        for (word, found) in [("each", &each), ("pilots", &pilots)] {
            let harmed = found.errors.iter();
            let harmed = harmed.filter(|(id, error)| **error > HARM * each.errors[*id]);
            let ids: Vec<&String> = harmed.map(|(id, _)| id).collect();
            let mut errors: Vec<f64> = found.errors.values().copied().collect();
            errors.sort_by(f64::total_cmp);
            let shared = found.result.shared.as_ref();
            println!(
                "| {name} | {word} | {} | {} | {:.1} ms | {:.1} ms | {:.3} % | {:.3} % | {} | {} |",
                shared.map_or(0, |shared| shared.kinds.len()),
                shared.map_or(0, |shared| shared.pilots),
                1e3 * found.seconds / count as f64,
                1e3 * found.with_bootstrap / count as f64,
                errors[errors.len() / 2],
                errors[errors.len() - 1],
                ids.len(),
                found.result.alone.len(),
            );
            if let Some(shared) = shared {
                eprintln!("{shared}\n{:#?}", shared.kinds);
            }
            for alone in &found.result.alone {
                eprintln!("{alone}");
            }
            for id in ids {
                let ratio = found.errors[id] / each.errors[id];
                eprintln!("harmed: {id}: {ratio:.2} of {:.4}", each.errors[id]);
            }
        }
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

/// A fleet that was fitted.
struct Measured {
    /// Of each actuator, on what was left out, in percent.
    errors: BTreeMap<String, f64>,
    seconds: f64,
    with_bootstrap: f64,
    result: FleetFitted,
}

fn measured(table: &Path, choice: FleetChoice, fit: &Fit<'static>) -> Result<Measured> {
    let target = table.with_extension("parquet");
    let once = |fit: Fit<'static>| -> Result<(FleetFitted, f64)> {
        let options = FleetOptions {
            by: Some("id"),
            choice,
            ..FleetOptions::new(Columns::new("x", "y"), fit)
        };
        let begin = Instant::now();
        let data = [PathBuf::from(table)];
        let to = Destination::from(target.as_path());
        let found = fit_fleet(&data, &options, to, Progress::NONE)?;
        let took = begin.elapsed().as_secs_f64();
        Ok((found, took))
    };
    let (_, with_bootstrap) = match std::env::var_os("NO_BOOTSTRAP") {
        None => once(fit.clone())?,
        Some(_) => (FleetFitted::default(), f64::NAN),
    };
    let _ = std::fs::remove_file(&target);
    let (result, seconds) = once(fit.clone().bootstrap(0))?;
    let mut errors = BTreeMap::new();
    read_fleet(&target, |row| {
        let fit = row.model.fit.as_ref();
        let tested = fit.and_then(|fit| fit.validation.as_ref());
        errors.insert(
            row.id,
            tested.map_or(f64::NAN, |tested| tested.nrmse_percent),
        );
        Ok(true)
    })?;
    std::fs::remove_file(&target)?;
    Ok(Measured {
        errors,
        seconds,
        with_bootstrap,
        result,
    })
}

/// The recordings of a fleet as one table.
fn recorded(count: usize, kind: impl Fn(usize) -> Kind) -> Result<String> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut text = "id,x,y\n".to_owned();
    for n in 0..count {
        let (input, output) = record(&kind(n), &mut rng)?;
        for (x, y) in input.iter().zip(output) {
            writeln!(text, "A{n:05},{x:.4},{y:.5}")?;
        }
    }
    Ok(text)
}

/// A material of random constants, recorded.
fn record(kind: &Kind, rng: &mut ChaCha8Rng) -> Result<(Vec<f64>, Vec<f64>)> {
    let mut near = |mean: f64, deviation: f64| -> f64 {
        let normal: f64 = StandardNormal.sample(&mut *rng);
        mean * (1.0 + deviation * normal).max(0.3)
    };
    let (middle, half) = (near(kind.middle, 0.05), near(kind.half, 0.15));
    let (spread, width) = (near(kind.spread, 0.12), near(kind.width, 0.15));
    let (stroke, offset) = (near(10.0, 0.08), near(2.0, 0.1));
    let plane = Plane::new(RANGE.0, RANGE.1, FINE)?;
    let weights = bell((middle, spread), (half, width), stroke);
    let material = Model::new(Operator::Mkp, plane, weights, offset, Sign::Positive)?;
    let begin = if kind.begins_inside { 0.35 } else { 0.0 };
    let input: Vec<f64> = (0..SAMPLES)
        .map(|n| {
            path(
                kind.swings * (begin / kind.swings + n as f64 / SAMPLES as f64),
                kind.swings,
            )
        })
        .collect();
    let mut before = vec![RANGE.0 + 2.0];
    before.extend(&input);
    let mut output = material.simulate(&before)?.split_off(1);
    for y in &mut output {
        let normal: f64 = StandardNormal.sample(&mut *rng);
        *y += kind.noise * 10.0 * normal;
    }
    Ok((input, output))
}

/// Swings between the ends of the range, each a little smaller.
fn path(swing: f64, swings: f64) -> f64 {
    let shrunk = 1.0 - 0.8 * swing.floor() / swings;
    let triangle = 1.0 - (2.0 * (swing - swing.floor()) - 1.0).abs();
    RANGE.0 + 2.0 + (RANGE.1 - RANGE.0 - 4.0) * (triangle * shrunk + 0.4 * (1.0 - shrunk))
}
