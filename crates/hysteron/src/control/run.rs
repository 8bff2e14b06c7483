//! Runs a controller on a simulated plant, sample by sample, and records the run.

use super::{Action, Controller, Disturbance, Reference, SimulatedPlant, Trace};
use crate::error::Result;
use crate::progress::Progress;
use crate::progress::SAMPLES_BETWEEN;
use hysteron_core::Direction;

/// A run: the reference and the disturbances. It has as many samples as the reference.
#[derive(Debug, Clone)]
pub struct Course<'a> {
    /// The reference at each sample, in the output's unit.
    pub reference: &'a [f64],
    /// The direction of the reference at each sample ([`crate::headings`]), for *anticipate*.
    /// Samples beyond the end of this slice have none.
    pub headings: &'a [Option<Direction>],
    /// How many samples of the reference the controller is told ahead
    /// ([`Controller::step_ahead`]). It is always told the one that is due ([`Controller::due`]).
    pub ahead: usize,
    /// Disturbances in order. Each acts before the sample with this index, counted from 0.
    pub events: &'a [(usize, Disturbance)],
}

impl Course<'_> {
    /// The target of sample `n`, and the references after it that the controller is told: at least
    /// up to the one that is `due` samples later ([`Controller::due`]).
    ///
    /// # Panics
    /// If `n` is not a sample of the reference.
    #[must_use]
    pub fn target(&self, n: usize, due: usize) -> (Reference, &[f64]) {
        let next = &self.reference[n + 1..];
        let at = n + due.min(next.len());
        let target = Reference {
            output: self.reference[n],
            heading: self.headings.get(at).copied().flatten(),
        };
        (target, &next[..self.ahead.max(due).min(next.len())])
    }
}

/// Runs `controller` on `plant`. The trace holds the plant's true output and input.
///
/// # Errors
/// [`crate::Error::Plant`] for a disturbance that the plant does not have; [`crate::Error::Core`]
/// for a reference that is not finite; the error that `progress` returns.
pub fn run(
    plant: &mut dyn SimulatedPlant,
    controller: &mut Controller,
    course: &Course<'_>,
    progress: Progress<'_>,
) -> Result<Trace> {
    run_with(plant, controller, course, progress, &mut |_, _| Ok(()))
}

/// As [`run`], with `after` each sample: it sees what the controller did, and may change it
/// ([`Controller::retune`], [`Controller::renew`]).
///
/// # Errors
/// As [`run`], and the error that `after` returns.
pub fn run_with(
    plant: &mut dyn SimulatedPlant,
    controller: &mut Controller,
    course: &Course<'_>,
    progress: Progress<'_>,
    after: &mut dyn FnMut(&mut Controller, &Action) -> Result<()>,
) -> Result<Trace> {
    let mut trace = Trace::default();
    let mut events = course.events.iter().peekable();
    let count = course.reference.len();
    for (n, &output) in course.reference.iter().enumerate() {
        if n % SAMPLES_BETWEEN == 0 {
            progress.tell("control loop", n as f64 / count as f64)?;
        }
        while let Some((_, event)) = events.next_if(|(at, _)| *at <= n) {
            plant.disturb(*event)?;
        }
        let truth = plant.truth();
        let reading = plant.read();
        let (target, next) = course.target(n, controller.due());
        let action = controller.step_ahead(target, next, reading)?;
        plant.write(action.drive);
        plant.advance(controller.interval_s());
        trace.record(count, output, (reading, truth), (controller, &action));
        after(controller, &action)?;
    }
    Ok(trace)
}
