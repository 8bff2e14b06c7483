//! What is due when: a drive to play, or an output to follow.

use crate::config::{Config, Profile};
use crate::error::Result;
use hysteron::control::Reference;
use hysteron::{
    Columns, DesignOptions, Direction, Model, Rates, Recording, Repair, design, design_heated,
    headings, range,
};
use hysteron_sim::track;
use std::path::Path;

/// A course over the run's time, with straight lines between its points.
#[derive(Debug, Clone)]
pub(crate) struct Course {
    points: track::Reference,
    end_s: f64,
    range: (f64, f64),
    /// Where it goes next, every `step_s`; empty where nobody asks.
    headings: Vec<Option<Direction>>,
    step_s: f64,
}

impl Course {
    fn new(points: Vec<(f64, f64)>) -> Self {
        let values: Vec<f64> = points.iter().map(|(_, value)| *value).collect();
        Self {
            end_s: points.last().map_or(0.0, |(time, _)| *time),
            range: range(&values),
            points: track::Reference::Ramps { points },
            headings: Vec::new(),
            step_s: 1.0,
        }
    }

    /// A column of a table over its column of time.
    fn read(path: &Path, time: &str, column: &str) -> Result<Self> {
        let (table, _) = Recording::read(path, Columns::new(time, column), Repair::Refuse)?;
        Ok(Self::new(
            table.input.into_iter().zip(table.output).collect(),
        ))
    }

    /// The reference of a file.
    pub(crate) fn reference(config: &Config) -> Result<Option<Self>> {
        let Some(options) = &config.reference else {
            return Ok(None);
        };
        let time = options.time.as_deref().unwrap_or("time");
        let column = options.column.as_deref().unwrap_or("reference");
        Self::read(&config.at(&options.table), time, column).map(Some)
    }

    /// The profile of a file.
    pub(crate) fn profile(config: &Config) -> Result<Option<Self>> {
        let Some(options) = &config.profile else {
            return Ok(None);
        };
        if options.table.as_os_str() == "design" {
            return Self::designed(config, options).map(Some);
        }
        let time = options.time.as_deref().unwrap_or("time");
        let column = options.column.as_deref().unwrap_or("drive");
        Self::read(&config.at(&options.table), time, column).map(Some)
    }

    /// The experiment that determines a model on the plane of another one. Where a body heats, it is
    /// planned in temperatures, and no drive leaves `limits.drive`, by default those that the model
    /// was fitted to.
    fn designed(config: &Config, options: &Profile) -> Result<Self> {
        let missing = |field| {
            let what = "a design needs a model, and one without a thermal body how fast the drive \
                        rises and falls: two numbers above zero";
            config.refused(field, what)
        };
        let model = options
            .model
            .as_ref()
            .ok_or_else(|| missing("profile.model"))?;
        let model = Model::read(&config.at(model))?;
        let rates = options.rates;
        let rates = rates.map(|(heating, cooling)| Rates { heating, cooling });
        let (plane, budget_s) = (*model.plane(), config.duration_s);
        let found = match model.thermal {
            Some(_) => {
                let limits = (budget_s, None);
                design_heated(&model, config.limits.drive, plane.levels(), rates, limits)?
            }
            None => {
                let rates = rates.ok_or_else(|| missing("profile.rates"))?;
                let plain = DesignOptions::new(plane, rates);
                design(&DesignOptions { budget_s, ..plain }, &[])?
            }
        };
        Ok(Self::new(found.time.into_iter().zip(found.input).collect()))
    }

    /// The value that is due at a time of the run, s.
    pub(crate) fn at(&self, time: f64) -> f64 {
        self.points.at(time)
    }

    pub(crate) fn end_s(&self) -> f64 {
        self.end_s
    }

    /// Lowest and highest value.
    pub(crate) fn range(&self) -> (f64, f64) {
        self.range
    }

    /// Finds where it goes next, for *anticipate*.
    pub(crate) fn head(&mut self, tolerance: f64, step_s: f64) {
        /// More samples than a run has.
        const MOST: f64 = 1e7;
        let count = (self.end_s / step_s).clamp(0.0, MOST) as usize + 1;
        let values: Vec<f64> = (0..count).map(|n| self.at(n as f64 * step_s)).collect();
        (self.headings, self.step_s) = (headings(&values, tolerance), step_s);
    }

    /// The target at a time.
    pub(crate) fn target(&self, time: f64) -> Reference {
        let n = (time / self.step_s).round().max(0.0) as usize;
        Reference {
            output: self.at(time),
            heading: self.headings.get(n).copied().flatten(),
        }
    }
}

/// The error for a course that has no time to run.
pub(crate) fn refuse_empty(config: &Config, field: &str, course: &Course) -> Result<()> {
    match course.end_s() > 0.0 || config.duration_s.is_some() {
        true => Ok(()),
        false => Err(config.refused(field, "its times end at 0 s: give duration_s")),
    }
}
