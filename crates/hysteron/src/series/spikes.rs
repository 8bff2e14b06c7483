//! Removes isolated spikes.
//!
//! Hampel's identifier (1974): a sample is an outlier if it is more than a given number of median
//! absolute deviations from the median of its neighbours. Recordings of actuators rise and fall
//! steeply. So the median is replaced by a robust line through the neighbours (Theil 1950, Sen
//! 1968). A spike must also be beyond the samples on both sides of it, which a step or a turning
//! point of the signal is not.

use crate::series::noise::{deviation_of, median, noise};
use crate::series::range;

/// Number of neighbours on either side. Eight in all are enough to outvote three wrong samples in a
/// row.
const REACH: usize = 4;

/// Number of deviations from which on a sample is a spike. Hampel's 3 would remove one sample in
/// 400 of Gaussian noise, 4 removes one in 16,000.
pub(crate) const DEVIATIONS: f64 = 4.0;

/// A spike below this share of the range is not removed. It is less than half the distance between
/// the levels of a plane of 20.
const SMALLEST: f64 = 0.02;

/// Replaces spikes of more than `deviations` by linear interpolation between their neighbours, in
/// place. Returns the indices of the samples replaced.
pub(crate) fn remove(values: &mut [f64], deviations: f64) -> Vec<usize> {
    let (low, high) = range(values);
    let removed = remove_above(values, deviations, SMALLEST * (high - low));
    removed.into_iter().map(|(n, _)| n).collect()
}

/// The values that stand out from those on both sides by more than `deviations` and `floor`, as
/// pairs of index and height, and the values without these heights. Unlike in [`remove`], the first
/// and last ones count too.
pub(crate) fn isolated(
    mut values: Vec<f64>,
    deviations: f64,
    floor: f64,
) -> (Vec<(usize, f64)>, Vec<f64>) {
    let len = values.len();
    if len <= REACH {
        return (Vec::new(), values);
    }
    // Mirrored at both ends.
    values.reserve_exact(2 * REACH);
    values.extend_from_within(len - 1 - REACH..len - 1);
    values[len..].reverse();
    let before: [f64; REACH] = std::array::from_fn(|n| values[REACH - n]);
    values.splice(0..0, before);
    let removed = remove_above(&mut values, deviations, floor).into_iter();
    let own = removed.filter(|(n, _)| (REACH..REACH + len).contains(n));
    let far = own.map(|(n, read)| (n - REACH, read - values[n])).collect();
    values.truncate(REACH + len);
    values.drain(..REACH);
    (far, values)
}

/// Replaces what stands out by more than `deviations` and `floor`. Returns the indices of what was
/// replaced, and what was read there.
fn remove_above(values: &mut [f64], deviations: f64, floor: f64) -> Vec<(usize, f64)> {
    let sigma = noise(values);
    // No threshold is lower, so what cannot reach this one needs no line.
    let least = (deviations * sigma).max(floor);
    // The samples that are too far from the line.
    let mut off: Vec<Off> = Vec::new();
    for (sample, window) in (REACH..).zip(values.windows(2 * REACH + 1)) {
        if furthest(window) <= least {
            continue;
        }
        let (residual, spread) = against_neighbours(window);
        let threshold = (deviations * spread.max(sigma)).max(floor);
        if residual.abs() > threshold {
            let side = residual.signum();
            off.push(Off {
                sample,
                side,
                threshold,
            });
        }
    }
    let mut removed = Vec::new();
    let next_to = |a: &Off, b: &Off| a.sample + 1 == b.sample && a.side == b.side;
    for run in off.chunk_by(next_to) {
        let (start, end) = (run[0].sample, run[0].sample + run.len());
        let side = run[0].side;
        // The first and last REACH samples are never spikes, so there is a neighbour on either
        // side.
        let (before, after) = (values[start - 1], values[end]);
        let outer = if side > 0.0 {
            before.max(after)
        } else {
            before.min(after)
        };
        let above = |off: &Off| side * (values[off.sample] - outer) > off.threshold;
        let sticks_out = run.iter().all(above);
        if sticks_out {
            let length = (end - start + 1) as f64;
            removed.extend((start..end).map(|n| (n, values[n])));
            for (n, value) in (1_u32..).zip(&mut values[start..end]) {
                *value = before + (after - before) * f64::from(n) / length;
            }
        }
    }
    removed
}

