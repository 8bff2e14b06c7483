//! The distance of each actuator from the others, the strangest first.

use super::view::{Figure, View};
use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::sheet::{Drawing, MARGIN};
use crate::draw::style::{FOLLOWER, GUIDE};
use crate::panels::WIDTH;
use crate::quantity::Labelled;
use crate::stack::Figures;

const HEIGHT: f64 = 240.0;
/// Distances beyond so many limits are drawn at the edge: one broken actuator would flatten all.
const MOST: f64 = 8.0;

pub(super) fn svg(view: &View<'_>) -> Drawing {
    let mut sheet = view.sheet(Figure::Distances, WIDTH);
    let limit = view.ordered[0].1.limit;
    let distances: Vec<f64> = view
        .ordered
        .iter()
        .map(|(_, strange)| match strange.distance.is_nan() {
            true => MOST * limit,
            false => strange.distance.min(MOST * limit),
        })
        .collect();
    let plain = |name: &str| Labelled {
        name: name.into(),
        unit: None,
    };
    let places: Vec<f64> = (1..=distances.len()).map(|n| n as f64).collect();
    let x = Axis::new(
        &plain("actuators, the strangest first"),
        Span::of(&places).padded(0.02),
    );
    let highest = Span::of(&distances).with(limit).with(0.0);
    let y = Axis::new(&plain("distance"), highest.padded(0.05).from(0.0));
    let left = MARGIN + left_of(&y, HEIGHT);
    let area = Rect {
        x: left,
        y: sheet.top,
        width: WIDTH - MARGIN - left,
        height: HEIGHT,
    };
    let panel = Panel::draw(&mut sheet.canvas, area, x, y, Labels { x: true, y: true });
    panel.level(&mut sheet.canvas, limit, &GUIDE);
    panel.curve(&mut sheet.canvas, &places, &distances, &FOLLOWER);
    let height = area.bottom() + BELOW + 4.0;
    view.finish(Figure::Distances, sheet, height)
}
