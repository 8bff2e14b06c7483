//! Fig. 8(b): how large the weights are.

use crate::draw::axis::{Axis, Span};
use crate::draw::colour_bar::{BAR, BESIDE, colour_bar, room};
use crate::draw::panel::{Panel, left_of};
use crate::draw::shape::Rect;
use crate::draw::sheet::{Key, MARGIN, Sheet};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::plane::{Cell, Half, axes};

pub(super) const WIDTH: f64 = 600.0;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig08b-weights-map",
        chapter: Some("8(b)"),
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(_: &View<'_>) -> Option<[String; 2]> {
    Some([
        "Size of the weights".into(),
        "The weights μ over the plane; the darker, the larger.".into(),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let half = Half::of_values(view.source.plane(), view.source.weights());
    let span = Span::from_zero(half.cells().map(|cell| cell.sum));
    let scale = Axis::new(&view.output.renamed("weight μ"), span);

    let mut keys = Vec::new();
    keys.extend((span.low < 0.0).then(|| Key::Text("cells with − : weights below zero".into())));
    keys.extend(half.remark().map(Key::Text));
    if keys.is_empty() {
        keys.push(Key::Text(String::new()));
    }
    sheet.legend(&keys);

    let panel = plot(sheet, view, &half, |cell| cell.sum, &scale, span.largest());
    half.signs(&mut sheet.canvas, &panel, view.source.zero());
    Some(panel.end())
}

/// The plane, each cell coloured by its value relative to `largest`, and the bar of `scale`.
pub(super) fn plot(
    sheet: &mut Sheet,
    view: &View<'_>,
    half: &Half,
    value: impl Fn(&Cell) -> f64,
    scale: &Axis,
    largest: f64,
) -> Panel {
    let [alpha, beta] = axes(view.source.plane(), &view.input);
    let left = MARGIN + left_of(&beta, WIDTH);
    let side = WIDTH - MARGIN - left - room(scale, WIDTH);
    let area = Rect {
        x: left,
        y: sheet.top,
        width: side,
        height: side,
    };
    let panel = half.panel(&mut sheet.canvas, area, alpha, beta, false);
    half.fill(&mut sheet.canvas, &panel, value, largest);
    let bar = Rect {
        x: area.right() + BESIDE,
        width: BAR,
        ..area
    };
    colour_bar(&mut sheet.canvas, bar, scale, largest);
    panel
}
