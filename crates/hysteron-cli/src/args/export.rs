//! Arguments of `hysteron export`.

use super::common::{Force, Json};
use super::value::parse_limits;
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

#[derive(Subcommand)]
pub(crate) enum Export {
    /// Portable C99 with the model as constants, for a microcontroller or a PLC
    #[command(after_help = "Examples:\n\
        \x20 hysteron export c spring.json -o mcu --real float\n\
        \x20 hysteron export c wire.json -o mcu --dt 0.01 --drive-range 0,100")]
    C(ExportC),
    /// A block for Simulink, Dymola and other tools (FMI, co-simulation)
    #[command(after_help = "Examples:\n\
        \x20 hysteron export fmu spring.json -o sf_MKP.fmu\n\
        \x20 hysteron export fmu spring.json --inverse -o sf_Inverse_MKP.fmu\n\
        \x20 hysteron export fmu spring.json --fmi 3 --name spring -o spring.fmu")]
    Fmu(ExportFmu),
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum CReal {
    /// Single precision, for processors that compute in it
    Float,
    /// Double precision: the digits of `simulate` and `invert`
    Double,
}

impl From<CReal> for hysteron_export::CReal {
    fn from(real: CReal) -> Self {
        match real {
            CReal::Float => Self::Float,
            CReal::Double => Self::Double,
        }
    }
}

#[derive(Args)]
pub(crate) struct ExportC {
    /// The model
    pub(crate) model: PathBuf,
    /// Folder for the files: the algorithm (hysteron_mcu…) and the model's
    #[arg(short, long = "output", value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Name of the model in C, and of its files [default: that of the model's file]
    #[arg(long)]
    pub(crate) name: Option<String>,
    /// The number type to compute in
    #[arg(long, value_enum, default_value_t = CReal::Float)]
    pub(crate) real: CReal,
    /// Also write the code with which the weights adapt on the target
    #[arg(long)]
    pub(crate) adaptation: bool,
    /// The sample time on the target, for a model that depends on time
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub(crate) dt: Option<f64>,
    /// Lowest and highest drive of the inverse, for a model with stages [default: for a thermal
    /// body the drives it was fitted with, otherwise no limits]
    #[arg(long, value_name = "MIN,MAX", value_parser = parse_limits, allow_hyphen_values = true)]
    pub(crate) drive_range: Option<(f64, f64)>,
    /// Take the model at this load; without it the load is an argument on the target
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true)]
    pub(crate) load: Option<f64>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct ExportFmu {
    /// The model
    pub(crate) model: PathBuf,
    /// The file, which ends with .fmu
    #[arg(short, long = "output", value_name = "FMU")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// The inverse instead of the model: from the wanted output to the input
    #[arg(long)]
    pub(crate) inverse: bool,
    /// The standard: FMI 2.0 or 3.0
    #[arg(long, value_enum, default_value = "2")]
    pub(crate) fmi: Fmi,
    /// Name of the block, a C identifier [default: sf_MKP, with --inverse sf_Inverse_MKP]
    #[arg(long)]
    pub(crate) name: Option<String>,
    /// Take the model at this load; without it the load is an input of the block
    #[arg(long, value_name = "LOAD", allow_hyphen_values = true)]
    pub(crate) load: Option<f64>,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Clone, Copy, clap::ValueEnum)]
pub(crate) enum Fmi {
    /// What most tools import
    #[value(name = "2")]
    V2,
    /// For tools that prefer it
    #[value(name = "3")]
    V3,
}

impl From<Fmi> for hysteron_export::Fmi {
    fn from(fmi: Fmi) -> Self {
        match fmi {
            Fmi::V2 => Self::V2,
            Fmi::V3 => Self::V3,
        }
    }
}
