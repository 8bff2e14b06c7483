//! What the data determined, and how well: excitation, bootstrap, confidence.

pub(super) mod bootstrap;
pub(super) mod confidence;
pub(super) mod excitation;
