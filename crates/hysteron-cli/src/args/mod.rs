//! The command line: its forms, defaults and help.

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

mod adapt;
mod common;
mod export;
mod fit;
mod fit_how;
mod fleet;
mod prepare;
mod shell;
mod studio;
mod value;

pub(crate) use adapt::*;
pub(crate) use common::*;
pub(crate) use export::*;
pub(crate) use fit::*;
pub(crate) use fit_how::*;
pub(crate) use fleet::*;
pub(crate) use prepare::*;
pub(crate) use shell::*;
pub(crate) use studio::*;
pub(crate) use value::*;

/// Hysteresis models of actuators: from a recording to a model and its exact inverse.
#[derive(Parser)]
#[command(
    name = "hysteron",
    version,
    arg_required_else_help = true,
    after_help = "Recordings are tables with named columns: CSV (commas, semicolons or tabs;\n\
                  decimal points or commas; a row of units; # and % comments; loggers and\n\
                  LabVIEW), Parquet, Arrow, or MATLAB files (v5, v7, v7.3).\n\
                  A column goes by its name, without its unit if there is no other, or by its\n\
                  number from 1.\n\
                  `-` reads CSV from standard input.\n\
                  Results of earlier runs are replaced; any other file is kept, unless --force\n\
                  is given.\n\
                  Exit codes: 0 done, 1 the work failed, 2 wrong usage."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Identify a model from a recording
    #[command(after_help = "Example:\n\
        \x20 hysteron fit run1.csv --input temperature --output displacement \
        -o spring.json")]
    Fit(Box<Fit>),
    /// Fit a model to each of many actuators, and compare them
    #[command(subcommand)]
    Fleet(Fleet),
    /// Prepare a recording for a fit: spikes, noise, a sensor's lag, false reversals
    #[command(after_help = "Example:\n\
        \x20 hysteron prepare run1.csv --input temperature --output displacement \
        --time time -o clean.csv")]
    Prepare(Prepare),
    /// Run a model over an input: adds the column `output_model`
    #[command(after_help = "Example:\n\
        \x20 hysteron simulate spring.json run2.csv --input temperature -o modelled.csv")]
    Simulate(Simulate),
    /// Find the input for a wanted output: adds the columns `input_model` (the drive, for a model
    /// with a thermal body) and `status` (ok, low, high, passed, limited); `output_low` and
    /// `output_high`, where the output may really be, if the model knows how far it errs
    #[command(after_help = "Example:\n\
        \x20 hysteron invert spring.json wanted.csv --target displacement -o inputs.csv")]
    Invert(Invert),
    /// Judge a model on a recording: forward and inverse errors, and a report
    #[command(after_help = "Example:\n\
        \x20 hysteron evaluate spring.json run2.csv --input temperature \
        --output displacement --report report")]
    Evaluate(Evaluate),
    /// Put models beside each other on recordings: errors, and a report of their residuals
    #[command(after_help = "Example:\n\
        \x20 hysteron compare few.json many.json run2.csv --input temperature \
        --output displacement --report compared")]
    Compare(Compare),
    /// Let a model learn from a recording, sample by sample, and write the adapted one
    #[command(after_help = "Example:\n\
        \x20 hysteron adapt spring.json run3.csv --input temperature \
        --output displacement -o adapted.json")]
    Adapt(Adapt),
    /// Show what is in a recording or a model: ranges, reversals, gaps, operators excited
    #[command(after_help = "Examples:\n\
        \x20 hysteron inspect run1.csv --input temperature --output displacement\n\
        \x20 hysteron inspect spring.json")]
    Inspect(Inspect),
    /// Plan a recording: the input profile that determines every operator in the shortest time
    #[command(after_help = "Examples:\n\
        \x20 hysteron design --range 20,80 --levels 20 --heating-rate 2 \
        --cooling-rate 0.5 -o profile.csv\n\
        \x20 hysteron design --range 20,80 --levels 20 --heating-rate 2 \
        --cooling-rate 0.5 --from run1.csv --input temperature -o next.csv")]
    Design(Design),
    /// Compare controllers on a simulated plant: PID, inverse, both, and an inverse that adapts
    #[command(after_help = "Examples:\n\
        \x20 hysteron track load-step -o load-step\n\
        \x20 hysteron track load-step --show > mine.toml\n\
        \x20 hysteron track mine.toml --seeds 5 -o mine")]
    Track(Track),
    /// Run a profile or a controller on a device: a serial line, a program on a pipe, a socket
    #[command(after_help = "Example:\n\
        \x20 hysteron run bench.toml -o run.csv\n\n\
        Exit codes: 0 all was run; 1 it could not begin, or the controller failed; 2 wrong usage;\n\
        3 no valid reading for lost_s; 4 the output was stuck; 5 the output was beyond its limits,\n\
        or far beyond what the model reaches;\n\
        6 the device ended; 7 the line is gone; 8 the log cannot be written; 130 stopped.\n\
        Whatever ends a run, the drive is safe and the log is whole.")]
    Run(Run),
    /// Export a model: C for a microcontroller, a block for Simulink and other tools
    #[command(subcommand)]
    Export(Export),
    /// Show the main task on a simulated NiTi spring: record, fit, validate forward and inverse,
    /// report
    #[command(after_help = "Example:\n  hysteron demo -o demo")]
    Demo(Demo),
    /// Begin with a recording: what is in it, which columns are meant, a first fit, and the
    /// commands to go on with
    #[command(after_help = "Example:\n  hysteron start run1.csv")]
    Start(Begin),
    /// Open a local page to look at recordings, fit, drive models by hand and take them home
    #[cfg(feature = "studio")]
    #[command(after_help = "Examples:\n\
        \x20 hysteron studio\n\
        \x20 hysteron studio run1.csv run2.csv\n\
        \x20 hysteron studio --no-open --port 8123 run1.csv")]
    Studio(Studio),
    /// Print a script with which a shell completes commands and options
    #[command(after_help = "Examples:\n\
        \x20 hysteron completions bash > ~/.local/share/bash-completion/completions/hysteron\n\
        \x20 hysteron completions zsh > ~/.zfunc/_hysteron\n\
        \x20 hysteron completions fish > ~/.config/fish/completions/hysteron.fish")]
    Completions(Completions),
    /// Write manual pages, one for each command
    #[command(after_help = "Example:\n\
        \x20 hysteron man -o ~/.local/share/man/man1")]
    Man(Man),
}

