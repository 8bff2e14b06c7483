//! Fig. 8(b): how large the weights are.

use super::{finish, sheet};
use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::{Anchor, Canvas, Rect, Short, rect_data};
use crate::draw::colour::of_share;
use crate::draw::panel::{BELOW, Panel, left_of};
use crate::draw::sheet::{Key, MARGIN, Sheet};
use crate::draw::style::{AXIS, LABEL, Stroke, TICK};
use crate::draw::text;
use crate::figure::Figure;
use crate::plane::{Cell, Half, axes};
use crate::view::View;
use std::fmt::Write;

pub(super) const WIDTH: f64 = 600.0;
const BAR: f64 = 16.0;
const SHADES: usize = 96;

pub(super) fn svg(view: &View<'_>) -> String {
    let half = Half::of_weights(view.source);
    let (low, high) = half.cells().fold((0.0f64, 0.0f64), |(low, high), cell| {
        (low.min(cell.sum), high.max(cell.sum))
    });
    let largest = if high > -low { high } else { -low };
    let scale = Axis::new(
        &view.output.renamed("weight μ"),
        if low < high {
            Span { low, high }
        } else {
            Span {
                low: 0.0,
                high: 1.0,
            }
        },
    );

    let mut sheet = sheet(Figure::WeightsMap, view, WIDTH);
    let mut keys = Vec::new();
    keys.extend((low < 0.0).then(|| Key::Text("cells with − : weights below zero".into())));
    keys.extend(half.remark().map(Key::Text));
    if keys.is_empty() {
        keys.push(Key::Text(String::new()));
    }
    sheet.legend(&keys);

    let (panel, bottom) = plot(&mut sheet, view, &half, |cell| cell.sum, &scale, largest);
    let mut minus = String::new();
    for cell in half.cells() {
        let [x, y, width] = half.place(&panel, &cell);
        if cell.sum < -view.source.zero() && width > 4.0 {
            let _ = write!(
                minus,
                "M{} {}h{}",
                Short(x + 0.3 * width),
                Short(y + 0.5 * width),
                Short(0.4 * width)
            );
        }
    }
    sheet
        .canvas
        .path(&minus, None, Some(&Stroke::solid("#1b2128", 1.0)));
    finish(Figure::WeightsMap, view, sheet, bottom)
}

/// The plane, each cell coloured by its value relative to `largest`, and the bar of `scale`; returns the panel and
/// the height of the figure.
pub(super) fn plot(
    sheet: &mut Sheet,
    view: &View<'_>,
    half: &Half,
    value: impl Fn(&Cell) -> f64,
    scale: &Axis,
    largest: f64,
) -> (Panel, f64) {
    let [alpha, beta] = axes(view);
    let left = MARGIN + left_of(&beta, WIDTH);
    let bar_room = BAR + 18.0 + left_of(scale, WIDTH);
    let side = WIDTH - MARGIN - left - bar_room;
    let area = Rect {
        x: left,
        y: sheet.top,
        width: side,
        height: side,
    };
    let panel = half.panel(&mut sheet.canvas, area, alpha, beta, false);
    for cell in half.cells() {
        let [x, y, width] = half.place(&panel, &cell);
        let share = if largest > 0.0 {
            value(&cell) / largest
        } else {
            0.0
        };
        // A hair wider than the cell, or the seams between cells shine through.
        let (width, height) = (width + 0.3, width + 0.3);
        let area = Rect {
            x,
            y,
            width,
            height,
        };
        sheet.canvas.rect(area, &of_share(share));
    }
    let bar = Rect {
        x: area.right() + 18.0,
        width: BAR,
        ..area
    };
    colour_bar(&mut sheet.canvas, bar, scale, largest);
    (panel, area.bottom() + BELOW + 4.0)
}

fn colour_bar(canvas: &mut Canvas, area: Rect, scale: &Axis, largest: f64) {
    let Span { low, high } = scale.span;
    let shade = area.height / SHADES as f64;
    for k in 0..SHADES {
        let value = high + (low - high) * (k as f64 + 0.5) / SHADES as f64;
        let share = if largest > 0.0 { value / largest } else { 0.0 };
        canvas.rect(
            Rect {
                y: area.y + k as f64 * shade,
                height: shade + 0.3,
                ..area
            },
            &of_share(share),
        );
    }
    canvas.path(&rect_data(area), None, Some(&Stroke { width: 0.7, ..AXIS }));
    let mut widest: f64 = 0.0;
    for tick in scale.ticks_up(area.height) {
        let y = area.bottom() - (tick.value - low) / (high - low) * area.height;
        canvas.line([area.right(), y], [area.right() + 4.0, y], &AXIS);
        canvas.text(
            [area.right() + 8.0, y + 0.36 * TICK],
            Anchor::Start,
            TICK,
            &tick.label,
        );
        widest = widest.max(text::width(&tick.label, TICK));
    }
    let label = text::fit(&scale.label(), LABEL, area.height);
    canvas.text_upwards(
        [
            area.right() + 14.0 + widest + LABEL,
            area.y + area.height / 2.0,
        ],
        Anchor::Middle,
        LABEL,
        &label,
    );
}
