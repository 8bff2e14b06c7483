//! The model of an actuator: operators, the stages in front of them, and a record of how they were
//! identified.
//!
//! `actuator` is the model. `operators` are its weighted operators; `body`, `load` and `constants`
//! are those of the stages around them, and `stages` hands them to the core. `delay` is the dead
//! time in front. `at_load` is the model at one load. `state` moves a model sample by sample from
//! its `start`, `surroundings` simulates it with time and load, and `inverse` inverts it (`policy`
//! says how). `late` tells what comes late, and `known_loads` which loads a model knows. `band` is
//! the interval around the output, and `bounds` where it may really be. `file` reads and writes
//! models; `summary`, `smooth`, `validation`, `confidence` and `excitation` are the record of the
//! fit.

mod actuator;
mod at_load;
mod band;
mod body;
mod bounds;
mod change;
mod confidence;
mod constants;
mod delay;
mod excitation;
mod file;
mod inverse;
mod known_loads;
mod late;
mod load;
mod operators;
mod policy;
mod preview;
mod registration;
mod sign;
mod smooth;
mod stages;
mod start;
mod state;
mod summary;
mod surroundings;
mod units;
mod validation;
mod within;

pub use actuator::Model;
pub(crate) use band::add_variance;
pub use band::{Band, BandEvaluation};
pub use body::FirstOrder;
pub(crate) use body::needs_time;
pub use bounds::Bounds;
pub use change::Change;
pub(crate) use confidence::band_name;
pub use confidence::{Confidence, INTERVAL};
pub use constants::{CreepTerm, StageConstants};
pub use delay::Delay;
pub(crate) use delay::UnderWay;
pub use excitation::Excitation;
#[cfg(feature = "files")]
pub(crate) use file::{FORMAT, no_model};
pub use inverse::{Inverse, Wanted};
pub use load::{LoadCurves, LoadDependence, LoadPart};
pub(crate) use load::{bernstein, no_load};
pub use operators::{FittedStart, OperatorState, Operators, Plane};
pub use policy::Policy;
#[cfg(feature = "data")]
pub(crate) use preview::Preview;
pub use registration::Registration;
pub use sign::Sign;
pub use smooth::Smooth;
pub use state::{Sample, State};
pub use summary::{FitSummary, Outlier, SeenFile, Solver, Start};
pub use surroundings::Surroundings;
pub use validation::{Criterion, RivalScore, Score, Validation};
pub(crate) use within::{Bend, Found};
