//! How well the data determine the weights: excitation, bootstrap, confidence.

pub(super) mod bootstrap;
pub(super) mod confidence;
pub(super) mod excitation;
