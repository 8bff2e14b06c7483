//! A model that is driven by hand: its input is moved and the output answers, or the output is
//! pulled and the inverse answers. While the output is pulled, the other policy goes its own way
//! beside it.

use super::fault::Fault;
use super::fitted::Fitted;
use super::id::Id;
use super::path::{Followed, FollowedView, Path, Side};
use hysteron::{Direction, Model, Policy, Sample, State, Target, Wanted};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Samples of the way that are kept and shown.
const TRAIL: usize = 2000;

/// A hand jumps; a model without time takes the way in so many steps, which leads to the same state
/// and shows the branch.
const STEPS: u32 = 48;

/// The most samples of a path.
const PATH: usize = 4000;

/// A model that is driven.
#[derive(Debug, Clone)]
pub(super) struct Drive {
    pub(super) fit: Id,
    model: Arc<Model>,
    pub(super) dt: f64,
    pub(super) load: Option<f64>,
    pub(super) way: Way,
    /// The way of the other policy since the input was moved.
    rival: Option<(Policy, Way)>,
    wanted: Option<f64>,
    moves: Vec<[f64; 3]>,
    /// The last path, until the model is moved otherwise.
    pub(super) followed: Option<Arc<Followed>>,
    /// Inputs and outputs that the page offers.
    inputs: (f64, f64),
    pub(super) outputs: (f64, f64),
}

/// A state, and how it came there.
#[derive(Debug, Clone)]
pub(super) struct Way {
    state: State,
    pub(super) input: f64,
    pub(super) output: f64,
    pub(super) status: &'static str,
    trail: Vec<[f64; 2]>,
}

/// Moves a model that is driven. One of `input`, `output`, `inputs` and `outputs` is given.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Pull {
    /// The drive.
    pub drive: Id,
    /// The new input.
    #[serde(default)]
    pub input: Option<f64>,
    /// Or the output that is wanted.
    #[serde(default)]
    pub output: Option<f64>,
    /// Or a path of inputs.
    #[serde(default)]
    pub inputs: Option<Vec<f64>>,
    /// Or a path of outputs that are wanted. Where it turns is known ahead.
    #[serde(default)]
    pub outputs: Option<Vec<f64>>,
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
    /// The other policy, pulled by the same outputs since the input was moved.
    pub rival: Option<RivalView>,
    /// The output wanted, and the input with the policies hold and anticipate, for each pull since
    /// the input was moved.
    pub moves: Vec<[f64; 3]>,
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
    /// The path that led here.
    pub followed: Option<FollowedView>,
}

/// The other policy of a drive.
#[derive(Debug, Clone, Serialize)]
pub struct RivalView {
    /// Which it is.
    pub policy: Policy,
    /// Its input.
    pub input: f64,
    /// Its output.
    pub output: f64,
    /// Whether the wanted output was reached.
    pub status: &'static str,
    /// Its way since the input was moved.
    pub trail: Vec<[f64; 2]>,
}

/// Ends that are apart, in order.
fn ordered((a, b): (f64, f64)) -> Option<(f64, f64)> {
    let way = (b - a).abs();
    (way > 0.0 && way.is_finite()).then(|| (a.min(b), a.max(b)))
}

/// The inputs that move the model, of those that were recorded.
fn inputs(model: &Model, recorded: (f64, f64)) -> (f64, f64) {
    let active = match model.thermal {
        Some(_) => ordered(model.drive_range()),
        None => ordered(model.active_range()),
    };
    let both = active.map(|(low, high)| (low.max(recorded.0), high.min(recorded.1)));
    both.filter(|(low, high)| low < high).unwrap_or(recorded)
}

/// The outputs from every operator off to every operator on.
fn stroke(model: &Model) -> Option<(f64, f64)> {
    ordered(model.output_range())
}

