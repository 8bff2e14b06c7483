//! Identifies the output curve behind the operators, where it predicts parts of the recordings that
//! were left out.
//!
//! A curve is worth most where the weights are told little: with weights that depend on the width
//! of an operator alone it is a two-sided Prandtl-Ishlinskii model (Kuhnen 2003). So curve and
//! smoothness along the diagonal are chosen together.

use crate::error::{Error, Result};
use crate::identify::options::{Choice, FitOptions};
use crate::identify::stages::blocks::{BLOCKS, WORTH, blocks};
use crate::identify::weights::problem::Problem;
use crate::model::{Bend, Smooth};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::{fair_range, range};
use serde::Serialize;

/// The largest number of pieces.
const MOST: usize = 100;

/// Pieces of a curve that are tried.
const PIECES: [usize; 2] = [5, 8];

/// Strengths along the diagonal that are tried beside the one chosen. With the last ones the
/// weights depend on little but the width.
const ALONG: [f64; 4] = [1e-6, 1e-5, 1e-4, 1e-3];

/// Turns between weights and curve. Further ones change little.
const ROUNDS: usize = 8;

/// The flattest piece, as a share of the mean slope: the inverse divides by it.
const FLATTEST: f64 = 0.02;

/// What was tried, for the model file.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Report {
    /// Error on blocks left out without a curve, in percent of the range.
    without: f64,
    /// The same with the curve taken.
    with: f64,
}

/// A curve, and how the weights in front of it are fitted.
pub(super) struct Bent {
    pub(super) bend: Bend,
    /// The recordings with the output of the operators in front of the curve.
    pub(super) recordings: Vec<Recording>,
    pub(super) options: FitOptions,
    pub(super) report: Report,
}

/// Finds a curve; `None` where the operators alone predict as well. One that was asked for is taken
/// in any case.
pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<Option<Bent>> {
    let search = Search::new(recordings, options, progress);
    let strengths = [options.smooth.along].into_iter().chain(ALONG);
    let (pieces, asked) = match options.curve {
        Choice::Fixed(0) => return Ok(None),
        Choice::Fixed(count) if count > MOST => {
            let what = format!("a curve of {count} pieces: take {MOST} at most");
            return Err(Error::Fit(what));
        }
        Choice::Fixed(count) => (vec![count], true),
        Choice::Auto => (PIECES.to_vec(), false),
    };
    let mut without = f64::INFINITY;
    let mut best = (f64::INFINITY, 0, options.smooth.along);
    for along in strengths {
        without = without.min(search.rated(0, along)?);
        for &count in &pieces {
            let error = search.rated(count, along)?;
            if error < best.0 {
                best = (error, count, along);
            }
        }
    }
    let (with, count, along) = best;
    let worth = asked || with < (1.0 - WORTH) * without;
    if !(worth && with.is_finite()) {
        return Ok(None);
    }
    let options = search.with(along);
    let (bend, recordings) = search.bent(count, &options, None)?;
    Ok(bend.map(|bend| Bent {
        bend,
        recordings,
        options: FitOptions {
            bootstrap: search.options.bootstrap,
            ..options
        },
        report: Report { without, with },
    }))
}

struct Search<'a> {
    recordings: &'a [Recording],
    options: &'a FitOptions,
    progress: Progress<'a>,
    /// The measured outputs, and the block of each sample.
    measured: Vec<f64>,
    blocks: Vec<usize>,
}

impl<'a> Search<'a> {
    fn new(recordings: &'a [Recording], options: &'a FitOptions, progress: Progress<'a>) -> Self {
        let each = recordings.iter();
        Self {
            recordings,
            options,
            progress,
            measured: each.clone().flat_map(|r| r.output.clone()).collect(),
            blocks: each.flat_map(|one| blocks(one, BLOCKS)).collect(),
        }
    }

    fn with(&self, along: f64) -> FitOptions {
        let smooth = Smooth {
            along,
            ..self.options.smooth
        };
        FitOptions {
            bootstrap: 0,
            smooth,
            ..self.options.clone()
        }
    }

    /// The error on blocks left out, in percent of the range, with a curve of so many pieces.
    fn rated(&self, pieces: usize, along: f64) -> Result<f64> {
        self.progress.tell("output curve", f64::NAN)?;
        let options = self.with(along);
        let mut squares = 0.0;
        for parity in 0..2 {
            let kept: Vec<f64> = self
                .blocks
                .iter()
                .map(|b| f64::from(b % 2 != parity))
                .collect();
            let (bend, recordings) = self.bent(pieces, &options, Some(&kept))?;
            let sums = sums(&recordings, &options, Some(&kept))?;
            let left_out = |n: usize| self.blocks[n] % 2 == parity;
            let error = |(n, sum): (usize, &f64)| {
                let output = bend.as_ref().map_or(*sum, |bend| bend.core().at(*sum));
                (output - self.measured[n]).powi(2)
            };
            let each = sums.iter().enumerate().filter(|(n, _)| left_out(*n));
            squares += each.map(error).sum::<f64>();
        }
        let (low, high) = fair_range(&self.measured);
        Ok(100.0 * (squares / self.measured.len() as f64).sqrt() / (high - low))
    }

