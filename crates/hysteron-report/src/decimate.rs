//! Fewer points for the same picture.
//!
//! Points are in pixels. A point that is not finite breaks the line, so every function returns the unbroken pieces.

use std::collections::HashSet;

/// A point in pixels.
pub(crate) type Point = [f64; 2];

/// Beyond this many points, loops drop the segments that lie on pixels already drawn.
const DENSE: usize = 20_000;

/// For curves over time: of the consecutive points in one pixel column keep the first, lowest, highest and last, so that
/// no peak is lost and at most four points a column remain.
pub(crate) fn columns(points: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    pieces(points)
        .into_iter()
        .map(|piece| {
            piece
                .chunk_by(|a, b| a[0].floor() == b[0].floor())
                .flat_map(extremes)
                .collect()
        })
        .collect()
}

/// First, lowest, highest and last of a column, in the order of time.
fn extremes(column: &[Point]) -> Vec<Point> {
    let by_height = |a: &usize, b: &usize| column[*a][1].total_cmp(&column[*b][1]);
    let lowest = (0..column.len()).min_by(by_height);
    let highest = (0..column.len()).max_by(by_height);
    let mut kept: Vec<usize> = [Some(0), lowest, highest, column.len().checked_sub(1)]
        .into_iter()
        .flatten()
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|k| column[k]).collect()
}

/// For curves that are no function of x: drop points closer than half a pixel to the last one kept, except the extremes.
pub(crate) fn loops(points: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    let thinned: Vec<Vec<Point>> = pieces(points).iter().map(|piece| thin(piece)).collect();
    if thinned.iter().map(Vec::len).sum::<usize>() <= DENSE {
        return thinned;
    }
    uncovered(&thinned)
}

fn thin(piece: &[Point]) -> Vec<Point> {
    let mut keep = vec![false; piece.len()];
    for axis in 0..2 {
        let along = |a: &usize, b: &usize| piece[*a][axis].total_cmp(&piece[*b][axis]);
        for extreme in [
            (0..piece.len()).min_by(along),
            (0..piece.len()).max_by(along),
        ]
        .into_iter()
        .flatten()
        {
            keep[extreme] = true;
        }
    }
    let mut last: Option<Point> = None;
    let mut kept = Vec::new();
    for (k, &point) in piece.iter().enumerate() {
        let far = last.is_none_or(|last| distance(last, point) >= 0.5);
        if far || keep[k] || k + 1 == piece.len() {
            kept.push(point);
            last = Some(point);
        }
    }
    kept
}

/// The segments that touch at least one pixel that no earlier segment has touched.
fn uncovered(pieces: &[Vec<Point>]) -> Vec<Vec<Point>> {
    let mut drawn: HashSet<(i32, i32)> = HashSet::new();
    let mut kept: Vec<Vec<Point>> = Vec::new();
    for piece in pieces {
        let mut run: Vec<Point> = Vec::new();
        for pair in piece.windows(2) {
            let &[from, to] = pair else { continue };
            let steps = distance(from, to).ceil().max(1.0) as usize;
            let mut new = false;
            for step in 0..=steps {
                let share = step as f64 / steps as f64;
                let at =
                    |axis: usize| (from[axis] + share * (to[axis] - from[axis])).floor() as i32;
                new |= drawn.insert((at(0), at(1)));
            }
            if !new {
                kept.extend((!run.is_empty()).then(|| std::mem::take(&mut run)));
                continue;
            }
            if run.is_empty() {
                run.push(from);
            }
            run.push(to);
        }
        kept.extend((!run.is_empty()).then_some(run));
    }
    kept
}

fn pieces(points: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    let mut pieces = vec![Vec::new()];
    for point in points {
        if point.iter().all(|coordinate| coordinate.is_finite()) {
            if let Some(piece) = pieces.last_mut() {
                piece.push(point);
            }
        } else {
            pieces.push(Vec::new());
        }
    }
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_of_one_sample_survives() {
        let mut points: Vec<Point> = (0..1_000_000)
            .map(|k| [k as f64 * 600.0 / 1e6, 0.0])
            .collect();
        points[123_457][1] = 300.0;
        points[777_777][1] = -40.0;
        let drawn = columns(points.into_iter());
        assert_eq!(drawn.len(), 1);
        assert!(drawn[0].len() <= 4 * 601, "{} points", drawn[0].len());
        assert!(drawn[0].iter().any(|point| point[1] == 300.0));
        assert!(drawn[0].iter().any(|point| point[1] == -40.0));
        assert!(drawn[0].is_sorted_by(|a, b| a[0] <= b[0]));
    }

    #[test]
    fn a_gap_stays_a_gap() {
        let drawn = columns([[0.0, 0.0], [1.0, f64::NAN], [2.0, 0.0]].into_iter());
        assert_eq!(drawn, [vec![[0.0, 0.0]], vec![[2.0, 0.0]]]);
        assert!(columns([[f64::NAN, 0.0]].into_iter()).is_empty());
    }

    #[test]
    fn loops_keep_their_extremes() {
        let circle = (0..100_000)
            .map(|k| (k as f64 * 0.001).sin_cos())
            .map(|(s, c)| [300.0 + 200.0 * c, 200.0 + 150.0 * s]);
        let all: Vec<Point> = circle.collect();
        let drawn = loops(all.iter().copied()).concat();
        assert!(drawn.len() < all.len());
        for axis in 0..2 {
            let low =
                |points: &[Point]| points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let high = |points: &[Point]| {
                points
                    .iter()
                    .map(|p| p[axis])
                    .fold(f64::NEG_INFINITY, f64::max)
            };
            // What lies on a pixel drawn already may go: half a pixel cannot be seen.
            assert!((low(&drawn) - low(&all)).abs() < 0.5);
            assert!((high(&drawn) - high(&all)).abs() < 0.5);
        }
    }

    #[test]
    fn a_million_repeated_loops_stay_small() {
        let all = (0..1_000_000)
            .map(|k| (k as f64 * 0.037).sin_cos())
            .map(|(s, c)| [300.0 + 200.0 * c, 200.0 + 150.0 * s]);
        let drawn: usize = loops(all).iter().map(Vec::len).sum();
        assert!(drawn < 10_000, "{drawn} points");
    }
}
