//! A scenario: a plant, what acts on it, a reference, and the controllers to compare.

use super::reference::Reference;
use crate::control::{Disturbance, Rest, SimulatedPlant};
use crate::plant::{PreisachPlant, PreisachPlantOptions, SpringPlant, SpringPlantOptions};
use crate::{Adaptation, Error, Method, Quantity, Result};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The scenarios that need no file.
const BUILTIN: [(&str, &str); 6] = [
    ("load-step", include_str!("builtin/load-step.toml")),
    (
        "load-step-preisach",
        include_str!("builtin/load-step-preisach.toml"),
    ),
    ("sine", include_str!("builtin/sine.toml")),
    ("staircase", include_str!("builtin/staircase.toml")),
    ("drift", include_str!("builtin/drift.toml")),
    ("faults", include_str!("builtin/faults.toml")),
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
    /// What happens to the plant.
    #[serde(default)]
    pub disturbance: Vec<Event>,
    /// What all controllers share.
    #[serde(default, rename = "loop")]
    pub shared: LoopOptions,
    /// How the adaptive ones learn.
    #[serde(default)]
    pub adaptation: AdaptationOptions,
    /// The controllers; all of them where none is named.
    #[serde(default = "Kind::all")]
    pub controllers: Vec<Kind>,
}

/// Which plant, and its options.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum PlantOptions {
    /// The simulated NiTi spring.
    Spring(SpringPlantOptions),
    /// The simulated cloud of relays.
    Preisach(PreisachPlantOptions),
}

/// The plane, and the experiment that its weights are identified from.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelOptions {
    /// Number of levels.
    pub levels: usize,
    /// Lowest and highest level, in the input's unit.
    pub range: (f64, f64),
    /// Strength of the smoothness.
    #[serde(default)]
    pub smooth: f64,
    /// How fast the input rises and falls in the experiment, in its unit per second.
    pub rates: (f64, f64),
    /// A model file to use instead of an experiment.
    pub file: Option<PathBuf>,
}

/// Something that happens.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// When.
    pub at_s: f64,
    /// The load becomes this, N.
    pub load_n: Option<f64>,
    /// The room's temperature becomes this, °C.
    pub room_degc: Option<f64>,
    /// The pre-deformation becomes this, mm.
    pub predeformation_mm: Option<f64>,
    /// The output's sensor stands still (`true`) or works again.
    pub stuck: Option<bool>,
    /// The output's sensor reads nothing (`true`) or works again.
    pub lost: Option<bool>,
}

/// What all controllers share.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LoopOptions {
    /// Time constant of the filter on the readings. Default 0: none.
    pub filter_s: f64,
    /// Reversals of the reference up to this size are not followed by the inverse, in the output's unit. Default 0.
    pub tolerance: f64,
    /// Test and rule that the PID is tuned by. Default `relay`.
    pub tuning: Tuning,
}

/// Test and rule that the gains of the PID come from, the same for all controllers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tuning {
    /// Relay test, Tyreus & Luyben 1992.
    #[default]
    Relay,
    /// Step test on the rising branch, SIMC (Skogestad 2003).
    Step,
}

/// How the adaptive controllers learn; see [`Adaptation`].
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AdaptationOptions {
    /// The method.
    pub method: MethodName,
    /// Gain of the gradients.
    pub gain: f64,
    /// Levels between two updates of `increments`.
    pub span: f64,
    /// Forgetting factor of `least-squares`.
    pub forgetting: f64,
    /// Standard deviation of the error of a reading.
    pub noise: f64,
    /// Standard deviation by which a weight may differ from the off-line one.
    pub spread: f64,
    /// Distance, in levels, over which deviations go together.
    pub correlation: f64,
    /// How freely the offset moves, beside one weight.
    pub offset_share: f64,
    /// Errors up to this are noise.
    pub dead_zone: f64,
    /// Share by which weights return to the off-line ones with each update.
    pub leakage: f64,
    /// Levels that the input has to move.
    pub movement: f64,
}

/// Name of a method of adaptation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MethodName {
    /// [`Method::Gradient`].
    Gradient,
    /// [`Method::Increments`].
    Increments,
    /// [`Method::LeastSquares`].
    LeastSquares,
}

impl Default for AdaptationOptions {
    fn default() -> Self {
        Self {
            method: MethodName::LeastSquares,
            gain: 0.3,
            span: 1.0,
            forgetting: 0.9995,
            noise: 0.3,
            spread: 0.05,
            correlation: 3.0,
            offset_share: 10.0,
            dead_zone: 0.0,
            leakage: 0.0,
            movement: 0.02,
        }
    }
}

