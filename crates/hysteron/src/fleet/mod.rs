//! Fleets: a model for each of many actuators, from one call to one table.
//!
//! `fit` is the entry point, with the settings of `options`. `sources` finds the files, `reading`
//! hands out the actuators, `one` fits one, `each` does so on all threads, and `row` is a row of a
//! table. `join` puts tables of parts together.
//!
//! What is left to the data is a `choice`: `pilots` make it, `palette` finds what serves all of
//! them, `signs` tell who is unlike them, and `share` fits.
//!
//! `shape` describes a model in a few numbers, and `outliers` tells which actuators are unlike the
//! others. `prior` is what they tell about the next one.

mod choice;
mod each;
mod fit;
mod join;
mod one;
mod options;
mod outliers;
mod palette;
mod pilots;
mod prior;
mod reading;
mod row;
mod shape;
mod share;
mod signs;
mod sources;

pub use choice::{FleetAlone, FleetChoice, FleetKind, FleetShared};
pub use fit::{FleetFailure, FleetFitted, fit_fleet};
pub use join::join_fleets;
pub use options::FleetOptions;
pub use outliers::{Norm, Strangeness};
pub use prior::prior_of_fleet;
pub use row::{FleetRow, read_fleet};
pub use shape::Shape;
