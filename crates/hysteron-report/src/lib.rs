//! Figures and a self-contained HTML page from the evaluation of a model on a recording, or from runs of controllers.
//!
//! [`Report::write`] draws the figures that the chapter on the MKP model shows in its section 6, for any recording, each as
//! SVG and PNG, and puts them on one page, `index.html`, that needs nothing beside it. [`Report::svg`] draws a single figure.
//!
//! [`TrackReport::write`] does the same for control loops: one run of each controller over the same reference.
//!
//! The figures stay legible in grey: curves differ in line style and lightness, never in colour alone.

mod captions;
mod dead_band;
mod decimate;
mod draw;
mod error;
mod figure;
mod figures;
mod files;
mod frame;
mod instants;
mod number;
mod page;
mod plane;
mod png;
mod quantity;
mod report;
mod source;
mod track;
mod view;

pub use error::ReportError;
pub use figure::Figure;
pub use figures::excitation_map;
pub use report::Report;
pub use track::{NamedTrace, TrackReport, TrackTable, write_comparison};

#[cfg(test)]
mod fixture;
#[cfg(test)]
mod tests;
