//! Machine instructions for a sample, counted by callgrind: unlike times, they do not depend on
//! what else the machine does. Prints `docs/measured/instructions.md`. Needs valgrind:
//! `cargo run --release -p hysteron-measure -- instructions`
//!
//! With the word `watch` it counts what the table holds for the build of the tests, and fails where
//! something costs more. With the name of a task it does that task, for callgrind to count.

use crate::result::Result;
use hysteron::{
    AdaptOptions, Around, Fit, FitOptions, Learner, Memory, Model, Operator, Plane, Recording,
    Sign, Simulate, TableReader, TableWriter, Target, simulate_table,
};
use rand::{RngExt, SeedableRng};
use std::fmt::Write as _;
use std::hint::black_box;
use std::process::Command;

/// What was counted before: build, task, levels, input, instructions. A build is a release, in the
/// release profile, or [`TESTS`].
const TABLE: &str = include_str!("text/instructions.csv");

/// The build of the tests, which is there wherever they ran. It is watched.
const TESTS: &str = "tests";

/// What a row of [`TESTS`] may grow by. There the compiler divides the library into units by their
/// size, and inlines within them: a change elsewhere moved `Model::step` by 11 %.
const GROWTH: f64 = 1.2;

/// As many samples are made for each count.
const SAMPLES: usize = 20_000;

/// The first of them are fitted.
const FITTED: usize = 500;

const BOTH: &[&str] = &["smooth", "random walk"];

const TASKS: [Task; 7] = [
    Task::new("run", "a sample of `Model::run`", (10_000, 20_000)),
    Task::new("step", "`Model::step`", (10_000, 20_000)),
    Task::new(
        "inverse",
        "`Inverse::step`, exact inverse",
        (10_000, 20_000),
    ),
    Task::new("increments", "`Adaptive::step`, increments", (2_000, 4_000)),
    Task::new(
        "drift",
        "`Adaptive::step`, drift by least squares",
        (1_000, 2_000),
    ),
    Task {
        inputs: &["smooth"],
        ..Task::new(
            "row",
            "a row of CSV, simulated and written",
            (10_000, 20_000),
        )
    },
    Task {
        levels: &[20],
        inputs: &["random walk"],
        ..Task::new(
            "fit",
            "a fit of 500 samples, nothing left to the data",
            (1, 2),
        )
    },
];

/// Something that is done many times.
struct Task {
    name: &'static str,
    what: &'static str,
    /// It is counted so many times and so many times: what is done once falls out.
    times: (usize, usize),
    levels: &'static [usize],
    inputs: &'static [&'static str],
}

impl Task {
    const fn new(name: &'static str, what: &'static str, times: (usize, usize)) -> Self {
        Self {
            name,
            what,
            times,
            levels: &[20, 100],
            inputs: BOTH,
        }
    }

    /// Instructions for doing it once.
    fn count(&self, levels: &str, input: &str) -> Result<f64> {
        let (few, many) = self.times;
        let all = |times: usize| counted([self.name, levels, input, &times.to_string()]);
        Ok((all(many)? - all(few)?) / (many - few) as f64)
    }
}

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    match arguments {
        [] => page(),
        [word] if word == "watch" => watch(),
        [task, levels, input, times] => work(task, levels.parse()?, input, times.parse()?),
        _ => Err("no arguments, or `watch`".into()),
    }
}

/// The rows of the table: build, task, levels, input, instructions.
fn rows() -> Result<Vec<[&'static str; 5]>> {
    let lines = TABLE.lines().filter(|line| !line.starts_with('#'));
    let row = |line: &'static str| {
        let cells: Vec<&str> = line.split(',').collect();
        let row = cells.try_into();
        row.map_err(|_| format!("text/instructions.csv: five cells, not `{line}`").into())
    };
    lines.map(row).collect()
}

