//! Fig. 2: the major loops of one model at several loads.

use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::sheet::{Drawing, Key, MARGIN};
use crate::draw::style::{ANTICIPATE, MEASURED, MODELLED};
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::quantity::Labelled;
use crate::stack::Figures;

const WIDTH: f64 = 620.0;
const PLOT_HEIGHT: f64 = 420.0;

/// Inputs on each branch.
const SAMPLES: usize = 500;

pub(super) fn svg(view: &View<'_>) -> Option<Drawing> {
    let load = view.source.load()?;
    let (low, high) = load.range();
    // The load moves the loops along the axis.
    let ends = [low, high].map(|load| view.source.active_range(load));
    let bottom = ends
        .iter()
        .flatten()
        .fold(f64::INFINITY, |a, range| a.min(range.0));
    let top = ends
        .iter()
        .flatten()
        .fold(f64::NEG_INFINITY, |a, range| a.max(range.1));
    let up = (0..=SAMPLES).map(|n| bottom + (top - bottom) * n as f64 / SAMPLES as f64);
    let input: Vec<f64> = up.clone().chain(up.rev()).collect();
    let mut loops = Vec::new();
    let quantity = Labelled::first([&load.quantity, &load.quantity], "load");
    let mut keys = Vec::new();
    for (load, stroke) in [
        (low, MEASURED),
        (0.5 * (low + high), MODELLED),
        (high, ANTICIPATE),
    ] {
        loops.push((view.source.at_load(load, &input)?, stroke));
        let words = format!("{} {}", quantity.name, quantity.value(load));
        keys.push(Key::Line(stroke, words));
    }

    let mut sheet = view.sheet(Figure::LoadLoops, WIDTH);
    sheet.legend(&keys);
    let x = Axis::new(&view.input, Span::of(&input).padded(0.03));
    let outputs = loops.iter().flat_map(|(output, _)| output);
    let y = Axis::new(&view.output, Span::of(outputs).padded(0.04));
    let left = MARGIN + left_of(&y, PLOT_HEIGHT);
    let area = Rect {
        x: left,
        y: sheet.top,
        width: WIDTH - MARGIN - left,
        height: PLOT_HEIGHT,
    };
    let panel = Panel::draw(&mut sheet.canvas, area, x, y, Labels { x: true, y: true });
    for (output, stroke) in &loops {
        panel.loops(&mut sheet.canvas, &input, output, stroke);
    }
    let height = area.bottom() + BELOW + 4.0;
    Some(view.finish(Figure::LoadLoops, sheet, height))
}
