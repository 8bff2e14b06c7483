//! A scenario: a plant, what acts on it, a reference, and the controllers to compare.

use super::place::{line_at, line_of};
use super::{Event, Kind, LoopOptions, ModelOptions, PlantOptions, Reference};
use hysteron::{AdaptOptions, Error, Result};
use serde::Deserialize;
use std::path::Path;

/// The scenarios that need no file.
const BUILTIN: [(&str, &str); 9] = [
    ("load-step", include_str!("builtin/load-step.toml")),
    (
        "load-step-preisach",
        include_str!("builtin/load-step-preisach.toml"),
    ),
    ("sine", include_str!("builtin/sine.toml")),
    ("staircase", include_str!("builtin/staircase.toml")),
    ("drift", include_str!("builtin/drift.toml")),
    ("faults", include_str!("builtin/faults.toml")),
    ("wire", include_str!("builtin/wire.toml")),
    ("latent-wire", include_str!("builtin/latent-wire.toml")),
    ("bouc-wen", include_str!("builtin/bouc-wen.toml")),
];

/// What `track` compares controllers on. All times are in seconds.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Heading of the report.
    pub title: String,
    /// How long a run takes.
    pub duration_s: f64,
    /// Time between samples.
    pub interval_s: f64,
    /// Errors count from so long after the start, and after each disturbance.
    #[serde(default = "two_minutes")]
    pub settle_s: f64,
    /// How many runs, each with its own noise and its own recording to identify from.
    #[serde(default = "twenty")]
    pub seeds: u32,
    /// The simulated plant.
    pub plant: PlantOptions,
    /// How its model is identified before.
    pub model: ModelOptions,
    /// What the output is to follow: the sum of these.
    pub reference: Vec<Reference>,
    /// Drives held before a run, `[time_s, drive]`, of which no controller is told: the model's
    /// operators begin elsewhere than the plant. Not before the experiment that a model is
    /// identified from.
    #[serde(default)]
    pub before: Vec<(f64, f64)>,
    /// What happens to the plant.
    #[serde(default)]
    pub disturbance: Vec<Event>,
    /// What all controllers share.
    #[serde(default, rename = "loop")]
    pub shared: LoopOptions,
    /// How the adaptive ones learn.
    #[serde(default)]
    pub adaptation: AdaptOptions,
    /// The controllers; all of them where none is named.
    #[serde(default = "Kind::all")]
    pub controllers: Vec<Kind>,
}

impl Scenario {
    /// Names of the built-in scenarios.
    #[must_use]
    pub fn names() -> [&'static str; BUILTIN.len()] {
        BUILTIN.map(|(name, _)| name)
    }

    /// The text of a built-in scenario, to start your own from.
    #[must_use]
    pub fn text(name: &str) -> Option<&'static str> {
        let mut found = BUILTIN.iter().filter(|(builtin, _)| *builtin == name);
        found.next().map(|(_, text)| *text)
    }

    /// A built-in scenario by its name, or one from a TOML file.
    ///
    /// # Errors
    /// [`Error::File`], and [`Error::Scenario`] for what the file says.
    pub fn load(name: &str) -> Result<Self> {
        if let Some(text) = Self::text(name) {
            return Self::parse(text, Path::new(""));
        }
        let path = Path::new(name);
        let text = std::fs::read_to_string(path).map_err(|source| match source.kind() {
            std::io::ErrorKind::NotFound => Error::Scenario {
                path: None,
                line: None,
                field: name.into(),
                problem: format!(
                    "no such file, and no such built-in scenario: {}",
                    Self::names().join(", ")
                ),
            },
            _ => Error::File {
                path: path.into(),
                source,
            },
        })?;
        let parsed = Self::parse(&text, path.parent().unwrap_or(Path::new("")));
        parsed.map_err(|error| match error {
            Error::Scenario {
                line,
                field,
                problem,
                ..
            } => Error::Scenario {
                path: Some(path.into()),
                line,
                field,
                problem,
            },
            other => other,
        })
    }

    /// A scenario from its text; files that it names are looked for from `folder`.
    ///
    /// # Errors
    /// [`Error::Scenario`] tells the line and the field.
    pub fn parse(text: &str, folder: &Path) -> Result<Self> {
        let fields =
            toml::Deserializer::parse(text).map_err(|error| unreadable(text, ".", &error))?;
        let mut scenario: Self = serde_path_to_error::deserialize(fields)
            .map_err(|error| unreadable(text, &error.path().to_string(), error.inner()))?;
        let read = scenario.reference.into_iter().map(|part| part.read(folder));
        scenario.reference = read.collect::<Result<_>>()?;
        if let Some(file) = &mut scenario.model.file {
            *file = folder.join(&*file);
        }
        scenario.check().map_err(|error| match error {
            Error::Scenario { field, problem, .. } => Error::Scenario {
                path: None,
                line: line_of(text, &field),
                field,
                problem,
            },
            other => other,
        })?;
        Ok(scenario)
    }

    /// The reference at each sample.
    #[must_use]
    pub fn references(&self) -> Vec<f64> {
        let count = (self.duration_s / self.interval_s).round() as usize;
        let time = (0..count).map(|n| n as f64 * self.interval_s);
        time.map(|t| self.reference.iter().map(|part| part.at(t)).sum())
            .collect()
    }
}

/// The error for a text that is no scenario.
fn unreadable(text: &str, field: &str, error: &toml::de::Error) -> Error {
    Error::Scenario {
        path: None,
        line: error.span().map(|span| line_at(text, span.start)),
        field: field.into(),
        problem: error.message().into(),
    }
}

fn two_minutes() -> f64 {
    120.0
}

fn twenty() -> u32 {
    20
}
