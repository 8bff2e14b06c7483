//! What every figure reads: a fleet in the words and units that are shown.

use crate::error::ReportError;
use crate::quantity::Labelled;
use hysteron::{FleetRow, Norm, Strangeness};

/// A fleet, ready to be drawn.
pub(crate) struct View<'a> {
    pub(super) input: Labelled,
    pub(super) output: Labelled,
    /// The actuators and their distances, the strangest first.
    pub(super) ordered: Vec<(&'a FleetRow, Strangeness)>,
}

impl<'a> View<'a> {
    /// Number of loops that are drawn beside the most usual one.
    pub(super) const DRAWN: usize = 10;

    pub(crate) fn new(rows: &'a [FleetRow], norm: &Norm) -> Result<Self, ReportError> {
        let first = &rows.first().ok_or(ReportError::NoModel)?.model;
        let mut ordered: Vec<_> = rows
            .iter()
            .map(|row| (row, norm.strangeness(row)))
            .collect();
        // Those that cannot be compared first; of equals, in the order of the table.
        let key = |strange: &Strangeness| match strange.distance.is_nan() {
            true => f64::INFINITY,
            false => strange.distance,
        };
        ordered.sort_by(|a, b| key(&b.1).total_cmp(&key(&a.1)));
        Ok(Self {
            input: Labelled::first([&first.input, &first.input], "input"),
            output: Labelled::first([&first.output, &first.output], "output"),
            ordered,
        })
    }

    /// The most usual actuator.
    pub(super) fn usual(&self) -> &FleetRow {
        self.ordered[self.ordered.len() - 1].0
    }

    pub(super) fn is_simulated(&self) -> bool {
        let mut fits = (self.ordered.iter()).filter_map(|(row, _)| row.model.fit.as_ref());
        fits.any(|fit| fit.simulated)
    }

    pub(super) fn slope_unit(&self) -> Option<String> {
        let (output, input) = (self.output.unit.as_ref()?, self.input.unit.as_ref()?);
        Some(format!("{output}/{input}"))
    }

    pub(super) fn outliers(&self) -> usize {
        let strange = self.ordered.iter();
        strange.filter(|(_, s)| s.is_outlier()).count()
    }
}
