//! Figs. 12 and 14: modelled minus measured over time.

use super::over_time::{Curve, WIDTH, plot, policies};
use super::{finish, sheet};
use crate::captions::rmse_and_max;
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::Key;
use crate::draw::style::{ANTICIPATE, DISCREPANCY, MODELLED, ZERO};
use crate::figure::Figure;
use crate::view::View;

const PLOT_HEIGHT: f64 = 210.0;

pub(super) fn output(view: &View<'_>) -> String {
    let mut sheet = sheet(Figure::OutputDiscrepancy, view, WIDTH);
    sheet.legend(&[
        Key::Line(DISCREPANCY, format!("modelled − {}", view.recorded())),
        Key::Text(rmse_and_max(&view.evaluation.forward, &view.output)),
    ]);
    let difference = View::discrepancy(&view.evaluation.output_model, &view.recording.output);
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
    finish(Figure::OutputDiscrepancy, view, sheet, height)
}

pub(super) fn input(view: &View<'_>) -> Option<String> {
    let inverse = view.inverse()?;
    let mut sheet = sheet(Figure::InputDiscrepancy, view, WIDTH);
    sheet.legend(&policies(&inverse.moving));
    let hold = View::discrepancy(&inverse.hold.input_model, &view.recording.input);
    let anticipate = View::discrepancy(&inverse.anticipate.input_model, &view.recording.input);
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
    );
    let (panel, height) = plot(&mut sheet, view, y, &curves, &inverse.moving, PLOT_HEIGHT);
    panel.level(&mut sheet.canvas, 0.0, &ZERO);
    Some(finish(Figure::InputDiscrepancy, view, sheet, height))
}

/// The range of the differences, with zero in it.
fn around_zero<'a>(values: impl IntoIterator<Item = &'a f64>) -> Span {
    Span::of(values).with(0.0).padded(0.06)
}
