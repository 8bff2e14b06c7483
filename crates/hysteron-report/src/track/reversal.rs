//! The reversal of the reference after which the controllers differ most in their lag, close up.

use super::figure::Figure;
use super::report::NamedTrace;
use super::stack::WIDTH;
use super::view::View;
use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::sheet::{Key, MARGIN};
use crate::draw::style::{GUIDE, LINES, REFERENCE, Stroke};
use crate::figures::time_axis;
use hysteron::{Direction, Turning};
use std::ops::Range;

/// Reversals by less than this part of the reference's range are not looked at.
const SMALLEST: f64 = 0.05;
/// A series has turned once it has gone back by this part of the way to the next reversal.
const TURNED: f64 = 0.05;
/// Curves in one panel, at most: more cannot be told apart in grey.
const TOGETHER: usize = 6;
const HEIGHT: f64 = 300.0;

/// A reversal of the reference and what followed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reversal {
    /// The sample at which the reference turns.
    pub(super) sample: usize,
    /// For each run, how long after the reference its output turned, s; `None` where it did not before the next reversal.
    pub(super) lags: Vec<Option<f64>>,
    /// The samples to show.
    window: Range<usize>,
}

/// Of the reversals in the last third of the runs, the one with the largest difference of lag.
pub(super) fn find(runs: &[NamedTrace<'_>]) -> Option<Reversal> {
    let reference = &runs.first()?.trace.reference;
    let span = Span::of(reference);
    let mut turning = Turning::new(SMALLEST * (span.high - span.low));
    let mut turns: Vec<(usize, Direction)> =
        reference.iter().filter_map(|&r| turning.push(r)).collect();
    let (direction, extreme) = turning.branch()?;
    turns.push((extreme, direction));
    let late = reference.len() * 2 / 3;
    let candidates = turns.windows(2).filter_map(|pair| match pair {
        // The start counts as a turn, but nothing turns there.
        &[(sample, direction), (next, _)] if sample >= late.max(1) && next > sample => {
            Some(reversal(runs, sample, next, direction))
        }
        _ => None,
    });
    let spread = |reversal: &Reversal| {
        let rest = duration(runs, &(reversal.sample..reversal.window.end));
        let lags = reversal.lags.iter().map(|lag| lag.unwrap_or(rest));
        let (low, high) = lags.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), lag| {
            (low.min(lag), high.max(lag))
        });
        high - low
    };
    candidates.max_by(|a, b| spread(a).total_cmp(&spread(b)))
}

fn reversal(runs: &[NamedTrace<'_>], sample: usize, next: usize, direction: Direction) -> Reversal {
    let part = sample..next + 1;
    let turned = |series: &[f64], way: f64| {
        let series = series.get(part.clone())?;
        turn(series, way, direction).map(|n| sample + n)
    };
    let lag = |run: &NamedTrace<'_>| {
        let trace = run.trace;
        let from = trace.reference.get(sample)?;
        let way = TURNED * (trace.reference.get(next)? - from).abs();
        let [asked, done] = [&trace.reference, &trace.output].map(|series| turned(series, way));
        let [asked, done] = [trace.time.get(asked?)?, trace.time.get(done?)?];
        Some(done - asked).filter(|lag| lag.is_finite())
    };
    let followed = runs.iter().filter_map(|run| {
        let way =
            TURNED * (run.trace.reference.get(next)? - run.trace.reference.get(sample)?).abs();
        turned(&run.trace.output, way)
    });
    let length = next - sample;
    let slowest = followed.map(|at| at - sample).max().unwrap_or(length);
    let after = (3 * slowest).max(length / 4).clamp(4, length.max(4));
    Reversal {
        sample,
        lags: runs.iter().map(lag).collect(),
        window: sample.saturating_sub((after / 2).max(2))
            ..(sample + after + 1).min(runs.first().map_or(0, |run| run.trace.time.len())),
    }
}

/// The first sample at which `series` has gone back by `way` in `direction` from its furthest point so far.
fn turn(series: &[f64], way: f64, direction: Direction) -> Option<usize> {
    let sign = match direction {
        Direction::Rising => 1.0,
        Direction::Falling => -1.0,
    };
    let mut furthest = f64::INFINITY;
    series.iter().position(|value| {
        let value = sign * value;
        furthest = furthest.min(value);
        value - furthest > way
    })
}

