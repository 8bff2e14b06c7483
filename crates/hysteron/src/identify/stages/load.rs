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
use crate::model::LoadShift;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;
use serde::Serialize;

/// Loads closer than this share of their range are one load.
const SAME: f64 = 0.03;

/// With more loads than this the load changes all the time, and the shift has `EVEN_KNOTS` knots.
const MOST: usize = 8;
const EVEN_KNOTS: usize = 3;

/// Levels of the search. Shifts do not need more.
const LEVELS: usize = 14;

/// Samples of the search.
const SAMPLES: usize = 3000;

/// First step of the search, as a share of the input's range, and the number of its halvings.
const FIRST: f64 = 0.04;
const HALVINGS: usize = 6;

/// A more complex law has to predict loads left out better by this factor.
const WORTH: f64 = 0.9;

/// The law of the load, and what chose it.
pub(super) struct Law {
    pub(super) shift: LoadShift,
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
    /// For each law tried: order of the weights, whether the axis is scaled, and the error on loads
    /// left out, in percent of the range.
    tried: Vec<(usize, bool, f64)>,
}

pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<Law> {
    let samples = Samples::new(recordings)?;
    let groups = Groups::new(&samples.load);
    let search = Search {
        recordings,
        samples: &samples,
        groups: &groups,
        options: FitOptions {
            levels: options.levels.min(LEVELS),
            bootstrap: 0,
            load_degree: Some(0),
            range: None,
            offset: None,
            ..options.clone()
        },
        progress,
    };
    let plain = search.shifts(false)?;
    let mut tried = Vec::new();
    let inner = groups.knots.len().saturating_sub(2);
    let highest = groups.knots.len().saturating_sub(2).min(2);
    let degrees = match options.load_degree {
        Some(degree) => degree..=degree,
        None if inner == 0 => 1..=1,
        None => 0..=highest,
    };
    let mut best: Option<(LoadShift, usize, f64)> = None;
    let scaled = if inner > 0 {
        vec![false, true]
    } else {
        vec![false]
    };
    for scale in scaled {
        let shift = match scale {
            false => plain.clone(),
            true => search.shifts(true)?,
        };
        for degree in degrees.clone() {
            progress.tell("loads left out", f64::NAN)?;
            let error = match inner {
                0 => 0.0,
                _ => search.left_out(&shift, degree)?,
            };
            tried.push((degree, scale, error));
            if best
                .as_ref()
                .is_none_or(|(.., least)| error < WORTH * least)
            {
                best = Some((shift.clone(), degree, error));
            }
        }
    }
    let (shift, degree, _) = best.unwrap_or((plain, 1, 0.0));
    let report = Report {
        loads: groups.knots.clone(),
        slope: shift.slope(),
        tried,
    };
    Ok(Law {
        shift,
        degree,
        report,
    })
}

/// The recordings with the load's shift taken off their inputs.
pub(super) fn behind(shift: &LoadShift, recordings: &[Recording]) -> Vec<Recording> {
    // Without spacing, the plane has no part in it.
    with_inputs(recordings, |recording| {
        let load = recording.load.iter().flatten();
        let pairs = recording.input.iter().zip(load);
        pairs
            .map(|(t, load)| {
                let (scale, shift) = shift.at(*load);
                scale * t - shift
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
}

impl Groups {
    fn new(load: &[f64]) -> Self {
        let (low, high) = range(load);
        let mut sorted = load.to_vec();
        sorted.sort_by(f64::total_cmp);
        let mut starts = vec![0];
        for n in 1..sorted.len() {
            if sorted[n] - sorted[n - 1] > SAME * (high - low) {
                starts.push(n);
            }
        }
        let ends = starts.iter().skip(1).copied().chain([sorted.len()]);
        let spans: Vec<(usize, usize)> = starts.iter().copied().zip(ends).collect();
        let wide = |(from, to): &(usize, usize)| {
            sorted[to - 1] - sorted[*from] > 4.0 * SAME * (high - low)
        };
        if spans.len() < 2 || spans.len() > MOST || spans.iter().any(wide) {
            let knot = |n: usize| low + (high - low) * n as f64 / (EVEN_KNOTS - 1) as f64;
            return Self {
                knots: (0..EVEN_KNOTS).map(knot).collect(),
                group: None,
            };
        }
        let knots: Vec<f64> = spans
            .iter()
            .map(|(from, to)| sorted[(from + to) / 2])
            .collect();
        let nearest = |load: &f64| {
            let by = |a: &usize, b: &usize| {
                (knots[*a] - load)
                    .abs()
                    .total_cmp(&(knots[*b] - load).abs())
            };
            (0..knots.len()).min_by(by).unwrap_or(0)
        };
        let group = load.iter().map(nearest).collect();
        Self {
            knots,
            group: Some(group),
        }
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
    /// The shift of each load against the lowest one; with `scaled`, the scale too.
    fn shifts(&self, scaled: bool) -> Result<LoadShift> {
        let loads = self.groups.knots.clone();
        let (low, high) = range(&self.samples.input);
        let mut shift = LoadShift {
            shifts: self.half_heights(),
            scales: if scaled {
                vec![1.0; loads.len()]
            } else {
                Vec::new()
            },
            loads,
        };
        let normalised = self.normalised();
        let rated = |shift: &LoadShift| self.rated(&normalised, shift);
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
                for n in 1..shift.loads.len() {
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
        Ok(shift)
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
        let spans: Option<Vec<(f64, f64)>> = self.groups.group.as_ref().map(|group| {
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
        });
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
    fn rated(&self, recordings: &[Recording], shift: &LoadShift) -> Result<f64> {
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
    /// of its output; the root of the mean square.
    fn left_out(&self, shift: &LoadShift, degree: usize) -> Result<f64> {
        let Some(group) = &self.groups.group else {
            return Ok(0.0);
        };
        let last = self.groups.knots.len() - 1;
        let mut squares = 0.0;
        for g in 1..last {
            let mut others = shift.clone();
            others.loads.remove(g);
            others.shifts.remove(g);
            if !others.scales.is_empty() {
                others.scales.remove(g);
            }
            let seen = behind(&others, self.recordings);
            let options = FitOptions {
                load_degree: Some(degree),
                ..self.options.clone()
            };
            let mut problem = Problem::new(&seen, &options)?;
            let kept: Vec<f64> = group.iter().map(|at| f64::from(*at != g)).collect();
            let fitted = problem.solve(Some(&kept), Progress::NONE)?;
            let predicted = problem.predict(&fitted.solution)?;
            let own = (0..group.len()).filter(|n| group[*n] == g);
            let output = &self.samples.output;
            let (mut sum, mut count, mut ends) = (0.0, 0.0, (f64::INFINITY, f64::NEG_INFINITY));
            for n in own {
                sum += (output[n] - fitted.sign.factor() * predicted[n]).powi(2);
                count += 1.0;
                ends = (ends.0.min(output[n]), ends.1.max(output[n]));
            }
            squares += sum / count / (ends.1 - ends.0).max(f64::MIN_POSITIVE).powi(2);
        }
        Ok(100.0 * (squares / (last - 1) as f64).sqrt())
    }
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