    /// A curve fitted in turn with the weights, and the recordings with what the operators have to
    /// give in front of it: the curve's slope makes the problem of the weights linear
    /// (Gauss-Newton). The best of all rounds. Without pieces the recordings as they are.
    fn bent(
        &self,
        pieces: usize,
        options: &FitOptions,
        kept: Option<&[f64]>,
    ) -> Result<(Option<Bend>, Vec<Recording>)> {
        let mut best = (f64::INFINITY, None, self.recordings.to_vec());
        if pieces == 0 {
            return Ok((None, best.2));
        }
        let mut seen = self.recordings.to_vec();
        for _ in 0..ROUNDS {
            let sums = sums(&seen, options, kept)?;
            let counts = |n: usize| kept.is_none_or(|kept| kept[n] != 0.0);
            let Some(bend) = fit(&sums, &self.measured, counts, pieces) else {
                break;
            };
            let curve = bend.core();
            let errors = sums
                .iter()
                .zip(&self.measured)
                .map(|(h, y)| y - curve.at(*h));
            let errors: Vec<f64> = errors.collect();
            let each = errors.iter().enumerate().filter(|(n, _)| counts(*n));
            let squares: f64 = each.map(|(_, error)| error * error).sum();
            let better = squares < best.0;
            let mut from = 0;
            for recording in &mut seen {
                for (n, output) in (from..).zip(&mut recording.output) {
                    let slope = curve.slope_at(sums[n]);
                    *output = sums[n] + errors[n] / slope;
                }
                from += recording.len();
            }
            if better {
                best = (squares, Some(bend), seen.clone());
            }
        }
        Ok((best.1, best.2))
    }
}

/// The outputs of the operators, in their unit and with their sign, fitted to the samples kept.
fn sums(recordings: &[Recording], options: &FitOptions, kept: Option<&[f64]>) -> Result<Vec<f64>> {
    let mut problem = Problem::new(recordings, options)?;
    let fitted = problem.solve(kept, Progress::NONE)?;
    problem.outputs(&fitted)
}

/// The monotone curve of so many equal pieces that is nearest to the outputs that count, by least
/// squares: each slope in turn, until none moves. `None` where the sums do not move.
fn fit(
    sums: &[f64],
    outputs: &[f64],
    counts: impl Fn(usize) -> bool,
    pieces: usize,
) -> Option<Bend> {
    let used: Vec<usize> = (0..sums.len()).filter(|n| counts(*n)).collect();
    let (low, high) = range(&used.iter().map(|n| sums[*n]).collect::<Vec<f64>>());
    let (least, most) = range(&used.iter().map(|n| outputs[*n]).collect::<Vec<f64>>());
    let step = (high - low) / pieces as f64;
    let mean = (most - least) / (high - low);
    if !(step > 0.0 && mean > 0.0 && mean.is_finite()) {
        return None;
    }
    // How far a sum is within a piece; the outermost ones go on.
    let within = |h: f64, k: usize| {
        let part = h - low - step * k as f64;
        let from = if k == 0 { f64::NEG_INFINITY } else { 0.0 };
        let to = if k + 1 == pieces { f64::INFINITY } else { step };
        part.clamp(from, to)
    };
    let centred = |values: Vec<f64>| {
        let middle = values.iter().sum::<f64>() / values.len() as f64;
        let values: Vec<f64> = values.iter().map(|value| value - middle).collect();
        (values, middle)
    };
    let column = |k: usize| centred(used.iter().map(|n| within(sums[*n], k)).collect());
    let columns: Vec<(Vec<f64>, f64)> = (0..pieces).map(column).collect();
    let (mut rest, middle) = centred(used.iter().map(|n| outputs[*n]).collect());
    let mut slopes = vec![mean; pieces];
    for (slope, (column, _)) in slopes.iter().zip(&columns) {
        rest.iter_mut()
            .zip(column)
            .for_each(|(r, b)| *r -= slope * b);
    }
    for _ in 0..SWEEPS {
        for (slope, (column, _)) in slopes.iter_mut().zip(&columns) {
            let square: f64 = column.iter().map(|b| b * b).sum();
            let product: f64 = column.iter().zip(&rest).map(|(b, r)| b * r).sum();
            if square > 0.0 {
                let next = (*slope + product / square).max(FLATTEST * mean);
                let moved = next - std::mem::replace(slope, next);
                rest.iter_mut()
                    .zip(column)
                    .for_each(|(r, b)| *r -= moved * b);
            }
        }
    }
    let middles = slopes
        .iter()
        .zip(&columns)
        .map(|(s, (_, middle))| s * middle);
    let mut output = middle - middles.sum::<f64>();
    let mut bend = Bend {
        sums: vec![low],
        outputs: vec![output],
    };
    for (k, slope) in slopes.iter().enumerate() {
        output += slope * step;
        bend.sums.push(low + step * (k + 1) as f64);
        bend.outputs.push(output);
    }
    Some(bend)
}

/// Passes over the slopes of a curve.
const SWEEPS: usize = 200;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Sign;

    #[test]
    fn a_curve_is_found_again_and_anchored_at_any_offset() {
        let curve = |h: f64| {
            if h < 2.0 {
                0.5 * h
            } else {
                1.0 + 2.0 * (h - 2.0)
            }
        };
        let sums: Vec<f64> = (0..101).map(|n| -1.0 + 0.06 * f64::from(n)).collect();
        let outputs: Vec<f64> = sums.iter().map(|h| curve(*h)).collect();
        let Some(bend) = fit(&sums, &outputs, |_| true, 6) else {
            unreachable!("the sums move");
        };
        for (h, y) in sums.iter().zip(&outputs) {
            assert!((bend.core().at(*h) - y).abs() < 1e-9);
        }
        for (offset, sign) in [(0.3, Sign::Positive), (2.7, Sign::Negative)] {
            let (base, sums, outputs) = bend.anchored(offset, sign);
            let anchored = Bend { sums, outputs };
            for h in [0.0, 0.4, 1.3, 2.9] {
                let there = base + sign.factor() * anchored.core().at(h);
                let expected = bend.core().at(offset + sign.factor() * h);
                assert!((there - expected).abs() < 1e-9, "{there} for {expected}");
            }
        }
    }
}
