//! The report of controllers over the same reference.

mod figures;
mod page;
mod reversal;
mod tracking;
mod view;

pub use tracking::{NamedTrace, TrackTable, Tracking};
pub(crate) use view::View;

#[cfg(test)]
mod fixture;
#[cfg(test)]
mod tests;
