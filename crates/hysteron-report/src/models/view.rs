//! What every figure and caption reads, and the figures there are.

use super::page;
use super::report::ModelsReport;
use crate::clock::clock;
use crate::draw::sheet::Drawing;
use crate::number::difference;
use crate::panels::{Heading, WIDTH};
use crate::quantity::Labelled;
use crate::residuals::{CLASSES, Residuals};
use crate::stack::Figures;
use hysteron::Origin;
use std::borrow::Cow;

/// A figure of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Figure {
    /// Modelled minus measured output over time.
    Time,
    /// The same over the input.
    Input,
    /// How often each residual occurs.
    Histogram,
}

/// A report, ready to be drawn.
pub(super) struct View<'a> {
    pub(super) report: &'a ModelsReport<'a>,
    pub(super) input: Labelled,
    pub(super) output: Labelled,
    pub(super) time: Cow<'a, [f64]>,
    pub(super) time_label: Labelled,
    /// Modelled minus measured output of each model.
    pub(super) residuals: Vec<Vec<f64>>,
}

impl<'a> View<'a> {
    pub(super) fn new(report: &'a ModelsReport<'a>) -> Self {
        let recording = report.recording;
        let label = |quantity, fallback| Labelled::first([quantity, quantity], fallback);
        let (time, time_label) = clock(recording);
        let models = report.models.iter();
        Self {
            report,
            input: label(&recording.input_quantity, "input"),
            output: label(&recording.output_quantity, "output"),
            time,
            time_label,
            residuals: models
                .map(|model| difference(&model.forward.output_model, &recording.output))
                .collect(),
        }
    }

    /// A heading for each model, with its error.
    fn headings(&self) -> Vec<Heading> {
        let models = self.report.models.iter();
        models
            .map(|model| Heading {
                name: model.name.to_owned(),
                remark: format!(
                    "RMSE {}, max {}",
                    self.output.value(model.forward.errors.rmse),
                    self.output.value(model.forward.errors.max_abs)
                ),
            })
            .collect()
    }
}

impl Figures for View<'_> {
    type Figure = Figure;
    const ALL: &'static [Figure] = &[Figure::Time, Figure::Input, Figure::Histogram];

    fn stem(figure: Figure) -> &'static str {
        match figure {
            Figure::Time => "residuals-time",
            Figure::Input => "residuals-input",
            Figure::Histogram => "residuals-histogram",
        }
    }

    fn simulated(&self) -> bool {
        self.report.recording.origin == Origin::Simulated
    }

    fn title(&self, figure: Figure) -> String {
        match figure {
            Figure::Time => format!("Residuals over {}", self.time_label.name),
            Figure::Input => format!("Residuals over {}", self.input.name),
            Figure::Histogram => "Residuals: how often each size occurs".into(),
        }
    }

    fn caption(&self, figure: Figure) -> String {
        let what = format!("Modelled minus measured {}", self.output.name);
        match figure {
            Figure::Time => format!(
                "{what}, a panel for each model with the same axes. A drift shows here as a slope."
            ),
            Figure::Input => format!(
                "{what} at each {}. What the model cannot follow shows here as a pattern.",
                self.input.name
            ),
            Figure::Histogram => format!(
                "{what}: share of the samples in each of {} classes of equal width. Noise alone \
                 gives a bell around zero.",
                CLASSES
            ),
        }
    }

    fn draw(&self, figure: Figure) -> Option<Drawing> {
        let residuals = Residuals {
            headings: self.headings(),
            each: &self.residuals,
            label: self.output.renamed("residual"),
            recorded: if self.simulated() {
                "simulated"
            } else {
                "measured"
            },
        };
        let mut sheet = self.sheet(figure, WIDTH);
        let input = &self.report.recording.input;
        let bottom = match figure {
            Figure::Time => residuals.over_time(&mut sheet, &self.time, &self.time_label),
            Figure::Input => residuals.over_input(&mut sheet, input, &self.input),
            Figure::Histogram => residuals.histogram(&mut sheet),
        };
        Some(self.finish(figure, sheet, bottom))
    }

    fn is_linked(figure: Figure) -> bool {
        figure != Figure::Histogram
    }

    fn page(&self, drawn: &[(Figure, Drawing)]) -> String {
        page::html(self, drawn)
    }
}
