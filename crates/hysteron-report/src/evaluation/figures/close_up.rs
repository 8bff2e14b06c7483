//! Fig. 15: the dead band with the largest input discrepancy, close up.

use super::over_time::policies;
use crate::draw::axis::{Axis, Span, time_axis};
use crate::draw::panel::{Labels, Panel, left_of};
use crate::draw::shape::Rect;
use crate::draw::sheet::{Key, MARGIN, Sheet};
use crate::draw::stretches::{extent, stretches};
use crate::draw::style::{ANTICIPATE, GUIDE, MEASURED, MODELLED};
use crate::evaluation::dead_band::{Worst, worst};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::panels::WIDTH;
use std::ops::Range;

const OUTPUT_HEIGHT: f64 = 150.0;
const INPUT_HEIGHT: f64 = 250.0;
const GAP: f64 = 16.0;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig15-dead-band",
        chapter: Some("15"),
        width: WIDTH,
        is_linked: true,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let (inverse, worst) = (view.inverse()?, find(view)?);
    let (input, output) = (&view.input.name, &view.output.name);
    let at = |series: &[f64]| series[worst.sample];
    let measured = at(&view.recording.input);
    let [begin, end, when] = [worst.stretch.start, worst.stretch.end - 1, worst.sample]
        .map(|k| view.time_label.value(view.time[k]));
    let [held, anticipated] = [&inverse.hold, &inverse.anticipate]
        .map(|run| view.input.value((at(&run.input_model) - measured).abs()));
    Some([
        "Largest dead-band discrepancy, close up".into(),
        format!(
            "The {output} rests from {begin} to {end} while the {input} travels. At {when} the \
             held {input} is off by {held}, the anticipated one by {anticipated}."
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let inverse = view.inverse()?;
    let found = find(view)?;
    let window = around(&found.stretch, view.recording.input.len());
    let [output, input] =
        [&view.recording.output, &view.recording.input].map(|series| part(series, &window));
    let [hold, anticipate] =
        [&inverse.hold, &inverse.anticipate].map(|run| part(&run.input_model, &window));
    let time = part(&view.time, &window);

    let mut keys = vec![Key::Line(MEASURED, view.recorded().into())];
    keys.extend(policies(&inverse.moving));
    keys.push(Key::Line(GUIDE, "largest discrepancy of hold".into()));
    sheet.legend(&keys);

    let x = time_axis(&view.time_label, Span::covering(time));
    let upper_y = Axis::new(&view.output, Span::covering(output).padded(0.08));
    let lower_y = Axis::new(
        &view.input,
        Span::covering([input, hold, anticipate].concat().iter()).padded(0.06),
    );
    let left = MARGIN + left_of(&upper_y, OUTPUT_HEIGHT).max(left_of(&lower_y, INPUT_HEIGHT));
    let upper = Rect {
        x: left,
        y: sheet.top,
        width: WIDTH - MARGIN - left,
        height: OUTPUT_HEIGHT,
    };
    let lower = Rect {
        y: upper.bottom() + GAP,
        height: INPUT_HEIGHT,
        ..upper
    };

    let bands: Vec<[f64; 2]> = stretches(&inverse.moving)
        .iter()
        .filter(|stretch| stretch.start < window.end && stretch.end > window.start)
        .map(|stretch| extent(&view.time, stretch))
        .collect();
    let canvas = &mut sheet.canvas;
    let above = Panel::draw(
        canvas,
        upper,
        x.clone(),
        upper_y,
        Labels { x: false, y: true },
    );
    let below = Panel::draw(canvas, lower, x, lower_y, Labels { x: true, y: true });
    for panel in [&above, &below] {
        panel.shade(canvas, bands.iter().copied());
        if let Some(at) = view.time.get(found.sample) {
            panel.upright(canvas, *at, &GUIDE, "");
        }
    }
    above.curve(canvas, time, output, &MEASURED);
    below.curve(canvas, time, input, &MEASURED);
    below.curve(canvas, time, hold, &MODELLED);
    below.curve(canvas, time, anticipate, &ANTICIPATE);
    Some(below.end())
}

/// The dead band that the figure shows.
fn find(view: &View<'_>) -> Option<Worst> {
    let inverse = view.inverse()?;
    worst(
        &inverse.moving,
        &inverse.hold.input_model,
        &view.recording.input,
    )
}

/// Some samples before, and more after, where the model catches up.
fn around(stretch: &Range<usize>, samples: usize) -> Range<usize> {
    let length = stretch.len();
    stretch.start.saturating_sub((length * 3 / 4).max(6))
        ..(stretch.end + (length * 5 / 4).max(10)).min(samples)
}

fn part<'a>(series: &'a [f64], window: &Range<usize>) -> &'a [f64] {
    series
        .get(window.start..window.end.min(series.len()))
        .unwrap_or(&[])
}
