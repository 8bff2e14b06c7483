//! Turning points of a series, found while small reversals are ignored as noise.

use crate::series::spread::usual_span;
use hysteron_core::Direction;
use std::iter::repeat_n;
use std::ops::Range;

/// The default tolerance as a share of a range. Smaller reversals are noise: they are not counted,
/// and the inverse does not follow them.
pub const NOISE: f64 = 0.01;

/// The default tolerance of a series: [`NOISE`] times its range; 0 for an empty series.
#[must_use]
pub fn usual_tolerance(series: &[f64]) -> f64 {
    let (low, high) = crate::series::spread::range(series);
    NOISE * (high - low).max(0.0)
}

/// Finds the turning points of a series, sample by sample. An extreme counts as a turning point
/// once the series has moved back from it by more than `tolerance`.
///
/// ```
/// use hysteron::{Direction, Turning};
/// let mut turning = Turning::new(0.5);
/// let series = [0.0, 1.0, 0.9, 2.0, 1.9, 0.0];
/// let found: Vec<_> = series.iter().filter_map(|&y| turning.push(y)).collect();
/// assert_eq!(found, [(0, Direction::Rising), (3, Direction::Falling)]);
/// ```
#[derive(Debug, Clone)]
pub struct Turning {
    tolerance: f64,
    count: usize,
    low: (usize, f64),
    high: (usize, f64),
    heading: Option<Direction>,
}

impl Turning {
    /// A search that ignores reversals up to `tolerance`.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            count: 0,
            low: (0, f64::INFINITY),
            high: (0, f64::NEG_INFINITY),
            heading: None,
        }
    }

    /// Takes the next sample. If it confirms a turning point, returns the index of that point and
    /// the direction of the series from there. The start of the series counts as a turning point.
    pub fn push(&mut self, y: f64) -> Option<(usize, Direction)> {
        let n = self.count;
        self.count += 1;
        if y < self.low.1 {
            self.low = (n, y);
        }
        if y > self.high.1 {
            self.high = (n, y);
        }
        use Direction::{Falling, Rising};
        let (turn, heading) = if self.heading != Some(Falling) && self.high.1 - y > self.tolerance {
            (self.high.0, Falling)
        } else if self.heading != Some(Rising) && y - self.low.1 > self.tolerance {
            (self.low.0, Rising)
        } else {
            return None;
        };
        let first = self.heading.replace(heading).is_none();
        // The search for the next extreme starts here.
        (self.low, self.high) = ((n, y), (n, y));
        Some((if first { 0 } else { turn }, heading))
    }

    /// The direction of the current branch, once it is known, and the index of its extreme so far.
    /// Up to this index the series is certainly on this branch.
    #[must_use]
    pub fn branch(&self) -> Option<(Direction, usize)> {
        self.heading.map(|heading| match heading {
            Direction::Rising => (heading, self.high.0),
            Direction::Falling => (heading, self.low.0),
        })
    }
}

/// The branch of each sample, counted from 0. A branch ends where the series turns by more than
/// `tolerance`. The turning point belongs to the branch before it.
///
/// ```
/// let series = [0.0, 2.0, 4.0, 3.9, 4.0, 1.0, 3.0];
/// assert_eq!(hysteron::branches(&series, 0.5), [0, 0, 0, 1, 1, 1, 2]);
/// ```
#[must_use]
pub fn branches(series: &[f64], tolerance: f64) -> Vec<usize> {
    let spans = branch_spans(series, tolerance).enumerate();
    let of_each = spans.flat_map(|(branch, samples)| repeat_n(branch, samples.len()));
    of_each.collect()
}

/// As [`branches`], but the samples of each branch.
pub(crate) fn branch_spans(series: &[f64], tolerance: f64) -> impl Iterator<Item = Range<usize>> {
    let mut turning = Turning::new(tolerance);
    let turns = series.iter().filter_map(move |&x| turning.push(x));
    // The start is reported as a turning point, but it ends no branch. A turn at the last sample
    // ends none either.
    let inside = turns.map(|(n, _)| n + 1);
    let inside = inside.filter(|end| (2..series.len()).contains(end));
    let last = (!series.is_empty()).then_some(series.len());
    let spans = inside.chain(last).scan(0, |start, end| {
        let samples = *start..end;
        *start = end;
        Some(samples)
    });
    // With a tolerance below zero a sample may turn twice.
    spans.filter(|samples| !samples.is_empty())
}

/// A clear reversal is larger than this share of the usual range.
const CLEAR: f64 = 0.05;

/// The branches between clear reversals.
pub(crate) fn clear_branch_spans(series: &[f64]) -> impl Iterator<Item = Range<usize>> {
    branch_spans(series, CLEAR * usual_span(series))
}

/// Their number; at least one.
pub(crate) fn clear_branches(series: &[f64]) -> usize {
    clear_branch_spans(series).count().max(1)
}

