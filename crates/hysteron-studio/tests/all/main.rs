//! The tests of this crate: one program, since every program is linked with all dependencies.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../common/asked.rs"]
mod asked;
#[cfg(feature = "server")]
#[path = "../common/chromium.rs"]
mod chromium;
#[cfg(feature = "server")]
#[path = "../common/mod.rs"]
mod common;
#[cfg(feature = "server")]
#[path = "../common/folder.rs"]
mod folder;
#[cfg(feature = "server")]
#[path = "../common/place.rs"]
mod place;
#[cfg(feature = "server")]
#[path = "../../../hysteron/tests/common/mod.rs"]
mod recordings;

mod accessibility;
mod browser;
mod browser_files;
mod browser_sample;
mod browser_views;
mod carried;
mod changed_files;
mod hostile_sessions;
mod layers;
mod server;
mod session;
mod views;
