//! Who chooses what a fleet's fits leave to the data, and what came of it.

use super::signs::Usual;
use crate::error::{Error, Result};
use crate::identify::Chosen;
use crate::model::{Model, Smooth, Start};
use serde::Serialize;
use serde_json::{Value, json};
use std::fmt;
use std::str::FromStr;

/// Who chooses levels, smoothness, start, spacing and stages of a fleet, where they are left to the
/// data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FleetChoice {
    /// Some actuators, spread over the data, for all.
    #[default]
    Pilots,
    /// Each actuator for itself, as its fit alone.
    Each,
}

impl FromStr for FleetChoice {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        match text {
            "pilots" => Ok(Self::Pilots),
            "each" => Ok(Self::Each),
            _ => Err(Error::Fit(format!(
                "`choice` cannot be `{text}`: `pilots` or `each` is needed"
            ))),
        }
    }
}

/// What the pilots chose for the fleet.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FleetShared {
    /// Number of pilots.
    pub pilots: usize,
    /// The choices; several where the fleet has several kinds of actuators. An actuator takes the
    /// one that predicts best what is left out of it.
    pub kinds: Vec<FleetKind>,
    /// The largest error of a pilot on what is left out, in multiples of that of its own choice.
    pub worst: f64,
}

/// A choice of the pilots.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FleetKind {
    /// What is taken.
    #[serde(flatten)]
    pub chosen: Chosen,
    /// Number of pilots that it predicts best.
    pub pilots: usize,
    /// Median error on what is left out of all pilots that it serves, in percent of the measured
    /// range.
    pub left_out_percent: f64,
    /// Errors outside of these limits are unusual for this kind.
    pub usual_percent: (f64, f64),
    /// Limits of these errors and of the loops.
    #[serde(skip)]
    pub(super) usual: Usual,
}

/// An actuator that the choice of the pilots does not fit, so it has chosen by itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FleetAlone {
    /// The actuator.
    pub id: String,
    /// Its error on what is left out with the choice of the pilots, in percent of its range; `None`
    /// where no fit succeeds with it.
    pub shared_percent: Option<f64>,
    /// The same with its own choice.
    pub own_percent: f64,
}

/// The entry of the record of a fit that says whose choice it has.
const RECORD: &str = "fleet_choice";

impl FleetAlone {
    /// Says in the record of the fit that the actuator has chosen by itself.
    pub(super) fn record(model: &mut Model, shared: Option<f64>, own: f64) {
        let own = json!({"of": "own", "shared_percent": shared, "own_percent": own});
        write(model, own);
    }

    /// Reads what [`FleetAlone::record`] wrote, from the text of a model in a table.
    pub(super) fn from_record(id: &str, model: &str) -> Option<Self> {
        // Few have it, and a search costs less than all of the text's values.
        if !model.contains(RECORD) {
            return None;
        }
        let model: Value = serde_json::from_str(model).ok()?;
        let said = &model["fit"][RECORD];
        Some(Self {
            id: id.to_owned(),
            shared_percent: said["shared_percent"].as_f64(),
            own_percent: said["own_percent"].as_f64()?,
        })
    }
}

impl FleetShared {
    /// Says in the record of the fit that it has the choice of this kind.
    pub(super) fn record(&self, model: &mut Model, kind: usize) {
        let shared = json!({"of": "pilots", "pilots": self.pilots, "kind": kind + 1});
        write(model, shared);
    }
}

fn write(model: &mut Model, said: Value) {
    if let Some(fit) = &mut model.fit {
        fit.other.insert(RECORD.into(), said);
    }
}

impl fmt::Display for FleetShared {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{} pilots chose for all: ", self.pilots)?;
        for (n, kind) in self.kinds.iter().enumerate() {
            let comma = if n > 0 { "; or " } else { "" };
            write!(to, "{comma}{}", Words(&kind.chosen))?;
            if self.kinds.len() > 1 {
                write!(to, " ({} of them)", kind.pilots)?;
            }
        }
        let worst = self.worst.max(1.0);
        write!(
            to,
            ". What is left out of them is predicted with at most {worst:.2} times the error of \
             their own choices"
        )
    }
}

impl fmt::Display for FleetAlone {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (id, own) = (&self.id, self.own_percent);
        match self.shared_percent {
            Some(shared) => write!(
                to,
                "{id}: chosen by itself: what is left out of it is predicted to {own:.3} % of its \
                 range, and to {shared:.3} % with the choice for all"
            ),
            None => write!(
                to,
                "{id}: chosen by itself: the choice for all does not fit it"
            ),
        }
    }
}

/// A choice in words.
struct Words<'a>(&'a Chosen);

impl fmt::Display for Words<'_> {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Chosen {
            levels,
            smooth,
            start,
            rest,
            spacing,
            delay,
            rings,
            heated,
        } = self.0;
        write!(to, "levels {levels}, smoothness ")?;
        match smooth {
            smooth if smooth.is_none() => write!(to, "off")?,
            Smooth { along, across } => write!(to, "{along:e},{across:e}")?,
        }
        match (start, rest) {
            (Start::Rest, Some([a, b])) if a == b => write!(to, ", at rest at {a:.4}")?,
            (Start::Rest, Some([a, b])) => write!(to, ", at rest at {a:.4}, then {b:.4}")?,
            (Start::Rest, None) => write!(to, ", at a rest that each finds")?,
            (Start::On, _) => write!(to, ", start on")?,
            (Start::Unknown, _) => write!(to, ", start unknown")?,
            (Start::Off | Start::Fitted, _) => write!(to, ", start off")?,
        }
        match spacing {
            Some(_) => write!(to, ", levels where the output moves")?,
            None => write!(to, ", levels at equal distances")?,
        }
        match delay {
            0 => {}
            1 => write!(to, ", a delay of 1 sample")?,
            delay => write!(to, ", a delay of {delay} samples")?,
        }
        to.write_str(if *rings { ", with a resonance" } else { "" })?;
        to.write_str(if *heated { ", with a thermal body" } else { "" })
    }
}
