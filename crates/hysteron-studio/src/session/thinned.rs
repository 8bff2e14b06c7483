//! Points of a recording, no more than a picture can show.

use hysteron::Recording;
use hysteron_report::decimate::{self, Point};
use serde::Serialize;

/// Bars of a histogram.
const BARS: usize = 60;

/// The time of a sample, or its number from 1.
pub(super) fn when(recording: &Recording, n: usize) -> f64 {
    match &recording.time {
        Some(time) => time[n],
        None => (n + 1) as f64,
    }
}

/// The samples in a window of the time, and one more at each end, so that lines go to its edge.
pub(super) fn rows(recording: &Recording, window: Option<(f64, f64)>) -> std::ops::Range<usize> {
    let count = recording.len();
    let Some((from, to)) = window.filter(|(from, to)| from < to) else {
        return 0..count;
    };
    let (first, last) = match &recording.time {
        Some(time) => (
            time.partition_point(|t| *t < from),
            time.partition_point(|t| *t <= to),
        ),
        // `as` saturates.
        None => (
            (from - 1.0).ceil().max(0.0) as usize,
            to.floor().max(0.0) as usize,
        ),
    };
    let first = first.saturating_sub(1).min(count - 1);
    first..last.saturating_add(1).clamp(first + 1, count)
}

pub(super) type Points = (Vec<Option<f64>>, Vec<Option<f64>>);

/// What is drawn through points.
#[derive(Debug, Clone, Copy)]
pub(super) enum Shape {
    /// A line with one height at a time.
    OverTime,
    /// A line that may go back.
    Loop,
    /// No line.
    Dots,
}

/// The ends of both axes; `None` where they are those of the points.
pub(super) type Scale = [Option<(f64, f64)>; 2];

/// An axis shows this part of the way between the outermost points at least.
const LEAST: f64 = 1e-9;

/// The points that a picture of so many pixels can show at a scale: what lies far beyond it makes no
/// pixel larger.
pub(super) fn thinned(
    points: impl Iterator<Item = Point> + Clone,
    (width, height): (u32, u32),
    shown: Scale,
    shape: Shape,
) -> Points {
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for point in points.clone() {
        for (ends, value) in ends.iter_mut().zip(point) {
            *ends = [ends[0].min(value), ends[1].max(value)];
        }
    }
    // Half a pixel is not seen.
    let pixels = [width, height].map(|pixels| f64::from(pixels.clamp(10, 8192)));
    let scale = [0, 1].map(|axis| {
        let whole = ends[axis][1] - ends[axis][0];
        let part = shown[axis].map_or(whole, |(low, high)| high - low);
        let way = part.clamp(LEAST * whole.max(0.0), whole.max(0.0));
        if way > 0.0 { way / pixels[axis] } else { 1.0 }
    });
    let lowest = [ends[0][0], ends[1][0]];
    let scaled = points.map(|p| [0, 1].map(|axis| (p[axis] - lowest[axis]) / scale[axis]));
    let pieces = match shape {
        Shape::OverTime => decimate::columns(scaled),
        Shape::Loop => decimate::loops(scaled),
        Shape::Dots => decimate::dots(scaled),
    };
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for piece in pieces {
        if !x.is_empty() {
            x.push(None);
            y.push(None);
        }
        x.extend(piece.iter().map(|p| Some(lowest[0] + p[0] * scale[0])));
        y.extend(piece.iter().map(|p| Some(lowest[1] + p[1] * scale[1])));
    }
    (x, y)
}

/// The ends of a scale.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ends {
    /// The lowest value on it.
    pub low: f64,
    /// The highest value on it.
    pub high: f64,
    /// Whether values lie beyond.
    pub beyond: bool,
}

impl Ends {
    /// The ends of both scales.
    pub(super) fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            beyond: self.beyond || other.beyond,
        }
    }
}

/// The ends of a scale that a few values far from all others do not set; `None` for no values.
pub(super) fn fair_ends(values: impl Iterator<Item = f64>) -> Option<Ends> {
    let values: Vec<f64> = values.collect();
    let (low, high) = hysteron::fair_range(&values);
    let beyond = (low, high) != hysteron::range(&values);
    (low <= high).then_some(Ends { low, high, beyond })
}

/// How often values occur: the middles of bars, and the share of each in percent. The outermost bars
/// count what is beyond them.
pub(super) fn histogram(values: impl Iterator<Item = f64> + Clone) -> Points {
    let ends = fair_ends(values.clone());
    let ends = ends.map_or((0.0, 0.0), |ends| (ends.low, ends.high));
    let width = ((ends.1 - ends.0) / BARS as f64).max(f64::MIN_POSITIVE);
    let mut counts = [0_u32; BARS];
    let mut all = 0.0;
    for value in values {
        counts[(((value - ends.0) / width) as usize).min(BARS - 1)] += 1;
        all += 1.0;
    }
    let middle = |n: usize| Some(ends.0 + (n as f64 + 0.5) * width);
    let share = |count: &u32| Some(100.0 * f64::from(*count) / all);
    (
        (0..BARS).map(middle).collect(),
        counts.iter().map(share).collect(),
    )
}