#[derive(Args)]
pub(crate) struct Simulate {
    /// The model
    pub(crate) model: PathBuf,
    /// A table with the input
    pub(crate) data: PathBuf,
    /// Column of the input [default: the model's, by its name]
    #[arg(long, value_name = "COL")]
    pub(crate) input: Option<String>,
    #[command(flatten)]
    pub(crate) load: Load,
    /// Add the columns `output_low` and `output_high`, the 95 % prediction band of a model fitted
    /// with --bootstrap
    #[arg(long)]
    pub(crate) band: bool,
    /// Column of time, in seconds or with its unit in its name, for a model that depends on
    /// time, and for --repair
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
    /// State of the operators before the first row
    #[arg(long, value_enum, default_value = "fitted")]
    pub(crate) start: RunStart,
    /// Input long before the first row, at which all was at rest [default: that of the first row]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = parse_finite)]
    pub(crate) rest: Option<f64>,
    /// Where the table goes: *.parquet or *.arrow with the types of a source of the same kind,
    /// otherwise CSV [default: standard output; with --json nowhere]
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) repair: Rows,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct Invert {
    /// The model
    pub(crate) model: PathBuf,
    /// A table with the wanted output
    pub(crate) data: PathBuf,
    /// Column of the wanted output [default: the model's output, by its name]
    #[arg(long, value_name = "COL")]
    pub(crate) target: Option<String>,
    /// What the input does while the target stands still
    #[arg(long, value_enum, default_value = "hold")]
    pub(crate) policy: Policy,
    /// Reversals of the target up to this size are noise and not followed, in its unit
    /// [default: 0 with `hold`, 1 % of the model's range with `anticipate`]
    #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = parse_tolerance)]
    pub(crate) tolerance: Option<f64>,
    /// With `anticipate`: rows to look ahead for the next reversal [default: 65536]
    #[arg(long, value_name = "N", value_parser = up_to::<usize>(u64::from(u32::MAX)))]
    pub(crate) look_ahead: Option<usize>,
    #[command(flatten)]
    pub(crate) load: Load,
    /// Column of time, in seconds or with its unit in its name, for a model that depends on
    /// time, and for --repair
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
    /// State of the operators before the first row
    #[arg(long, value_enum, default_value = "fitted")]
    pub(crate) start: RunStart,
    /// Lowest and highest drive, or input of a model without a thermal body [default: for a thermal
    /// body the drives it was fitted with, otherwise no limits]
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_limits, allow_hyphen_values = true)]
    pub(crate) drive_range: Option<(f64, f64)>,
    /// With a thermal body: reach a temperature in this time instead of one row, so that noise of
    /// the target does not send the drive from one end to the other
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_hyphen_values = true, value_parser = parse_tolerance)]
    pub(crate) horizon: f64,
    /// With a thermal body: how long before a target the drive may start for it, 0 for a reference
    /// that is not known ahead [default: twice the longer time constant]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = parse_tolerance)]
    pub(crate) preview: Option<f64>,
    /// Where the table goes: *.parquet or *.arrow with the types of a source of the same kind,
    /// otherwise CSV [default: standard output; with --json nowhere]
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) repair: Rows,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct Evaluate {
    /// The model
    pub(crate) model: PathBuf,
    /// The recording
    pub(crate) data: PathBuf,
    #[command(flatten)]
    pub(crate) columns: Columns,
    /// State of the operators before the first sample
    #[arg(long, value_enum, default_value = "fitted")]
    pub(crate) start: Start,
    #[command(flatten)]
    pub(crate) load: Load,
    #[command(flatten)]
    pub(crate) repair: Repair,
    /// Write a page and its figures (SVG, PNG) into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
    #[command(flatten)]
    pub(crate) prepare: PrepareFirst,
}

