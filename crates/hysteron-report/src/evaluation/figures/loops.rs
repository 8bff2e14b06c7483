//! Fig. 11: output over input, modelled and measured.

use super::over_time::{measured_and_modelled, ring_worst};
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::Sheet;
use crate::draw::style::{BAND, MEASURED, MODELLED};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::panels::single;

/// With the residuals beside it, within a page of 1,280 pixels.
const WIDTH: f64 = 600.0;
const PLOT_HEIGHT: f64 = 420.0;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig11-loops",
        chapter: Some("11"),
        width: WIDTH,
        is_linked: true,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let (input, output, recorded) = (&view.input.name, &view.output.name, view.recorded());
    Some([
        format!("{output} over {input}"),
        format!("Modelled and {recorded} {output} over {recorded} {input}: major and minor loops."),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    sheet.legend(&measured_and_modelled(view));
    let (input, output, modelled) = (
        &view.recording.input,
        &view.recording.output,
        &view.evaluation.output_model,
    );
    let band = view.band_edges();
    let edges = band.iter().flatten().flatten();
    let x = Axis::new(&view.input, Span::covering(input).padded(0.03));
    let y = Axis::new(
        &view.output,
        Span::covering(output.iter().chain(modelled).chain(edges)).padded(0.04),
    );
    let panel = single(sheet, x, y, PLOT_HEIGHT);
    if let Some(band) = &band {
        panel.band(&mut sheet.canvas, input, band, BAND);
    }
    panel.loops(&mut sheet.canvas, input, output, &MEASURED);
    panel.loops(&mut sheet.canvas, input, modelled, &MODELLED);
    ring_worst(sheet, view, &panel, [input, output]);
    Some(panel.end())
}
