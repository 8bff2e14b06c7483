//! What is worth knowing about how a file was understood.

use crate::error::Place;
use std::fmt;

/// What was assumed in reading a file, for the reader of a message to judge.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Remark {
    /// The text is not UTF-8 and was decoded from this encoding.
    Encoding(&'static str),
    /// Lines above the header were skipped.
    Preamble {
        /// How many.
        lines: u64,
        /// The names that were found below them, shortened.
        header: String,
    },
    /// There is no header row: columns go by their number, from 1.
    Unnamed {
        /// Lines above the first row.
        above: u64,
        /// How many columns there are.
        columns: usize,
    },
    /// A column was found by another name than its own.
    Found {
        /// The name that was asked for.
        asked: String,
        /// Its own.
        column: String,
    },
    /// Commas that could stand between thousands were read as decimal.
    DecimalComma {
        /// The first such number as it was read.
        number: String,
        /// Its column.
        column: String,
        /// Where it is.
        place: Place,
    },
    /// The time was turned into seconds.
    Time {
        /// Its column.
        column: String,
        /// Its unit.
        unit: String,
    },
    /// The time has no unit, and is odd as seconds.
    DoubtfulTime {
        /// Its column.
        column: String,
        /// Median time between samples.
        step: f64,
        /// From the first to the last sample.
        duration: f64,
    },
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Encoding(name) => write!(f, "the text is not UTF-8: read as {name}"),
            Self::Preamble { lines, header } => write!(
                f,
                "{lines} {} above the header skipped; line {} is the header: {header}",
                if *lines == 1 { "line" } else { "lines" },
                lines + 1
            ),
            Self::Unnamed { above, columns } => write!(
                f,
                "no header row: the table begins in line {}, and its columns go by number, 1 to {columns}",
                above + 1
            ),
            Self::Found { asked, column } => {
                write!(f, "`{asked}` is taken for the column `{column}`")
            }
            Self::DecimalComma {
                number,
                column,
                place,
            } => write!(
                f,
                "{place}, column `{column}`: commas are read as decimal, so that this is {number}; \
                 if they stand between thousands, write the numbers without them"
            ),
            Self::Time { column, unit } => {
                write!(
                    f,
                    "the time in column `{column}` is in {unit}: turned into seconds"
                )
            }
            Self::DoubtfulTime {
                column,
                step,
                duration,
            } => write!(
                f,
                "the time in column `{column}` has no unit and is taken as seconds: a step of {step} s, {duration} s in all; \
                 if it is in another unit, say so in its name, as in `time [ms]`"
            ),
        }
    }
}
