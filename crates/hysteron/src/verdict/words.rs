//! A verdict in sentences.

use super::grade::USABLE;
use super::parts::{ErrorPart, PartKind};
use super::{Basis, Cause, Grade, Verdict};
use crate::advice::remedy_of_readings;
use crate::model::band_name;
use crate::recording::Quantity;
use crate::remedy::{Remedy, Setting, counted};
use std::fmt;

/// No session changes a gain so much: another unit or another device does.
fn is_odd(gain: &ErrorPart) -> bool {
    !(-0.6..=1.5).contains(&gain.size)
}

const CREEP: Setting = Setting::word("creep", "auto");

/// What helps a model that cannot follow.
const MORE: &str = "record more reversals inside the range (design makes such an input)";
/// The same, where what depends on the speed was not seen.
const FASTER: &str = "record more reversals inside the range (design makes such an input), and some \
     at another speed";

fn is_few(cause: &Cause) -> bool {
    matches!(cause, Cause::FewBranches { .. } | Cause::FewPoints { .. })
}

impl Grade {
    /// The word, and what the model is good for.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Good => "good: its inverse can drive without a sensor",
            Self::Usable => "usable: drive by it beside a controller that measures the output",
            Self::Poor => "poor: do not drive by it yet",
            Self::Untested => "not tested: all of these data were fitted",
        }
    }
}

/// Of a model whose inverse undoes what comes late, which multiplies the noise of the readings.
const SMOOTH: &str = "good: its inverse can drive without a sensor, along a smooth path";

