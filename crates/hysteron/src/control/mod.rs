//! Control loops on a hysteresis model and its inverse.
//!
//! A [`Controller`] is a [`Scheme`] in motion; it runs on whatever implements [`Device`], real or simulated, and [`run`] does so
//! on a [`SimulatedPlant`].

mod compensator;
mod controller;
mod device;
mod pid;
mod run;
mod scheme;
mod trace;
mod watch;

pub use compensator::Compensator;
pub use controller::{Action, Controller, Target};
pub use device::{Device, Disturbance, Reading, SimulatedPlant};
pub use pid::{Gains, Pid};
pub use run::{Course, run};
pub use scheme::{InnerLoop, Rest, Scheme};
pub use trace::{LoopStatus, Snapshot, Trace};
