//! A table as a user sees it first: its columns, a small picture of each, and their roles.

use crate::data::roles::{Columns, Roles, Series, of_columns};
use crate::data::table::{Column, TableReader, is_timestamp};
use crate::data::{ColumnSummary, TableSummary};
use crate::error::Result;
use serde::Serialize;

/// A table as a user sees it first: its columns with a small picture each, and a guess of their
/// roles.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TablePreview {
    /// Rows and columns.
    #[serde(flatten)]
    pub table: TableSummary,
    /// For each column its course: the smallest and the largest number in each of at most
    /// [`PICTURE`] equal parts of the rows. A part without a number is `None`.
    pub pictures: Vec<Vec<Option<(f64, f64)>>>,
    /// The guess.
    pub roles: Roles,
}

/// Parts of the rows in a picture of a column.
pub const PICTURE: usize = 96;

/// Reads `table` to its end, keeps a picture of each column, and guesses the roles.
///
/// ```
/// let text = "time [s],T [degC],lift [mm]\n0,20,0\n1,50,3\n2,80,14\n3,50,9\n";
/// let mut table = hysteron::TableReader::from_bytes("run.csv", text, 1 << 20)?;
/// let roles = hysteron::preview_table(&mut table)?.roles;
/// assert_eq!(roles.time.as_deref(), Some("time [s]"));
/// assert_eq!(roles.input.as_deref(), Some("T [degC]"));
/// assert_eq!(roles.output.as_deref(), Some("lift [mm]"));
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// As [`crate::inspect_table`].
pub fn preview_table(table: &mut TableReader) -> Result<TablePreview> {
    preview_table_knowing(table, [None; 4])
}

/// As [`preview_table`], where some columns are known: those of input, output, time and load. They are
/// not guessed to be anything else.
///
/// # Errors
/// As [`preview_table`].
pub fn preview_table_knowing(
    table: &mut TableReader,
    known: [Option<Column>; 4],
) -> Result<TablePreview> {
    let count = table.header().len();
    // Each is there twice: while the rows pass, and for the one who asked.
    take(table, 2 * count * size_of::<Course>())?;
    let mut columns: Vec<Course> = table.header().iter().map(|_| Course::default()).collect();
    let places: Vec<_> = table.columns().collect();
    let mut rows = 0;
    while table.advance()? {
        if rows < 2 * PICTURE as u64 {
            take(table, 2 * count * size_of::<Option<(f64, f64)>>())?;
        }
        rows += 1;
        for (course, &place) in columns.iter_mut().zip(&places) {
            let value = table.value(place);
            if value.is_none() && course.stamps == course.missing {
                let stamp = table.text(place).is_some_and(is_timestamp);
                course.stamps += u64::from(stamp);
            }
            course.push(value);
        }
    }
    let named = table.header().iter().zip(&columns);
    let summaries = named.map(|(name, course)| ColumnSummary {
        name: name.clone(),
        min: course.numbers().then_some(course.min),
        max: course.numbers().then_some(course.max),
        not_numbers: course.missing,
    });
    let summaries = summaries.collect();
    let units = places.iter().map(|&place| table.unit(place));
    let named = table.header().iter().zip(units).zip(&columns);
    let named = named.map(|((name, unit), course)| (name.as_str(), unit, course.series()));
    let roles = of_columns(
        &named.collect::<Columns<'_>>(),
        known.map(|column| column.map(Column::place)),
    );
    Ok(TablePreview {
        table: TableSummary {
            rows,
            columns: summaries,
        },
        pictures: columns.iter().map(Course::picture).collect(),
        roles,
    })
}

/// Takes memory for the pictures of all columns.
fn take(table: &mut TableReader, bytes: usize) -> Result<()> {
    let taken = table
        .budget()
        .take(bytes as u128, "a preview of its columns");
    taken.map_err(|problem| table.fault_at(None, None, problem))
}

/// A load that changes by less than this share of its size is constant.
const CHANGES: f64 = 0.2;

/// Steps that differ by less than this share are even.
const EVEN: f64 = 0.3;

/// What is kept of a column while its rows pass.
#[derive(Debug, Clone)]
struct Course {
    min: f64,
    max: f64,
    count: u64,
    missing: u64,
    /// Cells that are timestamps, as long as all that are no numbers are.
    stamps: u64,
    last: f64,
    /// The last step, how many went down and up, and how many of those up were as the one before.
    step: f64,
    falling: u64,
    rising: u64,
    even: u64,
    parts: Vec<Option<(f64, f64)>>,
    /// Rows in each part, and in the last one so far.
    size: u64,
    filled: u64,
}

impl Default for Course {
    fn default() -> Self {
        Self {
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            count: 0,
            missing: 0,
            stamps: 0,
            last: f64::NAN,
            step: f64::NAN,
            falling: 0,
            rising: 0,
            even: 0,
            parts: Vec::new(),
            size: 1,
            filled: 1,
        }
    }
}

impl Course {
    fn push(&mut self, value: Option<f64>) {
        if self.filled == self.size {
            if self.parts.len() == 2 * PICTURE {
                // Two parts become one, so that the number of rows need not be known.
                let pairs = self.parts.chunks(2);
                self.parts = pairs
                    .map(|pair| pair.iter().copied().fold(None, joined))
                    .collect();
                self.size *= 2;
            }
            self.parts.push(None);
            self.filled = 0;
        }
        self.filled += 1;
        let Some(value) = value else {
            self.missing += 1;
            return;
        };
        if let Some(part) = self.parts.last_mut() {
            *part = joined(*part, Some((value, value)));
        }
        let step = value - self.last;
        self.falling += u64::from(step < 0.0);
        if step > 0.0 {
            self.rising += 1;
            self.even += u64::from((step - self.step).abs() <= EVEN * step);
        }
        (self.last, self.step) = (value, step);
        self.count += 1;
        (self.min, self.max) = (self.min.min(value), self.max.max(value));
    }

    fn numbers(&self) -> bool {
        self.count > 0
    }

    /// What the values tell of its role.
    fn series(&self) -> Series {
        let steps = self.count.saturating_sub(1);
        let most = |count: u64, of: u64| of > 0 && 20 * count >= 19 * of;
        Series {
            moves: self.numbers() && self.max > self.min,
            rises: 20 * self.falling <= steps,
            falls: 20 * self.rising <= steps,
            rises_evenly: most(self.rising, steps) && 10 * self.even >= 8 * steps.saturating_sub(1),
            stamps: self.missing > 0 && self.count == 0 && most(self.stamps, self.missing),
            changes: self.max - self.min > CHANGES * self.min.abs().max(self.max.abs()),
        }
    }

    fn picture(&self) -> Vec<Option<(f64, f64)>> {
        let each = self.parts.len().div_ceil(PICTURE).max(1);
        let parts = self.parts.chunks(each);
        parts
            .map(|part| part.iter().copied().fold(None, joined))
            .collect()
    }
}

fn joined(a: Option<(f64, f64)>, b: Option<(f64, f64)>) -> Option<(f64, f64)> {
    match (a, b) {
        (Some(a), Some(b)) => Some((a.0.min(b.0), a.1.max(b.1))),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_small_and_keeps_every_peak() {
        let mut course = Course::default();
        for n in 0..100_003 {
            course.push((n % 7 != 0).then_some(if n == 54_321 { 9.0 } else { 0.0 }));
        }
        let picture = course.picture();
        assert!(picture.len() <= PICTURE, "{}", picture.len());
        assert_eq!(
            picture
                .iter()
                .flatten()
                .filter(|part| part.1 == 9.0)
                .count(),
            1
        );
    }
}
