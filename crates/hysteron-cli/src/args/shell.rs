//! Options of `completions` and `man`.

use super::common::Force;
use clap::Args;
use clap_complete::Shell;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct Completions {
    /// The shell
    pub(crate) shell: Shell,
}

#[derive(Args)]
pub(crate) struct Man {
    /// Folder for the pages
    #[arg(
        short,
        long = "output",
        value_name = "DIR",
        default_value = "hysteron-man"
    )]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
}
