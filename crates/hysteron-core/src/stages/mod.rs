//! The stages before and after the operators, from the drive of an actuator to its output.
//!
//! ```text
//! drive ─▶ body ─▶ temperature ─▶ axis (load, spacing) ─▶ operators ─▶ creep ─▶ lag ─▶ output
//! ```
//!
//! - [`Body`]: first-order heating and cooling, from the drive to the temperature.
//! - [`Axis`]: the load shifts the temperature axis; the spacing places the levels.
//! - [`Load`]: what the load does to axis, stroke and offset.
//! - [`Parts`]: weights that depend on the load.
//! - [`Creep`]: the output goes on moving after the operators have come to rest.
//! - [`Stages`]: the whole chain. It steps forward, and its inverse is exact for the sample.
//!
//! A stage is a set of constants. What changes is in one [`StageState`]. Nothing here allocates.

mod after;
mod axis;
mod body;
mod chain;
mod invert;
mod limits;
mod mix;
mod parts;

pub use after::{Creep, MAX_CREEP};
pub use axis::{Axis, Load, Loaded};
pub use body::{Body, Decay};
pub use chain::{Rates, Sample, StageState, Stages};
pub use invert::Wanted;
pub use mix::mix;
pub use parts::{MAX_PARTS, Parts, Placed, bernstein};
