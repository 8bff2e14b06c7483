//! Fig. 8(b): how large the weights are.

use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::colour_bar::{BAR, BESIDE, colour_bar, room};
use crate::draw::panel::{BELOW, Panel, left_of};
use crate::draw::sheet::{Drawing, Key, MARGIN, Sheet};
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::plane::{Cell, Half, axes};
use crate::stack::Figures;

pub(super) const WIDTH: f64 = 600.0;

pub(super) fn svg(view: &View<'_>) -> Drawing {
    let half = Half::of_values(view.source.plane(), view.source.weights());
    let span = Span::from_zero(half.cells().map(|cell| cell.sum));
    let scale = Axis::new(&view.output.renamed("weight μ"), span);

    let mut sheet = view.sheet(Figure::WeightsMap, WIDTH);
    let mut keys = Vec::new();
    keys.extend((span.low < 0.0).then(|| Key::Text("cells with − : weights below zero".into())));
    keys.extend(half.remark().map(Key::Text));
    if keys.is_empty() {
        keys.push(Key::Text(String::new()));
    }
    sheet.legend(&keys);

    let (panel, bottom) = plot(
        &mut sheet,
        view,
        &half,
        |cell| cell.sum,
        &scale,
        span.largest(),
    );
    half.signs(&mut sheet.canvas, &panel, view.source.zero());
    view.finish(Figure::WeightsMap, sheet, bottom)
}

/// The plane, each cell coloured by its value relative to `largest`, and the bar of `scale`;
/// returns the panel and the height of the figure.
pub(super) fn plot(
    sheet: &mut Sheet,
    view: &View<'_>,
    half: &Half,
    value: impl Fn(&Cell) -> f64,
    scale: &Axis,
    largest: f64,
) -> (Panel, f64) {
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
    (panel, area.bottom() + BELOW + 4.0)
}
