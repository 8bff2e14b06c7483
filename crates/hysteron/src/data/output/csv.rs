//! Writes rows of CSV to a stream, a block at a time.

use super::sink::Sink;
use super::writer::{RowWriter, Rows};
use crate::data::cells::push_number;
use crate::data::table::Needs;
use std::io::{self, Write};

/// Rows are handed on when they take this many bytes.
const BLOCK: usize = 1 << 17;

/// A stream of rows. Dropped before its end, it hands on the rows that it holds.
pub(super) struct Csv<W: Write> {
    /// `None` after the end.
    to: Option<W>,
    held: Vec<u8>,
}

impl<W: Write> Csv<W> {
    pub(super) fn new(to: W) -> Self {
        Self {
            to: Some(to),
            held: Vec::with_capacity(BLOCK + (BLOCK >> 2)),
        }
    }

    /// Rows that are CSV already, each followed by more cells.
    pub(super) fn extended(&mut self, rows: &Rows<'_>) -> io::Result<()> {
        let ((block, first), (cells, from)) = (rows.block, rows.cells);
        for n in 0..rows.count {
            self.held.extend_from_slice(block.row(first + n));
            for series in &cells.numbers {
                self.held.push(b',');
                push_number(&mut self.held, series[from + n]);
            }
            if let Some(word) = cells.words.get(from + n) {
                self.held.push(b',');
                // The words of commands need no quotes.
                self.held.extend_from_slice(word.as_bytes());
            }
            self.end_row()?;
        }
        Ok(())
    }

    /// A row that is CSV already.
    pub(super) fn copied(&mut self, row: &[u8]) -> io::Result<()> {
        self.held.extend_from_slice(row);
        self.end_row()
    }

    #[inline]
    fn end_row(&mut self) -> io::Result<()> {
        self.held.push(b'\n');
        match self.held.len() < BLOCK {
            true => Ok(()),
            false => self.hand_on(),
        }
    }

    /// Hands on the rows that are held.
    pub(super) fn hand_on(&mut self) -> io::Result<()> {
        let Some(to) = &mut self.to else {
            return Ok(());
        };
        let written = to.write_all(&self.held);
        // What could not be written once is not written again.
        self.held.clear();
        written
    }

    pub(super) fn finish(mut self) -> io::Result<Option<W>> {
        self.hand_on()?;
        let mut to = self.to.take();
        if let Some(to) = &mut to {
            to.flush()?;
        }
        Ok(to)
    }
}

impl RowWriter for Csv<Sink> {
    fn needs(&self) -> Needs {
        Needs::Text
    }

    fn row(&mut self, row: &[u8]) -> io::Result<()> {
        self.copied(row)
    }

    fn extended(&mut self, rows: &Rows<'_>) -> io::Result<()> {
        self.extended(rows)
    }

    fn hand_on(&mut self) -> io::Result<()> {
        self.hand_on()
    }

    fn finish(self: Box<Self>) -> io::Result<Option<Sink>> {
        (*self).finish()
    }
}

impl<W: Write> Drop for Csv<W> {
    fn drop(&mut self) {
        let _ = self.hand_on();
        if let Some(to) = &mut self.to {
            let _ = to.flush();
        }
    }
}
