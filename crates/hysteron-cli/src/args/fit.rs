//! Options of `fit` and `prepare`.

use super::common::{Force, Json, Repair};
use super::value::*;
use clap::Args;
use hysteron::Step;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct Fit {
    /// The recording; several are one experiment, each from its own initial state
    #[arg(required = true, value_name = "DATA")]
    pub(crate) data: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) how: FitHow,
    /// Another recording of the same actuator; may be given several times. The model is not fitted
    /// to it. The band is widened to what changes between sessions
    #[arg(long, value_name = "FILE")]
    pub(crate) repeat: Vec<PathBuf>,
    /// Where the model goes
    #[arg(short, value_name = "MODEL")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
}

/// What fits of one actuator and of a fleet have in common.
#[derive(Args)]
pub(crate) struct FitHow {
    /// Column of the input [default: as the table tells: a log of `run` or `track`, or one whose
    /// columns leave no doubt]
    #[arg(long, value_name = "COL")]
    pub(crate) input: Option<String>,
    /// Column of the output [default: as for --input]
    #[arg(long, value_name = "COL")]
    pub(crate) output: Option<String>,
    /// Number of levels K of the plane; it has K(K+1)/2 operators. `auto` chooses it by the error
    /// on branches left out, or by the evidence where there are few branches
    #[arg(long, value_name = "K", default_value = "auto", value_parser = parse_levels_or_auto)]
    pub(crate) levels: Levels,
    /// Strength of the smoothness along the diagonal of the plane, and across it: 1e-10 to 1e-4 and
    /// 1e-10 to 1e-7 as a rule; `auto` chooses them as the levels
    #[arg(
        long,
        value_name = "ALONG[,ACROSS]",
        default_value = "auto",
        allow_hyphen_values = true,
        value_parser = parse_smooth
    )]
    pub(crate) smooth: Smooth,
    /// Ridge on the weights, 0 to 1: pulls weights that the data hardly move to zero. Relative to
    /// the mean diagonal element of the Gram matrix
    #[arg(long, value_name = "SHARE", default_value = "1e-6", allow_hyphen_values = true, value_parser = parse_finite)]
    pub(crate) ridge: f64,
    /// Outliers, which stand out from their neighbours: `auto` finds and lists them, and leaves them
    /// out of the fit
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) robust: Robust,
    /// State of the operators before the first sample; `auto` takes a rest, unless an unknown
    /// start predicts clearly better
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) start: FitStart,
    /// Column of the load or stress: the model depends on it
    #[arg(long, value_name = "COL")]
    pub(crate) load: Option<String>,
    /// What the load changes
    #[arg(long, value_enum, requires = "load", default_value = "auto")]
    pub(crate) load_law: LoadLaw,
    /// Order of weights and offset in the load, 0 to 5; `auto` chooses it by loads left out
    #[arg(
        long,
        value_name = "N",
        default_value = "auto",
        requires = "load",
        allow_hyphen_values = true,
        value_parser = parse_degree
    )]
    pub(crate) load_degree: Degree,
    /// Where the levels are: close together where the output moves, if that is better, or at equal
    /// distances
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) spacing: Spacing,
    /// Dead time: samples from an input to the output that answers it, up to 1000; `auto` (up to 7,
    /// where they predict parts of the recording left out) or `off`. Needs --time
    #[arg(long, value_name = "N", default_value = "auto", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) delay: Step,
    /// Creep of the output: `auto` (where it predicts parts of the recording left out), `off`, or
    /// the number of terms, up to 4. Needs --time
    #[arg(long, value_name = "N", default_value = "off", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) creep: Step,
    /// Lag of the output: `auto` (as for --creep), `off`, or its time constant in s. Needs --time
    #[arg(long, value_name = "SECONDS", default_value = "off", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) lag: Step,
    /// What happens behind the operators in time: a ring, which is a resonance of the second order,
    /// or a lag, which is of the first. `auto` looks for a ring in recordings with time and without a
    /// load, unless creep or a lag is asked for
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) dynamics: Dynamics,
    /// Output curve behind the operators: `auto` (where it predicts parts of the recordings left
    /// out), `off`, or the number of pieces, up to 100
    #[arg(long, value_name = "N", default_value = "off", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) curve: Step,
    /// Identify a thermal body in front of the operators, for an input that heats while the
    /// temperature is not known. The input has to be proportional to the power, as a duty cycle is:
    /// give the square of a current or a voltage. Needs --time
    #[arg(long, value_enum, value_name = "BODY")]
    pub(crate) thermal: Option<Thermal>,
    /// Replicates for standard errors and the prediction band, 0 for none [default: 200, from 25
    /// levels on 60, from 45 on 0]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = up_to::<usize>(10_000))]
    pub(crate) bootstrap: Option<usize>,
    /// A table of models of other actuators of the same kind (`fleet fit`): their mean and spread
    /// say what a short recording does not. Plane, levels, spacing, operator and sign are theirs
    #[arg(long, value_name = "MODELS", conflicts_with_all = [
        "levels", "range", "smooth", "ridge", "spacing", "operator", "sign", "offset", "thermal",
        "load", "creep", "lag", "dynamics", "curve", "bootstrap",
    ])]
    pub(crate) prior: Option<PathBuf>,
    /// What takes no part in the fit, and tests it beside a straight line and interpolation:
    /// `branches:20%` or just `20%` (a share up to 33 %, spread over the recording), `rows:A-B,C-D`
    /// (counted from 1, after the preparation, through all that is fitted), or another recording.
    /// It may be given several times: one part, and any number of files
    #[arg(long, value_name = "WHAT|FILE", value_parser = parse_hold_out)]
    pub(crate) hold_out: Vec<HoldOut>,
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
    pub(crate) prepare: PrepareFirst,
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
    /// Column of time, in seconds or with its unit in its name
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
    #[command(flatten)]
    pub(crate) repair: Repair,
    #[command(flatten)]
    pub(crate) steps: Steps,
    /// Undo the lag of the input's sensor: `auto` (right only for a material that does not depend
    /// on rate), `off` or its time constant in s [default: off]
    #[arg(long = "sensor-lag", alias = "lag", help_heading = "Preparation", value_name = "STEP", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) sensor_lag: Option<Step>,
    /// Where the prepared recording goes
    #[arg(short, value_name = "OUT")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct PrepareFirst {
    /// Column of time, in seconds or with its unit in its name: for the preparation, a thermal
    /// body, figures over time, and a warning if loops depend on rate
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
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
