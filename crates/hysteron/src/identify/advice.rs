//! Warnings about a fit: signs in the data that the model may not be what the user expects.

use crate::error::Result;
use crate::identify::choose::MANY_OPEN;
use crate::identify::monotone::{AGAINST_INPUT, way_against_input};
use crate::model::{Model, Solver, Start};
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use std::fmt;

/// A warning about a fit. [`Advice::remedy`] suggests what may help.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Advice {
    /// Inputs outside the plane's active range were clipped to its ends.
    Clipped {
        /// Number of inputs outside.
        inputs: usize,
        /// Number of inputs in all.
        samples: usize,
        /// Lowest and highest input of the active range.
        range: (f64, f64),
    },
    /// The output moves against its input. Non-negative weights cannot follow that.
    AgainstInput {
        /// The share of the output's path on which it does so, from 0 to 1.
        part: f64,
    },
    /// The first input does not determine the state of some operators, and all of these were taken
    /// as off.
    OpenStart {
        /// Number of these operators.
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
                "{inputs} of {samples} inputs lie outside the active range {low:.6} to {high:.6} \
                 and were clipped to its ends"
            ),
            Self::AgainstInput { part } if *part > 0.5 => write!(
                f,
                "on {:.0} % of its path the output moves against the sign of the model",
                100.0 * part
            ),
            Self::AgainstInput { part } => write!(
                f,
                "on {:.0} % of its path the output moves against the input, which non-negative \
                 weights cannot follow",
                100.0 * part
            ),
            Self::OpenStart { operators } => write!(
                f,
                "the first input does not determine the state of {operators} operators: they are \
                 taken as off"
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
                "leave {} out; if it was not set, the output hardly depends on this input",
                [Setting::any("sign")],
            ),
            Self::AgainstInput { .. } => Remedy::new(
                "use {} for a butterfly loop, {} for several loads, {} for a drive that heats",
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

/// The warnings for a `model` that was fitted to `recordings`.
///
/// # Errors
/// [`crate::Error::Thermal`] for recordings without time if the model has a thermal body.
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
        // A load that changes moves the output by itself, so the test says nothing then.
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
        if fit.start == Start::Off && operators as f64 > MANY_OPEN * plane.operators() as f64 {
            advice.push(Advice::OpenStart { operators });
        }
    }
    Ok(advice)
}
