//! Parts of a control loop that are numbers alone: the feedback, what is done to a reading before
//! it, and what notices one that stands still or is missing. The loop itself is `hysteron::control::Controller`.

mod gate;
mod low_pass;
mod pid;
mod safety;
mod standstill;

pub use gate::Gate;
pub use low_pass::LowPass;
pub use pid::{Pid, Terms, clamp};
pub use safety::{Safety, Silence};
pub use standstill::{Cause, Standstill};
