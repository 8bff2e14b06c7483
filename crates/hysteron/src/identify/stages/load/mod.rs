//! Identifies how the load shifts the axis of the operators.
//!
//! The shift of a load starts at the mean of the inputs at which its loop passes half its height.
//! A search then moves the shifts so that one set of weights explains the loops of all loads, each
//! scaled to its own height. Before that, a registration of the loops is tried: at which input each
//! fraction of the stroke is passed. Loads that are left out choose between these, the order of the
//! weights in the load, a scale of the axis, and how the stroke goes between the loads.

mod curves;
mod groups;
mod left_out;
mod monotone;
mod registration;
mod search;
mod stroke;

use crate::error::{Error, Result};
use crate::identify::options::{FitOptions, LoadLaw};
use crate::identify::stages::load::curves::{fine, moving_only, still};
use crate::identify::stages::load::groups::{Groups, Samples, TELLING};
use crate::identify::stages::load::registration::Loops;
use crate::identify::stages::load::search::Search;
use crate::identify::stages::load::stroke::Stroke;
use crate::model::{LoadCurves, Registration, Smooth};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;
use serde::Serialize;

/// Smoothness of the weights in the search, so that operators that few data touch stay small.
const SMOOTH: Smooth = Smooth {
    along: 0.0,
    across: 1e-6,
};

/// Levels of the search. Shifts do not need more.
const LEVELS: usize = 14;

/// A law of another kind than the best so far has to predict loads left out better by this factor.
/// The registration comes first.
const WORTH: f64 = 0.9;

/// The law of the load, and what chose it.
pub(super) struct Law {
    /// `None` where the axis does not move.
    pub(super) curves: Option<LoadCurves>,
    pub(super) registration: Registration,
    /// The recordings as the operators see them.
    pub(super) seen: Vec<Recording>,
    /// Whether gain and offset are among the curves. Otherwise the weights depend on the load, with
    /// the order `degree`.
    pub(super) uses_curves: bool,
    pub(super) degree: usize,
    pub(super) report: Report,
}

/// How the law was chosen, for the model file.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Report {
    /// The loads that count as different.
    loads: Vec<f64>,
    /// Mean slope of the shift.
    slope: f64,
    /// Those with hardly any stroke: they have no say in the choice of the law.
    silent: Vec<f64>,
    /// The law taken.
    chosen: Tried,
    /// Its error on loads left out, in percent of the range of outputs at such a load; `None`
    /// without a load between two others.
    left_out_percent: Option<f64>,
    /// The laws tried, and their errors on loads left out, or fitted where none can be.
    tried: Vec<(Tried, f64)>,
}

/// How axis, stroke and offset follow the load.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Tried {
    /// One set of weights behind a registration; how its gain and offset follow the load.
    Registered { stroke: Stroke },
    /// One set of weights on a shifted axis.
    Gain { stroke: Stroke, scaled: bool },
    /// Weights of this order in the load, on a shifted axis.
    Weights { degree: usize, scaled: bool },
    /// Weights of this order in the load, on an axis that does not move.
    Alone { degree: usize },
}

impl Tried {
    /// Whether both move the axis in the same way.
    fn is_like(self, other: Self) -> bool {
        use Tried::{Alone, Gain, Registered, Weights};
        match (self, other) {
            (Registered { .. }, Registered { .. }) | (Alone { .. }, Alone { .. }) => true,
            (Gain { scaled: a, .. }, Gain { scaled: b, .. })
            | (Weights { scaled: a, .. }, Weights { scaled: b, .. }) => a == b,
            _ => false,
        }
    }
}

/// What moves at each load.
struct Moves {
    curves: LoadCurves,
    /// The output of all operators at the gain 1, with its sign.
    reach: f64,
    /// The loops that are registered; `None` where the axis is shifted only.
    loops: Option<Loops>,
}

impl Search<'_> {
    /// A shift for each load, and with `scaled` a scale.
    fn shifted(&self, scaled: bool) -> Result<Moves> {
        let mut curves = self.curves(scaled)?;
        let reach = self.find_gains(&mut curves, &Registration::default())?;
        Ok(Moves {
            curves,
            reach,
            loops: None,
        })
    }

    /// A registration of the loops; `None` where the recordings do not show them.
    fn registered(&self) -> Result<Option<Moves>> {
        let Some(loops) = Loops::new(self.recordings, self.samples, self.groups) else {
            return Ok(None);
        };
        let loads = self.groups.knots.clone();
        let mut curves = LoadCurves {
            shifts: vec![0.0; loads.len()],
            loads,
            ..LoadCurves::default()
        };
        for (g, middle) in loops.middles() {
            curves.shifts[g] = middle;
        }
        self.fill_in(&mut curves);
        let registration = loops.registration(&curves, &curves.loads);
        let reach = self.find_gains(&mut curves, &registration)?;
        Ok(Some(Moves {
            curves,
            reach,
            loops: Some(loops),
        }))
    }
}

pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<Law> {
    let samples = Samples::new(recordings)?;
    let groups = Groups::new(recordings, &samples);
    let search = Search {
        recordings,
        samples: &samples,
        groups: &groups,
        options: FitOptions {
            levels: options.levels.min(LEVELS),
            bootstrap: 0,
            smooth: options.smooth.at_least(SMOOTH),
            load_degree: Some(0),
            range: None,
            offset: None,
            ..options.clone()
        },
        progress,
    };
    let inner = search.inner().count();
    let mut ways = Vec::new();
    // A range is given in inputs; behind a registration the axis has other numbers.
    let open = options.load_law == LoadLaw::Auto
        && options.load_degree.is_none()
        && options.range.is_none()
        && groups.group.is_some()
        && groups.show_loops;
    if open {
        ways.extend(search.registered()?);
    }
    ways.push(search.shifted(false)?);
    if inner > 0 {
        ways.push(search.shifted(true)?);
    }
    let mut best: Option<(&Moves, Tried, f64)> = None;
    let mut tried: Vec<(Tried, f64)> = Vec::new();
    for moves in &ways {
        for candidate in candidates(moves, options, &groups) {
            progress.tell("loads left out", f64::NAN)?;
            let error = search.left_out(moves, candidate)?;
            tried.push((candidate, error));
            let better = best.is_none_or(|(_, other, least)| {
                let worth = if candidate.is_like(other) { 1.0 } else { WORTH };
                inner > 0 && error < worth * least
            });
            if better {
                best = Some((moves, candidate, error));
            }
        }
    }
    let Some((moves, law, error)) = best else {
        return Err(Error::Fit("no law of the load was tried".into()));
    };
    let curves = &moves.curves;
    let rows = match law {
        // Straight between the loads: their own rows say it all.
        Tried::Gain {
            stroke: Stroke::Straight,
            ..
        } => curves.loads.clone(),
        _ => fine(&curves.loads),
    };
    let (curves, uses_curves, degree) = match law {
        Tried::Registered { stroke } | Tried::Gain { stroke, .. } => {
            (stroke.at(curves, moves.reach, &rows), true, 0)
        }
        Tried::Weights { degree, .. } => (moving_only(curves), false, degree),
        Tried::Alone { degree } => (still(curves), false, degree),
    };
    let registration = match (&moves.loops, law) {
        (Some(loops), Tried::Registered { .. }) => loops.registration(&moves.curves, &rows),
        _ => Registration::default(),
    };
    let moves_axis = !matches!(law, Tried::Alone { .. });
    Ok(Law {
        seen: search.seen(&curves, &registration, recordings)?,
        report: Report {
            loads: groups.knots.clone(),
            slope: curves.slope(),
            silent: (0..groups.knots.len())
                .filter(|g| !groups.telling[*g])
                .map(|g| groups.knots[g])
                .collect(),
            chosen: law,
            left_out_percent: (inner > 0).then_some(error),
            tried,
        },
        curves: moves_axis.then_some(curves),
        registration,
        uses_curves,
        degree,
    })
}

/// The laws of stroke and offset that are tried where the axis moves so.
fn candidates(moves: &Moves, options: &FitOptions, groups: &Groups) -> Vec<Tried> {
    let scaled = !moves.curves.scales.is_empty();
    let (least, most) = range(&moves.curves.gains);
    // Where no load between two can choose, a power through a stroke near zero is not trusted.
    let strokes = match groups.knots.len() == 2 && least < TELLING * most {
        true => &[Stroke::Straight],
        false => Stroke::possible(&groups.knots),
    };
    let strokes = strokes.iter();
    match (options.load_degree, &groups.group) {
        _ if moves.loops.is_some() => strokes
            .map(|&stroke| Tried::Registered { stroke })
            .collect(),
        (Some(degree), _) => vec![Tried::Weights { degree, scaled }],
        (None, None) => vec![Tried::Weights { degree: 1, scaled }],
        (None, Some(_)) => {
            // Two loads cannot tell weights of their own from one shape.
            let degrees = 1..=groups.knots.len().saturating_sub(2).min(2);
            let weights = degrees
                .clone()
                .map(|degree| Tried::Weights { degree, scaled });
            let alone = degrees.map(|degree| Tried::Alone { degree });
            // Once, and where the law is left to the data.
            let alone = alone.filter(|_| !scaled && options.load_law == LoadLaw::Auto);
            let gains = strokes.map(|&stroke| Tried::Gain { stroke, scaled });
            gains.chain(weights).chain(alone).collect()
        }
    }
}
