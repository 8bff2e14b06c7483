//! Where a log stands: the number and the time of a sample.

use crate::error::{Result, of_file};
use std::path::Path;

/// A sample as the log has it: numbers and times go on where an earlier run ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct At {
    pub(crate) number: u64,
    pub(crate) time: f64,
}

/// The last whole row of a log; `None` for a log without rows.
///
/// # Errors
/// [`hysteron::Error::File`].
pub(crate) fn last(rows: &Path) -> Result<Option<At>> {
    let text = std::fs::read_to_string(rows).map_err(|source| of_file(rows, source))?;
    let mut lines = text
        .split_inclusive('\n')
        .filter(|line| line.ends_with('\n'));
    let names: Vec<&str> = lines
        .next()
        .unwrap_or_default()
        .trim_end()
        .split(',')
        .collect();
    let value = |row: &str, name: &str| {
        let place = names.iter().position(|column| *column == name)?;
        row.trim_end().split(',').nth(place)?.parse::<f64>().ok()
    };
    let at = |row: &str| {
        Some(At {
            number: value(row, "sample")? as u64,
            time: value(row, "time")?,
        })
    };
    Ok(lines.next_back().and_then(at))
}
