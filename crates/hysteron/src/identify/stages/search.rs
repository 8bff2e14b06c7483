//! Searches constants of creep and lag: those with the least error on what is fitted, and their
//! error on blocks of time that are left out.

use super::blocks::{BLOCKS, SMOOTH, WORTH, blocks};
use super::undone::{After, forward, no_time, undone_outputs};
use crate::error::{Error, Result};
use crate::identify::choose::Open;
use crate::identify::options::{Choice, FitOptions};
use crate::identify::weights::again::Again;
use crate::identify::weights::problem::Problem;
use crate::identify::weights::solve::STEPS;
use crate::model::{CreepTerm, Smooth};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::coarse::noise_behind;
use crate::series::{fair_range, fair_range_of_all, range};

/// So much of the whole error has to go, whatever the noise is.
const LEAST: f64 = 0.02;

/// Coefficients of creep that are tried, for all terms together.
const COEFFICIENTS: [f64; 8] = [0.005, 0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2];

/// The shortest lag that is tried, in sampling steps. Each one after it is twice as long.
const SHORTEST: f64 = 0.5;

/// What is slower than this share of the longest recording is creep.
const SLOWEST: f64 = 1.0 / 30.0;

/// Time constants that are tried for a single term.
const SINGLE: usize = 5;

/// Levels on which the constants are found, if their number is left to the data, and the
/// smoothness: a coarse or smooth plane takes its own width for a lag.
const FINE: usize = 40;
const SLIGHT: Smooth = Smooth {
    along: 1e-9,
    across: 1e-9,
};

/// Proximal steps of a fit that is compared with others of its kind: one ends where its ridge of
/// 1e-11 no longer shows in an error.
const SEARCHED: usize = 1;

/// Rounds in which coefficients and time constants are refined, each with a smaller step.
const REFINED: i32 = 4;

/// Constants, and the errors with them. On a coarse plane a lag helps where there is none, so what
/// is taken has to help on a fine one as well.
pub(super) struct Candidate {
    pub(super) after: After,
    pub(super) left_out: f64,
    fitted: f64,
}

impl Candidate {
    /// Whether it is worth more constants than a simpler one has. No model follows the `noise`, so
    /// the share is of the error beyond it, and a small one of the whole.
    pub(super) fn is_worth(&self, simpler: &Self, noise: f64) -> bool {
        self.gains(WORTH, simpler, noise)
    }

    /// The same with another share than usual.
    pub(super) fn gains(&self, worth: f64, simpler: &Self, noise: f64) -> bool {
        let better = |error, other| is_better(error, other, worth, noise);
        better(self.left_out, simpler.left_out) && better(self.fitted, simpler.fitted)
    }
}

/// Whether an error is smaller than another one by a share of what is beyond the noise, and by a
/// small share of the whole.
pub(super) fn is_better(error: f64, other: f64, worth: f64, noise: f64) -> bool {
    let share = |less: f64| 1.0 - (1.0 - less) * (1.0 - less);
    let gained = other * other - error * error;
    let beyond = other * other - noise * noise;
    gained > share(worth) * beyond && gained > share(LEAST) * other * other
}

/// Options with the fine plane on which constants are judged.
pub(super) fn fine(options: &FitOptions, open: Open) -> FitOptions {
    FitOptions {
        levels: match open.levels {
            true => FINE.max(options.levels),
            false => options.levels,
        },
        smooth: match open.smooth {
            true => SLIGHT,
            false => options.smooth,
        },
        bootstrap: 0,
        ..options.clone()
    }
}

/// The white noise of the outputs, in percent of their range, as far as it can be told.
pub(super) fn noise_percent(recordings: &[Recording]) -> f64 {
    let (low, high) = fair_range_of_all(recordings.iter().map(|recording| &recording.output));
    let told = recordings.iter().map(|r| noise_behind(&r.input, &r.output));
    let worst = told.fold(0.0, f64::max);
    100.0 * worst / (high - low)
}

pub(super) struct Search<'a> {
    recordings: &'a [Recording],
    measured: Vec<f64>,
    /// For what is left out.
    coarse: Again<'a>,
    /// For what is fitted.
    fine: Again<'a>,
    progress: Progress<'a>,
    /// Into how many blocks of time a recording is divided.
    pub(super) blocks: usize,
    /// Standard deviation of the white noise of the outputs, in percent of their range.
    pub(super) noise: f64,
    /// Sampling step, and the time that the longest recording takes.
    pub(super) step: f64,
    longest: f64,
}