#[derive(Args)]
pub(crate) struct Compare {
    /// Models (*.json) and recordings, in any order
    #[arg(required = true, num_args = 2.., value_name = "MODEL|DATA")]
    pub(crate) files: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) columns: Columns,
    /// State of the operators before the first sample
    #[arg(long, value_enum, default_value = "fitted")]
    pub(crate) start: Start,
    #[command(flatten)]
    pub(crate) load: Load,
    #[command(flatten)]
    pub(crate) repair: Repair,
    /// Write a page of the residuals over time, over the input and as histograms into this folder;
    /// for several recordings a folder for each
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
    #[command(flatten)]
    pub(crate) prepare: PrepareFirst,
}

#[derive(Args)]
pub(crate) struct Inspect {
    /// A recording, or a model (*.json)
    pub(crate) file: PathBuf,
    /// Column of the input
    #[arg(long, value_name = "COL", requires = "output")]
    pub(crate) input: Option<String>,
    /// Column of the output
    #[arg(long, value_name = "COL", requires = "input")]
    pub(crate) output: Option<String>,
    /// Column of time, in seconds or with its unit in its name
    #[arg(long, value_name = "COL", requires = "input")]
    pub(crate) time: Option<String>,
    #[command(flatten)]
    pub(crate) repair: Repair,
    /// Levels of the plane on which excited operators are counted
    #[arg(long, default_value_t = 20, value_parser = parse_levels)]
    pub(crate) levels: usize,
    /// Its lowest and highest level [default: so that the active range is that of the input]
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_range, allow_hyphen_values = true)]
    pub(crate) range: Option<(f64, f64)>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct Design {
    /// Range in which the profile stays: it starts at the lowest input, and the plane's lowest level
    /// is one step above
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_range, allow_hyphen_values = true,
          required_unless_present = "model")]
    pub(crate) range: Option<(f64, f64)>,
    /// A model with a thermal body: the profile is of drives, which stay in the range [default: of
    /// the drives fitted], and its temperature follows the ramps
    #[arg(long, value_name = "MODEL", conflicts_with = "from")]
    pub(crate) model: Option<PathBuf>,
    /// Number of levels K of the plane; it has K(K+1)/2 operators
    #[arg(long, value_parser = parse_levels)]
    pub(crate) levels: usize,
    /// How fast the input can rise, in its unit per second
    #[arg(long, value_name = "R", value_parser = parse_positive, allow_hyphen_values = true,
          required_unless_present = "model", requires = "cooling_rate")]
    pub(crate) heating_rate: Option<f64>,
    /// How fast it can fall
    #[arg(long, value_name = "R", value_parser = parse_positive, allow_hyphen_values = true,
          required_unless_present = "model", requires = "heating_rate")]
    pub(crate) cooling_rate: Option<f64>,
    /// Longest duration: as many loops as fit, evenly spread [default: as long as needed]
    #[arg(long, value_name = "MINUTES", value_parser = parse_positive, allow_hyphen_values = true)]
    pub(crate) budget: Option<f64>,
    /// A recording that exists, repeatable: what it determines is left out
    #[arg(long, value_name = "RECORDING", requires = "input")]
    pub(crate) from: Vec<PathBuf>,
    /// Column of the input in the recordings
    #[arg(long, value_name = "COL")]
    pub(crate) input: Option<String>,
    /// Longest time between samples [default: ten samples a level]
    #[arg(long, value_name = "SECONDS", value_parser = parse_positive, allow_hyphen_values = true)]
    pub(crate) step: Option<f64>,
    /// Elementary operator
    #[arg(long, value_enum, default_value = "mkp")]
    pub(crate) operator: Operator,
    /// Where the profile goes, with the columns `time [s]` and `input`
    #[arg(short, long = "output", value_name = "PROFILE")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Draw the plane, with what the data determine of each operator
    #[arg(long, value_name = "SVG")]
    pub(crate) figure: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) memory: Memory,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct Track {
    /// A TOML file, or the name of a built-in scenario
    #[arg(required_unless_present = "list")]
    pub(crate) scenario: Option<String>,
    /// List the built-in scenarios
    #[arg(long)]
    pub(crate) list: bool,
    /// Print the text of a built-in scenario, to start your own from
    #[arg(long)]
    pub(crate) show: bool,
    /// Runs with different noise [default: what the scenario says]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) seeds: Option<u32>,
    /// Folder for report, scores, curves of the first run, and model
    #[arg(short, long = "output", value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct Run {
    /// The TOML file that says what to run
    pub(crate) config: PathBuf,
    /// Where the log goes (.csv or .parquet), in place of the file's `log`
    #[arg(short, long = "output", value_name = "LOG")]
    pub(crate) out: Option<PathBuf>,
    /// Say what would be sent, the limits and the checks, and send nothing
    #[arg(long)]
    pub(crate) dry_run: bool,
    /// Go on where the log ends: model, learner and numbers
    #[arg(long, conflicts_with = "force")]
    pub(crate) resume: bool,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct Demo {
    /// Folder for the recordings, the model and the report
    #[arg(
        short,
        long = "output",
        value_name = "DIR",
        default_value = "hysteron-demo"
    )]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
}
