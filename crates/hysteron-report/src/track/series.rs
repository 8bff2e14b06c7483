//! Output, error and prediction error over time, a panel for each controller.

use super::figure::Figure;
use super::report::NamedTrace;
use super::view::View;
use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::panel::Panel;
use crate::draw::sheet::{Drawing, Key, Sheet};
use crate::draw::stretches::extent;
use crate::draw::stretches::stretches;
use crate::draw::style::{BEYOND, FOLLOWER, REFERENCE, ZERO};
use crate::number::difference;
use crate::panels::{Heading, WIDTH, event_lines, height, stack};
use crate::stack::Figures;

/// The part of all values that must be seen; what lies far beyond is cut off.
const SEEN: f64 = 0.98;
/// How far beyond that the axis goes.
const ROOM: f64 = 1.6;

pub(super) fn tracking(view: &View<'_>) -> Drawing {
    let runs = view.report.runs;
    let references = || runs.iter().flat_map(|run| &run.trace.reference);
    let outputs = || runs.iter().flat_map(|run| &run.trace.output);
    let mut span = Span::of(references().chain(outputs()));
    let errors: Vec<Vec<f64>> = runs.iter().map(error_of).collect();
    let (error, cut) = robust(errors.iter().map(Vec::as_slice));
    if cut {
        // A range around the reference as wide as the range of the errors.
        let asked = Span::of(references());
        span = Span {
            low: span.low.max(asked.low + error.low),
            high: span.high.min(asked.high + error.high),
        };
    }
    let span = span.padded(0.05);
    let y = Axis::new(&view.output, span);
    let mut sheet = view.sheet(Figure::Tracking, WIDTH);
    let mut keys = vec![
        Key::Line(REFERENCE, "reference".into()),
        Key::Line(FOLLOWER, view.output.name.clone()),
    ];
    keys.extend(cut.then(|| Key::Line(BEYOND, "beyond the axis".into())));
    sheet.legend(&keys);
    let headings: Vec<Heading> = runs.iter().map(|run| named(run, String::new())).collect();
    let (panels, bottom) = stack(
        &mut sheet,
        view.report.events,
        &headings,
        [&view.time_axis, &y],
        height(runs.len()),
        [0.0; 2],
    );
    for (panel, NamedTrace { trace, .. }) in panels.iter().zip(runs) {
        panel.curve(&mut sheet.canvas, &trace.time, &trace.reference, &REFERENCE);
        panel.curve(&mut sheet.canvas, &trace.time, &trace.output, &FOLLOWER);
        beyond(&mut sheet, panel, &trace.time, &trace.output, span);
        event_lines(&mut sheet, view.report.events, panel);
    }
    view.finish(Figure::Tracking, sheet, bottom)
}

fn error_of(run: &NamedTrace<'_>) -> Vec<f64> {
    difference(&run.trace.output, &run.trace.reference)
}

pub(super) fn error(view: &View<'_>) -> Drawing {
    let runs = view.report.runs.iter();
    let errors: Vec<_> = runs.map(|run| (*run, error_of(run))).collect();
    differences(Figure::Error, view, &errors)
}

pub(super) fn prediction(view: &View<'_>) -> Option<Drawing> {
    let of = |run: &NamedTrace<'_>| difference(&run.trace.prediction, &run.trace.output);
    let runs = view.report.runs.iter().map(|run| (*run, of(run)));
    let told: Vec<_> = runs
        .filter(|(_, values)| values.iter().any(|value| value.is_finite()))
        .collect();
    (!told.is_empty()).then(|| differences(Figure::Prediction, view, &told))
}

fn differences(figure: Figure, view: &View<'_>, runs: &[(NamedTrace<'_>, Vec<f64>)]) -> Drawing {
    let (span, cut) = robust(runs.iter().map(|(_, values)| values.as_slice()));
    let told_apart = match figure {
        Figure::Prediction => "predicted ",
        _ => "",
    };
    let y = Axis::new(&view.output.renamed("error"), span).told_apart(told_apart);
    let mut sheet = view.sheet(figure, WIDTH);
    let difference = match figure {
        Figure::Prediction => "predicted − reached output",
        _ => "output − reference",
    };
    let mut keys = vec![Key::Line(FOLLOWER, difference.into())];
    keys.extend(cut.then(|| Key::Line(BEYOND, "beyond the axis".into())));
    sheet.legend(&keys);
    let headings: Vec<Heading> = runs
        .iter()
        .map(|(run, values)| named(run, rms_and_largest(view, values)))
        .collect();
    let (panels, bottom) = stack(
        &mut sheet,
        view.report.events,
        &headings,
        [&view.time_axis, &y],
        height(runs.len()),
        [0.0; 2],
    );
    for (panel, (run, values)) in panels.iter().zip(runs) {
        panel.level(&mut sheet.canvas, 0.0, &ZERO);
        panel.curve(&mut sheet.canvas, &run.trace.time, values, &FOLLOWER);
        beyond(&mut sheet, panel, &run.trace.time, values, span);
        event_lines(&mut sheet, view.report.events, panel);
    }
    view.finish(figure, sheet, bottom)
}

pub(super) fn named(run: &NamedTrace<'_>, remark: String) -> Heading {
    Heading {
        name: run.name.to_owned(),
        remark,
    }
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

/// A range around zero in which most of the values of most panels can be told apart, and whether it
/// leaves some out.
///
/// Half of the panels decide: a few controllers that are far off throughout must not make the
/// others illegible.
pub(super) fn robust<'a>(panels: impl Iterator<Item = &'a [f64]> + Clone) -> (Span, bool) {
    let all = Span::of(panels.clone().flatten()).with(0.0).padded(0.06);
    let mut seen: Vec<f64> = panels.filter_map(far).collect();
    seen.sort_unstable_by(f64::total_cmp);
    let seen = ROOM
        * seen
            .get(seen.len().saturating_sub(1) / 2)
            .copied()
            .unwrap_or(0.0);
    let cut = Span {
        low: all.low.max(-seen),
        high: all.high.min(seen),
    };
    // If a cut widens the scale only a little, everything is shown instead.
    if seen > 0.0 && cut.high - cut.low < 0.6 * (all.high - all.low) {
        (cut, true)
    } else {
        (all, false)
    }
}

/// How far from zero most of the values lie.
fn far(values: &[f64]) -> Option<f64> {
    let finite = values.iter().filter(|value| value.is_finite());
    let mut sizes: Vec<f64> = finite.map(|value| value.abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let rank = (SEEN * sizes.len().saturating_sub(1) as f64) as usize;
    sizes.get(rank).copied()
}

/// Marks at the edge where `values` leave the panel.
pub(super) fn beyond(sheet: &mut Sheet, panel: &Panel, time: &[f64], values: &[f64], span: Span) {
    let area = panel.area;
    type Leaves = fn(f64, Span) -> bool;
    let edges: [(f64, Leaves); 2] = [
        (area.y, |value, span| value > span.high),
        (area.bottom() - BEYOND.width, |value, span| value < span.low),
    ];
    for (y, leaves) in edges {
        let inside: Vec<bool> = values.iter().map(|value| !leaves(*value, span)).collect();
        let bands = stretches(&inside);
        let edge = Rect {
            y,
            height: BEYOND.width,
            ..area
        };
        let times = bands.iter().map(|stretch| extent(time, stretch));
        panel.fill(&mut sheet.canvas, times, edge, BEYOND.colour);
    }
}
