//! Functions over slices of numbers: turning points, filters, ranges, measures of error.

mod errors;
pub mod filter;
mod spread;
mod turning;

pub use errors::Errors;
pub use spread::{mean_and_deviation, range};
pub use turning::{Headings, NOISE, Turning, branches, headings, remembered, usual_tolerance};
