//! What a panel shows, as numbers, so that a page can draw it again where one zooms.

use super::axis::Axis;
use super::shape::{Anchor, Rect};
use super::style::Stroke;
use hysteron_files::printable;
use serde::Serialize;

/// Samples of a line that a page holds, at most about so many; of a band, up to twice as many.
const MOST: usize = 20_000;

/// A panel, as numbers.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Plot {
    area: Rect,
    pub(crate) x: Shown,
    pub(crate) y: Shown,
    pub(crate) lines: Vec<Line>,
    /// Bands from x to x, between top and bottom of an area, in a colour.
    pub(crate) bands: Vec<(Vec<[f64; 2]>, Rect, &'static str)>,
    /// Where the x axis stands, if that is below the panel.
    pub(crate) foot: Option<f64>,
    /// Lines at a y.
    pub(crate) levels: Vec<(f64, Stroke)>,
    /// Lines at an x with their words.
    pub(crate) uprights: Vec<(f64, Stroke, String)>,
    /// Rings around samples.
    pub(crate) rings: Vec<([f64; 2], Stroke)>,
}

/// An axis, as numbers.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Shown {
    /// Name and unit.
    label: String,
    /// Axes with the same key are zoomed together.
    key: String,
    pub(crate) range: [f64; 2],
    /// Whether the label stands here, and whether the axis has numbers.
    labelled: bool,
    numbered: bool,
}

/// A line of a panel.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Line {
    /// What it is, where the legend says so.
    pub(crate) name: String,
    stroke: Stroke,
    /// The area to the line before this one.
    fill: Option<&'static str>,
    /// Whether x only ever grows, as time does.
    forward: bool,
    /// Number of samples that it was drawn from.
    samples: usize,
    /// Which of them are here; all, where empty.
    kept: Vec<u32>,
    #[serde(skip)]
    pub(crate) xs: Vec<f64>,
    #[serde(skip)]
    pub(crate) ys: Vec<f64>,
}

/// Words beside the panels.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Words {
    pub(crate) at: [f64; 2],
    pub(crate) anchor: Anchor,
    pub(crate) size: f64,
    pub(crate) colour: &'static str,
    pub(crate) text: String,
}

impl Shown {
    pub(crate) fn new(axis: &Axis, numbered: bool) -> Self {
        Self {
            label: printable(&axis.whole_label()).into_owned(),
            key: axis.key(),
            range: [axis.span.low, axis.span.high],
            labelled: numbered && !axis.label().is_empty(),
            numbered,
        }
    }
}

impl Plot {
    pub(crate) fn new(area: Rect, x: Shown, y: Shown) -> Self {
        Self {
            area,
            x,
            y,
            lines: Vec::new(),
            bands: Vec::new(),
            foot: None,
            levels: Vec::new(),
            uprights: Vec::new(),
            rings: Vec::new(),
        }
    }

    /// The area between two lines.
    pub(crate) fn band(&mut self, xs: &[f64], [low, high]: [&[f64]; 2], fill: &'static str) {
        const UNSEEN: Stroke = Stroke::solid("rgba(0,0,0,0)", 0.0);
        let forward = xs.windows(2).all(|pair| pair[0] <= pair[1]);
        let samples = xs.len().min(low.len()).min(high.len());
        // The edges belong together: what is kept of one is kept of the other.
        let of = |edge: &[f64]| kept(&xs[..samples], &edge[..samples], forward);
        let mut kept = [of(low), of(high)].concat();
        kept.sort_unstable();
        kept.dedup();
        let edge = |ys| Line::from_kept(xs, ys, UNSEEN, forward, kept.clone());
        let fill = Some(fill);
        self.lines.extend([edge(low), Line { fill, ..edge(high) }]);
    }
}

impl Line {
    /// A curve over time.
    pub(crate) fn curve(xs: &[f64], ys: &[f64], stroke: Stroke) -> Self {
        Self::new(xs, ys, stroke, true)
    }

    /// A curve that returns on itself.
    pub(crate) fn returning(xs: &[f64], ys: &[f64], stroke: Stroke) -> Self {
        Self::new(xs, ys, stroke, false)
    }

