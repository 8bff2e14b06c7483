//! Identification: finds the weights of a model from recordings.
//!
//! `fit` is the entry point; `options` are its settings, `words` the same as texts. `weights`
//! solves the least-squares problem. First `delay` finds the dead time and `outliers` wrong
//! readings. `choose` selects levels and smoothness. `doubt` estimates how well the data determine
//! the weights. `stages` identifies the thermal body in front of the operators; `heated` looks for
//! one that nobody asked for, and `warm_start` for the drive before a recording. `chosen` hands
//! choices on to other fits. `monotone` tells data that the model cannot follow.

mod changed;
mod choose;
#[cfg(feature = "data")]
mod chosen;
mod delay;
mod doubt;
mod fit;
mod fixed;
mod heated;
mod history;
mod initial;
pub(crate) mod kept;
mod monotone;
mod neighbours;
mod options;
mod outliers;
mod prior;
mod rest;
mod stages;
mod warm_start;
mod weights;
mod words;

pub use choose::left_out::{LeftOut, left_out};
pub(crate) use choose::left_out::{predicted_from, predicted_without};
pub(crate) use choose::start::MANY_OPEN;
pub use choose::start::usual_start;
pub use choose::validate::{Candidates, cross_validate};
#[cfg(feature = "data")]
pub use chosen::Chosen;
pub(crate) use doubt::excitation::Unresolved;
pub use doubt::excitation::excitation;
pub(crate) use doubt::spectrum::determined;
pub use fit::Fit;
pub(crate) use fixed::fit_weights;
pub(crate) use history::find_start;
pub(crate) use initial::Initial;
pub use monotone::{AGAINST_INPUT, way_against_input};
pub(crate) use options::SOME_SMOOTHNESS;
pub use options::{Auto, Choice, Dynamics, FitOptions, LoadLaw, Spacing, Thermal};
pub use prior::WeightPrior;
pub(crate) use rest::find_rest;
pub(crate) use stages::AFTER;
pub use stages::SpacingShape;
pub use warm_start::rested_words;
pub use weights::experiment::plane_of;
pub(crate) use weights::pivoting;
pub(crate) use weights::rows::Term;
pub(crate) use weights::sparse::{BranchSums, SparseForm, Square};
pub use words::{FIT_OPTIONS, FitOption};
