//! Parts of a control loop that are numbers alone: the feedback, and what notices a reading that
//! stands still or is missing. The loop itself is `hysteron::control::Controller`.

mod pid;
mod safety;
mod standstill;

pub use pid::{Pid, Terms, clamp};
pub use safety::{Safety, Silence};
pub use standstill::{Cause, Standstill};
