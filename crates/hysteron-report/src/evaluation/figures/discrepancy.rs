//! Figs. 12 and 14: modelled minus measured over time.

use super::over_time::{Curve, WIDTH, plot, policies};
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::{Drawing, Key};
use crate::draw::style::{ANTICIPATE, DISCREPANCY, MODELLED, ZERO};
use crate::evaluation::captions::rmse_and_max;
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::number::difference;
use crate::stack::Figures;

const PLOT_HEIGHT: f64 = 210.0;

pub(super) fn output(view: &View<'_>) -> Drawing {
    let mut sheet = view.sheet(Figure::OutputDiscrepancy, WIDTH);
    sheet.legend(&[
        Key::Line(DISCREPANCY, format!("modelled − {}", view.recorded())),
        Key::Text(rmse_and_max(&view.evaluation.forward, &view.output)),
    ]);
    let difference = difference(&view.evaluation.output_model, &view.recording.output);
    let curves = [Curve {
        values: &difference,
        stroke: DISCREPANCY,
    }];
    let y = Axis::new(
        &view.output.renamed("discrepancy"),
        around_zero(&difference),
    );
    let (panel, height) = plot(&mut sheet, view, y, &curves, &[], PLOT_HEIGHT);
    panel.level(&mut sheet.canvas, 0.0, &ZERO);
    view.finish(Figure::OutputDiscrepancy, sheet, height)
}

pub(super) fn input(view: &View<'_>) -> Option<Drawing> {
    let inverse = view.inverse()?;
    let mut sheet = view.sheet(Figure::InputDiscrepancy, WIDTH);
    sheet.legend(&policies(&inverse.moving));
    let hold = difference(&inverse.hold.input_model, &view.recording.input);
    let anticipate = difference(&inverse.anticipate.input_model, &view.recording.input);
    let curves = [
        Curve {
            values: &hold,
            stroke: MODELLED,
        },
        Curve {
            values: &anticipate,
            stroke: ANTICIPATE,
        },
    ];
    let y = Axis::new(
        &view.input.renamed("discrepancy"),
        around_zero(hold.iter().chain(&anticipate)),
    )
    .told_apart("input ");
    let (panel, height) = plot(&mut sheet, view, y, &curves, &inverse.moving, PLOT_HEIGHT);
    panel.level(&mut sheet.canvas, 0.0, &ZERO);
    Some(view.finish(Figure::InputDiscrepancy, sheet, height))
}

/// The range of the differences, with zero in it.
fn around_zero<'a>(values: impl IntoIterator<Item = &'a f64>) -> Span {
    Span::of(values).with(0.0).padded(0.06)
}
