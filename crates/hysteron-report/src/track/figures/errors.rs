//! Error and prediction error over time, a panel for each controller.

use super::cut::{MARKS, beyond, error_of, events, named, robust};
use crate::draw::axis::Axis;
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::{BEYOND, FOLLOWER, ZERO};
use crate::figure::Figure;
use crate::number::difference;
use crate::panels::{Heading, WIDTH, event_lines, height, stack};
use crate::track::tracking::NamedTrace;
use crate::track::view::View;

pub(crate) fn tracking<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "track-error",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words: words_of_tracking,
        draw: draw_tracking,
    }
}

fn words_of_tracking(view: &View<'_>) -> Option<[String; 2]> {
    let output = &view.output.name;
    Some([
        format!("error of the {output}"),
        format!(
            "The {output} minus the reference, for every controller on the same axis. {MARKS}{}",
            events(view)
        ),
    ])
}

fn draw_tracking(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let runs = view.tracking.runs.iter();
    let errors: Vec<_> = runs.map(|run| (run, error_of(run))).collect();
    Some(differences(
        view,
        sheet,
        &errors,
        ["output − reference", ""],
    ))
}

pub(crate) fn prediction<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "track-prediction",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words: words_of_prediction,
        draw: draw_prediction,
    }
}

fn words_of_prediction(view: &View<'_>) -> Option<[String; 2]> {
    let output = &view.output.name;
    Some([
        format!("prediction error of the {output}"),
        format!(
            "The {output} that the controller's model expected before it learned from the reading, \
             minus the {output} that came, for the controllers with a model.{}",
            events(view)
        ),
    ])
}

fn draw_prediction(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let of = |run: &NamedTrace<'_>| difference(&run.trace.prediction, &run.trace.output);
    let runs = view.tracking.runs.iter().map(|run| (run, of(run)));
    let predicted: Vec<_> = runs
        .filter(|(_, values)| values.iter().any(|value| value.is_finite()))
        .collect();
    let words = ["predicted − reached output", "predicted "];
    (!predicted.is_empty()).then(|| differences(view, sheet, &predicted, words))
}

/// A panel for each of `runs`; `what` is what the difference is, `told_apart` its key beside others
/// in the same unit.
fn differences(
    view: &View<'_>,
    sheet: &mut Sheet,
    runs: &[(&NamedTrace<'_>, Vec<f64>)],
    [what, told_apart]: [&'static str; 2],
) -> f64 {
    let (span, cut) = robust(runs.iter().map(|(_, values)| values.as_slice()));
    let y = Axis::new(&view.output.renamed("error"), span).told_apart(told_apart);
    let mut keys = vec![Key::Line(FOLLOWER, what.into())];
    keys.extend(cut.then(|| Key::Line(BEYOND, "beyond the axis".into())));
    sheet.legend(&keys);
    let headings: Vec<Heading> = runs
        .iter()
        .map(|(run, values)| named(run, rms_and_largest(view, values)))
        .collect();
    let (panels, bottom) = stack(
        sheet,
        view.tracking.events,
        &headings,
        [&view.time_axis, &y],
        height(runs.len()),
        [0.0; 2],
    );
    for (panel, (run, values)) in panels.iter().zip(runs) {
        panel.level(&mut sheet.canvas, 0.0, &ZERO);
        panel.curve(&mut sheet.canvas, &run.trace.time, values, &FOLLOWER);
        beyond(sheet, panel, &run.trace.time, values, span);
        event_lines(sheet, view.tracking.events, panel);
    }
    bottom
}

fn rms_and_largest(view: &View<'_>, values: &[f64]) -> String {
    let (mut sum, mut count, mut largest) = (0.0, 0usize, 0.0_f64);
    for value in values.iter().filter(|value| value.is_finite()) {
        sum += value * value;
        count += 1;
        largest = largest.max(value.abs());
    }
    if count == 0 {
        return "no number".into();
    }
    format!(
        "RMS {}, largest {}",
        view.output.value((sum / count as f64).sqrt()),
        view.output.value(largest)
    )
}
