//! `hysteron fit --hold-out`: what is held out, and what it says of the model.

use crate::terminal::Result;
use crate::{args, text};
use hysteron::{HeldOut, HoldOut, Model, Recording};
use std::path::Path;

/// What the options hold out; `read` reads a file as the recordings fitted are read.
pub(crate) fn what(
    args: &args::Fit,
    read: impl Fn(&Path) -> Result<Vec<Recording>>,
) -> Result<Option<HoldOut>> {
    let (mut files, mut held) = (Vec::new(), None);
    for what in &args.how.tests.hold_out {
        match (what, &held) {
            (args::HoldOut::File(file), _) => files.extend(read(file)?),
            (args::HoldOut::Part(part), None) => held = Some(part.clone()),
            (args::HoldOut::Part(_), Some(_)) => {
                return Err(
                    "--hold-out: one part of the recording can be held out, and any files".into(),
                );
            }
        }
    }
    Ok(HoldOut::together(held, files))
}

/// A line for the model, and a table of the rivals.
pub(crate) fn to_text(held_out: &HeldOut, model: &Model) -> String {
    let mut rows = vec![text::row([
        "held out",
        "RMSE",
        "largest",
        "% of range",
        "samples",
    ])];
    let rivals = held_out
        .rivals
        .iter()
        .map(|rival| (rival.name, &rival.errors));
    for (name, errors) in [("model", &held_out.model)].into_iter().chain(rivals) {
        rows.push(text::errors(name, errors, &model.output));
    }
    text::table(&rows)
}
