//! Removes isolated spikes.
//!
//! Hampel's identifier (1974): a sample is an outlier if it is more than a given number of median
//! absolute deviations from the median of its neighbours. Recordings of actuators rise and fall
//! steeply. So the median is replaced by a robust line through the neighbours (Theil 1950, Sen
//! 1968). A spike must also be beyond the samples on both sides of it, which a step or a turning
//! point of the signal is not.

use crate::series::noise::{SIGMA_PER_MEDIAN, furthest, noise};
use crate::series::range;

/// Number of neighbours on either side. Eight in all are enough to outvote three wrong samples in a
/// row.
const REACH: usize = 4;

/// Number of deviations from which on a sample is a spike. Hampel's 3 would remove one sample in
/// 400 of Gaussian noise, 4 removes one in 16,000.
pub(crate) const DEVIATIONS: f64 = 4.0;

/// A reading is further from the line through eight others than from the right one: both err.
const LINE: f64 = 1.1;

/// The deviations from which on one of so many samples is a spike. The furthest of `n` readings
/// with Gaussian noise is about `√(2 ln n)` deviations away, and is none.
pub(crate) fn usual_deviations(samples: usize) -> f64 {
    DEVIATIONS.max(LINE * furthest(samples))
}

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
    let windows = values.len().saturating_sub(2 * REACH);
    for first in (0..windows).step_by(LANES) {
        // The last ones end with the series: a window may be looked at twice.
        let begin = first.min(windows.saturating_sub(LANES));
        let window = |lane: usize| &values[begin + lane..begin + lane + 2 * REACH + 1];
        let lanes = first - begin..LANES.min(windows - begin);
        if lanes
            .clone()
            .all(|lane| furthest_from_line(window(lane)) <= least)
        {
            continue;
        }
        let (residuals, spreads) = against_neighbours(|lane| window(lane.min(lanes.end - 1)));
        for lane in lanes {
            let threshold = (deviations * spreads[lane].max(sigma)).max(floor);
            if residuals[lane].abs() > threshold {
                off.push(Off {
                    sample: begin + lane + REACH,
                    side: residuals[lane].signum(),
                    threshold,
                });
            }
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
fn furthest_from_line(window: &[f64]) -> f64 {
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

/// So many windows are looked at together: the same few operations on each make one of a vector.
const LANES: usize = 8;

/// A number of each window.
type Lanes = [f64; LANES];

/// In each window, the distance of the middle sample from the line through the others, and their
/// deviation from that line.
fn against_neighbours<'a>(window: impl Fn(usize) -> &'a [f64]) -> (Lanes, Lanes) {
    let place = |n: usize| n + usize::from(n >= REACH);
    let at = |n: usize| place(n) as f64 - REACH as f64;
    let series: [Lanes; OTHERS] = each(|n, lane| window(lane)[place(n)]);
    let mut slopes = [[0.0; LANES]; PAIRS];
    let pairs = (0..OTHERS).flat_map(|a| (a + 1..OTHERS).map(move |b| (a, b)));
    for (slopes, (a, b)) in slopes.iter_mut().zip(pairs) {
        *slopes = std::array::from_fn(|lane| (series[b][lane] - series[a][lane]) / (at(b) - at(a)));
    }
    let slope = middle(slopes);
    let level = middle(each::<OTHERS>(|n, lane| {
        series[n][lane] - slope[lane] * at(n)
    }));
    let spread = middle(each::<OTHERS>(|n, lane| {
        (series[n][lane] - level[lane] - slope[lane] * at(n)).abs()
    }));
    let residual = std::array::from_fn(|lane| window(lane)[REACH] - level[lane]);
    (residual, spread.map(|median| SIGMA_PER_MEDIAN * median))
}

/// Numbers by their place and lane.
fn each<const N: usize>(of: impl Fn(usize, usize) -> f64) -> [Lanes; N] {
    std::array::from_fn(|n| std::array::from_fn(|lane| of(n, lane)))
}

/// The median in each lane, of an even number of rows: the mean of the two middle ones. The rows
/// are sorted by a network, the odd-even merge sort (Batcher 1968), which compares the same places
/// whatever the numbers are.
fn middle<const N: usize>(mut rows: [Lanes; N]) -> Lanes {
    let mut merged = 1;
    while merged < N {
        let mut apart = merged;
        while apart > 0 {
            for start in (apart % merged..N - apart).step_by(2 * apart) {
                for n in start..(start + apart).min(N - apart) {
                    // Both within the same sequence that is merged.
                    if n / (2 * merged) == (n + apart) / (2 * merged) {
                        in_order(&mut rows, n, n + apart);
                    }
                }
            }
            apart /= 2;
        }
        merged *= 2;
    }
    std::array::from_fn(|lane| 0.5 * (rows[N / 2 - 1][lane] + rows[N / 2][lane]))
}

/// The smaller number of each lane to row `low`, the larger one to row `high`.
fn in_order(rows: &mut [Lanes], low: usize, high: usize) {
    let (a, b) = (rows[low], rows[high]);
    // Each is one instruction of the processor, which `f64::min` is not.
    let least = |lane: usize| if a[lane] < b[lane] { a[lane] } else { b[lane] };
    let most = |lane: usize| if a[lane] > b[lane] { a[lane] } else { b[lane] };
    rows[low] = std::array::from_fn(least);
    rows[high] = std::array::from_fn(most);
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

    /// Wherever a spike is, and however many windows are left for the last look.
    #[test]
    fn a_spike_is_found_in_a_series_of_any_length() {
        for len in 2 * REACH + 1..5 * LANES {
            let noise = gaussian(len as u64, len).into_iter().enumerate();
            let ramp: Vec<f64> = noise.map(|(n, e)| n as f64 + 0.1 * e).collect();
            for at in REACH..len - REACH {
                let mut read = ramp.clone();
                read[at] += 30.0;
                assert_eq!(remove(&mut read, DEVIATIONS), [at], "of {len}");
            }
        }
    }

    #[test]
    fn the_furthest_of_many_readings_is_no_spike() {
        for (seed, samples) in [(1, 1000), (2, 10_000), (3, 100_000), (4, 300_000)] {
            let mut noise = gaussian(seed, samples);
            let removed = remove(&mut noise, usual_deviations(samples));
            assert_eq!(removed, [0; 0], "of {samples}");
        }
    }

    /// Windows that are looked at together against each by itself, by medians of sorted numbers.
    #[test]
    fn windows_together_are_as_each_alone() {
        let sorted_median = |mut values: Vec<f64>| {
            values.sort_unstable_by(f64::total_cmp);
            let half = values.len() / 2;
            0.5 * (values[half - 1] + values[half])
        };
        let coarse = gaussian(9, 64).into_iter().map(f64::round);
        let values: Vec<f64> = gaussian(8, 64).into_iter().chain(coarse).collect();
        for first in 0..values.len() - 2 * REACH - LANES {
            let window = |lane: usize| &values[first + lane..first + lane + 2 * REACH + 1];
            let (residuals, spreads) = against_neighbours(window);
            for lane in 0..LANES {
                let place = |n: usize| n as f64 - REACH as f64;
                let all = window(lane).iter().enumerate();
                let others: Vec<(f64, f64)> = all
                    .filter(|(n, _)| *n != REACH)
                    .map(|(n, x)| (place(n), *x))
                    .collect();
                let pairs = (0..OTHERS).flat_map(|a| (a + 1..OTHERS).map(move |b| (a, b)));
                let rise = |(a, b): (usize, usize)| {
                    (others[b].1 - others[a].1) / (others[b].0 - others[a].0)
                };
                let slope = sorted_median(pairs.map(rise).collect());
                let level = sorted_median(others.iter().map(|(n, x)| x - slope * n).collect());
                let off = others.iter().map(|(n, x)| (x - level - slope * n).abs());
                let spread = SIGMA_PER_MEDIAN * sorted_median(off.collect());
                assert_eq!(residuals[lane], window(lane)[REACH] - level);
                assert_eq!(spreads[lane], spread);
            }
        }
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
