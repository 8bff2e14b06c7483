//! Design of an experiment: the shortest input profile that excites every operator.
//!
//! `spiral` finds the turning points of the profile. `profile` makes ramps over time from them.
//! This file combines both, and takes earlier recordings and a time budget into account. `heated`
//! plans for an actuator whose body heats, in drives.

mod heated;
mod profile;
mod spiral;

pub use heated::design_heated;
pub use profile::{Rates, ramps};

use crate::error::{Error, Result};
use crate::identify::excitation;
use crate::identify::{Initial, Unresolved};
use crate::model::Excitation;
use crate::model::Plane;
use crate::series::range;
use hysteron_core::Operator;
use spiral::Corners;

/// Largest number of samples of a profile.
const MOST_SAMPLES: f64 = 1e7;

/// Default number of samples per level at the faster rate. It is large enough to average out some
/// noise.
const SAMPLES_PER_LEVEL: f64 = 10.0;

/// The options of an experiment.
///
/// | field | default | range | purpose |
/// | --- | --- | --- | --- |
/// | `plane` | | | the plane of the model to be identified |
/// | `operator` | MKP | MKP, KP, relay | its elementary operator |
/// | `rates` | | above 0 | how fast the input can rise and fall |
/// | `budget_s` | none | enough for one ring | longest duration of the profile, s |
/// | `step_s` | 10 samples per level | above 0, 1 sample per level | longest sample interval, s |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesignOptions {
    /// The plane of the model to be identified.
    pub plane: Plane,
    /// Its elementary operator.
    pub operator: Operator,
    /// How fast the input can rise and fall.
    pub rates: Rates,
    /// Longest duration of the profile in seconds.
    pub budget_s: Option<f64>,
    /// Longest time between samples in seconds.
    pub step_s: Option<f64>,
}

impl DesignOptions {
    /// Options for MKP operators without a time budget.
    #[must_use]
    pub fn new(plane: Plane, rates: Rates) -> Self {
        Self {
            plane,
            operator: Operator::Mkp,
            rates,
            budget_s: None,
            step_s: None,
        }
    }

    /// As [`DesignOptions::new`], for a plane of so many `levels` whose profile never leaves the
    /// range from `low` to `high`: its bottom, where every operator is off, is not below `low`. The
    /// lowest level is one step above.
    ///
    /// ```
    /// use hysteron::{DesignOptions, Rates, design};
    /// let rates = Rates { heating: 2.0, cooling: 0.5 };
    /// let found = design(&DesignOptions::within((0.0, 120.0), 20, rates)?, &[])?;
    /// assert!(found.input.iter().all(|volts| (0.0..=120.0).contains(volts)));
    /// assert_eq!(found.plane.min(), 6.0);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Core`] for a range or levels that no plane has.
    pub fn within((low, high): (f64, f64), levels: usize, rates: Rates) -> Result<Self> {
        let mut min = low + (high - low) / levels.max(1) as f64;
        // The bottom is off by a rounding or two.
        loop {
            let plane = Plane::new(min, high, levels)?;
            if plane.bottom() >= low {
                return Ok(Self::new(plane, rates));
            }
            min = min.next_up();
        }
    }
}

/// One branch of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// Input at its start.
    pub from: f64,
    /// Input at its end.
    pub to: f64,
    /// Number of Everett corners that neither the recordings nor earlier legs determine; 0 for a
    /// leg that only leads to the next one.
    pub new_corners: usize,
}

/// An input profile, and what the data will determine once it has been recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The plane.
    pub plane: Plane,
    /// Time of each sample in seconds, from 0; empty if nothing is left to measure.
    pub time: Vec<f64>,
    /// Input at each sample. It starts at the bottom of the plane, where every operator is off.
    pub input: Vec<f64>,
    /// The branches in order.
    pub legs: Vec<Leg>,
    /// How well the recordings alone determine each operator; `None` without recordings.
    pub recorded: Option<Vec<Excitation>>,
    /// How well the recordings and the profile together determine each operator.
    pub excitation: Vec<Excitation>,
    /// Number of Everett corners `C[p][q]`, `q < p`, that are known after the profile. With all `N`
    /// of them every operator is determined.
    pub corners: usize,
    /// Duration in seconds of the profile without a budget.
    pub full_duration_s: f64,
}

impl Design {
    /// Duration in seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.time.last().copied().unwrap_or_default()
    }

    /// Number of operators in a class after the profile has been recorded.
    #[must_use]
    pub fn count(&self, class: Excitation) -> usize {
        self.excitation.iter().filter(|e| **e == class).count()
    }
}

