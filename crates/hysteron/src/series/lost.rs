//! Finds readings that were lost: spikes, bursts of them, and stretches in which the logger went on
//! with the last reading, or with a fixed value.

use crate::series::clear_branches;
use crate::series::coarse::goes_by_jumps;
use crate::series::jumps::{Steps, remove_bursts, steps};
use crate::series::noise::median_of;
use crate::series::spikes;
use crate::series::spread::{range, usual_span};
use std::ops::Range;

/// Fewer equal readings in a row are not told from a slow signal.
const SHORTEST: usize = 4;
/// Where a series comes back, it steps so many times further than nearby.
pub(crate) const STEP: f64 = 2.0;
/// The other series moves by this share of its usual range meanwhile.
const MOVES: f64 = 0.02;
/// A series that rests for more than this share of its samples is one of steps, or a coarse one.
const RESTS: f64 = 0.02;
/// More than this share of the samples cannot be lost.
const MOST: f64 = 0.5;

/// Readings that are held for fewer samples do little to a model.
const SHORTEST_HELD: usize = 3;
/// So much of a series has to be held equally long.
const REGULAR: f64 = 0.6;
/// A reading that changes by less than this share of its range is a coarse one.
const COARSE: f64 = 0.01;
/// Steps that differ by less than this factor are alike. An answer to a set point dies away.
const ALIKE: f64 = 1.5;

/// Number of steps on either side that tell where a series goes.
const STEPS: usize = 6;

/// Rounds of the search: what stands beside a wrong reading is seen only when that one is gone.
const ROUNDS: usize = 4;

/// The samples over which a series keeps exactly one value, one run after the other.
pub(crate) fn equal_runs(values: &[f64]) -> impl Iterator<Item = Range<usize>> {
    let mut end = 0;
    values.chunk_by(|a, b| a == b).map(move |run| {
        end += run.len();
        end - run.len()..end
    })
}

/// Whether one of these runs of equal values begins where another ends: they are set points, one
/// after the other.
pub(crate) fn are_set_points(runs: &[Range<usize>], n: usize) -> bool {
    let after = n > 0 && runs[n - 1].end == runs[n].start;
    let before = n + 1 < runs.len() && runs[n].end == runs[n + 1].start;
    after || before
}

/// The samples over which `values` keeps exactly one value and then goes on elsewhere, or while
/// the series that follows it, if any, moves. None in a series that often rests.
pub(crate) fn held(values: &[f64], follower: Option<&[f64]>) -> Vec<Range<usize>> {
    let long: Vec<Range<usize>> = equal_runs(values)
        .filter(|run| run.len() >= SHORTEST)
        .collect();
    if long.is_empty() {
        return long;
    }
    let step = |n: usize| (values[n] - values[n - 1]).abs();
    let jumps = |run: &Range<usize>, n: usize| {
        let near = step_near(values, run);
        (1..values.len()).contains(&n) && near > 0.0 && step(n) > STEP * near
    };
    // A drive may rest at the end of its range, while what it moved goes back.
    let (low, high) = range(values);
    let rests = |value: f64| value == low || value == high;
    let far = MOVES * follower.map_or(0.0, usual_span);
    let is_left_behind = |run: &Range<usize>| {
        follower.is_some_and(|follower| {
            let (low, high) = range(&follower[run.clone()]);
            high - low > far && !rests(values[run.start])
        })
    };
    let lost = |run: &Range<usize>| jumps(run, run.end) || is_left_behind(run);
    let held = (0..long.len()).filter(|&n| !are_set_points(&long, n) && lost(&long[n]));
    let held: Vec<Range<usize>> = held.map(|n| long[n].clone()).collect();
    // All samples that repeat the one before, also in short runs.
    let equal = values.windows(2).filter(|pair| pair[0] == pair[1]).count();
    let count: usize = held.iter().map(Range::len).sum();
    let rests = (equal + held.len() - count) as f64;
    let len = values.len() as f64;
    if rests > RESTS * len || count as f64 > MOST * len {
        return Vec::new();
    }
    // The first reading of a run was right if the series came there by a usual step.
    let begin = |run: &Range<usize>| match jumps(run, run.start) {
        true => run.start,
        false => run.start + 1,
    };
    held.iter().map(|run| begin(run)..run.end).collect()
}

