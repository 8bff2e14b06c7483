//! The shrinking spiral: the order of turning points that determines all operators with the
//! shortest travel. Positions are on the grid: `0` is the bottom of the plane, `k` its level `k`.
//!
//! At the start every operator is off. A rise from `q` to `p` shows the Everett corners `C[q+1][q]
//! … C[p][q]`. A fall from `p` to `q` shows `C[p][p−1] … C[p][q]`. Each step of one level shows one
//! corner. The corners with `q < p` are `N = K(K + 1)/2` numbers. All weights follow from them as
//! second differences.
//!
//! **No profile that turns at levels is shorter.** Along one step between neighbouring levels the
//! output is linear. So a step adds at most one equation, and `N` unknown weights need `N` steps, a
//! travel of `N ΔT`. The spiral `0, K, 1, K−1, 2, …` needs no more: its legs have `K, K−1, …, 1`
//! steps, and no step repeats a corner. `C[p][q]` belongs to the rise from `q` if `p + q ≤ K`,
//! otherwise to the fall from `p`.
//!
//! A path that repeats no corner never closes a loop, because the step that closes a loop shows
//! again what the fall before has shown. So such a path is this spiral, and it ends at `⌈K/2⌉`.
//! Rises minus falls equal the end position. So the time `R/heating + F/cooling` has
//! `R = (N + ⌈K/2⌉)/2` and `F = (N − ⌈K/2⌉)/2`. With slow cooling, an end at `K` would save at most
//! `K/4` of about `K²/4` falls. A search over all paths up to `K = 5`, for ratios of the rates from
//! 1/10 to 100, found nothing faster than the spiral.
//!
//! If a path turned between levels, one step could show two combinations of corners, each at a part
//! of its size. That needs fewer steps in principle, but noise has more effect. A full set of
//! first-order reversal curves travels `K(K + 1)`, twice as much.

use hysteron_core::{operator_count, operator_index};

/// The turning points of the full spiral, including the start at 0.
pub(super) fn full(levels: usize) -> Vec<usize> {
    between(levels, 1)
}

/// A spiral from 0 whose first maximum is `max` and whose first minimum is `min`.
fn between(max: usize, min: usize) -> Vec<usize> {
    let turn = |n: usize| match n {
        0 => 0,
        n if n % 2 == 0 => min + n / 2 - 1,
        n => max - n / 2,
    };
    (0..max + 2 - min).map(turn).collect()
}

/// Turning points that show all corners that are not `known`. Two spirals are compared: the full
/// one and the smallest one that is sufficient. Known parts are removed from both, and the shorter
/// result is taken. It is short, but not proven to be the shortest.
pub(super) fn completing(levels: usize, known: &Corners) -> Vec<usize> {
    let all = operator_count(levels);
    let mut spirals: Vec<Vec<usize>> = (1..=levels)
        .flat_map(|max| (1..=max).map(move |min| between(max, min)))
        .collect();
    spirals.sort_by_key(|turns| travel(turns));
    let enough = spirals
        .into_iter()
        .find(|turns| known.with(turns).count() == all);
    let pruned = [enough, Some(full(levels))]
        .into_iter()
        .flatten()
        .map(|turns| prune(turns, known));
    pruned.min_by_key(|turns| travel(turns)).unwrap_or_default()
}

/// Which corners `C[p][q]` are known. Each is at the index of the weight `(q + 1, p)`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Corners(pub(super) Vec<bool>);

impl Corners {
    pub(super) fn none(levels: usize) -> Self {
        Self(vec![false; operator_count(levels)])
    }

    pub(super) fn count(&self) -> usize {
        self.0.iter().filter(|known| **known).count()
    }

    /// Adds the corners that a leg shows and returns how many of them are new. The path must not
    /// close a loop.
    pub(super) fn add(&mut self, from: usize, to: usize) -> usize {
        let mut new = 0;
        for step in from.min(to)..from.max(to) {
            let (p, q) = if from < to {
                (step + 1, from)
            } else {
                (from, step)
            };
            let known = &mut self.0[operator_index(q + 1, p)];
            new += usize::from(!std::mem::replace(known, true));
        }
        new
    }

    fn with(&self, turns: &[usize]) -> Self {
        let mut sum = self.clone();
        for leg in turns.windows(2) {
            sum.add(leg[0], leg[1]);
        }
        sum
    }
}

/// `turns` without the parts that show only `known` corners. Whole rings are removed, the others
/// are shortened.
///
/// Removing turning points from a nested path only removes corners from what it shows. So it is
/// sufficient to remove one pair at a time.
fn prune(mut turns: Vec<usize>, known: &Corners) -> Vec<usize> {
    let wanted = known.with(&turns);
    while let Some(shorter) = without_a_pair(&turns)
        .filter(|shorter| known.with(shorter) == wanted)
        .min_by_key(|shorter| travel(shorter))
    {
        turns = shorter;
    }
    for at in (1..turns.len()).rev() {
        while let Some(shorter) = shortened(&turns, at).filter(|s| known.with(s) == wanted) {
            turns = shorter;
        }
    }
    turns
}

