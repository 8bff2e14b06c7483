//! Finds a channel that stands still while the other one moves.

use crate::series::lost::{are_set_points, equal_runs, half_a_branch, held};
use crate::series::noise::noise;
use crate::series::spread::{range, usual_span};
use std::ops::Range;

/// Fewer equal readings in a row are not told from a slow signal.
pub(crate) const SHORTEST: usize = 20;
/// The other series rises and falls by at least this share of its usual range meanwhile. No material
/// with any response is still over such a way. One way alone proves nothing: a wire without a drive
/// cools, and its output moves all the way back.
const FAR: f64 = 0.8;
/// A series that often stands still is one of steps: at most this share of its other samples is in
/// long runs.
const OFTEN: f64 = 0.5;

/// A frozen channel may have noise: so far it stays together, as a share of the usual range.
const NOISY: f64 = 0.02;
/// Well inside its range a series moves sooner: within so much of it an answer is on its way between
/// two ends, and so far the other series may go.
const INSIDE: std::ops::RangeInclusive<f64> = 0.1..=0.9;
const FAR_INSIDE: f64 = 0.5;
/// A series repeats a reading at most so often where it has noise and no coarse steps.
const SELDOM: f64 = 0.05;
/// Less noise than this share of the range is none.
const FINE: f64 = 1e-4;
/// What is noise and no slow answer: the mean squared step, by twice the variance. It is 1 for white
/// noise and near 0 for a smooth series (von Neumann 1941).
const ROUGH: f64 = 0.25;

/// The samples over which `values` keeps one value, exactly or but for noise, while `other` moves
/// far; or exactly, for so long that it may have turned twice, and then goes on elsewhere.
///
/// Frozen are readings of a sensor that lost its contact or of a logger that goes on with the last
/// value. A series that moves in steps is not frozen between them.
pub(crate) fn frozen(values: &[f64], other: &[f64]) -> Vec<Range<usize>> {
    let long: Vec<Range<usize>> = equal_runs(values)
        .filter(|run| run.len() >= SHORTEST)
        .collect();
    let span = usual_span(other);
    // A drive may rest at the end of its range before an experiment, while what it moves settles.
    let (low, high) = range(values);
    let not_begun = |run: &Range<usize>| run.start == 0 && [low, high].contains(&values[0]);
    let moves_by = |share: f64, run: &Range<usize>| {
        let (rise, fall) = rise_and_fall(&other[run.clone()]);
        span > 0.0 && rise.min(fall) >= share * span && !not_begun(run)
    };
    let inside = |run: &Range<usize>| INSIDE.contains(&((values[run.start] - low) / (high - low)));
    let count = |runs: &[Range<usize>]| runs.iter().map(Range::len).sum::<usize>();
    // Of readings that differ even at rest, equal ones are no rest.
    let repeats = values.windows(2).filter(|pair| pair[0] == pair[1]).count();
    let elsewhere = values.len() - count(&long);
    let moving = || {
        let ends = [0].into_iter().chain(long.iter().map(|run| run.end));
        let starts = long.iter().map(|run| run.start).chain([values.len()]);
        let parts = ends.zip(starts).map(|(from, to)| &values[from..to]);
        parts.collect::<Vec<_>>().concat()
    };
    let is_fine = (repeats + long.len() - count(&long)) as f64 <= SELDOM * elsewhere as f64
        && noise(&moving()) >= FINE * (high - low);
    let far = |run: &Range<usize>| match is_fine && inside(run) {
        true => FAR_INSIDE,
        false => FAR,
    };
    let (far, rest): (Vec<_>, Vec<_>) = (0..long.len())
        .partition(|&n| !are_set_points(&long, n) && moves_by(far(&long[n]), &long[n]));
    let [far, rest] = [far, rest].map(|places| {
        let runs = places.into_iter().map(|n: usize| long[n].clone());
        runs.collect::<Vec<_>>()
    });
    let others = values.len() - count(&far);
    let mut found = match count(&rest) as f64 > OFTEN * others as f64 || others == 0 {
        true => Vec::new(),
        false => far,
    };
    let apart = |run: &Range<usize>, found: &[Range<usize>]| {
        found.iter().all(|other| are_apart(other, run))
    };
    for run in still(values) {
        let far = match inside(&run) {
            true => FAR_INSIDE,
            false => FAR,
        };
        if moves_by(far, &run) && is_rough(&values[run.clone()]) && apart(&run, &found) {
            found.push(run);
        }
    }
    let longest = half_a_branch(values);
    for run in held(values, None)
        .into_iter()
        .filter(|run| run.len() > longest)
    {
        if apart(&run, &found) {
            found.push(run);
        }
    }
    found
}

