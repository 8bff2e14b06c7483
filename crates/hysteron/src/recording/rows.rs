//! Rows of a recording, as they are named to its user.

use super::Recording;
use crate::error::Place;
use std::fmt;
use std::ops::Range;

impl Recording {
    /// A sample, counted from 0, as its user is told of it: counted from 1, and where it stands in
    /// its file ([`Recording::place`]).
    ///
    /// ```
    /// let recording = hysteron::Recording::new(vec![0.0, 1.0], vec![0.0, 2.0])?;
    /// assert_eq!(recording.named(1), "sample 2"); // of a file: `sample 2 (line 3 of the file)`
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    #[must_use]
    pub fn named(&self, sample: usize) -> String {
        named(sample + 1, self.place(sample))
    }
}

/// A sample by its number, counted from 1, and where it stands in its file.
pub(crate) fn named(number: usize, place: Option<Place>) -> String {
    let place = place.map_or(String::new(), |place| format!(" ({place} of the file)"));
    format!("sample {number}{place}")
}

/// Rows that follow one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rows {
    /// The first one, counted from 1 as a sample of the recording.
    pub first: usize,
    /// The last one.
    pub last: usize,
    /// Where the two stand in the file, if rows count otherwise there: see [`Recording::place`].
    pub in_file: Option<(Place, Place)>,
}

impl Rows {
    pub(crate) fn new(recording: &Recording, samples: &Range<usize>) -> Self {
        let place = |sample| recording.place(sample);
        let last = samples.end.saturating_sub(1);
        Self {
            first: samples.start + 1,
            last: samples.end,
            in_file: place(samples.start).zip(place(last)),
        }
    }

    /// The same, of a recording that follows so many rows of others.
    pub(crate) fn after(self, before: usize) -> Self {
        Self {
            first: self.first + before,
            last: self.last + before,
            ..self
        }
    }

    /// The numbers of the first and the last.
    pub(crate) fn ends(self) -> (usize, usize) {
        (self.first, self.last)
    }
}

/// `12 to 30`, and where that is in the file.
impl fmt::Display for Rows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", self.first, self.last)?;
        match self.in_file {
            Some((Place::Line(first), Place::Line(last))) => {
                write!(f, " (lines {first} to {last} of the file)")
            }
            Some((
                Place::Row(first) | Place::Line(first),
                Place::Row(last) | Place::Line(last),
            )) => {
                write!(f, " (in the file {first} to {last})")
            }
            None => Ok(()),
        }
    }
}
