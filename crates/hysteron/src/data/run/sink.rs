//! Pairs the rows of a table with the cells that come for them in the same order.

use crate::data::output::{Added, AddedCells, TableWriter};
use crate::data::table::{Block, Needs, TableReader};
use crate::error::Result;
use std::collections::VecDeque;

/// Writes rows as soon as their new cells are known. A row may wait for the cells of rows after it.
pub(super) struct Sink {
    out: Option<TableWriter>,
    /// The blocks whose cells have not all come yet.
    waiting: VecDeque<Block>,
    /// The next row to be written in the first of them.
    at: usize,
}

impl Sink {
    pub(super) fn start(
        table: &TableReader,
        out: Option<TableWriter>,
        added: &[Added],
    ) -> Result<Self> {
        let mut names = added.iter().map(Added::name);
        if let Some(name) = names.find(|name| table.header().iter().any(|h| h == name)) {
            let problem =
                format!("there is a column `{name}` already: rename it, or name another file");
            return Err(table.fault(None, problem));
        }
        Ok(Self {
            out: out.map(|out| out.begin(table, added)).transpose()?,
            waiting: VecDeque::new(),
            at: 0,
        })
    }

    /// What of the rows is to be read for the writer.
    pub(super) fn needs(&self) -> Needs {
        self.out.as_ref().map_or(Needs::Nothing, TableWriter::needs)
    }

    /// Writes the rows whose cells are known now, and hands them on to whoever reads the result.
    /// Leaves a used block in place of `block`, if there is one.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub(super) fn take(&mut self, block: &mut Block, cells: &AddedCells) -> Result<()> {
        self.waiting.push_back(std::mem::take(block));
        if let Some(used) = self.write(cells)? {
            *block = used;
        }
        self.out.as_mut().map_or(Ok(()), TableWriter::hand_on)
    }

    /// Writes the next rows with these cells. Returns the last block that was used up.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub(super) fn write(&mut self, cells: &AddedCells) -> Result<Option<Block>> {
        let (mut from, mut used) = (0, None);
        while let Some(first) = self.waiting.front() {
            let count = (first.len() - self.at).min(cells.len() - from);
            if let Some(out) = &mut self.out {
                out.extend_rows((first, self.at), (cells, from), count)?;
            }
            (self.at, from) = (self.at + count, from + count);
            if self.at < first.len() {
                break;
            }
            (self.at, used) = (0, self.waiting.pop_front());
        }
        Ok(used)
    }

    /// Ends the table.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub(super) fn finish(self) -> Result<()> {
        self.out.map_or(Ok(()), TableWriter::finish)
    }
}
