//! Rows of a table on their way into another one, many at a time.

use super::time::Time;
use super::{Column, Source, TableReader};
use crate::data::cells;
use crate::error::{Place, Result};
use crate::recording::Positions;
use std::ops::Range;

/// What a writer needs of the rows of its source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Needs {
    /// Nothing: it copies them itself.
    Nothing,
    /// Their numbers.
    Numbers,
    /// Their text.
    Text,
}

/// Rows of a table: how they will be written, and the numbers of the columns asked for.
#[derive(Default)]
pub(crate) struct Block {
    /// The rows as CSV with commas, if it is needed.
    text: Vec<u8>,
    /// Where each row begins and ends in `text`, which is small.
    rows: Vec<(u32, u32)>,
    places: Positions,
    /// A series for each column asked for.
    numbers: Vec<Vec<f64>>,
    /// A series for each column, if they are needed.
    copied: Vec<Vec<f64>>,
}

/// A block is full with so many bytes of text, or so many rows. Text comes 128 KiB at a time, and a
/// block takes it once.
const BYTES: usize = 1 << 16;
pub(super) const ROWS: usize = 1 << 13;

impl Block {
    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    /// The numbers of the columns asked for, in their order.
    pub(crate) fn numbers(&self) -> &[Vec<f64>] {
        &self.numbers
    }

    /// The numbers of all columns, if they were needed.
    pub(crate) fn copied(&self) -> &[Vec<f64>] {
        &self.copied
    }

    /// Keeps these rows of all columns.
    pub(super) fn copy(&mut self, columns: &[Vec<f64>], rows: Range<usize>) {
        self.copied.resize_with(columns.len(), Vec::new);
        for (copy, column) in self.copied.iter_mut().zip(columns) {
            let end = rows.end.min(column.len());
            copy.clear();
            copy.extend_from_slice(column.get(rows.start..end).unwrap_or_default());
        }
    }

    /// A row as CSV without the end of its line; empty if no text was asked for.
    pub(crate) fn row(&self, n: usize) -> &[u8] {
        let row = self.rows.get(n);
        row.map_or(&[], |(start, end)| {
            &self.text[*start as usize..*end as usize]
        })
    }

    pub(crate) fn place(&self, n: usize) -> Option<Place> {
        (n < self.len()).then(|| self.places.at(n))
    }

    fn clear(&mut self, columns: usize) {
        self.text.clear();
        self.rows.clear();
        self.places.truncate(0);
        self.numbers.resize_with(columns, Vec::new);
        self.numbers.iter_mut().for_each(Vec::clear);
    }

    pub(super) fn is_full(&self) -> bool {
        self.text.len() >= BYTES || self.len() >= ROWS
    }

    /// Adds the number of a row in the column asked for as number `slot`.
    pub(super) fn push_number(&mut self, slot: usize, number: f64) {
        self.numbers[slot].push(number);
    }

    /// Takes back the numbers of a row that was not added.
    pub(super) fn drop_numbers(&mut self) {
        let rows = self.len();
        for series in &mut self.numbers {
            series.truncate(rows);
        }
    }

    /// Adds a row, after its numbers. `write` appends its text.
    pub(super) fn push_row(&mut self, place: Place, write: impl FnOnce(&mut Vec<u8>)) {
        let start = self.text.len();
        write(&mut self.text);
        self.push_row_at(place, start..self.text.len());
    }

    /// Adds a row whose text is at `row`, or will be with [`Block::push_text`].
    #[inline]
    pub(super) fn push_row_at(&mut self, place: Place, row: Range<usize>) {
        self.rows.push((row.start as u32, row.end as u32));
        self.places.push(place);
    }

    pub(super) fn text_len(&self) -> usize {
        self.text.len()
    }

    /// Adds the text of rows. Their cells are separated by `delimiter`.
    pub(super) fn push_text(&mut self, text: &[u8], delimiter: u8) {
        let start = self.text.len();
        self.text.extend_from_slice(text);
        if delimiter != b',' {
            for byte in &mut self.text[start..] {
                if *byte == delimiter {
                    *byte = b',';
                }
            }
        }
    }

    /// Adds so many rows without text, whose numbers were added before.
    pub(super) fn push_places(&mut self, first: Place, count: usize) {
        self.places.push_run(first, count);
    }

