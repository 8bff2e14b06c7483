//! Puts tables of models together: those that several machines made of the parts of a fleet.

use super::row::COLUMNS;
use crate::data::{RecordWriter, Value, read_records};
use crate::error::{Error, Result};
use hysteron_files::Destination;
use std::collections::HashMap;
use std::path::PathBuf;

/// Writes the rows of several tables of models as one table, in the order of `parts`. Returns their
/// number.
///
/// The table has the same bits as one that was fitted at once to the data of all parts in the same
/// order.
///
/// # Errors
/// As [`crate::read_fleet`]; [`Error::Recording`] for an actuator that is in two parts;
/// [`Error::File`] for a target that cannot be written. Nothing is written then.
pub fn join_fleets(parts: &[PathBuf], target: Destination<'_>) -> Result<usize> {
    let mut table = RecordWriter::create(target, COLUMNS)?;
    let mut known: HashMap<String, usize> = HashMap::new();
    for (n, part) in parts.iter().enumerate() {
        read_records(part, COLUMNS, |values| {
            let refused = |problem: String| Error::Recording {
                path: Some(part.clone()),
                row: None,
                column: Some("id".into()),
                problem,
            };
            let Some(Value::Text(id)) = values.first() else {
                return Err(refused("this is no table of models".into()));
            };
            if let Some(other) = known.insert(id.clone(), n) {
                let other = parts[other].display();
                let problem = format!("the actuator `{id}` is in {other} too");
                return Err(refused(problem));
            }
            table.push(values)?;
            Ok(true)
        })?;
    }
    table.finish()?;
    Ok(known.len())
}
