//! Identifies the heat that the operators bind, where it predicts parts of the recordings that were
//! left out.
//!
//! The body loses so much heat per unit of the output. In the search that is the output measured: so
//! for given constants the weights stay a linear problem. What is found is judged by the model that
//! runs from the drive alone, with the heat that its own output binds.

use crate::error::{Error, Result};
use crate::identify::fixed::described;
use crate::identify::kept;
use crate::identify::options::FitOptions;
use crate::identify::stages::blocks::{BLOCKS, WORTH};
use crate::identify::stages::body::Search;
use crate::identify::stages::nelder_mead::minimise;
use crate::identify::weights::problem::Problem;
use crate::model::{FirstOrder, Found, Model, Solver, needs_time};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;
use hysteron_core::Operator;
use serde::Serialize;

/// The search begins with so much heat for the range of the output, as a share of the range of
/// temperatures at rest. A wire of NiTi binds about as much as 60 to 100 K take.
const FIRST: f64 = 0.5;

/// First edge of the simplex, its last size and its steps, as in the search for a body.
const EDGE: f64 = 0.3;
const TOLERANCE: f64 = 2e-3;
const STEPS: usize = 100;

/// A body that loses heat to the output.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heated {
    pub(super) body: FirstOrder,
    /// Degrees per unit of the output; below zero for an output that falls with the temperature.
    pub(super) per_output: f64,
}

/// What was found.
pub(super) struct Binding {
    pub(super) heated: Heated,
    pub(super) report: Report,
}

/// What was tried, for the model file.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Report {
    /// Error on what is left out if nothing is bound, in percent of the range.
    without: f64,
    /// The same with the heat found.
    with: f64,
}

impl Heated {
    /// A body alone.
    pub(super) fn unbound(body: FirstOrder) -> Self {
        Self {
            body,
            per_output: 0.0,
        }
    }

    /// The recordings with the temperature as their input.
    pub(super) fn behind(&self, recordings: &[Recording]) -> Result<Vec<Recording>> {
        let behind = |recording: &Recording| match self.per_output == 0.0 {
            true => self.body.behind(recording),
            false => Ok(Recording {
                input: self.respond(recording)?,
                rest: None,
                ..recording.clone()
            }),
        };
        recordings.iter().map(behind).collect()
    }

    fn respond(&self, recording: &Recording) -> Result<Vec<f64>> {
        let time = recording.time.as_ref().ok_or_else(needs_time)?;
        let output = smoothed(&recording.output);
        let first = recording.rest.or(recording.input.first().copied());
        let mut temperature = self.body.rest(first.unwrap_or_default());
        let samples = recording.input.iter().enumerate().map(|(n, &drive)| {
            let before = n.saturating_sub(1);
            let unbound = self.body.step(temperature, time[n] - time[before], drive)?;
            temperature = unbound - self.per_output * (output[n] - output[before]);
            Ok(temperature)
        });
        samples.collect()
    }
}

/// The output with less of its noise, which would be a noise of the temperature.
fn smoothed(output: &[f64]) -> Vec<f64> {
    let at = |n: usize| output[n.min(output.len() - 1)];
    let mean = |n: usize| 0.25 * at(n.saturating_sub(1)) + 0.5 * at(n) + 0.25 * at(n + 1);
    (0..output.len()).map(mean).collect()
}

/// The heat that is bound and the time constants beside it; `None` where it predicts little of what
/// is left out, and for relays and weights below zero, which cannot bind any.
///
/// # Errors
/// As the search for a body.
pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    (unbound, told_apart): (Heated, bool),
    progress: Progress<'_>,
) -> Result<Option<Binding>> {
    if options.operator == Operator::Relay || options.solver != Solver::Nnls {
        return Ok(None);
    }
    let search = Search::new(recordings, options, progress)?;
    let sign = search.model(unbound, None)?.sign().factor();
    let (cold, hot) = search.temperatures(unbound.body);
    let (low, high) = search.outputs();
    if low == high || cold == hot {
        return Ok(None);
    }
    let of = |[heating, cooling, share]: [f64; 3]| Heated {
        body: FirstOrder {
            tau_heating: heating.exp(),
            tau_cooling: cooling.exp(),
            ..unbound.body
        },
        per_output: sign * share * (hot - cold) / (high - low),
    };
    let value = |point: [f64; 3]| match search.has(point[0]) && search.has(point[1]) {
        true if point[2] >= 0.0 => search.left_out(of(point)),
        _ => Ok(f64::INFINITY),
    };
    let taus = [unbound.body.tau_heating, unbound.body.tau_cooling].map(f64::ln);
    // What is bound takes its time as well, which the time constants alone had to explain. So one
    // may do where two were told apart.
    let shorter = taus.map(|tau| tau - FIRST.ln_1p());
    let common = |[tau, share]: [f64; 2]| [tau, tau, share];
    let (at, mut with) = least([shorter[0], FIRST], |at| value(common(at)))?;
    let mut point = common(at);
    if told_apart {
        let (two, apart) = least(point, value)?;
        if apart < (1.0 - WORTH) * with {
            (point, with) = (two, apart);
        }
    }
    // Without heat from both starts: another time constant alone may do as much.
    let mut without = f64::INFINITY;
    for [heating, cooling] in [taus, [point[0], point[1]]] {
        let alone = match told_apart {
            true => least([heating, cooling], |[a, b]| value([a, b, 0.0]))?.1,
            false => least([heating], |[tau]| value([tau, tau, 0.0]))?.1,
        };
        without = without.min(alone);
        let is_worth = with < (1.0 - WORTH) * without;
        if !is_worth {
            return Ok(None);
        }
    }
    let percent = 100.0 / (high - low);
    let report = Report {
        without: percent * without,
        with: percent * with,
    };
    let heated = of(point);
    Ok(Some(Binding { heated, report }))
}

