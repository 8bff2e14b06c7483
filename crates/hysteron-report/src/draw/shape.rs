//! Rectangles, anchors of text and coordinates, as SVG writes them.

use serde::Serialize;

/// A rectangle in pixels, y downwards.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Rect {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Rect {
    pub(crate) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// Where a text stands relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// Path data of a rectangle.
pub(crate) fn rect_data(rect: Rect) -> String {
    format!(
        "M{} {}h{}v{}h{}z",
        Short(rect.x),
        Short(rect.y),
        Short(rect.width),
        Short(rect.height),
        Short(-rect.width)
    )
}

/// A coordinate with at most two decimals, which is finer than any screen or printer shows.
pub(crate) struct Short(pub(crate) f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let hundredths = (self.0 * 100.0).round();
        write!(
            f,
            "{}",
            if hundredths == 0.0 {
                0.0
            } else {
                hundredths / 100.0
            }
        )
    }
}
