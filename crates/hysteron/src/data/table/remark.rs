//! Remarks about how a file was understood.

use crate::error::Place;
use std::fmt;

/// An assumption made while a file was read. The user can judge whether it is right.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Remark {
    /// The text is not UTF-8 and was decoded from this encoding.
    Encoding(&'static str),
    /// Lines above the header were skipped.
    Preamble {
        /// Number of lines.
        lines: u64,
        /// The names in the header below them, shortened.
        header: String,
    },
    /// There is no header row. Columns are numbered from 1.
    Unnamed {
        /// Number of lines above the first row.
        above: u64,
        /// Number of columns.
        columns: usize,
    },
    /// A column was found by another name than its own.
    Found {
        /// The name that was asked for.
        asked: String,
        /// The name of the column.
        column: String,
    },
    /// Commas that could separate thousands were read as decimal commas.
    DecimalComma {
        /// The first such number as it was read.
        number: String,
        /// Its column.
        column: String,
        /// Its position.
        place: Place,
    },
    /// The time was converted to seconds.
    Time {
        /// Its column.
        column: String,
        /// Its unit in the file.
        unit: String,
    },
    /// The time is a date or a time of day, and was converted to seconds from the first row.
    Dated {
        /// Its column.
        column: String,
        /// The first one as it is in the file, shortened.
        first: String,
        /// For numbers since 1970, their unit.
        unit: Option<String>,
    },
    /// The time has no unit and would be unusual in seconds.
    DoubtfulTime {
        /// Its column.
        column: String,
        /// Median time between samples, if the unit is seconds.
        step: f64,
        /// Time from the first to the last sample, if the unit is seconds.
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
                "no header row: the table begins in line {}, and its columns go by number, \
                 1 to {columns}",
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
            Self::Dated {
                column,
                first,
                unit,
            } => match unit {
                None => write!(
                    f,
                    "the times in column `{column}` are timestamps: read as seconds from the \
                     first one, {first}"
                ),
                Some(unit) => write!(
                    f,
                    "the times in column `{column}` are in {unit} since 1970: read as seconds \
                     from the first one, {first}"
                ),
            },
            Self::DoubtfulTime {
                column,
                step,
                duration,
            } => write!(
                f,
                "the time in column `{column}` has no unit and is taken as seconds: \
                 a step of {step} s, {duration} s in all; \
                 if it is in another unit, say so in its name, as in `time [ms]`"
            ),
        }
    }
}
