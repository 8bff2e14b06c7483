//! Fewer points for the same picture.
//!
//! Points are in pixels. A point that is not finite breaks the line, so every function returns the
//! unbroken pieces.

use std::collections::HashSet;
use std::f64::consts::{PI, TAU};

/// A point in pixels.
pub type Point = [f64; 2];

/// Beyond this many points, loops drop the segments that lie on pixels already drawn.
const DENSE: usize = 20_000;

/// For curves over time: of the consecutive points in one pixel column keep the first, lowest,
/// highest and last, so that no peak is lost and at most four points a column remain.
pub fn columns(points: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
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

/// Width of the columns that a band is drawn in: finer than the eye resolves in its light tint.
pub(crate) const COLUMN: f64 = 0.5;

/// For a band between two edges at the same x, between `left` and `right`: of each column of pixels
/// the stretches `[x, top, bottom]` that it covers, so that a million samples take no more than the
/// picture has room for.
pub(crate) fn covered(
    edges: impl Iterator<Item = (Point, Point)>,
    left: f64,
    right: f64,
) -> Vec<[f64; 3]> {
    let count = ((right - left) / COLUMN).ceil().max(1.0) as usize;
    let mut columns: Vec<Vec<[f64; 2]>> = vec![Vec::new(); count];
    let column = |x: f64| (((x - left) / COLUMN).max(0.0) as usize).min(count - 1);
    let mut before: Option<[f64; 3]> = None;
    for (a, b) in edges {
        if !(a[0].is_finite() && a[1].is_finite() && b[1].is_finite()) {
            before = None;
            continue;
        }
        let now = [a[0], a[1].min(b[1]), a[1].max(b[1])];
        let from = before.unwrap_or(now);
        let (first, last) = (column(from[0].min(now[0])), column(from[0].max(now[0])));
        for (n, stretches) in columns.iter_mut().enumerate().take(last + 1).skip(first) {
            // The part of the way from one sample to the next that lies in this column.
            let share = |x: f64| {
                let way = now[0] - from[0];
                let share = if way == 0.0 { 1.0 } else { (x - from[0]) / way };
                share.clamp(0.0, 1.0)
            };
            let x = left + n as f64 * COLUMN;
            let at = |share: f64, edge: usize| from[edge] + share * (now[edge] - from[edge]);
            let ends = [share(x), share(x + COLUMN)];
            let top = at(ends[0], 1).min(at(ends[1], 1));
            let bottom = at(ends[0], 2).max(at(ends[1], 2));
            stretches.push([top, bottom]);
            if stretches.len() > 64 {
                merge(stretches);
            }
        }
        before = Some(now);
    }
    let of_column = |(n, mut stretches): (usize, Vec<[f64; 2]>)| {
        merge(&mut stretches);
        let x = left + n as f64 * COLUMN;
        stretches
            .into_iter()
            .map(move |[top, bottom]| [x, top, bottom])
    };
    columns
        .into_iter()
        .enumerate()
        .flat_map(of_column)
        .collect()
}

/// Stretches that touch become one.
fn merge(stretches: &mut Vec<[f64; 2]>) {
    stretches.sort_by(|a, b| a[0].total_cmp(&b[0]));
    stretches.dedup_by(|next, kept| {
        let touch = next[0] <= kept[1] + COLUMN;
        if touch {
            kept[1] = kept[1].max(next[1]);
        }
        touch
    });
}

/// For curves that are no function of x: drop points closer than half a pixel to the last one kept,
/// except the extremes, and points on the straight way between others.
pub fn loops(points: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    let thinned = pieces(points).into_iter();
    let thinned: Vec<Vec<Point>> = thinned.map(|piece| straight(&thin(&piece))).collect();
    if thinned.iter().map(Vec::len).sum::<usize>() <= DENSE {
        return thinned;
    }
    uncovered(&thinned)
}

/// For points without a line: of those on one pixel the first.
pub fn dots(points: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    let mut drawn: HashSet<(i32, i32)> = HashSet::new();
    let mut last = None;
    let is_new = |point: &Point| {
        let pixel = (point[0].floor() as i32, point[1].floor() as i32);
        // Mostly it is the pixel of the point before.
        last.replace(pixel) != Some(pixel) && drawn.insert(pixel)
    };
    let finite = points.filter(|point| point.iter().all(|coordinate| coordinate.is_finite()));
    let kept: Vec<Point> = finite.filter(is_new).collect();
    if kept.is_empty() {
        Vec::new()
    } else {
        vec![kept]
    }
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

/// The cone of all directions.
const ALL_AROUND: [f64; 2] = [-PI, PI];

/// How far a point may lie from the line that is drawn instead, in pixels.
const STRAIGHT: f64 = 0.2;

/// The line through fewer points: each point left out is closer than [`STRAIGHT`] to it.
///
/// Directions from the last point kept that pass every point since are a cone, which narrows from
/// point to point (Sklansky and Gonzalez 1980). A point beside it, or closer than one before it,
/// ends the line at the point before.
fn straight(piece: &[Point]) -> Vec<Point> {
    let Some((&first, rest)) = piece.split_first() else {
        return Vec::new();
    };
    let mut kept = vec![first];
    let (mut from, mut before) = (first, first);
    let (mut farthest, mut middle) = (0.0, 0.0);
    let mut cone = ALL_AROUND;
    for &point in rest {
        let mut away = distance(from, point);
        let mut angle = (point[1] - from[1]).atan2(point[0] - from[0]);
        let aside = |angle: f64, middle: f64| {
            let turned = angle - middle;
            turned - TAU * (turned / TAU).round()
        };
        let along = aside(angle, middle);
        if !(cone[0]..=cone[1]).contains(&along) || away < farthest {
            kept.push(before);
            from = before;
            away = distance(from, point);
            angle = (point[1] - from[1]).atan2(point[0] - from[0]);
            (farthest, cone) = (0.0, ALL_AROUND);
        }
        if cone == ALL_AROUND && away > STRAIGHT {
            middle = angle;
        }
        if away > STRAIGHT {
            let half = (STRAIGHT / away).asin();
            let along = aside(angle, middle);
            cone = [cone[0].max(along - half), cone[1].min(along + half)];
        }
        farthest = f64::max(farthest, away);
        before = point;
    }
    if piece.len() > 1 {
        kept.push(before);
    }
    kept
}

/// A segment of more pixels leads far beyond the picture.
const FAR: f64 = 2000.0;

/// The segments that touch at least one pixel that no earlier segment has touched, and those that
/// lead far away.
fn uncovered(pieces: &[Vec<Point>]) -> Vec<Vec<Point>> {
    let mut drawn: HashSet<(i32, i32)> = HashSet::new();
    let mut kept: Vec<Vec<Point>> = Vec::new();
    for piece in pieces {
        let mut run: Vec<Point> = Vec::new();
        for pair in piece.windows(2) {
            let &[from, to] = pair else { continue };
            let length = distance(from, to);
            let mut new = length > FAR;
            let steps = if new {
                0
            } else {
                length.ceil().max(1.0) as usize
            };
            for step in 0..=steps {
                let share = step as f64 / steps.max(1) as f64;
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
    fn a_band_covers_what_lies_between_its_edges_and_stays_small() {
        // Steps of three pixels between heights, and back over the same place further down.
        let there = (0..=10).map(|k| [3.0 * f64::from(k), 50.0 + f64::from(k)]);
        let back = (0..=10).rev().map(|k| [3.0 * f64::from(k), 200.0]);
        let edges = there.chain(back).map(|[x, y]| ([x, y + 2.0], [x, y - 2.0]));
        let covered = covered(edges, 0.0, 40.0);
        let at = |x: f64| {
            covered
                .iter()
                .filter(move |c| c[0] == x)
                .map(|c| [c[1], c[2]])
        };
        // Between samples 3 and 4, at x = 10.5 to 11: heights 53.5 to 53.67, give or take 2.
        let found: Vec<[f64; 2]> = at(10.5).collect();
        let expected = [[51.5, 50.0 + 11.0 / 3.0 + 2.0], [198.0, 202.0]];
        assert_eq!(found.len(), 2);
        for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
        }
        assert_eq!(at(35.0).count(), 0);
        let million = (0..1_000_000).map(|k| (f64::from(k) * 0.037).sin_cos());
        let edges = million.map(|(s, c)| {
            (
                [300.0 + 200.0 * c, 201.0 + 150.0 * s],
                [300.0 + 200.0 * c, 199.0 + 150.0 * s],
            )
        });
        assert!(super::covered(edges, 0.0, 600.0).len() < 2000);
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
    fn a_line_through_fewer_points_passes_all_of_them() {
        // Circles that shrink, a walk with jumps back, and a line that turns on itself.
        let circles = (0..5000).map(|k| f64::from(k) * 0.05).map(|t| {
            let (s, c) = t.sin_cos();
            [300.0 + (200.0 - 0.5 * t) * c, 200.0 + (150.0 - 0.3 * t) * s]
        });
        let mut random: u64 = 7;
        let mut step = || {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (random >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let mut at = [300.0, 200.0];
        let walk = (0..5000).map(|n| {
            let size = if n % 7 == 0 { 40.0 } else { 2.0 };
            at = [at[0] + size * step(), at[1] + size * step()];
            at
        });
        let back = (0_i32..900).map(|k| [f64::from((k % 60 - 30).abs()), 5.0]);
        for all in [
            circles.collect(),
            walk.collect(),
            back.collect::<Vec<Point>>(),
        ] {
            let drawn = straight(&all);
            assert_eq!((drawn.first(), drawn.last()), (all.first(), all.last()));
            let beside = |point: &Point, [a, b]: [Point; 2]| {
                let (way, to) = (
                    [b[0] - a[0], b[1] - a[1]],
                    [point[0] - a[0], point[1] - a[1]],
                );
                let length = way[0] * way[0] + way[1] * way[1];
                let share = (to[0] * way[0] + to[1] * way[1]) / length.max(f64::MIN_POSITIVE);
                let share = share.clamp(0.0, 1.0);
                distance(*point, [a[0] + share * way[0], a[1] + share * way[1]])
            };
            // In order: each point belongs to the segment between the points kept around it.
            let mut segments = drawn.windows(2).peekable();
            for point in &all {
                while let Some(&&[a, b]) = segments.peek() {
                    if beside(point, [a, b]) <= STRAIGHT * 1.0001 {
                        break;
                    }
                    segments.next();
                }
                assert!(segments.peek().is_some(), "{point:?} is not on the line");
            }
        }
        let circle = (0..100_000).map(|k| (f64::from(k) * 1e-4).sin_cos());
        let circle: Vec<Point> = circle.map(|(s, c)| [200.0 * c, 200.0 * s]).collect();
        assert!(straight(&circle).len() < 250, "{}", straight(&circle).len());
    }

    #[test]
    fn a_way_far_beyond_the_picture_takes_no_time() {
        let circle = |k: u32| {
            let (s, c) = (f64::from(k) * 0.6).sin_cos();
            [300.0 + 200.0 * c, 200.0 + 150.0 * s - 1e-3 * f64::from(k)]
        };
        let spike = |k: u32| {
            if k.is_multiple_of(500) {
                [1e12, 0.0]
            } else {
                circle(k)
            }
        };
        let drawn = loops((0..100_000).map(spike)).concat();
        assert_eq!(drawn.iter().filter(|point| point[0] == 1e12).count(), 200);
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
