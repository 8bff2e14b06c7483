//! What figures over time share: curves over all of the recording, and their legends.

use crate::draw::axis::{Axis, Span, time_axis};
use crate::draw::panel::Panel;
use crate::draw::sheet::{Key, Sheet};
use crate::draw::stretches::{extent, stretches};
use crate::draw::style::{ANTICIPATE, BAND, MEASURED, MODELLED, POINTED, SHADE, Stroke};
use crate::evaluation::view::View;
use crate::panels::single;

/// Values over time and how they are drawn.
pub(super) type Curve<'a> = (&'a [f64], Stroke);

/// Legend of both outputs, and of the band where there is one.
pub(super) fn measured_and_modelled(view: &View<'_>) -> Vec<Key> {
    let mut keys = vec![
        Key::Line(MEASURED, view.recorded().into()),
        Key::Line(MODELLED, "modelled".into()),
    ];
    if let Some(band) = view.band() {
        keys.push(Key::Area(BAND, band.name()));
    }
    keys.extend(worst(view));
    keys
}

/// Legend of the worst sample, where there is one.
pub(super) fn worst(view: &View<'_>) -> Option<Key> {
    let (_, words) = view.worst()?;
    Some(Key::Ring(POINTED, words))
}

/// A ring around the worst sample, which is at these values.
pub(super) fn ring_worst(sheet: &mut Sheet, view: &View<'_>, panel: &Panel, [xs, ys]: [&[f64]; 2]) {
    let at = view
        .worst()
        .and_then(|(n, _)| Some([*xs.get(n)?, *ys.get(n)?]));
    if let Some(at) = at {
        panel.ring(&mut sheet.canvas, at, &POINTED);
    }
}

/// Legend of the inverse's policies, and of the dead band where there is one.
pub(super) fn policies(moving: &[bool]) -> Vec<Key> {
    let mut keys = vec![
        Key::Line(MODELLED, "modelled, hold".into()),
        Key::Line(ANTICIPATE, "modelled, anticipate".into()),
    ];
    if moving.contains(&false) {
        keys.push(Key::Area(SHADE, "output at rest (dead band)".into()));
    }
    keys
}

/// Draws `curves` over all of the recording's time, shaded where nothing moves.
pub(super) fn plot(
    sheet: &mut Sheet,
    view: &View<'_>,
    y: Axis,
    curves: &[Curve<'_>],
    moving: &[bool],
    height: f64,
) -> Panel {
    let panel = empty(sheet, view, y, height);
    let rests = stretches(moving);
    let rests = rests.iter().map(|stretch| extent(&view.time, stretch));
    panel.shade(&mut sheet.canvas, rests);
    draw(sheet, view, &panel, curves);
    panel
}

/// An empty panel over all of the recording's time.
pub(super) fn empty(sheet: &mut Sheet, view: &View<'_>, y: Axis, height: f64) -> Panel {
    let x = time_axis(&view.time_label, Span::covering(view.time.iter()));
    single(sheet, x, y, height)
}

pub(super) fn draw(sheet: &mut Sheet, view: &View<'_>, panel: &Panel, curves: &[Curve<'_>]) {
    for (values, stroke) in curves {
        panel.curve(&mut sheet.canvas, &view.time, values, stroke);
    }
}
