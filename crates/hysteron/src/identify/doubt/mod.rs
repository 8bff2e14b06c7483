//! How well the data determine the weights: excitation, spectrum, bootstrap, calibration,
//! confidence.

pub(super) mod bootstrap;
mod calibrate;
mod change;
pub(super) mod confidence;
pub(super) mod excitation;
pub(super) mod sessions;
pub(super) mod spectrum;
