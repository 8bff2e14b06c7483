//! The samples that a view shows, and lines through them.

use super::parts::Parts;
use super::thinned::{Points, Scale, Shape, rows, thinned, when};
use super::view::{Picture, View};
use hysteron::Recording;
use hysteron_report::decimate::Point;
use std::ops::Range;

/// The samples of a recording that a view shows.
pub(super) struct Seen<'r> {
    pub(super) recording: &'r Recording,
    rows: Range<usize>,
    /// Of `rows`, whether the loop is inside the area there.
    shown: Vec<bool>,
    /// The first sample of each recording but the first one.
    begins: Vec<usize>,
    pixels: (u32, u32),
    scale: Scale,
    picture: Picture,
}

impl<'r> Seen<'r> {
    pub(super) fn new(parts: &'r Parts, view: &View) -> Self {
        let recording = &*parts.shown;
        let rows = rows(recording, view.window);
        let shown = rows.clone().map(|n| view.area.shows(recording, n));
        Self {
            shown: shown.collect(),
            begins: parts.begins().skip(1).collect(),
            pixels: view.pixels,
            scale: [None; 2],
            picture: view.picture,
            recording,
            rows,
        }
    }

    /// The same, drawn at a scale.
    pub(super) fn at(self, scale: Scale) -> Self {
        Self { scale, ..self }
    }

    /// The samples.
    pub(super) fn kept(&self) -> impl DoubleEndedIterator<Item = usize> + Clone {
        let first = self.rows.start;
        self.rows.clone().filter(move |n| self.shown[n - first])
    }

    pub(super) fn shows(&self, n: usize) -> bool {
        let place = n.checked_sub(self.rows.start);
        place.is_some_and(|place| self.shown.get(place) == Some(&true))
    }

    /// A value at each sample, over the time.
    pub(super) fn over_time(&self, of: impl Fn(usize) -> f64) -> Points {
        let points = self.points(|n| [when(self.recording, n), of(n)]);
        thinned(points, self.pixels, self.scale, Shape::OverTime)
    }

    /// The same over the input.
    pub(super) fn over_input(&self, of: impl Fn(usize) -> f64) -> Points {
        let shape = match self.picture {
            Picture::ResidualsOverInput => Shape::Dots,
            _ => Shape::Loop,
        };
        let points = self.points(|n| [self.recording.input[n], of(n)]);
        thinned(points, self.pixels, self.scale, shape)
    }

    /// A point for each sample. What is not a number breaks a line: no history goes on from one
    /// recording to the next.
    fn points(&self, of: impl Fn(usize) -> Point + Clone) -> impl Iterator<Item = Point> + Clone {
        let each = self.rows.clone().zip(&self.shown);
        each.flat_map(move |(n, shown)| {
            let [x, y] = of(n);
            let gap = self.begins.binary_search(&n).is_ok();
            let gap = gap.then_some([f64::NAN; 2]);
            gap.into_iter()
                .chain([[x, if *shown { y } else { f64::NAN }]])
        })
    }
}
