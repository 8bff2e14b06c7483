//! Pictures: lines with no more points than the page can show, and the plane.

use super::Session;
use super::fault::Fault;
use super::request::Id;
use hysteron::{Model, Recording, Start, Surroundings, forward, operators};
use hysteron_report::decimate::{self, Point};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What is drawn of a file and of fits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Picture {
    /// The input over time.
    Input,
    /// The output over time.
    Output,
    /// The output over the input.
    Loop,
    /// Measured minus modelled output over time.
    Residuals,
    /// The same over the input.
    ResidualsOverInput,
    /// How often each residual occurs.
    Histogram,
}

/// Lines that are asked for.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct View {
    /// The file.
    pub file: Id,
    /// The fits drawn with it.
    #[serde(default)]
    pub fits: Vec<Id>,
    /// What is drawn.
    pub picture: Picture,
    /// The part of the time that is shown, in seconds, or in samples from 1; `None` for all.
    #[serde(default)]
    pub window: Option<(f64, f64)>,
    /// Width and height of the picture in pixels.
    pub pixels: (u32, u32),
}

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
    /// Samples in the window.
    pub samples: usize,
    /// The part of the time marked for validation.
    pub marked: Option<(f64, f64)>,
}

/// A line. A gap has `None` in both.
#[derive(Debug, Clone, Serialize)]
pub struct Line {
    /// The fit; `None` for what was measured.
    pub fit: Option<Id>,
    /// Where its points are.
    pub x: Vec<Option<f64>>,
    /// And how high.
    pub y: Vec<Option<f64>>,
}

/// What is shown of each operator of the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PlaneKind {
    /// Its weight.
    Weights,
    /// How well the recording determines it: 0 never, 1 once, 2 not told apart, 3 well.
    Excitation,
    /// The standard error of its weight.
    Errors,
    /// Its state at a sample, 0 to 1.
    States,
}

/// The plane of a fit.
#[derive(Debug, Clone, Serialize)]
pub struct PlaneView {
    /// What is shown.
    pub kind: PlaneKind,
    /// The levels, in the input's unit.
    pub levels: Vec<f64>,
    /// For each level of `β`, for each level of `α` up to it, the value; `None` beyond.
    pub values: Vec<Vec<Option<f64>>>,
    /// The input, with its unit.
    pub unit: String,
    /// The unit of the values.
    pub of: String,
    /// The sample whose states are shown: input, measured and modelled output.
    pub sample: Option<[f64; 3]>,
    /// Its row, counted from 1.
    pub row: Option<usize>,
}

/// Bars of a histogram.
const BARS: usize = 60;

impl Session {
    /// The modelled output of a fit on a file.
    fn course(&mut self, fit: Id, file: Id) -> Result<Arc<Vec<f64>>, Fault> {
        let recording = self.file(file)?.recording()?.clone();
        let fitted = self.fitted(fit)?;
        if let Some(course) = fitted.courses.get(&file) {
            return Ok(course.clone());
        }
        // A model that found a start of one recording begins elsewhere on another.
        let start = match fitted.files.contains(&file) {
            true => Start::Fitted,
            false => Start::Unknown,
        };
        let model = fitted.model.clone();
        let run = |start| forward(&model, &recording, start).map(|run| run.output_model);
        let course = Arc::new(run(start).or_else(|_| run(Start::Fitted))?);
        let fits = self.fits.iter_mut().find(|other| other.id == fit);
        if let Some(fitted) = fits {
            fitted.courses.insert(file, course.clone());
        }
        Ok(course)
    }

