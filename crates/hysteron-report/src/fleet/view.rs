//! What every figure and caption reads, and the figures there are.

use super::report::FleetReport;
use super::{distances, distributions, loops, page};
use crate::draw::sheet::Drawing;
use crate::quantity::Labelled;
use crate::stack::Figures;
use hysteron::{FleetRow, Strangeness};

/// A figure of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Figure {
    /// How errors and main numbers are distributed.
    Distributions,
    /// Distance of each actuator, in order.
    Distances,
    /// Loops of the strangest beside the most usual one.
    Loops,
}

/// A report, ready to be drawn.
pub(super) struct View<'a> {
    pub(super) report: &'a FleetReport<'a>,
    pub(super) input: Labelled,
    pub(super) output: Labelled,
    /// The actuators and their distances, the strangest first.
    pub(super) ordered: Vec<(&'a FleetRow, Strangeness)>,
}

impl<'a> View<'a> {
    /// Number of loops that are drawn beside the most usual one.
    pub(super) const DRAWN: usize = 10;

    /// `None` without actuators.
    pub(super) fn new(report: &'a FleetReport<'a>) -> Option<Self> {
        let first = &report.rows.first()?.model;
        let rows = report.rows.iter();
        let mut ordered: Vec<_> = rows
            .map(|row| (row, report.norm.strangeness(row)))
            .collect();
        // Those that cannot be compared first; of equals, in the order of the table.
        let key = |strange: &Strangeness| match strange.distance.is_nan() {
            true => f64::INFINITY,
            false => strange.distance,
        };
        ordered.sort_by(|a, b| key(&b.1).total_cmp(&key(&a.1)));
        Some(Self {
            report,
            input: Labelled::first([&first.input, &first.input], "input"),
            output: Labelled::first([&first.output, &first.output], "output"),
            ordered,
        })
    }

    /// The most usual actuator.
    pub(super) fn usual(&self) -> &FleetRow {
        self.ordered[self.ordered.len() - 1].0
    }

    pub(super) fn outliers(&self) -> usize {
        let strange = self.ordered.iter();
        strange.filter(|(_, s)| s.is_outlier()).count()
    }
}

impl Figures for View<'_> {
    type Figure = Figure;
    const ALL: &'static [Figure] = &[Figure::Distributions, Figure::Distances, Figure::Loops];

    fn stem(figure: Figure) -> &'static str {
        match figure {
            Figure::Distributions => "fleet-distributions",
            Figure::Distances => "fleet-distances",
            Figure::Loops => "fleet-loops",
        }
    }

    fn simulated(&self) -> bool {
        let fits = self.report.rows.iter();
        let mut fits = fits.filter_map(|row| row.model.fit.as_ref());
        fits.any(|fit| fit.simulated)
    }

    fn title(&self, figure: Figure) -> String {
        match figure {
            Figure::Distributions => "Errors and loops of the fleet".into(),
            Figure::Distances => "How far each actuator is from the others".into(),
            Figure::Loops => "The strangest loops beside the most usual one".into(),
        }
    }

    fn caption(&self, figure: Figure) -> String {
        match figure {
            Figure::Distributions => format!(
                "Number of actuators in each of {} classes of equal width. Dashed: the median. \
                 Marks at the foot: actuators unlike the others. Classes at both ends hold what \
                 lies beyond them.",
                distributions::CLASSES
            ),
            Figure::Distances => {
                let limit = self.ordered[0].1.limit;
                format!(
                    "Robust distance of stroke, width, slope, position and error, the strangest \
                     first. Of normally distributed actuators one in a thousand lies above the \
                     dashed limit of {limit:.2}; here {} of {} do.",
                    self.outliers(),
                    self.ordered.len()
                )
            }
            Figure::Loops => format!(
                "Major loops of the {} actuators with the largest distances, each over that of the \
                 most usual one, {} (pale).",
                loops::count(self),
                self.usual().id
            ),
        }
    }

    fn draw(&self, figure: Figure) -> Option<Drawing> {
        match figure {
            Figure::Distributions => Some(distributions::svg(self)),
            Figure::Distances => Some(distances::svg(self)),
            Figure::Loops => loops::svg(self),
        }
    }

    fn is_linked(figure: Figure) -> bool {
        figure == Figure::Loops
    }

    fn page(&self, drawn: &[(Figure, Drawing)]) -> String {
        page::html(self, drawn)
    }
}