impl From<AdaptationOptions> for Adaptation<f64> {
    fn from(options: AdaptationOptions) -> Self {
        let AdaptationOptions {
            gain,
            span,
            forgetting,
            noise,
            spread,
            correlation,
            ..
        } = options;
        let method = match options.method {
            MethodName::Gradient => Method::Gradient { gain },
            MethodName::Increments => Method::Increments { gain, span },
            MethodName::LeastSquares => Method::LeastSquares {
                forgetting,
                noise,
                spread,
                correlation,
            },
        };
        Self {
            method,
            offset_share: options.offset_share,
            dead_zone: options.dead_zone,
            leakage: options.leakage,
            movement: options.movement,
            ..Self::default()
        }
    }
}

/// A controller of the comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// PID alone.
    Pid,
    /// The inverse alone, *hold*.
    Inverse,
    /// The inverse alone, *anticipate*.
    InverseAnticipate,
    /// Inverse and PID, *hold*.
    InversePid,
    /// Inverse and PID, *anticipate*.
    InversePidAnticipate,
    /// Adaptive inverse and PID, *hold*.
    AdaptivePid,
    /// Adaptive inverse and PID, *anticipate*.
    AdaptivePidAnticipate,
}

impl Kind {
    fn all() -> Vec<Self> {
        vec![
            Self::Pid,
            Self::Inverse,
            Self::InverseAnticipate,
            Self::InversePid,
            Self::InversePidAnticipate,
            Self::AdaptivePid,
            Self::AdaptivePidAnticipate,
        ]
    }

    /// What to call it.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Pid => "PID",
            Self::Inverse => "inverse, hold",
            Self::InverseAnticipate => "inverse, anticipate",
            Self::InversePid => "inverse + PID, hold",
            Self::InversePidAnticipate => "inverse + PID, anticipate",
            Self::AdaptivePid => "adaptive inverse + PID, hold",
            Self::AdaptivePidAnticipate => "adaptive inverse + PID, anticipate",
        }
    }

    /// Its name in a scenario.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pid => "pid",
            Self::Inverse => "inverse",
            Self::InverseAnticipate => "inverse-anticipate",
            Self::InversePid => "inverse-pid",
            Self::InversePidAnticipate => "inverse-pid-anticipate",
            Self::AdaptivePid => "adaptive-pid",
            Self::AdaptivePidAnticipate => "adaptive-pid-anticipate",
        }
    }

    pub(super) fn has_pid(self) -> bool {
        !matches!(self, Self::Inverse | Self::InverseAnticipate)
    }

    pub(super) fn adapts(self) -> bool {
        matches!(self, Self::AdaptivePid | Self::AdaptivePidAnticipate)
    }

    pub(super) fn rest(self) -> Rest {
        match self {
            Self::InverseAnticipate | Self::InversePidAnticipate | Self::AdaptivePidAnticipate => {
                Rest::Anticipate
            }
            _ => Rest::Hold,
        }
    }
}

impl Scenario {
    /// Names of the built-in scenarios.
    #[must_use]
    pub fn names() -> [&'static str; BUILTIN.len()] {
        BUILTIN.map(|(name, _)| name)
    }