fn page() -> Result<()> {
    print!("{}", include_str!("text/instructions.md"));
    let own = env!("CARGO_PKG_VERSION");
    let rows = rows()?;
    let mut builds: Vec<&str> = rows.iter().map(|[build, ..]| *build).collect();
    builds.dedup();
    builds.retain(|build| *build != own);
    let columns: String = builds.iter().map(|build| format!(" {build} |")).collect();
    println!("| for each | K | input |{columns} {own} |");
    println!(
        "| --- | ---: | --- |{} ---: |",
        " ---: |".repeat(builds.len())
    );
    for task in TASKS {
        for levels in task.levels {
            for input in task.inputs {
                let (name, levels) = (task.name, levels.to_string());
                let of = |wanted: &&str| {
                    let row = rows.iter().find(|[build, rest @ .., _]| {
                        build == wanted && *rest == [name, levels.as_str(), input]
                    });
                    format!(" {} |", row.map_or("–", |row| row[4]))
                };
                let before: String = builds.iter().map(of).collect();
                let now = task.count(&levels, input)?;
                println!("| {} | {levels} | {input} |{before} {now:.0} |", task.what);
                eprintln!("{own},{name},{levels},{input},{now:.0}");
            }
        }
    }
    Ok(())
}

/// Counts each row of the build of the tests anew, with the program that runs.
fn watch() -> Result<()> {
    if !cfg!(debug_assertions) {
        return Err("the rows are of the build of the tests: leave out `--release`".into());
    }
    let mut grown = Vec::new();
    let mut rows = rows()?;
    rows.retain(|[build, ..]| *build == TESTS);
    if rows.is_empty() {
        return Err("text/instructions.csv has no row to watch".into());
    }
    for [_, name, levels, input, before] in rows {
        let task = TASKS.iter().find(|task| task.name == name);
        let task = task.ok_or_else(|| format!("text/instructions.csv: no task `{name}`"))?;
        let (now, before) = (task.count(levels, input)?, before.parse::<f64>()?);
        println!("{TESTS},{name},{levels},{input},{now:.0}");
        if now > GROWTH * before {
            let by = 100.0 * (now / before - 1.0);
            grown.push(format!(
                "{} (K = {levels}, {input}): {now:.0} instructions, {by:.0} % above {before:.0}",
                task.what
            ));
        }
    }
    if grown.is_empty() {
        return Ok(());
    }
    Err(format!(
        "{}\nprofile it, or write the rows above into text/instructions.csv with the reason",
        grown.join("\n")
    )
    .into())
}

/// Instructions of this program with these words.
fn counted(words: [&str; 4]) -> Result<f64> {
    let done = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe()?)
        .arg("instructions")
        .args(words)
        // Threads that wait for work spin, as long as it pleases the machine.
        .env("RAYON_NUM_THREADS", "1")
        .output()
        .map_err(|error| format!("valgrind cannot be started: {error}"))?;
    let said = String::from_utf8_lossy(&done.stderr);
    let counted = said
        .lines()
        .find_map(|line| line.split_once("Collected : "));
    match counted {
        Some((_, counted)) if done.status.success() => Ok(counted.trim().parse()?),
        _ => Err(format!("valgrind did not count: {said}").into()),
    }
}

fn work(task: &str, levels: usize, input: &str, times: usize) -> Result<()> {
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
    let mut text = "input\n".to_owned();
    let mut ends = vec![text.len()];
    for input in &inputs {
        writeln!(text, "{input:.6}")?;
        ends.push(text.len());
    }
    let swings = Recording::new(inputs[..FITTED].to_vec(), outputs[..FITTED].to_vec())?;
    let (inputs, outputs) = (&inputs[..times], &outputs[..times]);
    let mut state = model.start();
    match task {
        "run" => {
            let mut output = vec![0.0; times];
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
        "row" => {
            let account = Memory::new(1 << 30);
            let mut table =
                TableReader::from_bytes("in.csv", text[..ends[times]].to_owned(), account.clone())?;
            let what = Simulate {
                input: "input",
                around: Around::default(),
                rest: None,
                band: None,
            };
            let out = TableWriter::in_memory("out.csv", &account)?;
            simulate_table(&model, state, &mut table, what, Some(out), |_| {})?;
        }
        "fit" => {
            let options = FitOptions {
                levels,
                ..FitOptions::plain()
            };
            let fit = Fit::from(options);
            for _ in 0..times {
                black_box(fit.run(&swings)?);
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