/// The least value near a point, and where it is.
fn least<const N: usize>(
    start: [f64; N],
    value: impl Fn([f64; N]) -> Result<f64>,
) -> Result<([f64; N], f64)> {
    minimise(start, EDGE, TOLERANCE, STEPS, |at| value(*at))
}

impl Search<'_> {
    /// The model behind a body; with a `half`, of the other half alone.
    pub(super) fn model(&self, heated: Heated, half: Option<usize>) -> Result<Model> {
        self.progress.tell("heat that is bound", f64::NAN)?;
        let behind: Vec<Recording> = heated.behind(self.recordings)?;
        let behind: Vec<Recording> = behind.iter().map(|r| self.thinned(r)).collect();
        let kept = half.map(|half| {
            let halves = halves(&behind).into_iter().flatten();
            halves
                .map(|own| f64::from(own != half))
                .collect::<Vec<f64>>()
        });
        let mut problem = Problem::new(&behind, &self.options)?;
        let fitted = problem.solve(kept.as_deref(), Progress::NONE)?;
        let model = described(&problem, &fitted, &behind)?.with_stages(Found {
            thermal: Some(heated.body),
            latent: heated.per_output.abs(),
            ..Found::default()
        })?;
        kept::with_start(model, self.recordings, &self.options)
    }

    /// RMSE of models that run from the drive alone, each on the half that its weights have not
    /// seen.
    fn left_out(&self, heated: Heated) -> Result<f64> {
        let halves = halves(self.recordings);
        let (mut squares, mut count) = (0.0, 0.0);
        for half in [0, 1] {
            let model = match self.model(heated, Some(half)) {
                // The body is too slow to reach the plane.
                Err(error) if matches!(error.parts().0, Error::Fit(_)) => {
                    return Ok(f64::INFINITY);
                }
                found => found?,
            };
            for (recording, halves) in self.recordings.iter().zip(&halves) {
                let (output, _) = model.run_over(&mut model.start(), recording)?;
                let errors = output.iter().zip(&recording.output).zip(halves);
                for ((h, y), _) in errors.filter(|(_, own)| **own == half) {
                    squares += (h - y).powi(2);
                    count += 1.0;
                }
            }
        }
        Ok((squares / count).sqrt())
    }

    /// The temperatures at rest with the lowest and with the highest drive.
    fn temperatures(&self, body: FirstOrder) -> (f64, f64) {
        let drives = self.recordings.iter().map(|r| range(&r.input));
        let (low, high) = drives.fold((f64::INFINITY, f64::NEG_INFINITY), widened);
        (body.rest(low), body.rest(high))
    }

    /// The range of the outputs.
    fn outputs(&self) -> (f64, f64) {
        let outputs = self.recordings.iter().map(|r| range(&r.output));
        outputs.fold((f64::INFINITY, f64::NEG_INFINITY), widened)
    }
}

fn widened((low, high): (f64, f64), (from, to): (f64, f64)) -> (f64, f64) {
    (low.min(from), high.max(to))
}

/// In which half each sample is: every other recording is in the same one. What the weights make up
/// for in drives of one shape, they do not in those of another. A single recording is halved by
/// blocks of time.
fn halves(recordings: &[Recording]) -> Vec<Vec<usize>> {
    let block = |recording: &Recording| -> Vec<usize> {
        let time = recording.time.as_deref().unwrap_or_default();
        let (start, end) = range(time);
        let of = |t: &f64| ((t - start) / (end - start) * BLOCKS as f64) as usize;
        time.iter().map(|t| of(t).min(BLOCKS - 1) % 2).collect()
    };
    match recordings {
        [one] => vec![block(one)],
        several => several
            .iter()
            .enumerate()
            .map(|(n, r)| vec![n % 2; r.len()])
            .collect(),
    }
}
