//! Axes that leave some values out, and marks where curves leave them.

use crate::draw::axis::Span;
use crate::draw::panel::Panel;
use crate::draw::shape::Rect;
use crate::draw::sheet::Sheet;
use crate::draw::stretches::{extent, stretches};
use crate::draw::style::BEYOND;
use crate::number::difference;
use crate::panels::Heading;
use crate::track::tracking::NamedTrace;
use crate::track::view::View;

/// The part of all values that must be seen; what lies far beyond is cut off.
const SEEN: f64 = 0.98;
/// How far beyond that the axis goes.
const ROOM: f64 = 1.6;

/// What captions say of the marks.
pub(super) const MARKS: &str = "Bars at an edge mark samples beyond it: errors that do not last, or \
                                of a minority of the controllers, do not set the scale.";

/// What captions say of the events.
pub(super) fn events(view: &View<'_>) -> &'static str {
    match view.tracking.events.is_empty() {
        true => "",
        false => " Dashed lines are the events above.",
    }
}

/// Output minus reference.
pub(super) fn error_of(run: &NamedTrace<'_>) -> Vec<f64> {
    difference(&run.trace.output, &run.trace.reference)
}

pub(super) fn named(run: &NamedTrace<'_>, remark: String) -> Heading {
    Heading {
        name: run.name.to_owned(),
        remark,
    }
}

/// A range around zero in which most of the values of most panels can be told apart, and whether it
/// leaves some out.
///
/// Half of the panels decide: a few controllers that are far off throughout must not make the
/// others illegible.
pub(crate) fn robust<'a>(panels: impl Iterator<Item = &'a [f64]> + Clone) -> (Span, bool) {
    let all = Span::covering(panels.clone().flatten())
        .with(0.0)
        .padded(0.06);
    let mut seen: Vec<f64> = panels.filter_map(far).collect();
    seen.sort_unstable_by(f64::total_cmp);
    let seen = ROOM
        * seen
            .get(seen.len().saturating_sub(1) / 2)
            .copied()
            .unwrap_or(0.0);
    let cut = Span {
        low: all.low.max(-seen),
        high: all.high.min(seen),
    };
    // If a cut widens the scale only a little, everything is shown instead.
    if seen > 0.0 && cut.high - cut.low < 0.6 * (all.high - all.low) {
        (cut, true)
    } else {
        (all, false)
    }
}

/// How far from zero most of the values lie.
fn far(values: &[f64]) -> Option<f64> {
    let finite = values.iter().filter(|value| value.is_finite());
    let mut sizes: Vec<f64> = finite.map(|value| value.abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let rank = (SEEN * sizes.len().saturating_sub(1) as f64) as usize;
    sizes.get(rank).copied()
}

/// Marks at the edge where `values` leave the panel.
pub(super) fn beyond(sheet: &mut Sheet, panel: &Panel, time: &[f64], values: &[f64], span: Span) {
    let area = panel.area;
    type Leaves = fn(f64, Span) -> bool;
    let edges: [(f64, Leaves); 2] = [
        (area.y, |value, span| value > span.high),
        (area.bottom() - BEYOND.width, |value, span| value < span.low),
    ];
    for (y, leaves) in edges {
        let inside: Vec<bool> = values.iter().map(|value| !leaves(*value, span)).collect();
        let bands = stretches(&inside);
        let edge = Rect {
            y,
            height: BEYOND.width,
            ..area
        };
        let times = bands.iter().map(|stretch| extent(time, stretch));
        panel.fill(&mut sheet.canvas, times, edge, BEYOND.colour);
    }
}
