//! Fleets: a model for each of many actuators, from one call to one table.
//!
//! `fit` is the entry point, with the settings of `options`. `sources` finds the files, `one` fits
//! one actuator, `each` does so on all threads, and `row` is a row of the table. `join` puts tables
//! of parts together. `shape` describes a model in a few numbers, and `outliers` tells which
//! actuators are unlike the others. `prior` is what they tell about the next one.

mod each;
mod fit;
mod join;
mod one;
mod options;
mod outliers;
mod prior;
mod row;
mod shape;
mod sources;

pub use fit::{FleetFailure, FleetFitted, fit_fleet};
pub use join::join_fleets;
pub use options::FleetOptions;
pub use outliers::{Norm, Strangeness};
pub use prior::prior_of_fleet;
pub use row::{FleetRow, read_fleet};
pub use shape::Shape;
