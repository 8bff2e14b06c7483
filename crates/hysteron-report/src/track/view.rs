//! What every figure and caption reads: the parts of the report in the words and units that are
//! shown.

use super::figure::Figure;
use super::report::{NamedTrace, TrackReport};
use super::reversal::{self, Reversal};
use super::{captions, page};
use crate::draw::axis::time_axis;
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::Drawing;
use crate::quantity::Labelled;
use crate::stack::Figures;

/// A report, ready to be drawn.
pub(super) struct View<'a> {
    pub(super) report: &'a TrackReport<'a>,
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
    pub(super) fn new(report: &'a TrackReport<'a>) -> Self {
        let label = |quantity, fallback| Labelled::first([quantity, quantity], fallback);
        let time = Labelled {
            name: "time".into(),
            unit: Some("s".into()),
        };
        let times = report.runs.iter().flat_map(|run| &run.trace.time);
        Self {
            report,
            time_axis: time_axis(&time, Span::of(times)),
            input: label(&report.input, "input"),
            output: label(&report.output, "output"),
            drive: label(&report.drive, "drive"),
            time,
            reversal: reversal::find(report),
        }
    }

    /// The controllers that adapted, with the weights at the start and the end at least.
    pub(super) fn adapting(&self) -> impl Iterator<Item = &'a NamedTrace<'a>> {
        let runs = self.report.runs.iter();
        runs.filter(|run| run.trace.snapshots.len() >= 2)
    }

    /// Whether the drive is a quantity of its own, and not the input of the hysteresis itself.
    pub(super) fn has_drive(&self) -> bool {
        self.drive != self.input
    }

    /// What is known of the plant's input: the truth where it is simulated.
    pub(super) fn known(&self) -> &'static str {
        if self.report.simulated {
            "true"
        } else {
            "measured"
        }
    }
}

impl Figures for View<'_> {
    type Figure = Figure;
    const ALL: &'static [Figure] = &Figure::ALL;

    fn stem(figure: Figure) -> &'static str {
        figure.stem()
    }

    fn simulated(&self) -> bool {
        self.report.simulated
    }

    fn title(&self, figure: Figure) -> String {
        captions::title(figure, self)
    }

    fn caption(&self, figure: Figure) -> String {
        captions::caption(figure, self)
    }

    fn draw(&self, figure: Figure) -> Option<Drawing> {
        figure.svg(self)
    }

    fn is_linked(figure: Figure) -> bool {
        !matches!(figure, Figure::WeightsTime | Figure::BeforeAfter)
    }

    fn page(&self, drawn: &[(Figure, Drawing)]) -> String {
        page::html(self, drawn)
    }
}
