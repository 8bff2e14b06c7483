//! Identification: the weights of a model from recordings.

mod advice;
mod choose;
mod doubt;
mod fit;
mod monotone;
mod options;
mod stages;
mod weights;

pub use advice::{Advice, advice};
pub use choose::left_out::{LeftOut, left_out};
pub use choose::validate::{Candidates, cross_validate};
pub(crate) use doubt::excitation::Unresolved;
pub use doubt::excitation::excitation;
pub use fit::{Auto, Choice, Fit};
pub use monotone::{AGAINST_INPUT, way_against_input};
pub use options::FitOptions;
pub use weights::experiment::plane_of;
pub(crate) use weights::fit::fit_weights;
pub(crate) use weights::initial::simulate_from_unknown;
pub(crate) use weights::sparse::Initial;
