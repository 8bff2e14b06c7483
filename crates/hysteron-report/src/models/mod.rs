//! Models beside each other on one recording: residuals over time, over the input, and as
//! histograms.

mod page;
mod report;
mod view;

pub use report::{ModelsReport, NamedForward};

#[cfg(test)]
mod tests;
