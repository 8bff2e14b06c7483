//! Recordings from files, with what there is to say about their rows.

use crate::args;
use crate::terminal::{Result, say};
use hysteron::{Columns, Note, Others, Recording, Segment, TableReader};
use std::path::Path;

/// Reads a table: one recording, or several of one experiment. Notes go to standard error.
pub(crate) fn segments(
    path: &Path,
    columns: Columns<'_>,
    repair: &args::Repair,
) -> Result<Vec<Recording>> {
    let (segments, notes) = Recording::read_segments(path, columns, repair)?;
    tell(path, &notes, &segments);
    Ok(segments.into_iter().map(|part| part.recording).collect())
}

/// As [`segments`], with the other columns of the file.
pub(crate) fn segments_with_others(
    path: &Path,
    columns: Columns<'_>,
    repair: &args::Repair,
) -> Result<(Vec<Recording>, Others)> {
    let (segments, others, notes) = Recording::read_with_others(path, columns, repair)?;
    tell(path, &notes, &segments);
    let recordings = segments.into_iter().map(|part| part.recording).collect();
    Ok((recordings, others))
}

fn tell(path: &Path, notes: &[Note], segments: &[Segment]) {
    for note in notes {
        say(format_args!("{}: {note}", path.display()));
    }
    if segments.len() > 1 {
        let rows = segments
            .iter()
            .map(|part| format!("{} to {}", part.first, part.last));
        let named: Vec<String> = rows.take(NAMED).collect();
        let others = match segments.len() - named.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        say(format_args!(
            "{}: {} recordings of one experiment, {}{others}",
            path.display(),
            segments.len(),
            named.join(", ")
        ));
    }
}

/// So many segments are named by their lines.
const NAMED: usize = 8;

/// Before what is said of one recording of several.
pub(crate) fn which(n: usize, count: usize) -> String {
    match count {
        1 => String::new(),
        _ => format!("recording {}: ", n + 1),
    }
}

/// What was assumed in reading a table, at its end.
pub(crate) fn tell_of_table(path: &Path, table: &TableReader) {
    for remark in table.remarks() {
        say(format_args!("{}: {remark}", path.display()));
    }
}
