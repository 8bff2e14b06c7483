//! Runs of controllers, and their parts checked against each other.

use crate::error::ReportError;
use hysteron::control::Trace;
use hysteron::{Plane, Quantity};

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
/// use hysteron_report::{Made, NamedTrace, Report, Shown, TrackTable, Tracking};
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
/// let tracking = Tracking {
///     simulated: true,
///     input: Quantity::with_unit("temperature", "degC"),
///     output: Quantity::with_unit("displacement", "mm"),
///     drive: Quantity::with_unit("current", "A"),
///     runs: &[NamedTrace { name: "PID", trace: &trace }],
///     events: &[(10.0, "load 10 N".into())],
///     table: &TrackTable::default(),
///     plane: &Plane::new(20.0, 80.0, 10)?,
/// };
/// let shown = Shown::Tracking(&tracking);
/// let report = Report { title: "a sine", shown, made: Made::default() };
/// let folder = tempfile::tempdir()?;
/// let written = report.write(folder.path())?;
/// assert!(written[0].ends_with("index.html"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Tracking<'a> {
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
}

impl Tracking<'_> {
    /// Whether the parts fit together.
    pub(super) fn check(&self) -> Result<(), ReportError> {
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
