//! The reversal after which the controllers differ most in their lag, close up.

use super::cut::{beyond, named, robust};
use crate::draw::axis::{Axis, Span, time_axis};
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::{BEYOND, FOLLOWER, GUIDE, REFERENCE};
use crate::figure::Figure;
use crate::number::difference;
use crate::panels::{WIDTH, height, stack};
use crate::track::view::View;

/// What is shown before the reversal, as a part of the branch after it.
const BEFORE: f64 = 0.25;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "track-reversal",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let reversal = view.reversal.as_ref()?;
    Some([
        "After a reversal of the reference".into(),
        format!(
            "The reversal of the reference at {}: of those before the first event, the one with the \
             largest difference of lag. The lag is the time by which the {} goes back by a \
             twentieth of the range later than the reference, each from its own extreme. The dashed \
             line is the reversal.",
            view.time.value(reversal.time),
            view.output.name
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let reversal = view.reversal.as_ref()?;
    let runs = view.tracking.runs;
    let time = &runs.first()?.trace.time;
    let begin = reversal.time - BEFORE * (reversal.until - reversal.time);
    let window =
        time.partition_point(|t| *t < begin)..time.partition_point(|t| *t <= reversal.until);
    let part = |series: &'_ [f64]| series.get(window.clone()).unwrap_or(&[]).to_vec();
    let time = part(time);
    let references: Vec<Vec<f64>> = runs.iter().map(|run| part(&run.trace.reference)).collect();
    let outputs: Vec<Vec<f64>> = runs.iter().map(|run| part(&run.trace.output)).collect();
    let pairs = outputs.iter().zip(&references);
    let errors: Vec<Vec<f64>> = pairs.map(|(y, r)| difference(y, r)).collect();
    let (error, cut) = robust(errors.iter().map(Vec::as_slice));
    let asked = Span::covering(references.iter().flatten());
    let span = Span {
        low: asked.low + error.low,
        high: asked.high + error.high,
    }
    .padded(0.04);
    let [x, y] = [
        time_axis(&view.time, Span::covering(&time)),
        Axis::new(&view.output, span),
    ];

    let mut keys = vec![
        Key::Line(REFERENCE, "reference".into()),
        Key::Line(FOLLOWER, view.output.name.clone()),
    ];
    keys.extend(cut.then(|| Key::Line(BEYOND, "beyond the axis".into())));
    sheet.legend(&keys);
    let lags = reversal.lags.iter();
    let headings: Vec<_> = runs
        .iter()
        .zip(lags)
        .map(|(run, lag)| named(run, format!("lag {}", view.time.value(*lag))))
        .collect();
    let panels_height = height(runs.len());
    let (panels, bottom) = stack(
        sheet,
        view.tracking.events,
        &headings,
        [&x, &y],
        panels_height,
        [0.0; 2],
    );
    for ((panel, output), reference) in panels.iter().zip(&outputs).zip(&references) {
        panel.curve(&mut sheet.canvas, &time, reference, &REFERENCE);
        panel.curve(&mut sheet.canvas, &time, output, &FOLLOWER);
        beyond(sheet, panel, &time, output, span);
        panel.upright(&mut sheet.canvas, reversal.time, &GUIDE, "");
    }
    Some(bottom)
}
