//! Figs. 12 and 14: modelled minus measured over time.

use super::over_time::{plot, policies, ring_worst, worst};
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::{ANTICIPATE, DISCREPANCY, MODELLED, ZERO};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::number::difference;
use crate::panels::WIDTH;
use hysteron::{Errors, InverseRun};

const HEIGHT: f64 = 210.0;

pub(crate) fn output<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig12-output-discrepancy",
        chapter: Some("12"),
        width: WIDTH,
        is_linked: true,
        words: words_of_output,
        draw: draw_output,
    }
}

fn words_of_output(view: &View<'_>) -> Option<[String; 2]> {
    let output = &view.output.name;
    let errors = view.output.rmse_and_max(&view.evaluation.forward);
    Some([
        format!("discrepancy of the modelled {output}"),
        format!("Modelled minus {} {output}: {errors}.", view.recorded()),
    ])
}

fn draw_output(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let mut keys = vec![
        Key::Line(DISCREPANCY, format!("modelled − {}", view.recorded())),
        Key::Text(view.output.rmse_and_max(&view.evaluation.forward)),
    ];
    keys.extend(worst(view));
    sheet.legend(&keys);
    let difference = difference(&view.evaluation.output_model, &view.recording.output);
    let y = view.output.renamed("discrepancy");
    let y = Axis::new(&y, around_zero(&difference));
    let panel = plot(sheet, view, y, &[(&difference, DISCREPANCY)], &[], HEIGHT);
    panel.level(&mut sheet.canvas, 0.0, &ZERO);
    ring_worst(sheet, view, &panel, [&view.time, &difference]);
    Some(panel.end())
}

pub(crate) fn input<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig14-input-discrepancy",
        chapter: Some("14"),
        width: WIDTH,
        is_linked: true,
        words: words_of_input,
        draw: draw_input,
    }
}

fn words_of_input(view: &View<'_>) -> Option<[String; 2]> {
    let (inverse, input) = (view.inverse()?, &view.input.name);
    let policy = |name: &str, run: &InverseRun| {
        let part = |errors: &Option<Errors>, place: String| {
            let errors = errors.as_ref()?;
            Some(format!("{} {place}", view.input.rmse_and_max(errors)))
        };
        let moving = part(&run.moving, format!("where the {} moves", view.output.name));
        let resting = part(&run.dead_band, "in the dead band".to_owned());
        let parts: Vec<String> = moving.into_iter().chain(resting).collect();
        format!("{name}: {}.", parts.join(", "))
    };
    Some([
        format!("discrepancy of the modelled {input}"),
        format!(
            "Modelled minus {} {input}. {} {}",
            view.recorded(),
            policy("Hold", &inverse.hold),
            policy("Anticipate", &inverse.anticipate)
        ),
    ])
}

fn draw_input(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let inverse = view.inverse()?;
    sheet.legend(&policies(&inverse.moving));
    let [hold, anticipate] = [&inverse.hold, &inverse.anticipate]
        .map(|run| difference(&run.input_model, &view.recording.input));
    let y = view.input.renamed("discrepancy");
    let y = Axis::new(&y, around_zero(hold.iter().chain(&anticipate))).told_apart("input ");
    let curves = [(&*hold, MODELLED), (&*anticipate, ANTICIPATE)];
    let panel = plot(sheet, view, y, &curves, &inverse.moving, HEIGHT);
    panel.level(&mut sheet.canvas, 0.0, &ZERO);
    Some(panel.end())
}

/// The range of the differences, with zero in it.
fn around_zero<'a>(values: impl IntoIterator<Item = &'a f64>) -> Span {
    Span::covering(values).with(0.0).padded(0.06)
}
