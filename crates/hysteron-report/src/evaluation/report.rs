//! The report itself.

use crate::error::ReportError;
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::made::Made;
use crate::stack::{self, Figures};
use hysteron::Evaluation;
use hysteron::Model;
use hysteron::Recording;
use hysteron::{AtomicFolder, Destination};
use std::path::{Path, PathBuf};

/// An evaluation of a model on a recording, to be shown.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// Heading of the page.
    pub title: &'a str,
    /// The model that was evaluated.
    pub model: &'a Model,
    /// What it was evaluated on.
    pub recording: &'a Recording,
    /// How it did.
    pub evaluation: &'a Evaluation,
    /// How the report was made.
    pub made: Made<'a>,
}

impl Report<'_> {
    /// Writes `index.html` and, for each figure, `figNN-name.svg` and `figNN-name.png` into `dir`,
    /// which is made if absent.
    ///
    /// Figures 13 to 15 need an inverse, and figure 15 a dead band; where they are missing the page
    /// says why. Figures of confidence, cross-validation and load need a model that has them. The
    /// report appears whole or not at all. Files of an earlier report are replaced or removed,
    /// those of others stay; a path alone as `dir` replaces these too where they are in the way.
    ///
    /// Returns the paths written, the page first.
    ///
    /// # Errors
    ///
    /// [`ReportError::Length`] where the evaluation belongs to another recording, before anything
    /// is written; [`ReportError::Write`] and [`ReportError::Raster`] name the file that could not
    /// be made.
    pub fn write<'t>(&self, dir: impl Into<Destination<'t>>) -> Result<Vec<PathBuf>, ReportError> {
        stack::write_folder(dir, |folder, within| self.write_into(folder, within))
    }

    /// As [`Report::write`], into the folder `within` another one that is being written.
    ///
    /// # Errors
    ///
    /// As [`Report::write`].
    pub fn write_into(
        &self,
        folder: &mut AtomicFolder,
        within: &Path,
    ) -> Result<Vec<PathBuf>, ReportError> {
        self.view()?.write(folder, within)
    }

    /// The page alone, `index.html` of [`Report::write`]. It needs nothing beside it.
    ///
    /// # Errors
    ///
    /// [`ReportError::Length`] where the evaluation belongs to another recording.
    pub fn page(&self) -> Result<String, ReportError> {
        let view = self.view()?;
        Ok(view.whole_page(&view.drawn()))
    }

    /// A single figure as an SVG document; `None` where the evaluation has nothing to show in it.
    ///
    /// # Errors
    ///
    /// [`ReportError::Length`] where the evaluation belongs to another recording.
    pub fn svg(&self, figure: Figure) -> Result<Option<String>, ReportError> {
        Ok(self.view()?.draw(figure).map(|drawing| drawing.svg))
    }

    /// The parts of the report, once they fit together.
    fn view(&self) -> Result<View<'_>, ReportError> {
        let expected = self.recording.input.len();
        let mut lengths = vec![
            ("recording.output", self.recording.output.len()),
            ("output_model", self.evaluation.output_model.len()),
        ];
        if let Some(band) = &self.evaluation.band {
            lengths.push(("band.half_width", band.half_width.len()));
        }
        if let Ok(inverse) = &self.evaluation.inverse {
            lengths.extend([
                ("inverse.moving", inverse.moving.len()),
                ("inverse.hold.input_model", inverse.hold.input_model.len()),
                (
                    "inverse.anticipate.input_model",
                    inverse.anticipate.input_model.len(),
                ),
            ]);
        }
        match lengths.into_iter().find(|&(_, found)| found != expected) {
            Some((series, found)) => Err(ReportError::Length {
                series,
                expected,
                found,
            }),
            None => Ok(View::new(self)),
        }
    }
}
