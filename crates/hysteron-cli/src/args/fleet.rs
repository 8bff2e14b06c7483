//! Arguments of `hysteron fleet`.

use super::common::{Force, Json};
use super::fit_how::FitHow;
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

#[derive(Subcommand)]
pub(crate) enum Fleet {
    /// Fit a model to each actuator of tables or folders: a table with a row for each
    #[command(after_help = "Examples:\n\
        \x20 hysteron fleet fit line.parquet --by serial --input temperature \
        --output displacement -o models.parquet\n\
        \x20 hysteron fleet fit recordings/ --input temperature --output displacement \
        --levels 20 --bootstrap 0 -o models.parquet")]
    Fit(Box<FleetFit>),
    /// Write the model of one actuator as a file
    #[command(after_help = "Example:\n\
        \x20 hysteron fleet extract models.parquet A-0017 -o a17.json")]
    Extract(FleetExtract),
    /// Put tables of models together, made of the parts of a fleet
    #[command(after_help = "Example:\n\
        \x20 hysteron fleet join part-1.parquet part-2.parquet -o models.parquet")]
    Join(FleetJoin),
    /// Is an actuator like the others? The robust distance of its main numbers from theirs
    #[command(after_help = "Examples:\n\
        \x20 hysteron fleet check models.parquet new.json\n\
        \x20 hysteron fleet check models.parquet today.parquet")]
    Check(FleetCheck),
    /// Draw how errors and loops of a fleet are distributed, and the ten strangest loops
    #[command(after_help = "Example:\n\
        \x20 hysteron fleet report models.parquet -o report")]
    Report(FleetReport),
}

#[derive(Args)]
pub(crate) struct FleetFit {
    /// Tables, or folders of tables (csv, txt, dat, tsv, parquet, mat; also in folders below)
    #[arg(required = true, value_name = "DATA")]
    pub(crate) data: Vec<PathBuf>,
    /// Column that tells which actuator a row belongs to: numbers or text. Its rows stand next to
    /// each other [default: each file is an actuator, and has the name of the file]
    #[arg(long, value_name = "COL")]
    pub(crate) by: Option<String>,
    /// Who chooses what is left to the data, such as the levels: some actuators, spread over the
    /// data, for all of them; or each for itself
    #[arg(long, value_name = "WHO", default_value = "pilots")]
    pub(crate) choice: FleetChoice,
    /// Where the table of models goes: *.parquet
    #[arg(short, value_name = "MODELS")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) json: Json,
    #[command(flatten)]
    pub(crate) how: FitHow,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FleetChoice {
    /// Pilots that are spread over the data; who is not served by their choice chooses for itself
    Pilots,
    /// Each actuator, as `fit` for it alone
    Each,
}

impl From<FleetChoice> for hysteron::FleetChoice {
    fn from(choice: FleetChoice) -> Self {
        match choice {
            FleetChoice::Pilots => Self::Pilots,
            FleetChoice::Each => Self::Each,
        }
    }
}

#[derive(Args)]
pub(crate) struct FleetExtract {
    /// The table of models
    pub(crate) models: PathBuf,
    /// The actuator
    pub(crate) id: String,
    /// Where the model goes
    #[arg(short, long = "output", value_name = "MODEL")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
}

#[derive(Args)]
pub(crate) struct FleetJoin {
    /// The tables of models, in the order of the result
    #[arg(required = true, value_name = "PART")]
    pub(crate) parts: Vec<PathBuf>,
    /// Where the table of all models goes: *.parquet
    #[arg(short, long = "output", value_name = "MODELS")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
}

#[derive(Args)]
pub(crate) struct FleetCheck {
    /// The table of models that says what is usual
    pub(crate) models: PathBuf,
    /// Models (*.json) and tables of models (*.parquet) to be judged
    #[arg(required = true, value_name = "NEW")]
    pub(crate) new: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct FleetReport {
    /// The table of models
    pub(crate) models: PathBuf,
    /// Folder for the page and its figures (SVG, PNG)
    #[arg(short, long = "output", value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
}
