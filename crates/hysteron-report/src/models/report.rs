//! What is reported, and its parts checked against each other.

use super::view::View;
use crate::error::ReportError;
use crate::made::Made;
use crate::stack::{self, Figures};
use hysteron::{AtomicFolder, Destination, Forward, Recording};
use std::path::{Path, PathBuf};

/// One model's run over the recording.
#[derive(Debug, Clone, Copy)]
pub struct NamedForward<'a> {
    /// The model, for example the name of its file.
    pub name: &'a str,
    /// Its output, and its errors.
    pub forward: &'a Forward,
}

/// Several models on the same recording, to be shown.
///
/// ```
/// use hysteron::{Fit, Recording, Start, forward};
/// use hysteron_report::{Made, ModelsReport, NamedForward};
///
/// let input: Vec<f64> = (0..200).map(|n| (1.0 - (f64::from(n) * 0.1).cos()) * 30.0).collect();
/// let recording = Recording::new(input.clone(), input.iter().map(|x| x * x).collect())?;
/// let of = |levels| -> hysteron::Result<_> {
///     let model = Fit::new().levels(levels).bootstrap(0).run(&recording)?;
///     forward(&model, &recording, Start::Fitted)
/// };
/// let (few, many) = (of(5)?, of(20)?);
/// let report = ModelsReport {
///     title: "5 and 20 levels",
///     recording: &recording,
///     models: &[
///         NamedForward { name: "5 levels", forward: &few },
///         NamedForward { name: "20 levels", forward: &many },
///     ],
///     made: Made::default(),
/// };
/// let folder = tempfile::tempdir()?;
/// let written = report.write(folder.path())?;
/// assert!(written[0].ends_with("index.html"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct ModelsReport<'a> {
    /// Heading of the page.
    pub title: &'a str,
    /// The recording that all of them ran over.
    pub recording: &'a Recording,
    /// The models, in the order of the figures.
    pub models: &'a [NamedForward<'a>],
    /// How the report was made.
    pub made: Made<'a>,
}

impl ModelsReport<'_> {
    /// Writes `index.html` and the figures `residuals-*.svg` and `residuals-*.png` into `dir`,
    /// which is made if absent.
    ///
    /// The report appears whole or not at all. Files of an earlier report are replaced or removed,
    /// those of others stay; a path alone as `dir` replaces these too where they are in the way.
    ///
    /// Returns the paths written, the page first.
    ///
    /// # Errors
    ///
    /// [`ReportError::NoModel`] and [`ReportError::Length`] where the parts do not fit together,
    /// before anything is written; [`ReportError::Write`] and [`ReportError::Raster`] name the file
    /// that could not be made.
    pub fn write<'t>(&self, dir: impl Into<Destination<'t>>) -> Result<Vec<PathBuf>, ReportError> {
        stack::write_folder(dir, |folder, within| self.write_into(folder, within))
    }

    /// As [`ModelsReport::write`], into the folder `within` another one that is being written.
    ///
    /// # Errors
    ///
    /// As [`ModelsReport::write`].
    pub fn write_into(
        &self,
        folder: &mut AtomicFolder,
        within: &Path,
    ) -> Result<Vec<PathBuf>, ReportError> {
        if self.models.is_empty() {
            return Err(ReportError::NoModel);
        }
        let expected = self.recording.input.len();
        let outputs = self.models.iter().map(|m| m.forward.output_model.len());
        let mut lengths = outputs.map(|found| ("output_model", found));
        let measured = ("recording.output", self.recording.output.len());
        let differs = |(_, found): &(_, usize)| *found != expected;
        if let Some((series, found)) = lengths.find(differs).or(Some(measured).filter(differs)) {
            return Err(ReportError::Length {
                series,
                expected,
                found,
            });
        }
        View::new(self).write(folder, within)
    }
}
