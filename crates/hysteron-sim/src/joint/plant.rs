//! The model in the place of the plant.

use hysteron::control::Scheme;
use hysteron::{Model, Result, Sample, State};
use std::collections::VecDeque;

/// Dead times in the integral time of a loop that SIMC makes around an integrator. Its time
/// constant is the dead time.
const OF_SIMC: f64 = 8.0;
/// How many times later the plant is taken to be where nothing says how fast it is. A sampled loop
/// should have 4 to 10 samples in its rise (Åström & Wittenmark 1997): slower things are unknown.
pub const UNKNOWN: usize = 10;
/// Samples of the shortest simulated run, and of the longest.
pub(super) const SHORTEST: usize = 600;
const LONGEST: usize = 4800;
/// How many times the model can answer a step within a run.
const ANSWERS: usize = 20;
/// However late it answers, so many times it can within a run.
const LATENCIES: usize = 10;
/// The share of its way at which a model has answered, and the share by which it still moves in the
/// shortest run when it has come to rest.
const ANSWERED: f64 = 0.9;
const RESTS: f64 = 0.01;
/// Such runs, longer for a plant that is late, within which it comes to rest.
const PATIENCE: usize = 30;

/// The loop around the model without a loop inside, which the [`Plant`] has.
pub(super) struct Outer {
    pub(super) scheme: Scheme,
    /// Dead time and time constant of the loop inside, s; 0 without one.
    inner_s: f64,
    /// Whether anything says how fast the plant is.
    pub(super) knows_time: bool,
}

impl Outer {
    pub(super) fn of(model: &Model, scheme: &Scheme) -> Self {
        let inside = scheme.inner.map(|inner| inner.gains.integral_s);
        Self {
            scheme: Scheme {
                drives: match inside {
                    Some(_) => scheme.commands,
                    None => scheme.drives,
                },
                delay: Some(scheme.delay.unwrap_or_else(|| late(model, scheme)).max(1)),
                inner: None,
                compensator: None,
                stuck_s: None,
                gate: None,
                slew: None,
                safety: hysteron::control::Safety::default(),
                ..scheme.clone()
            },
            inner_s: inside.map_or(0.0, |integral_s| integral_s / OF_SIMC),
            knows_time: model.is_timed() || inside.is_some(),
        }
    }

    /// Samples from a drive until its effect is read.
    pub(super) fn latency(&self) -> usize {
        let Scheme { interval_s: dt, .. } = self.scheme;
        let due = match self.knows_time {
            true => self.scheme.due(),
            false => UNKNOWN * self.scheme.due(),
        };
        due + (self.inner_s / dt).round() as usize
    }

    /// The drive at this share of the range.
    pub(super) fn drive(&self, share: f64) -> f64 {
        let (low, high) = self.scheme.drives;
        low + share * (high - low)
    }
}

/// Samples from a drive until its effect is read, where the scheme does not say.
fn late(model: &Model, scheme: &Scheme) -> usize {
    usize::from(scheme.inner.is_none()) + model.delay().at(Some(scheme.interval_s))
}

/// The model, each drive seen so many samples after it was given.
pub(super) struct Plant<'a> {
    model: &'a Model,
    state: State,
    waiting: VecDeque<f64>,
    dt: f64,
    /// Where the loop inside has brought the command, and the share that it comes nearer in a
    /// sample.
    at: f64,
    nearer: f64,
}

impl<'a> Plant<'a> {
    pub(super) fn new(model: &'a Model, outer: &Outer, rest: f64) -> Self {
        let dt = outer.scheme.interval_s;
        Self {
            model,
            state: model.start(),
            waiting: std::iter::repeat_n(rest, outer.latency() - 1).collect(),
            dt,
            at: rest,
            nearer: match outer.inner_s > 0.0 {
                true => 1.0 - (-dt / outer.inner_s).exp(),
                false => 1.0,
            },
        }
    }

    /// The output after a sample with this drive.
    pub(super) fn step(&mut self, drive: f64) -> Result<f64> {
        self.waiting.push_back(drive);
        let acts = self.waiting.pop_front().unwrap_or(drive);
        self.at += self.nearer * (acts - self.at);
        let sample = Sample {
            input: self.at,
            dt: Some(self.dt),
            load: None,
        };
        Ok(self.model.step(&mut self.state, sample)?.output)
    }
}

/// What a model does between two drives.
pub(super) struct Reach {
    /// The outputs at the lower and at the higher one, from the other.
    pub(super) outputs: [f64; 2],
    /// Samples of a run in which the model can answer many times.
    pub(super) samples: usize,
}

impl Reach {
    pub(super) fn of(model: &Model, outer: &Outer, drives: [f64; 2]) -> Result<Self> {
        let [low, high] = drives;
        let mut plant = Plant::new(model, outer, low);
        let (mut outputs, mut slowest) = ([0.0; 2], 0);
        for (drive, end) in [(low, 0), (high, 1), (low, 0), (high, 1)] {
            let course = rest(&mut plant, drive)?;
            let (from, to) = (course[0], course[course.len() - 1]);
            let answered = |y: &f64| (y - from) / (to - from) >= ANSWERED;
            slowest = slowest.max(course.iter().position(answered).unwrap_or(0));
            outputs[end] = to;
        }
        Ok(Self {
            outputs,
            samples: (ANSWERS * slowest).clamp(SHORTEST, LONGEST.max(LATENCIES * outer.latency())),
        })
    }
}

/// The outputs until the model rests with this drive.
fn rest(plant: &mut Plant<'_>, drive: f64) -> Result<Vec<f64>> {
    let mut course = Vec::new();
    // A plant that is later than that has not begun to move.
    let samples = SHORTEST.max(2 * plant.waiting.len());
    for _ in 0..PATIENCE {
        for _ in 0..samples {
            course.push(plant.step(drive)?);
        }
        let end = course[course.len() - 1];
        let moved = (end - course[course.len() - samples]).abs();
        if moved <= RESTS * (end - course[0]).abs() {
            break;
        }
    }
    Ok(course)
}
