//! Fleets: a model for each of many actuators, from one call to one table.
//!
//! `fit` is the entry point, with the settings of `options`. `sources` finds the files, `one` fits
//! one actuator, `row` is its row of the table. `shape` describes a model in a few numbers, and
//! `outliers` tells which actuators are unlike the others.

mod fit;
mod one;
mod options;
mod outliers;
mod row;
mod shape;
mod sources;

pub use fit::{FleetFailure, FleetFitted, fit_fleet};
pub use options::FleetOptions;
pub use outliers::{Norm, Strangeness};
pub use row::{FleetRow, read_fleet};
pub use shape::Shape;
