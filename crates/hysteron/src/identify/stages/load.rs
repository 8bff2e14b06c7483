//! Identifies how the load shifts the axis of the operators.
//!
//! The shift of a load starts at the mean of the inputs at which its loop passes half its height.
//! A search then moves the shifts so that one set of weights explains the loops of all loads, each
//! scaled to its own height. The order of the weights in the load, and a scale of the axis, are
//! taken where loads that were left out are predicted better with them.

use crate::error::{Error, Result};
use crate::identify::options::FitOptions;
use crate::identify::stages::with_inputs;
use crate::identify::weights::fit::fit_weights;
use crate::identify::weights::problem::Problem;
use crate::model::LoadCurves;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;
use serde::Serialize;

/// Loads closer than this share of their range are one load.
const SAME: f64 = 0.03;

/// With more loads than this the load changes all the time, and the shift has `EVEN_KNOTS` knots.
const MOST: usize = 8;
const EVEN_KNOTS: usize = 3;

/// A plateau of the load has at least this share of the samples, and at most this share lies on none.
const RESTING: f64 = 0.08;
const MOVING: f64 = 0.25;

/// The shift of a load is found only if the output moves by this share of the largest stroke.
const TELLING: f64 = 0.12;

/// Smoothness of the weights in the search, so that operators that few data touch stay small.
const SMOOTH: f64 = 1e-6;

/// Levels of the search. Shifts do not need more.
const LEVELS: usize = 14;

/// Samples of the search.
const SAMPLES: usize = 3000;

/// First step of the search, as a share of the input's range, and the number of its halvings.
const FIRST: f64 = 0.04;
const HALVINGS: usize = 6;

/// A more complex law has to predict loads left out better by this factor.
const WORTH: f64 = 0.9;

/// With two loads only: one shape for both is right up to this error in percent, and above it if
/// weights of their own do not reduce it to this share.
const ALIKE: f64 = 3.0;
const OF_THEIR_OWN: f64 = 0.4;

