//! A ring over whole recordings, as the search of its constants needs it: forward, its transpose,
//! and the input that most likely gave an output.

use crate::model::StageConstants;
use crate::recording::Recording;
use std::ops::Range;

/// Steps of time that differ by less than this share of the mean one count as equal: clocks are
/// written with few digits.
const EQUAL: f64 = 1e-3;

/// How much an input is believed to be what the operators give, beside a unit of the output's
/// noise. In the band below the resonance a tenth of what is left then stays after each turn.
const BELIEF: f64 = 0.1;

/// Steps of conjugate gradients, and the share of the squares at which they end. A damping of 0.01
/// takes some hundred.
const STEPS: usize = 200;
const ENOUGH: f64 = 1e-8;

/// When the samples of all recordings were taken.
pub(super) struct Clock {
    /// The samples of each recording.
    recordings: Vec<Range<usize>>,
    /// Time since the sample before; zero at the first of each recording.
    dt: Vec<f64>,
    /// The mean step, s, and the longest recording, s.
    pub(super) step: f64,
    pub(super) longest: f64,
}

impl Clock {
    /// `None` where a recording has no time, or none passes.
    pub(super) fn new(recordings: &[Recording]) -> Option<Self> {
        let (mut ranges, mut dt) = (Vec::new(), Vec::new());
        let (mut total, mut count, mut longest) = (0.0, 0, 0.0_f64);
        for recording in recordings {
            let time = recording.time.as_ref()?;
            let start = dt.len();
            dt.extend((0..time.len()).map(|n| time[n] - time[n.saturating_sub(1)]));
            ranges.push(start..dt.len());
            let length: f64 = dt[start..].iter().sum();
            total += length;
            count += time.len().saturating_sub(1);
            longest = longest.max(length);
        }
        let step = total / count as f64;
        let near = |dt: &f64| (dt - step).abs() <= EQUAL * step;
        dt.iter_mut()
            .filter(|dt| near(dt))
            .for_each(|dt| *dt = step);
        (step > 0.0 && step.is_finite()).then_some(Self {
            recordings: ranges,
            dt,
            step,
            longest,
        })
    }
}

/// A ring at the samples of a clock: `x ← F x + g u` with output and velocity `x`.
pub(super) struct Resonator<'a> {
    clock: &'a Clock,
    /// `1 − a`, `b`, `d` of each sample.
    factors: Vec<[f64; 3]>,
}

impl<'a> Resonator<'a> {
    /// `None` for constants out of range. `most` limits how many samples are looked at.
    pub(super) fn new(
        clock: &'a Clock,
        [frequency, damping]: [f64; 2],
        most: usize,
    ) -> Option<Self> {
        let named = [("ring_frequency", frequency), ("ring_damping", damping)];
        let constants =
            StageConstants::new(named.map(|(name, number)| (name, vec![number]))).ok()?;
        let stages = constants.stages();
        let in_range = |(constant, numbers): (&hysteron_core::Constant, &[f64])| {
            numbers.iter().all(|number| constant.range.has(*number))
        };
        if stages.is_none() || !constants.iter().all(in_range) {
            return None;
        }
        let factors = |dt: f64| {
            let [.., gain, b, d] = stages.rates(dt).to_numbers();
            [gain, b, d]
        };
        let usual = factors(clock.step);
        let each = clock
            .dt
            .iter()
            .take(most)
            .map(|dt| match *dt == clock.step {
                true => usual,
                false => factors(*dt),
            });
        Some(Self {
            clock,
            factors: each.collect(),
        })
    }

