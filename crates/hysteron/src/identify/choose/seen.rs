//! The recordings that a choice sees.

use crate::recording::Recording;

/// The same samples at three places of a model.
#[derive(Debug, Clone, Copy)]
pub(in crate::identify) struct Seen<'a> {
    /// As the operators see them.
    pub(in crate::identify) operators: &'a [Recording],
    /// The same before the place of the levels bends the axis. Their branches are left out, so that
    /// every spacing is tested on the same samples.
    pub(in crate::identify) even: &'a [Recording],
    /// As measured. Simple rivals see these.
    pub(in crate::identify) measured: &'a [Recording],
}

impl<'a> From<&'a [Recording]> for Seen<'a> {
    /// Recordings that the operators see as they were measured.
    fn from(recordings: &'a [Recording]) -> Self {
        Self {
            operators: recordings,
            even: recordings,
            measured: recordings,
        }
    }
}
