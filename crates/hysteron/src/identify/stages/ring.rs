//! Identifies a ring of the output, where the recordings excite one and it predicts parts of them
//! that were left out.
//!
//! For a given ring the weights are a linear problem, and for given weights the ring has two
//! numbers. Both are found in turn: the ring by a simplex search over the logarithms of frequency
//! and damping, the weights for the input of the ring that most likely gave the output.

use crate::error::{Error, Result};
use crate::identify::changed::few_in_time;
use crate::identify::choose::Open;
use crate::identify::options::{Dynamics, FitOptions};
use crate::identify::stages::blocks::{BLOCKS, SMOOTH, WORTH, blocks};
use crate::identify::stages::nelder_mead::minimise;
use crate::identify::stages::resonator::{Clock, Resonator};
use crate::identify::stages::search::{fine, is_better, noise_percent};
use crate::identify::stages::undone::with_outputs;
use crate::identify::weights::again::Again;
use crate::identify::weights::problem::Problem;
use crate::identify::weights::solve::STEPS;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::fair_range;
use serde::Serialize;

/// A ring that takes less than this share off the squares that the operators leave is not searched
/// for any further: the recording does not excite it.
const EXCITED: f64 = 0.1;

/// Frequencies tried in each decade, and dampings. A resonance is as wide as its damping, so the
/// widest one finds it, and the search then goes to it.
const DECADE: f64 = 30.0;
const DAMPINGS: [f64; 3] = [0.03, 0.12, 0.5];

/// The lowest frequency has so many cycles in the longest recording; the highest so many cycles a
/// sample, below the one half that samples can tell.
const CYCLES: f64 = 10.0;
const HIGHEST: f64 = 0.45;

/// With fewer samples a cycle, a swing is not told apart from an output that comes early: unasked,
/// it is not taken.
const CLEAR: f64 = 4.0;

/// From a damping of `1/√2` on there is no resonance. A lag says the same then.
const RESONANT: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A ring of more damping hardly rings: it is a lag of second order, which smooths whatever the
/// model does wrong. It has to take this share of the error, as a long lag has.
const DULL: f64 = 0.25;
const DULL_WORTH: f64 = 0.5;

/// A ring has to die down within this share of the longest recording. One that goes on is not told
/// apart from an input that does.
const DECAYS: f64 = 1.0 / 3.0;

/// Samples that are looked at when frequencies are tried.
const LOOKED_AT: usize = 50_000;

/// Turns between weights and ring.
const ROUNDS: usize = 5;

/// What was tried, for the model file.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Report {
    /// Error on blocks left out without a ring, in percent of the range.
    without: f64,
    /// The same with the ring taken.
    with: f64,
}

/// A ring: frequency in Hz and damping ratio, and the recordings as what is before it sees them.
pub(super) struct Swinging {
    pub(super) constants: [f64; 2],
    pub(super) recordings: Vec<Recording>,
    pub(super) report: Report,
}

/// Finds a ring; `None` where the recordings do not excite one. One that was asked for is taken in
/// any case.
///
/// # Errors
/// [`Error::Fit`] for a ring that was asked for where none can be searched for.
pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    open: Open,
    progress: Progress<'_>,
) -> Result<Option<Swinging>> {
    let asked = options.dynamics == Dynamics::Ring;
    // The steps of a clock that is coarser than the samples would be taken for a swing.
    let stands = |time: &[f64]| time.windows(2).any(|pair| pair[1] <= pair[0]);
    let coarse = |recording: &Recording| recording.time.as_deref().is_some_and(stands);
    if !asked && recordings.iter().any(coarse) {
        return Ok(None);
    }
    let fine = fine(options, open);
    let options = FitOptions {
        bootstrap: 0,
        smooth: options.smooth.at_least(SMOOTH),
        ..options.clone()
    };
    let looked_at = few_in_time(recordings);
    let Some((first, report)) = judged(&looked_at, &options, asked, progress)? else {
        return Ok(None);
    };
    // On a coarse plane a ring helps where there is none, so it has to help on a fine one as well.
    if !asked && !explains(&looked_at, &fine, first, progress)? {
        return Ok(None);
    }
    let Some(clock) = Clock::new(recordings) else {
        return Ok(None);
    };
    let mut search = Search::new(recordings, &options, &clock, progress)?;
    let still = search.still(None)?;
    let (constants, targets, _) = search.swung(first, None, &still)?;
    let [frequency, damping] = constants;
    let decay = 1.0 / (std::f64::consts::TAU * frequency * damping);
    let is_weak = damping > DULL && report.with > (1.0 - DULL_WORTH) * report.without;
    let is_unclear = damping >= RESONANT
        || is_weak
        || decay > DECAYS * clock.longest
        || CLEAR * clock.step * frequency > 1.0;
    if !asked && is_unclear {
        return Ok(None);
    }
    Ok(Some(Swinging {
        constants,
        recordings: with_outputs(recordings, &targets),
        report,
    }))
}

