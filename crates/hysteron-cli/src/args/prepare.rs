//! Options of `prepare`, and of a preparation before something else.

use super::common::{Force, Json, Repair};
use super::value::*;
use clap::Args;
use hysteron::Step;
use std::path::PathBuf;

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
    /// Column of time, in seconds or with its unit in its name
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
    #[command(flatten)]
    pub(crate) repair: Repair,
    /// Where the prepared recording goes
    #[arg(short, value_name = "OUT")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
    #[command(flatten)]
    pub(crate) steps: Steps,
    /// Undo the lag of the input's sensor: `auto` (right only for a material that does not depend
    /// on rate), `off` or its time constant in s [default: off]
    #[arg(long = "sensor-lag", alias = "lag", help_heading = "Preparation", value_name = "STEP", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) sensor_lag: Option<Step>,
}

/// A preparation before something else.
#[derive(Args)]
#[command(next_help_heading = "Preparation")]
pub(crate) struct PrepareFirst {
    /// Prepare the recording as `hysteron prepare` does; without it, only the steps that are named
    #[arg(long)]
    pub(crate) prepare: bool,
    #[command(flatten)]
    pub(crate) steps: Steps,
    /// Undo the lag of the input's sensor: `auto` (right only for a material that does not depend
    /// on rate), `off` or its time constant in s [default: off]
    #[arg(long = "sensor-lag", help_heading = "Preparation", value_name = "STEP", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) sensor_lag: Option<Step>,
}

#[derive(Args)]
#[command(next_help_heading = "Preparation")]
pub(crate) struct Steps {
    /// Restore the signs of readings just below zero that lost them: `on` or `off`. It turns good
    /// readings over where none was lost [default: off]
    #[arg(long, value_enum, value_name = "STEP")]
    pub(crate) signs: Option<OnOff>,
    /// Replace spikes: `auto`, `off`, or how many median absolute deviations make a spike
    #[arg(long, value_name = "STEP", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) spikes: Option<Step>,
    /// Equal steps of time: `auto` (where time is irregular and a filter needs it), `off`, or the
    /// step in s
    #[arg(long, value_name = "STEP", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) resample: Option<Step>,
    /// Zero-phase low-pass: `auto` (as far as the noise goes), `off`, or the cut-off in Hz, without
    /// time in cycles a sample
    #[arg(long, value_name = "STEP", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) low_pass: Option<Step>,
    /// Remove reversals of the input up to a dead band: `auto` (as far as the noise reaches),
    /// `off`, or the dead band in the input's unit
    #[arg(long, value_name = "STEP", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) dead_band: Option<Step>,
    /// Prepare also a recording that cannot be believed: with a frozen channel, rows that come
    /// twice, or rows that disagree with the others
    #[arg(long)]
    pub(crate) believe: bool,
}
