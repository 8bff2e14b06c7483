//! Figures and a self-contained HTML page from the evaluation of a model on a recording, or from
//! runs of controllers.
//!
//! [`Report::write`] draws the figures that the chapter on the MKP model shows in its section 6,
//! for any recording, each as SVG and PNG, and puts them on one page, `index.html`, that needs
//! nothing beside it. [`Report::svg`] draws a single figure.
//!
//! [`TrackReport::write`] does the same for control loops: one run of each controller over the same
//! reference. [`ModelsReport::write`] puts the residuals of several models beside each other,
//! and [`FleetReport::write`] shows which actuators of a fleet are unlike the others.
//!
//! The figures stay legible in grey: curves differ in line style and lightness, never in colour
//! alone.

mod clock;
pub mod decimate;
mod draw;
mod error;
mod evaluation;
mod fleet;
mod frame;
mod linked;
mod made;
mod models;
mod number;
mod panels;
mod plane;
mod png;
mod quantity;
mod residuals;
mod stack;
mod track;

pub use error::ReportError;
pub use evaluation::{Figure, Report, excitation_map};
pub use fleet::FleetReport;
pub use linked::plotly;
pub use made::Made;
pub use models::{ModelsReport, NamedForward};
pub use track::{NamedTrace, TrackReport, TrackTable, write_comparison};