    pub(super) fn curves(&mut self, view: &View) -> Result<Curves, Fault> {
        let recording = self.file(view.file)?.recording()?.clone();
        let marked = self.file(view.file)?.marked;
        let mut courses = Vec::new();
        for &fit in &view.fits {
            courses.push((fit, self.course(fit, view.file)?));
        }
        let rows = rows(&recording, view.window);
        let (input, output) = (
            recording.input_quantity.to_column(),
            recording.output_quantity.to_column(),
        );
        let time = match &recording.time {
            Some(_) => "time [s]".to_owned(),
            None => "sample".to_owned(),
        };
        let over_time = |of: &dyn Fn(usize) -> f64| {
            let points = rows.clone().map(|n| [when(&recording, n), of(n)]);
            thinned(points, view.pixels, true)
        };
        let over_input = |of: &dyn Fn(usize) -> f64| {
            let points = rows.clone().map(|n| [recording.input[n], of(n)]);
            thinned(points, view.pixels, false)
        };
        let measured = |n: usize| recording.output[n];
        let line = |fit, (x, y)| Line { fit, x, y };
        let mut lines = Vec::new();
        let residual = |course: &Arc<Vec<f64>>, n: usize| recording.output[n] - course[n];
        match view.picture {
            Picture::Input => lines.push(line(None, over_time(&|n| recording.input[n]))),
            Picture::Output => lines.push(line(None, over_time(&measured))),
            Picture::Loop => lines.push(line(None, over_input(&measured))),
            Picture::Residuals | Picture::ResidualsOverInput | Picture::Histogram => {}
        }
        for (fit, course) in &courses {
            let points = match view.picture {
                Picture::Input => continue,
                Picture::Output => over_time(&|n| course[n]),
                Picture::Loop => over_input(&|n| course[n]),
                Picture::Residuals => over_time(&|n| residual(course, n)),
                Picture::ResidualsOverInput => over_input(&|n| residual(course, n)),
                Picture::Histogram => histogram(rows.clone().map(|n| residual(course, n))),
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
            samples: rows.len(),
            marked: marked.map(|(a, b)| (when(&recording, a - 1), when(&recording, b - 1))),
        })
    }

    pub(super) fn plane(
        &mut self,
        fit: Id,
        kind: PlaneKind,
        at: Option<(Id, f64)>,
    ) -> Result<PlaneView, Fault> {
        let model = self.fitted(fit)?.model.clone();
        let confidence = model.fit.as_ref().and_then(|fit| fit.confidence.as_ref());
        let unknown = || {
            Fault::missing(
                "standard errors were not estimated for this fit",
                "fit with “bootstrap” 60",
            )
        };
        let (mut sample, mut row) = (None, None);
        let values: Vec<f64> = match kind {
            PlaneKind::Weights => model.weights().to_vec(),
            PlaneKind::Errors => confidence.ok_or_else(unknown)?.standard_error.clone(),
            PlaneKind::Excitation => {
                let classes = confidence.ok_or_else(unknown)?.excitation.iter();
                classes.map(|class| f64::from(*class as u8)).collect()
            }
            PlaneKind::States => {
                let (file, time) = at.ok_or_else(|| {
                    Fault::missing("no sample is chosen", "point at a sample over time")
                })?;
                let recording = self.file(file)?.recording()?.clone();
                let course = self.course(fit, file)?;
                let n = nearest(&recording, time);
                sample = Some([recording.input[n], recording.output[n], course[n]]);
                row = Some(n + 1);
                states(&model, &recording, n + 1)?
            }
        };
        let count = model.plane().levels();
        let mut rows = vec![vec![None; count]; count];
        for ((i, j), value) in operators(count).zip(values) {
            rows[j - 1][i - 1] = Some(value);
        }
        let levels = match model.spacing() {
            [] => (1..=count).map(|k| model.plane().level(k)).collect(),
            [_, levels @ ..] => levels.to_vec(),
        };
        Ok(PlaneView {
            kind,
            levels,
            values: rows,
            unit: model.input.to_column(),
            of: match kind {
                PlaneKind::Weights => format!("weight{}", unit_of(&model)),
                PlaneKind::Errors => format!("standard error{}", unit_of(&model)),
                PlaneKind::Excitation => "how well determined".into(),
                PlaneKind::States => "state".into(),
            },
            sample,
            row,
        })
    }
}

fn unit_of(model: &Model) -> String {
    let unit = model.output.unit.as_ref();
    unit.map_or(String::new(), |unit| format!(" [{unit}]"))
}

