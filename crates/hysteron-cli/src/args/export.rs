//! Arguments of `hysteron export`.

use super::{Json, Load};
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

#[derive(Subcommand)]
pub(crate) enum Export {
    /// Portable C99 with the model as constants, for a microcontroller or a PLC
    #[command(after_help = "Example:\n  hysteron export c spring.json -o firmware --real float")]
    C(ExportC),
    /// A block for Simulink, Dymola and other tools (FMI, co-simulation)
    #[command(
        after_help = "Examples:\n  hysteron export fmu spring.json -o sf_MKP.fmu\n  hysteron export fmu spring.json --inverse -o sf_Inverse_MKP.fmu"
    )]
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
    /// Folder for the files: hysteron_mcu.h and .c, and the model's
    #[arg(short, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Name of the model in C, and of its files [default: that of the model's file]
    #[arg(long)]
    pub(crate) name: Option<String>,
    /// The number type to compute in
    #[arg(long, value_enum, default_value_t = CReal::Float)]
    pub(crate) real: CReal,
    /// Also write what lets the weights follow the plant on the target
    #[arg(long)]
    pub(crate) adaptation: bool,
    #[command(flatten)]
    pub(crate) load: Load,
    #[command(flatten)]
    pub(crate) json: Json,
}

#[derive(Args)]
pub(crate) struct ExportFmu {
    /// The model
    pub(crate) model: PathBuf,
    /// The file
    #[arg(short, value_name = "FMU")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) load: Load,
    #[command(flatten)]
    pub(crate) json: Json,
}
