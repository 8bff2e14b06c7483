//! The report itself: figures as files around a page.

use crate::error::ReportError;
use crate::layout::Layout;
use crate::made::Made;
use crate::models::NamedForward;
#[cfg(feature = "png")]
use crate::png;
use crate::track::Tracking;
use crate::{evaluation, fleet, models, track};
use hysteron::Destination;
use hysteron::{Evaluation, FleetRow, Model, Norm, Recording, Verdict};
use hysteron_files::{AtomicFile, AtomicFolder, Own};
use std::path::{Path, PathBuf};

/// Figures and a page of what is [`Shown`].
///
/// ```
/// use hysteron::{Fit, Recording, Start, forward};
/// use hysteron_report::{Made, NamedForward, Report, Shown};
///
/// let input: Vec<f64> = (0..200).map(|n| (1.0 - (f64::from(n) * 0.1).cos()) * 30.0).collect();
/// let recording = Recording::new(input.clone(), input.iter().map(|x| x * x).collect())?;
/// let of = |levels| -> hysteron::Result<_> {
///     let model = Fit::new().levels(levels).bootstrap(0).run(&recording)?;
///     forward(&model, &recording, Start::Fitted)
/// };
/// let (few, many) = (of(5)?, of(20)?);
/// let report = Report {
///     title: "5 and 20 levels",
///     shown: Shown::Models {
///         recording: &recording,
///         models: &[
///             NamedForward { name: "5 levels", forward: &few, verdict: None },
///             NamedForward { name: "20 levels", forward: &many, verdict: None },
///         ],
///     },
///     made: Made::default(),
/// };
/// let folder = tempfile::tempdir()?;
/// let written = report.write(folder.path())?;
/// assert!(written[0].ends_with("index.html"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// Heading of the page.
    pub title: &'a str,
    /// What it shows.
    pub shown: Shown<'a>,
    /// How the report was made.
    pub made: Made<'a>,
}

/// What a report shows.
#[derive(Debug, Clone, Copy)]
pub enum Shown<'a> {
    /// A model on a recording, or on several that are shown one after the other. Some figures stand
    /// beside those of the chapter on the MKP model.
    ///
    /// Figures of the inverse need a model that has one, the close-up a dead band; where they are
    /// missing the page says why. Figures of confidence, cross-validation and load need a model
    /// that has them.
    Evaluation {
        /// The model that was evaluated.
        model: &'a Model,
        /// What it was evaluated on.
        recordings: &'a [Recording],
        /// How it did.
        evaluation: &'a Evaluation,
        /// Whether that is good enough; the page does not say it where it is `None`.
        verdict: Option<&'a Verdict>,
    },
    /// Residuals of several models on one recording.
    Models {
        /// The recording that all of them ran over.
        recording: &'a Recording,
        /// The models, in the order of the figures.
        models: &'a [NamedForward<'a>],
    },
    /// Which actuators of a fleet are unlike the others.
    Fleet {
        /// The actuators.
        rows: &'a [FleetRow],
        /// What is usual among them.
        norm: &'a Norm,
    },
    /// Controllers over the same reference. What no run has (predictions, snapshots, reversals of
    /// the reference) has no figure; samples that are not finite leave gaps.
    Tracking(&'a Tracking<'a>),
}

