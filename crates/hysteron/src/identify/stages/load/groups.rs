//! The samples of all recordings, and the loads that count as the same.

use crate::error::Result;
use crate::identify::options::FitOptions;
use crate::identify::weights::experiment::Experiment;
use crate::recording::Recording;
use crate::series::range;

/// Loads closer than this share of their range are one load.
const SAME: f64 = 0.03;

/// With more loads than this the load changes all the time, and the shift has `EVEN_KNOTS` knots.
const MOST: usize = 8;
const EVEN_KNOTS: usize = 3;

/// A plateau of the load has at least this share of the samples, and at most this share lies on none.
const RESTING: f64 = 0.08;
const MOVING: f64 = 0.25;

/// The shift of a load is found only if the output moves by this share of the largest stroke.
pub(super) const TELLING: f64 = 0.12;

/// All samples of the recordings in one series.
pub(super) struct Samples {
    pub(super) input: Vec<f64>,
    pub(super) output: Vec<f64>,
    pub(super) load: Vec<f64>,
}

impl Samples {
    /// Refuses what an experiment refuses: a recording without a load, and a load that is the same
    /// throughout.
    pub(super) fn new(recordings: &[Recording]) -> Result<Self> {
        let options = FitOptions {
            load_degree: Some(0),
            ..FitOptions::plain()
        };
        let Experiment { input, output, .. } = Experiment::new(recordings, &options)?;
        let loads = recordings.iter().flat_map(|recording| &recording.load);
        Ok(Self {
            input: input.into_owned(),
            output: output.into_owned(),
            load: loads.flatten().copied().collect(),
        })
    }
}

/// The loads, in groups of loads that are the same.
pub(super) struct Groups {
    /// The load of each group, ascending; for loads that change all the time, knots of the shift.
    pub(super) knots: Vec<f64>,
    /// The group of each sample; `None` for loads that change all the time.
    pub(super) group: Option<Vec<usize>>,
    /// Whether the output moves enough in a group to tell its shift.
    pub(super) telling: Vec<bool>,
    /// Whether two groups or more have a stroke that shows the shape of their loop.
    pub(super) show_loops: bool,
}

impl Groups {
    pub(super) fn new(recordings: &[Recording], samples: &Samples) -> Self {
        let (low, high) = range(&samples.load);
        let loads = match recordings.len() {
            1 => plateaus(&samples.load),
            _ => apart(
                recordings.iter().map(middle_load).collect(),
                SAME * (high - low),
            ),
        };
        if !(2..=MOST).contains(&loads.len()) {
            let knot = |n: usize| low + (high - low) * n as f64 / (EVEN_KNOTS - 1) as f64;
            return Self {
                knots: (0..EVEN_KNOTS).map(knot).collect(),
                group: None,
                telling: vec![true; EVEN_KNOTS],
                show_loops: false,
            };
        }
        let nearest = |load: f64| {
            let by = |a: &usize, b: &usize| {
                (loads[*a] - load)
                    .abs()
                    .total_cmp(&(loads[*b] - load).abs())
            };
            (0..loads.len()).min_by(by).unwrap_or(0)
        };
        let group: Vec<usize> = match recordings.len() {
            1 => samples.load.iter().map(|load| nearest(*load)).collect(),
            // The load of a recording may waver, but it is one load.
            _ => recordings
                .iter()
                .flat_map(|recording| vec![nearest(middle_load(recording)); recording.len()])
                .collect(),
        };
        let strokes: Vec<f64> = (0..loads.len())
            .map(|g| {
                let own = samples
                    .output
                    .iter()
                    .zip(&group)
                    .filter(|(_, at)| **at == g);
                let (low, high) = range(&own.map(|(y, _)| *y).collect::<Vec<_>>());
                high - low
            })
            .collect();
        let most = strokes.iter().fold(0.0, |a: f64, b| a.max(*b));
        let mut telling: Vec<bool> = strokes
            .iter()
            .map(|stroke| *stroke > TELLING * most)
            .collect();
        let show_loops = telling.iter().filter(|telling| **telling).count() >= 2;
        if !show_loops {
            telling.fill(true);
        }
        Self {
            telling,
            show_loops,
            knots: loads,
            group: Some(group),
        }
    }
}

/// The median load of a recording.
fn middle_load(recording: &Recording) -> f64 {
    let mut load = recording.load.clone().unwrap_or_default();
    load.sort_by(f64::total_cmp);
    load.get(load.len() / 2).copied().unwrap_or_default()
}

/// Ascending, and those that are closer than `same` merged.
fn apart(mut loads: Vec<f64>, same: f64) -> Vec<f64> {
    loads.sort_by(f64::total_cmp);
    loads.dedup_by(|b, a| *b - *a <= same);
    loads
}

/// The loads at which a load that changes in steps rests; none if it does not rest most of the time.
fn plateaus(load: &[f64]) -> Vec<f64> {
    let (low, high) = range(load);
    let width = 2.0 * SAME * (high - low);
    let mut left = load.to_vec();
    left.sort_by(f64::total_cmp);
    let mut found = Vec::new();
    while found.len() <= MOST {
        // The window with the most samples.
        let (mut end, mut best) = (0, (0, 0));
        for begin in 0..left.len() {
            while end < left.len() && left[end] - left[begin] <= width {
                end += 1;
            }
            if end - begin > best.1 - best.0 {
                best = (begin, end);
            }
        }
        if (best.1 - best.0) as f64 <= RESTING * load.len() as f64 {
            break;
        }
        found.push(left[(best.0 + best.1) / 2]);
        left.drain(best.0..best.1);
    }
    match left.len() as f64 > MOVING * load.len() as f64 {
        true => Vec::new(),
        false => apart(found, width),
    }
}
