//! Figs. 10 and 13: modelled and measured series over time.

use crate::draw::axis::time_axis;
use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::sheet::{Drawing, Key, MARGIN, Sheet};
use crate::draw::stretches::extent;
use crate::draw::stretches::stretches;
use crate::draw::style::{ANTICIPATE, BAND, MEASURED, MODELLED, SHADE, Stroke};
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::stack::Figures;

/// Width of a figure over time.
pub(super) const WIDTH: f64 = 760.0;
const PLOT_HEIGHT: f64 = 290.0;

/// A series and how it is drawn.
pub(super) struct Curve<'a> {
    pub(super) values: &'a [f64],
    pub(super) stroke: Stroke,
}

pub(super) fn output(view: &View<'_>) -> Drawing {
    let mut sheet = view.sheet(Figure::OutputTime, WIDTH);
    sheet.legend(&measured_and_modelled(view));
    let curves = [
        Curve {
            values: &view.recording.output,
            stroke: MEASURED,
        },
        Curve {
            values: &view.evaluation.output_model,
            stroke: MODELLED,
        },
    ];
    let band = view.band_edges();
    let edges = band.iter().flatten().flatten();
    let span = Span::of(curves.iter().flat_map(|curve| curve.values).chain(edges)).padded(0.04);
    let y = Axis::new(&view.output, span);
    let (panel, height) = frame(&mut sheet, view, y, PLOT_HEIGHT);
    if let Some(band) = &band {
        panel.band(&mut sheet.canvas, &view.time, band, BAND);
    }
    draw(&mut sheet, view, &panel, &curves);
    view.finish(Figure::OutputTime, sheet, height)
}

/// Legend of both outputs, and of the band where there is one.
pub(super) fn measured_and_modelled(view: &View<'_>) -> Vec<Key> {
    let mut keys = vec![
        Key::Line(MEASURED, view.recorded().into()),
        Key::Line(MODELLED, "modelled".into()),
    ];
    if view.band().is_some() {
        keys.push(Key::Area(BAND, "95 % band".into()));
    }
    keys
}

pub(super) fn input(view: &View<'_>) -> Option<Drawing> {
    let inverse = view.inverse()?;
    let mut sheet = view.sheet(Figure::InputTime, WIDTH);
    let mut keys = vec![Key::Line(MEASURED, view.recorded().into())];
    keys.extend(policies(&inverse.moving));
    sheet.legend(&keys);
    let curves = [
        Curve {
            values: &view.recording.input,
            stroke: MEASURED,
        },
        Curve {
            values: &inverse.hold.input_model,
            stroke: MODELLED,
        },
        Curve {
            values: &inverse.anticipate.input_model,
            stroke: ANTICIPATE,
        },
    ];
    let span = Span::of(curves.iter().flat_map(|curve| curve.values)).padded(0.04);
    let height = plot(
        &mut sheet,
        view,
        Axis::new(&view.input, span),
        &curves,
        &inverse.moving,
        PLOT_HEIGHT,
    )
    .1;
    Some(view.finish(Figure::InputTime, sheet, height))
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

/// Draws `curves` over all of the recording's time; returns the panel and the height of the figure.
pub(super) fn plot(
    sheet: &mut Sheet,
    view: &View<'_>,
    y: Axis,
    curves: &[Curve<'_>],
    moving: &[bool],
    height: f64,
) -> (Panel, f64) {
    let (panel, height) = frame(sheet, view, y, height);
    panel.shade(
        &mut sheet.canvas,
        stretches(moving)
            .iter()
            .map(|stretch| extent(&view.time, stretch)),
    );
    draw(sheet, view, &panel, curves);
    (panel, height)
}

/// An empty panel over all of the recording's time, and the height of the figure.
fn frame(sheet: &mut Sheet, view: &View<'_>, y: Axis, height: f64) -> (Panel, f64) {
    let left = MARGIN + left_of(&y, height);
    let area = Rect {
        x: left,
        y: sheet.top,
        width: WIDTH - MARGIN - left,
        height,
    };
    let x = time_axis(&view.time_label, Span::of(view.time.iter()));
    let panel = Panel::draw(&mut sheet.canvas, area, x, y, Labels { x: true, y: true });
    (panel, area.bottom() + BELOW + 4.0)
}

fn draw(sheet: &mut Sheet, view: &View<'_>, panel: &Panel, curves: &[Curve<'_>]) {
    for curve in curves {
        panel.curve(&mut sheet.canvas, &view.time, curve.values, &curve.stroke);
    }
}
