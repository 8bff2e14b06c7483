//! The tests of this crate: one program, since every program is linked with all dependencies.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../loops/mod.rs"]
mod loops;

mod bound_heat;
mod comparison;
mod control;
mod faults;
mod foreign;
mod rig;
mod safety;
mod sensor_lag;
mod threads;
mod track;
mod wire;
