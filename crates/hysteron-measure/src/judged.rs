//! Recordings of a folder, and the error of a model on one.

use crate::result::Result;
use hysteron::{Columns, FitOptions, Model, Recording, Repair, Start, evaluate_from};
use std::path::Path;

pub(crate) fn read(folder: &Path, name: &str, columns: Columns<'_>) -> Result<Recording> {
    Ok(Recording::read(&folder.join(name), columns, Repair::Refuse)?.0)
}

pub(crate) fn options(levels: usize) -> FitOptions {
    FitOptions {
        levels,
        ..FitOptions::plain()
    }
}

/// The error of a model on a recording, in percent of the recording's range.
pub(crate) fn error(model: &Model, recording: &Recording, start: Start) -> Result<f64> {
    let forward = evaluate_from(model, recording, start)?.forward;
    Ok(forward.nrmse_percent.unwrap_or(f64::NAN))
}
