//! The entries of a model file.

use crate::error::{Error, Result};
use crate::model::Model;
use crate::model::body::{FirstOrder, range_of};
use crate::model::constants::CreepTerm;
use crate::model::delay::Delay;
use crate::model::load::{LoadCurves, LoadDependence, LoadPart};
use crate::model::operators::FittedStart;
use crate::model::summary::FitSummary;
use crate::recording::Quantity;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub(super) struct File {
    pub(super) format: String,
    pub(super) version: u64,
    pub(super) operator: OperatorName,
    pub(super) plane: PlaneEntry,
    #[serde(default)]
    pub(super) input: InputEntry,
    #[serde(default)]
    pub(super) output: OutputEntry,
    pub(super) weights: Vec<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) load: Option<LoadEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) thermal: Option<ThermalEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) drive: Option<DriveEntry>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) spacing: Vec<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) creep: Vec<CreepTerm>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) lag: Option<f64>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) stages: BTreeMap<String, Vec<f64>>,
    #[serde(default, skip_serializing_if = "Delay::is_none")]
    pub(super) delay: Delay,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) start: Option<FittedStart>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) fit: Option<FitSummary>,
}

impl File {
    /// The version that is needed, and an entry that needs it.
    pub(super) fn needed(&self) -> (u64, &'static str) {
        if !self.delay.is_none() {
            return (4, "delay");
        }
        if !self.stages.is_empty() {
            return (3, "stages");
        }
        let curves = self.load.as_ref().is_some_and(|load| load.curves.is_some());
        let ambient = |ThermalEntry::FirstOrder(body): &ThermalEntry| body.ambient != 0.0;
        [
            ("load.curves", curves),
            (
                "thermal.ambient",
                self.thermal.as_ref().is_some_and(ambient),
            ),
            ("drive", self.drive.is_some()),
            ("spacing", !self.spacing.is_empty()),
            ("creep", !self.creep.is_empty()),
            ("lag", self.lag.is_some()),
            ("start", self.start.is_some()),
        ]
        .into_iter()
        .find_map(|(name, present)| present.then_some((2, name)))
        .unwrap_or((1, "format"))
    }
}

/// The drives that the actuator was recorded with.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub(super) struct DriveEntry {
    pub(super) min: f64,
    pub(super) max: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum OperatorName {
    Mkp,
    Kp,
    Relay,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub(super) struct PlaneEntry {
    pub(super) min: f64,
    pub(super) max: f64,
    pub(super) levels: usize,
}

#[derive(Serialize, Deserialize, Default)]
#[serde(default, deny_unknown_fields, expecting = "an object in braces")]
pub(super) struct InputEntry {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) unit: Option<String>,
}

#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "an object in braces")]
pub(super) struct OutputEntry {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) unit: Option<String>,
    pub(super) offset: f64,
    pub(super) sign: i64,
}

/// Weights that depend on a load. `weights` and `offset` of the file are then those at the middle
/// of its range.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub(super) struct LoadEntry {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) unit: Option<String>,
    pub(super) min: f64,
    pub(super) max: f64,
    /// One entry for each Bernstein polynomial, from the smallest load on.
    pub(super) parts: Vec<LoadPart>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) curves: Option<LoadCurves>,
}

#[derive(Serialize, Deserialize)]
#[serde(
    tag = "kind",
    rename_all = "kebab-case",
    expecting = "an object in braces"
)]
pub(super) enum ThermalEntry {
    FirstOrder(FirstOrder),
}

impl ThermalEntry {
    pub(super) fn check(self) -> Result<FirstOrder> {
        let Self::FirstOrder(body) = self;
        match body.fault() {
            None => Ok(body),
            Some((field, value)) => Err(fault(
                &format!("thermal.{field}"),
                format!("{value} is not {}", range_of(field)),
            )),
        }
    }
}

impl Default for OutputEntry {
    fn default() -> Self {
        Self {
            name: None,
            unit: None,
            offset: 0.0,
            sign: 1,
        }
    }
}

impl LoadEntry {
    pub(super) fn new(load: &LoadDependence) -> Self {
        let (min, max) = load.range();
        Self {
            name: Some(load.quantity.name.clone()),
            unit: load.quantity.unit.clone(),
            min,
            max,
            parts: load.parts().to_vec(),
            curves: load.curves.clone(),
        }
    }

    pub(super) fn into_load(self, model: &Model) -> Result<LoadDependence> {
        let (min, max) = (self.min, self.max);
        if !(min.is_finite() && max.is_finite() && min < max) {
            let problem = format!("the range {min} to {max} must be finite, the smaller end first");
            return Err(fault("load", problem));
        }
        if self.parts.is_empty() {
            return Err(fault("load.parts", "there are none".into()));
        }
        let name = self.name.unwrap_or_else(|| "load".into());
        let quantity = Quantity {
            name,
            unit: self.unit,
        };
        let load = LoadDependence::new(quantity, (min, max), self.parts, model.operators());
        let mut load =
            load.map_err(|(n, error)| fault(&format!("load.parts[{n}]"), error.to_string()))?;
        if self
            .curves
            .as_ref()
            .is_some_and(|curves| curves.loads.is_empty())
        {
            return Err(fault("load.curves.loads", "there are none".into()));
        }
        if let Some(curves) = &self.curves
            && !curves.loads.iter().any(|load| (min..=max).contains(load))
        {
            let problem = format!("none of them is within the loads of the model, {min} to {max}");
            return Err(fault("load.curves.loads", problem));
        }
        load.curves = self.curves;
        Ok(load)
    }
}

impl DriveEntry {
    pub(super) fn check(self) -> Result<(f64, f64)> {
        let Self { min, max } = self;
        match min.is_finite() && max.is_finite() && min <= max {
            true => Ok((min, max)),
            false => {
                let what = format!("the range {min} to {max} must be finite and in order");
                Err(fault("drive", what))
            }
        }
    }
}

pub(super) fn fault(field: &str, problem: String) -> Error {
    Error::ModelFile {
        path: None,
        field: field.into(),
        problem,
    }
}
