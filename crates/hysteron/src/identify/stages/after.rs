//! Identifies creep and lag after the operators, where they predict parts of the recordings that
//! were left out.

use crate::error::{Error, Result};
use crate::identify::options::{Choice, FitOptions};
use crate::identify::weights::problem::Problem;
use crate::model::{CreepTerm, Model, Operators, Smooth, StageConstants};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use crate::series::range;
use hysteron_core::MAX_CREEP;
use serde::Serialize;

type After = StageConstants<f64>;

/// Each recording is divided into this many blocks of time; those with an odd number are left out
/// first, then the others.
const BLOCKS: usize = 6;

/// Creep and lag have to reduce the error on blocks left out by this share. Blocks of one recording
/// are less different than recordings are: on a valve, creep that gained 7 % on blocks left out lost
/// 13 % on a recording at another frequency.
const WORTH: f64 = 0.1;

/// Coefficients of creep that are tried, for all terms together, and lags in sampling steps.
const COEFFICIENTS: [f64; 8] = [0.005, 0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2];
const LAGS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// Time constants that are tried for a single term.
const SINGLE: usize = 5;

/// Rounds in which coefficients and time constants are refined, each with a smaller step.
const REFINED: i32 = 4;

/// Smoothness of the weights in the search, so that operators that a block left out do not run away.
const SMOOTH: Smooth = Smooth {
    along: 0.0,
    across: 1e-6,
};

/// Terms that are tried by `auto`.
const TERMS: [usize; 2] = [1, 3];

/// What was tried, for the model file.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Report {
    /// Error on blocks left out without creep and lag, in percent of the range.
    without: f64,
    /// The same with the creep and the lag taken.
    with: f64,
}

pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<(After, Report)> {
    if let Choice::Fixed(count) = options.creep
        && count > MAX_CREEP
    {
        return Err(Error::Fit(format!(
            "{count} creep terms: take {MAX_CREEP} at most"
        )));
    }
    if let Choice::Fixed(lag) = options.lag
        && !(lag >= 0.0 && lag.is_finite())
    {
        return Err(Error::Fit(format!(
            "a lag of {lag} s: it must be a finite number from 0 on"
        )));
    }
    let search = Search::new(recordings, options, progress)?;
    let without = search.rated(&After::default())?;
    let lags: Vec<f64> = match options.lag {
        Choice::Fixed(lag) => vec![lag],
        Choice::Auto => [0.0]
            .into_iter()
            .chain(LAGS.map(|steps| steps * search.step))
            .collect(),
    };
    let counts = match options.creep {
        Choice::Fixed(count) => vec![count],
        Choice::Auto => [0].into_iter().chain(TERMS).collect(),
    };
    // The simpler first. What was asked for is taken with its best constants.
    let mut best: Option<(After, f64)> = None;
    for &count in &counts {
        // A lag that is chosen before creep would stand for it, so the best of each is compared.
        let mut of_count: Option<(After, f64)> = None;
        for &lag in &lags {
            let found = search.creep(count, lag)?;
            let bar = if lag > 0.0 { 1.0 - WORTH } else { 1.0 };
            if of_count
                .as_ref()
                .is_none_or(|(_, least)| found.1 < bar * least)
            {
                of_count = Some(found);
            }
        }
        if let Some(found) = of_count
            && best
                .as_ref()
                .is_none_or(|(_, least)| found.1 < (1.0 - WORTH) * least)
        {
            best = Some(found);
        }
    }
    let (after, with) = best.unwrap_or((After::default(), without));
    Ok((after, Report { without, with }))
}

/// The recordings with the output as it was before creep and lag.
pub(super) fn before(after: &After, recordings: &[Recording]) -> Result<Vec<Recording>> {
    let around = around(after, recordings)?;
    let undone = |recording: &Recording| {
        Ok(Recording {
            output: around.before_stages(recording)?,
            ..recording.clone()
        })
    };
    recordings.iter().map(undone).collect()
}

/// A model of any operators with creep and lag.
fn around(after: &After, recordings: &[Recording]) -> Result<Model> {
    let plane = crate::identify::plane_of(&recordings[0], 2)?;
    let operator = hysteron_core::Operator::Mkp;
    let operators = Operators::new(operator, plane, vec![0.0; 3], 0.0, Default::default())?;
    Model::from(operators).with_after(&after.terms(), after.lag())
}

/// A recording without time, for options that ask for creep or a lag.
fn no_time() -> Error {
    let what = "creep, lag and ring depend on time, and the recording has none";
    let remedy = Remedy::new("name its column ({})", [Setting::any("time")]);
    Error::Fit(what.into()).remedied(remedy)
}

/// Refuses recordings without time before anything is computed.
pub(crate) fn check_time(recordings: &[Recording]) -> Result<()> {
    match recordings.iter().all(|recording| recording.time.is_some()) {
        true => Ok(()),
        false => Err(no_time()),
    }
}

struct Search<'a> {
    recordings: &'a [Recording],
    options: FitOptions,
    progress: Progress<'a>,
    /// Sampling step, and the time that the longest recording takes.
    step: f64,
    longest: f64,
}