/// The shortest input profile that determines every operator: a spiral that shrinks from the whole
/// plane to its middle, with one step of a level for each operator.
///
/// What the inputs `recorded` so far determine is left out. If the budget is too short for the
/// whole profile, only as many rings of the spiral are kept as fit. The outermost ring comes first
/// and the others are evenly spread.
///
/// The proof that no profile with turning points at levels is shorter is in `design/spiral.rs`. A
/// profile that completes recordings is short, but not proven to be the shortest. For relays the
/// input goes half a step beyond the levels, so that they switch in spite of rounding.
///
/// ```
/// use hysteron::{DesignOptions, Excitation, Plane, Rates, design};
/// let plane = Plane::new(20.0, 80.0, 20)?;
/// let rates = Rates { heating: 2.0, cooling: 0.5 }; // degC/s
/// let profile = design(&DesignOptions::new(plane, rates), &[])?;
/// assert_eq!(profile.count(Excitation::Determined), 210);
/// let rises = 110.0 * plane.step(); // of 210 steps, to end at level 10
/// let falls = 100.0 * plane.step();
/// assert!((profile.duration_s() - (rises / 2.0 + falls / 0.5)).abs() < 1e-6);
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// # Errors
/// [`Error::Design`] for invalid rates, budgets and steps, for a budget too short for one ring, and
/// for recordings outside the plane; otherwise as [`excitation`].
pub fn design(options: &DesignOptions, recorded: &[&[f64]]) -> Result<Design> {
    let step_s = check(options, recorded)?;
    let levels = options.plane.levels();
    let mut known = Corners::none(levels);
    if !recorded.is_empty() {
        known.0 = Unresolved::new(recorded, options.plane, options.operator, Initial::Off)?
            .corners_known();
    }
    let wanted = spiral::completing(levels, &known);
    let turns = within_budget(options, &wanted)?;
    let mut legs = Vec::new();
    for leg in turns.windows(2) {
        legs.push(Leg {
            from: input_at(options, leg[0]),
            to: input_at(options, leg[1]),
            new_corners: known.add(leg[0], leg[1]),
        });
    }
    let samples = options.rates.duration(&inputs(options, &turns)) / step_s;
    if samples > MOST_SAMPLES {
        return Err(Error::Design(format!(
            "a sample every {step_s:e} s makes {samples:.1e} samples, more than {MOST_SAMPLES:e}: \
             give a longer step, or rates nearer to each other"
        )));
    }
    let (time, input) = match legs.is_empty() {
        true => (Vec::new(), Vec::new()),
        false => ramps(&inputs(options, &turns), options.rates, step_s),
    };
    let classes = |inputs: &[&[f64]]| excitation(inputs, options.plane, options.operator);
    let all: Vec<&[f64]> = recorded.iter().copied().chain([&input[..]]).collect();
    Ok(Design {
        plane: options.plane,
        recorded: (!recorded.is_empty())
            .then(|| classes(recorded))
            .transpose()?,
        excitation: classes(&all)?,
        time,
        input,
        legs,
        corners: known.count(),
        full_duration_s: options.rates.duration(&inputs(options, &wanted)),
    })
}

/// Checks the options and returns the time between samples.
fn check(options: &DesignOptions, recorded: &[&[f64]]) -> Result<f64> {
    options.rates.check()?;
    let plane = options.plane;
    for (name, seconds) in [("budget", options.budget_s), ("step", options.step_s)] {
        if let Some(seconds) = seconds.filter(|s| !(s.is_finite() && *s > 0.0)) {
            return Err(Error::Design(format!(
                "the {name} is {seconds} s, but must be above zero"
            )));
        }
    }
    let level_s = plane.step() / options.rates.fastest();
    if let Some(step) = options.step_s.filter(|step| *step > level_s * (1.0 + 1e-9)) {
        return Err(Error::Design(format!(
            "in a step of {step} s the input passes more than one level: \
             take at most {level_s:.4} s, or fewer levels"
        )));
    }
    for (n, input) in recorded.iter().enumerate() {
        let (low, high) = range(input);
        if input.is_empty() || plane.normalise(low) >= plane.normalise(high) {
            return Err(Error::Design(format!(
                "recording {} of {} moves no operator: its input lies between {low} and {high}, \
                 the plane's active range is {} to {}",
                n + 1,
                recorded.len(),
                plane.bottom(),
                plane.max()
            )));
        }
    }
    Ok(options.step_s.unwrap_or(level_s / SAMPLES_PER_LEVEL))
}

/// The turning points of as many rings as the budget allows.
fn within_budget(options: &DesignOptions, turns: &[usize]) -> Result<Vec<usize>> {
    let Some(budget) = options.budget_s else {
        return Ok(turns.to_vec());
    };
    let seconds = |turns: &[usize]| options.rates.duration(&inputs(options, turns));
    // A user may give exactly the duration as the budget. Allow for rounding.
    let fits = |turns: &Vec<usize>| seconds(turns) <= budget * (1.0 + 1e-9);
    let rings = spiral::rings(turns);
    if rings == 0 {
        return Ok(turns.to_vec());
    }
    let selections = (1..=rings).rev().map(|count| spiral::evenly(turns, count));
    selections.into_iter().find(fits).ok_or_else(|| {
        let least = seconds(&spiral::evenly(turns, 1));
        Error::Design(format!(
            "{:.4} min ({budget:.1} s) are too short for a single ring, which takes {:.4} min \
             ({least:.1} s): allow more time or faster rates",
            budget / 60.0,
            least / 60.0
        ))
    })
}

/// The input at a grid position. For relays it lies beyond the level, in both directions.
fn input_at(options: &DesignOptions, position: usize) -> f64 {
    let beyond = match options.operator {
        Operator::Mkp | Operator::Kp => 0.0,
        Operator::Relay => 0.5,
    };
    options.plane.denormalise(position as f64 + beyond)
}

fn inputs(options: &DesignOptions, turns: &[usize]) -> Vec<f64> {
    turns.iter().map(|&turn| input_at(options, turn)).collect()
}
