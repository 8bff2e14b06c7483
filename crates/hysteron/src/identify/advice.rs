//! What a fit should make its user look at again.

use crate::error::Result;
use crate::identify::monotone::{AGAINST_INPUT, way_against_input};
use crate::model::{Model, Solver, Start};
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use std::fmt;

/// Part of the operators from which on it matters that a start leaves them open.
const MANY: f64 = 0.05;

/// A doubt about a fit; [`Advice::remedy`] says what may help.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Advice {
    /// Inputs outside the plane's active range were taken as its ends.
    Clipped {
        /// How many.
        inputs: usize,
        /// Of how many.
        samples: usize,
        /// The active range.
        range: (f64, f64),
    },
    /// The output goes against its input, which weights from zero on cannot follow.
    AgainstInput {
        /// The part of its way, from 0 to 1.
        part: f64,
    },
    /// The first input leaves operators open, and all were taken as off.
    OpenStart {
        /// How many.
        operators: usize,
    },
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Clipped {
                inputs,
                samples,
                range: (low, high),
            } => write!(
                f,
                "{inputs} of {samples} inputs lie outside the active range {low:.6} to {high:.6} and were taken as its ends"
            ),
            Self::AgainstInput { part } if *part > 0.5 => write!(
                f,
                "on {:.0} % of its way the output goes the other way than the model's sign allows",
                100.0 * part
            ),
            Self::AgainstInput { part } => write!(
                f,
                "on {:.0} % of its way the output goes against the input, which weights from zero on cannot follow",
                100.0 * part
            ),
            Self::OpenStart { operators } => write!(
                f,
                "the first input leaves {operators} operators open, which are taken as off"
            ),
        }
    }
}

impl Advice {
    /// What may help.
    #[must_use]
    pub fn remedy(&self) -> Remedy {
        match self {
            Self::Clipped { .. } => Remedy::new("widen {}", [Setting::any("range")]),
            Self::AgainstInput { part } if *part > 0.5 => Remedy::new(
                "leave {} out; where it was left out, the output hardly follows from this input",
                [Setting::any("sign")],
            ),
            Self::AgainstInput { .. } => Remedy::new(
                "a butterfly loop needs {}, several loads {}, a drive that heats {}",
                [
                    Setting::word("solver", "ols"),
                    Setting::any("load"),
                    Setting::any("thermal"),
                ],
            ),
            Self::OpenStart { .. } => Remedy::new(
                "if the recording does not begin after the lowest input, use {}",
                [Setting::word("start", "unknown")],
            ),
        }
    }
}

/// What there is to say of a model fitted to these recordings.
///
/// # Errors
/// [`crate::Error::Thermal`] for recordings without time where the model has a thermal body.
pub fn advice(model: &Model, recordings: &[Recording]) -> Result<Vec<Advice>> {
    let plane = model.plane();
    let (mut inputs, mut samples, mut against) = (0, 0, 0.0_f64);
    for recording in recordings {
        let seen = model.behind_body(recording)?;
        inputs += seen
            .input
            .iter()
            .filter(|t| plane.clipped(**t).is_some())
            .count();
        samples += seen.len();
        // A load that changes moves the output by itself.
        if model.load.is_none() {
            against = against.max(way_against_input(&seen, model.sign())?);
        }
    }
    let mut advice = Vec::new();
    if inputs > 0 {
        advice.push(Advice::Clipped {
            inputs,
            samples,
            range: (plane.bottom(), plane.max()),
        });
    }
    if let Some(fit) = &model.fit {
        if fit.solver == Solver::Nnls && against > AGAINST_INPUT {
            advice.push(Advice::AgainstInput { part: against });
        }
        let operators = fit.open_at_start;
        if fit.start == Start::Off && operators as f64 > MANY * plane.operators() as f64 {
            advice.push(Advice::OpenStart { operators });
        }
    }
    Ok(advice)
}
