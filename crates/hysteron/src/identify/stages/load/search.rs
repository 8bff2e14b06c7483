//! Searches the shift of each load, and finds stroke and offset at it.

use crate::error::Result;
use crate::identify::changed::thin;
use crate::identify::fixed::fit_weights;
use crate::identify::options::FitOptions;
use crate::identify::stages::load::curves::positions;
use crate::identify::stages::load::groups::{Groups, Samples};
use crate::identify::stages::load::monotone::make_monotone;
use crate::identify::weights::problem::Problem;
use crate::model::{LoadCurves, Registration};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;

/// Samples of the search.
const SAMPLES: usize = 3000;

/// First step of the search, as a share of the input's range, and the number of its halvings.
const FIRST: f64 = 0.04;
const HALVINGS: usize = 6;

pub(super) struct Search<'a> {
    pub(super) recordings: &'a [Recording],
    pub(super) samples: &'a Samples,
    pub(super) groups: &'a Groups,
    pub(super) options: FitOptions,
    pub(super) progress: Progress<'a>,
}

impl Search<'_> {
    /// The shift of each load against the lowest one; with `scaled`, the scale too. Then gain and
    /// offset of each load.
    pub(super) fn curves(&self, scaled: bool) -> Result<LoadCurves> {
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
        Ok(shift)
    }

    /// The recordings behind curves and registration. A load that does not tell its shift says
    /// nothing of operators that no other load moves: its inputs end where those of the others do.
    pub(super) fn seen(
        &self,
        curves: &LoadCurves,
        registration: &Registration,
        recordings: &[Recording],
    ) -> Result<Vec<Recording>> {
        let start = self.options.start;
        let with = |recording: &Recording| {
            Ok(Recording {
                input: positions(curves, registration, recording, start)?,
                ..recording.clone()
            })
        };
        let mut seen: Vec<Recording> = recordings.iter().map(with).collect::<Result<_>>()?;
        let count: usize = seen.iter().map(Recording::len).sum();
        let telling = |n: usize| match &self.groups.group {
            Some(group) if group.len() == count => self.groups.telling[group[n]],
            _ => true,
        };
        let inputs = seen.iter().flat_map(|recording| &recording.input);
        let own = inputs.enumerate().filter(|(n, _)| telling(*n));
        let (low, high) = range(&own.map(|(_, x)| *x).collect::<Vec<_>>());
        let inputs = seen.iter_mut().flat_map(|recording| &mut recording.input);
        inputs.for_each(|x| *x = x.clamp(low, high));
        Ok(seen)
    }

    /// Gain and offset of each load: the line from the outputs of one set of weights, which fits the
    /// loops scaled to their own height, to the outputs measured at that load. Gains count from that
    /// of the largest one. Returns the output of all operators at the gain 1, with its sign.
    pub(super) fn find_gains(
        &self,
        curves: &mut LoadCurves,
        registration: &Registration,
    ) -> Result<f64> {
        let Some(group) = &self.groups.group else {
            return Ok(0.0);
        };
        let spans = self.spans(group);
        let mut seen = self.seen(curves, registration, &self.scaled())?;
        seen.iter_mut().for_each(|recording| recording.load = None);
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
            // No load has a gain below zero. One with hardly any stroke does not show the shape: its
            // gain is its height.
            let (low, high) = spans[g];
            gains[g] = match self.groups.telling[g] {
                true => (product / square.max(f64::MIN_POSITIVE)).max(0.05 * (high - low)),
                false => high - low,
            };
            offsets[g] = y - gains[g] * h;
        }
        let most = gains.iter().fold(f64::MIN_POSITIVE, |a, b| a.max(*b));
        gains
            .iter_mut()
            .for_each(|gain| *gain = (*gain / most).max(1e-6));
        (curves.gains, curves.offsets) = (gains, offsets);
        let larger = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
        Ok(most * (0..group.len()).map(sum).fold(0.0, larger))
    }

    /// Smallest and largest output of each group.
    pub(super) fn spans(&self, group: &[usize]) -> Vec<(f64, f64)> {
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
    pub(super) fn fill_in(&self, shift: &mut LoadCurves) {
        let telling: Vec<usize> = (0..shift.loads.len())
            .filter(|n| self.groups.telling[*n])
            .collect();
        let (Some(&first), Some(&last)) = (telling.first(), telling.last()) else {
            return;
        };
        let falls = shift.shifts[last] < shift.shifts[first];
        let mut values: Vec<f64> = telling.iter().map(|n| shift.shifts[*n]).collect();
        make_monotone(&mut values, falls);
        let loads: Vec<f64> = telling.iter().map(|n| shift.loads[*n]).collect();
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
    pub(super) fn half_heights(&self) -> Vec<f64> {
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

    /// The recordings without most of their samples, each load's loop scaled to its own height.
    pub(super) fn normalised(&self) -> Vec<Recording> {
        let stride = self.samples.input.len().div_ceil(SAMPLES);
        let scaled = self.scaled().into_iter();
        scaled.map(|recording| thin(&recording, stride)).collect()
    }

    /// The recordings with each load's loop scaled to its own height. Where the load changes all the
    /// time they stay as they are.
    fn scaled(&self) -> Vec<Recording> {
        let mut scaled = self.recordings.to_vec();
        let Some(group) = &self.groups.group else {
            return scaled;
        };
        let spans = self.spans(group);
        let outputs = scaled
            .iter_mut()
            .flat_map(|recording| &mut recording.output);
        for (y, g) in outputs.zip(group) {
            let (low, high) = spans[*g];
            *y = (*y - low) / (high - low).max(f64::MIN_POSITIVE);
        }
        scaled
    }

    /// Error of one set of weights behind this shift. Where the load changes all the time, the
    /// weights follow it in the first order.
    pub(super) fn rated(&self, recordings: &[Recording], shift: &LoadCurves) -> Result<f64> {
        let mut seen = self.seen(shift, &Registration::default(), recordings)?;
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
}
