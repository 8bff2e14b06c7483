//! The recordings of a file: several where its clock says so, and how they are shown.

use super::fault::Fault;
use hysteron::{Place, Recording, Segment, one_after_the_other};
use std::borrow::Cow;
use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

/// Recordings of one experiment, in the order of the file.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    /// What is shown: the recordings one after the other.
    pub(super) shown: Arc<Recording>,
    /// The recordings, where there are several.
    several: Arc<[Recording]>,
    /// Where each of them stands in the file.
    stands: Arc<[Stands]>,
}

/// Where a recording was read from its file.
#[derive(Debug, Clone, Copy)]
struct Stands {
    first: Place,
    last: Place,
    samples: usize,
}

impl Stands {
    /// The place of a sample. `None` where samples are not the rows any more, as in equal steps.
    fn of(self, recording: &Recording, sample: usize) -> Option<Place> {
        let (Place::Line(first) | Place::Row(first), Place::Line(last) | Place::Row(last)) =
            (self.first, self.last);
        let is_run = last.checked_sub(first) == Some((self.samples as u64).saturating_sub(1));
        match (recording.len() == self.samples, is_run, self.first) {
            (false, ..) => None,
            (true, true, Place::Row(first)) => Some(Place::Row(first + sample as u64)),
            (true, ..) => recording.place(sample),
        }
    }
}

impl Parts {
    /// # Errors
    /// [`Fault`] for no recordings.
    fn new(mut recordings: Vec<Recording>, stands: Arc<[Stands]>) -> Result<Self, Fault> {
        let shown = match recordings.len() {
            1 => recordings.pop(),
            _ => one_after_the_other(&recordings).map(Cow::into_owned),
        };
        let shown = shown.ok_or_else(|| Fault::defect("a file has no recording"))?;
        Ok(Self {
            shown: Arc::new(shown),
            several: recordings.into(),
            stands,
        })
    }

    /// The same recordings after their preparation.
    pub(super) fn prepared(&self, recordings: Vec<Recording>) -> Result<Self, Fault> {
        Self::new(recordings, self.stands.clone())
    }

    pub(super) fn of_segments(segments: Vec<Segment>) -> Result<Self, Fault> {
        let stands = segments.iter().map(|part| Stands {
            first: part.first,
            last: part.last,
            samples: part.recording.len(),
        });
        let stands = stands.collect();
        let recordings = segments.into_iter().map(|part| part.recording);
        Self::new(recordings.collect(), stands)
    }

    /// Where a sample, counted from 0 among those shown, stands in the file. `None` where a
    /// preparation has made other samples.
    pub(super) fn place(&self, n: usize) -> Option<Place> {
        let parts = self.all().iter().zip(self.begins()).zip(&*self.stands);
        let ((recording, begin), stands) =
            parts.take_while(|((_, begin), _)| *begin <= n).last()?;
        stands.of(recording, n - begin)
    }

    pub(super) fn all(&self) -> &[Recording] {
        match &self.several[..] {
            [] => std::slice::from_ref(&*self.shown),
            several => several,
        }
    }

    /// The first sample of each recording, among those shown.
    pub(super) fn begins(&self) -> impl Iterator<Item = usize> {
        let mut end = 0;
        self.all().iter().map(move |recording| {
            let begin = end;
            end += recording.len();
            begin
        })
    }

    /// Memory of the numbers.
    pub(super) fn size(&self) -> u64 {
        let several = self.several.iter().map(numbers_of);
        several.sum::<u64>() + numbers_of(&self.shown)
    }
}

/// Memory of the numbers of a recording.
pub(super) fn numbers_of(recording: &Recording) -> u64 {
    let series = 2 + u64::from(recording.time.is_some()) + u64::from(recording.load.is_some());
    series * (size_of::<f64>() * recording.len()) as u64
}

/// A number for samples, the same for the same ones.
pub(super) fn number<'a>(recordings: impl Iterator<Item = &'a Recording>) -> u64 {
    let mut hasher = DefaultHasher::new();
    for recording in recordings {
        for value in recording.input.iter().chain(&recording.output) {
            hasher.write_u64(value.to_bits());
        }
    }
    hasher.finish()
}