/// The number of samples for which an input is held from one reading to the next, if it is a slow
/// sensor's in a fast log: what follows it goes on as far with each sample, whether a reading is
/// held or the next one comes. `None` for set points, which it answers, and for a coarse reading.
pub(crate) fn held_between_readings(values: &[f64], follower: &[f64]) -> Option<usize> {
    let mut sorted: Vec<usize> = equal_runs(values).map(|run| run.len()).collect();
    sorted.sort_unstable();
    let usual = *sorted.get(sorted.len() / 2)?;
    let alike = sorted
        .iter()
        .filter(|length| length.abs_diff(usual) <= 1)
        .sum::<usize>();
    if usual < SHORTEST_HELD || (alike as f64) < REGULAR * values.len() as f64 {
        return None;
    }
    let step = |series: &[f64], n: usize| (series[n] - series[n - 1]).abs();
    let (low, high) = range(values);
    let mut begins: Vec<usize> = (1..values.len())
        .filter(|n| step(values, *n) > 0.0)
        .collect();
    let steps = begins.iter().map(|n| step(values, *n)).collect();
    if median_of(steps) < COARSE * (high - low) {
        return None;
    }
    begins.retain(|begin| begin + usual <= follower.len());
    let at = |place: usize| median_of(begins.iter().map(|n| step(follower, n + place)).collect());
    let places: Vec<f64> = (0..usual).map(at).collect();
    let (least, most) = range(&places);
    (least > 0.0 && most < ALIKE * least).then_some(usual)
}

/// The largest step just before and just after a run of samples.
pub(crate) fn step_near(values: &[f64], run: &Range<usize>) -> f64 {
    let step = |n: usize| (values[n] - values[n - 1]).abs();
    let before = (run.start.saturating_sub(STEPS) + 1..run.start).map(step);
    let after = (run.end + 1..values.len().min(run.end + STEPS)).map(step);
    before.chain(after).fold(0.0, f64::max)
}

/// The number of samples in a row within which a series hardly turns twice: half of what it takes
/// from one reversal to the next.
pub(crate) fn half_a_branch(values: &[f64]) -> usize {
    values.len() / (2 * clear_branches(values))
}

/// The samples whose readings are wrong, ascending: those far from where their neighbours lead by
/// more than `deviations`, and with `runs` also bursts of them, and readings that were held for no
/// longer than half a branch. `follower` is the output, for an input.
pub(crate) fn wrong(
    values: &[f64],
    follower: Option<&[f64]>,
    deviations: f64,
    runs: bool,
) -> Vec<usize> {
    replaced(values, follower, deviations, runs).0
}

/// The wrong readings of an input and of its output. Between set points both jump, and a short one
/// is as right as a long one: none is wrong then.
pub(crate) fn wrong_of_both(input: &[f64], output: &[f64]) -> [Vec<usize>; 2] {
    let deviations = spikes::usual_deviations(input.len());
    let (found, right) = replaced(input, Some(output), deviations, true);
    match goes_by_jumps(&right) {
        true => [Vec::new(), Vec::new()],
        false => [found, wrong(output, None, deviations, true)],
    }
}

/// As [`wrong`], and the series with lines in place of these readings.
fn replaced(
    read: &[f64],
    follower: Option<&[f64]>,
    deviations: f64,
    runs: bool,
) -> (Vec<usize>, Vec<f64>) {
    let mut held = match runs {
        true => held(read, follower),
        false => Vec::new(),
    };
    if !held.is_empty() {
        let longest = half_a_branch(read);
        held.retain(|run| run.len() <= longest);
    }
    let without_held = || {
        let mut values = read.to_vec();
        held.iter().for_each(|run| fill(&mut values, run));
        values
    };
    let mut values = without_held();
    let mut found = match runs {
        true => rounds(&mut values, None, deviations),
        false => spikes::remove(&mut values, deviations),
    };
    if runs && !found.is_empty() {
        // Many wrong readings make many large steps, and among those the first step of a burst may
        // look usual. What is usual is seen once they are gone.
        let usual = steps(&values);
        values = without_held();
        found = rounds(&mut values, usual, deviations);
    }
    found.extend(held.into_iter().flatten());
    found.sort_unstable();
    found.dedup();
    (found, values)
}

