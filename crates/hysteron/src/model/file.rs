//! The model file: JSON with a version. Every error names the field.
//!
//! Version 2 adds the stages and the start: `load.curves`, `thermal.ambient`, `drive`, `spacing`,
//! `creep`, `lag` and `start`. Version 3 adds `stages`: the constants of all other stages, as lists
//! by the names that the stages declare. Version 4 adds `delay`. A model is written in the lowest
//! version that has what it needs.

mod entries;

use self::entries::{
    DriveEntry, File, InputEntry, LoadEntry, OperatorName, OutputEntry, PlaneEntry, ThermalEntry,
    fault,
};
use crate::error::{Error, Result};
use crate::model::Plane;
use crate::model::constants::{CreepTerm, StageConstants};
use crate::model::load::{LoadDependence, LoadPart};
use crate::model::registration::Registration;
use crate::model::summary::FitSummary;
use crate::model::{Model, Sign};
use crate::recording::{LARGEST, Quantity};
use hysteron_core::{Constant, Operator, Stages};
use serde::Deserialize;
use std::collections::BTreeMap;

pub(crate) const FORMAT: &str = "hysteron-model";
/// The versions that can be read.
const VERSIONS: std::ops::RangeInclusive<u64> = 1..=4;

/// The fields that show whether the rest of the file can be read.
#[derive(Deserialize)]
#[serde(expecting = "a model: an object in braces")]
struct Head {
    format: Option<String>,
    version: Option<serde_json::Value>,
}

/// The error for a file that holds something else.
pub(crate) fn no_model() -> Error {
    let problem = "this is no model: a model is JSON in braces, as a fit writes it";
    fault(".", problem.into())
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
        if !text.trim_start().starts_with('{') {
            return Err(no_model());
        }
        let head: Head = parse(text)?;
        if head.format.as_deref() != Some(FORMAT) {
            let found = head
                .format
                .map_or("is missing".into(), |f| format!("is `{f}`"));
            let problem = format!("{found}, where a model file has `{FORMAT}`");
            return Err(fault("format", problem));
        }
        let version = head.version.as_ref().and_then(serde_json::Value::as_u64);
        if !version.is_some_and(|version| VERSIONS.contains(&version)) {
            let found = head
                .version
                .map_or("none".into(), |found| found.to_string());
            let problem = format!(
                "version {found} is not known, only {} to {}: a newer hysteron may read it",
                VERSIONS.start(),
                VERSIONS.end()
            );
            return Err(fault("version", problem));
        }
        Self::of_file(parse(text)?)
    }

    /// A model from the text that [`Model::to_json_without_weights`] wrote, and its weights.
    #[cfg(feature = "data")]
    pub(crate) fn from_json_and_weights(text: &str, weights: Vec<f64>) -> Result<Self> {
        Self::of_file(File {
            weights,
            ..parse(text)?
        })
    }

    fn of_file(file: File) -> Result<Self> {
        let (needed, field) = file.needed();
        if needed > file.version {
            return Err(fault(field, format!("this needs `version` {needed}")));
        }
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
        if let Some(load) = &model.load {
            agrees_with_parts(&model, load)?;
        }
        model.thermal = file.thermal.map(ThermalEntry::check).transpose()?;
        model.drive = file.drive.map(DriveEntry::check).transpose()?;
        if model.drive.is_some() && model.thermal.is_none() {
            let problem = "it is the range of the drive of a thermal body, and there is none";
            return Err(fault("drive", problem.into()));
        }
        if let Some(problem) = file.delay.fault() {
            return Err(fault("delay", problem));
        }
        model.delay = file.delay;
        let listed = listed(file.creep, file.lag, file.stages)?;
        model.latent = listed.stages().latent.heat;
        model.registration = Registration::of_constants(&listed);
        let behind = listed.stages().behind;
        model.behind = StageConstants::from_stages(&Stages {
            behind,
            ..Stages::NONE
        });
        model.spacing = file.spacing;
        model.check_stages().map_err(|error| {
            let field = match &error {
                Error::Core(hysteron_core::Error::Stage { stage }) => (place(stage), hint(stage)),
                _ => ("spacing".into(), String::new()),
            };
            fault(&field.0, format!("{error}{}", field.1))
        })?;
        let mut model = model
            .with_start(file.start)
            .map_err(|error| fault("start.turning_points", error.to_string()))?;
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
        let file = self.entries(self.weights().to_vec(), self.fit.clone());
        // The file has only numbers and strings, so writing JSON cannot fail.
        serde_json::to_string(&file).unwrap_or_default() + "\n"
    }

    /// As [`Model::to_json`], without the weights and without the confidence in them: what is left
    /// of a model whose weights are kept elsewhere.
    #[cfg(feature = "data")]
    pub(crate) fn to_json_without_weights(&self) -> String {
        let fit = self.fit.clone().map(|fit| FitSummary {
            confidence: None,
            ..fit
        });
        serde_json::to_string(&self.entries(Vec::new(), fit)).unwrap_or_default()
    }

    fn entries(&self, weights: Vec<f64>, fit: Option<FitSummary>) -> File {
        let entry = |quantity: &Quantity| (Some(quantity.name.clone()), quantity.unit.clone());
        let (input_name, input_unit) = entry(&self.input);
        let (output_name, output_unit) = entry(&self.output);
        let plane = self.plane();
        let file = File {
            format: FORMAT.into(),
            version: 1,
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
            weights,
            load: self.load.as_ref().map(LoadEntry::new),
            thermal: self.thermal.map(ThermalEntry::FirstOrder),
            drive: self.drive.map(|(min, max)| DriveEntry { min, max }),
            spacing: self.spacing.clone(),
            creep: self.behind.terms(),
            lag: Some(self.behind.lag()).filter(|lag| *lag > 0.0),
            stages: self.others(),
            delay: self.delay,
            start: self.start.clone(),
            fit,
        };
        let (version, _) = file.needed();
        File { version, ..file }
    }

    /// The constants that version 2 has no entry for.
    fn others(&self) -> BTreeMap<String, Vec<f64>> {
        let constants = self.constants();
        let all = constants.iter();
        let others = all.filter(|(constant, numbers)| {
            !numbers.is_empty() && place(constant.name).starts_with(OTHERS)
        });
        others
            .map(|(constant, numbers)| (constant.name.to_owned(), numbers.to_vec()))
            .collect()
    }
}

