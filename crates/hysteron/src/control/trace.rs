//! What a run of a control loop leaves behind.

use super::{Action, Controller, Reading};

/// Snapshots of adapted weights over a run.
const SNAPSHOTS: usize = 60;

/// What the loop had to say of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LoopStatus {
    /// The drive or the input asked for stood at a limit.
    pub saturated: bool,
    /// The reference lay out of the model's reach; the nearest end was aimed at.
    pub out_of_reach: bool,
    /// A reading was missing, or stuck: the loop went on without it.
    pub sensor_fault: bool,
    /// The model learned from the sample.
    pub adapted: bool,
    /// Reading rejected: the model did not learn from it, because it was too far from what was
    /// expected.
    pub rejected: bool,
}

/// The adapted weights at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// When, s.
    pub time: f64,
    /// Output with every operator off.
    pub offset: f64,
    /// `N` weights, row by row.
    pub weights: Vec<f64>,
}

/// One controller's run: a value for each sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// Time, s.
    pub time: Vec<f64>,
    /// What the output should be.
    pub reference: Vec<f64>,
    /// The output: the true one of a simulated plant, the measured one of a real device.
    pub output: Vec<f64>,
    /// The output as its sensor read it; NaN where it gave nothing.
    pub measured: Vec<f64>,
    /// The input of the hysteresis, true or measured.
    pub input: Vec<f64>,
    /// The input that the controller asked for.
    pub command: Vec<f64>,
    /// The drive that was written to the device.
    pub drive: Vec<f64>,
    /// The output that the controller's model expected before it learned from the reading; NaN for
    /// a controller without a model.
    pub prediction: Vec<f64>,
    /// What the loop had to say.
    pub status: Vec<LoopStatus>,
    /// The weights over time, of a controller that adapts.
    pub snapshots: Vec<Snapshot>,
}

impl Trace {
    /// Adds the next of `count` samples: what was wanted, what was read and, of a simulated plant,
    /// what was true, and what the controller did. Now and then also its weights, where these
    /// adapt.
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
