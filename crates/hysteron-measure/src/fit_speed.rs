//! How fast weights are identified, against SciPy's dense way in the same run, and how time and
//! memory grow: `cargo run --release -p hysteron-measure -- fit-speed`

use crate::result::Result;
use crate::scipy;
use hysteron::{Fit, FitOptions, Model, Operator, Plane, Recording, Sign};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::time::Instant;

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    if let [levels, samples] = arguments {
        return child(levels.parse()?, samples.parse()?);
    }
    print!("{}", include_str!("text/fit-speed.md"));
    println!(
        "Simulated material, first-order reversal curves and a walk between levels, noise of 1 %.\n"
    );
    println!(
        "| levels | samples | time of a fit | SciPy, dense: regressor + NNLS | ratio | difference \
         of squared errors |"
    );
    println!("| ---: | ---: | ---: | ---: | ---: | ---: |");
    for levels in [20, 40] {
        let recording = experiment(levels, 10_000)?;
        // The shortest of several runs: other load on the machine only adds time.
        let mut best = f64::INFINITY;
        let mut squares = 0.0;
        for _ in 0..7 {
            let start = Instant::now();
            let model = Fit::from(&options(levels)).run(&recording)?;
            best = best.min(start.elapsed().as_secs_f64());
            let rmse = model.fit.map_or(0.0, |fit| fit.rmse);
            squares = rmse * rmse * recording.len() as f64;
        }
        let plane = plane(levels)?;
        match scipy::run(&recording, plane, None)? {
            None => println!(
                "| {levels} | 10000 | {:.1} ms | not installed | | |",
                1e3 * best
            ),
            Some(found) => println!(
                "| {levels} | 10000 | {:.1} ms | {:.2} + {:.2} s | {:.0} | {:.1e} |",
                1e3 * best,
                found.seconds_regressor,
                found.seconds_fit,
                (found.seconds_regressor + found.seconds_fit) / best,
                (squares - found.squares).abs() / found.squares
            ),
        }
    }
    println!("\nEach in a process of its own; the memory is the process' highest.\n");
    println!(
        "| levels | operators | samples | time | memory | dense regressor | weights not zero |"
    );
    println!("| ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    let growth = [10_000, 100_000, 1_000_000, 10_000_000].map(|n| (20, n));
    let levels = [10, 20, 40, 60, 100, 150, 200].map(|k| (k, 100_000));
    for (levels, samples) in growth.into_iter().chain(levels).chain([(100, 1_000_000)]) {
        let output = std::process::Command::new(std::env::current_exe()?)
            .args(["fit-speed", &levels.to_string(), &samples.to_string()])
            .output()?;
        print!("{}", String::from_utf8(output.stdout)?);
        if !output.status.success() {
            return Err(String::from_utf8(output.stderr)?.into());
        }
    }
    Ok(())
}

fn child(levels: usize, samples: usize) -> Result<()> {
    let recording = experiment(levels, samples)?;
    let start = Instant::now();
    let model = Fit::from(&options(levels)).run(&recording)?;
    let time = start.elapsed().as_secs_f64();
    let operators = model.plane().operators();
    println!(
        "| {levels} | {operators} | {samples} | {time:.3} s | {} | {:.1} GiB | {} |",
        highest_memory().map_or("–".into(), |mebibytes| format!("{mebibytes:.0} MiB")),
        (8 * operators * samples) as f64 / f64::from(1 << 30),
        model.fit.map_or(0, |fit| fit.weights_not_zero),
    );
    Ok(())
}

fn options(levels: usize) -> FitOptions {
    FitOptions {
        levels,
        range: Some((20.0, 80.0)),
        // The minimum that SciPy looks for.
        ridge: 0.0,
        ..FitOptions::plain()
    }
}

fn plane(levels: usize) -> Result<Plane> {
    Ok(Plane::new(20.0, 80.0, levels)?)
}

/// A material with two hills of density, as SMA have, driven over the whole plane.
fn experiment(levels: usize, samples: usize) -> Result<Recording> {
    let plane = plane(levels)?;
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let k = levels as f64;
    let mut weights = Vec::new();
    for j in 1..=levels {
        for i in 1..=j {
            let hill = |a: f64, b: f64, width: f64| {
                let (u, v) = (i as f64 / k - a, j as f64 / k - b);
                (-(u * u + v * v) / (width * width)).exp()
            };
            let density = hill(0.3, 0.6, 0.1) + 0.4 * hill(0.5, 0.8, 0.07);
            weights.push(if density > 0.01 {
                density / (k * k)
            } else {
                0.0
            });
        }
    }
    let model = Model::new(Operator::Mkp, plane, weights, 1.0, Sign::Positive)?;
    let mut turns = vec![plane.bottom()];
    for level in 1..=levels {
        turns.extend([plane.level(level), plane.bottom()]);
    }
    for _ in 0..levels {
        turns.push(plane.level(rng.random_range(0..=levels)));
    }
    let travel: f64 = turns.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    let step = travel / samples as f64;
    let mut input = Vec::with_capacity(samples);
    let mut legs = turns.windows(2);
    let (mut at, mut leg) = (0.0, legs.next());
    while input.len() < samples {
        let Some(pair) = leg else {
            input.push(turns[turns.len() - 1]);
            continue;
        };
        let length = (pair[1] - pair[0]).abs();
        if at >= length {
            at -= length;
            leg = legs.next();
            continue;
        }
        input.push(pair[0] + at * (pair[1] - pair[0]).signum());
        at += step;
    }
    let mut output = model.simulate(&input)?;
    let (low, high) = model.output_range();
    for y in &mut output {
        let noise: f64 = StandardNormal.sample(&mut rng);
        *y += 0.01 * (high - low) * noise;
    }
    Ok(Recording::new(input, output)?)
}

/// The most memory this process has had, in MiB, where the system tells.
fn highest_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    let kibibytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes / 1024.0)
}