/// A sample that is too far from the line through its neighbours.
struct Off {
    sample: usize,
    /// 1 above the line, -1 below it.
    side: f64,
    threshold: f64,
}

/// Number of neighbours of a sample, and number of pairs of them.
const OTHERS: usize = 2 * REACH;
const PAIRS: usize = OTHERS * (OTHERS - 1) / 2;

/// The largest distance that [`against_neighbours`] can find. The slope of the line is at most that
/// of the steepest step, so no point of the line is further off.
fn furthest(window: &[f64]) -> f64 {
    let middle = window[REACH];
    let away = |most: f64, x: &f64| most.max((x - middle).abs());
    let away = window.iter().fold(0.0, away);
    // The step over the middle sample is between its two neighbours.
    let steps = window.windows(2).enumerate();
    let steps = steps.filter(|(n, _)| *n + 1 != REACH && *n != REACH);
    let over = 0.5 * (window[REACH + 1] - window[REACH - 1]).abs();
    let steepest = steps.fold(over, |most, (_, x)| most.max((x[1] - x[0]).abs()));
    // Rounding of a few sums.
    (away + steepest * REACH as f64) * (1.0 + 1e-12)
}

/// The distance of the middle sample from the line through the others, and their deviation from
/// that line.
fn against_neighbours(window: &[f64]) -> (f64, f64) {
    let mut others = [(0.0, 0.0); OTHERS];
    for (n, other) in others.iter_mut().enumerate() {
        let place = n + usize::from(n >= REACH);
        *other = (place as f64 - REACH as f64, window[place]);
    }
    let mut slopes = [0.0; PAIRS];
    let pairs = others.iter().enumerate();
    let pairs = pairs.flat_map(|(n, a)| others[n + 1..].iter().map(move |b| (a, b)));
    for (slope, ((a, at_a), (b, at_b))) in slopes.iter_mut().zip(pairs) {
        *slope = (at_b - at_a) / (b - a);
    }
    let slope = median(&mut slopes);
    let level = median(&mut others.map(|(n, x)| x - slope * n));
    let spread = deviation_of(&mut others.map(|(n, x)| x - level - slope * n));
    (window[REACH] - level, spread)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::test_series::gaussian;

    fn noisy_triangle() -> Vec<f64> {
        let triangle = (0..1000).map(|n| (f64::from(n % 200) - 100.0).abs());
        triangle
            .zip(gaussian(6, 1000))
            .map(|(x, e)| x + 0.2 * e)
            .collect()
    }

    #[test]
    fn spikes_are_found_and_nothing_else() {
        let clean = noisy_triangle();
        let mut spiked = clean.clone();
        let at = [50, 151, 152, 300, 444, 445, 446, 800];
        for n in at {
            spiked[n] = 0.0;
        }
        spiked[300] = 140.0;
        // The triangle itself has turning points at 300 and 800.
        let mut repaired = spiked.clone();
        assert_eq!(remove(&mut repaired, DEVIATIONS), at);
        for n in at {
            // Linear interpolation at a corner has an error of one step, 1, plus the noise.
            assert!((repaired[n] - clean[n]).abs() < 2.0, "{n}: {}", repaired[n]);
        }
        let untouched = |n: &usize| !at.contains(n);
        assert!(
            (0..1000)
                .filter(untouched)
                .all(|n| repaired[n] == spiked[n])
        );
    }

    #[test]
    fn steps_corners_and_short_series_are_no_spikes() {
        let steps: Vec<f64> = (0..300).map(|n| f64::from(n / 25 % 3)).collect();
        let jump: Vec<f64> = (0..50).map(|n| if n < 20 { 0.0 } else { 1.0 }).collect();
        let short = vec![0.0, 9.0, 0.0];
        let constant = vec![1.0; 30];
        for series in [noisy_triangle(), steps, jump, short, constant] {
            let mut after = series.clone();
            assert_eq!(remove(&mut after, DEVIATIONS), [0; 0]);
            assert_eq!(after, series);
        }
    }
}
