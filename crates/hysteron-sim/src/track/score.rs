//! How well a run tracked its reference, by stretches of time.

use super::{Event, Scenario};
use hysteron::Direction;
use hysteron::control::{Snapshot, Trace};
use hysteron::{Model, Result, Turning};
use serde::Serialize;

/// A stretch of time that errors are taken over.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// What to call it.
    pub name: String,
    /// From when, s.
    pub from_s: f64,
    /// Until when, s.
    pub to_s: f64,
    /// Whether the start, or the disturbance before, is over.
    pub settled: bool,
}

/// What a controller did in a window.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Score {
    /// RMS of output less reference.
    pub rmse: f64,
    /// Largest absolute value of output less reference.
    pub max_abs: f64,
    /// RMS of what the model expected, before it learned, less the output; NaN without a model.
    pub prediction_rmse: f64,
    /// The same with the weights as they were when the window began, and never learned since; NaN
    /// without a model, and where a model with stages learns.
    pub frozen_rmse: f64,
    /// Median lag of the output after reversals of the reference, s ([`reversal_lags`]); NaN
    /// without a reversal.
    pub lag_s: f64,
    /// Mean change of the drive from sample to sample, as a share of its range.
    pub drive_travel: f64,
    /// Share of samples with the drive at a limit.
    pub saturated: f64,
    /// Share of samples without a reading to be believed.
    pub faults: f64,
}

/// Share of the reference's range by which something has to go back to count as turned.
const TURNED: f64 = 0.05;

/// Share of the range within which it still rests.
const RESTS: f64 = 0.002;

/// The windows of a scenario: before the first disturbance, and between them, each with and without
/// the time to settle; without disturbances the halves of the run. A window that a scenario names is
/// taken whole.
#[must_use]
pub fn windows(scenario: &Scenario) -> Vec<Window> {
    let window = |name: &str, from_s: f64, to_s: f64, settled: bool| Window {
        name: name.into(),
        from_s,
        to_s,
        settled,
    };
    let (settle, end) = (scenario.settle_s, scenario.duration_s);
    let unknown =
        (!scenario.before.is_empty()).then(|| window("unknown start", 0.0, settle, false));
    let Some(first) = scenario.disturbance.first() else {
        let middle = 0.5 * (settle + end);
        let halves = [
            window("first half", settle, middle, true),
            window("second half", middle, end, true),
        ];
        return unknown.into_iter().chain(halves).collect();
    };
    let mut windows: Vec<Window> = unknown.into_iter().collect();
    windows.push(window("before", settle, first.at_s, true));
    // What happens at the same time is one event.
    let events: Vec<&[Event]> = scenario
        .disturbance
        .chunk_by(|a, b| a.at_s == b.at_s)
        .collect();
    for (n, together) in events.iter().enumerate() {
        let next = events.get(n + 1).map_or(end, |later| later[0].at_s);
        let event = &together[0];
        let words: Vec<String> = together.iter().map(Event::words).collect();
        let words = words.join(", ");
        if event.window.is_some() {
            windows.push(window(&words, event.at_s, next, true));
            continue;
        }
        windows.push(window(&format!("after {words}"), event.at_s, next, false));
        let settled = event.at_s + settle;
        if settled < next && settle > 0.0 {
            windows.push(window(
                &format!("after {words}, settled"),
                settled,
                next,
                true,
            ));
        }
    }
    let two_samples = 2.0 * scenario.interval_s;
    windows.retain(|window| window.to_s - window.from_s >= two_samples);
    windows
}

impl Score {
    /// The score of a run, with a model of the same plane, in a window.
    pub(super) fn new(
        trace: &Trace,
        window: &Window,
        drives: (f64, f64),
        model: &Model,
    ) -> Result<Self> {
        let inside: Vec<usize> = (0..trace.time.len())
            .filter(|n| (window.from_s..window.to_s).contains(&trace.time[*n]))
            .collect();
        let share = |count: usize| count as f64 / inside.len() as f64;
        let error = |n: &usize| trace.output[*n] - trace.reference[*n];
        let rms = |errors: Vec<f64>| {
            let sum: f64 = errors.iter().map(|e| e * e).sum();
            (sum / errors.len() as f64).sqrt()
        };
        let expected = |n: &usize| trace.prediction[*n] - trace.output[*n];
        let travel = inside
            .windows(2)
            .map(|pair| (trace.drive[pair[1]] - trace.drive[pair[0]]).abs());
        let status = |is: fn(&hysteron::control::LoopStatus) -> bool| {
            share(inside.iter().filter(|n| is(&trace.status[**n])).count())
        };
        let prediction_rmse = rms(inside
            .iter()
            .map(expected)
            .filter(|e| e.is_finite())
            .collect());
        let frozen_rmse = match trace.snapshots.iter().rfind(|s| s.time <= window.from_s) {
            // The weights alone are not the model.
            Some(_) if !model.is_plain() => f64::NAN,
            Some(snapshot) => {
                let output = free_run(trace, snapshot, model)?;
                rms(inside
                    .iter()
                    .map(|n| output[*n] - trace.output[*n])
                    .collect())
            }
            None => prediction_rmse,
        };
        let lags = reversal_lags(trace, window.from_s, window.to_s);
        let mut lags: Vec<f64> = lags.iter().map(|lag| lag.lag).collect();
        Ok(Self {
            rmse: rms(inside.iter().map(error).collect()),
            max_abs: inside.iter().map(error).fold(0.0, |a, e| a.max(e.abs())),
            prediction_rmse,
            frozen_rmse,
            lag_s: median(&mut lags),
            drive_travel: travel.sum::<f64>() / inside.len() as f64 / (drives.1 - drives.0),
            saturated: status(|s| s.saturated),
            faults: status(|s| s.sensor_fault),
        })
    }
}

