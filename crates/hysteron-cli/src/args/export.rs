//! Arguments of `hysteron export`.

use super::{Json, Load};
use clap::{Args, Subcommand};
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

#[derive(Args)]
pub(crate) struct ExportC {
    /// The model
    pub(crate) model: PathBuf,
    /// Folder for the files
    #[arg(short, value_name = "DIR")]
    pub(crate) out: PathBuf,
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
