//! The recordings of a file: several where its clock says so, and how they are shown.

use super::fault::Fault;
use hysteron::{Recording, Segment, one_after_the_other};
use std::borrow::Cow;
use std::sync::Arc;

/// Recordings of one experiment, in the order of the file.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    /// What is shown: the recordings one after the other.
    pub(super) shown: Arc<Recording>,
    /// The recordings, where there are several.
    several: Arc<[Recording]>,
}

impl Parts {
    /// # Errors
    /// [`Fault`] for no recordings.
    pub(super) fn new(mut recordings: Vec<Recording>) -> Result<Self, Fault> {
        let shown = match recordings.len() {
            1 => recordings.pop(),
            _ => one_after_the_other(&recordings).map(Cow::into_owned),
        };
        let shown = shown.ok_or_else(|| Fault::defect("a file has no recording"))?;
        Ok(Self {
            shown: Arc::new(shown),
            several: recordings.into(),
        })
    }

    pub(super) fn of_segments(segments: Vec<Segment>) -> Result<Self, Fault> {
        Self::new(segments.into_iter().map(|part| part.recording).collect())
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
