//! A row of a fleet's table: an actuator and its model.

use super::shape::Shape;
use crate::data::{Kind, Schema, Value, read_records};
use crate::error::{Error, Result};
use crate::model::Model;
use hysteron_core::Operator;
use std::path::Path;

/// The columns of the table. All that is no column is in the text `model`: a model file without its
/// weights.
pub(super) const COLUMNS: &Schema = &[
    ("id", Kind::Text),
    ("file", Kind::Text),
    ("digest", Kind::Text),
    ("samples", Kind::Integer),
    ("rmse", Kind::Number),
    ("max_abs", Kind::Number),
    ("nrmse_percent", Kind::Number),
    ("held_out_percent", Kind::Number),
    ("stroke", Kind::Number),
    ("width", Kind::Number),
    ("slope", Kind::Number),
    ("position", Kind::Number),
    ("operator", Kind::Text),
    ("min", Kind::Number),
    ("max", Kind::Number),
    ("levels", Kind::Integer),
    ("spacing", Kind::Numbers),
    ("offset", Kind::Number),
    ("sign", Kind::Integer),
    ("weights", Kind::Numbers),
    ("weights_not_zero", Kind::Integer),
    ("start", Kind::Text),
    ("outliers", Kind::Integer),
    ("branches", Kind::Integer),
    ("rank", Kind::Integer),
    ("unknowns", Kind::Integer),
    ("condition", Kind::Number),
    ("noise", Kind::Number),
    ("sensor", Kind::Number),
    ("replicates", Kind::Integer),
    ("offset_error", Kind::Number),
    ("standard_error", Kind::Numbers),
    ("warnings", Kind::Text),
    ("model", Kind::Text),
];

/// An actuator of a fleet and its model.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetRow {
    /// The label of the actuator, or the name of its file without the ending.
    pub id: String,
    /// The file that its recording is from.
    pub file: String,
    /// SHA-256 of the samples fitted, in hexadecimal.
    pub digest: String,
    /// The model. One that was read from a table has no confidence: the table holds numbers of it,
    /// but not the band.
    pub model: Model,
    /// The model in a few numbers.
    pub shape: Shape,
    /// What there is to say of recording and fit.
    pub warnings: Vec<String>,
}

impl FleetRow {
    /// The row of a model that was fitted by itself.
    #[must_use]
    pub fn of_model(id: &str, model: Model) -> Self {
        let fit = model.fit.as_ref();
        let known = |text: Option<&String>| text.cloned().unwrap_or_default();
        let file = known(fit.and_then(|fit| fit.file.as_ref()));
        let digest = known(fit.and_then(|fit| fit.sha256.as_ref()));
        Self::new(id, file, digest, model, Vec::new())
    }

    pub(super) fn new(
        id: &str,
        file: String,
        digest: String,
        model: Model,
        warnings: Vec<String>,
    ) -> Self {
        Self {
            id: id.to_owned(),
            file,
            digest,
            shape: Shape::new(&model),
            model,
            warnings,
        }
    }

