//! Several recordings joined into one experiment: all samples in one series, their branches, and
//! the functions of the load.

use crate::error::{Error, Result};
use crate::identify::options::FitOptions;
use crate::identify::weights::of_load::OfLoad;
use crate::model::Plane;
use crate::model::bernstein;
use crate::recording::{Recording, no_recordings};
use crate::remedy::{Remedy, Setting};
use crate::series::{branch_spans, range, range_of_all, usual_tolerance};
use std::borrow::Cow;
use std::ops::Range;

pub(crate) struct Experiment<'a> {
    /// Those of a single recording are borrowed from it.
    pub(crate) input: Cow<'a, [f64]>,
    pub(crate) output: Cow<'a, [f64]>,
    /// The range of samples of each recording.
    pub(crate) recordings: Vec<Range<usize>>,
    /// The samples of each branch, through all recordings.
    pub(crate) branches: Vec<Range<usize>>,
    /// Smallest and largest load, if there is a load.
    pub(crate) load_range: Option<(f64, f64)>,
    /// Functions of the load at each sample; a single constant 1 without a load.
    pub(crate) parts: Vec<OfLoad>,
    /// The same for the offset, whose order is at least 1. Where gain and offset over the load are
    /// known, that offset is taken off the outputs, and a constant is left.
    pub(crate) offsets: Vec<OfLoad>,
    /// What was taken off; empty where nothing was.
    known: Vec<f64>,
}

impl<'a> Experiment<'a> {
    pub(crate) fn new(recordings: &'a [Recording], options: &FitOptions) -> Result<Self> {
        let Some(first) = recordings.first() else {
            return Err(Error::Fit("there is no recording to fit".into()));
        };
        if recordings.len() > MOST_RECORDINGS {
            return Err(Error::Fit(format!(
                "{} recordings are too many: one experiment has at most {MOST_RECORDINGS}",
                recordings.len()
            )));
        }
        let mut experiment = Self {
            input: joined(recordings, |recording| &recording.input),
            output: joined(recordings, |recording| &recording.output),
            recordings: Vec::new(),
            branches: Vec::new(),
            load_range: None,
            parts: Vec::new(),
            offsets: Vec::new(),
            known: Vec::new(),
        };
        let mut load = first.load.as_ref().map(|_| Vec::new());
        let mut start = 0;
        for recording in recordings {
            recording.check()?;
            let end = start + recording.len();
            experiment.recordings.push(start..end);
            start = end;
            match (&mut load, &recording.load) {
                (Some(all), Some(load)) => all.extend_from_slice(load),
                (None, None) => {}
                _ => {
                    return Err(Error::Fit(
                        "some recordings have a load and some have none".into(),
                    ));
                }
            }
        }
        experiment.find_branches();
        match load {
            None => {
                experiment.parts = vec![OfLoad::One(experiment.input.len())];
                experiment.offsets = experiment.parts.clone();
            }
            Some(load) => {
                let (low, high) = range(&load);
                // Loads that differ only by rounding are one load.
                if high - low <= 1e-9 * high.abs().max(low.abs()) {
                    return Err(Error::Fit(format!(
                        "the load is {low} throughout, so its effect cannot be identified: \
                         fit without it"
                    )));
                }
                let (loads, degree) = (different(&load), options.load_degree.unwrap_or(1));
                if loads <= degree {
                    let what = format!(
                        "{loads} different loads cannot tell weights of order {degree} in the load"
                    );
                    let most = Setting::number("load-degree", loads - 1);
                    let remedy = Remedy::new("take {} at most", [most]);
                    return Err(Error::Fit(what).remedied(remedy));
                }
                experiment.load_range = Some((low, high));
                if let Some(curves) = &options.load_curves {
                    let at = load.iter().map(|load| curves.at(*load));
                    let at = at.collect::<Result<Vec<_>>>()?;
                    let gains = at.iter().map(|at| at.gain).collect();
                    experiment.parts = vec![OfLoad::Each(gains)];
                    experiment.offsets = vec![OfLoad::One(load.len())];
                    experiment.known = at.iter().map(|at| at.offset).collect();
                    let measured = std::mem::take(&mut experiment.output).into_owned();
                    experiment.replace_outputs(measured);
                    return Ok(experiment);
                }
                let share = |load: &f64| (load - low) / (high - low);
                let of_order = |degree| functions(load.iter().map(share), degree);
                experiment.parts = of_order(degree);
                experiment.offsets = of_order(degree.max(1));
            }
        }
        Ok(experiment)
    }

    /// Other outputs of the same recordings, as measured.
    pub(crate) fn replace_outputs(&mut self, mut outputs: Vec<f64>) {
        outputs
            .iter_mut()
            .zip(&self.known)
            .for_each(|(y, at)| *y -= at);
        self.output = Cow::Owned(outputs);
    }

