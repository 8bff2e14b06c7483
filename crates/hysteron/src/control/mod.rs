//! Control loops on a hysteresis model and its inverse.

mod device;
mod trace;

pub use device::{Device, Disturbance, Reading, SimulatedPlant};
pub use trace::{LoopStatus, Snapshot, Trace};
