//! Rows of a recording that cannot be used as they are: what is done about them, and how it is
//! reported.

use crate::data::table::Remark;
use crate::error::Place;
use std::fmt;

/// What to do with rows that cannot be used as they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Repair {
    /// Refuse them, with an error that lists their positions.
    #[default]
    Refuse,
    /// Drop rows without a number, with more or fewer cells than the header, that stand twice, or
    /// whose time alone is wrong. Where the clock goes back, another segment begins
    /// ([`Recording::read_segments`](crate::Recording::read_segments)). Rows keep their order.
    Mend,
}

/// A note about a recording: a repair, or a remark on how the file was understood.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// A note about rows.
    Rows {
        /// The kind of the note.
        kind: NoteKind,
        /// The rows.
        places: Places,
    },
    /// A remark on how the file was understood.
    File(Remark),
}

/// The kinds of notes about rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoteKind {
    /// More or fewer cells than in the header: dropped.
    Ragged,
    /// No finite number in a column that was asked for: dropped.
    Dropped,
    /// A reading that the loop of a log did not believe: left out.
    Held,
    /// The same time and values as a row before: dropped.
    Copied,
    /// A time that fits none of the rows around, which fit each other: dropped.
    Alone,
    /// Time equal to that of the row before, with other values: kept.
    Repeated,
    /// Time goes back: another segment begins.
    Back,
    /// Input and output have times of their own: the output was interpolated at the times of the
    /// input.
    Interpolated,
    /// More than three times the median step since the row before: not changed.
    Gap,
    /// A gap in which the input may have turned unseen: another segment begins.
    LongGap,
}

impl NoteKind {
    /// What is wrong with rows of this kind, if they were not repaired.
    pub(super) fn fault(self) -> &'static str {
        match self {
            Self::Ragged => "with more or fewer cells than the header",
            Self::Dropped => "without a number",
            Self::Held => "whose reading the loop did not believe",
            Self::Copied => "standing there before",
            Self::Alone => "with a time that fits none around",
            Self::Repeated => "at the time of the row before",
            Self::Back => "going back in time",
            Self::Interpolated => "of an output with times of its own",
            Self::Gap => "after a gap of over three times the median time step",
            Self::LongGap => "after a gap in which the input may have turned",
        }
    }

    fn mended(self) -> &'static str {
        match self {
            Self::Ragged | Self::Dropped | Self::Held | Self::Copied | Self::Alone => ": dropped",
            Self::Repeated => ": kept",
            Self::Back | Self::LongGap => ": a segment begins, with a history of its own",
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

/// Number of rows of a kind, and the positions of the first few.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Places {
    /// Number of rows.
    pub count: u64,
    /// Positions of the first few rows.
    pub first: Vec<Place>,
}

impl Places {
    /// Number of rows that are listed.
    const NAMED: usize = 3;

    /// Adds all of `other`.
    pub(super) fn add(&mut self, other: &Self) {
        let room = Self::NAMED.saturating_sub(self.first.len());
        self.first.extend(other.first.iter().take(room));
        self.count += other.count;
    }

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
