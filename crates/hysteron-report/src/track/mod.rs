//! The report of a comparison of controllers.

mod before_after;
mod captions;
mod comparison;
mod figure;
mod input;
mod page;
mod report;
mod reversal;
mod series;
mod view;
mod weights_time;

pub use comparison::write_comparison;
pub use report::{NamedTrace, TrackReport, TrackTable};

#[cfg(test)]
mod fixture;
#[cfg(test)]
mod tests;
