//! What a step does to a recording: one series changes, or all are resampled.

use crate::recording::Recording;

pub(super) enum Change {
    Input(Vec<f64>),
    Output(Vec<f64>),
    /// Other samples in time.
    Resampled(Box<Recording>),
}

impl Change {
    /// Makes the change. What was before is then in here, so that doing it again undoes it.
    pub(super) fn swap(&mut self, work: &mut Recording) {
        match self {
            Self::Input(values) => std::mem::swap(values, &mut work.input),
            Self::Output(values) => std::mem::swap(values, &mut work.output),
            Self::Resampled(recording) => std::mem::swap(&mut **recording, work),
        }
    }

    /// The input with the change.
    pub(super) fn input<'a>(&'a self, work: &'a Recording) -> &'a [f64] {
        match self {
            Self::Input(values) => values,
            Self::Output(_) => &work.input,
            Self::Resampled(recording) => &recording.input,
        }
    }

    /// The samples that differ; all, if the times are others.
    pub(super) fn samples(&self, work: &Recording) -> Vec<usize> {
        let (old, new) = match self {
            Self::Input(values) => (&work.input, values),
            Self::Output(values) => (&work.output, values),
            Self::Resampled(recording) => return (0..recording.len()).collect(),
        };
        let pairs = old.iter().zip(new).enumerate();
        pairs.filter(|(_, (a, b))| a != b).map(|(n, _)| n).collect()
    }
}
