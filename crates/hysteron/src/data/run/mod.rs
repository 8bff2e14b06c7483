//! Simulates and inverts tables block by block, so that memory does not grow with the file.
//!
//! `pipeline` reads, computes and writes, each on a thread of its own. `samples` makes samples of
//! rows. `simulate` and `invert` are the work in between. `sink` pairs rows with their new cells.

mod invert;
mod pipeline;
mod samples;
mod simulate;
mod sink;

pub use invert::{Invert, invert_table};
pub use simulate::{Simulate, simulate_table};

use crate::data::recording::Repair;
use hysteron_core::Status;
use serde::Serialize;

/// Counts of the rows processed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Counts {
    /// Rows read and written.
    pub samples: u64,
    /// Rows clipped at the upper end: an input above the range, or a target above it.
    pub high: u64,
    /// Rows clipped at the lower end: an input below the range, or a target below it.
    pub low: u64,
    /// Targets inside a jump of a relay model, which no input reaches exactly.
    pub passed: u64,
    /// Targets that the drive, within its range, cannot reach in time.
    pub limited: u64,
    /// Of an inversion: the largest distance from the modelled output to where it may really be, in
    /// its unit ([`crate::Bounds`]); `None` where the model does not know.
    pub half_width: Option<f64>,
    /// Rows at which the model began anew, because the clock went back.
    pub anew: u64,
}

impl Counts {
    /// Counts a target with this status.
    fn add(&mut self, status: Status) {
        self.samples += 1;
        match status {
            Status::Ok => {}
            Status::Low => self.low += 1,
            Status::High => self.high += 1,
            Status::Passed => self.passed += 1,
            Status::Limited => self.limited += 1,
        }
    }
}

/// What a table has besides its input or target.
#[derive(Debug, Clone, Copy, Default)]
pub struct Around<'a> {
    /// Column of time in seconds. A model that depends on time needs it.
    pub time: Option<&'a str>,
    /// Column of the load, for a model that depends on one.
    pub load: Option<&'a str>,
    /// What is done where the clock goes back: with [`Repair::Mend`] another recording begins, and
    /// the model with it. All rows stay. In a gap the input is held, as the table says.
    pub repair: Repair,
}