impl Verdict {
    /// The word of the grade, and what the model is good for.
    #[must_use]
    pub fn words(&self) -> &'static str {
        let inverse = self.inverse.and_then(|errors| errors.nrmse_percent);
        match self.grade {
            Grade::Good if inverse.is_some_and(|percent| percent > USABLE) => SMOOTH,
            grade => grade.words(),
        }
    }

    /// What is to be said, each with its heading: `verdict`, `error`, `inverse`, `why`, `worst` and
    /// `next`, as far as there is something. An option is written by `spelling`.
    pub fn lines(&self, spelling: impl Fn(&Setting) -> String) -> Vec<(&'static str, String)> {
        let mut lines = vec![
            ("verdict", self.words().to_owned()),
            ("error", self.error()),
        ];
        if let Some(inverse) = &self.inverse {
            let percent = inverse.nrmse_percent;
            let percent = percent.map_or(String::new(), |p| format!(" ({p:.2} % of its range)"));
            let rmse = self.input.text(inverse.rmse);
            let text = format!(
                "{} to {rmse}{percent} while the output moves",
                self.input.name
            );
            lines.push(("inverse", text));
        }
        // Nobody asks why a good model is not better, unless the readings are.
        let least = match self.grade {
            Grade::Good => Cause::NOISE,
            _ => Cause::MISFIT,
        };
        let alone = self.causes.len() == 1;
        let is_said = |cause: &&Cause| match cause {
            Cause::Misfit { .. } => alone && least <= Cause::MISFIT,
            cause => cause.weight() >= least,
        };
        let causes = self.causes.iter().filter(is_said);
        let causes = causes.map(|cause| self.sentence(cause));
        lines.extend(causes.map(|sentence| ("why", sentence)));
        lines.extend(self.worst().map(|text| ("worst", text)));
        lines.push(("next", self.next().spelt(spelling)));
        lines
    }

    /// The error, on what, and beside it the best simple predictor.
    fn error(&self) -> String {
        let on = match self.basis {
            Basis::OtherRecording => "a recording that was not fitted",
            Basis::HeldOut => "what was held out",
            Basis::BranchesLeftOut => "branches left out",
            Basis::PartsLeftOut => "parts of branches left out",
            Basis::Fitted => "the data fitted",
        };
        let percent = self.percent;
        let percent = percent.map_or(String::new(), |p| format!(" ({p:.2} % of the range)"));
        let rmse = self.output.text(self.rmse);
        let rival = self
            .rival
            .as_ref()
            .map(|(name, rival)| format!("; {name} errs {rival:.2} %"));
        // Where a branch is the only one of its kind, leaving it out tells nothing of a new one.
        let within = match self.causes.iter().any(is_few) && self.basis != Basis::OtherRecording {
            true => " within this recording, no promise for another",
            false => "",
        };
        format!(
            "{rmse}{percent} on {on}{within}{}",
            rival.unwrap_or_default()
        )
    }

    /// A cause in words.
    #[must_use]
    pub fn sentence(&self, cause: &Cause) -> String {
        match cause {
            Cause::Outside { share } => format!(
                "{:.1} % of the inputs are outside the range that the model knows",
                100.0 * share
            ),
            Cause::Doubted { doubts } => format!(
                "{} about the rows: what a model errs by on them tells nothing",
                counted(*doubts, "doubt")
            ),
            Cause::Readings { share, samples, .. } => format!(
                "{:.0} % of the squared error is in {} out of line with neighbours or held",
                100.0 * share,
                counted(*samples, "reading")
            ),
            Cause::LoadsLeftOut { percent } => format!(
                "loads that were left out are predicted to {percent:.2} % of their range: at loads \
                 that were not recorded it is a guess"
            ),
            Cause::OneSpeed { speed } => format!(
                "all was recorded at one speed ({} per second), so what comes late is not told \
                 from a wider loop: at other speeds it is a guess",
                self.input.text(*speed)
            ),
            Cause::OtherSpeed { speed, late: true } => format!(
                "what comes late in the model was found at one speed ({} per second), and this one \
                 has others: there it was a guess",
                self.input.text(*speed)
            ),
            Cause::OtherSpeed { speed, late: false } => format!(
                "the model was fitted at one speed ({} per second), and this one has others: what \
                 comes late is not in the model",
                self.input.text(*speed)
            ),
            Cause::OtherStart { start, percent, .. } => format!(
                "the model begins elsewhere than the actuator did: {}, it errs {percent:.2} %",
                start.words()
            ),
            Cause::LagLeft { tau } => format!(
                "the model was fitted with a lag of {} s of the input's sensor undone, and here it \
                 is not",
                Quantity::default().text(*tau)
            ),
            Cause::Easier { percent } => format!(
                "the model errs {percent:.2} % of the range on what it was fitted to: what was held \
                 out is easier than that"
            ),
            Cause::Clipped {
                value,
                times,
                samples,
            } => format!(
                "{} came to {} {times} times and stayed there for {samples} readings while {} went \
                 on: if its sensor ends there, the model errs by what it did not see",
                self.output.name,
                self.output.text(*value),
                self.input.name
            ),
            Cause::HeldInput { samples } => format!(
                "{} is held for {samples} samples from reading to reading while {} goes on: what \
                 looks late may be that",
                self.input.name, self.output.name
            ),
            Cause::Elsewhere { coverage, sessions } => format!(
                "only {coverage:.1} % of the samples are inside the {}: it does not belong to \
                 this recording",
                band_name(*sessions)
            ),
            Cause::Unrelated { share } => format!(
                "{} hardly follows {}: the model explains {:.0} % of its squared deviations, \
                 little more than its mean",
                self.output.name,
                self.input.name,
                100.0 * share
            ),
            Cause::Rival { name, percent } => format!(
                "{name} errs less ({percent:.2} %): the data do not determine the model, or it \
                 cannot follow them"
            ),
            Cause::Noise { noise } => format!(
                "mostly noise of the readings ({}): a better model cannot help",
                self.output.text(*noise)
            ),
            Cause::FewBranches { branches: 1, .. } => {
                "one branch was recorded: what other paths do is a guess".into()
            }
            Cause::FewBranches { different: 1, .. } => {
                "all branches that were recorded repeat one: what other paths do is a guess".into()
            }
            Cause::FewBranches {
                branches,
                different,
            } if branches > different => format!(
                "only {different} branches that were recorded are different, the other ones repeat \
                 them: what other paths do is a guess"
            ),
            Cause::FewBranches { branches, .. } => {
                format!("only {branches} branches were recorded: what other paths do is a guess")
            }
            Cause::FewPoints { points } => {
                format!("the input stands at {points} points only: what other paths do is a guess")
            }
            Cause::Misfit { misfit, noise } => format!(
                "{} of it is what the model cannot follow; the noise of the readings is {}",
                self.output.text(*misfit),
                self.output.text(*noise)
            ),
            Cause::Part(part) => {
                let share = format!("{:.0} % of the squared error is", 100.0 * part.share);
                match part.kind {
                    PartKind::Offset => format!(
                        "{share} a constant offset of {}: another zero or session",
                        self.output.text(part.size)
                    ),
                    PartKind::Gain if is_odd(part) => format!(
                        "{share} a gain: the output moves {} times as far",
                        Quantity::default().text(1.0 + part.size)
                    ),
                    PartKind::Gain => format!(
                        "{share} a gain: the output moves {:.1} % {} than the model's",
                        100.0 * part.size.abs(),
                        if part.size < 0.0 { "less" } else { "more" }
                    ),
                    PartKind::Shift => format!(
                        "{share} a shift of {} by {}",
                        self.input.name,
                        self.input.text(part.size)
                    ),
                    PartKind::Late => format!(
                        "{share} a delay: the output comes {:.1} samples {} than the model's",
                        part.size.abs(),
                        if part.size < 0.0 { "earlier" } else { "later" }
                    ),
                    PartKind::Drift => format!(
                        "{share} a drift of {} from the first to the last sample",
                        self.output.text(part.size)
                    ),
                }
            }
        }
    }

    fn worst(&self) -> Option<String> {
        let worst = self.worst.as_ref()?;
        let time = worst
            .time
            .map(|time| format!(" at {} s", (time * 1e6).round() / 1e6));
        Some(format!(
            "{}{}: {} {}, {} {} measured, {} modelled",
            worst.named(),
            time.unwrap_or_default(),
            self.input.name,
            self.input.text(worst.input),
            self.output.name,
            self.output.text(worst.measured),
            self.output.text(worst.modelled),
        ))
    }

    /// What to do next.
    #[must_use]
    pub fn next(&self) -> Remedy {
        let first = self.causes.first();
        // To adapt the model to a drift or a delay would spoil it.
        let moves = self.causes.iter().find(|cause| {
            matches!(cause, Cause::Part(part) if matches!(part.kind, PartKind::Drift | PartKind::Late))
        });
        // No offset helps where the unit is another one.
        let odd = |cause: &&Cause| match cause {
            Cause::Part(part) => part.kind == PartKind::Gain && is_odd(part),
            _ => false,
        };
        let weightiest = match first {
            Some(Cause::Part(_)) => self.causes.iter().find(odd).or(moves).or(first),
            _ => first,
        };
        let is_good = self.grade == Grade::Good;
        match weightiest {
            Some(Cause::Doubted { .. }) => Remedy::new(
                "look at the rows in doubt, mend or leave out those that are wrong, and try again",
                [],
            ),
            _ if self.basis == Basis::Fitted && self.grade == Grade::Untested => {
                match self.causes.iter().any(is_few) {
                    true => Remedy::new(
                        "evaluate it on another recording: this one has too few branches to hold \
                         some out",
                        [],
                    ),
                    false => Remedy::new(
                        "evaluate it on another recording, or hold a part out of the fit with {}",
                        [Setting::any("hold-out")],
                    ),
                }
            }
            _ if is_good && self.basis != Basis::OtherRecording => {
                let speed = self.one_speed.map(|speed| {
                    let speed = self.input.text(speed);
                    format!("; so may another speed, as all of this one is at {speed} per second")
                });
                let words = "evaluate it on another recording: the same actuator on another day \
                             may differ";
                Remedy::new(format!("{words}{}", speed.unwrap_or_default()), [])
            }
            _ if is_good => Remedy::new("use it: invert, control, export", []),
            Some(Cause::Outside { .. }) => Remedy::new(
                "fit a recording that covers this range, or check the unit of the input",
                [],
            ),
            Some(Cause::Unrelated { .. }) => Remedy::new(
                "look whether these are input and output, and whether their rows belong together; \
                 a loop with two wings (a butterfly) is fitted with {}",
                [Setting::word("solver", "ols")],
            ),
            Some(Cause::Part(part)) => match part.kind {
                PartKind::Gain if is_odd(part) => Remedy::new(
                    "check the unit of the output, and that the recording is of this actuator",
                    [],
                ),
                PartKind::Offset | PartKind::Gain | PartKind::Shift => Remedy::new(
                    "adapt the model to this session (adapt), and compare again",
                    [],
                ),
                PartKind::Late if part.size < 0.0 => Remedy::new(
                    "if the sensor of the input is slow, undo it with {}; if the loop runs the other \
                     way round, fit it with {}, which has no inverse; else look whether input and \
                     output are exchanged, and whether their rows belong together",
                    [
                        Setting::word("sensor-lag", "auto"),
                        Setting::word("solver", "ols"),
                    ],
                ),
                PartKind::Late if self.tried.body => Remedy::new(
                    "fit this recording together with the one fitted: the body was found from that \
                     one alone",
                    [],
                ),
                PartKind::Late if self.has_time && self.tried.thermal => Remedy::new(
                    "let the fit look for what comes late: {} or {}",
                    [Setting::word("lag", "auto"), Setting::word("creep", "auto")],
                ),
                PartKind::Late if self.has_time => Remedy::new(
                    "let the fit look for what comes late: {}, {}, or {} for a drive that heats",
                    [
                        Setting::word("lag", "auto"),
                        Setting::word("creep", "auto"),
                        Setting::on("thermal"),
                    ],
                ),
                PartKind::Late => Remedy::new(
                    "name the time and let the fit look for dynamics: {}, {}, {} for a drive that \
                     heats",
                    [
                        Setting::any("time"),
                        Setting::word("dynamics", "auto"),
                        Setting::on("thermal"),
                    ],
                ),
                PartKind::Drift if self.has_time => Remedy::new(
                    "let the specimen settle before you record, adapt on line (adapt), or fit it with \
                     the time as {} and not as {}",
                    [Setting::any("load"), Setting::any("time")],
                ),
                PartKind::Drift => Remedy::new(
                    "let the specimen settle before you record, adapt on line (adapt), or fit it with \
                     the time as {}",
                    [Setting::any("load")],
                ),
            },
            Some(Cause::Noise { .. }) => Remedy::new(
                "average the readings, or use {}, whose steps are taken only where they help",
                [Setting::on("prepare")],
            ),
            Some(Cause::Readings {
                samples, replaced, ..
            }) => remedy_of_readings(*samples, *replaced),
            Some(Cause::OtherStart { start, .. }) => Remedy::new(
                "evaluate it with {}; a stroke over the whole range, there and back, brings \
                     actuator and model together",
                [Setting::word("start", start.name())],
            ),
            Some(Cause::LagLeft { .. }) => Remedy::new(
                "undo it here too, with {} and that time constant",
                [Setting::any("sensor-lag")],
            ),
            Some(Cause::OtherSpeed { late: true, .. }) if self.tried.body => Remedy::new(
                "fit both recordings together, so that there are several speeds",
                [],
            ),
            Some(Cause::OtherSpeed { late: true, .. }) => Remedy::new(
                "fit both recordings together, so that there are several speeds, or compare a fit \
                 without what comes late: {}",
                [Setting::word("dynamics", "off")],
            ),
            Some(Cause::OtherSpeed { late: false, .. }) => Remedy::new(
                "fit both recordings together, with {}, and look for what comes late: {} or, if \
                 the input is a drive that heats, {}",
                [Setting::any("time"), CREEP, Setting::on("thermal")],
            ),
            Some(Cause::OneSpeed { .. }) => Remedy::new(
                "record at two speeds or more, of which one is several times the other",
                [],
            ),
            Some(Cause::Clipped { .. }) => Remedy::new(
                "record within the reach of the sensor; a stop of the mechanism looks the same, and \
                 is followed",
                [],
            ),
            Some(Cause::HeldInput { .. }) => Remedy::new(
                "read the input as often as the output, or log both at the pace of the slower one",
                [],
            ),
            Some(Cause::LoadsLeftOut { .. }) => {
                Remedy::new("record loads between those that there are", [])
            }
            _ => {
                let record = self.one_speed.map_or(MORE, |_| FASTER);
                let (load, time) = (self.has_load, self.has_time);
                let steps = [
                    (time && !self.tried.creep, ", look for creep ({})", CREEP),
                    (
                        time && !load && !self.tried.thermal,
                        ", for a body that heats if the input is a drive ({})",
                        Setting::on("thermal"),
                    ),
                    (
                        time && !load && !self.tried.sensor_lag,
                        ", undo a slow sensor of the input ({})",
                        Setting::word("sensor-lag", "auto"),
                    ),
                    (
                        !load,
                        ", name what else moves the output ({})",
                        Setting::any("load"),
                    ),
                    (!time, ", name the time ({})", Setting::any("time")),
                ];
                let steps = steps.into_iter().filter(|(helps, ..)| *helps);
                let (words, settings): (String, Vec<Setting>) =
                    steps.map(|(_, words, setting)| (words, setting)).unzip();
                Remedy::listed(format!("{record}{words}"), settings)
            }
        }
    }
}

/// The sentences, a line each. Options are shown by name.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.lines(|setting| format!("`{}`", setting.name.replace('-', " ")));
        let lines = lines
            .iter()
            .map(|(heading, text)| format!("{heading}: {text}"));
        f.write_str(&lines.collect::<Vec<_>>().join("\n"))
    }
}
