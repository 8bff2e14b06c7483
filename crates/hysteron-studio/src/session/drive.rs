//! A model that is driven by hand: its input is moved and the output answers, or the output is
//! pulled and the inverse answers.

use super::fault::Fault;
use super::request::Id;
use super::{MOST, Session};
use hysteron::{Direction, Model, Policy, Sample, State, Target, Wanted};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Samples of the way that are kept and shown.
const TRAIL: usize = 2000;

/// A hand jumps; a model without time takes the way in so many steps, which leads to the same state
/// and shows the branch.
const STEPS: u32 = 48;

/// A model, its state, and the way it came.
#[derive(Debug)]
pub(super) struct Drive {
    pub(super) fit: Id,
    model: Arc<Model>,
    state: State,
    dt: f64,
    load: Option<f64>,
    input: f64,
    output: f64,
    wanted: Option<f64>,
    status: &'static str,
    other: Option<(Policy, f64)>,
    trail: Vec<[f64; 2]>,
    /// Inputs and outputs that the page offers.
    inputs: (f64, f64),
    outputs: (f64, f64),
}

/// Moves a model that is driven.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct Pull {
    /// The drive.
    pub drive: Id,
    /// The new input.
    #[serde(default)]
    pub input: Option<f64>,
    /// Or the output that is wanted.
    #[serde(default)]
    pub output: Option<f64>,
    /// What the inverse does when the target reverses.
    #[serde(default)]
    pub policy: Policy,
    /// Time since the sample before, in seconds.
    #[serde(default)]
    pub dt: Option<f64>,
    /// The load.
    #[serde(default)]
    pub load: Option<f64>,
}

/// A model that is driven, as the page shows it.
#[derive(Debug, Clone, Serialize)]
pub struct DriveView {
    /// Its number.
    pub drive: Id,
    /// The input.
    pub input: f64,
    /// The output.
    pub output: f64,
    /// The output that was wanted.
    pub wanted: Option<f64>,
    /// Whether it was reached: ok, low, high, passed, limited.
    pub status: &'static str,
    /// The input that the other policy gives.
    pub other: Option<(Policy, f64)>,
    /// The inputs between which the output stands still.
    pub dead_band: Option<(f64, f64)>,
    /// Inputs and outputs on the way here.
    pub trail: Vec<[f64; 2]>,
    /// Lowest and highest input that makes sense.
    pub inputs: (f64, f64),
    /// The same for the output.
    pub outputs: (f64, f64),
    /// Time step in seconds, where the model depends on time.
    pub dt: Option<f64>,
    /// The load, where the model depends on one.
    pub load: Option<f64>,
}

impl Session {
    pub(super) fn drive(&mut self, fit: Id) -> Result<DriveView, Fault> {
        let fitted = self.fitted(fit)?;
        let model = fitted.model.clone();
        let mut drive = Drive {
            fit,
            state: model.off(),
            dt: fitted.dt.unwrap_or(1.0),
            load: model.load.as_ref().map(|load| {
                let (low, high) = load.range();
                low + 0.5 * (high - low)
            }),
            input: fitted.input.0,
            output: 0.0,
            wanted: None,
            status: "ok",
            other: None,
            trail: Vec::new(),
            inputs: fitted.input,
            outputs: fitted.output,
            model,
        };
        drive.push(drive.inputs.0)?;
        let id = self.next();
        if self.drives.len() >= MOST {
            self.drives.pop_first();
        }
        let view = drive.view(id);
        self.drives.insert(id, drive);
        Ok(view)
    }

    pub(super) fn pull(&mut self, pull: &Pull) -> Result<DriveView, Fault> {
        let drive = self.drives.get_mut(&pull.drive);
        let drive = drive.ok_or_else(|| Fault::gone("drive", pull.drive))?;
        if let Some(dt) = pull.dt {
            drive.dt = dt;
        }
        if let (Some(load), Some(_)) = (pull.load, drive.load) {
            drive.load = Some(load);
        }
        match (pull.input, pull.output) {
            (Some(input), None) => drive.push(input)?,
            (None, Some(output)) => drive.pull(output, pull.policy)?,
            _ => {
                return Err(Fault::missing(
                    "a drive is moved by an input or by an output",
                    "give one of them",
                ));
            }
        }
        Ok(drive.view(pull.drive))
    }
}

