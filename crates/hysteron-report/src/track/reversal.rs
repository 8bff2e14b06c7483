//! The reversal of the reference after which the controllers differ most in their lag.

use super::tracking::Tracking;
use crate::draw::axis::Span;
use hysteron_sim::track::{ReversalLag, reversal_lags};

/// The part of a run before the first event, or of all of it, in which the start has died down.
const BEGUN: f64 = 1.0 / 3.0;

/// A reversal of the reference and what followed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reversal {
    /// When the reference turns, s.
    pub(super) time: f64,
    /// When it turns again.
    pub(super) until: f64,
    /// For each run, the lag after it, s.
    pub(super) lags: Vec<f64>,
}

/// Of the reversals before the first event, the one with the largest difference of lag.
pub(super) fn find(tracking: &Tracking<'_>) -> Option<Reversal> {
    let last = tracking.runs.first()?.trace.time.last()?;
    let to = tracking.events.first().map_or(*last, |(time, _)| *time);
    let from = BEGUN * to;
    let of_runs: Vec<Vec<ReversalLag>> = tracking
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
        let span = Span::covering(&reversal.lags);
        span.high - span.low
    };
    (0..of_runs.first()?.len())
        .filter_map(reversal)
        .max_by(|a, b| spread(a).total_cmp(&spread(b)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::super::fixture::{FOUR, Fixture};
    use super::super::tracking::NamedTrace;
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
        Fixture::new(&FOUR, 10).tracking(true, |tracking| {
            let mut tracking = tracking.clone();
            (tracking.runs, tracking.events) = (&runs, events);
            find(&tracking)
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
