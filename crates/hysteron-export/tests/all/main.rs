//! The tests of this crate: one program, since every program is linked with all dependencies.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../common/mod.rs"]
mod common;

mod adapt;
mod arduino;
mod build;
mod c;
mod control;
mod decay;
mod delay;
mod files;
mod fmu;
mod fmu_sources;
mod page;
mod parts;
mod rounding;
mod shadow;
mod staged;
mod vectors;
mod vectors_staged;