impl Drive {
    /// The model of a fit, with every operator off and at its lowest input.
    ///
    /// # Errors
    /// [`Fault`] for a model that cannot take a step.
    pub(super) fn new(fitted: &Fitted) -> Result<Self, Fault> {
        let model = fitted.model.clone();
        let mut drive = Self {
            fit: fitted.id,
            dt: fitted.dt.unwrap_or(1.0),
            load: model.load.as_ref().map(|load| {
                let (low, high) = load.range();
                low + 0.5 * (high - low)
            }),
            way: Way {
                state: model.off(),
                input: fitted.input.0,
                output: 0.0,
                status: "ok",
                trail: Vec::new(),
            },
            rival: None,
            wanted: None,
            moves: Vec::new(),
            followed: None,
            inputs: inputs(&model, fitted.input),
            outputs: stroke(&model).unwrap_or(fitted.output),
            model,
        };
        drive.way.input = drive.inputs.0;
        drive.push(drive.inputs.0)?;
        Ok(drive)
    }

    pub(super) fn model(&self) -> &Model {
        &self.model
    }

    /// Takes a time step and a load, where they are given and the model depends on them.
    pub(super) fn takes(&mut self, dt: Option<f64>, load: Option<f64>) {
        self.dt = dt.unwrap_or(self.dt);
        self.load = self.load.map(|before| load.unwrap_or(before));
    }

    /// Moves the model. A path that is refused at its middle moves nothing.
    ///
    /// # Errors
    /// [`Fault`] for a move that cannot be.
    pub(super) fn moved(&mut self, pull: &Pull) -> Result<(), Fault> {
        let mut moved = self.clone();
        moved.takes(pull.dt, pull.load);
        moved.followed = None;
        let along = |of, values| Path {
            of,
            values,
            time: None,
            load: None,
        };
        let path = pull.inputs.as_ref().or(pull.outputs.as_ref());
        if path.is_some_and(|path| path.len() > PATH || path.is_empty()) {
            return Err(Fault::missing(
                "a path has one sample or more, and not too many",
                &format!("give up to {PATH}"),
            ));
        }
        match (pull.input, pull.output, &pull.inputs, &pull.outputs) {
            (Some(input), None, None, None) => moved.push(input)?,
            (None, Some(output), None, None) => moved.pull(output, pull.policy, None)?,
            (None, None, Some(inputs), None) => {
                moved.follow(&along(Side::Inputs, inputs), pull.policy, None)?;
            }
            (None, None, None, Some(outputs)) => {
                moved.follow(&along(Side::Outputs, outputs), pull.policy, None)?;
            }
            _ => {
                return Err(Fault::missing(
                    "a drive is moved by an input or by an output",
                    "give one of them",
                ));
            }
        }
        *self = moved;
        Ok(())
    }
}