/// Weights and offset of a model that depends on a load stand in the file twice: as they are, and as
/// the middle of the parts. They may differ by the rounding of digits, no more.
fn agrees_with_parts(model: &Model, load: &LoadDependence) -> Result<()> {
    const DIGITS: f64 = 1e-6;
    for (n, part) in load.parts().iter().enumerate() {
        let sum: f64 = part.weights.iter().map(|mu| mu.abs()).sum();
        let fits = sum <= LARGEST && part.offset.abs() <= LARGEST;
        if !fits {
            let problem = format!("its sum is beyond {LARGEST:e}: use another unit");
            return Err(fault(&format!("load.parts[{n}]"), problem));
        }
    }
    let middle = LoadPart::at_middle(load.parts());
    let largest = |numbers: &[f64]| numbers.iter().fold(0.0_f64, |most, mu| most.max(mu.abs()));
    let most = largest(&middle.weights).max(largest(model.weights()));
    let pairs = model.weights().iter().zip(&middle.weights);
    let differs = |(mu, of_parts): (&f64, &f64)| (mu - of_parts).abs() > DIGITS * most;
    if let Some(n) = pairs.clone().position(differs) {
        let (mu, of_parts) = (model.weights()[n], middle.weights[n]);
        let problem = format!(
            "weight number {n} (from 0) is {mu}, but {of_parts} in the middle of `load.parts`"
        );
        return Err(fault("weights", problem));
    }
    let (offset, of_parts) = (model.offset(), middle.offset);
    let size = offset.abs().max(of_parts.abs()).max(most);
    match (offset - of_parts).abs() <= DIGITS * size {
        true => Ok(()),
        false => {
            let problem = format!("{offset}, but {of_parts} in the middle of `load.parts`");
            Err(fault("output.offset", problem))
        }
    }
}

/// Where the constants of stages stand that have no entry of their own.
const OTHERS: &str = "stages.";

/// The entry that has a constant of a stage, or that has a whole stage.
fn place(stage: &str) -> String {
    let mut declared = Stages::<f64>::declared();
    let has = |constants: &[Constant]| constants.iter().any(|constant| constant.name == stage);
    let of = declared.find(|declared| has(declared.constants));
    match (of.map(|declared| declared.name), stage) {
        (Some("load"), curve) => format!("load.curves.{curve}"),
        (Some("body"), constant) => format!("thermal.{constant}"),
        (_, "offset") => "output.offset".into(),
        (_, "creep" | "creep_taus") => "creep".into(),
        (Some("spacing" | "lag") | None, entry) => entry.into(),
        (Some(_), constant) => format!("{OTHERS}{constant}"),
    }
}

/// What a constant of a stage has to be.
fn hint(stage: &str) -> String {
    if ["offset", "weights"].contains(&stage) {
        return ": outputs are up to 1e140".into();
    }
    let bound = match stage {
        "latent" => "; it needs a thermal body, no relays and no weight below zero",
        _ => "",
    };
    let mut constants = Stages::<f64>::declared().flat_map(|stage| stage.constants);
    match constants.find(|constant| constant.name == stage) {
        Some(constant) => {
            let words = constant.range.words();
            format!(": {}; {words}{bound}", constant.meaning)
        }
        None => String::new(),
    }
}

/// The constants that stand in lists.
fn listed(
    creep: Vec<CreepTerm>,
    lag: Option<f64>,
    others: BTreeMap<String, Vec<f64>>,
) -> Result<StageConstants<f64>> {
    if let Some(name) = others.keys().find(|name| !place(name).starts_with(OTHERS)) {
        let field = format!("{OTHERS}{name}");
        return Err(fault(&field, "there is no such constant of a stage".into()));
    }
    let of_version_2 = StageConstants::after(&creep, lag.unwrap_or_default());
    let all = of_version_2.and_then(|constants| constants.with(others));
    all.map_err(|error| fault("stages", error.to_string()))
}

fn parse<'a, T: Deserialize<'a>>(text: &'a str) -> Result<T> {
    let mut json = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut json)
        .map_err(|error| fault(&error.path().to_string(), error.inner().to_string()))?;
    json.end().map_err(|error| fault(".", error.to_string()))?;
    Ok(value)
}
