//! The report of an evaluation.

mod dead_band;
mod figures;
mod instants;
mod page;
mod source;
mod view;

pub use figures::excitation_map;
pub(crate) use view::View;

#[cfg(test)]
pub(crate) mod fixture;
#[cfg(test)]
mod tests;