/// Whether the recording has a time in which no two samples come at once.
pub(crate) fn time_passes(recording: &Recording) -> bool {
    let passes = |time: &Vec<f64>| time.windows(2).all(|pair| pair[1] > pair[0]);
    recording.time.as_ref().is_some_and(passes)
}

/// The mean sampling step; endless without a time.
pub(crate) fn step_of(recording: &Recording) -> f64 {
    let steps = recording.len().max(2).saturating_sub(1) as f64;
    let time = recording.time.as_ref().map(|time| range(time));
    time.map_or(f64::INFINITY, |(start, end)| (end - start) / steps)
}

impl<'a> Search<'a> {
    pub(super) fn new(
        recordings: &'a [Recording],
        options: &FitOptions,
        open: Open,
        progress: Progress<'a>,
    ) -> Result<Self> {
        let (mut step, mut longest) = (f64::INFINITY, 0.0_f64);
        for recording in recordings {
            let (start, end) = range(recording.time.as_ref().ok_or_else(no_time)?);
            step = step.min(step_of(recording));
            longest = longest.max(end - start);
        }
        if step <= 0.0 {
            let what = "time does not pass in a recording, so creep and lag cannot be identified";
            return Err(Error::Thermal(what.into()));
        }
        let coarse = FitOptions {
            bootstrap: 0,
            smooth: options.smooth.at_least(SMOOTH),
            ..options.clone()
        };
        let fits = |options| Ok::<_, Error>(Again::new(Problem::new(recordings, options)?));
        Ok(Self {
            recordings,
            measured: recordings.iter().flat_map(|r| r.output.clone()).collect(),
            coarse: fits(&coarse)?,
            fine: fits(&fine(options, open))?,
            progress,
            blocks: BLOCKS,
            noise: noise_percent(recordings),
            step,
            longest,
        })
    }

    /// Constants whose error on what is fitted is known.
    pub(super) fn judged(&mut self, (after, fitted): (After, f64)) -> Result<Candidate> {
        Ok(Candidate {
            left_out: self.left_out(&after)?,
            fitted,
            after,
        })
    }

    /// For each number of terms of creep the best constants, with no lag and with one if it is left
    /// to the data. A few numbers cannot follow noise, so they are those with the least error on
    /// what is fitted; whether they are taken is another question.
    pub(super) fn candidates(
        &mut self,
        counts: &[usize],
        lag: Choice<f64>,
    ) -> Result<Vec<(After, f64)>> {
        let lags = match lag {
            Choice::Fixed(lag) => vec![lag],
            Choice::Auto => {
                let alone = self.lag_alone()?;
                let alone = alone.map(|(after, _)| after.lag());
                [0.0].into_iter().chain(alone).collect()
            }
        };
        let mut found = Vec::new();
        for count in counts {
            for given in &lags {
                let mut best = match count {
                    0 => self.lagging(*given)?,
                    _ => self.creep(*count, *given)?,
                };
                if lag == Choice::Auto && *given > 0.0 {
                    self.refine_lag(&mut best)?;
                }
                found.push(best);
            }
        }
        Ok(found)
    }

    /// The lag that is best without creep; `None` in too short a recording.
    pub(super) fn lag_alone(&mut self) -> Result<Option<(After, f64)>> {
        let lags = std::iter::successors(Some(SHORTEST * self.step), |lag| Some(2.0 * lag));
        let longest = SLOWEST * self.longest;
        let mut best: Option<(After, f64)> = None;
        for lag in lags.take_while(|lag| *lag <= longest) {
            let next = self.lagging(lag)?;
            if best.as_ref().is_none_or(|best| next.1 < best.1) {
                best = Some(next);
            }
        }
        Ok(best)
    }

    /// A lag alone, and its error on what is fitted.
    pub(super) fn lagging(&mut self, lag: f64) -> Result<(After, f64)> {
        self.rated(After::after(&[], lag)?)
    }

    /// The best creep of `count` terms with this lag, and its error on what is fitted.
    pub(super) fn creep(&mut self, count: usize, lag: f64) -> Result<(After, f64)> {
        let tried = |coefficient: f64| match count {
            // The time constant of a single term is searched too.
            1 => {
                let terms = self.terms(SINGLE, coefficient * SINGLE as f64);
                terms.chunks(1).map(<[_]>::to_vec).collect()
            }
            _ => vec![self.terms(count, coefficient)],
        };
        let tried: Vec<_> = COEFFICIENTS.into_iter().flat_map(tried).collect();
        let mut best = self.rated(After::after(&tried[0], lag)?)?;
        for terms in &tried[1..] {
            let next = self.rated(After::after(terms, lag)?)?;
            if next.1 < best.1 {
                best = next;
            }
        }
        self.refine_creep(&mut best)?;
        Ok(best)
    }

