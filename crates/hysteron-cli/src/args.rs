//! The command line: its forms, defaults and help.

use clap::{Args, Parser, Subcommand, ValueEnum};
use hysteron::Step;
use std::path::PathBuf;

/// Hysteresis models of actuators: from a recording to a model and its exact inverse.
#[derive(Parser)]
#[command(
    name = "hysteron",
    version,
    arg_required_else_help = true,
    after_help = "Recordings are tables with named columns: CSV (commas, semicolons or tabs; decimal points or commas;\n\
                  a row of units; # and % comments), Parquet, or MATLAB files (v5, v7, v7.3). `-` reads CSV from standard input.\n\
                  Exit codes: 0 done, 1 the work failed, 2 wrong usage."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Identify a model from a recording
    #[command(
        after_help = "Example:\n  hysteron fit run1.csv --input temperature --output displacement -o spring.json"
    )]
    Fit(Fit),
    /// Ready a recording for a fit: spikes, noise, a sensor's lag, false reversals
    #[command(
        after_help = "Example:\n  hysteron prepare run1.csv --input temperature --output displacement --time time -o clean.csv"
    )]
    Prepare(Prepare),
    /// Run a model over an input: adds the column `output_model`
    #[command(
        after_help = "Example:\n  hysteron simulate spring.json run2.csv --input temperature -o modelled.csv"
    )]
    Simulate(Simulate),
    /// Find the input for a wanted output: adds the columns `input_model` and `status` (ok, low, high)
    #[command(
        after_help = "Example:\n  hysteron invert spring.json wanted.csv --target displacement -o inputs.csv"
    )]
    Invert(Invert),
    /// Judge a model on a recording: forward and inverse errors, and a report
    #[command(
        after_help = "Example:\n  hysteron evaluate spring.json run2.csv --input temperature --output displacement --report report"
    )]
    Evaluate(Evaluate),
    /// Tell what is in a recording or a model: ranges, reversals, gaps, operators excited
    #[command(
        after_help = "Examples:\n  hysteron inspect run1.csv --input temperature --output displacement\n  hysteron inspect spring.json"
    )]
    Inspect(Inspect),
    /// The main job on a simulated NiTi spring: record, fit, validate forward and inverse, report
    #[command(after_help = "Example:\n  hysteron demo -o demo")]
    Demo(Demo),
}

