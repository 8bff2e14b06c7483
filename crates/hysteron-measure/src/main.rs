//! The programs that print the pages of `docs/measured/`. One word chooses the program:
//! `cargo run --release -p hysteron-measure -- PROGRAM [ARGUMENTS]`

mod adaptation;
mod another_day;
mod batch_speed;
mod control;
mod coverage;
mod cycles;
mod faults;
mod fit_speed;
mod fleet_choice;
mod fleet_prior;
mod folder;
mod genuine;
mod instructions;
mod jitter;
mod judged;
mod leaderboard;
mod loads;
mod material;
mod median;
mod modules;
mod profiles;
mod recordings;
mod refit_speed;
mod result;
mod scipy;
mod simulate_speed;
mod stages;
mod wire;

use result::Result;
use std::process::ExitCode;

/// A program: its name, what it prints, and what runs it with the words behind its name.
type Program = (&'static str, &'static str, fn(&[String]) -> Result<()>);

const PROGRAMS: [Program; 19] = [
    (
        "adaptation",
        "FOLDER: models adapted over recordings",
        adaptation::run,
    ),
    (
        "batch-speed",
        "`BatchModel` beside `Model`",
        batch_speed::run,
    ),
    (
        "control",
        "controllers on the built-in scenarios",
        control::run,
    ),
    (
        "coverage",
        "FOLDER: how much of what was held out the band holds",
        coverage::run,
    ),
    (
        "faults",
        "faults of recordings and what they do",
        faults::run,
    ),
    (
        "fit-speed",
        "time and memory of a fit, beside SciPy",
        fit_speed::run,
    ),
    (
        "fleet-choice",
        "[COUNT [LEVELS]]: what it costs and gains that a fleet shares its choices",
        fleet_choice::run,
    ),
    (
        "fleet-prior",
        "what a fleet tells about the next actuator",
        fleet_prior::run,
    ),
    (
        "instructions",
        "instructions a sample, by callgrind",
        instructions::run,
    ),
    (
        "jitter",
        "COMMAND SECONDS: how fast `hysteron run` answers",
        jitter::run,
    ),
    (
        "leaderboard",
        "FOLDER: methods compared on held-out data",
        leaderboard::run,
    ),
    (
        "loads",
        "FOLDER: a load that was left out, predicted by each law",
        loads::run,
    ),
    (
        "modules",
        "the graphs of the modules, and their circles",
        modules::run,
    ),
    (
        "profiles",
        "designed experiments beside others",
        profiles::run,
    ),
    (
        "recordings",
        "FOLDER: a fit of each recording",
        recordings::run,
    ),
    (
        "refit-speed",
        "time of a sample of an adaptation",
        refit_speed::run,
    ),
    (
        "simulate-speed",
        "MODEL SAMPLES: time of a sample of `Model::run`",
        simulate_speed::run,
    ),
    ("stages", "FOLDER: what each stage gains", stages::run),
    ("wire", "a wire by each way to tune", wire::run),
];

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let chosen = words.split_first().and_then(|(word, rest)| {
        let program = PROGRAMS.iter().find(|(name, ..)| name == word)?;
        Some((program.2, rest))
    });
    let Some((run, rest)) = chosen else {
        eprintln!("name one of these programs:");
        for (name, what, _) in PROGRAMS {
            eprintln!("  {name:15} {what}");
        }
        return ExitCode::from(2);
    };
    match run(rest) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
