//! Controllers compared on a **simulated** plant: a [`Scenario`] goes in, scores and traces come
//! out of [`track`].
//!
//! For each seed a model is identified from an experiment of its own, and every controller runs
//! over the same reference with the same disturbances. The gains of all PIDs come from one test on
//! the same plant, or, for each controller, from the model of the run.

mod check;
mod identify;
mod kind;
mod options;
mod place;
mod plant;
mod reference;
mod scenario;
mod score;
mod self_tuning;
mod summary;
mod tune;

pub use kind::Kind;
pub use options::{LoopOptions, ModelOptions, Tuning, compensator};
pub use place::{line_at, line_of};
pub use plant::{Event, PlantOptions, course};
pub use reference::Reference;
pub use scenario::Scenario;
pub use score::{ReversalLag, Score, Window, reversal_lags};
pub use summary::{Median, Ratio};

use crate::joint::Tuned;
use hysteron::control::{Compensator, Controller, Course, Gains, Scheme, Trace, run_with};
use hysteron::{Error, Model, Progress, Result, headings};
use rayon::prelude::*;
use self_tuning::SelfTuning;
use std::sync::{Mutex, PoisonError};

/// A noisy reading that stays the same to the last bit for this many samples is stuck.
const STUCK_SAMPLES: f64 = 15.0;

/// The result of a comparison.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// The scenario's title.
    pub title: String,
    /// The controllers, in order.
    pub controllers: Vec<Kind>,
    /// The windows, in order.
    pub windows: Vec<Window>,
    /// Scores by controller, seed, window.
    pub scores: Vec<Vec<Vec<Score>>>,
    /// Each controller's run of the first seed.
    pub traces: Vec<Trace>,
    /// The model identified for the first seed.
    pub model: Model,
    /// Gains of the PID, by the scenario's [`Tuning`]; none where no controller has one, or where
    /// each has its own.
    pub gains: Option<Gains>,
    /// Gains by [`Tuning::Model`] and their margin, by controller, seed; none by another tuning,
    /// and of a controller without PID.
    pub tuned: Vec<Vec<Option<Tuned>>>,
    /// Gains of the loop inside, by SIMC; none where there is none.
    pub inner_gains: Option<Gains>,
}

/// Runs every controller of the scenario with every seed. `progress` is told of each finished run.
///
/// # Errors
/// [`Error::Scenario`] names a field that is wrong, or a plant that does not answer the tuning
/// test; [`Error::Plant`] for a plant outside its physics; as [`hysteron::Fit::run`] for a model
/// that cannot be identified.
///
/// ```
/// use hysteron::Progress;
/// use hysteron_sim::track::{Scenario, track};
/// let text = r#"
/// title = "A sine on a simulated piezo-like actuator"
/// duration_s = 8
/// interval_s = 0.01
/// settle_s = 2
/// seeds = 1
/// plant = { kind = "preisach", levels = 60 }
/// model = { levels = 10, range = [8, 150], rates = [200, 200] }
/// loop = { filter_s = 0.01, tolerance = 0.5 }
/// controllers = ["pid", "inverse-pid"]
/// [[reference]]
/// kind = "constant"
/// value = 36
/// [[reference]]
/// kind = "sine"
/// amplitude = 24
/// period_s = 2
/// "#;
/// let scenario = Scenario::parse(text, std::path::Path::new(""))?;
/// let comparison = track(&scenario, Progress::NONE)?;
/// // µm, of the first seed and window
/// let [pid, inverse_pid] = [0, 1].map(|k| comparison.scores[k][0][0].rmse);
/// assert!(inverse_pid < pid);
/// # Ok::<(), hysteron::Error>(())
/// ```
pub fn track(scenario: &Scenario, progress: Progress<'_>) -> Result<Comparison> {
    let total = scenario.controllers.len() * scenario.seeds as usize;
    progress.tell("runs", 0.0)?;
    let (scheme, gains) = tune(scenario)?;
    let reference = scenario.references();
    let headings = headings(&reference, scenario.shared.tolerance);
    let events = plant::course(&scenario.disturbance, scenario.interval_s);
    let course = Course {
        reference: &reference,
        headings: &headings,
        ahead: (scenario.shared.preview_s / scenario.interval_s).round() as usize,
        events: &events,
    };
    let windows = score::windows(scenario);
    let finished = Mutex::new(0);
    // One after the other, so that nobody is told a smaller count after a larger one.
    let tell = |more: usize| {
        let mut finished = finished.lock().unwrap_or_else(PoisonError::into_inner);
        *finished += more;
        progress.tell("runs", *finished as f64 / total as f64)
    };
    struct Ran {
        trace: Option<Trace>,
        scores: Vec<Score>,
        tuned: Option<Tuned>,
    }
    let by_model = scenario.shared.tuning == Tuning::Model;
    let seeds: Vec<(Model, Vec<Ran>)> = (1..=u64::from(scenario.seeds))
        .into_par_iter()
        .map(|seed| {
            // Recordings and runs do not share their noise.
            let model = identify::identify(scenario, &scheme, seed + 1_000_000)?;
            let runs = scenario.controllers.par_iter().map(|kind| {
                let mut plant = scenario.plant.build(seed)?;
                for &(time_s, drive) in &scenario.before {
                    plant.write(drive);
                    plant.advance(time_s);
                }
                let tuned = match by_model && kind.has_pid() {
                    true => Some(tune::by_model(&scheme, &model, *kind)?),
                    false => None,
                };
                let gains = tuned.map(|tuned| tuned.gains).or(gains);
                let mut tuner = match (kind, gains) {
                    (Kind::PiRls, Some(gains)) => SelfTuning::new(scenario, &scheme, gains),
                    _ => None,
                };
                let gains = tuner.as_ref().map(SelfTuning::first).or(gains);
                let mut controller = controller(scenario, &scheme, &model, gains, *kind)?;
                let trace = run_with(
                    plant.as_mut(),
                    &mut controller,
                    &course,
                    Progress::new(&|_, _| tell(0)),
                    &mut |controller, action| match tuner.as_mut().and_then(|t| t.push(action)) {
                        Some(gains) => controller.retune(gains),
                        None => Ok(()),
                    },
                )?;
                let score = |window| Score::new(&trace, window, scheme.drives, &model);
                let scores = windows.iter().map(score).collect::<Result<Vec<_>>>()?;
                tell(1)?;
                Ok(Ran {
                    trace: (seed == 1).then_some(trace),
                    scores,
                    tuned,
                })
            });
            let runs = runs.collect::<Result<Vec<_>>>()?;
            Ok((model, runs))
        })
        .collect::<Result<_>>()?;
    let controllers = 0..scenario.controllers.len();
    let scores = |k: usize| seeds.iter().map(move |(_, runs)| runs[k].scores.clone());
    let scores = controllers.clone().map(|k| scores(k).collect()).collect();
    let tuned = |k: usize| seeds.iter().map(move |(_, runs)| runs[k].tuned);
    let tuned = controllers.map(|k| tuned(k).collect()).collect();
    let mut seeds = seeds.into_iter();
    let (model, runs) = seeds.next().ok_or_else(|| Error::Scenario {
        path: None,
        line: None,
        field: "seeds".into(),
        problem: "at least one run is needed".into(),
    })?;
    Ok(Comparison {
        title: scenario.title.clone(),
        controllers: scenario.controllers.clone(),
        windows,
        scores,
        traces: runs.into_iter().filter_map(|ran| ran.trace).collect(),
        model,
        gains,
        tuned,
        inner_gains: scheme.inner.map(|inner| inner.gains),
    })
}

