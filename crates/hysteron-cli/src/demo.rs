//! `hysteron demo`
use crate::{Result, args};
pub(crate) fn run(_args: &args::Demo) -> Result<()> {
    Err("not yet".into())
}
