//! On-line adaptation: weights that follow the plant while the model runs.
//!
//! The output is linear in the weights: `H = φᵀμ`, with the operators' outputs `φ`. So estimators
//! of linear parameters apply. With every method the weights are zero or above after every sample,
//! so the inverse exists at every instant.
//!
//! [`ShiftEstimator`] leaves the weights alone. It follows one number: by how much an unknown load
//! shifts the operators' axis.

mod estimator;
mod gate;
mod increments;
mod learning;
mod least_squares;
mod memory;
mod operators;
mod options;
mod outcome;
mod parameters;
mod run;
mod shift;
mod shift_options;
mod start;
mod trial;
mod vector;
mod watch;

pub use estimator::Estimator;
pub use gate::{Gate, Verdict};
pub use memory::{estimator_len, estimator_len_of_basis};
pub use options::{Adaptation, Method};
pub use outcome::{Learning, Outcome};
pub use shift::ShiftEstimator;
pub use shift_options::ShiftOptions;
pub use watch::{Channel, Reading, Watch, Watched};
