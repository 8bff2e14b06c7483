//! Fig. 8(a): where the weights are not zero.

use crate::draw::marker::Marker;
use crate::draw::panel::left_of;
use crate::draw::shape::Rect;
use crate::draw::sheet::{Key, MARGIN, Sheet};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::number::count;
use crate::plane::{Half, axes};

const WIDTH: f64 = 520.0;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig08a-weights-plane",
        chapter: Some("8(a)"),
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let input = &view.input.name;
    Some([
        "Weights on the plane".into(),
        format!(
            "{} of {} weights are not zero. Each stands at the thresholds of its operator: α, \
             where the falling {input} switches it off, and β, where the rising {input} switches \
             it on.",
            count(view.source.weights_not_zero()),
            count(view.source.weights().len()),
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let half = Half::of_values(view.source.plane(), view.source.weights());
    let zero = view.source.zero();
    let [alpha, beta] = axes(view.source.plane(), &view.input);
    let left = MARGIN + left_of(&beta, WIDTH);
    let side = WIDTH - MARGIN - left;
    let radius = 0.33 * side / (half.side as f64 + 1.0);
    // On a fine plane a ring for every zero would look grey. Zeros are left out there.
    let coarse = radius >= 2.0;
    let not_zero = if coarse {
        Marker::Cross
    } else {
        Marker::Square
    };
    let mut keys = vec![Key::Marker(not_zero, "not zero".into(), "")];
    if coarse {
        keys.insert(0, Key::Marker(Marker::Ring, "zero".into(), ""));
    }
    keys.extend(half.remark().map(Key::Text));
    sheet.legend(&keys);

    let area = Rect {
        x: left,
        y: sheet.top,
        width: side,
        height: side,
    };
    let panel = half.panel(&mut sheet.canvas, area, alpha, beta, true);
    let radius = radius.clamp(0.8, 5.5);
    let (some, none): (Vec<_>, Vec<_>) = half.cells().partition(|cell| cell.largest > zero);
    if coarse {
        Marker::Ring.draw(
            &mut sheet.canvas,
            none.iter().map(|cell| panel.point(cell.alpha, cell.beta)),
            radius,
        );
    }
    not_zero.draw(
        &mut sheet.canvas,
        some.iter().map(|cell| panel.point(cell.alpha, cell.beta)),
        radius,
    );
    Some(panel.end())
}
