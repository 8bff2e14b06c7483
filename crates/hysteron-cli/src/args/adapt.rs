//! Options of `adapt`.

use super::common::{Force, Json, Repair};
use super::value::*;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct Adapt {
    /// The model
    pub(crate) model: PathBuf,
    /// The recording to learn from
    pub(crate) data: PathBuf,
    /// Column of the input
    #[arg(long, value_name = "COL")]
    pub(crate) input: String,
    /// Column of the output
    #[arg(long, value_name = "COL")]
    pub(crate) output: String,
    /// Column of time, in seconds or with its unit in its name, for the table and for a model that
    /// depends on time
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
    /// State of the operators before the first sample; `unknown`: off or on, whichever gives the
    /// smaller error
    #[arg(long, value_enum, default_value = "off")]
    pub(crate) start: AdaptStart,
    /// What follows the error, and how
    #[arg(long, value_enum, default_value = "refit")]
    pub(crate) method: Learner,
    /// With `refit`, `drift` and `load`, for a model that depends on a load: the load to start at
    /// [default: the middle of its range]
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true, value_parser = parse_finite)]
    pub(crate) load: Option<f64>,
    #[command(flatten)]
    pub(crate) repair: Repair,
    #[command(flatten)]
    pub(crate) tuning: Tuning,
    /// How far the model may move before it needs --force: its offset in percent of its range, its
    /// stroke in percent, its operators in percent of the plane
    #[arg(long, value_name = "PERCENT", default_value = "100", value_parser = parse_positive)]
    pub(crate) max_drift: f64,
    /// Where the adapted model goes; with --force also one that ended worse than the model left
    /// alone, that moved further than --max-drift, or that saw a channel stand still
    #[arg(short, value_name = "ADAPTED")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Write the recording with the columns `output_model` (predicted before each sample was
    /// learned from), `error` and `outcome`, with `load` also `shift_model` and `load_model`; CSV, or
    /// Parquet or Arrow where the name ends with .parquet or .arrow
    #[arg(long, value_name = "TABLE")]
    pub(crate) table: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
#[command(next_help_heading = "Tuning")]
pub(crate) struct Tuning {
    /// refit: the samples to fit to, cycles:N for the last cycles of the input, samples:N for the
    /// last samples [default: cycles:1]
    #[arg(long, value_name = "WINDOW")]
    window: Option<hysteron::Window>,
    /// refit: samples between two refits [default: at each turning point of the input, and where an
    /// eighth of the window is new]
    #[arg(long, value_name = "N", value_parser = up_to::<u32>(u64::from(u32::MAX)))]
    every: Option<u32>,
    /// refit: how firmly weights stay where they are, relative to the window's matrix, above 0 and
    /// up to 1 [default: 0.1]
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = parse_finite)]
    ridge: Option<f64>,
    /// gradient, increments: share of a sample's error to remove, above 0 and below 2 [default:
    /// 0.3]
    #[arg(long, value_name = "G", allow_hyphen_values = true, value_parser = parse_finite)]
    gain: Option<f64>,
    /// increments: levels that the input travels between two updates [default: 1]
    #[arg(long, value_name = "LEVELS", allow_hyphen_values = true, value_parser = parse_finite)]
    span: Option<f64>,
    /// least-squares, drift: weight of a sample relative to the next one, above 0 and up to 1
    /// [default: 0.999, with drift 0.9999]
    #[arg(long, value_name = "F", allow_hyphen_values = true, value_parser = parse_finite)]
    forgetting: Option<f64>,
    /// least-squares, drift, load: standard deviation of a reading's error, model error included, in
    /// the output's unit [default: the noise found, and at least 2 %, with drift and load 5 %, of the
    /// range]
    #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = parse_finite)]
    noise: Option<f64>,
    /// least-squares, drift: standard deviation of a weight (in the output's unit) or a coefficient
    /// around the model's [default: such that the sum of the weights may deviate by 0.3 of the
    /// range; of a coefficient 0.5]; load: of the shift, in the input's unit [default: half of what
    /// it can reach]
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = parse_finite)]
    spread: Option<f64>,
    /// least-squares: correlation length of the deviations, in levels [default: 1]
    #[arg(long, value_name = "LEVELS", allow_hyphen_values = true, value_parser = parse_finite)]
    correlation: Option<f64>,
    /// Errors up to this are noise, in the output's unit [default: twice the noise found]
    #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = parse_finite)]
    dead_zone: Option<f64>,
    /// Share by which the weights go back to the model's with each update, 0 to 1 [default: 0]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = parse_finite)]
    leakage: Option<f64>,
    /// How freely the offset moves, relative to one weight or coefficient; with 0 it stays
    /// [default: gradient, increments: 0.2 times the root of the number of weights; otherwise such
    /// that the offset may deviate by 0.3 of the range]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = parse_finite)]
    offset_share: Option<f64>,
    /// Levels that the input has to move before the model learns again [default: 0.05]
    #[arg(long, value_name = "LEVELS", allow_hyphen_values = true, value_parser = parse_finite)]
    movement: Option<f64>,
    /// Samples after which the weights are compared with the last good ones [default: 256]
    #[arg(long, value_name = "N", value_parser = up_to::<u32>(u64::from(u32::MAX)))]
    trial: Option<u32>,
    /// Reject a reading whose error exceeds this many times the usual one, from 2; 0 rejects none, and
    /// takes no channel for stuck
    /// [default: 12]
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = parse_finite)]
    gate: Option<f64>,
    /// Consecutive readings beyond the gate that agree, after which they are believed: the plant
    /// has jumped [default: 8]
    #[arg(long, value_name = "N", value_parser = up_to::<u32>(u64::from(u32::MAX)))]
    burst: Option<u32>,
}

impl From<&Adapt> for hysteron::AdaptOptions {
    fn from(args: &Adapt) -> Self {
        let tuning = &args.tuning;
        Self {
            learner: args.method.into(),
            start: args.start.into(),
            load: args.load,
            window: tuning.window,
            every: tuning.every,
            ridge: tuning.ridge,
            gain: tuning.gain,
            span: tuning.span,
            forgetting: tuning.forgetting,
            noise: tuning.noise,
            spread: tuning.spread,
            correlation: tuning.correlation,
            dead_zone: tuning.dead_zone,
            leakage: tuning.leakage,
            offset_share: tuning.offset_share,
            movement: tuning.movement,
            trial: tuning.trial,
            gate: tuning.gate,
            burst: tuning.burst,
        }
    }
}
