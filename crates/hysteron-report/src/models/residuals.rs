//! Residuals over time and over the input, a panel for each model.

use super::view::{Figure, View};
use crate::draw::axis::{Axis, Span, time_axis};
use crate::draw::sheet::Key;
use crate::draw::style::{FOLLOWER, ZERO};
use crate::panels::{WIDTH, height, stack};
use crate::stack::Figures;

pub(super) fn over_time(view: &View<'_>) -> String {
    let x = time_axis(&view.time_label, Span::of(view.time.iter()));
    draw(Figure::Time, view, &x)
}

pub(super) fn over_input(view: &View<'_>) -> String {
    let span = Span::of(&view.report.recording.input).padded(0.03);
    draw(Figure::Input, view, &Axis::new(&view.input, span))
}

fn draw(figure: Figure, view: &View<'_>, x: &Axis) -> String {
    let mut sheet = view.sheet(figure, WIDTH);
    let words = if view.simulated() {
        "simulated"
    } else {
        "measured"
    };
    sheet.legend(&[Key::Line(FOLLOWER, format!("modelled − {words}"))]);
    let all = view.residuals.iter().flatten();
    let y = Axis::new(&view.residual(), Span::of(all).with(0.0).padded(0.06));
    let headings = view.headings();
    let high = height(headings.len());
    let (panels, bottom) = stack(&mut sheet, &[], &headings, [x, &y], high, [0.0; 2]);
    for (panel, residuals) in panels.iter().zip(&view.residuals) {
        panel.level(&mut sheet.canvas, 0.0, &ZERO);
        match figure {
            Figure::Input => {
                let input = &view.report.recording.input;
                panel.loops(&mut sheet.canvas, input, residuals, &FOLLOWER);
            }
            _ => panel.curve(&mut sheet.canvas, &view.time, residuals, &FOLLOWER),
        }
    }
    view.finish(figure, sheet, bottom)
}
