//! Fig. 11: output over input, modelled and measured.

use super::over_time::measured_and_modelled;
use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::sheet::{Drawing, MARGIN};
use crate::draw::style::{BAND, MEASURED, MODELLED};
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::stack::Figures;

const WIDTH: f64 = 620.0;
const PLOT_HEIGHT: f64 = 420.0;

pub(super) fn svg(view: &View<'_>) -> Drawing {
    let mut sheet = view.sheet(Figure::Loops, WIDTH);
    sheet.legend(&measured_and_modelled(view));
    let (input, output, modelled) = (
        &view.recording.input,
        &view.recording.output,
        &view.evaluation.output_model,
    );
    let band = view.band_edges();
    let edges = band.iter().flatten().flatten();
    let x = Axis::new(&view.input, Span::of(input).padded(0.03));
    let y = Axis::new(
        &view.output,
        Span::of(output.iter().chain(modelled).chain(edges)).padded(0.04),
    );
    let left = MARGIN + left_of(&y, PLOT_HEIGHT);
    let area = Rect {
        x: left,
        y: sheet.top,
        width: WIDTH - MARGIN - left,
        height: PLOT_HEIGHT,
    };
    let panel = Panel::draw(&mut sheet.canvas, area, x, y, Labels { x: true, y: true });
    if let Some(band) = &band {
        panel.band(&mut sheet.canvas, input, band, BAND);
    }
    panel.loops(&mut sheet.canvas, input, output, &MEASURED);
    panel.loops(&mut sheet.canvas, input, modelled, &MODELLED);
    view.finish(Figure::Loops, sheet, area.bottom() + BELOW + 4.0)
}