/// Whether two spans of samples have none in common.
pub(crate) fn are_apart(one: &Range<usize>, other: &Range<usize>) -> bool {
    one.end <= other.start || other.end <= one.start
}

/// Runs of samples that keep one value, exactly or but for noise, whatever the other series does.
pub(crate) fn still(values: &[f64]) -> Vec<Range<usize>> {
    let mut runs = together(values, NOISY * usual_span(values));
    let exactly = |run: &[f64]| run.iter().all(|x| *x == run[0]);
    runs.retain(|run| is_rough(&values[run.clone()]) || exactly(&values[run.clone()]));
    runs
}

/// Runs of samples that stay within a `band`, one after the other, each as long as it can be, but
/// for the ends that stand outside of its inner readings: there a series comes to a rest, or leaves
/// it.
fn together(values: &[f64], band: f64) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for n in 0..=values.len() {
        let next = values.get(n).map(|&x| (low.min(x), high.max(x)));
        match next {
            Some((l, h)) if h - l <= band => (low, high) = (l, h),
            _ => {
                runs.extend(inner(values, start..n));
                start = n;
                if let Some(&x) = values.get(n) {
                    (low, high) = (x, x);
                }
            }
        }
    }
    runs
}

/// The part of a run whose readings are like those of its middle; `None` for a short one.
fn inner(values: &[f64], run: Range<usize>) -> Option<Range<usize>> {
    if run.len() < SHORTEST {
        return None;
    }
    let end = run.len() / 4;
    let middle = run.start + end..run.end - end;
    let (low, high) = range(&values[middle.clone()]);
    let like = |&n: &usize| (low - (high - low)..=high + (high - low)).contains(&values[n]);
    let start = (0..middle.start).rev().take_while(like).last();
    let end = (middle.end..values.len()).take_while(like).last();
    Some(start.unwrap_or(middle.start)..end.map_or(middle.end, |n| n + 1))
}

/// Whether a series jumps from reading to reading as noise does.
fn is_rough(values: &[f64]) -> bool {
    // From the first one on, so that a little noise on a large number is not lost in a sum.
    let from_first = || values.iter().map(|x| x - values[0]);
    let mean = from_first().sum::<f64>() / values.len() as f64;
    let spread: f64 = from_first().map(|x| (x - mean).powi(2)).sum();
    let steps: f64 = values.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
    spread > 0.0 && steps >= 2.0 * ROUGH * spread
}

