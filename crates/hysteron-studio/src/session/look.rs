//! Pictures: lines with no more points than the page can show.

use super::fault::Fault;
use super::id::Id;
use super::layers::Layers;
use super::parts::Parts;
use super::seen::Seen;
use super::state::{MOST, Session};
use super::thinned::{Ends, Scale, fair_ends, histogram, when};
use super::view::{Picture, View};
use hysteron::{Start, forward};
use serde::Serialize;
use std::sync::Arc;

/// Lines to draw.
#[derive(Debug, Clone, Serialize)]
pub struct Curves {
    /// What is drawn.
    pub picture: Picture,
    /// What the horizontal axis shows, with its unit.
    pub x: String,
    /// What the vertical axis shows.
    pub y: String,
    /// The lines.
    pub lines: Vec<Line>,
    /// Fits that cannot be drawn on this file, and why.
    pub left_out: Vec<LeftOut>,
    /// What the axes show, as far as the lines say it: a few samples far away are left out.
    pub ends: [Option<Ends>; 2],
    /// Samples in the window and the area.
    pub samples: usize,
    /// The time of the first and of the last of them.
    pub span: Option<(f64, f64)>,
    /// What is drawn besides them.
    #[serde(flatten)]
    pub layers: Layers,
}

/// A fit, and its modelled output.
pub(super) type Course = (Id, Arc<Vec<f64>>);

/// A fit that has no line.
#[derive(Debug, Clone, Serialize)]
pub struct LeftOut {
    /// The fit.
    pub fit: Id,
    /// Why it has none.
    pub why: Fault,
}

/// A line. A gap has `None` in both.
#[derive(Debug, Clone, Serialize)]
pub struct Line {
    /// The fit; `None` for what was measured.
    pub fit: Option<Id>,
    /// Whether it is what was measured, before its preparation.
    pub raw: bool,
    /// Where its points are.
    pub x: Vec<Option<f64>>,
    /// And how high.
    pub y: Vec<Option<f64>>,
}

impl Session {
    /// The modelled output of a fit on a file.
    pub(super) fn course(&mut self, fit: Id, file: Id) -> Result<Arc<Vec<f64>>, Fault> {
        let parts = self.file(file)?.parts()?.clone();
        let fitted = self.fitted(fit)?;
        if let Some((course, _)) = fitted.courses.get(&file) {
            return Ok(course.clone());
        }
        // A model that found a start of one recording begins elsewhere on another.
        let start = match fitted.files.contains(&file) {
            true => Start::Fitted,
            false => Start::Unknown,
        };
        let model = fitted.model.clone();
        let bytes = (size_of::<f64>() * parts.shown.len()) as u64;
        let held = self.held(bytes, "the output of a model")?;
        let run = |start| forward(&model, parts.all(), start).map(|run| run.output_model);
        let course = Arc::new(run(start).or_else(|_| run(Start::Fitted))?);
        let fits = self.fits.iter_mut().find(|other| other.id == fit);
        if let Some(fitted) = fits {
            fitted.courses.insert(file, (course.clone(), held));
        }
        Ok(course)
    }

    /// The modelled outputs of those fits that can be run on a file, and why the others cannot: they
    /// may need a time or a load that it does not have.
    pub(super) fn courses(
        &mut self,
        fits: &[Id],
        file: Id,
    ) -> Result<(Vec<Course>, Vec<LeftOut>), Fault> {
        few(fits)?;
        self.file(file)?.parts()?;
        let (mut courses, mut left_out) = (Vec::new(), Vec::new());
        for &fit in fits {
            self.fitted(fit)?;
            match self.course(fit, file) {
                Ok(course) => courses.push((fit, course)),
                Err(why) => left_out.push(LeftOut { fit, why }),
            }
        }
        Ok((courses, left_out))
    }

