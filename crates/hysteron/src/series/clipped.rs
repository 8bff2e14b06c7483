//! Finds an output that stands at an end of what its sensor reads.

use crate::series::lost::equal_runs;
use crate::series::noise::median_of;
use crate::series::spread::range;
use serde::Serialize;
use std::ops::Range;

/// Fewer equal readings in a row may be chance.
const SHORTEST: usize = 4;
/// So may be a single run.
const TIMES: usize = 2;
/// The input goes on by this share of its range before it turns. In a dead band, an output rests
/// from where the input turns.
const GOES_ON: f64 = 0.02;
/// An output that rests elsewhere too while the input goes on, with more than this share of its
/// samples, goes by steps.
const RESTS: f64 = 0.02;
/// With more equal neighbours than this share, the output is read in coarse steps.
const COARSE: f64 = 0.02;
/// Then its way is looked at over so many samples that it is usually as many of these steps. A
/// single one says nothing of how fast it moves.
const WAY: f64 = 8.0;
/// With fewer of them over the range of the output, the last one before an end is not told from a
/// stop.
const FINE: f64 = 100.0;
/// That many samples are at most this share of the recording.
const LONGEST: usize = 50;
/// A material comes to its end slowly, and leaves it slowly. What is cut off has steps of this
/// share of the usual one there; of two, one may be cut itself.
const KINK: f64 = 0.3;
/// Number of steps that tell where the input goes.
const STEPS: usize = 6;

/// Readings at an end of the output's range, which the output reaches again and again, and keeps to
/// the last digit while the input goes on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CutOff {
    /// The value, in the output's unit.
    pub value: f64,
    /// How often the output came there.
    pub times: usize,
    /// Number of such readings.
    pub samples: usize,
}

/// The end of the output that has more such readings, if one has them. A mechanical stop looks the
/// same: readings do not tell.
pub(crate) fn clipped(input: &[f64], output: &[f64]) -> Option<CutOff> {
    let (low, high) = range(output);
    // A force without contact, or a closed valve, is zero by itself.
    let is_end = |value: f64| value == low && low != 0.0 || value == high;
    let (least, most) = range(input);
    let goes_on = |run: &Range<usize>| {
        let at = input[run.start];
        let way = at - input[run.start.saturating_sub(STEPS)];
        let beyond = input[run.clone()].iter().map(|x| (x - at) * way.signum());
        way != 0.0 && beyond.fold(0.0, f64::max) >= GOES_ON * (most - least)
    };
    let stays = |run: &Range<usize>| run.len() >= SHORTEST && goes_on(run);
    let (runs, rests): (Vec<_>, Vec<_>) = equal_runs(output)
        .filter(stays)
        .partition(|run| is_end(output[run.start]));
    if rests.iter().map(Range::len).sum::<usize>() as f64 > RESTS * output.len() as f64 {
        return None;
    }
    let (samples, usual) = usual_way(output)?;
    let is_cut = |run: &Range<usize>| kink(output, run, samples) >= KINK * usual;
    let runs: Vec<Range<usize>> = runs.into_iter().filter(is_cut).collect();
    let at = |value: f64| {
        let runs = runs.iter().filter(|run| output[run.start] == value);
        let samples = runs.clone().map(Range::len).sum();
        let times = runs.count();
        CutOff {
            value,
            times,
            samples,
        }
    };
    let ends = [at(low), at(high)].into_iter();
    let ends = ends.filter(|end| end.times >= TIMES && low < high);
    ends.max_by_key(|end| end.samples)
}

/// The usual way of a series over some samples, and their number; 1 where it is not read in coarse
/// steps. `None` for a series that does not move, or has few of them.
fn usual_way(values: &[f64]) -> Option<(usize, f64)> {
    let ways = |samples: usize| -> Vec<f64> {
        let pairs = values.iter().zip(values.iter().skip(samples));
        let ways = pairs.map(|(a, b)| (b - a).abs());
        ways.filter(|way| *way > 0.0).collect()
    };
    let steps = ways(1);
    let finest = steps.iter().copied().reduce(f64::min)?;
    let equal = (values.len() - 1 - steps.len()) as f64;
    if equal <= COARSE * values.len() as f64 {
        return Some((1, median_of(steps)));
    }
    let (low, high) = range(values);
    if high - low < FINE * finest {
        return None;
    }
    let mut samples = 1;
    loop {
        let usual = median_of(ways(samples));
        if usual >= WAY * finest || samples >= values.len() / LONGEST {
            return Some((samples, usual));
        }
        samples *= 2;
    }
}

