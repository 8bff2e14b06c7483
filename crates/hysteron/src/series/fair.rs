//! The range of a series that wrong readings do not set.

use crate::series::range;
use crate::series::spikes::{DEVIATIONS, isolated};

/// Of fewer values, none is taken for far from the others.
const FEW: usize = 20;
/// Some of more than these say as well where most lie.
const MANY: usize = 50_000;
/// Where no end is further from where nine tenths of the values lie than this share of their
/// spread, no reading made the range.
const BEYOND: f64 = 0.25;
/// A reading that makes the range stands out from its neighbours by this share of it.
const SMALLEST: f64 = 0.05;
/// Of more than this share of the values, none is a single one.
const MOST: f64 = 0.05;
/// What stands beside a wrong reading is seen only when that one is gone.
const ROUNDS: usize = 4;

/// The range of finite `values`, in the order in which they were read, that wrong readings do not
/// set: up to three in a row that stand out from their neighbours; and up to a two-hundredth of the
/// values at each end, further from the others than these spread, where these spread at all. For an
/// empty slice, infinity and minus infinity.
///
/// ```
/// let mut read: Vec<f64> = (0..100).map(f64::from).collect();
/// read[50] = 5000.0;
/// read[70] = -60.0;
/// assert_eq!(hysteron::fair_range(&read), (0.0, 99.0));
/// assert_eq!(hysteron::fair_range(&read[..50]), (0.0, 49.0));
/// ```
#[must_use]
pub fn fair_range(values: &[f64]) -> (f64, f64) {
    fair(values.iter().copied())
}

/// As [`fair_range`], of the values of several series.
pub(crate) fn fair_range_of_all<'a>(
    series: impl Iterator<Item = &'a Vec<f64>> + Clone,
) -> (f64, f64) {
    fair(series.flatten().copied())
}

fn fair(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let (mut low, mut high) = range(&[]);
    let mut count = 0;
    for value in values.clone() {
        (low, high) = (low.min(value), high.max(value));
        count += 1;
    }
    if count < FEW || !is_beyond((low, high), most(values.clone(), count, 20), BEYOND) {
        return (low, high);
    }
    let values = without_single(values.collect());
    let (low, high) = range(&values);
    let inner = most(values.into_iter(), count, 200);
    let end = |end: f64, inner_end: f64| match is_beyond((end, end), inner, 1.0) {
        true => inner_end,
        false => end,
    };
    (end(low, inner.0), end(high, inner.1))
}

/// Where `count` values lie but for one in so many at each end, at least one.
fn most(values: impl Iterator<Item = f64>, count: usize, one_in: usize) -> (f64, f64) {
    let mut some: Vec<f64> = values.step_by(count.div_ceil(MANY)).collect();
    let few = (some.len() / one_in).max(1);
    let last = some.len() - 1;
    let mut nth = |n: usize| *some.select_nth_unstable_by(n, f64::total_cmp).1;
    (nth(few), nth(last - few))
}

/// Whether an end of a range is further from the others than so many times their spread.
fn is_beyond((low, high): (f64, f64), inner: (f64, f64), times: f64) -> bool {
    let far = times * (inner.1 - inner.0);
    far > 0.0 && (low < inner.0 - far || high > inner.1 + far)
}

/// The values with lines in place of the few that stand out from their neighbours.
fn without_single(values: Vec<f64>) -> Vec<f64> {
    let most = MOST * values.len() as f64;
    let (mut rest, mut replaced) = (values.clone(), 0);
    for _ in 0..ROUNDS {
        let (low, high) = range(&rest);
        let (far, without) = isolated(rest, DEVIATIONS, SMALLEST * (high - low));
        replaced += far.len();
        if replaced as f64 > most {
            return values;
        }
        rest = without;
        if far.is_empty() {
            break;
        }
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    #[test]
    fn several_series_have_the_fair_range_of_one() {
        let swing = |n: i32| 10.0 * (f64::from(n) * 0.1).sin();
        let one: Vec<f64> = (0..700).map(swing).collect();
        let mut other: Vec<f64> = (700..900).map(swing).collect();
        let clean = range(&[&one[..], &other].concat());
        assert_eq!(fair_range_of_all([&one, &other].into_iter()), clean);
        other[50] = -999.0;
        let (low, high) = fair_range_of_all([&one, &other].into_iter());
        assert_eq!((low, high), fair_range(&[&one[..], &other].concat()));
        assert!(
            (-10.0..-9.0).contains(&low) && high == clean.1,
            "{low} {high}"
        );
        // Where the others do not move, what moves is no spike.
        let mut rests = vec![4.0; 1000];
        rests[500] = 5.0;
        assert_eq!(fair_range(&rests), (4.0, 5.0));
        assert_eq!(fair_range(&[]), range(&[]));
    }

    /// Branches between random ends, with noise.
    fn swings(random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut share = || f64::from(random.next_u32()) / f64::from(u32::MAX);
        let (mut values, mut last) = (Vec::new(), 0.0);
        for n in 0..20 {
            let end = (0.3 + 0.7 * share()) * if n % 2 == 0 { 1.0 } else { -1.0 };
            let steps = 30 + (60.0 * share()) as i32;
            let at = |k: i32| last + (end - last) * f64::from(k) / f64::from(steps);
            let noise = 0.01 * share();
            values.extend((0..steps).map(|k| at(k) + noise * (share() - 0.5)));
            last = end;
        }
        values
    }

    #[test]
    fn spikes_of_any_size_do_not_make_the_range() {
        for seed in 0..60 {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let clean = swings(&mut random);
            let (low, high) = range(&clean);
            assert_eq!(fair_range(&clean), (low, high), "seed {seed}");
            let mut share = || f64::from(random.next_u32()) / f64::from(u32::MAX);
            let (size, part) = (0.3 + 2.0 * share(), 0.001 + 0.02 * share());
            let mut read = clean.clone();
            for y in &mut read {
                if share() < part {
                    *y += size * (high - low) * if share() < 0.5 { -1.0 } else { 1.0 };
                }
            }
            let (from, to) = fair_range(&read);
            let told = (to - from) / (high - low);
            assert!(
                (0.95..1.05).contains(&told),
                "seed {seed}: {told}, {size} {part}"
            );
        }
    }

    #[test]
    fn what_was_reached_once_is_in_the_range() {
        // One large loop before small ones, steps, and a peak.
        let loops = (0..2000).map(|n| match n {
            0..40 => f64::from(n),
            40..80 => f64::from(80 - n),
            _ => f64::from(n % 10),
        });
        let steps = (0..2000).map(|n| {
            if (900..905).contains(&n) {
                5.0
            } else {
                f64::from(n / 50 % 2)
            }
        });
        let peak =
            (0..2000).map(|n| (-f64::from(n - 700).powi(2) / 50.0).exp() + f64::from(n % 7) * 0.01);
        let all: [Vec<f64>; 3] = [loops.collect(), steps.collect(), peak.collect()];
        for (n, values) in all.iter().enumerate() {
            assert_eq!(without_single(values.clone()), *values, "{n}");
        }
    }
}
