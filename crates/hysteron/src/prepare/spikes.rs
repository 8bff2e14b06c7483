//! Isolated spikes.
//!
//! Hampel's identifier (1974): a sample is an outlier if it is further from the median of its
//! neighbours than so many of their median absolute deviations. Recordings of actuators go up and
//! down steeply, so the median gives way to a robust line through the neighbours (Theil 1950, Sen
//! 1968), and a spike has to stick out beyond the samples on both sides of it: a step or a turn of
//! the signal does not.

use super::noise::{deviation_of, median_of, noise};
use crate::series::range;

/// Neighbours on either side. Eight of them outvote three samples in a row that are wrong.
const REACH: usize = 4;

/// Deviations from which on a sample is a spike. Hampel's 3 would take one sample in 400 of
/// Gaussian noise for one; 4, one in 16,000.
pub(super) const DEVIATIONS: f64 = 4.0;

/// A spike below this part of the range is left: less than half the distance between the levels of
/// a plane of 20.
const SMALLEST: f64 = 0.02;

/// Replaces spikes of more than `deviations` by the line between their neighbours, in place, and
/// returns which samples were replaced.
pub(super) fn remove(values: &mut [f64], deviations: f64) -> Vec<usize> {
    let (low, high) = range(values);
    let sigma = noise(values);
    let floor = SMALLEST * (high - low);
    // For each sample how far it is off, with its sign, if that is too far.
    let mut off = vec![None; values.len()];
    for (place, window) in off[REACH.min(values.len())..]
        .iter_mut()
        .zip(values.windows(2 * REACH + 1))
    {
        let (residual, spread) = against_neighbours(window);
        let threshold = (deviations * spread.max(sigma)).max(floor);
        *place = (residual.abs() > threshold).then_some((residual.signum(), threshold));
    }
    let mut replaced = Vec::new();
    let mut start = 0;
    while start < values.len() {
        let Some((side, _)) = off[start] else {
            start += 1;
            continue;
        };
        let same = |place: &&Option<(f64, f64)>| place.is_some_and(|(other, _)| other == side);
        let end = start + off[start..].iter().take_while(same).count();
        // The first and last REACH samples are never off, so there is one on either side.
        let (before, after) = (values[start - 1], values[end]);
        let outer = if side > 0.0 {
            before.max(after)
        } else {
            before.min(after)
        };
        let sticks_out = (start..end)
            .all(|n| off[n].is_some_and(|(_, threshold)| side * (values[n] - outer) > threshold));
        if sticks_out {
            let length = (end - start + 1) as f64;
            for (n, value) in (1_u32..).zip(&mut values[start..end]) {
                *value = before + (after - before) * f64::from(n) / length;
            }
            replaced.extend(start..end);
        }
        start = end;
    }
    replaced
}

/// How far the sample in the middle is from the line through the others, and their deviation from
/// it.
fn against_neighbours(window: &[f64]) -> (f64, f64) {
    let others = || {
        (0..window.len())
            .filter(|n| *n != REACH)
            .map(|n| (n as f64 - REACH as f64, window[n]))
    };
    let slopes = others().enumerate().flat_map(|(n, (a, at_a))| {
        others()
            .skip(n + 1)
            .map(move |(b, at_b)| (at_b - at_a) / (b - a))
    });
    let slope = median_of(slopes.collect());
    let level = median_of(others().map(|(n, x)| x - slope * n).collect());
    let spread = deviation_of(others().map(|(n, x)| x - level - slope * n));
    (window[REACH] - level, spread)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::test_series::gaussian;

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
        // At 300 and 800 there are turning points of the triangle itself.
        let mut repaired = spiked.clone();
        assert_eq!(remove(&mut repaired, DEVIATIONS), at);
        for n in at {
            // The line between neighbours, at a corner one step of 1 away from the truth, and the
            // noise.
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