/// Puts lines in place of bursts and spikes, round by round. Returns their samples. Where the `usual`
/// steps are not known, each round takes those of the series.
fn rounds(values: &mut [f64], usual: Option<Steps>, deviations: f64) -> Vec<usize> {
    let mut found = Vec::new();
    for _ in 0..ROUNDS {
        let before = found.len();
        if let Some(steps) = usual.or_else(|| steps(values)) {
            found.extend(remove_bursts(values, steps));
        }
        found.extend(spikes::remove(values, deviations));
        if found.len() == before {
            break;
        }
    }
    found
}

/// Puts a line between the neighbours in place of a run of samples.
pub(crate) fn fill(values: &mut [f64], run: &Range<usize>) {
    let (before, after) = ends(values, run);
    let length = (run.len() + 1) as f64;
    for (n, value) in (1_u32..).zip(&mut values[run.clone()]) {
        *value = before + (after - before) * f64::from(n) / length;
    }
}

/// The values beside a run of samples; at an end of the series, the one on the other side.
pub(crate) fn ends(values: &[f64], run: &Range<usize>) -> (f64, f64) {
    let before = run.start.checked_sub(1).map(|n| values[n]);
    let after = values.get(run.end).copied();
    let either = before.or(after).unwrap_or(values[run.start]);
    (before.unwrap_or(either), after.unwrap_or(either))
}

/// Where a series turned between two stretches, `length` steps apart: how many steps after the
/// first, at a rise of how much a step before and after. The lines along which it went meet there.
#[derive(Debug)]
pub(crate) struct Turn {
    pub(crate) at: f64,
    pub(crate) rises: [f64; 2],
}

impl Turn {
    /// `None` if the series goes on in the same direction, or the lines do not meet in between.
    pub(crate) fn between(before: &[f64], after: &[f64], length: f64) -> Option<Self> {
        let before = &before[before.len().saturating_sub(STEPS + 1)..];
        let after = &after[..after.len().min(STEPS + 1)];
        let (Some(last), Some(first)) = (before.last(), after.first()) else {
            return None;
        };
        let [a, b] = [before, after].map(rise);
        // last + a t = first − b (length − t)
        let at = (first - last - b * length) / (a - b);
        (a * b < 0.0 && (0.0..=length).contains(&at)).then_some(Self { at, rises: [a, b] })
    }
}