/// Knots for each pair of neighbouring loads, where gain and offset between them are not straight.
const FINE: usize = 6;

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
            smooth: options.smooth.max(SMOOTH),
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
                let degrees = 1..=groups.knots.len().saturating_sub(2).clamp(1, 2);
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
        let worth = match inner {
            // Weights of their own always fit two loads better. They are taken only where the
            // loops have different shapes.
            0 if best.1 < ALIKE => 0.0,
            0 => OF_THEIR_OWN,
            _ => WORTH,
        };
        if next.1 < worth * best.1 {
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

/// The curves with more knots, where gain and offset between the loads are not straight.
fn refined(curves: &LoadCurves, power: f64) -> LoadCurves {
    if power == 1.0 {
        return curves.clone();
    }
    let mut loads = Vec::new();
    for pair in curves.loads.windows(2) {
        let knot = |n: usize| pair[0] + (pair[1] - pair[0]) * n as f64 / FINE as f64;
        loads.extend((0..FINE).map(knot));
    }
    loads.extend(curves.loads.last());
    curves.resampled(&loads, power)
}

/// The curves without gain and offset.
fn moving_only(curves: &LoadCurves) -> LoadCurves {
    LoadCurves {
        gains: Vec::new(),
        offsets: Vec::new(),
        ..curves.clone()
    }
}

/// The recordings with the load's shift taken off their inputs.
pub(super) fn behind(curves: &LoadCurves, recordings: &[Recording]) -> Vec<Recording> {
    with_inputs(recordings, |recording| {
        let load = recording.load.iter().flatten();
        let pairs = recording.input.iter().zip(load);
        pairs
            .map(|(t, load)| match curves.at(*load) {
                Ok(at) => at.scale * t - at.shift,
                Err(_) => f64::NAN,
            })
            .collect()
    })
}

/// All samples of the recordings in one series.
struct Samples {
    input: Vec<f64>,
    output: Vec<f64>,
    load: Vec<f64>,
}

impl Samples {
    fn new(recordings: &[Recording]) -> Result<Self> {
        let mut samples = Self {
            input: Vec::new(),
            output: Vec::new(),
            load: Vec::new(),
        };
        for recording in recordings {
            recording.check()?;
            let Some(load) = &recording.load else {
                let what = "some recordings have a load and some have none";
                return Err(Error::Fit(what.into()));
            };
            samples.input.extend_from_slice(&recording.input);
            samples.output.extend_from_slice(&recording.output);
            samples.load.extend_from_slice(load);
        }
        let (low, high) = range(&samples.load);
        // Loads that differ only by rounding are one load.
        if high - low <= 1e-9 * high.abs().max(low.abs()) {
            return Err(Error::Fit(format!(
                "the load is {low} throughout, so its effect cannot be identified: fit without it"
            )));
        }
        Ok(samples)
    }
}

/// The loads, in groups of loads that are the same.
struct Groups {
    /// The load of each group, ascending; for loads that change all the time, knots of the shift.
    knots: Vec<f64>,
    /// The group of each sample; `None` for loads that change all the time.
    group: Option<Vec<usize>>,
    /// Whether the output moves enough in a group to tell its shift.
    telling: Vec<bool>,
}

impl Groups {
    fn new(recordings: &[Recording], samples: &Samples) -> Self {
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
        if telling.iter().filter(|telling| **telling).count() < 2 {
            telling.fill(true);
        }
        Self {
            telling,
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

struct Search<'a> {
    recordings: &'a [Recording],
    samples: &'a Samples,
    groups: &'a Groups,
    options: FitOptions,
    progress: Progress<'a>,
}

impl Search<'_> {
    /// The shift of each load against the lowest one; with `scaled`, the scale too. Then gain and
    /// offset of each load.
    fn curves(&self, scaled: bool) -> Result<LoadCurves> {
        let loads = self.groups.knots.clone();
        let (low, high) = range(&self.samples.input);
        let mut shift = LoadCurves {
            shifts: self.half_heights(),
            scales: if scaled {
                vec![1.0; loads.len()]
            } else {
                Vec::new()
            },
            loads,
            ..LoadCurves::default()
        };
        self.fill_in(&mut shift);
        let normalised = self.normalised();
        let rated = |shift: &LoadCurves| self.rated(&normalised, shift);
        let mut error = rated(&shift)?;
        let centre = 0.5 * (low + high);
        let mut step = FIRST * (high - low);
        for _ in 0..HALVINGS {
            let mut again = true;
            for _ in 0..8 {
                if !again {
                    break;
                }
                again = false;
                let reference = self.groups.telling.iter().position(|telling| *telling);
                for n in 0..shift.loads.len() {
                    if !self.groups.telling[n] || Some(n) == reference {
                        continue;
                    }
                    self.progress.tell("shift by the load", f64::NAN)?;
                    for change in [-step, step] {
                        let mut moved = shift.clone();
                        moved.shifts[n] += change;
                        let found = rated(&moved)?;
                        if found < error {
                            (shift, error, again) = (moved, found, true);
                        }
                        if !scaled {
                            continue;
                        }
                        // About the centre, so that scale and shift are nearly independent.
                        let mut moved = shift.clone();
                        let factor = change / (high - low);
                        moved.scales[n] += factor;
                        moved.shifts[n] += factor * centre;
                        let found = rated(&moved)?;
                        if moved.scales[n] > 0.2 && found < error {
                            (shift, error, again) = (moved, found, true);
                        }
                    }
                }
            }
            step *= 0.5;
        }
        self.fill_in(&mut shift);
        self.find_gains(&mut shift)?;
        Ok(shift)
    }

    /// Gain and offset of each load: the line from the outputs of one set of weights, which fits the
    /// loops scaled to their own height, to the outputs measured at that load. Gains count from that
    /// of the largest one.
    fn find_gains(&self, curves: &mut LoadCurves) -> Result<()> {
        let Some(group) = &self.groups.group else {
            return Ok(());
        };
        let spans = self.spans(group);
        let mut seen = behind(curves, self.recordings);
        let mut at = 0;
        for recording in &mut seen {
            recording.load = None;
            for y in &mut recording.output {
                let (low, high) = spans[group[at]];
                *y = (*y - low) / (high - low).max(f64::MIN_POSITIVE);
                at += 1;
            }
        }
        let mut problem = Problem::new(&seen, &self.options)?;
        let telling = group.iter().map(|g| f64::from(self.groups.telling[*g]));
        let kept: Vec<f64> = telling.collect();
        let fitted = problem.solve(Some(&kept), Progress::NONE)?;
        let predicted = problem.predict(&fitted.solution)?;
        let sign = fitted.sign.factor();
        // The offset of a load is its output with every operator off.
        let off = fitted.solution.free.first().copied().unwrap_or_default();
        let sum = |n: usize| sign * (predicted[n] - off);
        let count = curves.loads.len();
        let (mut gains, mut offsets) = (vec![0.0; count], vec![0.0; count]);
        for g in 0..count {
            let own: Vec<usize> = (0..group.len()).filter(|n| group[*n] == g).collect();
            let mean = |of: &dyn Fn(usize) -> f64| {
                own.iter().map(|n| of(*n)).sum::<f64>() / own.len().max(1) as f64
            };
            let (h, y) = (mean(&sum), mean(&|n| self.samples.output[n]));
            let slope = |n: usize| sum(n) - h;
            let square = mean(&|n| slope(n) * slope(n));
            let product = mean(&|n| slope(n) * (self.samples.output[n] - y));
            // A load with hardly any stroke has a small gain, and none has a gain below zero.
            let (low, high) = spans[g];
            gains[g] = (product / square.max(f64::MIN_POSITIVE)).max(0.05 * (high - low));
            offsets[g] = y - gains[g] * h;
        }
        let most = gains.iter().fold(f64::MIN_POSITIVE, |a, b| a.max(*b));
        gains
            .iter_mut()
            .for_each(|gain| *gain = (*gain / most).max(1e-6));
        (curves.gains, curves.offsets) = (gains, offsets);
        Ok(())
    }

    /// Smallest and largest output of each group.
    fn spans(&self, group: &[usize]) -> Vec<(f64, f64)> {
        let of = |g| {
            let own = self
                .samples
                .output
                .iter()
                .zip(group)
                .filter(|(_, at)| **at == g);
            range(&own.map(|(y, _)| *y).collect::<Vec<_>>())
        };
        (0..self.groups.knots.len()).map(of).collect()
    }

    /// Makes the shift monotone, gives the loads that do not tell theirs the one that follows from
    /// their neighbours, and counts from the lowest load.
    fn fill_in(&self, shift: &mut LoadCurves) {
        let told: Vec<usize> = (0..shift.loads.len())
            .filter(|n| self.groups.telling[*n])
            .collect();
        let (Some(&first), Some(&last)) = (told.first(), told.last()) else {
            return;
        };
        let falls = shift.shifts[last] < shift.shifts[first];
        let mut values: Vec<f64> = told.iter().map(|n| shift.shifts[*n]).collect();
        make_monotone(&mut values, falls);
        let loads: Vec<f64> = told.iter().map(|n| shift.loads[*n]).collect();
        let line = LoadCurves {
            loads,
            shifts: values,
            ..LoadCurves::default()
        };
        for n in 0..shift.loads.len() {
            shift.shifts[n] = line.extended(shift.loads[n]);
            if let (false, Some(scale)) = (self.groups.telling[n], shift.scales.get_mut(n)) {
                *scale = 1.0;
            }
        }
        let lowest = shift.shifts[0];
        shift.shifts.iter_mut().for_each(|s| *s -= lowest);
    }

    /// The mean input at half the height of each load's loop, against the lowest load. Zero where
    /// the load changes all the time.
    fn half_heights(&self) -> Vec<f64> {
        let count = self.groups.knots.len();
        let Some(group) = &self.groups.group else {
            return vec![0.0; count];
        };
        let Samples { input, output, .. } = self.samples;
        let half: Vec<Option<f64>> = (0..count)
            .map(|g| {
                let own: Vec<usize> = (0..input.len()).filter(|n| group[*n] == g).collect();
                let (low, high) = range(&own.iter().map(|n| output[*n]).collect::<Vec<_>>());
                let middle = 0.5 * (low + high);
                // Crossings on the way up and on the way down weigh the same.
                let mut sums = [(0.0, 0); 2];
                for pair in own.windows(2).filter(|pair| pair[1] == pair[0] + 1) {
                    let [a, b] = [pair[0], pair[1]];
                    if (output[a] < middle) != (output[b] < middle) {
                        let part = (middle - output[a]) / (output[b] - output[a]);
                        let sum = &mut sums[usize::from(output[b] > output[a])];
                        sum.0 += input[a] + part * (input[b] - input[a]);
                        sum.1 += 1;
                    }
                }
                let means: Vec<f64> = sums
                    .iter()
                    .filter(|(_, count)| *count > 0)
                    .map(|(sum, count)| sum / f64::from(*count))
                    .collect();
                (!means.is_empty()).then(|| means.iter().sum::<f64>() / means.len() as f64)
            })
            .collect();
        let first = half.iter().flatten().next().copied().unwrap_or(0.0);
        let mut last = first;
        half.into_iter()
            .map(|half| {
                last = half.unwrap_or(last);
                last - first
            })
            .collect()
    }

    /// The recordings without much of their samples, each load's loop scaled to its own height.
    fn normalised(&self) -> Vec<Recording> {
        let stride = self.samples.input.len().div_ceil(SAMPLES);
        let spans = self.groups.group.as_ref().map(|group| self.spans(group));
        let mut begin = 0;
        let each = |recording: &Recording| {
            let from = begin;
            begin += recording.len();
            let kept: Vec<usize> = extremes(&recording.input, stride);
            let output = kept.iter().map(|n| {
                let y = recording.output[*n];
                match (&spans, &self.groups.group) {
                    (Some(spans), Some(group)) => {
                        let (low, high) = spans[group[from + n]];
                        (y - low) / (high - low).max(f64::MIN_POSITIVE)
                    }
                    _ => y,
                }
            });
            let every = |values: &[f64]| kept.iter().map(|n| values[*n]).collect::<Vec<f64>>();
            Recording {
                output: output.collect(),
                time: None,
                load: recording.load.as_deref().map(every),
                input: every(&recording.input),
                ..recording.clone()
            }
        };
        self.recordings.iter().map(each).collect()
    }

    /// Error of one set of weights behind this shift. Where the load changes all the time, the
    /// weights follow it in the first order.
    fn rated(&self, recordings: &[Recording], shift: &LoadCurves) -> Result<f64> {
        let mut seen = behind(shift, recordings);
        let options = match self.groups.group {
            Some(_) => {
                seen.iter_mut().for_each(|recording| recording.load = None);
                self.options.clone()
            }
            None => FitOptions {
                load_degree: Some(1),
                ..self.options.clone()
            },
        };
        let model = fit_weights(&seen, &options, Progress::NONE)?;
        Ok(model.fit.map_or(f64::INFINITY, |fit| fit.rmse))
    }

    /// The error on each load that was left out, between those next to it, in percent of the range
    /// of its output; the root of the mean square. Without a load between two others it is the error
    /// on all of them, fitted.
    fn left_out(&self, curves: &LoadCurves, tried: Tried) -> Result<f64> {
        let Some(group) = &self.groups.group else {
            return Ok(0.0);
        };
        let count = self.groups.knots.len();
        let squares: Vec<f64> = match count {
            2 => {
                let predicted = self.predicted(curves, tried, group, None)?;
                (0..count)
                    .map(|g| self.judged(group, g, &predicted))
                    .collect()
            }
            _ => (1..count - 1)
                .map(|g| Ok(self.judged(group, g, &self.predicted(curves, tried, group, Some(g))?)))
                .collect::<Result<_>>()?,
        };
        Ok(100.0 * (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
    }

    /// The outputs of a fit, to all loads or to all but one.
    fn predicted(
        &self,
        curves: &LoadCurves,
        tried: Tried,
        group: &[usize],
        left: Option<usize>,
    ) -> Result<Vec<f64>> {
        let mut loads = curves.loads.clone();
        if let Some(g) = left {
            loads.remove(g);
        }
        let (others, degree, load_curves) = match tried {
            Tried::Gain { power, .. } => {
                let others = curves.resampled(&loads, power);
                // What lies between them follows from the neighbours.
                let others = others.resampled(&curves.loads, power);
                (others.clone(), 0, Some(others))
            }
            Tried::Weights { degree, .. } => {
                (moving_only(&curves.resampled(&loads, 1.0)), degree, None)
            }
        };
        let seen = behind(&others, self.recordings);
        let options = FitOptions {
            load_degree: Some(degree),
            load_curves: load_curves.clone(),
            ..self.options.clone()
        };
        let mut problem = Problem::new(&seen, &options)?;
        let kept: Vec<f64> = group
            .iter()
            .map(|at| f64::from(Some(*at) != left))
            .collect();
        let fitted = problem.solve(Some(&kept), Progress::NONE)?;
        let sums = problem.predict(&fitted.solution)?;
        let offset = |n: usize| match &load_curves {
            Some(curves) => Ok::<_, Error>(curves.at(self.samples.load[n])?.offset),
            None => Ok(0.0),
        };
        let sums = sums.into_iter().enumerate();
        sums.map(|(n, sum)| Ok(offset(n)? + fitted.sign.factor() * sum))
            .collect()
    }

    /// The mean square error at one load, in squares of the range of its output.
    fn judged(&self, group: &[usize], g: usize, predicted: &[f64]) -> f64 {
        let output = &self.samples.output;
        let own: Vec<usize> = (0..group.len()).filter(|n| group[*n] == g).collect();
        let sum: f64 = own
            .iter()
            .map(|n| (output[*n] - predicted[*n]).powi(2))
            .sum();
        let (low, high) = range(&own.iter().map(|n| output[*n]).collect::<Vec<_>>());
        sum / own.len().max(1) as f64 / (high - low).max(f64::MIN_POSITIVE).powi(2)
    }
}

/// The nearest monotone values: neighbours in the wrong order take their mean (pool adjacent
/// violators, Barlow et al. 1972).
fn make_monotone(values: &mut [f64], falls: bool) {
    let sign = if falls { -1.0 } else { 1.0 };
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for value in values.iter() {
        let mut pool = (sign * value, 1);
        while let Some(&(mean, count)) = pools.last().filter(|(mean, _)| *mean > pool.0) {
            let total = count + pool.1;
            pool = (
                (mean * count as f64 + pool.0 * pool.1 as f64) / total as f64,
                total,
            );
            pools.pop();
        }
        pools.push(pool);
    }
    let all = pools
        .into_iter()
        .flat_map(|(mean, count)| vec![sign * mean; count]);
    values
        .iter_mut()
        .zip(all)
        .for_each(|(value, pooled)| *value = pooled);
}

/// Of each run of `stride` samples the first one and those with extreme inputs, so that the turning
/// points stay.
fn extremes(input: &[f64], stride: usize) -> Vec<usize> {
    let mut kept: Vec<usize> = (0..input.len())
        .step_by(stride)
        .flat_map(|start| {
            let block = start..(start + stride).min(input.len());
            let by = |a: &usize, b: &usize| input[*a].total_cmp(&input[*b]);
            [block.clone().min_by(by), block.max_by(by), Some(start)]
        })
        .flatten()
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept
}
