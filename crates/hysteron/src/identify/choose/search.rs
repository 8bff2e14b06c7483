//! The search for the best strengths of the smoothness at one number of levels: a walk on a grid of
//! decades, from where fewer levels ended.

use crate::error::Result;
use crate::model::Smooth;
use std::collections::BTreeMap;

/// Decades of the strengths on the grid; the first element of each row is no smoothness.
const ALONG: std::ops::RangeInclusive<i32> = -10..=-3;
const ACROSS: std::ops::RangeInclusive<i32> = -10..=-5;

/// A place on the grid: 0 is no smoothness, `n` the `n`-th decade.
pub(super) type Point = (usize, usize);

/// A way from a place to a neighbour.
pub(super) type Step = (isize, isize);

/// The neighbours on the axes.
pub(super) const ALONG_AXES: [Step; 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];

/// All neighbours.
pub(super) const AROUND: [Step; 8] = [
    (1, 0),
    (-1, 0),
    (0, 1),
    (0, -1),
    (1, 1),
    (-1, -1),
    (1, -1),
    (-1, 1),
];

/// Every third place in each direction, where the first walk looks.
const FIRST: [usize; 3] = [0, 3, 6];

pub(super) fn smooth_at(place: Point) -> Smooth {
    let at = |place: usize, decades: std::ops::RangeInclusive<i32>| match place {
        0 => 0.0,
        n => 10_f64.powi(decades.start() + n as i32 - 1),
    };
    Smooth {
        along: at(place.0, ALONG),
        across: at(place.1, ACROSS),
    }
}

/// The place of strengths on the grid.
pub(super) fn place_of(smooth: Smooth) -> Option<Point> {
    let all = (0..=ALONG.count()).flat_map(|a| (0..=ACROSS.count()).map(move |c| (a, c)));
    all.into_iter().find(|place| smooth_at(*place) == smooth)
}

/// Walks to a place where no neighbour has a smaller `value`, from the best of `from` (a coarse
/// grid, if that is empty). `steps` lead to the neighbours. Whether the walk goes on from one value
/// to the next is said by `goes_on`, for the first with infinity as the one before. Returns the
/// values of all places it looked at.
pub(super) fn walk(
    from: &[Point],
    steps: &[Step],
    goes_on: impl Fn(f64, f64) -> bool,
    mut value: impl FnMut(Point) -> Result<f64>,
) -> Result<BTreeMap<Point, f64>> {
    let most = |decades: std::ops::RangeInclusive<i32>| decades.count();
    let (along, across) = (most(ALONG), most(ACROSS));
    let mut known: BTreeMap<Point, f64> = BTreeMap::new();
    let coarse: Vec<Point> = FIRST
        .iter()
        .flat_map(|a| FIRST.map(|c| (*a, c.min(across))))
        .collect();
    for &place in if from.is_empty() { &coarse[..] } else { from } {
        known.insert(place, value(place)?);
    }
    let mut before = f64::INFINITY;
    loop {
        let Some(best) = best(&known) else {
            return Ok(known);
        };
        if !goes_on(before, known[&best]) {
            return Ok(known);
        }
        before = known[&best];
        let near = |&(a, c): &Step| {
            let a = best.0.checked_add_signed(a)?;
            let c = best.1.checked_add_signed(c)?;
            (a <= along && c <= across).then_some((a, c))
        };
        let new: Vec<Point> = steps
            .iter()
            .filter_map(near)
            .filter(|place| !known.contains_key(place))
            .collect();
        if new.is_empty() {
            return Ok(known);
        }
        for place in new {
            known.insert(place, value(place)?);
        }
    }
}

pub(super) fn best(known: &BTreeMap<Point, f64>) -> Option<Point> {
    let least = known.iter().min_by(|a, b| a.1.total_cmp(b.1));
    least.map(|(place, _)| *place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_walk_finds_the_bottom_of_a_bowl_anywhere() -> Result<()> {
        for bottom in [(0, 0), (8, 6), (3, 4), (7, 0), (0, 6)] {
            let bowl = |(a, c): Point| {
                Ok((a as f64 - bottom.0 as f64).powi(2) + (c as f64 - bottom.1 as f64).powi(2))
            };
            for from in [vec![], vec![(0, 0)], vec![(8, 6), (1, 1)]] {
                for steps in [&AROUND[..], &ALONG_AXES] {
                    let found = best(&walk(&from, steps, |_, _| true, bowl)?);
                    assert_eq!(found, Some(bottom), "from {from:?}");
                }
            }
        }
        Ok(())
    }

    #[test]
    fn the_walk_ends_where_it_is_told_to() -> Result<()> {
        let slope = |(a, c): Point| Ok(100.0 - (a + c) as f64);
        let known = walk(&[(0, 0)], &ALONG_AXES, |_, value| value > 98.0, slope)?;
        assert_eq!(best(&known), Some((0, 2)));
        let known = walk(&[(0, 0)], &ALONG_AXES, |_, _| false, slope)?;
        assert_eq!(known.len(), 1);
        Ok(())
    }

    #[test]
    fn places_are_decades() {
        assert_eq!(smooth_at((0, 0)), Smooth::NONE);
        for place in [(0, 0), (1, 6), (8, 0), (3, 4)] {
            assert_eq!(place_of(smooth_at(place)), Some(place));
        }
        assert_eq!(place_of(Smooth::from(3e-7)), None);
        let found = smooth_at((1, 6));
        // Powers of ten, rounded.
        assert!((found.along * 1e10 - 1.0).abs() < 1e-12);
        assert!((found.across * 1e5 - 1.0).abs() < 1e-12);
    }
}
