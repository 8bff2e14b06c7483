//! The preparation of a file: its steps as texts, as on the command line.

use super::argument::option;
use super::fault::Fault;
use hysteron::{PrepareOptions, Step};
use hysteron_files::python_literal;
use serde::{Deserialize, Serialize};

/// The steps of a preparation, each `auto`, `off` or a number: [`hysteron::PrepareOptions`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Steps {
    /// Lost signs: `on` or `off`.
    pub signs: String,
    /// Spikes.
    pub spikes: String,
    /// Equal steps of time.
    pub resample: String,
    /// The low-pass filter.
    pub low_pass: String,
    /// The lag of the input's sensor.
    pub lag: String,
    /// The dead band for false reversals.
    pub dead_band: String,
    /// Whether a recording is prepared that cannot be believed: `on` or `off`.
    pub believe: String,
}

impl Default for Steps {
    fn default() -> Self {
        let auto = || "auto".to_owned();
        Self {
            signs: "off".into(),
            spikes: auto(),
            resample: auto(),
            low_pass: auto(),
            lag: "off".into(),
            dead_band: auto(),
            believe: "off".into(),
        }
    }
}

impl Steps {
    /// Names and texts, those of the command line first.
    fn all(&self) -> [(&'static str, &'static str, &str); 7] {
        [
            ("signs", "signs", &self.signs),
            ("spikes", "spikes", &self.spikes),
            ("resample", "resample", &self.resample),
            ("low-pass", "low_pass", &self.low_pass),
            ("sensor-lag", "lag", &self.lag),
            ("dead-band", "dead_band", &self.dead_band),
            ("believe", "believe", &self.believe),
        ]
    }

    /// The same steps, each as it is understood.
    ///
    /// # Errors
    /// [`Fault`] for a text that is no step.
    pub(super) fn checked(self) -> Result<Self, Fault> {
        let options = self.options()?;
        Ok(Self {
            signs: switch(options.signs),
            believe: switch(options.believe),
            spikes: text(options.spikes),
            resample: text(options.resample),
            low_pass: text(options.low_pass),
            lag: text(options.lag),
            dead_band: text(options.dead_band),
        })
    }

    pub(super) fn options(&self) -> Result<PrepareOptions, Fault> {
        Ok(PrepareOptions {
            signs: is_on("signs", &self.signs)?,
            believe: is_on("believe", &self.believe)?,
            spikes: step("spikes", &self.spikes)?,
            resample: step("resample", &self.resample)?,
            low_pass: step("low-pass", &self.low_pass)?,
            lag: step("lag", &self.lag)?,
            dead_band: step("dead band", &self.dead_band)?,
        })
    }

    /// The steps that are not as usual.
    fn changed(&self) -> impl Iterator<Item = (&'static str, &'static str, &str)> {
        let usual = Self::default();
        let usual = usual.all().map(|(.., text)| text.to_owned());
        let all = self.all().into_iter().zip(usual);
        all.filter(|((.., text), usual)| text != usual)
            .map(|(step, _)| step)
    }

    pub(super) fn as_options(&self) -> String {
        let steps = self.changed().map(|(name, _, text)| match name {
            "believe" => " --believe".to_owned(),
            _ => format!(" {}", option(name, text)),
        });
        format!("--prepare{}", steps.collect::<String>())
    }

    pub(super) fn as_python(&self) -> String {
        let steps = self.changed().map(|(_, name, text)| match text {
            "on" => format!(", {name}=True"),
            number if number.parse::<f64>().is_ok() => format!(", {name}={number}"),
            word => format!(", {name}={}", python_literal(word)),
        });
        steps.collect()
    }

    pub(super) fn as_rust(&self) -> String {
        let steps = self.changed().map(|(_, name, text)| match text {
            "on" => format!("{name}: true, "),
            "auto" => format!("{name}: Step::Auto, "),
            "off" => format!("{name}: Step::Off, "),
            number => format!("{name}: Step::Value({number} as f64), "),
        });
        let steps: String = steps.collect();
        format!("PrepareOptions {{ {steps}..PrepareOptions::default() }}")
    }
}

fn switch(is_on: bool) -> String {
    if is_on { "on" } else { "off" }.into()
}

fn text(step: Step) -> String {
    match step {
        Step::Auto => "auto".into(),
        Step::Off => "off".into(),
        Step::Value(value) => value.to_string(),
    }
}

fn is_on(name: &str, text: &str) -> Result<bool, Fault> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => {
            let problem = format!("“{name}” is neither on nor off");
            Err(Fault::missing(&problem, "choose one of them"))
        }
    }
}

fn step(name: &str, text: &str) -> Result<Step, Fault> {
    match text {
        "auto" => Ok(Step::Auto),
        "off" => Ok(Step::Off),
        _ => text
            .parse::<f64>()
            .ok()
            .filter(|value| value.is_finite())
            .map(Step::Value)
            .ok_or_else(|| {
                let problem = format!("“{name}” is neither auto nor off nor a number");
                Fault::missing(&problem, "choose one of them")
            }),
    }
}
