//! What is reported of a fleet.

use super::view::View;
use crate::error::ReportError;
use crate::made::Made;
use crate::stack::{self, Figures};
use hysteron::{AtomicFolder, Destination, FleetRow, Norm};
use std::path::{Path, PathBuf};

/// The actuators of a fleet, to be shown.
#[derive(Debug, Clone, Copy)]
pub struct FleetReport<'a> {
    /// Heading of the page.
    pub title: &'a str,
    /// The actuators.
    pub rows: &'a [FleetRow],
    /// What is usual among them.
    pub norm: &'a Norm,
    /// How the report was made.
    pub made: Made<'a>,
}

impl FleetReport<'_> {
    /// Writes `index.html` and the figures `fleet-*.svg` and `fleet-*.png` into `dir`, which is
    /// made if absent.
    ///
    /// The report appears whole or not at all. Files of an earlier report are replaced or removed,
    /// those of others stay; a path alone as `dir` replaces these too where they are in the way.
    ///
    /// Returns the paths written, the page first.
    ///
    /// # Errors
    ///
    /// [`ReportError::NoModel`] without actuators; [`ReportError::Write`] and
    /// [`ReportError::Raster`] name the file that could not be made.
    pub fn write<'t>(&self, dir: impl Into<Destination<'t>>) -> Result<Vec<PathBuf>, ReportError> {
        stack::write_folder(dir, |folder, within| self.write_into(folder, within))
    }

    /// As [`FleetReport::write`], into the folder `within` another one that is being written.
    ///
    /// # Errors
    ///
    /// As [`FleetReport::write`].
    pub fn write_into(
        &self,
        folder: &mut AtomicFolder,
        within: &Path,
    ) -> Result<Vec<PathBuf>, ReportError> {
        let view = View::new(self).ok_or(ReportError::NoModel)?;
        view.write(folder, within)
    }
}
