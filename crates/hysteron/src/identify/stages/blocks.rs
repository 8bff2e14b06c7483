//! Blocks of time that are left out in turn, to tell whether a stage predicts what it has not seen.

use crate::model::Smooth;
use crate::recording::Recording;

/// Each recording is divided into so many blocks; those with an odd number are left out first, then
/// the others.
pub(in crate::identify) const BLOCKS: usize = 6;

/// A stage has to reduce the error on blocks left out by this share. Blocks of one recording are
/// less different than recordings are: on a valve, creep that gained 7 % on blocks left out lost
/// 13 % on a recording at another frequency.
pub(in crate::identify) const WORTH: f64 = 0.1;

/// Smoothness of the weights in the search, so that operators that a block left out do not run
/// away.
pub(in crate::identify) const SMOOTH: Smooth = Smooth {
    along: 0.0,
    across: 1e-6,
};

/// The block of each sample of a recording.
pub(in crate::identify) fn blocks(one: &Recording, count: usize) -> impl Iterator<Item = usize> {
    let samples = one.len();
    (0..samples).map(move |n| n * count / samples)
}
