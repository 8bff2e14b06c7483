//! Control loops on a hysteresis model and its inverse.

mod compensator;
mod controller;
mod device;
mod pid;
mod run;
mod trace;
mod watch;

pub use compensator::Compensator;
pub use controller::{Action, Controller, InnerLoop, Rest, Scheme, Target};
pub use device::{Device, Disturbance, Reading, SimulatedPlant};
pub use pid::{Gains, Pid};
pub use run::{Course, run};
pub use trace::{LoopStatus, Snapshot, Trace};
