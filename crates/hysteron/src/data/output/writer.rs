//! What writes the rows of a table, whatever the format.

use super::added::AddedCells;
use super::sink::Sink;
use crate::data::table::{Block, Needs};
use std::collections::HashSet;
use std::hash::Hash;
use std::io;

/// Rows of a block from a place on, the cells that are added to them from a place on, and their
/// number.
pub(super) struct Rows<'a> {
    pub(super) block: (&'a Block, usize),
    pub(super) cells: (&'a AddedCells, usize),
    pub(super) count: usize,
}

/// Writes rows in one format.
pub(super) trait RowWriter: Send {
    /// What it needs of the rows of its source.
    fn needs(&self) -> Needs;

    /// Writes a row that is CSV already, without its end. The first one holds the names; who does
    /// not need the text of rows has them since its beginning.
    ///
    /// # Errors
    /// What kept it from being written.
    fn row(&mut self, _row: &[u8]) -> io::Result<()> {
        Ok(())
    }

    /// Writes rows of the source, each followed by its added cells.
    ///
    /// # Errors
    /// What kept them from being written.
    fn extended(&mut self, rows: &Rows<'_>) -> io::Result<()>;

    /// Hands the rows so far on to a reader who may be waiting, where the format can.
    ///
    /// # Errors
    /// What kept them from being written.
    fn hand_on(&mut self) -> io::Result<()> {
        Ok(())
    }

    /// Ends the table. Returns what it was written to; nothing if that is gone.
    ///
    /// # Errors
    /// What kept the end from being written.
    fn finish(self: Box<Self>) -> io::Result<Option<Sink>>;
}

/// Refuses two columns with the same name, because readers of Parquet or Arrow could not
/// distinguish them.
pub(super) fn distinct<N: AsRef<str> + Eq + Hash>(
    names: impl Iterator<Item = N>,
) -> io::Result<()> {
    let mut seen = HashSet::new();
    for name in names {
        if let Some(name) = seen.replace(name) {
            let name = name.as_ref();
            let text = format!(
                "two columns are called `{name}`, which readers of such a file could not tell apart: \
                 write CSV"
            );
            return Err(io::Error::other(text));
        }
    }
    Ok(())
}
