//! What is drawn besides lines: where recordings begin, what is marked and held out, and of one fit
//! its band and its outliers.

use super::fault::Fault;
use super::fitted::Spans;
use super::fitting::held_part;
use super::id::Id;
use super::opened::Opened;
use super::seen::Seen;
use super::state::Session;
use super::thinned::{Points, when};
use super::view::{Picture, View};
use hysteron::{HoldOut, Recording, Surroundings};
use serde::Serialize;
use std::sync::Arc;

/// The most outliers that are drawn.
const OUTLIERS: usize = 2000;

/// What is drawn besides lines.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Layers {
    /// The times at which a recording begins after another one.
    pub begins: Vec<f64>,
    /// The spans of the time marked for validation.
    pub marked: Vec<(f64, f64)>,
    /// The spans of the time that were held out of the fit.
    pub held: Vec<(f64, f64)>,
    /// The lower and the upper end of the fit's 95 % band.
    pub band: Option<[Points; 2]>,
    /// What that band is called.
    pub band_name: Option<String>,
    /// The samples that the fit took for outliers.
    pub outliers: Vec<(f64, f64)>,
}

impl Session {
    pub(super) fn layers(&mut self, view: &View, seen: &Seen<'_>) -> Result<Layers, Fault> {
        let recording = seen.recording;
        let times = |spans: &[(usize, usize)]| {
            let ends = spans.iter();
            ends.map(|(a, b)| (when(recording, a - 1), when(recording, b - 1)))
                .collect()
        };
        let opened = self.file(view.file)?;
        let begins = opened.parts()?.begins().skip(1);
        let mut layers = Layers {
            begins: begins.map(|n| when(recording, n)).collect(),
            marked: times(&opened.marked),
            ..Layers::default()
        };
        // A fit that cannot be run on this file has no layers on it.
        let runs = |fit: &Id| self.course(*fit, view.file).is_ok();
        let Some(fit) = view.of.filter(runs) else {
            return Ok(layers);
        };
        layers.held = times(&self.rows_held(fit, view.file)?);
        layers.outliers = self.outliers(fit, view, seen)?;
        if let (Picture::Output, true) = (view.picture, view.band) {
            let half = self.half_width(fit, view.file)?;
            let summary = self.fitted(fit)?.model.fit.as_ref();
            let confidence = summary.and_then(|fit| fit.confidence.as_ref());
            layers.band_name = confidence.map(hysteron::Confidence::band_name);
            let course = self.course(fit, view.file)?;
            layers.band = half.map(|half| {
                let end = |sign: f64| seen.over_time(|n| course[n] + sign * half[n]);
                [end(-1.0), end(1.0)]
            });
        }
        Ok(layers)
    }

    /// The rows of a file that were held out of a fit.
    pub(super) fn rows_held(&mut self, fit: Id, file: Id) -> Result<Spans, Fault> {
        let fitted = self.fitted(fit)?;
        if let Some(spans) = fitted.held.get(&file) {
            return Ok(spans.clone());
        }
        let parts = self.file(file)?.parts()?;
        let mut held = vec![false; parts.shown.len()];
        let part = held_part(&fitted.words).parse::<HoldOut>().ok();
        match part.filter(|_| fitted.files.contains(&file)) {
            None => held.fill(fitted.validated.contains(&file)),
            Some(HoldOut::Rows(rows)) => {
                // Rows are counted through all files of the fit.
                let before = fitted.files.iter().take_while(|other| **other != file);
                let length = |id: &Id| Some(self.file(*id).ok()?.recording().ok()?.len());
                let before: usize = before.filter_map(length).sum();
                for span in rows {
                    let first = span.start().saturating_sub(before + 1);
                    let end = span.end().saturating_sub(before).min(held.len());
                    held.get_mut(first..end)
                        .into_iter()
                        .for_each(|rows| rows.fill(true));
                }
            }
            Some(part) => {
                let held_out = fitted.judged.held_out.as_ref();
                let at_end = held_out.is_some_and(|held_out| held_out.at_end);
                let mut begin = 0;
                for recording in parts.all() {
                    let end = begin + recording.len();
                    let split = match part {
                        HoldOut::Branches(share) if at_end => recording.split_end(share),
                        _ => recording.split(&part),
                    };
                    if let Ok(split) = split {
                        held[begin..end].copy_from_slice(&split.held_out);
                    }
                    begin = end;
                }
            }
        }
        let mut end = 0;
        let spans = held.chunk_by(|a, b| a == b).filter_map(|run| {
            let first = end + 1;
            end += run.len();
            run[0].then_some((first, end))
        });
        let spans: Spans = spans.collect();
        if let Some(fitted) = self.fits.iter_mut().find(|other| other.id == fit) {
            fitted.held.insert(file, spans.clone());
        }
        Ok(spans)
    }