    fn rated(&mut self, after: After) -> Result<(After, f64)> {
        let error = self.fitted(&after)?;
        Ok((after, error))
    }

    /// Scales the coefficients of creep, and its time constants, as far as that helps.
    fn refine_creep(&mut self, best: &mut (After, f64)) -> Result<()> {
        let scaled = |after: &After, coefficient: f64, tau: f64| {
            let scale = |term: CreepTerm| CreepTerm {
                coefficient: term.coefficient * coefficient,
                tau: term.tau * tau,
            };
            let terms: Vec<_> = after.terms().into_iter().map(scale).collect();
            After::after(&terms, after.lag())
        };
        self.refine(best, |after, factor| scaled(after, factor, 1.0))?;
        self.refine(best, |after, factor| scaled(after, 1.0, factor))
    }

    pub(super) fn refine_lag(&mut self, best: &mut (After, f64)) -> Result<()> {
        self.refine(best, |after, factor| {
            After::after(&after.terms(), factor * after.lag())
        })
    }

    /// Changes a stage by factors that come nearer to one, as long as the error on what is fitted
    /// falls.
    fn refine(
        &mut self,
        best: &mut (After, f64),
        changed: impl Fn(&After, f64) -> Result<After>,
    ) -> Result<()> {
        for round in 1..=REFINED {
            let step = 2_f64.powf(0.5_f64.powi(round));
            for factor in [step, 1.0 / step] {
                let after = changed(&best.0, factor)?;
                let error = self.fitted(&after)?;
                if error < best.1 {
                    *best = (after, error);
                }
            }
        }
        Ok(())
    }

    /// Terms with time constants spread evenly over the logarithm, from a thirtieth ([`SLOWEST`])
    /// to a third of the longest recording. Faster ones would not be creep, but stand for other
    /// dynamics.
    fn terms(&self, count: usize, coefficient: f64) -> Vec<CreepTerm> {
        let (from, to) = ((SLOWEST * self.longest).ln(), (self.longest / 3.0).ln());
        let tau = |k: usize| (from + (to - from) * (k as f64 + 0.5) / count as f64).exp();
        let term = |k| CreepTerm {
            coefficient: coefficient / count as f64,
            tau: tau(k),
        };
        (0..count).map(term).collect()
    }

    /// The error on blocks of time left out, in percent of the range.
    pub(super) fn left_out(&mut self, after: &After) -> Result<f64> {
        self.progress.tell("creep and lag", f64::NAN)?;
        // There is memory for one Gram matrix only.
        self.fine.forget();
        let seen = undone_outputs(after, self.recordings)?;
        let blocks: Vec<usize> = self
            .recordings
            .iter()
            .flat_map(|one| blocks(one, self.blocks).map(|block| block % 2))
            .collect();
        let mut squares = 0.0;
        for part in [0, 1] {
            let counts = |left: &usize| f64::from(*left != part);
            let kept: Vec<f64> = blocks.iter().map(counts).collect();
            let outputs = self.coarse.outputs(seen.clone(), Some(&kept), STEPS)?;
            let outputs = forward(after, self.recordings, &outputs)?;
            squares += self.squares(&outputs, |n| blocks[n] == part);
        }
        self.coarse.forget();
        Ok(self.percent(squares))
    }

    /// The error on what is fitted, in percent of the range.
    fn fitted(&mut self, after: &After) -> Result<f64> {
        self.progress.tell("creep and lag", f64::NAN)?;
        let seen = undone_outputs(after, self.recordings)?;
        let outputs = self.fine.outputs(seen, None, SEARCHED)?;
        let outputs = forward(after, self.recordings, &outputs)?;
        Ok(self.percent(self.squares(&outputs, |_| true)))
    }

    /// The squares of the errors at the samples that count.
    fn squares(&self, outputs: &[f64], counts: impl Fn(usize) -> bool) -> f64 {
        let errors = outputs.iter().zip(&self.measured).enumerate();
        let counted = errors.filter(|(n, _)| counts(*n));
        counted.map(|(_, (h, y))| (h - y).powi(2)).sum()
    }

    fn percent(&self, squares: f64) -> f64 {
        let (low, high) = fair_range(&self.measured);
        100.0 * (squares / self.measured.len() as f64).sqrt() / (high - low)
    }
}