/// The states of the operators after the first `count` rows.
fn states(model: &Model, recording: &Recording, count: usize) -> Result<Vec<f64>, Fault> {
    let around = Surroundings {
        time: recording.time.as_deref().map(|time| &time[..count]),
        load: recording.load.as_deref().map(|load| &load[..count]),
    };
    let around = Surroundings {
        time: around.time.filter(|_| model.is_timed()),
        load: around.load.filter(|_| model.load.is_some()),
    };
    let mut state = model.start();
    let input = &recording.input[..count];
    model.run_in(&mut state, input, around, &mut vec![0.0; count])?;
    Ok(model.operator_states(&state)?)
}

/// The time of a sample, or its number from 1.
pub(super) fn when(recording: &Recording, n: usize) -> f64 {
    match &recording.time {
        Some(time) => time[n],
        None => (n + 1) as f64,
    }
}

/// The sample nearest to a time; NaN is the first.
fn nearest(recording: &Recording, time: f64) -> usize {
    let last = recording.len() - 1;
    match &recording.time {
        Some(times) => {
            let after = times.partition_point(|t| *t < time).min(last);
            let before = after.saturating_sub(1);
            match (times[after] - time).abs() < (time - times[before]).abs() {
                true => after,
                false => before,
            }
        }
        // `as` saturates.
        None => ((time - 1.0).round().max(0.0) as usize).min(last),
    }
}

/// The samples in a window of the time, and one more at each end, so that lines go to its edge.
fn rows(recording: &Recording, window: Option<(f64, f64)>) -> std::ops::Range<usize> {
    let count = recording.len();
    let Some((from, to)) = window.filter(|(from, to)| from < to) else {
        return 0..count;
    };
    let (first, last) = match &recording.time {
        Some(time) => (
            time.partition_point(|t| *t < from),
            time.partition_point(|t| *t <= to),
        ),
        // `as` saturates.
        None => (
            (from - 1.0).ceil().max(0.0) as usize,
            to.floor().max(0.0) as usize,
        ),
    };
    let first = first.saturating_sub(1).min(count - 1);
    first..last.saturating_add(1).clamp(first + 1, count)
}

type Points = (Vec<Option<f64>>, Vec<Option<f64>>);

/// The points that a picture of so many pixels can show.
fn thinned(
    points: impl Iterator<Item = Point> + Clone,
    (width, height): (u32, u32),
    is_function: bool,
) -> Points {
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for point in points.clone() {
        for (ends, value) in ends.iter_mut().zip(point) {
            *ends = [ends[0].min(value), ends[1].max(value)];
        }
    }
    // Half a pixel is not seen.
    let pixels = [width, height].map(|pixels| f64::from(pixels.clamp(10, 8192)));
    let scale = [0, 1].map(|axis| {
        let way = ends[axis][1] - ends[axis][0];
        if way > 0.0 { way / pixels[axis] } else { 1.0 }
    });
    let lowest = [ends[0][0], ends[1][0]];
    let scaled = points.map(|p| [0, 1].map(|axis| (p[axis] - lowest[axis]) / scale[axis]));
    let pieces = match is_function {
        true => decimate::columns(scaled),
        false => decimate::loops(scaled),
    };
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for piece in pieces {
        if !x.is_empty() {
            x.push(None);
            y.push(None);
        }
        x.extend(piece.iter().map(|p| Some(lowest[0] + p[0] * scale[0])));
        y.extend(piece.iter().map(|p| Some(lowest[1] + p[1] * scale[1])));
    }
    (x, y)
}

fn histogram(values: impl Iterator<Item = f64> + Clone) -> Points {
    let ends = values
        .clone()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |ends, value| {
            (ends.0.min(value), ends.1.max(value))
        });
    let width = ((ends.1 - ends.0) / BARS as f64).max(f64::MIN_POSITIVE);
    let mut counts = [0_u32; BARS];
    let mut all = 0.0;
    for value in values {
        counts[(((value - ends.0) / width) as usize).min(BARS - 1)] += 1;
        all += 1.0;
    }
    let middle = |n: usize| Some(ends.0 + (n as f64 + 0.5) * width);
    let share = |count: &u32| Some(100.0 * f64::from(*count) / all);
    (
        (0..BARS).map(middle).collect(),
        counts.iter().map(share).collect(),
    )
}
