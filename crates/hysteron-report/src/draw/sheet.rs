//! The sheet that carries panels: title, note and legend above, so that they never hide data.

use super::canvas::Canvas;
use super::marker::{Marker, ring_around};
use super::plot::{Plot, Words};
use super::shape::{Anchor, Rect};
use super::style::{AXIS, FAINT, INK, LABEL, Stroke, TITLE};
use super::text;
use hysteron_files::printable;

/// Space around everything.
pub(crate) const MARGIN: f64 = 14.0;
/// Height of a row of the legend.
const ROW: f64 = 21.0;
/// Length of the piece of line in a legend.
const SAMPLE: f64 = 34.0;
/// Size of a subscript.
const SUBSCRIPT: f64 = 10.0;

/// One entry of a legend.
pub(crate) enum Key {
    /// A line and what it is.
    Line(Stroke, String),
    /// A filled area and what it is.
    Area(&'static str, String),
    /// A ring around a sample, and which sample it is.
    Ring(Stroke, String),
    /// A marker, what it is, and a subscript to that.
    Marker(Marker, String, &'static str),
    /// A remark.
    Text(String),
}

/// A figure, drawn.
#[derive(Debug, Clone)]
pub(crate) struct Drawing {
    /// As it stands on paper.
    pub(crate) svg: String,
    /// Its panels, for a page that can draw them again.
    pub(crate) plots: Vec<Plot>,
    pub(crate) words: Vec<Words>,
    /// What filled areas are.
    pub(crate) areas: Vec<(&'static str, String)>,
}

/// A figure under construction.
pub(crate) struct Sheet {
    pub(crate) canvas: Canvas,
    pub(crate) width: f64,
    title: String,
    /// What lines and filled areas are, as the legend says.
    lines: Vec<(Stroke, String)>,
    areas: Vec<(&'static str, String)>,
    /// Below title and legend.
    pub(crate) top: f64,
}

impl Sheet {
    /// A sheet `width` pixels wide with its title and, at the right, a note; its ids begin with
    /// `stem`.
    pub(crate) fn new(stem: &'static str, width: f64, title: &str, note: Option<&str>) -> Self {
        let mut canvas = Canvas::new(stem);
        let baseline = MARGIN + 0.8 * TITLE;
        let mut room = width - 2.0 * MARGIN;
        if let Some(note) = note {
            let taken = text::width(note, LABEL);
            canvas.words(Words {
                at: [width - MARGIN, baseline],
                anchor: Anchor::End,
                size: LABEL,
                colour: FAINT,
                text: note.to_owned(),
            });
            room -= taken + 16.0;
        }
        canvas.words(Words {
            at: [MARGIN, baseline],
            anchor: Anchor::Start,
            size: TITLE,
            colour: INK,
            text: text::fit(title, TITLE, room),
        });
        Self {
            canvas,
            width,
            title: title.to_owned(),
            lines: Vec::new(),
            areas: Vec::new(),
            top: baseline + 12.0,
        }
    }

    /// Adds a legend, in as many rows as it takes.
    pub(crate) fn legend(&mut self, keys: &[Key]) {
        let label = |words: &str| printable(words).into_owned();
        let (mut x, mut y) = (MARGIN, self.top + 0.5 * ROW);
        for key in keys {
            let (sample, words, subscript) = match key {
                Key::Line(_, words) => (SAMPLE + 7.0, words, ""),
                Key::Area(_, words) => (24.0 + 7.0, words, ""),
                Key::Ring(_, words) => (12.0 + 5.0, words, ""),
                Key::Marker(_, words, subscript) => (12.0 + 5.0, words, *subscript),
                Key::Text(words) => (0.0, words, ""),
            };
            let words = text::fit(words, LABEL, self.width - 2.0 * MARGIN - sample);
            let end = sample + text::width(&words, LABEL);
            let taken = end + text::width(subscript, SUBSCRIPT);
            if x > MARGIN && x + taken > self.width - MARGIN {
                (x, y) = (MARGIN, y + ROW);
            }
            self.sample(key, [x, y]);
            match key {
                Key::Line(stroke, words) | Key::Ring(stroke, words) => {
                    self.lines.push((*stroke, label(words)))
                }
                Key::Area(fill, words) => self.areas.push((*fill, label(words))),
                Key::Marker(..) | Key::Text(_) => {}
            }
            self.canvas
                .text([x + sample, y + 0.36 * LABEL], Anchor::Start, LABEL, &words);
            self.canvas.text(
                [x + end, y + 0.36 * LABEL + 3.0],
                Anchor::Start,
                SUBSCRIPT,
                subscript,
            );
            x += taken + 22.0;
        }
        self.top = y + 0.5 * ROW + 8.0;
    }

    fn sample(&mut self, key: &Key, [x, y]: [f64; 2]) {
        match key {
            Key::Line(stroke, _) => self.canvas.line([x, y], [x + SAMPLE, y], stroke),
            Key::Area(fill, _) => {
                let area = Rect {
                    x,
                    y: y - 7.0,
                    width: 24.0,
                    height: 14.0,
                };
                self.canvas.rect(area, fill);
                self.canvas.path(
                    &super::shape::rect_data(area),
                    None,
                    Some(&Stroke { width: 0.5, ..AXIS }),
                );
            }
            Key::Ring(stroke, _) => ring_around(&mut self.canvas, [x + 6.0, y], stroke),
            Key::Marker(marker, ..) => marker.draw(&mut self.canvas, [[x + 6.0, y]], 4.5),
            Key::Text(_) => {}
        }
    }

    /// The finished figure, `height` pixels high; `label` is what a screen reader says.
    pub(crate) fn finish(mut self, height: f64, label: &str) -> Drawing {
        let mut plots = std::mem::take(&mut self.canvas.plots);
        for line in plots.iter_mut().flat_map(|plot| &mut plot.lines) {
            let named = self
                .lines
                .iter()
                .find(|(stroke, _)| *stroke == line.stroke());
            line.name = named.map_or(String::new(), |(_, words)| words.clone());
        }
        // Lines of the legend that are none of samples: marks, and levels.
        let drawn = |stroke| {
            plots
                .iter()
                .flat_map(|plot| &plot.lines)
                .any(|l| l.stroke() == stroke)
        };
        let marks = self.lines.iter().filter(|(stroke, _)| !drawn(*stroke));
        let marks = marks.map(|(stroke, words)| (stroke.colour, words.clone()));
        self.areas.extend(marks.collect::<Vec<_>>());
        Drawing {
            words: std::mem::take(&mut self.canvas.words),
            svg: self
                .canvas
                .finish(self.width, height.ceil(), &self.title, label),
            plots,
            areas: self.areas,
        }
    }
}
