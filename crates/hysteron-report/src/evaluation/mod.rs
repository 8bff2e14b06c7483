//! The report of an evaluation: its figures, their captions and the page.

mod captions;
mod dead_band;
mod figure;
mod figures;
mod instants;
mod page;
mod report;
mod source;
mod view;

pub use figure::Figure;
pub use figures::excitation_map;
pub use report::Report;

#[cfg(test)]
pub(crate) mod fixture;
#[cfg(test)]
mod tests;
