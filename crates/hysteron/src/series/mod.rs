//! Functions over slices of numbers, without any model.
//!
//! `turning` finds turning points and the direction of each sample. `filter` is the low-pass
//! filter. `errors` compares two series. `noise` estimates white noise, and `coarse` tells series
//! that jump from reading to reading. `spikes` finds isolated readings, `jumps` jumps and bursts of
//! wrong readings, `lost` all readings that are wrong, `frozen` a channel that stands still, and
//! `repeated` rows that come twice, and `clipped` an output that is cut off. `spread` gives range,
//! mean and standard deviation, `line` the line through pairs, `fair` the range that wrong readings
//! do not set. `runs` keeps values that change seldom.

pub(crate) mod clipped;
pub(crate) mod coarse;
mod errors;
mod fair;
pub mod filter;
pub(crate) mod frozen;
#[cfg(feature = "data")]
pub(crate) mod interpolate;
pub(crate) mod jumps;
mod line;
pub(crate) mod lost;
pub(crate) mod noise;
pub(crate) mod repeated;
mod runs;
pub(crate) mod spikes;
pub(crate) mod spread;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
pub(crate) mod test_series;
mod turning;

pub use clipped::CutOff;
pub use errors::Errors;
pub use fair::fair_range;
pub(crate) use fair::fair_range_of_all;
pub(crate) use line::Line;
pub(crate) use runs::Runs;
pub(crate) use spread::range_of_all;
pub use spread::{mean_and_deviation, range};
pub use turning::{Headings, NOISE, Turning, branches, headings, remembered, usual_tolerance};
pub(crate) use turning::{branch_spans, clear_branch_spans, clear_branches, different_branches};
