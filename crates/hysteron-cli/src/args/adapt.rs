//! Options of `adapt`.

use super::common::{Columns, Force, Json, Repair};
use super::value::*;
use clap::{Arg, ArgMatches, Args, Command, Error, FromArgMatches};
use hysteron::{ADAPT_OPTIONS, AdaptOption, AdaptOptionKind, AdaptOptions, AdaptValue, Learner};
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct Adapt {
    /// The model
    pub(crate) model: PathBuf,
    /// The recording to learn from
    pub(crate) data: PathBuf,
    #[command(flatten)]
    pub(crate) columns: Columns,
    /// State of the operators before the first sample
    #[arg(long, value_enum, default_value = "unknown")]
    pub(crate) start: AdaptStart,
    /// What learns, and how
    #[arg(long, default_value = "auto", value_parser = learners())]
    pub(crate) method: Learner,
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

/// The options of the learners that are given.
pub(crate) struct Tuning(Vec<(&'static AdaptOption, AdaptValue)>);

impl Args for Tuning {
    fn augment_args(command: Command) -> Command {
        command.args(ADAPT_OPTIONS.iter().map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Tuning {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let given = ADAPT_OPTIONS.iter().filter_map(|option| {
            let value = matches.get_one::<AdaptValue>(option.name)?;
            Some((option, *value))
        });
        Ok(Self(given.collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The argument of an option, from the table of the library.
fn argument(option: &'static AdaptOption) -> Arg {
    let AdaptOption {
        name,
        kind,
        learners,
        default,
        range,
        purpose,
    } = option;
    let of = match learners.len() + 1 == Learner::ALL.len() {
        true => String::new(),
        false => {
            learners
                .iter()
                .map(|learner| learner.name())
                .collect::<Vec<_>>()
                .join(", ")
                + ": "
        }
    };
    let help = format!("{of}{purpose}; {range} [default: {default}]").replace('`', "");
    let value_name = match kind {
        AdaptOptionKind::Number => "NUMBER",
        AdaptOptionKind::Count => "N",
        AdaptOptionKind::Window => "WINDOW",
    };
    Arg::new(*name)
        .long(name.replace('_', "-"))
        .value_name(value_name)
        .allow_hyphen_values(true)
        .value_parser(|text: &str| kind.parse(text))
        .help(help)
        .help_heading("Tuning")
}

impl Adapt {
    /// The options of the library.
    pub(crate) fn options(&self) -> hysteron::Result<AdaptOptions> {
        let mut options = AdaptOptions {
            learner: self.method,
            start: self.start.into(),
            ..AdaptOptions::default()
        };
        for (option, value) in &self.tuning.0 {
            options.set(option.name, *value)?;
        }
        Ok(options)
    }
}