    fn new(xs: &[f64], ys: &[f64], stroke: Stroke, forward: bool) -> Self {
        let samples = xs.len().min(ys.len());
        let kept = kept(&xs[..samples], &ys[..samples], forward);
        Self::from_kept(xs, ys, stroke, forward, kept)
    }

    /// A line of which these samples are kept; all, where there are none.
    fn from_kept(xs: &[f64], ys: &[f64], stroke: Stroke, forward: bool, kept: Vec<u32>) -> Self {
        let samples = xs.len().min(ys.len());
        let part = |all: &[f64]| match kept.as_slice() {
            [] => all[..samples].to_vec(),
            kept => kept
                .iter()
                .filter_map(|k| all.get(*k as usize).copied())
                .collect(),
        };
        Self {
            name: String::new(),
            stroke,
            fill: None,
            forward,
            samples,
            xs: part(xs),
            ys: part(ys),
            kept,
        }
    }

    pub(crate) fn stroke(&self) -> Stroke {
        self.stroke
    }
}

/// Which samples stand for all: of each of equally long stretches those with the smallest and the
/// largest value, and the first gap. Empty where all can be kept.
fn kept(xs: &[f64], ys: &[f64], forward: bool) -> Vec<u32> {
    if xs.len() <= MOST {
        return Vec::new();
    }
    // Two ends of each series, and a gap.
    let each = if forward { 3 } else { 6 };
    let length = xs.len().div_ceil(MOST / each);
    let mut kept = vec![0];
    for from in (0..xs.len()).step_by(length) {
        let stretch = from..(from + length).min(xs.len());
        let mut ends = |values: &[f64]| {
            let order = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
            let finite = || stretch.clone().filter(|k| values[*k].is_finite());
            let gap = stretch.clone().find(|k| !values[*k].is_finite());
            kept.extend(
                [finite().min_by(order), finite().max_by(order), gap]
                    .into_iter()
                    .flatten(),
            );
        };
        ends(ys);
        if !forward {
            ends(xs);
        }
    }
    kept.push(xs.len() - 1);
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter()
        .filter_map(|k| u32::try_from(k).ok())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::style::MEASURED;

    #[test]
    fn a_peak_of_one_sample_is_kept() {
        let count = 1_000_000;
        let xs: Vec<f64> = (0..count).map(f64::from).collect();
        let mut ys: Vec<f64> = xs.iter().map(|x| (x * 1e-3).sin()).collect();
        (ys[123_456], ys[123_460]) = (5.0, f64::NAN);
        for line in [
            Line::curve(&xs, &ys, MEASURED),
            Line::returning(&xs, &ys, MEASURED),
        ] {
            assert!(line.xs.len() <= MOST + 2 && line.xs.len() > MOST / 4);
            assert!(line.ys.contains(&5.0) && line.kept.contains(&123_456));
            assert!(line.ys.iter().any(|y| y.is_nan()));
            assert_eq!((line.xs[0], line.xs.last()), (0.0, xs.last()));
        }
        let short = Line::curve(&xs[..MOST], &ys, MEASURED);
        assert!(short.kept.is_empty() && short.xs.len() == MOST && short.samples == MOST);
    }

    #[test]
    fn peaks_of_both_edges_of_a_band_are_kept() {
        let xs: Vec<f64> = (0..100_000).map(f64::from).collect();
        let (mut low, mut high) = (vec![-1.0; xs.len()], vec![1.0; xs.len() + 1]);
        (low[70_001], high[30_001]) = (-5.0, 5.0);
        let area = Rect {
            x: 0.0,
            y: 0.0,
            width: 1.0,
            height: 1.0,
        };
        let axis = || Shown {
            label: String::new(),
            key: String::new(),
            range: [0.0, 1.0],
            labelled: false,
            numbered: false,
        };
        let mut plot = Plot::new(area, axis(), axis());
        plot.band(&xs, [&low, &high], "gray");
        let [low, high] = plot.lines.as_slice() else {
            unreachable!("a band has two edges");
        };
        assert_eq!(low.kept, high.kept);
        assert!(low.ys.contains(&-5.0) && high.ys.contains(&5.0));
    }
}