    /// The ranges of the recordings, as far as the factors reach.
    fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        let count = self.factors.len();
        let each = self.clock.recordings.iter();
        each.map(move |range| range.start.min(count)..range.end.min(count))
    }

    /// The outputs for these inputs. Each recording begins at rest.
    pub(super) fn forward(&self, input: &[f64]) -> Vec<f64> {
        let mut output = Vec::with_capacity(input.len());
        for range in self.ranges() {
            let [mut y, mut v] = [input.get(range.start).copied().unwrap_or(0.0), 0.0];
            for n in range {
                let [gain, b, d] = self.factors[n];
                let gap = input[n] - y;
                [y, v] = [y + (gain * gap + b * v), b * gap + d * v];
                output.push(y);
            }
        }
        output
    }

    /// The transpose of [`Resonator::forward`].
    fn transposed(&self, output: &[f64]) -> Vec<f64> {
        let mut input = vec![0.0; output.len()];
        for range in self.ranges() {
            let first = range.start;
            let [mut p, mut q] = [0.0, 0.0];
            for n in range.rev() {
                p += output[n];
                let [gain, b, d] = self.factors[n];
                input[n] += gain * p + b * q;
                [p, q] = [(1.0 - gain) * p - b * q, b * p + d * q];
                if n == first {
                    // It rests at the first input.
                    input[n] += p;
                }
            }
        }
        input
    }

    /// The change of the input, as small as may be, that gives a change of the output at the
    /// samples that count: least squares of both, `min Σ w (R δ − r)² + β Σ δ²`, by conjugate
    /// gradients (Hestenes and Stiefel 1952). Undoing the ring instead would make noise above the
    /// resonance larger than all else.
    pub(super) fn undone(&self, change: &[f64], counts: Option<&[f64]>) -> Vec<f64> {
        let weighed = |mut values: Vec<f64>| {
            for (value, weight) in values.iter_mut().zip(counts.unwrap_or_default()) {
                *value *= weight;
            }
            values
        };
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut found = vec![0.0; change.len()];
        let mut rest = self.transposed(&weighed(change.to_vec()));
        let mut way = rest.clone();
        let mut squares = product(&rest, &rest);
        let enough = ENOUGH * squares;
        for _ in 0..STEPS {
            if squares <= enough {
                break;
            }
            let mut image = self.transposed(&weighed(self.forward(&way)));
            image
                .iter_mut()
                .zip(&way)
                .for_each(|(i, w)| *i += BELIEF * w);
            let length = squares / product(&way, &image);
            found
                .iter_mut()
                .zip(&way)
                .for_each(|(f, w)| *f += length * w);
            rest.iter_mut()
                .zip(&image)
                .for_each(|(r, i)| *r -= length * i);
            let next = product(&rest, &rest);
            let turn = next / squares;
            way.iter_mut()
                .zip(&rest)
                .for_each(|(w, r)| *w = r + turn * *w);
            squares = next;
        }
        found
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn uneven(count: usize) -> Clock {
        let time = (0..count).map(|n| 0.1 * n as f64 + 0.03 * (n as f64).sin());
        let recording = |time: Vec<f64>| {
            let input: Vec<f64> = time.iter().map(|t| t.cos()).collect();
            let mut recording = Recording::new(input.clone(), input).unwrap();
            recording.time = Some(time);
            recording
        };
        let time: Vec<f64> = time.collect();
        Clock::new(&[recording(time.clone()), recording(time)]).unwrap()
    }

    #[test]
    fn the_transpose_is_one_and_a_change_is_the_least() {
        let clock = uneven(200);
        let ring = Resonator::new(&clock, [0.8, 0.05], usize::MAX).unwrap();
        let series = |a: f64| {
            (0..400)
                .map(|n| (a * f64::from(n * n)).sin())
                .collect::<Vec<_>>()
        };
        let (u, r) = (series(0.013), series(0.029));
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (there, back) = (
            product(&ring.forward(&u), &r),
            product(&u, &ring.transposed(&r)),
        );
        assert!((there - back).abs() < 1e-9 * there.abs(), "{there} {back}");
        // The change is the minimum: the gradient is as small there as the search ends at.
        let found = ring.undone(&r, None);
        let missed: Vec<f64> = ring
            .forward(&found)
            .iter()
            .zip(&r)
            .map(|(y, r)| y - r)
            .collect();
        let slope = ring.transposed(&missed);
        let slope: Vec<f64> = slope
            .iter()
            .zip(&found)
            .map(|(s, f)| s + BELIEF * f)
            .collect();
        let first = ring.transposed(&r);
        let (left, first) = (product(&slope, &slope), product(&first, &first));
        assert!(left < 2.0 * ENOUGH * first, "{left} {first}");
    }
}