/// The number of branches between clear reversals that are unlike each other: that begin or end at
/// places further apart than a clear reversal. At least one.
pub(crate) fn different_branches<'a>(all: impl IntoIterator<Item = &'a [f64]>) -> usize {
    let all: Vec<&[f64]> = all.into_iter().collect();
    let clear = CLEAR * all.iter().map(|one| usual_span(one)).fold(0.0, f64::max);
    let mut known: Vec<(f64, f64)> = Vec::new();
    for series in all {
        for samples in branch_spans(series, clear) {
            let (from, to) = (
                series[samples.start.saturating_sub(1)],
                series[samples.end - 1],
            );
            let is_alike =
                |(a, b): &(f64, f64)| (a - from).abs() <= clear && (b - to).abs() <= clear;
            if !known.iter().any(is_alike) {
                known.push((from, to));
            }
        }
    }
    known.len().max(1)
}

/// The indices of the samples that hysteresis operators remember at the end of a series, ascending.
///
/// The first is the largest or the smallest sample of all, whichever comes first. Then follow, in
/// turn, the extremes that no later sample reaches. The last sample is always among them. From all
/// operators off or all on, these samples alone lead to the same operator states as the whole
/// series (return-point memory: Mayergoyz 2003, section 1.2).
///
/// ```
/// assert_eq!(hysteron::remembered(&[0.0, 5.0, 2.0, 4.0, 1.0, 3.0, 2.5]), [0, 1, 4, 5, 6]);
/// ```
#[must_use]
pub fn remembered(series: &[f64]) -> Vec<usize> {
    let extreme = |from: usize, high: bool| {
        let rest = series.iter().enumerate().skip(from);
        let better = |a: f64, b: f64| if high { a >= b } else { a <= b };
        rest.fold(None, |best: Option<(usize, f64)>, (n, &x)| match best {
            Some((_, b)) if !better(x, b) => best,
            _ => Some((n, x)),
        })
        .map(|(n, _)| n)
    };
    let mut high = extreme(0, true) < extreme(0, false);
    let mut found: Vec<usize> = Vec::new();
    while let Some(n) = extreme(found.last().map_or(0, |last| last + 1), high) {
        found.push(n);
        high = !high;
    }
    found
}

/// For each sample of a series, the direction that the series takes next. An extreme belongs to the
/// branch before it.
///
/// The direction of a sample is known only after the series has moved on. So it is returned some
/// samples later. At most `capacity` samples wait; beyond that, the oldest is returned without a
/// direction.
#[derive(Debug, Clone)]
pub struct Headings {
    turning: Turning,
    capacity: usize,
    released: usize,
}

impl Headings {
    /// Looks at most `capacity` samples ahead and ignores reversals up to `tolerance`.
    #[must_use]
    pub fn new(tolerance: f64, capacity: usize) -> Self {
        Self {
            turning: Turning::new(tolerance),
            capacity,
            released: 0,
        }
    }

    /// Takes the next sample and returns the directions that are now known, in order. Each pair is
    /// a direction and the number of samples that it holds for.
    #[must_use]
    pub fn push(&mut self, y: f64) -> [(Option<Direction>, usize); 2] {
        let before = self.turning.branch().map(|(heading, _)| heading);
        let turn = self.turning.push(y);
        let mut result = [(None, 0); 2];
        if let Some((index, _)) = turn {
            result[0] = (before, self.release(if index == 0 { 0 } else { index + 1 }));
        }
        result[1] = match self.turning.branch() {
            Some((heading, extreme)) => (Some(heading), self.release(extreme + 1)),
            None => (None, 0),
        };
        // The queue is full only while the series stays away from its extreme. Then nothing was
        // released above.
        let waiting = self.turning.count - self.released;
        if waiting > self.capacity {
            result[1] = (None, self.release(self.released + waiting - self.capacity));
        }
        result
    }

    /// The direction of the samples that still wait at the end of the series, and their number.
    #[must_use]
    pub fn finish(mut self) -> (Option<Direction>, usize) {
        let count = self.release(self.turning.count);
        (self.turning.heading, count)
    }

    /// The directions of all samples of a series.
    #[must_use]
    pub fn all(mut self, series: &[f64]) -> Vec<Option<Direction>> {
        let mut result = Vec::with_capacity(series.len());
        for &y in series {
            for (heading, count) in self.push(y) {
                result.extend(std::iter::repeat_n(heading, count));
            }
        }
        let (heading, count) = self.finish();
        result.extend(std::iter::repeat_n(heading, count));
        result
    }

    fn release(&mut self, up_to: usize) -> usize {
        let count = up_to.saturating_sub(self.released);
        self.released += count;
        count
    }
}

