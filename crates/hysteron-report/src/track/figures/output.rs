//! Output and reference over time, a panel for each controller.

use super::cut::{MARKS, beyond, error_of, events, named, robust};
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::{BEYOND, FOLLOWER, REFERENCE};
use crate::figure::Figure;
use crate::panels::{Heading, WIDTH, event_lines, height, stack};
use crate::track::tracking::NamedTrace;
use crate::track::view::View;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "track-output",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let output = &view.output.name;
    Some([
        format!("{output} and its reference"),
        format!(
            "The {output} that each controller reached, over the wide line of the reference. \
             {MARKS}{}",
            events(view)
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let runs = view.tracking.runs;
    let references = || runs.iter().flat_map(|run| &run.trace.reference);
    let outputs = || runs.iter().flat_map(|run| &run.trace.output);
    let mut span = Span::covering(references().chain(outputs()));
    let errors: Vec<Vec<f64>> = runs.iter().map(error_of).collect();
    let (error, cut) = robust(errors.iter().map(Vec::as_slice));
    if cut {
        // A range around the reference as wide as the range of the errors.
        let asked = Span::covering(references());
        span = Span {
            low: span.low.max(asked.low + error.low),
            high: span.high.min(asked.high + error.high),
        };
    }
    let span = span.padded(0.05);
    let y = Axis::new(&view.output, span);
    let mut keys = vec![
        Key::Line(REFERENCE, "reference".into()),
        Key::Line(FOLLOWER, view.output.name.clone()),
    ];
    keys.extend(cut.then(|| Key::Line(BEYOND, "beyond the axis".into())));
    sheet.legend(&keys);
    let headings: Vec<Heading> = runs.iter().map(|run| named(run, String::new())).collect();
    let (panels, bottom) = stack(
        sheet,
        view.tracking.events,
        &headings,
        [&view.time_axis, &y],
        height(runs.len()),
        [0.0; 2],
    );
    for (panel, NamedTrace { trace, .. }) in panels.iter().zip(runs) {
        panel.curve(&mut sheet.canvas, &trace.time, &trace.reference, &REFERENCE);
        panel.curve(&mut sheet.canvas, &trace.time, &trace.output, &FOLLOWER);
        beyond(sheet, panel, &trace.time, &trace.output, span);
        event_lines(sheet, view.tracking.events, panel);
    }
    Some(bottom)
}
