//! `run`: a profile, or one of the controllers of `track`, on a device outside the program: a child
//! process on a pipe, a serial line, a socket, or a simulated plant.
//!
//! A [`Config`] says what to do, [`run`] does it and comes to a [`Summary`]. Whatever ends a run,
//! the drive is safe and the log is whole. `docs/bench.md` has the protocol, the file and the
//! faults that were tried.
//!
//! The files: `protocol` has the lines and their check; `config` the file, `check` what has to hold
//! in it; `device` the ways to a device, `handshake` the first question; `play` what is due when;
//! `plan` what a run does with the device that answered; `tune` gains from a model; `learner`
//! learning beside the loop; `session` the run, `end` the ways that it can end, `summary` what it
//! tells, `dry` what it would do; `log` the table, `at` where it stands, `row` what stands in it,
//! `companion` what a later run needs.
#![forbid(unsafe_code)]

mod at;
mod check;
mod companion;
mod config;
pub mod device;
mod dry;
mod end;
mod error;
mod handshake;
mod jitter;
mod learner;
mod log;
mod plan;
mod play;
pub mod protocol;
mod row;
mod session;
mod summary;
mod sweep;
mod tune;

pub use config::{
    Config, ControllerOptions, DeviceOptions, Limits, Mode, Profile, ReferenceOptions, Safety,
    Tuning,
};
pub use dry::dry_run;
pub use end::{End, Stop};
pub use error::{Error, Result};
pub use session::run;
pub use summary::{Options, Seen, Summary};
pub use sweep::Unmoved;
