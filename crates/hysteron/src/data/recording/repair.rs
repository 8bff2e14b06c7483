//! Rows of a recording that cannot be used as they are, and what is done about them.

use crate::data::table::Remark;
use crate::error::Place;
use std::fmt;

/// What becomes of rows that cannot be used as they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Repair {
    /// They are refused, with their places.
    #[default]
    Refuse,
    /// Those without a number, or with more or fewer cells than the header, are dropped; those
    /// whose times go back are sorted; those at one time become one, with the mean of their values.
    Mend,
}

/// What was noted about a recording: it was mended, or is worth knowing.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// Of its rows.
    Rows {
        /// What it is.
        kind: NoteKind,
        /// The rows.
        places: Places,
    },
    /// Of how its file was understood.
    File(Remark),
}

/// What can be noted about rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoteKind {
    /// There are more or fewer cells than in the header: dropped.
    Ragged,
    /// There is no finite number in a column that was asked for: dropped.
    Dropped,
    /// The time goes back: sorted.
    Sorted,
    /// The time is that of the row before: merged to the mean.
    Merged,
    /// Input and output have times of their own: the output was interpolated onto the input's.
    Interpolated,
    /// More than three times the median step has passed since the row before: left as it is.
    Gap,
}

impl NoteKind {
    /// What is wrong with so many rows that were not mended.
    pub(super) fn fault(self) -> &'static str {
        match self {
            Self::Ragged => "with more or fewer cells than the header",
            Self::Dropped => "without a number",
            Self::Sorted => "going back in time",
            Self::Merged => "at the time of the row before",
            Self::Interpolated => "of an output with times of its own",
            Self::Gap => "after a gap of over three times the median time step",
        }
    }

    fn mended(self) -> &'static str {
        match self {
            Self::Ragged | Self::Dropped => ": dropped",
            Self::Sorted => ": sorted",
            Self::Merged => ": merged to their mean",
            Self::Interpolated => ": interpolated onto the times of the input",
            Self::Gap => "",
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rows { kind, places } => {
                write!(f, "{places} {}{}", kind.fault(), kind.mended())
            }
            Self::File(remark) => remark.fmt(f),
        }
    }
}

/// How many rows there are of a kind, and the first of them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Places {
    /// How many.
    pub count: u64,
    /// The first few.
    pub first: Vec<Place>,
}

impl Places {
    /// How many are named.
    const NAMED: usize = 3;

    pub(crate) fn push(&mut self, place: Place) {
        self.count += 1;
        if self.first.len() < Self::NAMED {
            self.first.push(place);
        }
    }
}

impl FromIterator<Place> for Places {
    fn from_iter<I: IntoIterator<Item = Place>>(places: I) -> Self {
        let mut all = Self::default();
        places.into_iter().for_each(|place| all.push(place));
        all
    }
}

impl fmt::Display for Places {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |place: &Place| match place {
            Place::Line(n) | Place::Row(n) => n.to_string(),
        };
        let numbers: Vec<String> = self.first.iter().map(number).collect();
        let word = match (self.first.first(), self.count) {
            (Some(Place::Line(_)), 1) => "line",
            (Some(Place::Line(_)), _) => "lines",
            (_, 1) => "row",
            _ => "rows",
        };
        let more = self.count - self.first.len() as u64;
        match (&numbers[..], more) {
            ([before @ .., last], 0) if !before.is_empty() => {
                write!(f, "{word} {} and {last}", before.join(", "))
            }
            (_, 0) => write!(f, "{word} {}", numbers.join(", ")),
            _ => write!(f, "{word} {} and {more} more", numbers.join(", ")),
        }
    }
}