/// The ring to begin with, and what it predicts of blocks left out; `None` where that is not worth
/// it, or no time passes.
fn judged(
    recordings: &[Recording],
    options: &FitOptions,
    asked: bool,
    progress: Progress<'_>,
) -> Result<Option<([f64; 2], Report)>> {
    let Some(clock) = Clock::new(recordings) else {
        return Ok(None);
    };
    let mut search = Search::new(recordings, options, &clock, progress)?;
    let still = search.still(None)?;
    let Some(first) = search.first(&still, asked)? else {
        return Ok(None);
    };
    let all = recordings.iter();
    let blocks: Vec<usize> = all.flat_map(|one| blocks(one, BLOCKS)).collect();
    let mut squares = [0.0; 2];
    for parity in 0..2 {
        let kept: Vec<f64> = blocks.iter().map(|b| f64::from(b % 2 != parity)).collect();
        let still = search.still(Some(&kept))?;
        let (_, _, swung) = search.swung(first, Some(&kept), &still)?;
        for (squares, outputs) in squares.iter_mut().zip([still, swung]) {
            let errors = outputs.iter().zip(&search.measured).zip(&kept);
            let left_out = errors.filter(|(_, kept)| **kept == 0.0);
            *squares += left_out.map(|((h, y), _)| (h - y).powi(2)).sum::<f64>();
        }
    }
    let (low, high) = fair_range(&search.measured);
    let count = search.measured.len() as f64;
    let [without, with] = squares.map(|sum| 100.0 * (sum / count).sqrt() / (high - low));
    let worth = with < (1.0 - WORTH) * without;
    Ok((worth || asked).then_some((first, Report { without, with })))
}

/// Whether a ring explains a part of what the operators leave of the outputs.
fn explains(
    recordings: &[Recording],
    options: &FitOptions,
    ring: [f64; 2],
    progress: Progress<'_>,
) -> Result<bool> {
    let Some(clock) = Clock::new(recordings) else {
        return Ok(false);
    };
    let mut search = Search::new(recordings, options, &clock, progress)?;
    let still = search.still(None)?;
    let (_, _, swung) = search.swung(ring, None, &still)?;
    let (low, high) = fair_range(&search.measured);
    let count = search.measured.len() as f64;
    let [without, with] = [still, swung].map(|outputs| {
        let squares = left(&outputs, &search.measured, None);
        100.0 * (squares / count).sqrt() / (high - low)
    });
    Ok(is_better(with, without, WORTH, noise_percent(recordings)))
}

struct Search<'a> {
    fits: Again<'a>,
    measured: Vec<f64>,
    clock: &'a Clock,
    progress: Progress<'a>,
}

impl<'a> Search<'a> {
    fn new(
        recordings: &'a [Recording],
        options: &'a FitOptions,
        clock: &'a Clock,
        progress: Progress<'a>,
    ) -> Result<Self> {
        progress.tell("ring", f64::NAN)?;
        Ok(Self {
            measured: recordings.iter().flat_map(|r| r.output.clone()).collect(),
            fits: Again::new(Problem::new(recordings, options)?),
            clock,
            progress,
        })
    }