    /// Half the width of a fit's band at each row of a file; `None` without a band.
    fn half_width(&mut self, fit: Id, file: Id) -> Result<Option<Arc<Vec<f64>>>, Fault> {
        let parts = self.file(file)?.parts()?.clone();
        let fitted = self.fitted(fit)?;
        if let Some((half, _)) = fitted.bands.get(&file) {
            return Ok(Some(half.clone()));
        }
        let model = fitted.model.clone();
        if !matches!(model.band(), Ok(Some(_))) {
            return Ok(None);
        }
        let held = self.held(
            (size_of::<f64>() * parts.shown.len()) as u64,
            "the band of a model",
        )?;
        let of = |recording: &Recording| {
            let recording = &*model.rested(recording)?;
            let around = Surroundings::from_recording(&model, recording);
            let (low, high) = model.band_in(&recording.input, around)?;
            let half = low.iter().zip(high).map(|(low, high)| 0.5 * (high - low));
            Ok::<Vec<f64>, Fault>(half.collect())
        };
        let each = parts.all().iter().map(of).collect::<Result<Vec<_>, _>>()?;
        let half = Arc::new(each.concat());
        if let Some(fitted) = self.fits.iter_mut().find(|other| other.id == fit) {
            fitted.bands.insert(file, (half.clone(), held));
        }
        Ok(Some(half))
    }

    /// The samples of a view that a fit took for outliers, as points of the picture.
    fn outliers(
        &mut self,
        fit: Id,
        view: &View,
        seen: &Seen<'_>,
    ) -> Result<Vec<(f64, f64)>, Fault> {
        let course = self.course(fit, view.file)?;
        let rows = self.outlier_rows(fit, view.file)?;
        let rows = rows.into_iter().filter(|n| seen.shows(*n));
        let points = rows.filter_map(|n| view.picture.point(seen.recording, Some(&course), n));
        Ok(points.take(OUTLIERS).map(|[x, y]| (x, y)).collect())
    }

    /// The samples of a file, counted from 0, that a fit took for outliers.
    pub(super) fn outlier_rows(&self, fit: Id, file: Id) -> Result<Vec<usize>, Fault> {
        let fitted = self.fitted(fit)?;
        // Recordings are counted through all files of the fit, which have to be there for that.
        let before = fitted.files.iter().take_while(|id| **id != file);
        let count = |id: &Id| Some(self.file(*id).ok()?.parts().ok()?.all().len());
        let before: Option<usize> = before.map(count).sum();
        let found = fitted.model.fit.as_ref().map(|fit| &fit.outliers);
        let (Some(before), Some(found), true) = (before, found, fitted.files.contains(&file))
        else {
            return Ok(Vec::new());
        };
        let begins: Vec<usize> = self.file(file)?.parts()?.begins().collect();
        let row = |(recording, sample): (usize, usize)| {
            let recording = recording.checked_sub(before)?;
            begins.get(recording)?.checked_add(sample)
        };
        let found = found.iter().map(|one| (one.recording, one.sample));
        Ok(found.filter_map(row).collect())
    }
}

impl Opened {
    /// The time of the first and of the last sample of each of its recordings.
    pub(super) fn spans(&self) -> Vec<(f64, f64)> {
        let Ok(parts) = self.parts() else {
            return Vec::new();
        };
        let mut begin = 0;
        let each = parts.all().iter().map(|recording| {
            let first = begin;
            begin += recording.len();
            (when(&parts.shown, first), when(&parts.shown, begin - 1))
        });
        each.collect()
    }
}
