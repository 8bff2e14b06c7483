//! The record of a run of a control loop.

use super::{Action, Controller, LoopStatus, Reading};

/// Number of snapshots of adapted weights in a run.
const SNAPSHOTS: usize = 60;

/// The adapted weights at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Time, s.
    pub time: f64,
    /// Output with every operator off.
    pub offset: f64,
    /// `N` weights, row by row.
    pub weights: Vec<f64>,
}

/// The run of one controller, with one value per sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// Time, s.
    pub time: Vec<f64>,
    /// The wanted output.
    pub reference: Vec<f64>,
    /// The output: the true one of a simulated plant, the measured one of a real device.
    pub output: Vec<f64>,
    /// The output as its sensor read it; NaN where the sensor gave nothing.
    pub measured: Vec<f64>,
    /// The input of the hysteresis, true or measured.
    pub input: Vec<f64>,
    /// The input that the controller commanded.
    pub command: Vec<f64>,
    /// The drive that was written to the device.
    pub drive: Vec<f64>,
    /// The output that the model expected before it learned from the reading; NaN without a model.
    pub prediction: Vec<f64>,
    /// Flags of each sample.
    pub status: Vec<LoopStatus>,
    /// The weights over time, for a controller that adapts.
    pub snapshots: Vec<Snapshot>,
}

impl Trace {
    /// Adds the next of `count` samples: target, readings, true values (of a simulated plant) and
    /// the controller's action. Also adds a snapshot of the weights now and then, if they adapt.
    pub fn record(
        &mut self,
        count: usize,
        reference: f64,
        (reading, truth): (Reading, Reading),
        (controller, action): (&Controller, &Action),
    ) {
        let n = self.time.len();
        let time = n as f64 * controller.interval_s();
        let every = count.div_ceil(SNAPSHOTS).max(1);
        let adapting = controller.compensator().and_then(|c| c.adapting());
        if let (Some(adaptive), true) = (adapting, n.is_multiple_of(every) || n + 1 == count) {
            self.snapshots.push(Snapshot {
                time,
                offset: adaptive.offset(),
                weights: adaptive.weights(),
            });
        }
        self.time.push(time);
        self.reference.push(reference);
        self.output.push(truth.output);
        self.measured.push(reading.output);
        self.input.push(truth.input.unwrap_or(action.command));
        self.command.push(action.command);
        self.drive.push(action.drive);
        self.prediction.push(action.prediction);
        self.status.push(action.status);
    }
}