/// The direction of each sample of a whole series; see [`Headings`].
#[must_use]
pub fn headings(series: &[f64], tolerance: f64) -> Vec<Option<Direction>> {
    Headings::new(tolerance, series.len()).all(series)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Direction::{Falling, Rising};

    #[test]
    fn an_extreme_belongs_to_the_branch_before_it() {
        let series = [0.0, 1.0, 2.0, 3.0, 3.0, 2.9, 1.0, 0.5, 2.0];
        let expected = [
            Rising, Rising, Rising, Rising, Falling, Falling, Falling, Falling, Rising,
        ];
        assert_eq!(headings(&series, 0.5), expected.map(Some));
        assert_eq!(headings(&[1.0, 1.1, 0.9], 0.5), [None; 3]);
        assert_eq!(headings(&[], 0.5), []);
    }

    /// Compares with the definition: the number of turning points before each sample.
    #[test]
    fn branches_end_at_turning_points() {
        use rand::{RngExt, SeedableRng};
        for round in 0..2000 {
            let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(round);
            let values = (0..rng.random_range(0..12)).map(|_| f64::from(rng.random_range(0..5)));
            let series: Vec<f64> = values.collect();
            let tolerance = [0.0, 0.5, 1.5, -1.0][rng.random_range(0..4)];
            let mut turning = Turning::new(tolerance);
            let mut turns: Vec<usize> = series
                .iter()
                .filter_map(|&x| turning.push(x))
                .map(|(n, _)| n)
                .filter(|n| *n > 0)
                .collect();
            turns.dedup();
            let branch = |n: usize| turns.iter().filter(|turn| **turn < n).count();
            let expected: Vec<usize> = (0..series.len()).map(branch).collect();
            assert_eq!(branches(&series, tolerance), expected, "{series:?}");
            let count = expected.last().map_or(0, |last| last + 1);
            assert_eq!(branch_spans(&series, tolerance).count(), count);
            assert!(branch_spans(&series, tolerance).all(|samples| !samples.is_empty()));
        }
    }

    /// Compares with the definition: from each extreme, look for the next one in the whole series.
    #[test]
    fn turning_points_of_a_long_series() {
        let legs = [0.0, 9.0, 2.0, 8.0, 1.0, 5.0, 3.0, 4.0, 3.5, 9.0];
        let mut series = vec![legs[0]];
        for pair in legs.windows(2) {
            let wiggle = |n: i32| if n % 2 == 0 { 0.1 } else { 0.0 };
            series.extend((1..=50).map(|n| {
                pair[0] + (pair[1] - pair[0]) * f64::from(n) / 50.0
                    - wiggle(n) * f64::from(50 - n) / 50.0
            }));
        }
        let mut turning = Turning::new(0.75);
        let found: Vec<_> = series.iter().filter_map(|&y| turning.push(y)).collect();
        let values: Vec<f64> = found.iter().map(|(n, _)| series[*n]).collect();
        // The wiggle from 4.0 to 3.5 and back is within the tolerance.
        let expected = [0.0, 9.0, 2.0, 8.0, 1.0, 5.0, 3.0];
        assert_eq!(values.len(), expected.len(), "{values:?}");
        for (value, expected) in values.iter().zip(expected) {
            assert!((value - expected).abs() <= 0.1, "{values:?}");
        }
    }

    #[test]
    fn what_is_remembered_leaves_every_operator_where_it_was() -> crate::error::Result<()> {
        let plane = crate::model::Plane::new(1.0, 9.0, 9)?;
        let (operator, sign) = (hysteron_core::Operator::Mkp, crate::model::Sign::Positive);
        let model = crate::model::Operators::new(operator, plane, vec![1.0; 45], 0.0, sign)?;
        let mut n = 1_u64;
        for length in 1..200 {
            let mut series = Vec::new();
            for _ in 0..length {
                n = n.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                series.push((n >> 40) as f64 * 11.0 / f64::from(1 << 24));
            }
            let kept: Vec<f64> = remembered(&series).iter().map(|n| series[*n]).collect();
            for start in [model.start(), model.saturated()] {
                let (mut whole, mut short) = (start.clone(), start);
                model.run(&mut whole, &series, &mut vec![0.0; length])?;
                model.run(&mut short, &kept, &mut vec![0.0; kept.len()])?;
                for (i, j) in hysteron_core::operators(9) {
                    assert_eq!(whole.gamma(i, j)?, short.gamma(i, j)?, "{series:?}");
                }
            }
        }
        assert!(remembered(&[]).is_empty());
        Ok(())
    }

    #[test]
    fn waiting_is_bounded() {
        let mut look = Headings::new(0.5, 3);
        let mut out = Vec::new();
        for y in [0.0, 1.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 1.0] {
            for (heading, count) in look.push(y) {
                out.extend(std::iter::repeat_n(heading, count));
            }
        }
        // Three samples of the plateau wait when the turning point becomes known. The two before
        // them were released without a direction.
        let known = [Some(Rising); 3]
            .into_iter()
            .chain([None; 2])
            .chain([Some(Falling); 4]);
        assert_eq!(out, known.collect::<Vec<_>>());
    }
}
