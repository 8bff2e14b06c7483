//! What every figure reads: runs of controllers in the words and units that are shown.

use super::reversal::{self, Reversal};
use super::tracking::{NamedTrace, Tracking};
use crate::draw::axis::{Axis, Span, time_axis};
use crate::error::ReportError;
use crate::quantity::Labelled;

/// Runs, ready to be drawn.
pub(crate) struct View<'a> {
    pub(super) tracking: &'a Tracking<'a>,
    pub(super) input: Labelled,
    pub(super) output: Labelled,
    pub(super) drive: Labelled,
    pub(super) time: Labelled,
    /// All of the time of all runs.
    pub(super) time_axis: Axis,
    /// The reversal that is shown close up.
    pub(super) reversal: Option<Reversal>,
}

impl<'a> View<'a> {
    /// The runs, once their parts fit together.
    pub(crate) fn new(tracking: &'a Tracking<'a>) -> Result<Self, ReportError> {
        tracking.check()?;
        let label = |quantity, fallback| Labelled::first([quantity, quantity], fallback);
        let time = Labelled {
            name: "time".into(),
            unit: Some("s".into()),
        };
        let times = tracking.runs.iter().flat_map(|run| &run.trace.time);
        Ok(Self {
            tracking,
            time_axis: time_axis(&time, Span::covering(times)),
            input: label(&tracking.input, "input"),
            output: label(&tracking.output, "output"),
            drive: label(&tracking.drive, "drive"),
            time,
            reversal: reversal::find(tracking),
        })
    }

    /// The controllers that adapted, with the weights at the start and the end at least.
    pub(super) fn adapting(&self) -> impl Iterator<Item = &'a NamedTrace<'a>> {
        let runs = self.tracking.runs.iter();
        runs.filter(|run| run.trace.snapshots.len() >= 2)
    }

    /// Whether the drive is a quantity of its own, and not the input of the hysteresis itself.
    pub(super) fn has_drive(&self) -> bool {
        self.drive != self.input
    }

    /// What is known of the plant's input: the truth where it is simulated.
    pub(super) fn known(&self) -> &'static str {
        if self.tracking.simulated {
            "true"
        } else {
            "measured"
        }
    }
}
