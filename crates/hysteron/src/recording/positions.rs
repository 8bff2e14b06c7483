//! The positions of rows in their file. Nearly all rows follow one another, so runs are kept.

use crate::error::Place;
use serde::{Deserialize, Serialize};

/// The positions of rows, in the order of the rows.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    try_from = "(Vec<(usize, Place)>, usize)",
    into = "(Vec<(usize, Place)>, usize)"
)]
pub(crate) struct Positions {
    /// The number of the first row of each run, and its position.
    runs: Vec<(usize, Place)>,
    len: usize,
}

/// Bytes of a run.
#[cfg(feature = "data")]
pub(crate) const RUN: usize = size_of::<(usize, Place)>();

#[cfg(feature = "data")]
impl Positions {
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Bytes of memory that one more row may take now, if it does not follow the one before.
    pub(crate) fn growth(&self) -> usize {
        match self.runs.len() < self.runs.capacity() {
            true => 0,
            false => self.runs.capacity().max(4) * RUN,
        }
    }

    /// Adds the position of the next row.
    pub(crate) fn push(&mut self, place: Place) {
        let last = self.runs.last();
        if last.is_none_or(|run| place_in(*run, self.len) != place) {
            self.runs.push((self.len, place));
        }
        self.len += 1;
    }

    /// Adds so many rows, of which the first is at `place`.
    pub(crate) fn push_run(&mut self, place: Place, count: usize) {
        if count > 0 {
            self.push(place);
            self.len += count - 1;
        }
    }

    /// Drops the rows from `len` on.
    pub(crate) fn truncate(&mut self, len: usize) {
        self.runs
            .truncate(self.runs.partition_point(|(first, _)| *first < len));
        self.len = self.len.min(len);
    }

    /// Whether the rows are numbered in the file as here, from 1 on. Lines never are: they count
    /// the header too.
    pub(crate) fn count_from_one(&self) -> bool {
        matches!(self.runs[..], [] | [(0, Place::Row(1))])
    }

    /// The positions of rows that follow one another here.
    pub(crate) fn part(&self, rows: std::ops::Range<usize>) -> Self {
        rows.map(|row| self.at(row)).collect()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = Place> {
        (0..self.len).map(|row| self.at(row))
    }
}

impl Positions {
    /// The position of a row that was added.
    pub(crate) fn at(&self, row: usize) -> Place {
        let run = self.runs.partition_point(|(first, _)| *first <= row) - 1;
        place_in(self.runs[run], row)
    }

    /// The position of a sample, if there are so many samples as rows.
    pub(super) fn of_sample(&self, sample: usize, samples: usize) -> Option<Place> {
        (self.len == samples && sample < samples).then(|| self.at(sample))
    }
}

#[cfg(feature = "data")]
impl FromIterator<Place> for Positions {
    fn from_iter<I: IntoIterator<Item = Place>>(places: I) -> Self {
        let mut all = Self::default();
        places.into_iter().for_each(|place| all.push(place));
        all
    }
}

impl From<Positions> for (Vec<(usize, Place)>, usize) {
    fn from(positions: Positions) -> Self {
        (positions.runs, positions.len)
    }
}

impl TryFrom<(Vec<(usize, Place)>, usize)> for Positions {
    type Error = &'static str;

    fn try_from((runs, len): (Vec<(usize, Place)>, usize)) -> Result<Self, Self::Error> {
        let mut firsts = runs.iter().map(|run| run.0);
        let ascend = firsts.clone().chain([len]).is_sorted_by(|a, b| a < b);
        match ascend && firsts.next() == (len > 0).then_some(0) {
            true => Ok(Self { runs, len }),
            false => Err("runs of rows that do not follow one another"),
        }
    }
}

/// The position of a row in a run that begins before it.
fn place_in((first, place): (usize, Place), row: usize) -> Place {
    let after = (row - first) as u64;
    match place {
        Place::Line(line) => Place::Line(line.saturating_add(after)),
        Place::Row(number) => Place::Row(number.saturating_add(after)),
    }
}

#[cfg(test)]
#[cfg(feature = "data")]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    #[test]
    fn runs_are_rows_that_follow_one_another() {
        let mut positions = Positions::default();
        for (place, count) in [(Place::Row(4), 3), (Place::Row(1), 0), (Place::Row(7), 2)] {
            positions.push_run(place, count);
        }
        assert!(positions.iter().eq((4..9).map(Place::Row)));
        assert_eq!(positions.runs.len(), 1);
    }

    /// Whatever is read, the position of each row can be told.
    #[test]
    fn runs_that_do_not_follow_one_another_are_refused() {
        let mut random = ChaCha8Rng::seed_from_u64(12);
        let mut read = 0;
        for _ in 0..5000 {
            let mut number = || random.next_u32() as usize % 4;
            let runs = (0..number()).map(|_| (number(), Place::Line(u64::MAX - 1)));
            let runs: Vec<(usize, Place)> = runs.collect();
            if let Ok(positions) = Positions::try_from((runs, number())) {
                assert_eq!(positions.iter().count(), positions.len());
                read += 1;
            }
        }
        assert!(read > 500, "{read}");
    }

    #[test]
    fn positions_are_those_that_were_added() {
        let mut random = ChaCha8Rng::seed_from_u64(11);
        for _ in 0..1000 {
            let mut place = 0;
            let places = (0..random.next_u32() % 50).map(|_| {
                place = match random.next_u32() % 8 {
                    0 => u64::from(random.next_u32() % 60),
                    _ => place + 1,
                };
                match random.next_u32() % 16 {
                    0 => Place::Row(place),
                    _ => Place::Line(place),
                }
            });
            let places: Vec<Place> = places.collect();
            let mut kept: Positions = places.iter().copied().collect();
            assert_eq!(kept.len(), places.len());
            assert!(kept.iter().eq(places.iter().copied()), "{places:?}");
            let text = serde_json::to_string(&kept).unwrap();
            assert_eq!(serde_json::from_str::<Positions>(&text).unwrap(), kept);
            let left = random.next_u32() as usize % 60;
            kept.truncate(left);
            assert!(
                kept.iter().eq(places.iter().copied().take(left)),
                "{places:?}"
            );
            kept.push(Place::Line(7));
            assert_eq!(kept.at(kept.len() - 1), Place::Line(7));
        }
    }
}
