//! Options of `studio` and `start`.

#[cfg(feature = "studio")]
use super::common::Memory;
use super::common::{Force, Json, Repair};
use super::prepare::PrepareFirst;
use super::value::up_to;
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
    /// Column of the input [default: found by name, unit and values]
    #[arg(long, value_name = "COL")]
    pub(crate) input: Option<String>,
    /// Column of the output [default: as for --input]
    #[arg(long, value_name = "COL")]
    pub(crate) output: Option<String>,
    /// Column of time: seconds, another unit in its name, or timestamps [default: as for --input]
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
    /// Column of the load [default: as for --input, if it changes]
    #[arg(long, value_name = "COL")]
    pub(crate) load: Option<String>,
    /// Also write the model of the first fit to this file
    #[arg(short, value_name = "MODEL")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    #[command(flatten)]
    pub(crate) repair: Repair,
    #[command(flatten)]
    pub(crate) json: Json,
    #[command(flatten)]
    pub(crate) prepare: PrepareFirst,
}