    /// The text of a built-in scenario, to start one's own from.
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
        Self::parse(&text, path.parent().unwrap_or(Path::new("")))
    }

    /// A scenario from its text; files that it names are looked for from `folder`.
    ///
    /// # Errors
    /// [`Error::Scenario`] tells the line, or the field.
    pub fn parse(text: &str, folder: &Path) -> Result<Self> {
        let mut scenario: Self = toml::from_str(text).map_err(|error| Error::Scenario {
            field: match error.span() {
                Some(span) => format!("line {}", text[..span.start].lines().count().max(1)),
                None => ".".into(),
            },
            problem: error.message().into(),
        })?;
        scenario.check()?;
        let read = scenario.reference.into_iter().map(|part| part.read(folder));
        scenario.reference = read.collect::<Result<_>>()?;
        if let Some(file) = &mut scenario.model.file {
            *file = folder.join(&*file);
        }
        Ok(scenario)
    }

    fn check(&self) -> Result<()> {
        let refuse = |field: &str, problem: &str| {
            Err(Error::Scenario {
                field: field.into(),
                problem: problem.into(),
            })
        };
        let positive = |value: f64| value > 0.0 && value.is_finite();
        if !positive(self.interval_s) {
            return refuse("interval_s", "the time between samples must be above zero");
        }
        let samples = self.duration_s / self.interval_s;
        if !(10.0..=1e7).contains(&samples) {
            return refuse("duration_s", "from 10 to 10 million samples are needed");
        }
        if !(self.settle_s >= 0.0 && self.settle_s < self.duration_s) {
            return refuse("settle_s", "must lie between 0 and the duration");
        }
        if !(1..=1000).contains(&self.seeds) {
            return refuse("seeds", "from 1 to 1000 runs");
        }
        if self.reference.is_empty() {
            return refuse("reference", "at least one part is needed");
        }
        for (n, part) in self.reference.iter().enumerate() {
            part.check(&format!("reference[{n}]"))?;
        }
        if self.controllers.is_empty() {
            return refuse("controllers", "at least one is needed");
        }
        let (heating, cooling) = self.model.rates;
        if !(positive(heating) && positive(cooling)) {
            return refuse("model.rates", "both must be above zero");
        }
        let LoopOptions {
            filter_s,
            tolerance,
            ..
        } = self.shared;
        if !(filter_s >= 0.0 && filter_s.is_finite() && tolerance >= 0.0 && tolerance.is_finite()) {
            return refuse("loop", "filter_s and tolerance must be zero or above");
        }
        let mut last = 0.0;
        for event in &self.disturbance {
            if !(event.at_s >= last && event.at_s < self.duration_s) {
                return refuse(
                    "disturbance.at_s",
                    "must be in order and within the duration",
                );
            }
            last = event.at_s;
            if event.disturbances().is_empty() {
                return refuse(
                    "disturbance",
                    "load_n, room_degc, predeformation_mm, stuck or lost is needed",
                );
            }
        }
        let adaptation: Adaptation<f64> = self.adaptation.into();
        if let Err(error) = adaptation.check() {
            return refuse("adaptation", &error.to_string());
        }
        self.plant.build(1).map(|_| ())
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

impl PlantOptions {
    /// The plant with the noise of `seed`.
    ///
    /// # Errors
    /// [`Error::Rig`] names the option that does not fit.
    pub fn build(&self, seed: u64) -> Result<Box<dyn SimulatedPlant>> {
        Ok(match self {
            Self::Spring(options) => {
                let options = SpringPlantOptions { seed, ..*options };
                Box::new(SpringPlant::new(&options)?)
            }
            Self::Preisach(options) => {
                let options = PreisachPlantOptions { seed, ..*options };
                Box::new(PreisachPlant::new(&options)?)
            }
        })
    }

    /// Lowest and highest drive.
    #[must_use]
    pub fn drives(&self) -> (f64, f64) {
        match self {
            Self::Spring(options) => (0.0, options.limit_a),
            Self::Preisach(options) => (0.0, options.limit_v),
        }
    }

    /// Names and units of the drive, the hysteresis' input and the output.
    #[must_use]
    pub fn quantities(&self) -> [Quantity; 3] {
        match self {
            Self::Spring(_) => [
                Quantity::with_unit("current", "A"),
                Quantity::with_unit("temperature", "degC"),
                Quantity::with_unit("displacement", "mm"),
            ],
            Self::Preisach(_) => [
                Quantity::with_unit("voltage", "V"),
                Quantity::with_unit("voltage", "V"),
                Quantity::with_unit("displacement", "um"),
            ],
        }
    }

    /// Whether a current heats, so that a loop around the temperature is needed.
    pub(super) fn heats(&self) -> bool {
        matches!(self, Self::Spring(_))
    }
}

impl Event {
    /// What happens, in the plant's words.
    pub(super) fn disturbances(&self) -> Vec<Disturbance> {
        let numbers = [
            self.load_n.map(Disturbance::Load),
            self.room_degc.map(Disturbance::Room),
            self.predeformation_mm.map(Disturbance::Predeformation),
            self.stuck.map(Disturbance::Stuck),
            self.lost.map(Disturbance::Lost),
        ];
        numbers.into_iter().flatten().collect()
    }

    /// What happens, in words.
    #[must_use]
    pub fn words(&self) -> String {
        let words = self.disturbances().into_iter().map(|what| match what {
            Disturbance::Load(n) => format!("load {n} N"),
            Disturbance::Room(t) => format!("room {t} degC"),
            Disturbance::Predeformation(x) => format!("pre-deformation {x} mm"),
            Disturbance::Stuck(true) => "sensor stuck".into(),
            Disturbance::Lost(true) => "sensor lost".into(),
            Disturbance::Stuck(false) | Disturbance::Lost(false) => "sensor works again".into(),
        });
        words.collect::<Vec<_>>().join(", ")
    }
}

fn two_minutes() -> f64 {
    120.0
}

fn twenty() -> u32 {
    20
}
