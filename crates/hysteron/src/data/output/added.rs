//! Columns that commands add to tables, and their cells.

use std::ops::Range;

/// A column that is added to a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Added {
    /// A column of numbers, with its name.
    Numbers(&'static str),
    /// A column of words, with its name.
    Words(&'static str),
}

impl Added {
    /// The column's name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Numbers(name) | Self::Words(name) => name,
        }
    }
}

/// Cells of added columns, for rows that follow one another.
#[derive(Default)]
pub(crate) struct AddedCells {
    /// A series for each column of numbers; there is one at least.
    pub(crate) numbers: Vec<Vec<f64>>,
    /// The cells of the column of words, which is the last one, if there is one.
    pub(crate) words: Vec<&'static str>,
}

impl AddedCells {
    /// No cells of these columns.
    pub(crate) fn of(added: &[Added]) -> Self {
        let is_number = |column: &&Added| matches!(column, Added::Numbers(_));
        Self {
            numbers: vec![Vec::new(); added.iter().filter(is_number).count()],
            words: Vec::new(),
        }
    }

    /// Number of rows.
    pub(crate) fn len(&self) -> usize {
        self.numbers.first().map_or(0, Vec::len)
    }

    pub(crate) fn clear(&mut self) {
        self.numbers.iter_mut().for_each(Vec::clear);
        self.words.clear();
    }

    /// Adds the cells of these rows of others.
    pub(crate) fn extend(&mut self, others: &Self, rows: Range<usize>) {
        for (series, more) in self.numbers.iter_mut().zip(&others.numbers) {
            series.extend_from_slice(&more[rows.clone()]);
        }
        self.words
            .extend(others.words.get(rows).unwrap_or_default());
    }

    /// Adds the numbers of a row.
    #[inline]
    pub(crate) fn push(&mut self, numbers: &[f64]) {
        for (series, number) in self.numbers.iter_mut().zip(numbers) {
            series.push(*number);
        }
    }
}
