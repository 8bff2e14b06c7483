//! By how much a load shifts the axis of the input.

use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::marker::Marker;
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::sheet::{Drawing, Key, MARGIN};
use crate::draw::style::MODELLED;
use crate::draw::style::Stroke;
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::quantity::Labelled;
use crate::stack::Figures;

const WIDTH: f64 = 520.0;
const PLOT_HEIGHT: f64 = 300.0;
const CURVE: Stroke = Stroke::solid(MODELLED.colour, 2.0);

pub(super) fn svg(view: &View<'_>) -> Option<Drawing> {
    let load = view.source.load()?;
    let curves = load.curves.as_ref()?;
    if curves.loads.len() < 2 || curves.shifts.len() != curves.loads.len() {
        return None;
    }
    let quantity = Labelled::first([&load.quantity, &load.quantity], "load");
    let x = Axis::new(&quantity, Span::of(&curves.loads).padded(0.05));
    let shift = view.input.difference("shift s");
    let y = Axis::new(&shift, Span::of(&curves.shifts).padded(0.08));

    let mut sheet = view.sheet(Figure::LoadShift, WIDTH);
    sheet.legend(&[
        Key::Line(CURVE, "shift of the model".into()),
        Key::Marker(Marker::Disc, "points of its curve".into(), ""),
    ]);
    let left = MARGIN + left_of(&y, PLOT_HEIGHT);
    let area = Rect {
        x: left,
        y: sheet.top,
        width: WIDTH - MARGIN - left,
        height: PLOT_HEIGHT,
    };
    let panel = Panel::draw(&mut sheet.canvas, area, x, y, Labels { x: true, y: true });
    panel.curve(&mut sheet.canvas, &curves.loads, &curves.shifts, &CURVE);
    let knots = curves.loads.iter().zip(&curves.shifts);
    let knots = knots.map(|(&load, &shift)| panel.point(load, shift));
    Marker::Disc.draw(&mut sheet.canvas, knots, 4.0);
    let height = area.bottom() + BELOW + 4.0;
    Some(view.finish(Figure::LoadShift, sheet, height))
}