/// How far a series rises from a value before, at most, and how far it falls.
pub(crate) fn rise_and_fall(values: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut rise, mut fall) = (0.0_f64, 0.0_f64);
    for &value in values {
        (low, high) = (low.min(value), high.max(value));
        (rise, fall) = (rise.max(value - low), fall.max(high - value));
    }
    (rise, fall)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from -1 to 1 that look random.
    fn noise(n: usize) -> f64 {
        let turns = (n as f64 * 12.9898).sin() * 43_758.545_3;
        2.0 * (turns - turns.floor()) - 1.0
    }

    #[test]
    fn a_frozen_channel_with_noise_is_found_and_a_small_answer_is_not() {
        let input: Vec<f64> = (0..2000).map(|n| (f64::from(n) * 0.02).sin()).collect();
        for size in [1e-15, 1e-12, 1e-6, 1e-3, 4e-3] {
            let mut output = input.clone();
            for (n, y) in output.iter_mut().enumerate() {
                *y = size * noise(n) + if n < 1200 { *y } else { input[1200] };
            }
            let found = frozen(&output, &input);
            assert_eq!(found.len(), 1, "{size}: {found:?}");
            assert!(found[0].start <= 1205 && found[0].end == 2000, "{size}");
            assert_eq!(frozen(&input, &output), vec![], "{size}");
        }
        // It comes to a rest slowly.
        let slowly = |n: usize| f64::from(1200 - n.min(1200) as i32) * 5e-5;
        let mut output = input.clone();
        for (n, y) in output.iter_mut().enumerate().skip(1100) {
            *y = slowly(n) + 1e-9 * noise(n);
        }
        let found = frozen(&output, &input);
        assert!(
            matches!(
                found[..],
                [Range {
                    start: 1199..=1201,
                    end: 2000
                }]
            ),
            "{found:?}"
        );
        // A weak load: an answer of half a percent, with less noise than that.
        let weak = |n: usize| match n < 1200 {
            true => input[n],
            false => 0.0025 * input[n] + 5e-4 * noise(n),
        };
        let weak: Vec<f64> = (0..2000).map(weak).collect();
        assert_eq!(frozen(&weak, &input), vec![]);
    }

    #[test]
    fn a_frozen_channel_is_found_and_steps_are_not() {
        let input: Vec<f64> = (0..2000).map(|n| (f64::from(n) * 0.02).sin()).collect();
        let mut output = input.clone();
        let held = output[1200];
        output[1200..1500].fill(held);
        assert_eq!(frozen(&output, &input), vec![1200..1500]);
        assert_eq!(frozen(&input, &output), vec![]);
        // With noise elsewhere, inside its range, and to the end: half of the range is enough.
        let half: Vec<f64> = (0..2000)
            .map(|n| if n < 700 { input[n] } else { 0.6 * input[n] })
            .collect();
        let mut still: Vec<f64> = (0..2000).map(|n| half[n] + 1e-3 * noise(n)).collect();
        let held = still[800];
        still[800..].fill(held);
        assert_eq!(frozen(&still, &half), vec![800..2000]);
        // Without noise it may be what the material does.
        let mut plain = half.clone();
        plain[800..].fill(half[800]);
        assert_eq!(frozen(&plain, &half), vec![]);
        // A drive that is off, while the actuator goes back.
        let mut off = input.clone();
        off[1000..].fill(0.0);
        let back: Vec<f64> = (0..2000)
            .map(|n| {
                if n < 1000 {
                    input[n]
                } else {
                    1.0 - f64::from(n as i32 - 1000) / 500.0
                }
            })
            .collect();
        assert_eq!(frozen(&off, &back), vec![]);
        // Shorter than the way over the range.
        let mut short = input.clone();
        short[1200..1260].fill(held);
        assert_eq!(frozen(&short, &input), vec![]);
        // Set points among ramps, and an actuator that rings at each.
        let set = |n: usize| [0.3, 0.8, 0.2, 0.6, 0.4][n / 40 % 5];
        let ramps = |n: usize| if n < 800 { input[n] } else { set(n) };
        let ramps: Vec<f64> = (0..1000).map(ramps).collect();
        let rings = |n: usize| match n < 800 {
            true => input[n],
            false => set(n) + (1.0 - (n % 40) as f64 / 40.0) * (n as f64).cos(),
        };
        let rings: Vec<f64> = (0..1000).map(rings).collect();
        assert_eq!(frozen(&ramps, &rings), vec![]);
        // A drive in steps, and an actuator that follows each.
        let steps: Vec<f64> = (0..2000).map(|n| f64::from(n / 200 % 3)).collect();
        let slow: Vec<f64> = (0..2000).map(|n| f64::from(n % 200)).collect();
        assert_eq!(frozen(&steps, &slow), vec![]);
        assert_eq!(frozen(&[], &[]), vec![]);
    }
}