    /// Drops the rows from `len` on.
    fn truncate(&mut self, len: usize) {
        self.places.truncate(len);
        self.rows.truncate(len);
        self.drop_numbers();
    }
}

impl TableReader {
    /// Reads the next rows into `block`; none at the end of the table. `needs` is what will be
    /// written of them. An error comes after the rows before it.
    ///
    /// From a pipe, rows are not kept back until a block is full.
    ///
    /// # Errors
    /// As [`TableReader::advance`] and [`TableReader::number`].
    pub(crate) fn fill(&mut self, block: &mut Block, asked: &[Column], needs: Needs) -> Result<()> {
        block.clear(asked.len());
        if let Some(error) = self.late.take() {
            return Err(error);
        }
        let filled = match &self.source {
            Source::Text(_) => self.fill_from_text(block, asked),
            Source::Numbers(_) => self.fill_from_numbers(block, asked, needs),
        };
        match filled {
            Err(error) if block.len() > 0 => {
                self.late = Some(error);
                Ok(())
            }
            filled => filled,
        }
    }

    /// Reads one row with all care, and those after it in a hurry.
    fn fill_from_text(&mut self, block: &mut Block, asked: &[Column]) -> Result<()> {
        let slots: Vec<(usize, usize)> = asked.iter().map(|c| c.place()).zip(0..).collect();
        while self.advance()? {
            if let Err(error) = self.push_numbers(block, asked) {
                block.drop_numbers();
                return Err(error);
            }
            let place = self.row_place();
            let row = self.row();
            block.push_row(place, |out| cells::push_row(out, row.cells()));
            let time = &self.time;
            let Source::Text(text) = &mut self.source else {
                break;
            };
            let number = |column: usize, value: f64| match time {
                Some((at, time)) if *at == column => {
                    time.in_seconds(Some(value)).unwrap_or(f64::NAN)
                }
                _ => value,
            };
            if matches!(time, Some((_, Time::Stamps(..)))) {
                // Each timestamp follows from those before.
                if block.is_full() || text.is_drained() {
                    break;
                }
                continue;
            }
            text.plain_rows(self.header.len(), &slots, number, block);
            if block.is_full() || text.is_drained() {
                break;
            }
        }
        Ok(())
    }

    fn push_numbers(&self, block: &mut Block, asked: &[Column]) -> Result<()> {
        for (slot, column) in asked.iter().enumerate() {
            block.push_number(slot, self.number(*column)?);
        }
        Ok(())
    }

    fn fill_from_numbers(
        &mut self,
        block: &mut Block,
        asked: &[Column],
        needs: Needs,
    ) -> Result<()> {
        let Source::Numbers(numbers) = &mut self.source else {
            return Ok(());
        };
        let places: Vec<usize> = asked.iter().map(|column| column.place()).collect();
        let filled = numbers.fill(block, &places, needs);
        filled.map_err(|problem| self.fault(None, problem))?;
        for (slot, column) in asked.iter().enumerate() {
            if let Some((at, time)) = &mut self.time
                && *at == column.place()
            {
                let numbers = &mut block.numbers[slot];
                if let Some(first) = numbers.iter().find(|number| number.is_finite()) {
                    time.learn(*first);
                }
                for value in numbers {
                    *value = time.in_seconds(Some(*value)).unwrap_or(f64::NAN);
                }
            }
        }
        let finite = |n: usize| block.numbers.iter().all(|series| series[n].is_finite());
        let Some(bad) = (0..block.len()).find(|n| !finite(*n)) else {
            return Ok(());
        };
        if let Source::Numbers(numbers) = &mut self.source {
            numbers.go_back(block.len() - 1 - bad);
        }
        block.truncate(bad);
        let found: Result<Vec<f64>> = asked.iter().map(|column| self.number(*column)).collect();
        found.map(|_| ())
    }

    /// Whether the table is stored by columns of numbers.
    pub(crate) fn is_by_columns(&self) -> bool {
        matches!(self.source, Source::Numbers(_))
    }

    /// Whether all bytes that have arrived are used, so that the next row may be long in coming.
    pub(crate) fn may_wait(&self) -> bool {
        match &self.source {
            Source::Text(text) => text.is_drained(),
            Source::Numbers(_) => false,
        }
    }
}
