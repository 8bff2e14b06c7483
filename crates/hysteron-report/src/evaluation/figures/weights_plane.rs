//! Fig. 8(a): where the weights are not zero.

use crate::draw::canvas::Rect;
use crate::draw::marker::Marker;
use crate::draw::panel::{BELOW, left_of};
use crate::draw::sheet::{Drawing, Key, MARGIN};
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::plane::{Half, axes};
use crate::stack::Figures;

const WIDTH: f64 = 520.0;

pub(super) fn svg(view: &View<'_>) -> Drawing {
    let half = Half::of_values(view.source.plane(), view.source.weights());
    let zero = view.source.zero();
    let mut sheet = view.sheet(Figure::WeightsPlane, WIDTH);
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
    view.finish(Figure::WeightsPlane, sheet, area.bottom() + BELOW + 4.0)
}
