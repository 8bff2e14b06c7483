//! At which temperature each fraction is transformed at each load, on the way up and on the way
//! down: the curves of a registration.

use crate::identify::stages::load::groups::{Groups, Samples};
use crate::identify::stages::load::monotone::make_monotone;
use crate::model::{LoadCurves, Registration};
use crate::recording::Recording;
use crate::series::{branch_spans, range, usual_tolerance};

/// The fractions. Nearer to the ends a loop tells little but its noise.
const FRACTIONS: [f64; 17] = [
    0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.93, 0.96, 0.98,
];
const HALF: usize = 8;

/// A branch of the major loop covers this share of the inputs at its load.
const MAJOR: f64 = 0.85;

/// Steps in which the width of the operators' loops is tried, and how far the two curves may cross
/// by noise, as a share of the inputs' range.
const WIDTHS: usize = 40;
const CROSSED: f64 = 0.003;

/// Inner knots of the curves, and the share of the axis that is left to the inputs beyond them, on
/// either side.
const KNOTS: usize = 18;
const OUTSIDE: f64 = 0.12;

/// How much of the axis follows the fraction transformed, where the levels are then close together.
const EVEN: f64 = 0.65;

/// The temperature at each fraction, at one load: on the way up, and on the way down.
type Loop = [[f64; FRACTIONS.len()]; 2];

/// The loops of all loads that tell theirs.
#[derive(Debug, Clone)]
pub(super) struct Loops {
    /// Index of the load, its stroke and its loop, ascending.
    known: Vec<(usize, f64, Loop)>,
    /// The inputs of all samples.
    inputs: (f64, f64),
}

impl Loops {
    /// `None` where a load that tells its shift lacks a branch up or a branch down, or any stroke.
    pub(super) fn new(
        recordings: &[Recording],
        samples: &Samples,
        groups: &Groups,
    ) -> Option<Self> {
        let group = groups.group.as_ref()?;
        let sign = direction(samples);
        let tolerance = usual_tolerance(&samples.input);
        // The branches of all recordings, each within one load.
        let mut spans = Vec::new();
        let mut start = 0;
        for recording in recordings {
            let end = start + recording.len();
            let mut from = start;
            for same in group[start..end].chunk_by(|a, b| a == b) {
                let to = from + same.len();
                let own = branch_spans(&samples.input[from..to], tolerance);
                spans.extend(own.map(|span| (same[0], from + span.start..from + span.end)));
                from = to;
            }
            start = end;
        }
        let mut known = Vec::new();
        for g in (0..groups.knots.len()).filter(|g| groups.telling[*g]) {
            let own = || (0..group.len()).filter(|n| group[*n] == g);
            let (low, high) = range(&own().map(|n| samples.input[n]).collect::<Vec<_>>());
            let (off, on) = range(&own().map(|n| sign * samples.output[n]).collect::<Vec<_>>());
            // Fractions of no stroke are none.
            let moves = on > off;
            if !moves {
                return None;
            }
            let mut ways: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
            for (_, span) in spans.iter().filter(|(at, _)| *at == g) {
                let own = &samples.input[span.clone()];
                let (from, to) = range(own);
                if to - from < MAJOR * (high - low) {
                    continue;
                }
                let rises = own[own.len() - 1] > own[0];
                let points = span.clone().map(|n| {
                    let fraction = (sign * samples.output[n] - off) / (on - off);
                    (samples.input[n], fraction)
                });
                ways[usize::from(!rises)].extend(points);
            }
            let [up, down] = ways.map(temperatures);
            known.push((g, on - off, [up?, down?]));
        }
        (known.len() > 1).then(|| Self {
            known,
            inputs: range(&samples.input),
        })
    }

    /// The same loops without those of one load.
    pub(super) fn without(&self, left: usize) -> Self {
        let known = self.known.iter().filter(|(g, ..)| *g != left);
        Self {
            known: known.copied().collect(),
            inputs: self.inputs,
        }
    }