/// All variants of `turns` with two neighbours removed, which keeps the rest nested, and the
/// variant without the last one.
fn without_a_pair(turns: &[usize]) -> impl Iterator<Item = Vec<usize>> + '_ {
    (1..turns.len()).map(|at| {
        let mut shorter = turns.to_vec();
        shorter.drain(at..(at + 2).min(turns.len()));
        shorter
    })
}

/// `turns` with the one at `at` moved one step towards the one before; `None` if they would not
/// stay nested.
fn shortened(turns: &[usize], at: usize) -> Option<Vec<usize>> {
    let mut shorter = turns.to_vec();
    let rising = turns[at] > turns[at - 1];
    let moved = if rising { turns[at] - 1 } else { turns[at] + 1 };
    if moved == turns[at - 1] {
        if at + 1 < turns.len() {
            return None;
        }
        shorter.pop();
        return Some(shorter);
    }
    let outside = |inner: &usize| {
        if rising {
            moved > *inner
        } else {
            moved < *inner
        }
    };
    if !turns.iter().skip(at + 1).take(2).all(outside) {
        return None;
    }
    shorter[at] = moved;
    Some(shorter)
}

fn travel(turns: &[usize]) -> usize {
    turns.windows(2).map(|leg| leg[0].abs_diff(leg[1])).sum()
}

/// The `count` rings of `turns` (a maximum and the minimum after it) that are spread most evenly.
/// The outermost is always among them. The order is bit-reversed (van der Corput 1935), so a larger
/// `count` only adds rings.
pub(super) fn evenly(turns: &[usize], count: usize) -> Vec<usize> {
    let Some((&start, rest)) = turns.split_first() else {
        return Vec::new();
    };
    let rings: Vec<&[usize]> = rest.chunks(2).collect();
    let mut order: Vec<usize> = (0..rings.len()).collect();
    order.sort_by_key(|ring| ring.reverse_bits());
    order.truncate(count);
    order.sort_unstable();
    let kept = order
        .into_iter()
        .flat_map(|ring| rings[ring].iter().copied());
    std::iter::once(start).chain(kept).collect()
}

/// Number of rings in `turns`.
pub(super) fn rings(turns: &[usize]) -> usize {
    turns.len().saturating_sub(1).div_ceil(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spiral_meets_the_lower_bound() {
        for levels in 2..60 {
            let turns = full(levels);
            assert_eq!(travel(&turns), operator_count(levels));
            assert_eq!(
                Corners::none(levels).with(&turns).count(),
                operator_count(levels)
            );
            assert_eq!(turns.last(), Some(&levels.div_ceil(2)));
        }
        assert_eq!(full(5), [0, 5, 1, 4, 2, 3]);
    }

    #[test]
    fn what_is_known_is_left_out_and_nothing_else() {
        let levels = 9;
        let nothing = Corners::none(levels);
        assert_eq!(prune(full(levels), &nothing), full(levels));
        let all = nothing.with(&full(levels));
        assert_eq!(prune(full(levels), &all), [0]);
        // Each single missing corner is reached, by a short path.
        for p in 1..=levels {
            for q in 0..p {
                let mut known = all.clone();
                known.0[operator_index(q + 1, p)] = false;
                let turns = prune(full(levels), &known);
                assert_eq!(known.with(&turns), all, "({p}, {q}): {turns:?}");
                assert!(travel(&turns) <= 3 * levels, "({p}, {q}): {turns:?}");
            }
        }
        // After the major loop, the corners of a plane with one level less are left.
        let known = nothing.with(&[0, levels, 1]);
        let turns = completing(levels, &known);
        assert_eq!(turns, between(levels - 1, 1));
        assert_eq!(known.with(&turns), all);
        assert_eq!(completing(levels, &all), [0]);
    }

    #[test]
    fn more_rings_show_what_fewer_do() {
        for levels in [2, 3, 8, 21] {
            let turns = full(levels);
            let mut before = Corners::none(levels);
            for count in 1..=rings(&turns) {
                let some = evenly(&turns, count);
                assert_eq!(some[..2], [0, levels]);
                let shown = Corners::none(levels).with(&some);
                assert_eq!(shown.with(&evenly(&turns, count - 1)), shown);
                assert!(shown.count() > before.count());
                // They are covered exactly: no step is used twice.
                assert_eq!(shown.count(), travel(&some));
                before = shown;
            }
            assert_eq!(evenly(&turns, rings(&turns)), turns);
        }
    }
}
