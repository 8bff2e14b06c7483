//! PID gains from the model, and what to do where none come from it.

use crate::error::Result;
use hysteron::control::Scheme;
use hysteron::{Error, Model};
use hysteron_sim::joint::{self, Tuned};

/// As [`joint::tune`], with the keys of the file as advice.
pub(crate) fn tune(model: &Model, scheme: &Scheme, inverse: bool) -> Result<Tuned> {
    let advised = |error| match error {
        Error::Control(why) => Error::Control(format!(
            "{why}: give `proportional` and `integral_s` in place of tuning = \"model\""
        )),
        other => other,
    };
    Ok(joint::tune(model, scheme, inverse).map_err(advised)?)
}