/// What all controllers of a scenario share, and the gains of their PID, where one of them has any
/// and a test of the plant gives them.
///
/// # Errors
/// As [`track`].
pub fn tune(scenario: &Scenario) -> Result<(Scheme, Option<Gains>)> {
    scenario.check()?;
    let mut scheme = base(scenario)?;
    if scenario.plant.heats() {
        scheme.inner = Some(tune::inner(scenario, &scheme)?);
    }
    let gains = match scenario.controllers.iter().any(|kind| kind.has_pid()) {
        true => tune::outer(scenario, &scheme)?,
        false => None,
    };
    Ok((scheme, gains))
}

/// What all controllers of a scenario share, without gains.
fn base(scenario: &Scenario) -> Result<Scheme> {
    let plane = scenario.model.plane()?;
    let truth = scenario.plant.build(1)?.truth();
    let drives = scenario.plant.drives();
    let commands = match scenario.plant.heats() {
        true => (plane.bottom(), plane.max()),
        false => drives,
    };
    Ok(Scheme {
        interval_s: scenario.interval_s,
        compensator: None,
        policy: hysteron::Policy::Hold,
        tolerance: scenario.shared.tolerance,
        pid: None,
        bias: match scenario.plant.has_body() {
            true => drives.0,
            false => truth.input.unwrap_or(drives.0),
        }
        .clamp(commands.0, commands.1),
        commands,
        drives,
        inner: None,
        filter_s: scenario.shared.filter_s,
        delay: scenario.shared.delay,
        stuck_s: (scenario.plant.noisy()).then_some(STUCK_SAMPLES * scenario.interval_s),
        ..Scheme::new(scenario.interval_s, commands)
    })
}

fn controller(
    scenario: &Scenario,
    scheme: &Scheme,
    model: &Model,
    gains: Option<Gains>,
    kind: Kind,
) -> Result<Controller> {
    let compensator = match kind {
        _ if !kind.has_model() => None,
        _ if kind.adapts() => Some(options::compensator(&scenario.adaptation, model)?),
        _ => Some(Compensator::fixed(model)?),
    };
    Controller::new(Scheme {
        compensator,
        policy: kind.policy(),
        pid: gains.filter(|_| kind.has_pid()),
        ..scheme.clone()
    })
}
