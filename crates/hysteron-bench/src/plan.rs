//! What a run does with the device that answered: limits, controller, learner.

use crate::companion::Follows;
use crate::config::{Config, ControllerOptions, Mode, Safety, Tuning};
use crate::error::{Error, Result};
use crate::learner::Beside;
use crate::play::{Course, refuse_empty};
use crate::protocol::Header;
use crate::sweep::{self, Sweep};
use crate::tune::tune;
use crate::{device, error};
use hysteron::control::{Compensator, Controller, Scheme};
use hysteron::{AdaptOptions, Learner, Model, Sample};
use hysteron_sim::{joint::Tuned, joint::UNKNOWN, track};

/// Samples of a reference that a controller is told ahead, at most.
const MOST_AHEAD: usize = 10_000;

/// Share of the output's way that is never taken for a spike.
const SMALL: f64 = 0.02;
/// Nor are so many times the error of the fit, up to this share: a step of a coarse sensor is 3.5
/// times the error that its rounding makes.
const ERRORS: f64 = 4.0;
const COARSE: f64 = 0.1;

/// An output that is further beyond what the model reaches than this share of it is no model's.
const ASTRAY: f64 = 0.5;
/// A reference that leaves what the model reaches by less than this share of it is not told of.
const HARDLY: f64 = 0.01;

/// What is read before the device is asked anything.
#[derive(Debug, Clone)]
pub(crate) struct Sources {
    pub(crate) model: Option<Model>,
    pub(crate) course: Option<Course>,
}

impl Sources {
    /// # Errors
    /// What a model or a table cannot be.
    pub(crate) fn read(config: &Config) -> Result<Self> {
        let course = match config.mode {
            Mode::Record => Course::profile(config)?,
            Mode::Control => Course::reference(config)?,
            Mode::Monitor => None,
        };
        if let Some(course) = &course {
            let field = if config.mode == Mode::Record {
                "profile"
            } else {
                "reference"
            };
            refuse_empty(config, field, course)?;
        }
        let path = config
            .controller
            .as_ref()
            .and_then(|options| options.model.as_ref());
        let model = path.map(|path| Model::read(&config.at(path))).transpose()?;
        if model.as_ref().is_some_and(|model| model.load.is_some()) {
            let what = "this model depends on a load, which a loop does not know: make one for a \
                        single load, or fit one";
            return Err(config.refused("controller.model", what));
        }
        Ok(Self { model, course })
    }
}

/// A run on one device.
pub(crate) struct Plan {
    pub(crate) header: Header,
    pub(crate) mode: Mode,
    /// Lowest and highest drive, and output.
    pub(crate) drives: (f64, f64),
    pub(crate) outputs: Option<(f64, f64)>,
    /// The outputs that the model reaches, with room about them, where no limits are given.
    pub(crate) reach: Option<(f64, f64)>,
    pub(crate) lost_s: f64,
    pub(crate) stuck_s: f64,
    pub(crate) end_s: Option<f64>,
    pub(crate) course: Option<Course>,
    /// Watches what a profile moves.
    pub(crate) sweep: Option<Sweep>,
    /// Samples of the reference that the controller is told ahead.
    pub(crate) ahead: usize,
    pub(crate) controller: Controller,
    pub(crate) beside: Option<Beside>,
    /// Name of the learner.
    pub(crate) learner: Option<Learner>,
    pub(crate) tuned: Option<Tuned>,
    /// What the drive follows.
    pub(crate) follows: Follows,
    /// What somebody should know before it begins.
    pub(crate) remarks: Vec<String>,
}

