//! Options of `studio` and `start`.

use super::{Json, Repair};
#[cfg(feature = "studio")]
use super::{Memory, up_to};
use clap::Args;
use std::path::PathBuf;

#[cfg(feature = "studio")]
#[derive(Args)]
pub(crate) struct Studio {
    /// Recordings, or a session that was saved
    #[arg(value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// Port on 127.0.0.1; 0 takes a free one
    #[arg(long, default_value_t = 0, value_parser = up_to::<u16>(65_535))]
    pub(crate) port: u16,
    /// Print the address, and open no browser
    #[arg(long)]
    pub(crate) no_open: bool,
    /// Keep the session in this file, and go on with it if it is there
    #[arg(long, value_name = "FILE")]
    pub(crate) session: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) memory: Memory,
}

#[derive(Args)]
pub(crate) struct Begin {
    /// The recording
    pub(crate) file: PathBuf,
    /// Column of the input [default: guessed]
    #[arg(long, value_name = "COL")]
    pub(crate) input: Option<String>,
    /// Column of the output [default: guessed]
    #[arg(long, value_name = "COL")]
    pub(crate) output: Option<String>,
    #[command(flatten)]
    pub(crate) repair: Repair,
    #[command(flatten)]
    pub(crate) json: Json,
}
