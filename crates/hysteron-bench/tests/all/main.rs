//! The tests of this crate: one program, since every program is linked with all dependencies.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod bench;
mod device;
mod ends;
mod faults;
mod lines;
#[cfg(unix)]
mod roads;
mod runs;
