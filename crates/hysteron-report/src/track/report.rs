//! What is reported, and its parts checked against each other.

use super::view::View;
use crate::error::ReportError;
use crate::made::Made;
use crate::stack::{self, Figures};
use hysteron::control::Trace;
use hysteron::{AtomicFolder, Destination, Plane, Quantity};
use std::path::{Path, PathBuf};

/// One controller's run.
#[derive(Debug, Clone, Copy)]
pub struct NamedTrace<'a> {
    /// The controller, for example `PID`.
    pub name: &'a str,
    /// The trace of its loop.
    pub trace: &'a Trace,
}

/// Numbers of each controller, for example medians over seeds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TrackTable {
    /// What the columns hold, with units: `RMSE before [mm]`.
    pub headers: Vec<String>,
    /// A controller and its numbers, as many as headers; `None` where there is none.
    pub rows: Vec<(String, Vec<Option<f64>>)>,
    /// Sentences that stand below the table.
    pub notes: Vec<String>,
    /// What the columns of the second table hold.
    pub ratio_headers: Vec<String>,
    /// Controllers beside each other, as many numbers as headers.
    pub ratios: Vec<(String, Vec<Option<f64>>)>,
}

/// Runs of several controllers over the same reference and the same disturbances, to be shown.
///
/// ```
/// use hysteron::control::{LoopStatus, Trace};
/// use hysteron::{Plane, Quantity};
/// use hysteron_report::{Made, NamedTrace, TrackReport, TrackTable};
///
/// let time: Vec<f64> = (0..200).map(|n| 0.1 * f64::from(n)).collect();
/// let reference: Vec<f64> = time.iter().map(|t| t.sin()).collect();
/// let trace = Trace {
///     output: time.iter().map(|t| (t - 0.2).sin()).collect(),
///     measured: reference.clone(),
///     input: reference.clone(),
///     command: reference.clone(),
///     drive: reference.clone(),
///     prediction: vec![f64::NAN; 200],
///     status: vec![LoopStatus::default(); 200],
///     snapshots: Vec::new(),
///     time,
///     reference,
/// };
/// let report = TrackReport {
///     title: "a sine",
///     simulated: true,
///     input: Quantity::with_unit("temperature", "degC"),
///     output: Quantity::with_unit("displacement", "mm"),
///     drive: Quantity::with_unit("current", "A"),
///     runs: &[NamedTrace { name: "PID", trace: &trace }],
///     events: &[(10.0, "load 10 N".into())],
///     table: &TrackTable::default(),
///     plane: &Plane::new(20.0, 80.0, 10)?,
///     made: Made::default(),
/// };
/// let folder = tempfile::tempdir()?;
/// let written = report.write(folder.path())?;
/// assert!(written[0].ends_with("index.html"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct TrackReport<'a> {
    /// Heading of the page.
    pub title: &'a str,
    /// Whether the plant is simulated; every figure then says so.
    pub simulated: bool,
    /// The input of the hysteresis.
    pub input: Quantity,
    /// The output, which follows the reference.
    pub output: Quantity,
    /// What the controllers write to the device; the same as `input` where the drive itself is the
    /// input.
    pub drive: Quantity,
    /// One run of each controller, in the order of the figures; all have the same number of
    /// samples.
    pub runs: &'a [NamedTrace<'a>],
    /// Disturbances: when, s, and what.
    pub events: &'a [(f64, String)],
    /// Numbers of the controllers.
    pub table: &'a TrackTable,
    /// The plane of the snapshots' weights.
    pub plane: &'a Plane,
    /// How the report was made.
    pub made: Made<'a>,
}

impl TrackReport<'_> {
    /// Writes `index.html` and the figures `track-*.svg` and `track-*.png` into `dir`, which is
    /// made if absent.
    ///
    /// Samples that are not finite leave gaps. What no run has (predictions, snapshots, reversals
    /// of the reference) has no figure. The report appears whole or not at all. Files of an earlier
    /// report are replaced or removed, those of others stay; a path alone as `dir` replaces these
    /// too where they are in the way.
    ///
    /// Returns the paths written, the page first.
    ///
    /// # Errors
    ///
    /// [`ReportError::NoRun`], [`ReportError::EmptyRun`], [`ReportError::RunLength`],
    /// [`ReportError::Snapshot`] and [`ReportError::Row`] where the parts do not fit together,
    /// before anything is written; [`ReportError::Write`] and [`ReportError::Raster`] name the file
    /// that could not be made.
    pub fn write<'t>(&self, dir: impl Into<Destination<'t>>) -> Result<Vec<PathBuf>, ReportError> {
        stack::write_folder(dir, |folder, within| self.write_into(folder, within))
    }

    /// As [`TrackReport::write`], into the folder `within` another one that is being written.
    ///
    /// # Errors
    ///
    /// As [`TrackReport::write`].
    pub fn write_into(
        &self,
        folder: &mut AtomicFolder,
        within: &Path,
    ) -> Result<Vec<PathBuf>, ReportError> {
        self.check()?;
        View::new(self).write(folder, within)
    }

    fn check(&self) -> Result<(), ReportError> {
        let first = self.runs.first().ok_or(ReportError::NoRun)?;
        let expected = first.trace.time.len();
        for NamedTrace { name, trace } in self.runs {
            if trace.time.is_empty() {
                return Err(ReportError::EmptyRun {
                    run: (*name).into(),
                });
            }
            let lengths = [
                ("time", trace.time.len()),
                ("reference", trace.reference.len()),
                ("output", trace.output.len()),
                ("measured", trace.measured.len()),
                ("input", trace.input.len()),
                ("command", trace.command.len()),
                ("drive", trace.drive.len()),
                ("prediction", trace.prediction.len()),
                ("status", trace.status.len()),
            ];
            if let Some((series, found)) = lengths.into_iter().find(|(_, found)| *found != expected)
            {
                return Err(ReportError::RunLength {
                    run: (*name).into(),
                    series,
                    expected,
                    found,
                });
            }
            let operators = self.plane.operators();
            let mut found = trace
                .snapshots
                .iter()
                .map(|snapshot| snapshot.weights.len());
            if let Some(found) = found.find(|found| *found != operators) {
                return Err(ReportError::Snapshot {
                    run: (*name).into(),
                    expected: operators,
                    found,
                });
            }
        }
        let expected = self.table.headers.len();
        let mut rows = self.table.rows.iter();
        match rows.find(|(_, values)| values.len() != expected) {
            Some((row, values)) => Err(ReportError::Row {
                row: row.clone(),
                expected,
                found: values.len(),
            }),
            None => Ok(()),
        }
    }
}
