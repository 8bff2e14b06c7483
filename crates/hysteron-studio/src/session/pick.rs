//! The sample that is pointed at, and the one with the largest residual.

use super::fault::Fault;
use super::id::Id;
use super::plane::{SampleView, nearest};
use super::seen::Seen;
use super::state::Session;
use super::thinned::when;
use super::view::{Picture, View};
use hysteron::{Recording, Sample, Surroundings};
use hysteron_report::decimate::Point;
use serde::Serialize;
use std::collections::HashSet;

/// The sample with the largest residual of a fit.
#[derive(Debug, Clone, Serialize)]
pub struct WorstView {
    /// The file that it is in.
    pub file: Id,
    /// The sample.
    pub sample: SampleView,
}

impl Picture {
    /// A sample in this picture, as measured or as modelled; `None` where it has no place there.
    /// In a histogram only the residual counts.
    pub(super) fn point(
        self,
        recording: &Recording,
        course: Option<&[f64]>,
        n: usize,
    ) -> Option<Point> {
        let (input, output) = (recording.input[n], recording.output[n]);
        let residual = || Some(course?[n] - output);
        Some(match self {
            Self::Input => [when(recording, n), input],
            Self::Output => [when(recording, n), output],
            Self::Loop => [input, output],
            Self::Residuals => [when(recording, n), residual()?],
            Self::ResidualsOverInput => [input, residual()?],
            Self::Histogram => [residual()?, 0.0],
        })
    }
}

impl Session {
    /// The sample of a picture nearest to a point of it.
    pub(super) fn nearest(&mut self, view: &View, at: Point) -> Result<SampleView, Fault> {
        let (courses, _) = self.courses(&view.fits, view.file)?;
        let parts = self.file(view.file)?.parts()?.clone();
        let seen = Seen::new(&parts, view);
        let recording = seen.recording;
        let is_histogram = view.picture == Picture::Histogram;
        let at = if is_histogram { [at[0], 0.0] } else { at };
        let mut found = (f64::INFINITY, 0);
        let lines = std::iter::once(None).chain(courses.iter().map(|(_, course)| Some(course)));
        for course in lines {
            let course = course.map(|course| &course[..]);
            let points = || {
                let each = seen.kept();
                each.filter_map(|n| Some((n, view.picture.point(recording, course, n)?)))
            };
            // In a loop the model's line can be pointed at as well.
            let moved = |(n, [x, y]): (usize, Point)| match (view.picture, course) {
                (Picture::Loop | Picture::Output, Some(course)) => (n, [x, course[n]]),
                _ => (n, [x, y]),
            };
            let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
            for (_, point) in points() {
                for (ends, value) in ends.iter_mut().zip(point) {
                    *ends = [ends[0].min(value), ends[1].max(value)];
                }
            }
            let way = ends.map(|[low, high]| f64::max(high - low, f64::MIN_POSITIVE));
            for (n, point) in points().map(moved) {
                let [x, y] = [0, 1].map(|axis| (point[axis] - at[axis]) / way[axis]);
                let distance = x.hypot(y);
                if distance < found.0 {
                    found = (distance, n);
                }
            }
        }
        self.sample_at(view.file, &view.fits, found.1)
    }

    /// The first sample after a time at which an operator switches, or the first of all: it is half
    /// way from off to on there, or back. `None` where it never switches.
    pub(super) fn switch(
        &mut self,
        fit: Id,
        file: Id,
        (off, on): (usize, usize),
        after: Option<f64>,
    ) -> Result<Option<SampleView>, Fault> {
        let model = self.fitted(fit)?.model.clone();
        let parts = self.file(file)?.parts()?.clone();
        let shown = &parts.shown;
        let after = after.map(|time| nearest(shown, time));
        let (mut begin, mut first) = (0, None);
        for recording in parts.all() {
            let recording = &*model.rested(recording)?;
            let around = Surroundings::from_recording(&model, recording);
            let acting = model.acting(&recording.input, around)?;
            let mut state = model.start();
            if let Some(input) = around.rest {
                let load = around.load.map(|load| load[0]);
                model.step(
                    &mut state,
                    Sample {
                        input,
                        dt: None,
                        load,
                    },
                )?;
            }
            let mut was = None;
            for (n, input) in acting.iter().enumerate() {
                let sample = Sample {
                    input: *input,
                    dt: around.time.map(|time| time[n] - time[n.saturating_sub(1)]),
                    load: around.load.map(|load| load[n]),
                };
                model.step(&mut state, sample)?;
                let is = model.operator_state(&state, off, on)? >= 0.5;
                if was.replace(is).is_some_and(|was| was != is) {
                    let found = begin + n;
                    if after.is_none_or(|after| found > after) {
                        return self.sample_at(file, &[fit], found).map(Some);
                    }
                    first.get_or_insert(found);
                }
            }
            begin += recording.len();
        }
        first
            .map(|found| self.sample_at(file, &[fit], found))
            .transpose()
    }

    /// The sample with the largest residual of a fit, in the files that the verdict is about: those
    /// for validation, with what else was held out, or else those fitted. Readings that the fit
    /// took for outliers do not count.
    pub(super) fn worst(&mut self, fit: Id) -> Result<WorstView, Fault> {
        let fitted = self.fitted(fit)?;
        let is_tested = !fitted.validated.is_empty();
        let files = fitted.files.iter().chain(&fitted.validated).copied();
        let files: Vec<Id> = files.collect();
        let mut worst: Option<(f64, Id, usize)> = None;
        for file in files {
            let Ok(recording) = self.file(file).and_then(|file| file.recording().cloned()) else {
                continue;
            };
            let course = self.course(fit, file)?;
            let outliers: HashSet<usize> = self.outlier_rows(fit, file)?.into_iter().collect();
            let spans = match is_tested {
                true => self.rows_held(fit, file)?,
                false => [(1, recording.len())].into(),
            };
            let samples = spans.iter().flat_map(|(first, last)| first - 1..*last);
            for n in samples.filter(|n| !outliers.contains(n)) {
                let (modelled, measured) = (course[n], recording.output[n]);
                let residual = (modelled - measured).abs();
                if worst.is_none_or(|(largest, ..)| residual > largest) {
                    worst = Some((residual, file, n));
                }
            }
        }
        let none = || {
            Fault::missing(
                "no file that this fit was judged by is open",
                "open it again",
            )
        };
        let (_, file, n) = worst.ok_or_else(none)?;
        let sample = self.sample_at(file, &[fit], n)?;
        Ok(WorstView { file, sample })
    }
}
