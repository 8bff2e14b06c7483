//! Fig. 10: modelled and measured output over time.

use super::over_time::{Curve, draw as draw_curves, empty, measured_and_modelled, ring_worst};
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::Sheet;
use crate::draw::style::{BAND, MEASURED, MODELLED};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::number::{count, percent};
use crate::panels::WIDTH;

const HEIGHT: f64 = 290.0;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig10-output-time",
        chapter: Some("10"),
        width: WIDTH,
        is_linked: true,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let (output, recorded) = (&view.output.name, view.recorded());
    let band = view.band().map_or(String::new(), |band| {
        let inside = percent(band.coverage_percent);
        format!(" {inside} of them lie inside the {}.", band.name())
    });
    Some([
        format!("{output} over {}", view.time_label.name),
        format!(
            "Modelled {output} and {recorded} {output}: {} over {} samples.{band}",
            view.output.rmse_and_max(&view.evaluation.forward),
            count(view.evaluation.forward.samples),
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    sheet.legend(&measured_and_modelled(view));
    let curves: [Curve<'_>; 2] = [
        (&view.recording.output, MEASURED),
        (&view.evaluation.output_model, MODELLED),
    ];
    let band = view.band_edges();
    let edges = band.iter().flatten().flatten();
    let values = curves.iter().flat_map(|(values, _)| *values);
    let y = Axis::new(
        &view.output,
        Span::covering(values.chain(edges)).padded(0.04),
    );
    let panel = empty(sheet, view, y, HEIGHT);
    if let Some(band) = &band {
        panel.band(&mut sheet.canvas, &view.time, band, BAND);
    }
    draw_curves(sheet, view, &panel, &curves);
    let measured = [&view.time[..], &view.recording.output];
    ring_worst(sheet, view, &panel, measured);
    Some(panel.end())
}
