//! Columns of numbers in memory, one row group after another.

use super::Row;
use super::block::{Block, Needs, ROWS};
use crate::data::cells::push_number;
use crate::error::Place;

/// Columns of numbers. A missing number is NaN.
pub(super) type Group = Vec<Vec<f64>>;

/// The rows of a table that is stored by columns.
pub(super) struct Numbers {
    group: Group,
    /// The groups after this one.
    rest: Box<dyn Iterator<Item = Result<Group, String>>>,
    /// Number of rows returned from this group, and of those in the groups before it.
    at: usize,
    before: u64,
    rows: u64,
    bytes: u64,
    matrices: bool,
    /// Columns that are certainly times in seconds.
    times: Vec<usize>,
    /// Names and lengths of the columns left out because of their length.
    left_out: Vec<(String, usize)>,
    row: Row,
}

impl Numbers {
    /// Groups with `rows` rows in all, from a file of `bytes` bytes.
    pub(super) fn in_groups(
        rest: impl Iterator<Item = Result<Group, String>> + 'static,
        rows: u64,
        bytes: u64,
    ) -> Self {
        Self {
            group: Vec::new(),
            rest: Box::new(rest),
            at: 0,
            before: 0,
            rows,
            bytes,
            matrices: false,
            times: Vec::new(),
            left_out: Vec::new(),
            row: Row::default(),
        }
    }

    /// Columns that are all in memory. Their lengths may differ, and some may belong to matrices.
    pub(super) fn held_whole(group: Group) -> Self {
        let bytes = group.iter().map(|column| 8 * column.len() as u64).sum();
        let rows = group.iter().map(Vec::len).max().unwrap_or(0) as u64;
        Self {
            group,
            matrices: true,
            ..Self::in_groups(std::iter::empty(), rows, bytes)
        }
    }

    /// Marks columns as times in seconds.
    pub(super) fn with_times(self, times: Vec<usize>) -> Self {
        Self { times, ..self }
    }

    /// The unit of a column of time.
    pub(super) fn unit(&self, column: usize) -> Option<&str> {
        self.times.contains(&column).then_some("s")
    }

    pub(super) fn has_matrices(&self) -> bool {
        self.matrices
    }

    /// A column of a table that is in memory as a whole.
    pub(super) fn held(&self, column: usize) -> &[f64] {
        &self.group[column]
    }

    /// Leaves out all columns of another length than `column`, and returns the new index of
    /// `column`.
    pub(super) fn keep_as_long_as(&mut self, column: usize, header: &mut Vec<String>) -> usize {
        let Some(length) = self.group.get(column).map(Vec::len) else {
            return column;
        };
        let keep: Vec<bool> = self
            .group
            .iter()
            .map(|other| other.len() == length)
            .collect();
        let names = header.iter().zip(&self.group).zip(&keep);
        let left_out = names.filter(|(_, keep)| !**keep);
        self.left_out
            .extend(left_out.map(|((name, other), _)| (name.clone(), other.len())));
        let mut kept = keep.iter();
        header.retain(|_| kept.next() == Some(&true));
        let mut kept = keep.iter();
        self.group.retain(|_| kept.next() == Some(&true));
        self.rows = length as u64;
        keep[..column].iter().filter(|keep| **keep).count()
    }

    /// The length of a column that was left out, and the length of those kept.
    pub(super) fn left_out(&self, name: &str) -> Option<(usize, usize)> {
        let data = format!("{name}:2");
        let found = self
            .left_out
            .iter()
            .find(|(n, _)| n == name || *n == data)?;
        Some((found.1, self.rows as usize))
    }

    fn length(&self) -> usize {
        self.group.iter().map(Vec::len).max().unwrap_or(0)
    }

    pub(super) fn advance(&mut self) -> Result<bool, String> {
        while self.at >= self.length() {
            let Some(group) = self.rest.next().transpose()? else {
                return Ok(false);
            };
            self.before += self.length() as u64;
            (self.group, self.at) = (group, 0);
        }
        self.at += 1;
        Ok(true)
    }

    /// Reads the next rows into `block`: the numbers of the columns `asked` for, and what else it
    /// `needs`.
    pub(super) fn fill(
        &mut self,
        block: &mut Block,
        asked: &[usize],
        needs: Needs,
    ) -> Result<(), String> {
        if !self.advance()? {
            return Ok(());
        }
        let rows = self.at - 1..self.length().min(self.at - 1 + ROWS);
        self.at = rows.end;
        let place = |row: usize| Place::Row(self.before + row as u64 + 1);
        for (slot, column) in asked.iter().enumerate() {
            let column = self.group.get(*column).map_or(&[][..], Vec::as_slice);
            for row in rows.clone() {
                block.push_number(slot, column.get(row).copied().unwrap_or(f64::NAN));
            }
        }
        if needs != Needs::Text {
            block.push_places(place(rows.start), rows.len());
            if needs == Needs::Numbers {
                block.copy(&self.group, rows);
            }
            return Ok(());
        }
        for row in rows {
            block.push_row(place(row), |out| {
                for (n, column) in self.group.iter().enumerate() {
                    if n > 0 {
                        out.push(b',');
                    }
                    if let Some(value) = column.get(row).filter(|value| !value.is_nan()) {
                        push_number(out, *value);
                    }
                }
            });
        }
        Ok(())
    }

    /// Makes the row before the last `rows` ones the current row again.
    pub(super) fn go_back(&mut self, rows: usize) {
        self.at = self.at.saturating_sub(rows);
    }

    /// The number in the current row; `None` beyond the end of a column that is shorter than
    /// others.
    pub(super) fn value(&self, column: usize) -> Option<f64> {
        let row = self.at.checked_sub(1)?;
        self.group.get(column)?.get(row).copied()
    }

    pub(super) fn row(&mut self) -> &Row {
        self.row.0.clear();
        for column in 0..self.group.len() {
            let cell = match self.value(column).filter(|value| !value.is_nan()) {
                Some(value) => value.to_string(),
                None => String::new(),
            };
            self.row.0.push_field(cell.as_bytes());
        }
        &self.row
    }

    /// Counted from 1; 0 before the first row.
    pub(super) fn number_of_row(&self) -> u64 {
        self.before + self.at as u64
    }

    pub(super) fn bytes_read(&self) -> u64 {
        let share = self.number_of_row() as f64 / self.rows.max(1) as f64;
        (self.bytes as f64 * share) as u64
    }
}
