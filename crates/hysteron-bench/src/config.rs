//! The file that says what to run.

use crate::error::{Error, Result, of_file};
use hysteron::AdaptOptions;
use hysteron::control::Gains;
use hysteron_sim::track::{Kind, line_at};
use serde::de::value::MapAccessDeserializer;
use serde::{Deserialize, Deserializer, Serialize, de};
use std::fmt;
use std::path::{Path, PathBuf};

/// What a run does with the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Plays a profile and logs.
    Record,
    /// Lets the output follow a reference.
    Control,
    /// Logs; the drive stays safe.
    Monitor,
}

/// A run, as its file says it. Unknown keys are errors.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// What to do.
    pub mode: Mode,
    /// Where the log goes, `.csv` or `.parquet`.
    pub log: Option<PathBuf>,
    /// How long, s. Default: to the end of the profile or the reference.
    pub duration_s: Option<f64>,
    /// The device.
    pub device: DeviceOptions,
    /// What the host keeps to, beside the device.
    #[serde(default)]
    pub limits: Limits,
    /// What `record` plays.
    pub profile: Option<Profile>,
    /// What `control` follows.
    pub reference: Option<ReferenceOptions>,
    /// How it follows.
    pub controller: Option<ControllerOptions>,
    /// When a run is given up.
    #[serde(default)]
    pub safety: Safety,
    #[serde(skip)]
    pub(crate) path: PathBuf,
    #[serde(skip)]
    pub(crate) text: String,
}

/// How the device is reached: one of `command`, `serial`, `tcp` and `simulated`.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceOptions {
    /// A child process, which speaks the protocol on standard input and output. It runs in the
    /// folder of the file.
    pub command: Option<Vec<String>>,
    /// A serial line.
    pub serial: Option<PathBuf>,
    /// Its speed, bits per second. Default 115200.
    pub baud: Option<u32>,
    /// Host and port.
    pub tcp: Option<String>,
    /// A plant of `track`: `spring`, `preisach` or `wire`.
    pub simulated: Option<String>,
    /// Time between the samples of a simulated plant, s. Default 0.05.
    pub interval_s: Option<f64>,
    /// Seed of the noise of a simulated plant. Default 1.
    pub seed: Option<u64>,
}

/// What the host keeps to. It may be narrower than the device's own, never wider.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Lowest and highest drive. Default: the device's.
    pub drive: Option<(f64, f64)>,
    /// Fastest change of the drive, in its unit per second. Default: none.
    pub slew: Option<f64>,
    /// Lowest and highest output. Beyond them the drive goes safe and the run ends. Default: none.
    pub output: Option<(f64, f64)>,
}

/// A profile of the drive over time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// A table, or `design` for the experiment that determines a model on `model`'s plane.
    pub table: PathBuf,
    /// Its column of the drive. Default `drive`.
    pub column: Option<String>,
    /// Its column of time, s. Default `time`.
    pub time: Option<String>,
    /// For `design`: the model whose plane the experiment is for.
    pub model: Option<PathBuf>,
    /// For `design`: how fast the drive rises and falls, in its unit per second. For a model with a
    /// thermal body these are rates of the temperature, in its unit per second; by default those
    /// that `limits.drive`, or else the drives that it was fitted to, can give everywhere.
    pub rates: Option<(f64, f64)>,
}

/// The wanted output over time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceOptions {
    /// A table.
    pub table: PathBuf,
    /// Its column of the wanted output. Default `reference`.
    pub column: Option<String>,
    /// Its column of time, s. Default `time`.
    pub time: Option<String>,
}

/// The controller of `control`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControllerOptions {
    /// Which one, as in `track`.
    pub kind: Kind,
    /// The model file. All kinds but `pid` need it.
    pub model: Option<PathBuf>,
    /// What learns in the adaptive kinds: `auto`, or a learner of `adapt`.
    pub learner: Option<String>,
    /// Options of the learner, as in a scenario.
    #[serde(default)]
    pub options: AdaptOptions,
    /// Where the gains of the PID come from. Default `model`, where there is one.
    pub tuning: Option<Tuning>,
    /// Proportional gain of the PID: drive per unit of the output. In place of `tuning`.
    pub proportional: Option<f64>,
    /// Integral time of the PID, s.
    pub integral_s: Option<f64>,
    /// Derivative time of the PID, s.
    pub derivative_s: Option<f64>,
    /// Reversals of the reference up to this are noise. Default: what is usual for the model.
    pub tolerance: Option<f64>,
    /// Time constant of the filter on the readings, s. Default 0: none.
    #[serde(default)]
    pub filter_s: f64,
    /// Samples until a drive is seen to act. Default: the next sample, or later by the dead time of
    /// the model.
    pub delay: Option<usize>,
    /// How long before it is due the inverse is told the reference, s. Default 0.
    #[serde(default)]
    pub preview_s: f64,
}