impl Report<'_> {
    /// Writes `index.html` and each figure as `STEM.svg` and, with the feature `png`, as `STEM.png`
    /// into `dir`, which is made if absent.
    ///
    /// The report appears whole or not at all. Files of an earlier report are replaced or removed,
    /// those of others stay; a path alone as `dir` replaces these too where they are in the way.
    ///
    /// Returns the paths written, the page first.
    ///
    /// # Errors
    ///
    /// Before anything is written, where the parts do not fit together: [`ReportError::Length`],
    /// [`ReportError::NoRecording`], [`ReportError::NoModel`], [`ReportError::NoRun`],
    /// [`ReportError::EmptyRun`], [`ReportError::RunLength`], [`ReportError::Snapshot`] and
    /// [`ReportError::Row`].
    /// [`ReportError::Write`] and [`ReportError::Raster`] name the file that could not be made.
    pub fn write<'t>(&self, dir: impl Into<Destination<'t>>) -> Result<Vec<PathBuf>, ReportError> {
        let mut folder = AtomicFolder::create(dir, None)?;
        let paths = self.write_into(&mut folder, Path::new(""))?;
        folder.commit()?;
        Ok(paths)
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
        let layout = self.layout(|_| true)?;
        let mut names = vec![within.join("index.html")];
        for figure in &layout.drawn {
            let name = |end| within.join(format!("{}.{end}", figure.stem));
            let svg = &figure.drawing.svg;
            write_file(folder, &name("svg"), svg.as_bytes())?;
            names.push(name("svg"));
            #[cfg(feature = "png")]
            {
                let png = name("png");
                let pixels = png::of_svg(svg).map_err(|reason| ReportError::Raster {
                    path: folder.path().join(&png),
                    reason,
                })?;
                write_file(folder, &png, &pixels)?;
                names.push(png);
            }
        }
        let page = layout.html(self.title, self.made);
        write_file(folder, &names[0], page.as_bytes())?;
        Ok(names.iter().map(|name| folder.path().join(name)).collect())
    }

    /// The page alone, `index.html` of [`Report::write`]. It needs nothing beside it.
    ///
    /// # Errors
    ///
    /// As [`Report::write`], where the parts do not fit together.
    pub fn page(&self) -> Result<String, ReportError> {
        Ok(self.layout(|_| true)?.html(self.title, self.made))
    }

    /// The names of the figures that there can be, in the order of the page; a figure without
    /// anything to show is left out.
    ///
    /// # Errors
    ///
    /// As [`Report::write`], where the parts do not fit together.
    pub fn stems(&self) -> Result<Vec<&'static str>, ReportError> {
        Ok(self.layout(|_| false)?.stems)
    }

    /// The figure `stem`, for example `fig10-output-time`, as an SVG document; `None` where there
    /// is nothing to show in it.
    ///
    /// # Errors
    ///
    /// [`ReportError::NoFigure`] where this report never has such a figure; as [`Report::write`],
    /// where the parts do not fit together.
    pub fn svg(&self, stem: &str) -> Result<Option<String>, ReportError> {
        let mut layout = self.layout(|other| other == stem)?;
        match layout.stems.contains(&stem) {
            true => Ok(layout.drawn.pop().map(|figure| figure.drawing.svg)),
            false => Err(ReportError::NoFigure {
                stem: stem.to_owned(),
                stems: layout.stems,
            }),
        }
    }

    fn layout(&self, is_wanted: impl Fn(&str) -> bool) -> Result<Layout, ReportError> {
        Ok(match self.shown {
            Shown::Evaluation {
                model,
                recordings,
                evaluation,
                verdict,
            } => Layout::new(
                &evaluation::View::new(model, recordings, (evaluation, verdict))?,
                is_wanted,
            ),
            Shown::Models { recording, models } => {
                Layout::new(&models::View::new(recording, models)?, is_wanted)
            }
            Shown::Fleet { rows, norm } => Layout::new(&fleet::View::new(rows, norm)?, is_wanted),
            Shown::Tracking(tracking) => Layout::new(&track::View::new(tracking)?, is_wanted),
        })
    }
}

fn write_file(folder: &mut AtomicFolder, name: &Path, content: &[u8]) -> Result<(), ReportError> {
    Ok(folder.file(name, |path| {
        AtomicFile::create(path, Own::SAME_BYTES)?.commit_with(content)
    })?)
}

#[cfg(test)]
mod tests {
    use crate::subject::{Section, Subject};
    use crate::{evaluation, fleet, models, track};

    /// A file of one figure would replace that of another.
    #[test]
    fn every_figure_has_one_place_on_its_page() {
        fn assert_distinct<V: Subject>() {
            let sections = V::sections();
            let figures = sections.iter().flat_map(Section::figures);
            let mut stems: Vec<&str> = figures.map(|figure| figure.stem).collect();
            let count = stems.len();
            stems.sort_unstable();
            stems.dedup();
            assert_eq!(stems.len(), count, "{stems:?}");
        }
        assert_distinct::<evaluation::View<'_>>();
        assert_distinct::<models::View<'_>>();
        assert_distinct::<fleet::View<'_>>();
        assert_distinct::<track::View<'_>>();
    }
}
