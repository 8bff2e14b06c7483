//! Recordings from files, with what there is to say about their rows.

use crate::{Result, args};
use hysteron::{Columns, Recording};
use std::path::Path;

/// Reads a recording; notes go to standard error.
pub(crate) fn read(path: &Path, columns: Columns<'_>, repair: &args::Repair) -> Result<Recording> {
    let (recording, notes) = Recording::read(path, columns, repair.into())?;
    for note in notes {
        eprintln!("hysteron: {}: {note}", path.display());
    }
    Ok(recording)
}
