//! Markers, many of one kind in one path.

use super::canvas::Canvas;
use super::shape::{Rect, Short, rect_data};
use super::style::Stroke;
use std::fmt::Write;

/// Pixels from the middle of a ring around a sample to its edge.
pub(crate) const AROUND: f64 = 6.0;

/// An open ring around a sample, which stays in sight.
pub(crate) fn ring_around(canvas: &mut Canvas, [x, y]: [f64; 2], stroke: &Stroke) {
    let mut d = String::new();
    circle(&mut d, [x, y], AROUND);
    canvas.path(&d, None, Some(stroke));
}

// Writing to a string cannot fail.
fn circle(d: &mut String, [x, y]: [f64; 2], radius: f64) {
    let (start, r, across) = (Short(x - radius), Short(radius), Short(2.0 * radius));
    let _ = write!(
        d,
        "M{start} {}a{r} {r} 0 1 0 {across} 0a{r} {r} 0 1 0 -{across} 0z",
        Short(y)
    );
}

/// The shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Marker {
    /// ○
    Ring,
    /// ●
    Disc,
    /// ■
    Square,
    /// ×
    Cross,
}

const RING: Stroke = Stroke::solid("#6b7480", 1.0);
const CROSS: Stroke = Stroke::solid("#1d2b3a", 1.8);
const DISC: &str = "#1d2b3a";
const SQUARE: &str = "#8b95a1";

impl Marker {
    /// Draws the marker at each of `points`, `radius` pixels from its middle to its edge.
    pub(crate) fn draw(
        self,
        canvas: &mut Canvas,
        points: impl IntoIterator<Item = [f64; 2]>,
        radius: f64,
    ) {
        let mut d = String::new();
        for [x, y] in points {
            let _ = match self {
                Self::Ring | Self::Disc => {
                    circle(&mut d, [x, y], radius);
                    Ok(())
                }
                Self::Square => {
                    let side = 1.8 * radius;
                    write!(
                        d,
                        "{}",
                        rect_data(Rect {
                            x: x - side / 2.0,
                            y: y - side / 2.0,
                            width: side,
                            height: side
                        })
                    )
                }
                Self::Cross => {
                    let (left, top, across) =
                        (Short(x - radius), Short(y - radius), Short(2.0 * radius));
                    write!(
                        d,
                        "M{left} {top}l{across} {across}m0 -{across}l-{across} {across}"
                    )
                }
            };
        }
        if d.is_empty() {
            return;
        }
        match self {
            Self::Ring => canvas.path(&d, Some("#ffffff"), Some(&RING)),
            Self::Disc => canvas.path(&d, Some(DISC), None),
            Self::Square => canvas.path(&d, Some(SQUARE), None),
            Self::Cross => canvas.path(&d, None, Some(&CROSS)),
        }
    }
}
