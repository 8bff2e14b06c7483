//! What has to hold in a file, before any device is asked.

use crate::config::{Config, Mode};
use crate::error::{Error, Result};
use hysteron_sim::track::line_of;

impl Config {
    /// An error about a key of this file.
    pub(crate) fn refused(&self, field: &str, problem: impl Into<String>) -> Error {
        Error::Config {
            path: self.path.clone(),
            line: line_of(&self.text, field),
            field: field.into(),
            problem: problem.into(),
        }
    }

    fn require(&self, fine: bool, field: &str, problem: &str) -> Result<()> {
        match fine {
            true => Ok(()),
            false => Err(self.refused(field, problem)),
        }
    }

    pub(crate) fn check(&self) -> Result<()> {
        const POSITIVE: &str = "a time above zero is needed, in seconds";
        let positive = |value: Option<f64>| value.is_none_or(|it| it > 0.0 && it.is_finite());
        self.require(positive(self.duration_s), "duration_s", POSITIVE)?;
        self.require(positive(self.safety.lost_s), "safety.lost_s", POSITIVE)?;
        self.require(positive(self.safety.stuck_s), "safety.stuck_s", POSITIVE)?;
        self.check_device()?;
        let ordered = |range: Option<(f64, f64)>| {
            range.is_none_or(|(low, high)| low < high && (high - low).is_finite())
        };
        const ORDERED: &str = "two finite numbers are needed, the lower one first";
        self.require(ordered(self.limits.drive), "limits.drive", ORDERED)?;
        self.require(ordered(self.limits.output), "limits.output", ORDERED)?;
        let slew = "a number above zero is needed: the drive's unit per second";
        self.require(positive(self.limits.slew), "limits.slew", slew)?;
        match self.mode {
            Mode::Record => self.check_profile(),
            Mode::Control => self.check_control(),
            Mode::Monitor => Ok(()),
        }
    }

    fn check_device(&self) -> Result<()> {
        let device = &self.device;
        let ways = [
            device.command.is_some(),
            device.serial.is_some(),
            device.tcp.is_some(),
            device.simulated.is_some(),
        ];
        let one = ways.iter().filter(|given| **given).count() == 1;
        let which = "one of command, serial, tcp and simulated is needed";
        self.require(one, "device", which)?;
        let words = device
            .command
            .as_ref()
            .is_none_or(|words| !words.is_empty());
        self.require(
            words,
            "device.command",
            "a program and its arguments are needed",
        )?;
        let serial = device.baud.is_none() || device.serial.is_some();
        self.require(serial, "device.baud", "this is for a serial line")?;
        self.require(
            device.baud != Some(0),
            "device.baud",
            "a speed above zero is needed",
        )?;
        for (given, field) in [
            (device.interval_s.is_some(), "device.interval_s"),
            (device.seed.is_some(), "device.seed"),
        ] {
            let fine = !given || device.simulated.is_some();
            self.require(fine, field, "this is for a simulated plant")?;
        }
        let interval = device.interval_s.unwrap_or(1.0);
        let fine = interval > 0.0 && interval.is_finite();
        self.require(fine, "device.interval_s", "a time above zero is needed")
    }

    fn check_profile(&self) -> Result<()> {
        let Some(profile) = &self.profile else {
            let what = "mode `record` plays a profile: table = \"profile.csv\" is needed here";
            return Err(self.refused("profile", what));
        };
        if profile.table.as_os_str() != "design" {
            return Ok(());
        }
        let model = profile.model.is_some();
        let what = "a design is for the plane of a model: name its file";
        self.require(model, "profile.model", what)?;
        let fine = |(up, down): (f64, f64)| up > 0.0 && down > 0.0 && (up + down).is_finite();
        let what = "how fast the drive rises and falls: two numbers above zero";
        self.require(profile.rates.is_none_or(fine), "profile.rates", what)
    }

    fn check_control(&self) -> Result<()> {
        let reference = self.reference.is_some();
        let what = "mode `control` follows a reference: table = \"reference.csv\" is needed here";
        self.require(reference, "reference", what)?;
        let Some(controller) = &self.controller else {
            let what = "mode `control` needs a controller: kind = \"pid\", for example";
            return Err(self.refused("controller", what));
        };
        let kind = controller.kind;
        let what = "`pi-rls` is a controller of `track` alone, to compare with";
        let fine = kind != hysteron_sim::track::Kind::PiRls;
        self.require(fine, "controller.kind", what)?;
        let what = format!(
            "the controller `{}` needs a model: name its file",
            kind.name()
        );
        self.require(
            !kind.has_model() || controller.model.is_some(),
            "controller.model",
            &what,
        )?;
        let numbers = [controller.integral_s, controller.derivative_s];
        let alone = controller.proportional.is_none() && numbers.iter().any(Option::is_some);
        self.require(
            !alone,
            "controller",
            "`proportional` is needed beside these times",
        )?;
        let both = controller.proportional.is_some() && controller.tuning.is_some();
        self.require(
            !both,
            "controller.tuning",
            "`proportional` is given as well: leave one out",
        )?;
        let gains = controller.gains();
        let tuned = !kind.has_pid() || gains.is_some();
        let what = "the gains are needed: proportional, integral_s and derivative_s, or a model \
                    and tuning = \"model\"";
        self.require(tuned, "controller", what)?;
        match gains {
            Some(crate::Tuning::Numbers(gains)) => gains
                .check()
                .map_err(|error| self.refused("controller", error.to_string()))?,
            Some(crate::Tuning::Model) if kind.has_pid() => {
                let what = "gains from a model need one: name its file, or give proportional";
                self.require(controller.model.is_some(), "controller.tuning", what)?;
            }
            _ => {}
        }
        let learns = kind.adapts() || controller.learner.is_none();
        let what = format!(
            "the controller `{}` does not learn: leave it out",
            kind.name()
        );
        self.require(learns, "controller.learner", &what)?;
        for (value, field) in [
            (controller.filter_s, "controller.filter_s"),
            (controller.preview_s, "controller.preview_s"),
            (controller.tolerance.unwrap_or(0.0), "controller.tolerance"),
        ] {
            let fine = value >= 0.0 && value.is_finite();
            self.require(fine, field, "a number from zero on is needed")?;
        }
        Ok(())
    }
}
