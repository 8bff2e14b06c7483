//! The tests of this crate: one program, since every program is linked with all dependencies.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../common/mod.rs"]
mod common;

mod adaptation;
mod definition;
mod drives;
mod estimation;
mod estimator;
mod gate;
mod guards;
mod inverse;
mod latent;
mod least_squares;
mod level;
mod parts;
mod physics;
mod plane;
mod reached;
mod refusals;
mod registration;
mod ring;
mod round_trip;
mod shift;
mod stage_parts;
mod stages;
mod surprise;
mod terms;
mod trials;
mod watch;
mod words;
