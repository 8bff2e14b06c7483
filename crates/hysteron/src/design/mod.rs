//! The experiment: an input that excites every operator in the shortest time.

mod profile;
mod spiral;

pub use profile::{Rates, ramps};

use crate::error::{Error, Result};
use crate::identify::excitation;
use crate::identify::{Initial, Unresolved};
use crate::model::Excitation;
use crate::model::Plane;
use crate::series::range;
use hysteron_core::Operator;
use spiral::Corners;

/// Most samples of a profile.
const MOST_SAMPLES: f64 = 1e7;

/// Samples a level at the faster rate, where the step is not given: enough to average some noise
/// away.
const SAMPLES_PER_LEVEL: f64 = 10.0;

/// What an experiment is for.
///
/// | field | default | range | purpose |
/// | --- | --- | --- | --- |
/// | `plane` | | | the plane of the model to be identified |
/// | `operator` | MKP | MKP, KP, relay | its elementary operator |
/// | `rates` | | above zero | how fast the input can rise and fall |
/// | `budget_s` | none | enough for one ring | longest duration of the profile, s |
/// | `step_s` | ten samples a level | above zero, at least one sample a level | longest time between samples, s |
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
    /// Options without a budget, for MKP operators.
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
}

/// One branch of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// Input at its start.
    pub from: f64,
    /// Input at its end.
    pub to: f64,
    /// Everett corners that neither recordings nor earlier legs show: 0 where the leg only leads on
    /// to the next.
    pub new_corners: usize,
}

/// A profile, and what is known once it has been recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The plane.
    pub plane: Plane,
    /// Time of each sample in seconds, from 0; empty where nothing is left to measure.
    pub time: Vec<f64>,
    /// Input at each sample; it starts at the bottom of the plane, with every operator off.
    pub input: Vec<f64>,
    /// The branches in order.
    pub legs: Vec<Leg>,
    /// What the recordings alone say of each operator; none without recordings.
    pub recorded: Option<Vec<Excitation>>,
    /// What recordings and profile say of each operator together.
    pub excitation: Vec<Excitation>,
    /// Everett corners `C[p][q]`, `q < p`, known then; with all `N` of them every operator is
    /// determined.
    pub corners: usize,
    /// Duration in seconds without a budget.
    pub full_duration_s: f64,
}

impl Design {
    /// Duration in seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.time.last().copied().unwrap_or_default()
    }

    /// How many operators are of a class once the profile has been recorded.
    #[must_use]
    pub fn count(&self, class: Excitation) -> usize {
        self.excitation.iter().filter(|e| **e == class).count()
    }
}

/// The shortest input profile that determines every operator: a spiral that shrinks from the whole
/// plane to its middle, with one step of a level for each operator. What the inputs `recorded` so
/// far determine already is left out. With a budget that is too short for it all, as many rings of
/// the spiral stay as fit, the outermost first and the others evenly spread.
///
/// The proof that no profile turning at levels is shorter stands in `design/spiral.rs`; what
/// completes recordings is short, not proven to be the shortest. Relays are passed half a step
/// beyond their levels, so that they switch whatever the rounding.
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
/// [`Error::Design`] for rates, a budget or a step that cannot be, a budget too short for one ring,
/// and recordings outside the plane; as [`excitation`] otherwise.
pub fn design(options: &DesignOptions, recorded: &[&[f64]]) -> Result<Design> {
    let step_s = check(options, recorded)?;
    let levels = options.plane.levels();
    let mut known = Corners::none(levels);
    if !recorded.is_empty() {
        known.0 = Unresolved::of(recorded, options.plane, options.operator, Initial::Off)?
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
            "a sample every {step_s:e} s makes {samples:.1e} samples, more than {MOST_SAMPLES:e}: give a longer step, or rates nearer to each other"
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

/// Refuses what cannot be; gives the time between samples.
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
            "in a step of {step} s the input passes more than one level: take at most {level_s:.4} s, or fewer levels"
        )));
    }
    for (n, input) in recorded.iter().enumerate() {
        let (low, high) = range(input);
        if input.is_empty() || plane.normalise(low) >= plane.normalise(high) {
            return Err(Error::Design(format!(
                "recording {} of {} moves no operator: its input lies between {low} and {high}, the plane's active range is {} to {}",
                n + 1,
                recorded.len(),
                plane.bottom(),
                plane.max()
            )));
        }
    }
    Ok(options.step_s.unwrap_or(level_s / SAMPLES_PER_LEVEL))
}

/// As many rings as the budget allows.
fn within_budget(options: &DesignOptions, turns: &[usize]) -> Result<Vec<usize>> {
    let Some(budget) = options.budget_s else {
        return Ok(turns.to_vec());
    };
    let seconds = |turns: &[usize]| options.rates.duration(&inputs(options, turns));
    // A budget that was worked out as the duration allows it, whatever the rounding.
    let fits = |turns: &Vec<usize>| seconds(turns) <= budget * (1.0 + 1e-9);
    let rings = spiral::rings(turns);
    if rings == 0 {
        return Ok(turns.to_vec());
    }
    let selections = (1..=rings).rev().map(|count| spiral::evenly(turns, count));
    selections.into_iter().find(fits).ok_or_else(|| {
        let least = seconds(&spiral::evenly(turns, 1));
        Error::Design(format!(
            "{:.4} min ({budget:.1} s) are too short for a single ring, which takes {:.4} min ({least:.1} s): allow more time or faster rates",
            budget / 60.0,
            least / 60.0
        ))
    })
}

/// The input at a grid position. A relay needs to pass its level, upwards and downwards.
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
