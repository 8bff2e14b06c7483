//! Forward and inverse tests of a model on recordings, as in the chapter's section 6.
//!
//! `one` tests one recording; `joined` makes one evaluation of those of several.

mod joined;
mod one;

pub(crate) use joined::over_all;
pub use joined::{evaluate, evaluate_errors, evaluate_from};
pub use one::{Evaluation, InverseEvaluation, InverseRun};
pub(crate) use one::{OTHER_START, begin, compare};