/// The way over so many samples with which a series comes to a run, or with which it leaves it,
/// whichever is smaller. Of two steps, one may be cut itself.
fn kink(values: &[f64], run: &Range<usize>, samples: usize) -> f64 {
    let largest = |pairs: &[f64]| {
        let steps = pairs.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        steps.fold(0.0, f64::max)
    };
    let (first, last) = (run.start, run.end - 1);
    let [before, after] = match samples {
        1 => [
            largest(&values[first.saturating_sub(2)..=first]),
            largest(&values[last..values.len().min(last + 3)]),
        ],
        _ => [
            first.saturating_sub(samples),
            (last + samples).min(values.len() - 1),
        ]
        .map(|n| (values[n] - values[first]).abs()),
    };
    match run.end == values.len() {
        true => before,
        false => before.min(after),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A play behind an S, noisy or not.
    fn loops(noise: f64) -> (Vec<f64>, Vec<f64>) {
        let input: Vec<f64> = (0..3000)
            .map(|n| 10.0 * (f64::from(n) * 0.02).sin())
            .collect();
        let mut play = 0.0_f64;
        let follow = |(n, x): (usize, &f64)| {
            play = play.clamp(x - 2.0, x + 2.0);
            let (n, cut) = (n as f64, (play / 4.0).clamp(-1.0, 1.0));
            1.5 * cut - 0.5 * cut.powi(3) + noise * (n * 12.9898).sin()
        };
        let output = input.iter().enumerate().map(follow).collect();
        (input, output)
    }

    #[test]
    fn what_is_cut_off_is_found() {
        let (input, clean) = loops(1e-3);
        for limit in [0.3, 0.6, 0.9] {
            let high: Vec<f64> = clean.iter().map(|y| y.min(limit)).collect();
            let found = clipped(&input, &high).map(|found| (found.value, found.times));
            assert_eq!(found, Some((limit, 10)));
            let low: Vec<f64> = clean.iter().map(|y| y.max(-limit)).collect();
            let found = clipped(&input, &low).map(|found| (found.value, found.times));
            assert_eq!(found, Some((-limit, 9)));
        }
    }

    /// A converter reads in steps. Some of them are in a row where the output moves, too.
    #[test]
    fn what_is_cut_off_is_found_behind_a_converter() {
        let (input, clean) = loops(1e-3);
        for steps in [200.0, 1000.0, 4000.0] {
            let read = |y: f64| (y * steps / 2.0).round() / (steps / 2.0);
            for limit in [0.3, 0.6] {
                let high: Vec<f64> = clean.iter().map(|y| read(y.min(limit))).collect();
                let found = clipped(&input, &high).map(|found| (found.value, found.times));
                assert_eq!(found, Some((read(limit), 10)), "{steps} steps");
                let whole: Vec<f64> = clean.iter().map(|y| read(*y)).collect();
                assert_eq!(clipped(&input, &whole), None, "{steps} steps");
            }
        }
    }

    #[test]
    fn what_rests_by_itself_is_not() {
        // Saturation that is reached slowly; dead bands; steps; a coarse reading; a rest.
        let (input, saturates) = loops(0.0);
        let (_, noisy) = loops(1e-3);
        let mut play = 0.0_f64;
        let dead_band = input.iter().map(|x| {
            play = play.clamp(x - 2.0, x + 2.0);
            play
        });
        let coarse = saturates.iter().map(|y| (y * 20.0).round());
        let steps = (0..3000).map(|n| f64::from(n / 50 % 7));
        let cases: [Vec<f64>; 6] = [
            saturates.clone(),
            noisy,
            dead_band.collect(),
            coarse.collect(),
            steps.collect(),
            vec![1.0; 3000],
        ];
        for (n, output) in cases.iter().enumerate() {
            assert_eq!(clipped(&input, output), None, "case {n}");
        }
        assert_eq!(clipped(&[], &[]), None);
    }
}