    /// The middle of each loop: the mean of the temperatures at half its height.
    pub(super) fn middles(&self) -> impl Iterator<Item = (usize, f64)> {
        let middle = |[up, down]: &Loop| 0.5 * (up[HALF] + down[HALF]);
        self.known.iter().map(move |(g, _, at)| (*g, middle(at)))
    }

    /// The registration behind the shifts of `curves`, with a row for each of the loads `rows`.
    ///
    /// Between two loads the middle of the loop moves with the shift, and its shape goes over from
    /// one to the other, weighted by the strokes.
    pub(super) fn registration(&self, curves: &LoadCurves, rows: &[f64]) -> Registration {
        let shifted: Vec<Loop> = self
            .known
            .iter()
            .map(|(g, _, at)| at.map(|way| way.map(|t| t - curves.shifts[*g])))
            .collect();
        let strokes: Vec<f64> = self.known.iter().map(|(_, stroke, _)| *stroke).collect();
        let mean = blend(&shifted, &strokes);
        let reach = self.inputs.1 - self.inputs.0;
        let apart = 1e-4 * reach;
        let widths = (0..=WIDTHS).rev().map(|n| n as f64 / WIDTHS as f64);
        let mut found = None;
        for width in widths {
            let frame = Frame::new(&mean, width, reach, apart);
            let ways: Vec<[Vec<f64>; 2]> = shifted.iter().map(|at| frame.ways(at)).collect();
            let crossed = ways.iter().flat_map(|[up, down]| down.iter().zip(up));
            let crossed = crossed.map(|(down, up)| down - up).fold(0.0, f64::max);
            let fits = crossed <= CROSSED * reach;
            found = Some((frame, ways));
            if fits {
                break;
            }
        }
        let Some((frame, ways)) = found else {
            return Registration::default();
        };
        let loads: Vec<f64> = self.known.iter().map(|(g, ..)| curves.loads[*g]).collect();
        let mut registration = Registration {
            knots: frame.positions,
            ..Registration::default()
        };
        for load in rows {
            let above = loads.partition_point(|known| known <= load);
            let a = above.max(1) - 1;
            let b = above.min(loads.len() - 1);
            // Beyond the outermost loads they are the same.
            let part = match a == b {
                true => 0.0,
                false => (load - loads[a]) / (loads[b] - loads[a]),
            };
            let shares = [(1.0 - part) * strokes[a], part * strokes[b]];
            let sum = shares[0] + shares[1];
            let way = |n: usize| -> Vec<f64> {
                let pairs = ways[a][n].iter().zip(&ways[b][n]);
                pairs
                    .map(|(a, b)| (shares[0] * a + shares[1] * b) / sum)
                    .collect()
            };
            let (mut up, mut down) = (way(0), way(1));
            // What noise has crossed meets in the middle.
            for (up, down) in up.iter_mut().zip(&mut down) {
                if down > up {
                    (*up, *down) = (0.5 * (*up + *down), 0.5 * (*up + *down));
                }
            }
            registration.rising.extend(ascending(&up, apart));
            registration.falling.extend(ascending(&down, apart));
        }
        let pairs = registration.falling.iter_mut().zip(&registration.rising);
        pairs.for_each(|(falling, rising)| *falling = falling.min(*rising));
        registration
    }
}

/// The axis of the operators: its knots as temperatures of the mean loop, and where they stand.
struct Frame {
    /// The fractions' temperatures on the axis, up and down.
    mean: Loop,
    /// The knots of the curves, as such temperatures.
    knots: Vec<f64>,
    positions: Vec<f64>,
}