impl<'a> Search<'a> {
    fn new(
        recordings: &'a [Recording],
        options: &FitOptions,
        progress: Progress<'a>,
    ) -> Result<Self> {
        let (mut step, mut longest) = (f64::INFINITY, 0.0_f64);
        for recording in recordings {
            let (start, end) = range(recording.time.as_ref().ok_or_else(no_time)?);
            step = step.min((end - start) / recording.len().max(2).saturating_sub(1) as f64);
            longest = longest.max(end - start);
        }
        if step <= 0.0 {
            let what = "time does not pass in a recording, so creep and lag cannot be identified";
            return Err(Error::Thermal(what.into()));
        }
        let options = FitOptions {
            bootstrap: 0,
            smooth: options.smooth.at_least(SMOOTH),
            ..options.clone()
        };
        Ok(Self {
            recordings,
            options,
            progress,
            step,
            longest,
        })
    }

    /// The best creep of `count` terms with this lag, and its error on blocks left out.
    fn creep(&self, count: usize, lag: f64) -> Result<(After, f64)> {
        let rate = |terms: &[CreepTerm]| {
            let after = After::after(terms, lag)?;
            let error = self.rated(&after)?;
            Ok::<_, Error>((after, error))
        };
        if count == 0 {
            return rate(&[]);
        }
        let mut best = rate(&self.terms(count, COEFFICIENTS[0]))?;
        for coefficient in COEFFICIENTS {
            let mut consider = |terms: &[CreepTerm]| {
                let next = rate(terms)?;
                if next.1 < best.1 {
                    best = next;
                }
                Ok::<_, Error>(())
            };
            match count {
                // The time constant of a single term is searched too.
                1 => {
                    for term in self.terms(SINGLE, coefficient * SINGLE as f64) {
                        consider(&[term])?;
                    }
                }
                _ => consider(&self.terms(count, coefficient))?,
            }
        }
        for round in 1..=REFINED {
            let step = 2_f64.powf(1.0 / f64::from(round));
            for factor in [step, 1.0 / step] {
                let scaled = |coefficient: f64, tau: f64| {
                    let scale = |term: CreepTerm| CreepTerm {
                        coefficient: term.coefficient * coefficient,
                        tau: term.tau * tau,
                    };
                    best.0.terms().into_iter().map(scale).collect::<Vec<_>>()
                };
                for terms in [scaled(factor, 1.0), scaled(1.0, factor)] {
                    let next = rate(&terms)?;
                    if next.1 < best.1 {
                        best = next;
                    }
                }
            }
        }
        Ok(best)
    }

    /// Terms with time constants spread evenly over the logarithm, from a thirtieth to a third of the
    /// longest recording. Faster ones would not be creep, but stand for other dynamics.
    fn terms(&self, count: usize, coefficient: f64) -> Vec<CreepTerm> {
        let (from, to) = ((self.longest / 30.0).ln(), (self.longest / 3.0).ln());
        let tau = |k: usize| (from + (to - from) * (k as f64 + 0.5) / count as f64).exp();
        let term = |k| CreepTerm {
            coefficient: coefficient / count as f64,
            tau: tau(k),
        };
        (0..count).map(term).collect()
    }

    /// The error on blocks of time left out, in percent of the range.
    fn rated(&self, after: &After) -> Result<f64> {
        self.progress.tell("creep and lag", f64::NAN)?;
        let seen = before(after, self.recordings)?;
        let mut problem = Problem::new(&seen, &self.options)?;
        let blocks: Vec<usize> = seen
            .iter()
            .flat_map(|recording| (0..recording.len()).map(|n| n * BLOCKS / recording.len()))
            .collect();
        let measured: Vec<f64> = self
            .recordings
            .iter()
            .flat_map(|recording| recording.output.clone())
            .collect();
        let mut squares = 0.0;
        for parity in 0..2 {
            let kept: Vec<f64> = blocks.iter().map(|b| f64::from(b % 2 != parity)).collect();
            let fitted = problem.solve(Some(&kept), Progress::NONE)?;
            let predicted = problem.predict(&fitted.solution)?;
            let sign = fitted.sign.factor();
            let offset = self.options.offset.unwrap_or(0.0);
            let sums: Vec<f64> = predicted.iter().map(|h| offset + sign * h).collect();
            let outputs = self.forward(after, &sums)?;
            squares += outputs
                .iter()
                .zip(&measured)
                .zip(&blocks)
                .filter(|(_, block)| **block % 2 == parity)
                .map(|((h, y), _)| (h - y).powi(2))
                .sum::<f64>();
        }
        let (low, high) = range(&measured);
        Ok(100.0 * (squares / measured.len() as f64).sqrt() / (high - low))
    }

    /// Outputs after creep and lag, from those of the operators.
    fn forward(&self, after: &After, sums: &[f64]) -> Result<Vec<f64>> {
        let model = around(after, self.recordings)?;
        let stages = model.stages();
        let mut output = Vec::with_capacity(sums.len());
        let mut from = 0;
        for recording in self.recordings {
            let time = recording.time.as_ref().ok_or_else(no_time)?;
            let mut past = None;
            for n in 0..recording.len() {
                let dt = time[n] - time[n.saturating_sub(1)];
                let (y, next) = stages.after(past, dt, sums[from + n]);
                past = Some(next);
                output.push(y);
            }
            from += recording.len();
        }
        Ok(output)
    }
}
