//! Recordings from files, with what there is to say about their rows.

use crate::args;
use crate::terminal::{Result, say};
use hysteron::{Columns, Note, Others, Recording, TableReader};
use std::path::Path;

/// Reads a recording; notes go to standard error.
pub(crate) fn read(path: &Path, columns: Columns<'_>, repair: &args::Repair) -> Result<Recording> {
    let (recording, notes) = Recording::read(path, columns, repair)?;
    tell(path, &notes);
    Ok(recording)
}

/// As [`read`], with the other columns of the file.
pub(crate) fn read_with_others(
    path: &Path,
    columns: Columns<'_>,
    repair: &args::Repair,
) -> Result<(Recording, Others)> {
    let (recording, others, notes) = Recording::read_with_others(path, columns, repair)?;
    tell(path, &notes);
    Ok((recording, others))
}

fn tell(path: &Path, notes: &[Note]) {
    for note in notes {
        say(format_args!("{}: {note}", path.display()));
    }
}

/// What was assumed in reading a table, at its end.
pub(crate) fn tell_of_table(path: &Path, table: &TableReader) {
    for remark in table.remarks() {
        say(format_args!("{}: {remark}", path.display()));
    }
}