/// The slope of the line through a short series, per step: the median of those between all pairs
/// (Theil 1950, Sen 1968).
fn rise(values: &[f64]) -> f64 {
    let pairs = (1..values.len()).flat_map(|n| (0..n).map(move |m| (m, n)));
    let slopes = pairs.map(|(m, n)| (values[n] - values[m]) / (n - m) as f64);
    median_of(slopes.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::test_series::swings;

    #[test]
    fn readings_that_were_held_are_found_and_rests_are_not() {
        let clean = swings();
        assert_eq!(held(&clean, None), []);
        // The last reading, and a fixed value.
        let mut read = clean.clone();
        read[300..310].fill(clean[300]);
        read[700..715].fill(3.0);
        assert_eq!(held(&read, None), [301..310, 700..715]);
        // Held over a turning point (at 1021): seen only by what follows the series.
        let mut read = clean.clone();
        read[1015..1028].fill(clean[1014]);
        assert_eq!(held(&read, None), []);
        let follower: Vec<f64> = (0..2000).map(|n| f64::from(n % 100)).collect();
        let expected = 1015..1028;
        assert_eq!(
            held(&read, Some(&follower)),
            std::slice::from_ref(&expected)
        );
        // A drive that is off; steps; a coarse reading.
        let mut off = clean.clone();
        off[1500..].fill(-40.0);
        let steps: Vec<f64> = (0..2000).map(|n| f64::from(n / 50 % 7)).collect();
        let coarse: Vec<f64> = clean.iter().map(|x| x.round()).collect();
        for rests in [off, steps, coarse, vec![1.0; 9], vec![]] {
            assert_eq!(held(&rests, Some(&follower[..rests.len()])), []);
        }
    }

    #[test]
    fn among_many_wrong_readings_a_burst_is_found_from_its_first_step_on() {
        let noise = (0..).map(|n| if n % 2 == 0 { 1.0 } else { -1.0 });
        let mut read: Vec<f64> = swings().iter().zip(noise).map(|(x, e)| x + e).collect();
        let spikes: Vec<usize> = (0..40).map(|k| 45 * k + 20).collect();
        spikes.iter().for_each(|n| read[*n] += 36.0);
        // The first step of a burst is smaller than the next one, which is taken back at its end.
        let burst = 405..415;
        let off = |n: usize| [-134.0, 85.0, 219.0, 219.0, 219.0][(n - burst.start) / 2];
        burst.clone().for_each(|n| read[n] += off(n));
        let mut wrong: Vec<usize> = spikes.into_iter().chain(burst.clone()).collect();
        wrong.sort_unstable();
        wrong.dedup();
        assert_eq!(super::wrong(&read, None, spikes::DEVIATIONS, true), wrong);
    }

    #[test]
    fn a_slow_sensor_in_a_fast_log_is_no_staircase() {
        let clean = swings();
        for every in [1, 2, 4, 6] {
            let held = |n: usize| clean[n - n % every];
            let slow: Vec<f64> = (0..clean.len()).map(held).collect();
            let found = held_between_readings(&slow, &clean);
            assert_eq!(found, (every > 2).then_some(every));
        }
        // Set points, which the output reaches at once, late, slowly or after a dead time.
        for every in [5, 10, 20] {
            let held = |n: usize| clean[n - n % every];
            let points: Vec<f64> = (0..clean.len()).map(held).collect();
            for (share, dead) in [
                (1.0, 0),
                (0.7, 0),
                (1.0, 1),
                (0.3, 2),
                (1.0 / every as f64, 0),
            ] {
                let mut late = points.clone();
                for n in 1..late.len() {
                    let wanted = points[n.saturating_sub(dead)];
                    late[n] = late[n - 1] + share * (wanted - late[n - 1]);
                }
                let found = held_between_readings(&points, &late);
                assert_eq!(found, None, "every {every}, {share}, {dead}");
            }
        }
        // A coarse reading.
        let coarse: Vec<f64> = clean.iter().map(|x| x.round()).collect();
        assert_eq!(held_between_readings(&coarse, &clean), None);
        let ramps: Vec<f64> = (0..4000)
            .map(|n: i32| f64::from((n % 2000 - 1000).abs()))
            .collect();
        let coarse: Vec<f64> = ramps.iter().map(|x| (x / 4.0).floor()).collect();
        assert_eq!(held_between_readings(&coarse, &ramps), None);
        assert_eq!(held_between_readings(&[], &[]), None);
    }

    #[test]
    fn a_series_turns_where_its_ways_meet() {
        let rising: Vec<f64> = (0..10).map(f64::from).collect();
        let falling: Vec<f64> = (0..10).map(|n| 12.0 - 2.0 * f64::from(n)).collect();
        // From 9 on for 5 steps to 14, and from there back for 1 step.
        let turn = Turn::between(&rising, &falling, 6.0).map(|turn| (turn.at, turn.rises));
        assert_eq!(turn, Some((5.0, [1.0, -2.0])));
        assert!(Turn::between(&rising, &rising, 6.0).is_none());
        assert!(Turn::between(&rising, &falling, 1.0).is_none());
        assert!(Turn::between(&[], &falling, 1.0).is_none());
    }
}
