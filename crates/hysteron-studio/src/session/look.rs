//! Pictures: lines with no more points than the page can show, and the plane.

use super::Session;
use super::fault::Fault;
use super::request::Id;
use hysteron::{Model, Recording, Start, State, Surroundings, forward, operators};
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
    /// The part of the loop that is shown: samples beside it are left out of every picture.
    #[serde(default)]
    pub area: Area,
    /// The file before its preparation too, where it is prepared.
    #[serde(default)]
    pub raw: bool,
    /// Width and height of the picture in pixels.
    pub pixels: (u32, u32),
}

/// A part of the loop. `None` for the whole of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(default)]
pub struct Area {
    /// Lowest and highest input.
    pub input: Option<(f64, f64)>,
    /// Lowest and highest measured output.
    pub output: Option<(f64, f64)>,
}

impl Area {
    /// Whether the loop is inside at a sample, or on the way from or to it, so that lines go to
    /// the edge.
    fn shows(&self, recording: &Recording, n: usize) -> bool {
        if self.input.is_none() && self.output.is_none() {
            return true;
        }
        self.has(recording, n)
            || (n > 0 && self.has(recording, n - 1))
            || (n + 1 < recording.len() && self.has(recording, n + 1))
    }

    pub(super) fn has(&self, recording: &Recording, n: usize) -> bool {
        let inside = |ends: Option<(f64, f64)>, value: f64| {
            ends.is_none_or(|(low, high)| (low..=high).contains(&value))
        };
        inside(self.input, recording.input[n]) && inside(self.output, recording.output[n])
    }
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
    /// Samples in the window and the area.
    pub samples: usize,
    /// The time of the first and of the last of them.
    pub span: Option<(f64, f64)>,
    /// The spans of the time marked for validation.
    pub marked: Vec<(f64, f64)>,
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
    /// The line between the operators that are on and off at the sample pointed at, as points of
    /// `α` and `β`. One unit is one cell, and cell `n` ends at `n`: [`hysteron::State::staircase`].
    pub staircase: Vec<[f64; 2]>,
    /// The sample pointed at.
    pub sample: Option<SampleView>,
}

/// A sample of a file.
#[derive(Debug, Clone, Serialize)]
pub struct SampleView {
    /// Its row, counted from 1.
    pub row: usize,
    /// Its time in seconds, or its number from 1.
    pub time: f64,
    /// Its input.
    pub input: f64,
    /// The measured output.
    pub output: f64,
    /// The modelled output of each fit.
    pub modelled: Vec<(Id, f64)>,
}

/// Bars of a histogram.
const BARS: usize = 60;

