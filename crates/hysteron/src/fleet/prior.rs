//! What a fleet tells about the next actuator of its kind.

use super::outliers::Norm;
use super::row::{FleetRow, read_fleet};
use crate::error::Result;
use crate::identify::WeightPrior;
use std::path::Path;

/// The prior of a fleet's table, for [`crate::Fit::prior`]. Actuators that are unlike the others do
/// not count, where there are enough to tell ([`Norm::from_rows`]).
///
/// # Errors
/// As [`read_fleet`] and [`WeightPrior::from_models`].
pub fn prior_of_fleet(models: &Path) -> Result<WeightPrior> {
    let mut rows: Vec<FleetRow> = Vec::new();
    read_fleet(models, |row| {
        rows.push(row);
        Ok(true)
    })?;
    if let Ok(norm) = Norm::from_rows(&rows) {
        rows.retain(|row| !norm.strangeness(row).is_outlier());
    }
    let models: Vec<_> = rows.into_iter().map(|row| row.model).collect();
    WeightPrior::from_models(&models)
}