    /// Outputs of a model as they are measured: with what was taken off.
    pub(super) fn as_measured(&self, mut outputs: Vec<f64>) -> Vec<f64> {
        outputs
            .iter_mut()
            .zip(&self.known)
            .for_each(|(y, at)| *y += at);
        outputs
    }

    /// A branch ends where the input turns by more than the noise.
    fn find_branches(&mut self) {
        let band = usual_tolerance(&self.input);
        for Range { start, end } in &self.recordings {
            let own = branch_spans(&self.input[*start..*end], band);
            let own = own.map(|span| start + span.start..start + span.end);
            self.branches.extend(own);
        }
    }

    /// The plane of the options; by default the one for the range of all inputs.
    pub(crate) fn plane(&self, recordings: &[Recording], options: &FitOptions) -> Result<Plane> {
        check_range(recordings, &self.output, |r| &r.output_quantity.name)?;
        check_range(recordings, &self.input, |r| &r.input_quantity.name)?;
        let (low, high) = range(&self.input);
        let Some((min, max)) = options.range else {
            return active_plane(low, high, options.levels);
        };
        let plane = Plane::new(min, max, options.levels)?;
        if plane.normalise(low) >= plane.normalise(high) {
            return Err(Error::Fit(format!(
                "the input, from {low} to {high}, moves no operator of a plane from {min} to \
                 {max}: take another range"
            )));
        }
        Ok(plane)
    }
}

/// Largest number of recordings in one experiment: a pattern of starts has one bit for each.
pub(crate) const MOST_RECORDINGS: usize = 64;

/// The Bernstein polynomials of a degree at each of the shares of the load range.
fn functions(shares: impl Iterator<Item = f64>, degree: usize) -> Vec<OfLoad> {
    let mut functions = vec![Vec::new(); degree + 1];
    for share in shares {
        for (function, value) in functions.iter_mut().zip(bernstein(degree, share)) {
            function.push(value);
        }
    }
    functions.into_iter().map(OfLoad::Each).collect()
}

/// A series of all recordings, one after the other.
fn joined(recordings: &[Recording], series: impl Fn(&Recording) -> &Vec<f64>) -> Cow<'_, [f64]> {
    match recordings {
        [one] => Cow::Borrowed(series(one)),
        all => Cow::Owned(all.iter().flat_map(series).copied().collect()),
    }
}

/// Number of loads that differ by more than a thousandth of their range.
fn different(load: &[f64]) -> usize {
    let mut sorted = load.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (low, high) = range(load);
    let mut last = f64::NEG_INFINITY;
    let mut count = 0;
    for load in sorted {
        if load - last > 1e-3 * (high - low) {
            count += 1;
            last = load;
        }
    }
    count
}

/// The square of a range below this is zero in floating point.
const SMALLEST: f64 = 1e-140;

fn check_range(
    recordings: &[Recording],
    values: &[f64],
    name: impl Fn(&Recording) -> &String,
) -> Result<()> {
    let (low, high) = range(values);
    if high - low >= SMALLEST {
        return Ok(());
    }
    Err(Error::Recording {
        path: recordings[0].source.as_ref().map(|s| s.path.clone()),
        row: None,
        column: Some(name(&recordings[0]).clone()),
        problem: match high > low {
            true => format!("it moves by {:e} only: use another unit", high - low),
            false => format!("it is {low} throughout: nothing can be identified from it"),
        },
    })
}

/// The plane of `levels` levels whose active range `[T_min − ΔT, T_max]` is the range of the input
/// of the recordings. The lowest ridge starts one step below the lowest level.
///
/// # Errors
/// [`Error::Core`] for an invalid number of levels; [`Error::Recording`] for a constant input.
pub fn plane_of(recordings: &(impl AsRef<[Recording]> + ?Sized), levels: usize) -> Result<Plane> {
    let recordings = recordings.as_ref();
    if recordings.is_empty() {
        return Err(no_recordings());
    }
    let (low, high) = range_of_all(recordings.iter().map(|recording| &recording.input));
    check_range(recordings, &[low, high], |r| &r.input_quantity.name)?;
    active_plane(low, high, levels)
}

/// The plane of a fit with these options to all the recordings.
pub(crate) fn plane_of_all(recordings: &[Recording], options: &FitOptions) -> Result<Plane> {
    Experiment::new(recordings, options)?.plane(recordings, options)
}

fn active_plane(low: f64, high: f64, levels: usize) -> Result<Plane> {
    let step = (high - low) / levels.max(1) as f64;
    let mut plane = Plane::new(low + step, high, levels)?;
    // Rounding must not place the lowest input outside the active range.
    for _ in 0..4 {
        if plane.bottom() > low {
            plane = Plane::new(plane.min().next_down(), high, levels)?;
        }
    }
    Ok(plane)
}