    /// The values, in the order of the columns.
    pub(super) fn values(&self) -> Vec<Value> {
        let model = &self.model;
        let text = |text: &str| Value::Text(text.to_owned());
        let count = |count: usize| Value::Integer(count as i64);
        let numbers = |numbers: &[f64]| match numbers {
            [] => Value::None,
            numbers => Value::Numbers(numbers.to_vec()),
        };
        let fit = model.fit.as_ref();
        let of_fit =
            |number: fn(&crate::model::FitSummary) -> Value| fit.map_or(Value::None, number);
        let confidence = fit.and_then(|fit| fit.confidence.as_ref());
        let trusted =
            |number: fn(&crate::model::Confidence) -> Value| confidence.map_or(Value::None, number);
        let held_out = fit
            .and_then(|fit| {
                fit.other
                    .get("hold_out")?
                    .get("model")?
                    .get("nrmse_percent")
            })
            .and_then(serde_json::Value::as_f64);
        let plane = model.plane();
        let optional = |number: Option<f64>| number.map_or(Value::None, Value::Number);
        vec![
            text(&self.id),
            text(&self.file),
            text(&self.digest),
            of_fit(|fit| Value::Integer(fit.samples as i64)),
            of_fit(|fit| Value::Number(fit.rmse)),
            of_fit(|fit| Value::Number(fit.max_abs)),
            of_fit(|fit| Value::Number(fit.nrmse_percent)),
            optional(held_out),
            Value::Number(self.shape.stroke),
            optional(self.shape.width),
            optional(self.shape.slope),
            optional(self.shape.position),
            text(match model.operator() {
                Operator::Mkp => "mkp",
                Operator::Kp => "kp",
                Operator::Relay => "relay",
            }),
            Value::Number(plane.min()),
            Value::Number(plane.max()),
            count(plane.levels()),
            numbers(model.spacing()),
            Value::Number(model.offset()),
            Value::Integer(model.sign().factor() as i64),
            numbers(model.weights()),
            of_fit(|fit| Value::Integer(fit.weights_not_zero as i64)),
            of_fit(|fit| {
                let start = fit.start.name();
                Value::Text(start.to_owned())
            }),
            of_fit(|fit| Value::Integer(fit.outliers.len() as i64)),
            trusted(|found| Value::Integer(found.branches as i64)),
            trusted(|found| Value::Integer(found.rank as i64)),
            trusted(|found| Value::Integer(found.unknowns as i64)),
            trusted(|found| Value::Number(found.condition)),
            trusted(|found| Value::Number(found.noise)),
            trusted(|found| Value::Number(found.sensor)),
            trusted(|found| Value::Integer(found.replicates as i64)),
            trusted(|found| Value::Number(found.offset_error)),
            trusted(|found| Value::Numbers(found.standard_error.clone())),
            match self.warnings.is_empty() {
                true => Value::None,
                false => text(&self.warnings.join("\n")),
            },
            text(&model.to_json_without_weights()),
        ]
    }

    /// The row of these values.
    fn from_values(values: Vec<Value>) -> Result<Self> {
        let mut named = COLUMNS.iter().map(|(name, _)| *name).zip(values);
        let mut next = |wanted: &str| {
            let found = named.find(|(name, _)| *name == wanted);
            found.map_or(Value::None, |(_, value)| value)
        };
        // In the order of the columns.
        let [id, file, digest] = ["id", "file", "digest"].map(|name| text_of(name, next(name)));
        let weights = match next("weights") {
            Value::Numbers(weights) => weights,
            _ => return Err(lacks("weights")),
        };
        let warnings = match next("warnings") {
            Value::Text(warnings) => warnings.lines().map(str::to_owned).collect(),
            _ => Vec::new(),
        };
        let model = text_of("model", next("model"))?;
        let model = Model::from_json_and_weights(&model, weights)?;
        Ok(Self {
            id: id?,
            file: file?,
            digest: digest?,
            shape: Shape::new(&model),
            model,
            warnings,
        })
    }
}

fn text_of(name: &str, value: Value) -> Result<String> {
    match value {
        Value::Text(text) => Ok(text),
        _ => Err(lacks(name)),
    }
}

fn lacks(column: &str) -> Error {
    Error::Recording {
        path: None,
        row: None,
        column: Some(column.to_owned()),
        problem: "a table of models has this column in every row: write it with a fit of a fleet"
            .into(),
    }
}

/// Reads a fleet's table and hands each row to `take`, until that returns false.
///
/// # Errors
/// [`Error::File`]; [`Error::Recording`] for a file that is no such table; [`Error::ModelFile`] for
/// a model that is not valid; the error of `take`.
pub fn read_fleet(path: &Path, mut take: impl FnMut(FleetRow) -> Result<bool>) -> Result<()> {
    read_records(path, COLUMNS, |values| {
        let row = FleetRow::from_values(values).map_err(|error| match error {
            Error::Recording {
                row,
                column,
                problem,
                ..
            } => Error::Recording {
                path: Some(path.to_owned()),
                row,
                column,
                problem,
            },
            other => other,
        })?;
        take(row)
    })
}
