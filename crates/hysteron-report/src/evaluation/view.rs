//! What every figure and caption reads: the report's parts in the words and units that are shown.

use crate::clock::clock;
use crate::draw::sheet::Drawing;
use crate::evaluation::figure::Figure;
use crate::evaluation::report::Report;
use crate::evaluation::source::Source;
use crate::evaluation::{captions, figures, page};
use crate::made::Made;
use crate::quantity::Labelled;
use crate::stack::Figures;
use hysteron::{BandEvaluation, Confidence, Evaluation, InverseEvaluation, Validation};
use hysteron::{Origin, Recording};
use std::borrow::Cow;

/// A report, ready to be drawn.
pub(crate) struct View<'a> {
    pub(crate) heading: &'a str,
    pub(crate) recording: &'a Recording,
    pub(crate) evaluation: &'a Evaluation,
    pub(crate) source: Source<'a>,
    pub(crate) made: Made<'a>,
    pub(crate) input: Labelled,
    pub(crate) output: Labelled,
    /// Seconds, or sample numbers where the recording has no time.
    pub(crate) time: Cow<'a, [f64]>,
    pub(crate) time_label: Labelled,
}

impl<'a> View<'a> {
    pub(crate) fn new(report: &Report<'a>) -> Self {
        let &Report {
            title: heading,
            model,
            recording,
            evaluation,
            made,
        } = report;
        let source = Source::new(model);
        let (time, time_label) = clock(recording);
        Self {
            heading,
            recording,
            evaluation,
            source,
            made,
            input: Labelled::first([&recording.input_quantity, source.input()], "input"),
            output: Labelled::first([&recording.output_quantity, source.output()], "output"),
            time,
            time_label,
        }
    }

    pub(crate) fn inverse(&self) -> Option<&'a InverseEvaluation> {
        self.evaluation.inverse.as_ref().ok()
    }

    /// What the recording fitted says of the weights, where the model tells.
    pub(crate) fn confidence(&self) -> Option<&'a Confidence> {
        self.source.fit()?.confidence.as_ref()
    }

    /// How levels and smoothness were chosen, where the model tells.
    pub(crate) fn validation(&self) -> Option<&'a Validation> {
        let validation = self.source.fit()?.validation.as_ref();
        validation.filter(|validation| !validation.scores.is_empty())
    }

    pub(crate) fn band(&self) -> Option<&'a BandEvaluation> {
        self.evaluation.band.as_ref()
    }

    /// Lower and upper edge of the prediction band.
    pub(crate) fn band_edges(&self) -> Option<[Vec<f64>; 2]> {
        let (lower, upper) = self.band()?.ends(&self.evaluation.output_model);
        Some([lower, upper])
    }

    /// What the recorded curves are called.
    pub(crate) fn recorded(&self) -> &'static str {
        if self.simulated() {
            "simulated plant"
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
        self.recording.origin == Origin::Simulated
    }

    fn title(&self, figure: Figure) -> String {
        captions::title(figure, self)
    }

    fn caption(&self, figure: Figure) -> String {
        captions::caption(figure, self)
    }

    fn draw(&self, figure: Figure) -> Option<Drawing> {
        figures::svg(figure, self)
    }

    fn is_linked(figure: Figure) -> bool {
        matches!(
            figure,
            Figure::OutputTime
                | Figure::Loops
                | Figure::LoadLoops
                | Figure::LoadMeasured
                | Figure::OutputDiscrepancy
                | Figure::OutputResiduals
                | Figure::InputTime
                | Figure::InputDiscrepancy
                | Figure::DeadBand
        )
    }

    fn page(&self, drawn: &[(Figure, Drawing)]) -> String {
        page::html(self, drawn)
    }
}
