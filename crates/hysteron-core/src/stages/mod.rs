//! The stages before and after the operators, from the drive of an actuator to its output.
//!
//! ```text
//! drive ─▶ body ─▶ temperature
//!       ─▶ axis (load, registration, spacing) ─▶ operators ─▶ behind ─▶ output
//! ```
//!
//! - [`Body`]: first-order heating and cooling, from the drive to the temperature.
//! - [`Latent`]: heat that the operators bind, so that the temperature lags behind.
//! - [`Axis`]: the load shifts the temperature axis; the spacing places the levels.
//! - [`Registration`]: at which temperature each threshold is passed, up and down.
//! - [`Load`]: what the load does to axis, stroke and offset.
//! - [`Parts`]: weights that depend on the load.
//! - [`Behind`]: the stages behind the operators, a file for each.
//! - [`Stages`]: the whole chain. It steps forward, and its inverse is exact for the sample.
//!
//! A stage is a set of constants, which it declares ([`Declared`]). What changes is in one
//! [`StageState`]. Nothing here allocates.

mod axis;
mod behind;
mod body;
mod chain;
mod constant;
mod creep;
mod curve;
mod invert;
mod lag;
mod latent;
mod loaded;
mod mix;
mod parts;
mod registration;
mod ring;
mod stage;
mod state;

pub use axis::{Axis, Load};
pub use behind::Behind;
pub use body::{Body, Decay};
pub use chain::Stages;
pub(crate) use chain::factors;
pub use constant::{Constant, Declared, Range, Unit};
pub use creep::{Creep, MAX_CREEP};
pub use curve::Curve;
pub use invert::Wanted;
pub use lag::Lag;
pub use latent::Latent;
pub use loaded::Loaded;
pub use mix::mix;
pub use parts::{MAX_PARTS, Parts, Placed, bernstein};
pub use registration::Registration;
pub use ring::Ring;
pub use state::{RATE_NUMBERS, Rates, STATE_NUMBERS, Sample, StageState};