impl Frame {
    /// The operators' own loop has this share of the `width` of the mean one.
    fn new(mean: &Loop, width: f64, reach: f64, apart: f64) -> Self {
        let [up, down] = mean;
        let middle = |k: usize| 0.5 * (up[k] + down[k]);
        let half = |k: usize| 0.5 * width * (up[k] - down[k]).max(0.0);
        let way = |sign: f64| {
            let way: Vec<f64> = (0..FRACTIONS.len())
                .map(|k| middle(k) + sign * half(k))
                .collect();
            let way = ascending(&way, apart);
            std::array::from_fn(|k| way[k])
        };
        let mean = [way(1.0), way(-1.0)];
        let mut all: Vec<f64> = mean.iter().flatten().copied().collect();
        all.sort_by(f64::total_cmp);
        let pick = |n: usize| all[n * (all.len() - 1) / (KNOTS - 1)];
        let inner = ascending(&(0..KNOTS).map(pick).collect::<Vec<_>>(), apart);
        let (first, last) = (inner[0], inner[KNOTS - 1]);
        // All inputs beyond are within so much.
        let knots: Vec<f64> = [first - reach]
            .into_iter()
            .chain(inner.iter().copied())
            .chain([last + reach])
            .collect();
        let fraction = |x: f64| {
            let of = |way| line(way, &FRACTIONS, x).clamp(0.0, 1.0);
            0.5 * (of(&mean[0]) + of(&mean[1]))
        };
        let place = |x: f64| (1.0 - EVEN) * (x - first) / (last - first) + EVEN * fraction(x);
        let (from, to) = (place(first), place(last));
        let span = (1.0 - 2.0 * OUTSIDE) * reach;
        let inside = |x: &f64| first + span * (place(*x) - from) / (to - from);
        let positions = [first - OUTSIDE * reach]
            .into_iter()
            .chain(inner.iter().map(inside))
            .chain([first + span + OUTSIDE * reach]);
        let positions = ascending(&positions.collect::<Vec<_>>(), apart);
        Self {
            mean,
            knots,
            positions,
        }
    }

    /// The temperatures at the knots, for the loop of a load.
    fn ways(&self, at: &Loop) -> [Vec<f64>; 2] {
        std::array::from_fn(|way| {
            let to = |x: &f64| line(&self.mean[way], &at[way], *x);
            self.knots.iter().map(to).collect()
        })
    }
}

/// The mean of loops with these weights.
fn blend(loops: &[Loop], weights: &[f64]) -> Loop {
    let sum: f64 = weights.iter().sum();
    std::array::from_fn(|way| {
        std::array::from_fn(|k| {
            let each = loops.iter().zip(weights);
            each.map(|(at, weight)| weight * at[way][k]).sum::<f64>() / sum
        })
    })
}

/// 1 where the output rises with the input, else −1.
fn direction(samples: &Samples) -> f64 {
    let Samples { input, output, .. } = samples;
    let count = input.len().max(1) as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let (x, y) = (mean(input), mean(output));
    let pairs = input.iter().zip(output);
    let product: f64 = pairs.map(|(t, out)| (t - x) * (out - y)).sum();
    if product < 0.0 { -1.0 } else { 1.0 }
}

/// The temperatures at the fractions, of a branch's points; `None` without points.
fn temperatures(mut points: Vec<(f64, f64)>) -> Option<[f64; FRACTIONS.len()]> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut fractions: Vec<f64> = points.iter().map(|point| point.1).collect();
    make_monotone(&mut fractions, false);
    let last = points.len().checked_sub(1)?;
    Some(FRACTIONS.map(|wanted| {
        let k = fractions.partition_point(|fraction| *fraction < wanted);
        if k == 0 || k > last {
            return points[k.min(last)].0;
        }
        let part = (wanted - fractions[k - 1]) / (fractions[k] - fractions[k - 1]);
        points[k - 1].0 + part * (points[k].0 - points[k - 1].0)
    }))
}

/// The piecewise linear function with these values, of slope one beyond its ends.
fn line(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let last = xs.len() - 1;
    if x <= xs[0] {
        return ys[0] + (x - xs[0]);
    }
    if x >= xs[last] {
        return ys[last] + (x - xs[last]);
    }
    let k = xs.partition_point(|knot| *knot <= x);
    ys[k - 1] + (x - xs[k - 1]) * (ys[k] - ys[k - 1]) / (xs[k] - xs[k - 1])
}

/// The same values, at least so far `apart`.
fn ascending(values: &[f64], apart: f64) -> Vec<f64> {
    let mut least = f64::NEG_INFINITY;
    let next = values.iter().map(|value| {
        let value = value.max(least);
        least = value + apart;
        value
    });
    next.collect()
}