impl Way {
    fn limit(&mut self) {
        let beyond = self.trail.len().saturating_sub(TRAIL);
        self.trail.drain(..beyond);
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

    pub(super) fn push(&mut self, input: f64) -> Result<(), Fault> {
        self.way = self.pushed(&self.way, input)?;
        (self.wanted, self.rival) = (None, None);
        self.moves.clear();
        Ok(())
    }

    /// The way with a step to an input.
    fn pushed(&self, way: &Way, input: f64) -> Result<Way, Fault> {
        let mut way = way.clone();
        let from = way.trail.last().map_or(input, |last| last[0]);
        let far = (input - from).abs() > 0.005 * (self.inputs.1 - self.inputs.0);
        if far && !self.model.is_timed() {
            for step in 1..STEPS {
                let between = from + (input - from) * (f64::from(step) / f64::from(STEPS));
                let output = self
                    .model
                    .step(&mut way.state, self.sample(between))?
                    .output;
                way.trail.push([between, output]);
            }
        }
        way.output = self.model.step(&mut way.state, self.sample(input))?.output;
        way.input = input;
        way.status = "ok";
        way.trail.push([input, way.output]);
        way.limit();
        Ok(way)
    }

    /// Pulls the output with both policies. `ahead` is where the target goes next; without it, it
    /// is taken to go on as it came.
    pub(super) fn pull(
        &mut self,
        wanted: f64,
        policy: Policy,
        ahead: Option<Option<Direction>>,
    ) -> Result<(), Fault> {
        let other = match policy {
            Policy::Hold => Policy::Anticipate,
            Policy::Anticipate => Policy::Hold,
        };
        let rival = self.rival.take().filter(|(of, _)| *of == other);
        let rival = match rival {
            Some((_, way)) => way,
            None => {
                self.moves.clear();
                Way {
                    trail: self.way.trail.last().copied().into_iter().collect(),
                    ..self.way.clone()
                }
            }
        };
        let way = self.pulled(&self.way, wanted, policy, ahead)?;
        let rival = self.pulled(&rival, wanted, other, ahead)?;
        let (hold, anticipate) = match policy {
            Policy::Hold => (way.input, rival.input),
            Policy::Anticipate => (rival.input, way.input),
        };
        self.moves.push([wanted, hold, anticipate]);
        let beyond = self.moves.len().saturating_sub(TRAIL);
        self.moves.drain(..beyond);
        (self.way, self.rival, self.wanted) = (way, Some((other, rival)), Some(wanted));
        Ok(())
    }

    fn pulled(
        &self,
        way: &Way,
        output: f64,
        policy: Policy,
        ahead: Option<Option<Direction>>,
    ) -> Result<Way, Fault> {
        let as_it_came = match () {
            () if output > way.output => Some(Direction::Rising),
            () if output < way.output => Some(Direction::Falling),
            () => None,
        };
        let heading = match policy {
            Policy::Hold => None,
            Policy::Anticipate => ahead.unwrap_or(as_it_came),
        };
        let target = Target::new(output + self.past(heading)).heading(heading);
        let inverse = self.model.inverse()?;
        let solution = inverse.step(&mut way.state.clone(), self.wanted(target))?;
        let mut next = self.pushed(way, solution.input)?;
        next.status = solution.status.name();
        Ok(next)
    }

    /// A hair in a direction. The inverse sums in another order, so an equal target could lie
    /// behind by rounding.
    fn past(&self, heading: Option<Direction>) -> f64 {
        let hair = 1e-12 * (self.outputs.1 - self.outputs.0).abs();
        match heading {
            Some(Direction::Rising) => hair,
            Some(Direction::Falling) => -hair,
            None => 0.0,
        }
    }

    /// The inputs between which the output stands still: where it starts to rise, and to fall.
    fn dead_band(&self) -> Option<(f64, f64)> {
        if self.model.is_timed() {
            return None;
        }
        let inverse = self.model.inverse().ok()?;
        let edge = |heading| {
            let target = Target::new(self.way.output + self.past(Some(heading)));
            let target = target.heading(Some(heading));
            let solution = inverse
                .step(&mut self.way.state.clone(), self.wanted(target))
                .ok()?;
            Some(solution.input)
        };
        let edges = (edge(Direction::Falling)?, edge(Direction::Rising)?);
        Some((edges.0.min(edges.1), edges.0.max(edges.1)))
    }

    pub(super) fn view(&self, id: Id) -> DriveView {
        DriveView {
            drive: id,
            input: self.way.input,
            output: self.way.output,
            wanted: self.wanted,
            status: self.way.status,
            rival: self.rival.as_ref().map(|(policy, way)| RivalView {
                policy: *policy,
                input: way.input,
                output: way.output,
                status: way.status,
                trail: way.trail.clone(),
            }),
            moves: self.moves.clone(),
            dead_band: self.dead_band(),
            trail: self.way.trail.clone(),
            followed: self.followed.as_ref().map(|followed| followed.view()),
            inputs: self.inputs,
            outputs: self.outputs,
            dt: self.model.is_timed().then_some(self.dt),
            load: self.load,
        }
    }
}
