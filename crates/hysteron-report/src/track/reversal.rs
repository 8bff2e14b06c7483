//! The reversal of the reference after which the controllers differ most in their lag, close up.

use super::figure::Figure;
use super::report::TrackReport;
use super::series::{beyond, named, robust};
use super::view::View;
use crate::draw::axis::time_axis;
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::{Drawing, Key};
use crate::draw::style::{BEYOND, FOLLOWER, GUIDE, REFERENCE};
use crate::number::difference;
use crate::panels::{WIDTH, height, stack};
use crate::stack::Figures;
use hysteron_sim::track::{ReversalLag, reversal_lags};

/// The part of a run before the first event, or of all of it, in which the start has died down.
const BEGUN: f64 = 1.0 / 3.0;
/// What is shown before the reversal, as a part of the branch after it.
const BEFORE: f64 = 0.25;

/// A reversal of the reference and what followed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reversal {
    /// When the reference turns, s.
    pub(super) time: f64,
    /// When it turns again.
    until: f64,
    /// For each run, the lag after it, s.
    pub(super) lags: Vec<f64>,
}

/// Of the reversals before the first event, the one with the largest difference of lag.
pub(super) fn find(report: &TrackReport<'_>) -> Option<Reversal> {
    let last = report.runs.first()?.trace.time.last()?;
    let to = report.events.first().map_or(*last, |(time, _)| *time);
    let from = BEGUN * to;
    let of_runs: Vec<Vec<ReversalLag>> = report
        .runs
        .iter()
        .map(|run| reversal_lags(run.trace, from, to))
        .collect();
    let reversal = |n: usize| {
        let lags: Vec<&ReversalLag> = of_runs.iter().filter_map(|lags| lags.get(n)).collect();
        let first = lags.first()?;
        Some(Reversal {
            time: first.time,
            until: first.until,
            lags: lags.iter().map(|lag| lag.lag).collect(),
        })
    };
    let spread = |reversal: &Reversal| {
        let span = Span::of(&reversal.lags);
        span.high - span.low
    };
    (0..of_runs.first()?.len())
        .filter_map(reversal)
        .max_by(|a, b| spread(a).total_cmp(&spread(b)))
}

pub(super) fn svg(view: &View<'_>) -> Option<Drawing> {
    let reversal = view.reversal.as_ref()?;
    let runs = view.report.runs;
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
    let asked = Span::of(references.iter().flatten());
    let span = Span {
        low: asked.low + error.low,
        high: asked.high + error.high,
    }
    .padded(0.04);
    let [x, y] = [
        time_axis(&view.time, Span::of(&time)),
        Axis::new(&view.output, span),
    ];

    let mut sheet = view.sheet(Figure::Reversal, WIDTH);
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
        &mut sheet,
        view.report.events,
        &headings,
        [&x, &y],
        panels_height,
        [0.0; 2],
    );
    for ((panel, output), reference) in panels.iter().zip(&outputs).zip(&references) {
        panel.curve(&mut sheet.canvas, &time, reference, &REFERENCE);
        panel.curve(&mut sheet.canvas, &time, output, &FOLLOWER);
        beyond(&mut sheet, panel, &time, output, span);
        panel.upright(&mut sheet.canvas, reversal.time, &GUIDE, "");
    }
    Some(view.finish(Figure::Reversal, sheet, bottom))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::super::fixture::{FOUR, Fixture};
    use super::super::report::NamedTrace;
    use super::*;
    use hysteron::control::Trace;

    /// A triangle of period 40 samples that a run follows `lag` samples late.
    fn late(lag: usize) -> Trace {
        let triangle = |n: usize| {
            let phase = n % 40;
            phase.min(40 - phase) as f64
        };
        Trace {
            time: (0..240).map(|n| 0.5 * n as f64).collect(),
            reference: (0..240).map(triangle).collect(),
            output: (0..240).map(|n| triangle(n + 240 - lag)).collect(),
            ..Trace::default()
        }
    }

    fn found(traces: &[Trace], events: &[(f64, String)]) -> Option<Reversal> {
        let runs: Vec<_> = traces
            .iter()
            .map(|trace| NamedTrace { name: "run", trace })
            .collect();
        Fixture::new(&FOUR, 10).report(true, |report| {
            let mut report = report.clone();
            (report.runs, report.events) = (&runs, events);
            find(&report)
        })
    }

    #[test]
    fn the_reversal_with_the_largest_difference_is_chosen() {
        let (quick, mut slow) = (late(1), late(1));
        // Four samples later than the other after the reversal at sample 160.
        let later = late(5);
        slow.output[160..180].copy_from_slice(&later.output[160..180]);
        let reversal = found(&[quick, slow], &[]).unwrap();
        assert_eq!((reversal.time, reversal.until), (80.0, 90.0));
        assert_eq!(reversal.lags, [0.5, 2.5]);
    }

    #[test]
    fn only_reversals_before_the_first_event_are_looked_at() {
        let events = [(62.0, "load".to_owned())];
        let reversal = found(&[late(1), late(3)], &events).unwrap();
        assert!(reversal.time < 62.0, "{}", reversal.time);
    }

    #[test]
    fn a_reference_that_does_not_turn_has_no_reversal() {
        let mut trace = late(2);
        trace.reference.fill(0.0);
        assert_eq!(found(&[trace], &[]), None);
    }
}
