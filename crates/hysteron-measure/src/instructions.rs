//! Machine instructions for a sample, counted by callgrind: unlike times, they do not depend on
//! what else the machine does. Prints `docs/measured/instructions.md`. Needs valgrind:
//! `cargo run --release -p hysteron-measure -- instructions`
//!
//! With the name of a task it does that task once, for callgrind to count.

use crate::result::Result;
use hysteron::{AdaptOptions, Learner, Model, Operator, Plane, Sign, Target};
use rand::{RngExt, SeedableRng};
use std::hint::black_box;
use std::process::Command;

/// Samples that are counted. Half of them are done a second time without being counted, see
/// [`count`].
const SAMPLES: usize = 20_000;

/// What was counted for earlier releases: release, task, levels, input, instructions.
const EARLIER: &str = include_str!("text/instructions.csv");

const TASKS: [Task; 5] = [
    Task::new("run", "a sample of `Model::run`"),
    Task::new("step", "`Model::step`"),
    Task::new("inverse", "`Inverse::step`, exact inverse"),
    Task::new("increments", "`Adaptive::step`, increments"),
    Task::new("drift", "`Adaptive::step`, drift by least squares"),
];
const LEVELS: [usize; 2] = [20, 100];
const INPUTS: [&str; 2] = ["smooth", "random walk"];

struct Task {
    name: &'static str,
    what: &'static str,
}

impl Task {
    const fn new(name: &'static str, what: &'static str) -> Self {
        Self { name, what }
    }
}

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    match arguments {
        [] => page(),
        [task, levels, input, samples] => work(task, levels.parse()?, input, samples.parse()?),
        _ => Err("no arguments are needed".into()),
    }
}

fn page() -> Result<()> {
    print!("{}", include_str!("text/instructions.md"));
    let earlier: Vec<Vec<&str>> = EARLIER
        .lines()
        .map(|row| row.split(',').collect())
        .collect();
    let mut releases: Vec<&str> = earlier.iter().map(|row| row[0]).collect();
    releases.dedup();
    let own = env!("CARGO_PKG_VERSION");
    releases.retain(|release| *release != own);
    let columns: String = releases
        .iter()
        .map(|release| format!(" {release} |"))
        .collect();
    println!("| for a sample | K | input |{columns} {own} |");
    println!(
        "| --- | ---: | --- |{} ---: |",
        " ---: |".repeat(releases.len())
    );
    for Task { name, what } in TASKS {
        for levels in LEVELS {
            for input in INPUTS {
                let key = [name, &levels.to_string(), input];
                let of = |release: &&str| {
                    let row = earlier
                        .iter()
                        .find(|row| row[0] == *release && row[1..4] == key);
                    format!(" {} |", row.map_or("–", |row| row[4]))
                };
                let before: String = releases.iter().map(of).collect();
                let now = count(key)?;
                println!("| {what} | {levels} | {input} |{before} {now:.0} |");
                eprintln!("{own},{name},{levels},{input},{now:.0}");
            }
        }
    }
    Ok(())
}

/// Instructions for a sample: the difference of two counts, so that what is done once falls out.
fn count(key: [&str; 3]) -> Result<f64> {
    let [few, many] = [SAMPLES / 2, SAMPLES].map(|samples| -> Result<f64> {
        let done = Command::new("valgrind")
            .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
            .arg(std::env::current_exe()?)
            .arg("instructions")
            .args(key)
            .arg(samples.to_string())
            .output()
            .map_err(|error| format!("valgrind cannot be started: {error}"))?;
        let said = String::from_utf8_lossy(&done.stderr);
        let counted = said
            .lines()
            .find_map(|line| line.split_once("Collected : "));
        let Some((_, counted)) = counted else {
            return Err(format!("valgrind did not count: {said}").into());
        };
        Ok(counted.trim().parse()?)
    });
    Ok((many? - few?) / (SAMPLES - SAMPLES / 2) as f64)
}

fn work(task: &str, levels: usize, input: &str, samples: usize) -> Result<()> {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
    let plane = Plane::new(20.0, 80.0, levels)?;
    let weights = (0..plane.operators()).map(|_| rng.random()).collect();
    let model = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive)?;
    // All samples in every call, so that making them falls out of the difference.
    let mut at: f64 = 50.0;
    let mut next = |n: usize| match input {
        "smooth" => 50.0 + 28.0 * (n as f64 * 0.0126).sin(),
        _ => {
            at += rng.random_range(-3.0..3.0);
            if !(20.0..=80.0).contains(&at) {
                at = if at < 20.0 { 40.0 } else { 160.0 } - at;
            }
            at
        }
    };
    let inputs: Vec<f64> = (0..SAMPLES).map(&mut next).collect();
    let outputs = model.simulate(&inputs)?;
    let (inputs, outputs) = (&inputs[..samples], &outputs[..samples]);
    let mut state = model.start();
    match task {
        "run" => {
            let mut output = vec![0.0; samples];
            model.run(&mut state, black_box(inputs), &mut output)?;
            black_box(output);
        }
        "step" => {
            for &input in inputs {
                black_box(model.step(&mut state, black_box(input))?);
            }
        }
        "inverse" => {
            let inverse = model.inverse()?;
            for &output in outputs {
                black_box(inverse.step(&mut state, Target::new(black_box(output)))?);
            }
        }
        _ => {
            let learner = match task {
                "increments" => Learner::Increments,
                _ => Learner::Drift,
            };
            let options = AdaptOptions {
                learner,
                ..AdaptOptions::default()
            };
            let mut adaptive = options.adaptive(&model)?;
            for (&input, &output) in inputs.iter().zip(outputs) {
                black_box(adaptive.step(input, 0.9 * output)?);
            }
        }
    }
    Ok(())
}