impl Plan {
    /// # Errors
    /// What the device cannot do, and what no controller can be made of.
    pub(crate) fn new(config: &Config, sources: Sources, header: Header) -> Result<Self> {
        let drives = config.limits.drive.unwrap_or(header.drive);
        let (low, high) = header.drive;
        if drives.0 < low || drives.1 > high {
            let what = format!(
                "{} to {} is wider than the device's {low} to {high}: a host may only narrow them",
                drives.0, drives.1
            );
            return Err(config.refused("limits.drive", what));
        }
        let (usual_lost_s, usual_stuck_s) = Safety::usual(header.dt);
        let lost_s = config.safety.lost_s.unwrap_or(usual_lost_s);
        if lost_s < 1.5 * header.dt {
            let what = format!(
                "{lost_s} s is less than one and a half samples of the device ({} s): every sample \
                 would be lost",
                header.dt
            );
            return Err(config.refused("safety.lost_s", what));
        }
        let mut made = Made::default();
        let controller = match (&config.controller, config.mode) {
            (Some(options), Mode::Control) => {
                made.control(config, options, &sources, &header, drives)?
            }
            _ => Controller::new(Scheme {
                slew: config.limits.slew,
                ..Scheme::new(header.dt, drives)
            })?,
        };
        let options = config.controller.as_ref();
        let ahead = options.map_or(0, |options| {
            let preview = (options.preview_s / header.dt).ceil() as usize;
            controller.due().max(preview).min(MOST_AHEAD)
        });
        let course_end = sources.course.as_ref().map(Course::end_s);
        let stuck_s = config.safety.stuck_s;
        let profile = sources.course.as_ref();
        let sweep = profile
            .filter(|_| config.mode == Mode::Record)
            .and_then(|profile| {
                Sweep::new(profile.range(), drives, stuck_s.unwrap_or(sweep::LEAST_S))
            });
        let mut plan = Self {
            mode: config.mode,
            drives,
            outputs: config.limits.output,
            reach: match (config.mode, config.limits.output, &sources.model) {
                (Mode::Control, None, Some(model)) => {
                    Some(about(model, ASTRAY)).filter(|(low, high)| high > low)
                }
                _ => None,
            },
            lost_s,
            stuck_s: stuck_s.unwrap_or(usual_stuck_s),
            end_s: config.duration_s.or(course_end),
            course: sources.course,
            sweep,
            ahead,
            controller,
            beside: made.beside,
            learner: made.learner,
            tuned: made.tuned,
            follows: Follows::of(config, sources.model.as_ref()),
            remarks: Vec::new(),
            header,
        };
        if let (Some(course), Some(options)) = (&mut plan.course, options)
            && options.kind.policy() == hysteron::Policy::Anticipate
        {
            course.head(made.tolerance, plan.header.dt);
        }
        plan.remarks = plan.remarked(sources.model.as_ref());
        Ok(plan)
    }

    /// Lets model and learner follow a sample that an earlier run has answered.
    pub(crate) fn recall(&mut self, dt: f64, drive: f64, output: f64) -> Result<()> {
        self.controller.replay(dt, drive, output)?;
        if let Some(beside) = &mut self.beside {
            let sample = Sample {
                input: drive,
                dt: Some(dt),
                load: None,
            };
            beside.push(sample, Some(output).filter(|output| output.is_finite()));
        }
        Ok(())
    }

    fn remarked(&self, model: Option<&Model>) -> Vec<String> {
        let beyond = |what: &str, (low, high): (f64, f64), of: &str, (least, most): (f64, f64)| {
            (low < least || high > most).then(|| {
                let [low, high, least, most] = [low, high, least, most].map(short);
                format!("the {what} goes from {low} to {high}, beyond {of}, {least} to {most}")
            })
        };
        let range = self.course.as_ref().map(Course::range);
        let (profile, reference) = match self.mode {
            Mode::Record => (range, None),
            _ => (None, range),
        };
        let clipped = profile.and_then(|range| {
            beyond("profile", range, "limits.drive", self.drives)
                .map(|text| text + ": it is clipped there")
        });
        let outside = reference.zip(self.outputs).and_then(|(range, outputs)| {
            beyond("reference", range, "limits.output", outputs)
                .map(|text| text + ": the run ends there")
        });
        let unreachable = reference.zip(model).and_then(|((low, high), model)| {
            let (least, most) = about(model, HARDLY);
            let reaches = about(model, 0.0);
            (low < least || high > most)
                .then(|| beyond("reference", (low, high), "what the model reaches", reaches))?
        });
        let unwatched = self.header.watchdog.is_none().then(|| {
            "the device has no watchdog: if this program is killed, its drive stays as it is".into()
        });
        let (low, high) = self.drives;
        let safe = self.header.safe;
        let narrow = (!(low..=high).contains(&safe))
            .then(|| format!("the safe drive {safe} is outside limits.drive, {low} to {high}"));
        // A model without time answers at once, however late the plant is.
        let unknown = model.filter(|model| self.tuned.is_some() && !model.is_timed());
        let unknown = unknown.map(|_| {
            let samples = UNKNOWN * self.controller.due();
            format!(
                "the model does not say how fast the plant is: the gains suppose that it answers \
                 within {samples} samples; give smaller ones if it rings"
            )
        });
        let all = [clipped, outside, unreachable, unwatched, narrow, unknown];
        all.into_iter().flatten().collect()
    }
}

/// What belongs to a controller.
#[derive(Default)]
struct Made {
    beside: Option<Beside>,
    learner: Option<Learner>,
    tuned: Option<Tuned>,
    tolerance: f64,
}