    pub(super) fn curves(&mut self, view: &View) -> Result<Curves, Fault> {
        let parts = self.file(view.file)?.parts()?.clone();
        let (courses, left_out) = self.courses(&view.fits, view.file)?;
        let seen = Seen::new(&parts, view);
        let recording = seen.recording;
        let (input, output) = (
            recording.input_quantity.to_column(),
            recording.output_quantity.to_column(),
        );
        let time = match &recording.time {
            Some(_) => "time [s]".to_owned(),
            None => "sample".to_owned(),
        };
        let measured = |n: usize| recording.output[n];
        let residual = |course: &Arc<Vec<f64>>, n: usize| course[n] - recording.output[n];
        let fair = |of: &dyn Fn(usize) -> f64| fair_ends(seen.kept().map(of));
        let input_ends = || fair(&|n| recording.input[n]);
        let of_courses = |of: &dyn Fn(&Arc<Vec<f64>>, usize) -> f64| {
            let each = courses.iter();
            each.filter_map(|(_, course)| fair(&|n| of(course, n)))
                .reduce(Ends::with)
        };
        let up = match view.picture {
            Picture::Input => input_ends(),
            Picture::Output | Picture::Loop => {
                let modelled = of_courses(&|course, n| course[n]);
                [fair(&measured), modelled]
                    .into_iter()
                    .flatten()
                    .reduce(Ends::with)
            }
            Picture::Residuals | Picture::ResidualsOverInput => of_courses(&residual),
            Picture::Histogram => None,
        };
        let across = match view.picture {
            Picture::Loop | Picture::ResidualsOverInput => input_ends(),
            _ => None,
        };
        let scale = view.scale([across, up]);
        let seen = seen.at(scale);
        let line = |fit, (x, y)| Line {
            fit,
            raw: false,
            x,
            y,
        };
        let mut lines = Vec::new();
        if let Some(raw) = self.file(view.file)?.raw().filter(|_| view.raw) {
            lines.extend(before(raw, view, scale));
        }
        match view.picture {
            Picture::Input => lines.push(line(None, seen.over_time(|n| recording.input[n]))),
            Picture::Output => lines.push(line(None, seen.over_time(measured))),
            Picture::Loop => lines.push(line(None, seen.over_input(measured))),
            Picture::Residuals | Picture::ResidualsOverInput | Picture::Histogram => {}
        }
        for (fit, course) in &courses {
            let points = match view.picture {
                Picture::Input => continue,
                Picture::Output => seen.over_time(|n| course[n]),
                Picture::Loop => seen.over_input(|n| course[n]),
                Picture::Residuals => seen.over_time(|n| residual(course, n)),
                Picture::ResidualsOverInput => seen.over_input(|n| residual(course, n)),
                Picture::Histogram => histogram(seen.kept().map(|n| residual(course, n))),
            };
            lines.push(line(Some(*fit), points));
        }
        // Short, because it stands beside a low picture.
        let difference = match &recording.output_quantity.unit {
            Some(unit) => format!("residual [{unit}]"),
            None => "residual".to_owned(),
        };
        let (x, y) = match view.picture {
            Picture::Input => (time, input),
            Picture::Output => (time, output),
            Picture::Loop => (input, output),
            Picture::Residuals => (time, difference),
            Picture::ResidualsOverInput => (input, difference),
            Picture::Histogram => (difference, "share of samples [%]".into()),
        };
        Ok(Curves {
            picture: view.picture,
            x,
            y,
            lines,
            left_out,
            ends: [across, up],
            samples: seen.kept().count(),
            span: seen.kept().next().map(|n| {
                let last = seen.kept().next_back().unwrap_or(n);
                (when(recording, n), when(recording, last))
            }),
            layers: self.layers(view, &seen)?,
        })
    }
}

/// Refuses more fits than a session has.
fn few(fits: &[Id]) -> Result<(), Fault> {
    match fits.len() > MOST {
        false => Ok(()),
        true => Err(Fault::missing(
            &format!("{} fits are asked for", fits.len()),
            &format!("take {MOST} at most"),
        )),
    }
}

/// The line of a recording before its preparation, in the pictures that have one.
fn before(raw: &Parts, view: &View, scale: Scale) -> Option<Line> {
    let seen = Seen::new(raw, view).at(scale);
    let raw = seen.recording;
    let (x, y) = match view.picture {
        Picture::Input => seen.over_time(|n| raw.input[n]),
        Picture::Output => seen.over_time(|n| raw.output[n]),
        Picture::Loop => seen.over_input(|n| raw.output[n]),
        Picture::Residuals | Picture::ResidualsOverInput | Picture::Histogram => return None,
    };
    Some(Line {
        fit: None,
        raw: true,
        x,
        y,
    })
}