#[derive(Args)]
pub(crate) struct Json {
    /// Print one JSON object on standard output, and nothing else there
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Repair {
    /// Drop rows without a number, sort times that go back, merge repeated ones, and tell of it
    #[arg(long)]
    repair: bool,
}

impl From<&Repair> for hysteron::Repair {
    fn from(args: &Repair) -> Self {
        match args.repair {
            true => Self::Mend,
            false => Self::Refuse,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Operator {
    /// Continuous, from 0 to 1
    Mkp,
    /// Continuous, from -1 to +1
    Kp,
    /// The classical Preisach relay, -1 or +1
    Relay,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Solver {
    /// Weights of zero and above: a monotone model, which has an inverse
    Nnls,
    /// Plain least squares: any weights, as a rule without an inverse
    Ols,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Policy {
    /// The input rests while the target rests
    Hold,
    /// The input crosses the dead band as soon as the target is known to reverse
    Anticipate,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Sign {
    /// The better one
    Auto,
    /// The output rises with the input
    Positive,
    /// The output falls as the input rises, as a strain recovered on heating does
    Negative,
}

#[derive(Args)]
pub(crate) struct Fit {
    /// The recording
    #[arg(required = true, value_name = "DATA")]
    pub(crate) data: Vec<PathBuf>,
    /// Column of the input
    #[arg(long, value_name = "COL")]
    pub(crate) input: String,
    /// Column of the output
    #[arg(long, value_name = "COL")]
    pub(crate) output: String,
    /// Number of levels K of the plane; it has K(K+1)/2 operators
    #[arg(long, default_value_t = 20, value_parser = parse_levels)]
    pub(crate) levels: usize,
    /// Lowest and highest level [default: so that the active range is that of the input]
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_range, allow_hyphen_values = true)]
    pub(crate) range: Option<(f64, f64)>,
    /// Elementary operator
    #[arg(long, value_enum, default_value = "mkp")]
    pub(crate) operator: Operator,
    /// How the weights are found
    #[arg(long, value_enum, default_value = "nnls")]
    pub(crate) solver: Solver,
    /// Direction of the output
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) sign: Sign,
    /// Output with every operator off [default: identified]
    #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = parse_finite)]
    pub(crate) offset: Option<f64>,
    /// Unit of the input [default: from a header like `temperature [degC]`]
    #[arg(long, value_name = "UNIT")]
    pub(crate) input_unit: Option<String>,
    /// Unit of the output
    #[arg(long, value_name = "UNIT")]
    pub(crate) output_unit: Option<String>,
    #[command(flatten)]
    pub(crate) repair: Repair,
    #[command(flatten)]
    pub(crate) prepare: PrepareBeforeFit,
    /// Where the model goes
    #[arg(short, value_name = "MODEL")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct Prepare {
    /// The recording
    pub(crate) data: PathBuf,
    /// Column of the input
    #[arg(long, value_name = "COL")]
    pub(crate) input: String,
    /// Column of the output
    #[arg(long, value_name = "COL")]
    pub(crate) output: String,
    /// Column of time in seconds
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
    #[command(flatten)]
    pub(crate) repair: Repair,
    #[command(flatten)]
    pub(crate) steps: Steps,
    /// Where the prepared recording goes
    #[arg(short, value_name = "OUT")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct PrepareBeforeFit {
    /// Column of time in seconds, for the preparation and the warning that loops depend on rate
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
    /// Prepare the recording as `hysteron prepare` does; without it, only the steps that are named
    #[arg(long)]
    pub(crate) prepare: bool,
    #[command(flatten)]
    pub(crate) steps: Steps,
}

#[derive(Args)]
#[command(next_help_heading = "Preparation")]
pub(crate) struct Steps {
    /// Give back lost signs and replace spikes: `auto`, `off`, or how many median absolute deviations make a spike
    #[arg(long, value_name = "STEP", value_parser = parse_step)]
    pub(crate) spikes: Option<Step>,
    /// Equal steps of time: `auto` (where time is irregular and a filter needs it), `off`, or the step in s
    #[arg(long, value_name = "STEP", value_parser = parse_step)]
    pub(crate) resample: Option<Step>,
    /// Zero-phase low-pass: `auto` (as far as the noise goes), `off`, or the cut-off in Hz, without time in cycles a sample
    #[arg(long, value_name = "STEP", value_parser = parse_step)]
    pub(crate) low_pass: Option<Step>,
    /// Undo the lag of the input's sensor: `auto` (right only for a material that does not depend on rate), `off` or its time constant in s [default: off]
    #[arg(long, value_name = "STEP", value_parser = parse_step)]
    pub(crate) lag: Option<Step>,
    /// Take away reversals of the input up to a dead band: `auto` (as far as the noise reaches), `off`, or the band in its unit
    #[arg(long, value_name = "STEP", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) band: Option<Step>,
}

#[derive(Args)]
pub(crate) struct Simulate {
    /// The model
    pub(crate) model: PathBuf,
    /// A table with the input
    pub(crate) data: PathBuf,
    /// Column of the input
    #[arg(long, value_name = "COL")]
    pub(crate) input: String,
    /// Where the table goes [default: standard output; with --json nowhere]
    #[arg(short, value_name = "OUT")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct Invert {
    /// The model
    pub(crate) model: PathBuf,
    /// A table with the wanted output
    pub(crate) data: PathBuf,
    /// Column of the wanted output
    #[arg(long, value_name = "COL")]
    pub(crate) target: String,
    /// What the input does while the target stands still
    #[arg(long, value_enum, default_value = "hold")]
    pub(crate) policy: Policy,
    /// Reversals of the target up to this size are noise and not followed, in its unit
    /// [default: 0 with `hold`, 1 % of the model's range with `anticipate`]
    #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = parse_band)]
    pub(crate) band: Option<f64>,
    /// With `anticipate`: rows to look ahead for the next reversal
    #[arg(long, value_name = "N", default_value_t = 65_536)]
    pub(crate) look_ahead: usize,
    /// Where the table goes [default: standard output; with --json nowhere]
    #[arg(short, value_name = "OUT")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct Evaluate {
    /// The model
    pub(crate) model: PathBuf,
    /// The recording
    pub(crate) data: PathBuf,
    /// Column of the input
    #[arg(long, value_name = "COL")]
    pub(crate) input: String,
    /// Column of the output
    #[arg(long, value_name = "COL")]
    pub(crate) output: String,
    /// Column of time in seconds, for the report's figures
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
    #[command(flatten)]
    pub(crate) repair: Repair,
    /// Write a page and its figures (SVG, PNG) into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) json: Json,
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
    /// Column of time in seconds
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
pub(crate) struct Demo {
    /// Folder for the recordings, the model and the report
    #[arg(short, value_name = "DIR", default_value = "hysteron-demo")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) json: Json,
}

fn parse_step(text: &str) -> Result<Step, String> {
    match text.trim() {
        "auto" => Ok(Step::Auto),
        "off" => Ok(Step::Off),
        number => match parse_finite(number) {
            Ok(value) if value >= 0.0 => Ok(Step::Value(value)),
            _ => Err("`auto`, `off` or a number from zero on is needed".into()),
        },
    }
}

fn parse_finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("`{text}` is not a finite number")),
    }
}

fn parse_band(text: &str) -> Result<f64, String> {
    let band = parse_finite(text)?;
    if band < 0.0 {
        return Err("it must not be below zero".into());
    }
    Ok(band)
}

fn parse_levels(text: &str) -> Result<usize, String> {
    let most = hysteron::MAX_LEVELS;
    match text.parse() {
        Ok(levels) if (2..=most).contains(&levels) => Ok(levels),
        _ => Err(format!("a plane has from 2 to {most} levels")),
    }
}

fn parse_range(text: &str) -> Result<(f64, f64), String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(parse_finite)
        .collect::<Result<_, _>>()?;
    match numbers[..] {
        [min, max] if min < max => Ok((min, max)),
        [_, _] => Err("the first number must be below the second".into()),
        _ => Err("two numbers with a comma between are needed, such as 20,80".into()),
    }
}
