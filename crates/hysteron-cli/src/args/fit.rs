//! Options of `fit`.

use super::common::{Force, Json};
use super::fit_how::FitHow;
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct Fit {
    /// The recording; several are one experiment, each from its own initial state
    #[arg(required = true, value_name = "DATA")]
    pub(crate) data: Vec<PathBuf>,
    /// Where the model goes
    #[arg(short, value_name = "MODEL")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Another recording of the same actuator; may be given several times. The model is not fitted
    /// to it. The band is widened to what changes between sessions
    #[arg(long, value_name = "FILE")]
    pub(crate) repeat: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) json: Json,
    #[command(flatten)]
    pub(crate) how: FitHow,
}