/// Where the gains of a PID come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tuning {
    /// From the model, by simulation of the loop.
    Model,
    /// Numbers.
    Numbers(Gains),
}

/// When a run is given up.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Safety {
    /// So long without a valid reading, or with readings far beyond what the model reaches, s.
    /// Default: 0.5 s, and at least five samples.
    pub lost_s: Option<f64>,
    /// So long without any change where the model expects one, s. Default 1, and at least five
    /// samples. In mode `record`: so long without more than noise, and at least while the profile
    /// goes there and back, s. Default 60.
    pub stuck_s: Option<f64>,
}

impl Safety {
    /// The defaults of `lost_s` and `stuck_s` at a sample time, s.
    ///
    /// ```
    /// use hysteron_bench::Safety;
    /// assert_eq!(Safety::usual(0.05), (0.5, 1.0));
    /// assert_eq!(Safety::usual(1.0), (5.0, 5.0)); // a few samples at least
    /// ```
    #[must_use]
    pub fn usual(dt: f64) -> (f64, f64) {
        hysteron_sim::joint::usual_safety(dt)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Numbers {
    proportional: f64,
    #[serde(default)]
    integral_s: f64,
    #[serde(default)]
    derivative_s: f64,
}

impl<'de> Deserialize<'de> for Tuning {
    fn deserialize<D: Deserializer<'de>>(from: D) -> std::result::Result<Self, D::Error> {
        struct Visitor;
        impl<'de> de::Visitor<'de> for Visitor {
            type Value = Tuning;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"model\", or { proportional, integral_s, derivative_s }")
            }
            fn visit_str<E: de::Error>(self, word: &str) -> std::result::Result<Tuning, E> {
                match word {
                    "model" => Ok(Tuning::Model),
                    _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
                }
            }
            fn visit_map<A: de::MapAccess<'de>>(
                self,
                map: A,
            ) -> std::result::Result<Tuning, A::Error> {
                let numbers = Numbers::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Tuning::Numbers(Gains {
                    gain: numbers.proportional,
                    integral_s: numbers.integral_s,
                    derivative_s: numbers.derivative_s,
                }))
            }
        }
        from.deserialize_any(Visitor)
    }
}

impl ControllerOptions {
    /// The gains that the file gives, or that they come from the model; `None` where it says
    /// nothing of them.
    pub(crate) fn gains(&self) -> Option<Tuning> {
        let numbers = self.proportional.map(|gain| {
            Tuning::Numbers(Gains {
                gain,
                integral_s: self.integral_s.unwrap_or(0.0),
                derivative_s: self.derivative_s.unwrap_or(0.0),
            })
        });
        self.tuning
            .or(numbers)
            .or(self.model.as_ref().map(|_| Tuning::Model))
    }
}

impl Config {
    /// Reads a file and checks it. Relative paths in it begin at its folder.
    ///
    /// # Errors
    /// [`hysteron::Error::File`], and [`Error::Config`] for what the file says.
    pub fn load(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|source| of_file(path, source))?;
        Self::parse(&text, path)
    }

    /// As [`Config::load`], from a text; `path` is the file that it stands for.
    ///
    /// ```
    /// use hysteron_bench::{Config, Mode};
    /// let text = "mode = 'monitor'\nlog = 'run.csv'\n[device]\nsimulated = 'spring'\n";
    /// let config = Config::parse(text, "bench/run.toml".as_ref())?;
    /// assert_eq!(config.mode, Mode::Monitor);
    /// let wrong = Config::parse("mode = 'monitor'\nspeed = 3\n", "run.toml".as_ref());
    /// assert!(wrong.is_err_and(|error| error.to_string().contains("line 2")));
    /// # Ok::<(), hysteron_bench::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Config`].
    pub fn parse(text: &str, path: &Path) -> Result<Self> {
        let unreadable = |field: &str, error: &toml::de::Error| Error::Config {
            path: path.into(),
            line: error.span().map(|span| line_at(text, span.start)),
            field: field.into(),
            problem: error.message().into(),
        };
        let keys = toml::Deserializer::parse(text).map_err(|error| unreadable(".", &error))?;
        let config: Self = serde_path_to_error::deserialize(keys)
            .map_err(|error| unreadable(&error.path().to_string(), error.inner()))?;
        let config = Self {
            path: path.into(),
            text: text.into(),
            ..config
        };
        config.check()?;
        Ok(config)
    }

    /// A path of the file, from its folder.
    pub(crate) fn at(&self, path: &Path) -> PathBuf {
        self.folder().join(path)
    }

    /// The folder of the file; empty for the present one.
    pub(crate) fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }
}
