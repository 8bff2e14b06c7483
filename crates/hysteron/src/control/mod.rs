//! Control loops with a hysteresis model and its inverse.
//!
//! A [`Scheme`] is the configuration of a loop and a [`Controller`] runs it. The controller runs on
//! anything that implements [`Device`], real or simulated; [`run`] does so on a [`SimulatedPlant`]
//! and records a [`Trace`]. Times are in seconds, inputs and outputs in the model's units.
//!
//! The files: `scheme` and `controller` as above; `compensator` is the model in the loop; `pid` has the
//! gains of the feedback and `tuning` finds them; `sensor` checks each sensor; `trust` chooses
//! between a learner and the model it began from; `status` has the flags; `device`, `run` and `trace`
//! connect the loop to a device and record it. The feedback itself, the gate against spikes, the
//! filter, and what notices that a reading stands still or is missing, are in
//! [`hysteron_core::control`].
//!
//! Inverse feedforward with PID feedback, on an actuator that the model was identified from:
//!
//! ```
//! use hysteron::control::{
//!     Compensator, Controller, Course, Device, Gains, Scheme, SimulatedPlant, run,
//! };
//! use hysteron_sim::plant::{PreisachPlant, PreisachPlantOptions};
//! use hysteron::{Fit, Progress, Recording};
//!
//! let new = || PreisachPlant::new(&PreisachPlantOptions::default()); // volts in, µm out
//! let (mut plant, mut input, mut output) = (new()?, Vec::new(), Vec::new());
//! for n in 0..4000 {
//!     let phase = 0.05 * f64::from(n);
//!     plant.write(75.0 - (75.0 - 0.015 * f64::from(n)) * phase.cos());
//!     plant.advance(0.01);
//!     let truth = plant.truth();
//!     input.extend(truth.input);
//!     output.push(truth.output);
//! }
//! let model = Fit::new().bootstrap(0).run(&Recording::new(input, output)?)?;
//!
//! let mut controller = Controller::new(Scheme {
//!     compensator: Some(Compensator::fixed(&model)?),
//!     tolerance: 0.5,
//!     pid: Some(Gains { gain: 0.2, integral_s: 0.05, derivative_s: 0.0 }),
//!     filter_s: 0.01,
//!     stuck_s: Some(0.15),
//!     ..Scheme::new(0.01, (0.0, 150.0))
//! })?;
//! let reference = (0..1000).map(|n| 36.0 - 24.0 * (0.03 * f64::from(n)).cos());
//! let reference: Vec<f64> = reference.collect();
//! let course = Course { reference: &reference, headings: &[], ahead: 0, events: &[] };
//! let trace = run(&mut new()?, &mut controller, &course, Progress::NONE)?;
//! let late = 200..1000; // after the start
//! let largest = late.map(|n| (trace.output[n] - reference[n]).abs()).fold(0.0, f64::max);
//! assert!(largest < 3.0, "{largest} µm");
//! # Ok::<(), hysteron::Error>(())
//! ```

mod compensator;
mod controller;
mod device;
mod pid;
mod run;
mod scheme;
mod sensor;
mod status;
mod trace;
mod trust;
mod tuning;

pub use compensator::Compensator;
pub use controller::{Action, Controller, Reference};
pub use device::{Device, Disturbance, Reading, SimulatedPlant};
pub use hysteron_core::control::{Pid, Safety};
pub use pid::Gains;
pub use run::{Course, run, run_with};
pub use scheme::{InnerLoop, Scheme};
pub use status::LoopStatus;
pub use trace::{Snapshot, Trace};
pub use tuning::RelayTest;