impl Session {
    /// The modelled output of a fit on a file.
    pub(super) fn course(&mut self, fit: Id, file: Id) -> Result<Arc<Vec<f64>>, Fault> {
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
        let marked = self.file(view.file)?.marked.clone();
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
        let shown: Vec<bool> = rows
            .clone()
            .map(|n| view.area.shows(&recording, n))
            .collect();
        let first = rows.start;
        // What is not a number breaks a line.
        let seen = |n: usize, value: f64| if shown[n - first] { value } else { f64::NAN };
        let over_time = |of: &dyn Fn(usize) -> f64| {
            let points = rows.clone().map(|n| [when(&recording, n), seen(n, of(n))]);
            thinned(points, view.pixels, Shape::OverTime)
        };
        let over_input = |of: &dyn Fn(usize) -> f64| {
            let points = rows.clone().map(|n| [recording.input[n], seen(n, of(n))]);
            let shape = match view.picture {
                Picture::ResidualsOverInput => Shape::Dots,
                _ => Shape::Loop,
            };
            thinned(points, view.pixels, shape)
        };
        let kept = || rows.clone().filter(|n| shown[n - first]);
        let measured = |n: usize| recording.output[n];
        let line = |fit, (x, y)| Line {
            fit,
            raw: false,
            x,
            y,
        };
        let mut lines = Vec::new();
        if let Some(raw) = self.file(view.file)?.raw().filter(|_| view.raw) {
            lines.extend(before(raw, view));
        }
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
                Picture::Histogram => histogram(kept().map(|n| residual(course, n))),
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
            samples: kept().count(),
            span: kept().next().map(|n| {
                let last = kept().next_back().unwrap_or(n);
                (when(&recording, n), when(&recording, last))
            }),
            marked: marked
                .iter()
                .map(|(a, b)| (when(&recording, a - 1), when(&recording, b - 1)))
                .collect(),
        })
    }

    /// The sample nearest to a time.
    pub(super) fn sample(&mut self, file: Id, fits: &[Id], at: f64) -> Result<SampleView, Fault> {
        let recording = self.file(file)?.recording()?.clone();
        let n = nearest(&recording, at);
        let mut modelled = Vec::new();
        for &fit in fits {
            modelled.push((fit, self.course(fit, file)?[n]));
        }
        Ok(SampleView {
            row: n + 1,
            time: when(&recording, n),
            input: recording.input[n],
            output: recording.output[n],
            modelled,
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
        let (sample, state) = match at {
            None => (None, None),
            Some((file, time)) => {
                let sample = self.sample(file, &[fit], time)?;
                let state = self.state_at(fit, file, sample.row)?;
                (Some(sample), Some(state))
            }
        };
        let values: Vec<f64> = match kind {
            PlaneKind::Weights => model.weights().to_vec(),
            PlaneKind::Errors => confidence.ok_or_else(unknown)?.standard_error.clone(),
            PlaneKind::Excitation => {
                let classes = confidence.ok_or_else(unknown)?.excitation.iter();
                classes.map(|class| f64::from(*class as u8)).collect()
            }
            PlaneKind::States => {
                let state = state.as_ref().ok_or_else(|| {
                    Fault::missing("no sample is chosen", "point at a sample over time")
                })?;
                model.operator_states(state)?
            }
        };
        let count = model.plane().levels();
        let levels = match model.spacing() {
            [] => (1..=count).map(|k| model.plane().level(k)).collect(),
            [_, levels @ ..] => levels.to_vec(),
        };
        Ok(PlaneView {
            kind,
            levels,
            values: cells(count, values.into_iter()),
            unit: model.input.to_column(),
            of: match kind {
                PlaneKind::Weights => format!("weight{}", unit_of(&model)),
                PlaneKind::Errors => format!("standard error{}", unit_of(&model)),
                PlaneKind::Excitation => "how well determined".into(),
                PlaneKind::States => "state".into(),
            },
            staircase: state.map_or(Vec::new(), |state| state.staircase()),
            sample,
        })
    }

    /// The state of a model after the first `count` rows of a file. It goes on from the state that
    /// was asked for before, where that is no later: a play through the time takes each row once.
    fn state_at(&mut self, fit: Id, file: Id, count: usize) -> Result<State, Fault> {
        let recording = self.file(file)?.recording()?.clone();
        let fitted = self.fits.iter_mut().find(|other| other.id == fit);
        let fitted = fitted.ok_or_else(|| Fault::gone("fit", fit))?;
        let reached = fitted.reached.take();
        // A model that depends on time has to see each step of it.
        let goes_on = |(of, at, _): &(Id, usize, State)| {
            *of == file && *at <= count && !fitted.model.is_timed()
        };
        let reached = reached.filter(goes_on);
        let (from, mut state) = match reached {
            Some((_, at, state)) => (at, state),
            None => (0, fitted.model.start()),
        };
        let rows = from..count;
        let model = &fitted.model;
        let around = Surroundings {
            time: recording.time.as_deref().filter(|_| model.is_timed()),
            load: recording.load.as_deref().filter(|_| model.load.is_some()),
        };
        let around = Surroundings {
            time: around.time.map(|time| &time[rows.clone()]),
            load: around.load.map(|load| &load[rows.clone()]),
        };
        model.run_in(
            &mut state,
            &recording.input[rows.clone()],
            around,
            &mut vec![0.0; rows.len()],
        )?;
        fitted.reached = Some((file, count, state.clone()));
        Ok(state)
    }
}

fn unit_of(model: &Model) -> String {
    let unit = model.output.unit.as_ref();
    unit.map_or(String::new(), |unit| format!(" [{unit}]"))
}

/// Values of operators, for each level of `β`, for each level of `α` up to it.
pub(super) fn cells(count: usize, values: impl Iterator<Item = f64>) -> Vec<Vec<Option<f64>>> {
    let mut rows = vec![vec![None; count]; count];
    for ((i, j), value) in operators(count).zip(values) {
        rows[j - 1][i - 1] = Some(value);
    }
    rows
}

/// The line of a recording before its preparation, in the pictures that have one.
fn before(raw: &Recording, view: &View) -> Option<Line> {
    let rows = rows(raw, view.window).filter(|n| view.area.shows(raw, *n));
    let (x, y) = match view.picture {
        Picture::Input => thinned(
            rows.map(|n| [when(raw, n), raw.input[n]]),
            view.pixels,
            Shape::OverTime,
        ),
        Picture::Output => thinned(
            rows.map(|n| [when(raw, n), raw.output[n]]),
            view.pixels,
            Shape::OverTime,
        ),
        Picture::Loop => thinned(
            rows.map(|n| [raw.input[n], raw.output[n]]),
            view.pixels,
            Shape::Loop,
        ),
        Picture::Residuals | Picture::ResidualsOverInput | Picture::Histogram => return None,
    };
    Some(Line {
        fit: None,
        raw: true,
        x,
        y,
    })
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
pub(super) fn rows(recording: &Recording, window: Option<(f64, f64)>) -> std::ops::Range<usize> {
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

/// What is drawn through points.
#[derive(Debug, Clone, Copy)]
pub(super) enum Shape {
    /// A line with one height at a time.
    OverTime,
    /// A line that may go back.
    Loop,
    /// No line.
    Dots,
}

/// The points that a picture of so many pixels can show.
pub(super) fn thinned(
    points: impl Iterator<Item = Point> + Clone,
    (width, height): (u32, u32),
    shape: Shape,
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
    let pieces = match shape {
        Shape::OverTime => decimate::columns(scaled),
        Shape::Loop => decimate::loops(scaled),
        Shape::Dots => decimate::dots(scaled),
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