impl Made {
    fn control(
        &mut self,
        config: &Config,
        options: &ControllerOptions,
        sources: &Sources,
        header: &Header,
        drives: (f64, f64),
    ) -> Result<Controller> {
        let kind = options.kind;
        if let Some(model) = &sources.model {
            refuse_other(config, model, header)?;
            self.tolerance = model.usual_tolerance();
        }
        self.tolerance = options.tolerance.unwrap_or(self.tolerance);
        let compensator = match &sources.model {
            Some(model) if kind.adapts() => Some(self.learning(config, options, model)?),
            Some(model) if kind.has_model() => Some(Compensator::fixed(model)?),
            _ => None,
        };
        let mut scheme = Scheme {
            policy: kind.policy(),
            tolerance: self.tolerance,
            bias: header.safe.max(drives.0).min(drives.1),
            filter_s: options.filter_s,
            delay: Some(
                options
                    .delay
                    .unwrap_or_else(|| 1 + late(sources.model.as_ref(), header.dt)),
            ),
            slew: config.limits.slew,
            gate: Some(gate(sources)),
            ..Scheme::new(header.dt, drives)
        };
        scheme.pid = match (options.gains().filter(|_| kind.has_pid()), &sources.model) {
            (Some(Tuning::Numbers(gains)), _) => Some(gains),
            (Some(Tuning::Model), Some(model)) => {
                let tuned = tune(model, &scheme, compensator.is_some())?;
                self.tuned = Some(tuned);
                Some(tuned.gains)
            }
            _ => None,
        };
        scheme.compensator = compensator;
        Ok(Controller::new(scheme)?)
    }

    /// A learner in the shadow of the model. One that may take long for a sample learns beside the
    /// loop.
    fn learning(
        &mut self,
        config: &Config,
        options: &ControllerOptions,
        model: &Model,
    ) -> Result<Compensator> {
        let learner = match options.learner.as_deref().map(str::parse::<Learner>) {
            Some(named) => {
                named.map_err(|error| config.refused("controller.learner", error.to_string()))?
            }
            None => options.options.learner,
        };
        self.learner = Some(learner);
        let options = AdaptOptions {
            learner,
            ..options.options
        };
        let learning = match learner {
            // A refit would delay a sample, and a mixture that comes late would be another one.
            Learner::Auto => Compensator::adaptive(options.adaptive_in_time(model)?),
            Learner::Refit => {
                let adaptive = options.adaptive(model)?;
                let beside = Beside::start(adaptive).map_err(|source| Error::Device {
                    name: device::name(config),
                    problem: format!("no thread for the learner: {source}"),
                })?;
                self.beside = Some(beside);
                Compensator::fixed(model)?
            }
            _ => track::compensator(&options, model)?,
        };
        Ok(Compensator::shadowed(model, learning)?)
    }
}

/// The dead time of the model, in samples of the device.
fn late(model: Option<&Model>, dt: f64) -> usize {
    model.map_or(0, |model| model.delay().at(Some(dt)))
}

/// The outputs that a model reaches, from the lowest on, with a share of their range about them.
fn about(model: &Model, share: f64) -> (f64, f64) {
    let (off, on) = model.output_range();
    let room = share * (on - off).abs();
    (off.min(on) - room, off.max(on) + room)
}

/// With six digits: for people.
fn short(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// What is never taken for a spike, in the output's unit.
fn gate(sources: &Sources) -> f64 {
    let scale = scale(sources);
    let fit = sources.model.as_ref().and_then(|model| model.fit.as_ref());
    let error = fit.map_or(0.0, |fit| fit.rmse);
    (ERRORS * error).min(COARSE * scale).max(SMALL * scale)
}

/// How far the output goes: through the reference, or the model's range where that is wider.
fn scale(sources: &Sources) -> f64 {
    let width = |(low, high): (f64, f64)| (high - low).abs();
    let course = sources.course.as_ref().map(Course::range);
    let model = sources.model.as_ref().map(Model::output_range);
    let wide = course
        .into_iter()
        .chain(model)
        .map(width)
        .fold(0.0, f64::max);
    match wide > 0.0 {
        true => wide,
        // A constant reference, and no model.
        false => course.map_or(0.0, |(low, _)| low.abs()),
    }
}

/// Refuses a model of another actuator: its command would be a number of another kind.
fn refuse_other(config: &Config, model: &Model, header: &Header) -> error::Result<()> {
    let name = &model.input.name;
    if model.thermal.is_none() && header.column(name).is_some() {
        let what = format!(
            "its input `{name}` is read by the device, and not driven: a model of the drive is \
             needed, as `hysteron fit --input drive` makes from a log of mode `record`"
        );
        return Err(config.refused("controller.model", what));
    }
    let output = header.column("output").map(|n| &header.columns[n]);
    let pairs = [
        ("input", &model.input.unit, "drive", header.unit.as_ref()),
        (
            "output",
            &model.output.unit,
            "output",
            output.and_then(|one| one.unit.as_ref()),
        ),
    ];
    for (own, unit, what, found) in pairs {
        if let (Some(unit), Some(found)) = (unit, found)
            && unit != found
        {
            let text = format!("its {own} is in {unit}, and the device's {what} in {found}");
            return Err(config.refused("controller.model", text));
        }
    }
    Ok(())
}
