//! The rows of a table that were measured. Some recordings hold copies of other rows, and a column
//! that marks them.

use crate::result::Result;
use hysteron::{Columns, Recording, Repair, TableReader};
use std::path::Path;

/// Columns that are not zero where a row is a copy.
const MARKS: [&str; 1] = ["ascending_copied_from_major"];

/// Reads a recording without its copies.
///
/// A copy is a part of a branch that was measured before. Without it the input jumps from one end
/// of that branch to the other, and the operators remember the same.
pub fn read(path: &Path, columns: Columns<'_>) -> Result<Recording> {
    let (recording, _) = Recording::read(path, columns, Repair::Refuse)?;
    let table = TableReader::open(path)?;
    let Some(mark) = MARKS
        .iter()
        .find(|m| table.header().iter().any(|h| h == *m))
    else {
        return Ok(recording);
    };
    let marks = column(path, columns.input, mark)?;
    let genuine = recording.only(|n| marks[n] == 0.0);
    Ok(genuine.ok_or("every row is a copy")?)
}

/// The numbers of another column, for every row of the file.
pub fn column(path: &Path, input: &str, name: &str) -> Result<Vec<f64>> {
    let (recording, _) = Recording::read(path, Columns::new(input, name), Repair::Refuse)?;
    Ok(recording.output)
}
