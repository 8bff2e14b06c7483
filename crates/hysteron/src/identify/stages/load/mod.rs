//! Identifies how the load shifts the axis of the operators.
//!
//! The shift of a load starts at the mean of the inputs at which its loop passes half its height.
//! A search then moves the shifts so that one set of weights explains the loops of all loads, each
//! scaled to its own height. The order of the weights in the load, and a scale of the axis, are
//! taken where loads that were left out are predicted better with them.

mod curves;
mod groups;
mod left_out;
mod search;

pub(super) use curves::behind;

use crate::error::Result;
use crate::identify::options::FitOptions;
use crate::identify::stages::load::curves::{moving_only, refined};
use crate::identify::stages::load::groups::{Groups, Samples};
use crate::identify::stages::load::search::Search;
use crate::model::{LoadCurves, Smooth};
use crate::progress::Progress;
use crate::recording::Recording;
use serde::Serialize;

/// Smoothness of the weights in the search, so that operators that few data touch stay small.
const SMOOTH: Smooth = Smooth {
    along: 0.0,
    across: 1e-6,
};

/// Levels of the search. Shifts do not need more.
const LEVELS: usize = 14;

/// A more complex law has to predict loads left out better by this factor.
const WORTH: f64 = 0.9;

/// The law of the load, and what chose it.
pub(super) struct Law {
    pub(super) curves: LoadCurves,
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
    /// The laws tried, and their errors on loads left out, in percent of the range.
    tried: Vec<(Tried, f64)>,
}

/// How stroke and offset follow the load.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Tried {
    /// One set of weights; its gain and offset are straight over the load to this power.
    Gain { power: f64, scaled: bool },
    /// Weights of this order in the load.
    Weights { degree: usize, scaled: bool },
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
    let plain = search.curves(false)?;
    let inner = match groups.group {
        Some(_) => groups.knots.len().saturating_sub(2),
        None => 0,
    };
    // A stroke that saturates is nearly straight over the root of the load. Without loads to leave
    // out, that is what to expect of a tension. Of a load below zero nothing is known: straight.
    let rooted = groups.knots.iter().all(|load| *load >= 0.0);
    let powers: &[f64] = if rooted { &[0.5, 1.0] } else { &[1.0] };
    let mut candidates = Vec::new();
    for scaled in [false, true] {
        match (options.load_degree, &groups.group) {
            (Some(degree), _) => candidates.push(Tried::Weights { degree, scaled }),
            (None, None) => candidates.push(Tried::Weights { degree: 1, scaled }),
            (None, Some(_)) => {
                candidates.extend(powers.iter().map(|&power| Tried::Gain { power, scaled }));
                // Two loads cannot tell weights of their own from one shape.
                let degrees = 1..=groups.knots.len().saturating_sub(2).min(2);
                candidates.extend(degrees.map(|degree| Tried::Weights { degree, scaled }));
            }
        }
    }
    let stretched = match inner {
        0 => None,
        _ => Some(search.curves(true)?),
    };
    let mut tried: Vec<(Tried, f64)> = Vec::new();
    for candidate in candidates {
        let (Tried::Gain { scaled, .. } | Tried::Weights { scaled, .. }) = candidate;
        let curves = match (scaled, &stretched) {
            (false, _) => &plain,
            (true, Some(curves)) => curves,
            (true, None) => continue,
        };
        progress.tell("loads left out", f64::NAN)?;
        let error = search.left_out(curves, candidate)?;
        tried.push((candidate, error));
    }
    let mut best = tried[0];
    for next in &tried[1..] {
        if inner > 0 && next.1 < WORTH * best.1 {
            best = *next;
        }
    }
    let (Tried::Gain { scaled, .. } | Tried::Weights { scaled, .. }) = best.0;
    let curves = match (scaled, stretched) {
        (true, Some(curves)) => curves,
        _ => plain,
    };
    let (curves, uses_curves, degree) = match best.0 {
        Tried::Gain { power, .. } => (refined(&curves, power), true, 0),
        Tried::Weights { degree, .. } => (moving_only(&curves), false, degree),
    };
    let report = Report {
        loads: groups.knots.clone(),
        slope: curves.slope(),
        tried,
    };
    Ok(Law {
        curves,
        uses_curves,
        degree,
        report,
    })
}
