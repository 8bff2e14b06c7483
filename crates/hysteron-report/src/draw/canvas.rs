//! SVG elements, written as text.

use super::plot::{Plot, Words};
use super::shape::{Anchor, Rect, Short, rect_data};
use super::style::{INK, Stroke};
use super::text::FAMILIES;
use hysteron_files::printable;
use std::borrow::Cow;
use std::fmt::Write;

/// An SVG document under construction. Its ids begin with `stem`, so that figures can share one
/// HTML page.
#[derive(Debug)]
pub(crate) struct Canvas {
    stem: &'static str,
    clips: usize,
    body: String,
    /// What the panels show, as numbers.
    pub(crate) plots: Vec<Plot>,
    /// The words beside the panels.
    pub(crate) words: Vec<Words>,
    /// Lines through so many samples break before these.
    breaks: (usize, Vec<usize>),
}

// Writing to a string cannot fail, so the results are ignored.
impl Canvas {
    pub(crate) fn new(stem: &'static str) -> Self {
        Self {
            stem,
            clips: 0,
            body: String::new(),
            plots: Vec::new(),
            words: Vec::new(),
            breaks: (0, Vec::new()),
        }
    }

    /// From now on, lines through so many samples break before these of them.
    pub(crate) fn breaking(&mut self, (samples, before): (usize, &[usize])) {
        self.breaks = (samples, before.to_vec());
    }

    /// Values of a line, with a gap at each break: `gap` makes it of the value before.
    pub(crate) fn broken<'v>(&self, values: &'v [f64], gap: fn(f64) -> f64) -> Cow<'v, [f64]> {
        let (samples, before) = &self.breaks;
        if values.len() != *samples || before.is_empty() {
            return values.into();
        }
        let gaps = |n| before.binary_search(&(n + 1)).is_ok();
        let each = values.iter().enumerate();
        let each = each.flat_map(|(n, value)| {
            let gap = gaps(n).then(|| gap(*value));
            std::iter::once(*value).chain(gap)
        });
        each.collect()
    }

    pub(crate) fn line(&mut self, from: [f64; 2], to: [f64; 2], stroke: &Stroke) {
        self.polyline(&[from, to], stroke);
    }

    /// An open line through `points`; a single point becomes a dot.
    pub(crate) fn polyline(&mut self, points: &[[f64; 2]], stroke: &Stroke) {
        let &[first, ref rest @ ..] = points else {
            return;
        };
        let mut d = format!("M{} {}", Short(first[0]), Short(first[1]));
        for point in rest {
            let _ = write!(d, "L{} {}", Short(point[0]), Short(point[1]));
        }
        if rest.is_empty() {
            d.push_str("h0.01");
        }
        self.path(&d, None, Some(stroke));
    }

    /// A path by its SVG path data.
    pub(crate) fn path(&mut self, d: &str, fill: Option<&str>, stroke: Option<&Stroke>) {
        let _ = write!(
            self.body,
            r#"<path d="{d}" fill="{}""#,
            fill.unwrap_or("none")
        );
        if let Some(stroke) = stroke {
            let _ = write!(
                self.body,
                r#" stroke="{}" stroke-width="{}""#,
                stroke.colour,
                Short(stroke.width)
            );
            if !stroke.dash.is_empty() {
                let _ = write!(self.body, r#" stroke-dasharray="{}""#, stroke.dash);
            }
        }
        self.body.push_str("/>\n");
    }

    pub(crate) fn rect(&mut self, rect: Rect, fill: &str) {
        let _ = writeln!(
            self.body,
            r#"<path d="{}" fill="{fill}" stroke="none"/>"#,
            rect_data(rect)
        );
    }

    pub(crate) fn text(&mut self, at: [f64; 2], anchor: Anchor, size: f64, text: &str) {
        self.text_in(at, anchor, size, INK, text);
    }

    pub(crate) fn text_in(
        &mut self,
        at: [f64; 2],
        anchor: Anchor,
        size: f64,
        colour: &str,
        text: &str,
    ) {
        let place = format!(r#"x="{}" y="{}""#, Short(at[0]), Short(at[1]));
        self.text_element(&place, anchor, size, colour, text);
    }

    /// Text that a page keeps when it draws the panels again.
    pub(crate) fn words(&mut self, mut words: Words) {
        words.text = printable(&words.text).into_owned();
        self.text_in(
            words.at,
            words.anchor,
            words.size,
            words.colour,
            &words.text,
        );
        self.words.push(words);
    }

    /// Text that reads upwards.
    pub(crate) fn text_upwards(&mut self, at: [f64; 2], anchor: Anchor, size: f64, text: &str) {
        let place = format!(
            r#"transform="translate({} {}) rotate(-90)""#,
            Short(at[0]),
            Short(at[1])
        );
        self.text_element(&place, anchor, size, INK, text);
    }

    fn text_element(&mut self, place: &str, anchor: Anchor, size: f64, colour: &str, text: &str) {
        if text.is_empty() {
            return;
        }
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escape(text);
        let _ = writeln!(
            self.body,
            r#"<text {place} text-anchor="{anchor}" font-size="{}" fill="{colour}">{text}</text>"#,
            Short(size)
        );
    }

    /// Draws what `draw` draws, cut off outside `rect`.
    pub(crate) fn clipped(&mut self, rect: Rect, draw: impl FnOnce(&mut Self)) {
        let id = format!("{}-clip{}", self.stem, self.clips);
        self.clips += 1;
        let _ = writeln!(
            self.body,
            r#"<clipPath id="{id}"><path d="{}"/></clipPath>"#,
            rect_data(rect)
        );
        let _ = writeln!(self.body, r#"<g clip-path="url(#{id})">"#);
        draw(self);
        self.body.push_str("</g>\n");
    }

    /// The whole document; `label` is what a screen reader says.
    pub(crate) fn finish(self, width: f64, height: f64, title: &str, label: &str) -> String {
        let (title, label) = (escape(title), escape(label));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{label}\" \
             font-family=\"{FAMILIES}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n\
             <title>{title}</title>\n<rect width=\"{width}\" height=\"{height}\" \
             fill=\"#ffffff\"/>\n{}</svg>\n",
            self.body
        )
    }
}

/// Text for an XML document: markup escaped, characters that XML does not allow replaced.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}
