//! What fits of one actuator and of a fleet have in common, in the groups that the help shows.

use super::common::{Columns, Repair};
use super::prepare::PrepareFirst;
use super::value::*;
use clap::Args;
use hysteron::Step;
use std::path::PathBuf;

/// Groups with a heading come last: clap lets a heading reach as far as the next one.
#[derive(Args)]
pub(crate) struct FitHow {
    #[command(flatten)]
    pub(crate) columns: Columns,
    #[command(flatten)]
    pub(crate) quantities: Quantities,
    #[command(flatten)]
    pub(crate) repair: Repair,
    #[command(flatten)]
    pub(crate) plane: Plane,
    #[command(flatten)]
    pub(crate) weights: Weights,
    #[command(flatten)]
    pub(crate) stages: Stages,
    #[command(flatten)]
    pub(crate) tests: Tests,
    #[command(flatten)]
    pub(crate) prepare: PrepareFirst,
}

/// The load, and the units.
#[derive(Args)]
pub(crate) struct Quantities {
    /// Column of the load or stress: the model depends on it
    #[arg(long, value_name = "COL")]
    pub(crate) load: Option<String>,
    /// Unit of the input [default: from a header like `temperature [degC]`]
    #[arg(long, value_name = "UNIT")]
    pub(crate) input_unit: Option<String>,
    /// Unit of the output
    #[arg(long, value_name = "UNIT")]
    pub(crate) output_unit: Option<String>,
}

/// The plane, and which way its operators go.
#[derive(Args)]
#[command(next_help_heading = "Plane")]
pub(crate) struct Plane {
    /// Number of levels K of the plane; it has K(K+1)/2 operators. `auto` chooses it by the error
    /// on branches left out, or by the evidence where there are few branches
    #[arg(long, value_name = "K", default_value = "auto", value_parser = parse_levels_or_auto)]
    pub(crate) levels: Levels,
    /// Where the levels are: close together where the output moves, if that is better, or at equal
    /// distances
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) spacing: Spacing,
    /// Lowest and highest level [default: so that the active range is that of the input]
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_range, allow_hyphen_values = true)]
    pub(crate) range: Option<(f64, f64)>,
    /// Elementary operator
    #[arg(long, value_enum, default_value = "mkp")]
    pub(crate) operator: Operator,
    /// Direction of the output
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) sign: Sign,
    /// Output with every operator off [default: identified]
    #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = parse_finite)]
    pub(crate) offset: Option<f64>,
}

/// How the weights are found, and from which start.
#[derive(Args)]
#[command(next_help_heading = "Weights")]
pub(crate) struct Weights {
    /// State of the operators before the first sample; `auto` takes a rest, unless an unknown
    /// start predicts clearly better
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) start: FitStart,
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
    /// How the weights are found
    #[arg(long, value_enum, default_value = "nnls")]
    pub(crate) solver: Solver,
    /// Outliers, which stand out from their neighbours: `auto` finds and lists them, and leaves them
    /// out of the fit
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) robust: Robust,
    /// A table of models of other actuators of the same kind (`fleet fit`): their mean and spread
    /// say what a short recording does not. Plane, levels, spacing, operator and sign are theirs
    #[arg(long, value_name = "MODELS", conflicts_with_all = [
        "levels", "range", "smooth", "ridge", "spacing", "operator", "sign", "offset", "thermal",
        "load", "creep", "lag", "dynamics", "curve", "bootstrap",
    ])]
    pub(crate) prior: Option<PathBuf>,
}

/// What stands before the operators and behind them.
#[derive(Args)]
#[command(next_help_heading = "Stages")]
pub(crate) struct Stages {
    /// Identify a thermal body in front of the operators, for an input that heats while the
    /// temperature is not known. The input has to be proportional to the power, as a duty cycle is:
    /// give the square of a current or a voltage. Needs --time
    #[arg(long, value_enum, value_name = "BODY")]
    pub(crate) thermal: Option<Thermal>,
    /// Dead time: samples from an input to the output that answers it, up to 1000; `auto` (up to 60,
    /// where they predict parts of the recording left out) or `off`. Needs --time
    #[arg(long, value_name = "N", default_value = "auto", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) delay: Step,
    /// Creep of the output: `auto` (where it predicts parts of the recording left out), `off`, or
    /// the number of terms, up to 4. Needs --time
    #[arg(long, value_name = "N", default_value = "off", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) creep: Step,
    /// Lag of the output: `auto` (as for --creep, of any length), or its time constant in s; `off`
    /// leaves it to --dynamics. Needs --time
    #[arg(long, value_name = "SECONDS", default_value = "off", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) lag: Step,
    /// What happens in time behind the operators: a ring, which is a resonance of the second order,
    /// or a lag, which is of the first. `auto` looks for both, and for a thermal body in front of
    /// the operators, in recordings with time and without a load, unless creep, a lag or a body is
    /// asked for
    #[arg(long, value_enum, default_value = "auto")]
    pub(crate) dynamics: Dynamics,
    /// Output curve behind the operators: `auto` (where it predicts parts of the recordings left
    /// out), `off`, or the number of pieces, up to 100
    #[arg(long, value_name = "N", default_value = "off", allow_hyphen_values = true, value_parser = parse_step)]
    pub(crate) curve: Step,
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
}

/// What tests the fit.
#[derive(Args)]
#[command(next_help_heading = "Tests")]
pub(crate) struct Tests {
    /// What takes no part in the fit, and tests it beside a straight line and interpolation:
    /// `branches:20%` or just `20%` (a share up to 33 %, spread over the recording, with `--time`
    /// the last ones), `rows:A-B,C-D` (counted from 1, after the preparation, through all that is
    /// fitted), or another recording. It may be given several times: one part, and any number of
    /// files
    #[arg(long, value_name = "WHAT|FILE", value_parser = parse_hold_out)]
    pub(crate) hold_out: Vec<HoldOut>,
    /// Replicates for standard errors and the prediction band, 0 for none [default: 200, from 25
    /// levels on 60, from 45 on 0]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = up_to::<usize>(10_000))]
    pub(crate) bootstrap: Option<usize>,
}
