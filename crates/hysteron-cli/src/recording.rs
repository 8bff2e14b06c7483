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

/// As [`read`], for a table that may hold several recordings of one experiment.
pub(crate) fn segments(
    path: &Path,
    columns: Columns<'_>,
    repair: &args::Repair,
) -> Result<Vec<Recording>> {
    let (segments, notes) = Recording::read_segments(path, columns, repair)?;
    tell(path, &notes);
    if segments.len() > 1 {
        let rows = segments
            .iter()
            .map(|part| format!("{} to {}", part.first, part.last));
        say(format_args!(
            "{}: {} recordings of one experiment, {}",
            path.display(),
            segments.len(),
            rows.collect::<Vec<_>>().join(", ")
        ));
    }
    Ok(segments.into_iter().map(|part| part.recording).collect())
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