    /// The outputs of the operators, fitted to `targets` at the samples kept.
    fn sums(&mut self, targets: Vec<f64>, kept: Option<&[f64]>) -> Result<Vec<f64>> {
        self.progress.tell("ring", f64::NAN)?;
        self.fits.outputs(targets, kept, STEPS)
    }

    /// Those without a ring.
    fn still(&mut self, kept: Option<&[f64]>) -> Result<Vec<f64>> {
        self.sums(self.measured.clone(), kept)
    }

    /// The squares that a ring behind these sums leaves at the samples kept.
    fn squares(&self, ring: [f64; 2], sums: &[f64], kept: Option<&[f64]>, most: usize) -> f64 {
        let told = ring[0] * self.clock.step <= HIGHEST && ring[0] * self.clock.longest >= CYCLES;
        let ring = Resonator::new(self.clock, ring, most).filter(|_| told);
        let Some(ring) = ring else {
            return f64::INFINITY;
        };
        left(&ring.forward(sums), &self.measured, kept)
    }

    /// The best of the frequencies and dampings that are tried; `None` where it leaves about as
    /// much as the operators alone.
    fn first(&self, sums: &[f64], asked: bool) -> Result<Option<[f64; 2]>> {
        let looked = sums.len().min(LOOKED_AT);
        let without = left(&sums[..looked], &self.measured, None);
        let (lowest, highest) = (CYCLES / self.clock.longest, HIGHEST / self.clock.step);
        let count = (DECADE * (highest / lowest).log10()).ceil().max(0.0) as usize;
        let mut best = (f64::INFINITY, None);
        for n in 0..count {
            self.progress.tell("ring", f64::NAN)?;
            let frequency = lowest * 10_f64.powf((n as f64 + 0.01) / DECADE);
            for damping in DAMPINGS {
                let ring = [frequency, damping];
                let squares = self.squares(ring, sums, None, looked);
                if squares < best.0 {
                    best = (squares, Some(ring));
                }
            }
        }
        match best.1 {
            None if asked => {
                let what = format!(
                    "a ring: {CYCLES} cycles of it are longer than the recording, or faster than \
                     its samples"
                );
                Err(Error::Fit(what))
            }
            found if asked || best.0 < (1.0 - EXCITED) * without => Ok(found),
            _ => Ok(None),
        }
    }

    /// The ring and the weights in turn, from the outputs of weights without a ring: the ring, what
    /// the operators have to give in front of it, and the outputs behind it.
    fn swung(
        &mut self,
        first: [f64; 2],
        kept: Option<&[f64]>,
        still: &[f64],
    ) -> Result<([f64; 2], Vec<f64>, Vec<f64>)> {
        let (mut at, mut sums) = (first.map(f64::ln), still.to_vec());
        let mut edge = 0.1;
        let mut round = 0;
        loop {
            let squares =
                |at: &[f64; 2]| Ok(self.squares(at.map(f64::exp), &sums, kept, usize::MAX));
            at = minimise(at, edge, 1e-4, 60, squares)?.0;
            edge = 0.02;
            let constants = at.map(f64::exp);
            let ring = Resonator::new(self.clock, constants, usize::MAX);
            let ring = ring.ok_or_else(|| Error::Fit("a ring out of its range".into()))?;
            let outputs = ring.forward(&sums);
            let change = self.measured.iter().zip(&outputs).map(|(y, h)| y - h);
            let change = ring.undone(&change.collect::<Vec<_>>(), kept);
            let targets = sums.iter().zip(change).map(|(h, change)| h + change);
            let targets: Vec<f64> = targets.collect();
            if round == ROUNDS {
                return Ok((constants, targets, outputs));
            }
            sums = self.sums(targets, kept)?;
            round += 1;
        }
    }
}

/// The squares of what is left at the samples kept, about their mean.
fn left(outputs: &[f64], measured: &[f64], kept: Option<&[f64]>) -> f64 {
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for (n, (h, y)) in outputs.iter().zip(measured).enumerate() {
        let weight = kept.map_or(1.0, |kept| kept[n]);
        let error = y - h;
        count += weight;
        sum += weight * error;
        squares += weight * error * error;
    }
    squares - sum * sum / count
}