fn duration(runs: &[NamedTrace<'_>], part: &Range<usize>) -> f64 {
    let time = runs
        .first()
        .and_then(|run| run.trace.time.get(part.clone()));
    match time {
        Some([first, .., last]) => last - first,
        _ => 0.0,
    }
}

pub(super) fn svg(view: &View<'_>) -> Option<String> {
    let reversal = view.reversal.as_ref()?;
    let runs = view.report.runs;
    let part = |series: &'_ [f64]| series.get(reversal.window.clone()).unwrap_or(&[]).to_vec();
    let time = part(&runs.first()?.trace.time);
    let reference = part(&runs.first()?.trace.reference);
    let outputs: Vec<Vec<f64>> = runs.iter().map(|run| part(&run.trace.output)).collect();
    let values = outputs.iter().flatten().chain(&reference);
    let y = Axis::new(&view.output, Span::of(values).padded(0.05));
    let x = time_axis(&view.time, Span::of(&time));

    let mut sheet = view.sheet(Figure::Reversal, WIDTH);
    let mut bottom = sheet.top;
    let groups = runs.chunks(TOGETHER).zip(outputs.chunks(TOGETHER));
    for (group, (runs, outputs)) in groups.enumerate() {
        let first = group * TOGETHER;
        let mut keys: Vec<Key> = vec![Key::Line(REFERENCE, "reference".into())];
        keys.extend(runs.iter().enumerate().map(|(n, run)| {
            let lag = reversal.lags.get(first + n).copied().flatten();
            Key::Line(
                stroke(n),
                format!("{}: {}", run.name, lag_in_words(view, lag)),
            )
        }));
        sheet.legend(&keys);
        let left = MARGIN + left_of(&y, HEIGHT);
        let area = Rect {
            x: left,
            y: sheet.top,
            width: WIDTH - MARGIN - left,
            height: HEIGHT,
        };
        let labels = Labels { x: true, y: true };
        let panel = Panel::draw(&mut sheet.canvas, area, x.clone(), y.clone(), labels);
        panel.curve(&mut sheet.canvas, &time, &reference, &REFERENCE);
        for (n, output) in outputs.iter().enumerate() {
            panel.curve(&mut sheet.canvas, &time, output, &stroke(n));
        }
        if let Some(time) = runs
            .first()
            .and_then(|run| run.trace.time.get(reversal.sample))
        {
            let at = panel.px(*time);
            if at.is_finite() {
                let (top, bottom) = (area.y, area.bottom());
                sheet.canvas.line([at, top], [at, bottom], &GUIDE);
            }
        }
        bottom = area.bottom() + BELOW + 4.0;
        sheet.top = bottom + 8.0;
    }
    Some(view.finish(Figure::Reversal, sheet, bottom))
}

/// The darkest first, so that few curves stand out best.
fn stroke(n: usize) -> Stroke {
    LINES[LINES.len() - 1 - n % TOGETHER]
}

fn lag_in_words(view: &View<'_>, lag: Option<f64>) -> String {
    lag.map_or("does not turn".into(), |lag| {
        format!("lag {}", view.time.value(lag))
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

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

    #[test]
    fn the_lag_is_that_of_the_output_behind_the_reference() {
        let traces = [late(2), late(7)];
        let runs = traces
            .each_ref()
            .map(|trace| NamedTrace { name: "run", trace });
        let found = find(&runs).unwrap();
        assert!(
            found.sample >= 160 && found.sample.is_multiple_of(20),
            "{}",
            found.sample
        );
        assert_eq!(found.lags, [Some(1.0), Some(3.5)]);
        assert!(found.window.contains(&found.sample));
    }

    #[test]
    fn a_reference_that_does_not_turn_late_has_no_reversal() {
        let mut trace = late(2);
        trace.reference[120..].fill(0.0);
        let run = NamedTrace {
            name: "run",
            trace: &trace,
        };
        assert_eq!(find(&[run]), None);
    }

    #[test]
    fn the_reversal_with_the_largest_difference_is_chosen() {
        let (quick, mut slow) = (late(1), late(1));
        // Stands still for a while after the reversal at sample 200.
        let held = slow.output[201];
        slow.output[201..212].fill(held);
        let runs = [&quick, &slow].map(|trace| NamedTrace { name: "run", trace });
        let found = find(&runs).unwrap();
        assert_eq!(found.sample, 200);
        assert!(found.lags[1] > found.lags[0]);
    }
}
