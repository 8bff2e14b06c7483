//! Figures and a self-contained HTML page from the evaluation of a model on a recording, or from
//! runs of controllers.
//!
//! A [`Report`] draws what is [`Shown`], each figure as SVG and (with the feature `png`, on by
//! default) as PNG, and puts the figures on one page, `index.html`, that needs nothing beside it:
//! those that the chapter on the MKP model has in its section 6, for any recording; residuals of
//! several models beside each other; runs of controllers over one reference; the actuators of a
//! fleet that are unlike the others.
//! [`Report::svg`] draws a single figure.
//!
//! The figures stay legible in grey: curves differ in line style and lightness, never in colour
//! alone.

mod clock;
mod comparison;
pub mod decimate;
mod draw;
mod error;
mod evaluation;
mod figure;
mod fleet;
mod layout;
mod linked;
mod made;
mod models;
mod number;
mod panels;
mod plane;
#[cfg(feature = "png")]
mod png;
mod quantity;
mod report;
mod residuals;
mod subject;
mod track;

pub use comparison::write_comparison;
pub use error::ReportError;
pub use evaluation::excitation_map;
pub use linked::plotly;
pub use made::Made;
pub use models::NamedForward;
pub use report::{Report, Shown};
pub use track::{NamedTrace, TrackTable, Tracking};
