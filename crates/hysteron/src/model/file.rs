//! The model file: JSON with a version. Every error names the field.

use crate::error::{Error, Result};
use crate::model::Plane;
use crate::model::body::FirstOrder;
use crate::model::load::{LoadDependence, LoadPart};
use crate::model::summary::FitSummary;
use crate::model::{Model, Sign};
use crate::recording::{LARGEST, Quantity};
use hysteron_core::Operator;
use serde::{Deserialize, Serialize};

const FORMAT: &str = "hysteron-model";
const VERSION: u64 = 1;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
struct File {
    format: String,
    version: u64,
    operator: OperatorName,
    plane: PlaneEntry,
    #[serde(default)]
    input: InputEntry,
    #[serde(default)]
    output: OutputEntry,
    weights: Vec<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    load: Option<LoadEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    thermal: Option<ThermalEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fit: Option<FitSummary>,
}

/// The fields that show whether the rest of the file can be read.
#[derive(Deserialize)]
#[serde(expecting = "a model: an object in braces")]
struct Head {
    format: Option<String>,
    version: Option<serde_json::Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum OperatorName {
    Mkp,
    Kp,
    Relay,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
struct PlaneEntry {
    min: f64,
    max: f64,
    levels: usize,
}

#[derive(Serialize, Deserialize, Default)]
#[serde(default, deny_unknown_fields, expecting = "an object in braces")]
struct InputEntry {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
}

#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "an object in braces")]
struct OutputEntry {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    offset: f64,
    sign: i64,
}

/// Weights that depend on a load. `weights` and `offset` of the file are then those at the middle
/// of its range.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
struct LoadEntry {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    min: f64,
    max: f64,
    /// One entry for each Bernstein polynomial, from the smallest load on.
    parts: Vec<LoadPart>,
}

#[derive(Serialize, Deserialize)]
#[serde(
    tag = "kind",
    rename_all = "kebab-case",
    expecting = "an object in braces"
)]
enum ThermalEntry {
    FirstOrder(FirstOrder),
}

impl ThermalEntry {
    fn check(self) -> Result<FirstOrder> {
        let Self::FirstOrder(body) = self;
        match body.fault() {
            None => Ok(body),
            Some((field, value)) => Err(fault(
                &format!("thermal.{field}"),
                format!("{value} is not a finite number above zero"),
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

impl Model {
    /// Reads the text of a model file.
    ///
    /// ```
    /// let text = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
    ///     "plane": {"min": 0, "max": 1, "levels": 2}, "weights": [1, 2]}"#;
    /// let error = hysteron::Model::from_json(text).unwrap_err();
    /// let expected = "field `weights`: 2 weights where K(K+1)/2 = 3 are needed";
    /// assert!(error.to_string().contains(expected));
    /// ```
    ///
    /// # Errors
    /// As [`Model::read`].
    pub fn from_json(text: &str) -> Result<Self> {
        let text = text.trim_start_matches('\u{feff}');
        let head: Head = parse(text)?;
        if head.format.as_deref() != Some(FORMAT) {
            let found = head
                .format
                .map_or("is missing".into(), |f| format!("is `{f}`"));
            let problem = format!("{found}, where a model file has `{FORMAT}`");
            return Err(fault("format", problem));
        }
        match head.version {
            Some(version) if version == VERSION => {}
            found => {
                let found = found.map_or("none".into(), |v| v.to_string());
                let problem = format!(
                    "version {found} is not known, only {VERSION}: \
                     a newer hysteron may read this file"
                );
                return Err(fault("version", problem));
            }
        }
        let file: File = parse(text)?;
        let in_field = |field: &'static str| {
            move |error: hysteron_core::Error| fault(field, error.to_string())
        };
        let PlaneEntry { min, max, levels } = file.plane;
        let plane = Plane::new(min, max, levels).map_err(in_field("plane"))?;
        if min.abs().max(max.abs()) > LARGEST {
            let problem =
                format!("{min:e} to {max:e} is too large to be squared: use another unit");
            return Err(fault("plane", problem));
        }
        let sign = match file.output.sign {
            1 => Sign::Positive,
            -1 => Sign::Negative,
            other => return Err(fault("output.sign", format!("{other} is neither 1 nor -1"))),
        };
        let operator = match file.operator {
            OperatorName::Mkp => Operator::Mkp,
            OperatorName::Kp => Operator::Kp,
            OperatorName::Relay => Operator::Relay,
        };
        let model = Model::new(operator, plane, file.weights, file.output.offset, sign);
        let mut model = model.map_err(|error| match error {
            Error::Core(error) => fault("weights", error.to_string()),
            other => other,
        })?;
        model.input.unit = file.input.unit;
        model.output.unit = file.output.unit;
        if let Some(name) = file.input.name {
            model.input.name = name;
        }
        if let Some(name) = file.output.name {
            model.output.name = name;
        }
        model.load = file.load.map(|entry| entry.into_load(&model)).transpose()?;
        model.thermal = file.thermal.map(ThermalEntry::check).transpose()?;
        let confidence = file.fit.as_ref().and_then(|fit| fit.confidence.as_ref());
        if let Some((field, problem)) = confidence.and_then(|c| c.fault(plane.operators())) {
            return Err(fault(&format!("fit.confidence.{field}"), problem));
        }
        model.fit = file.fit;
        Ok(model)
    }

    /// The text of this model's file.
    #[must_use]
    pub fn to_json(&self) -> String {
        let entry = |quantity: &Quantity| (Some(quantity.name.clone()), quantity.unit.clone());
        let (input_name, input_unit) = entry(&self.input);
        let (output_name, output_unit) = entry(&self.output);
        let plane = self.plane();
        let file = File {
            format: FORMAT.into(),
            version: VERSION,
            operator: match self.operator() {
                Operator::Mkp => OperatorName::Mkp,
                Operator::Kp => OperatorName::Kp,
                Operator::Relay => OperatorName::Relay,
            },
            plane: PlaneEntry {
                min: plane.min(),
                max: plane.max(),
                levels: plane.levels(),
            },
            input: InputEntry {
                name: input_name,
                unit: input_unit,
            },
            output: OutputEntry {
                name: output_name,
                unit: output_unit,
                offset: self.offset(),
                sign: self.sign().factor() as i64,
            },
            weights: self.weights().to_vec(),
            load: self.load.as_ref().map(LoadEntry::of),
            thermal: self.thermal.map(ThermalEntry::FirstOrder),
            fit: self.fit.clone(),
        };
        // The file has only numbers and strings, so writing JSON cannot fail.
        serde_json::to_string(&file).unwrap_or_default() + "\n"
    }
}

impl LoadEntry {
    fn of(load: &LoadDependence) -> Self {
        let (min, max) = load.range();
        Self {
            name: Some(load.quantity.name.clone()),
            unit: load.quantity.unit.clone(),
            min,
            max,
            parts: load.parts().to_vec(),
        }
    }

    fn into_load(self, model: &Model) -> Result<LoadDependence> {
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
        load.map_err(|(n, error)| fault(&format!("load.parts[{n}]"), error.to_string()))
    }
}

fn parse<'a, T: Deserialize<'a>>(text: &'a str) -> Result<T> {
    let mut json = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut json)
        .map_err(|error| fault(&error.path().to_string(), error.inner().to_string()))?;
    json.end().map_err(|error| fault(".", error.to_string()))?;
    Ok(value)
}

fn fault(field: &str, problem: String) -> Error {
    Error::ModelFile {
        path: None,
        field: field.into(),
        problem,
    }
}