/// What a model with the weights of `snapshot` makes of the whole run's input.
fn free_run(trace: &Trace, snapshot: &Snapshot, model: &Model) -> Result<Vec<f64>> {
    let (operator, plane) = (model.operator(), *model.plane());
    let weights = snapshot.weights.clone();
    let frozen = Model::new(operator, plane, weights, snapshot.offset, model.sign())?;
    frozen.simulate(&trace.input)
}

/// How far the output runs behind the reference after a reversal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReversalLag {
    /// When the reference turned, s.
    pub time: f64,
    /// Until when the branch after it lasts, s.
    pub until: f64,
    /// The lag, s; below zero where the output runs ahead.
    pub lag: f64,
}

/// The lag after each reversal of the reference from `from_s` to `to_s`: from when the reference
/// has gone back by a twentieth of its range until the output has, each from its own extreme since
/// the reference left its rest. So a constant error is no lag, nor is what the output did while the
/// reference rested.
#[must_use]
pub fn reversal_lags(trace: &Trace, from_s: f64, to_s: f64) -> Vec<ReversalLag> {
    let (low, high) = hysteron::range(&trace.reference);
    let (band, rest) = (TURNED * (high - low), RESTS * (high - low));
    let mut turning = Turning::new(band);
    let inside: Vec<usize> = (0..trace.time.len())
        .filter(|n| (from_s..to_s).contains(&trace.time[*n]))
        .collect();
    let turns = inside.iter().filter_map(|&n| {
        let (at, heading) = turning.push(trace.reference[n])?;
        Some((inside[at], n, heading))
    });
    // The first is where the window begins.
    let turns: Vec<(usize, usize, Direction)> = turns.skip(1).collect();
    let last = inside.last().copied().unwrap_or(0);
    let mut lags = Vec::new();
    for (k, &(extreme, turned, heading)) in turns.iter().enumerate() {
        let next = turns.get(k + 1).map_or(last, |(at, ..)| *at);
        let up = |value: f64| match heading {
            Direction::Rising => value,
            Direction::Falling => -value,
        };
        let there = up(trace.reference[extreme]) + rest;
        let rested = (extreme..turned).rfind(|&n| up(trace.reference[n]) <= there);
        let mut furthest = f64::INFINITY;
        let answered = (rested.unwrap_or(extreme)..=next).find(|&n| {
            let output = up(trace.output[n]);
            furthest = furthest.min(output);
            output - furthest > band
        });
        lags.push(ReversalLag {
            time: trace.time[rested.unwrap_or(extreme)],
            until: trace.time[next],
            // No response: the lag lasts until the next reversal.
            lag: trace.time[answered.unwrap_or(next)] - trace.time[turned],
        });
    }
    lags
}

/// The median; NaN of nothing.
pub(super) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => f64::NAN,
        _ if n % 2 == 1 => values[n / 2],
        _ => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use hysteron::Operator;
    use hysteron::control::LoopStatus;
    use hysteron::{Plane, Sign};

    fn score(trace: &Trace, from_s: f64, to_s: f64) -> Score {
        let plane = Plane::new(0.0, 1.0, 2).unwrap();
        let model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive).unwrap();
        let window = Window {
            name: String::new(),
            from_s,
            to_s,
            settled: true,
        };
        Score::new(trace, &window, (0.0, 2.0), &model).unwrap()
    }

    fn trace(reference: Vec<f64>, output: Vec<f64>) -> Trace {
        let count = reference.len();
        Trace {
            time: (0..count).map(|n| 0.5 * n as f64).collect(),
            measured: output.clone(),
            input: vec![0.0; count],
            command: vec![0.0; count],
            drive: (0..count).map(|n| (n % 2) as f64).collect(),
            prediction: vec![f64::NAN; count],
            status: vec![LoopStatus::default(); count],
            snapshots: Vec::new(),
            reference,
            output,
        }
    }

    #[test]
    fn errors_by_hand() {
        let mut trace = trace(vec![0.0; 8], vec![9.0, 9.0, 3.0, -4.0, 0.0, 0.0, 9.0, 9.0]);
        trace.prediction[2] = 4.0;
        trace.prediction[3] = -5.0;
        trace.status[4].saturated = true;
        trace.status[5].sensor_fault = true;
        trace.status[7].sensor_fault = true;
        // Samples 2 to 5.
        let score = score(&trace, 1.0, 3.0);
        assert_eq!(score.rmse, 2.5);
        assert_eq!(score.max_abs, 4.0);
        assert_eq!(score.prediction_rmse, 1.0);
        assert_eq!(score.frozen_rmse, 1.0);
        assert_eq!(score.saturated, 0.25);
        assert_eq!(score.faults, 0.25);
        // Three changes of half the range over four samples.
        assert_eq!(score.drive_travel, 3.0 / 8.0);
        assert!(score.lag_s.is_nan());
    }

    #[test]
    fn the_lag_by_hand() {
        // A triangle of 40 samples a leg, and an output that is 6 samples late.
        let wave = |n: i32| f64::from(40 - (n.rem_euclid(80) - 40).abs());
        let reference = (0..400).map(wave).collect();
        let late = (0..400).map(|n| wave((n - 6).max(0))).collect();
        let score = score(&trace(reference, late), 0.0, 200.0);
        assert_eq!(score.lag_s, 3.0);
    }

    #[test]
    fn the_median_by_hand() {
        assert!(median(&mut []).is_nan());
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
    }
}
