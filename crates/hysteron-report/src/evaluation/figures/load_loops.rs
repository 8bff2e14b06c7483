//! Fig. 2: the major loops of one model at several loads.

use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::{ANTICIPATE, MEASURED, MODELLED};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::panels::single;
use crate::quantity::Labelled;

const WIDTH: f64 = 620.0;
const PLOT_HEIGHT: f64 = 420.0;

/// Inputs on each branch.
const SAMPLES: usize = 500;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig02-load-loops",
        chapter: Some("2"),
        width: WIDTH,
        is_linked: true,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let name = &view.source.load()?.quantity.name;
    Some([
        format!("major loops by {name}"),
        format!(
            "One model that depends on the {name}: the whole loop at the smallest, the middle and \
             the largest that it was identified at."
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
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

    sheet.legend(&keys);
    let x = Axis::new(&view.input, Span::covering(&input).padded(0.03));
    let outputs = loops.iter().flat_map(|(output, _)| output);
    let y = Axis::new(&view.output, Span::covering(outputs).padded(0.04));
    let panel = single(sheet, x, y, PLOT_HEIGHT);
    for (output, stroke) in &loops {
        panel.loops(&mut sheet.canvas, &input, output, stroke);
    }
    Some(panel.end())
}