impl Drive {
    fn sample(&self, input: f64) -> Sample {
        Sample {
            dt: self.model.is_timed().then_some(self.dt),
            load: self.load,
            ..input.into()
        }
    }

    fn wanted(&self, target: Target<f64>) -> Wanted {
        Wanted {
            dt: self.model.is_timed().then_some(self.dt),
            load: self.load,
            ..target.into()
        }
    }

    fn push(&mut self, input: f64) -> Result<(), Fault> {
        let mut state = self.state.clone();
        let from = self.trail.last().map_or(input, |last| last[0]);
        let far = (input - from).abs() > 0.005 * (self.inputs.1 - self.inputs.0);
        let mut way = Vec::new();
        if far && !self.model.is_timed() {
            for step in 1..STEPS {
                let between = from + (input - from) * (f64::from(step) / f64::from(STEPS));
                let output = self.model.step(&mut state, self.sample(between))?.output;
                way.push([between, output]);
            }
        }
        let output = self.model.step(&mut state, self.sample(input))?.output;
        way.push([input, output]);
        (self.state, self.input, self.output) = (state, input, output);
        (self.wanted, self.other, self.status) = (None, None, "ok");
        self.trail.extend(way);
        let beyond = self.trail.len().saturating_sub(TRAIL);
        self.trail.drain(..beyond);
        Ok(())
    }

    fn pull(&mut self, wanted: f64, policy: Policy) -> Result<(), Fault> {
        let (input, status) = self.solve(wanted, policy)?;
        let other = match policy {
            Policy::Hold => Policy::Anticipate,
            Policy::Anticipate => Policy::Hold,
        };
        let other = self
            .solve(wanted, other)
            .ok()
            .map(|(input, _)| (other, input));
        self.push(input)?;
        (self.wanted, self.status, self.other) = (Some(wanted), status, other);
        Ok(())
    }

    /// The input for a wanted output; nothing moves.
    fn solve(&self, output: f64, policy: Policy) -> Result<(f64, &'static str), Fault> {
        let heading = match policy {
            Policy::Hold => None,
            Policy::Anticipate if output > self.output => Some(Direction::Rising),
            Policy::Anticipate if output < self.output => Some(Direction::Falling),
            Policy::Anticipate => None,
        };
        let target = Target::new(output).heading(heading);
        let inverse = self.model.inverse()?;
        let solution = inverse.step(&mut self.state.clone(), self.wanted(target))?;
        Ok((solution.input, solution.status.name()))
    }

    /// The inputs between which the output stands still: where it starts to rise, and to fall.
    fn dead_band(&self) -> Option<(f64, f64)> {
        if self.model.is_timed() {
            return None;
        }
        let inverse = self.model.inverse().ok()?;
        // The inverse sums in another order, so an equal target could lie behind by rounding.
        let hair = 1e-12 * (self.outputs.1 - self.outputs.0).abs();
        let edge = |heading| {
            let past = match heading {
                Direction::Rising => hair,
                Direction::Falling => -hair,
            };
            let target = Target::new(self.output + past).heading(Some(heading));
            let solution = inverse
                .step(&mut self.state.clone(), self.wanted(target))
                .ok()?;
            Some(solution.input)
        };
        let edges = (edge(Direction::Falling)?, edge(Direction::Rising)?);
        Some((edges.0.min(edges.1), edges.0.max(edges.1)))
    }

    fn view(&self, id: Id) -> DriveView {
        DriveView {
            drive: id,
            input: self.input,
            output: self.output,
            wanted: self.wanted,
            status: self.status,
            other: self.other,
            dead_band: self.dead_band(),
            trail: self.trail.clone(),
            inputs: self.inputs,
            outputs: self.outputs,
            dt: self.model.is_timed().then_some(self.dt),
            load: self.load,
        }
    }
}
