//! Identifies a thermal body by the fit of the weights behind it.

use crate::error::{Error, Result};
use crate::identify::changed::thin;
use crate::identify::fit_weights;
use crate::identify::options::FitOptions;
use crate::identify::stages::nelder_mead::minimise;
use crate::identify::stages::search::step_of;
use crate::model::{FirstOrder, Start, needs_time};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;

/// Number of samples that the search uses (up to three times as many). The last fit uses all
/// samples.
const SEARCHED: usize = 2000;

/// The longest recording must last at least this many time constants: after four, a body has
/// settled to 2 %. A slower body cannot be distinguished from drift.
const SETTLED: f64 = 4.0;

/// Levels at most of the plane on which a first look is taken.
pub(super) const LOOK: usize = 20;

/// Ratio of neighbouring time constants on the first grid.
pub(super) const GRID: f64 = 2.0;

/// A time constant is resolved if half or twice its value fits worse by this ratio of RMSE,
/// whatever the other time constant is. Smaller ratios occur by chance, because the weights can
/// compensate for a wrong body.
const RESOLVED: f64 = 1.25;

/// Where a body looks right only with a rest before the recordings, its error has to be smaller by
/// this factor: any transient at a beginning looks a little like one.
const CLEAR: f64 = 0.5;

/// At this size of the simplex the time constants are known to a thousandth, far better than data
/// can determine.
const TOLERANCE: f64 = 1e-3;

/// Largest number of simplex steps, several times the number that is needed.
const STEPS: usize = 200;

/// Identifies a thermal body from recordings of a drive (squared current, squared voltage, duty
/// cycle) with time. Returns it, and whether the data tell heating and cooling apart.
///
/// For given time constants, finding the weights is the problem of [`fit_weights`]. So the search
/// is over the time constants only (separable least squares, Golub and Pereyra 1973): on a
/// logarithmic grid, then from its best point by the simplex of Nelder and Mead. The time constants
/// lie between the sampling step and a quarter of the longest recording. A faster body is always at
/// rest, and a slower one never comes near it.
///
/// If each branch is driven in one way only, the weights can compensate for a wrong body, and the
/// two time constants are not resolved. Then a common one is identified, which is what a body in
/// constant surroundings has. Drives of different shape, for example a ramp and a step, resolve
/// both.
///
/// # Errors
/// As [`fit_weights`]; [`Error::Thermal`] for recordings without time.
pub(super) fn find(
    recordings: &[Recording],
    options: &FitOptions,
    progress: Progress<'_>,
) -> Result<(FirstOrder, bool)> {
    let search = Search::new(recordings, options, progress)?;
    let (two, least) = search.best(|taus: &[f64; 2]| *taus)?;
    let told_apart = search.all_beside_exceed(&two, RESOLVED * least)?;
    let [tau_heating, tau_cooling] = match told_apart {
        true => two,
        false => search.best(|[tau]: &[f64; 1]| [*tau; 2])?.0,
    };
    let body = FirstOrder {
        tau_heating,
        tau_cooling,
        ..FirstOrder::default()
    };
    Ok((body, told_apart))
}

/// Whether recordings look at all as if their input heats: with some common time constant in front
/// of the operators of a coarse plane, the error on what is fitted is at most this part of that
/// without a body.
///
/// # Errors
/// As [`find`].
pub(in crate::identify) fn may_heat(
    recordings: &[Recording],
    options: &FitOptions,
    most: f64,
    progress: Progress<'_>,
) -> Result<bool> {
    // From any start, which is not known here.
    let options = FitOptions {
        levels: options.levels.min(LOOK),
        start: Start::Unknown,
        ..options.clone()
    };
    let search = Search::new(recordings, &options, progress)?;
    let thinned: Vec<Recording> = recordings.iter().map(|r| search.thinned(r)).collect();
    let cold = fit_weights(&thinned, &search.options, Progress::NONE)?;
    let most = most * cold.fit.map_or(0.0, |fit| fit.rmse);
    let look = search.look()?;
    Ok(look.at_first <= most || look.rested <= CLEAR * most)
}

pub(super) struct Search<'a> {
    pub(super) recordings: &'a [Recording],
    pub(super) options: FitOptions,
    pub(super) progress: Progress<'a>,
    /// Logarithms of the shortest and the longest time constant searched.
    bounds: (f64, f64),
    /// Of each run of this many samples, at most three are used.
    stride: usize,
}

impl<'a> Search<'a> {
    pub(super) fn new(
        recordings: &'a [Recording],
        options: &FitOptions,
        progress: Progress<'a>,
    ) -> Result<Self> {
        if recordings.is_empty() {
            return Err(Error::Fit("there is no recording to fit".into()));
        }
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
        for recording in recordings {
            recording.check()?;
            let (start, end) = range(recording.time.as_ref().ok_or_else(needs_time)?);
            shortest = shortest.min(step_of(recording));
            longest = longest.max(end - start);
        }
        if shortest <= 0.0 {
            return Err(Error::Thermal(
                "time does not pass in a recording, so its body cannot be identified".into(),
            ));
        }
        let samples: usize = recordings.iter().map(Recording::len).sum();
        Ok(Self {
            recordings,
            options: FitOptions {
                bootstrap: 0,
                ..options.clone()
            },
            progress,
            bounds: (shortest.ln(), (longest / SETTLED).max(shortest).ln()),
            stride: samples.div_ceil(SEARCHED),
        })
    }

    /// The same search in recordings that differ in their rests.
    pub(super) fn of<'r>(&'r self, recordings: &'r [Recording]) -> Search<'r> {
        Search {
            recordings,
            options: self.options.clone(),
            ..*self
        }
    }

    /// Whether this logarithm of a time constant is one that is searched.
    pub(super) fn has(&self, logarithm: f64) -> bool {
        (self.bounds.0..=self.bounds.1).contains(&logarithm)
    }

    /// The samples of a recording behind a body that the search uses.
    pub(super) fn thinned(&self, behind: &Recording) -> Recording {
        thin(behind, self.stride)
    }

    /// RMSE with the best weights behind a body with these logarithms of its time constants.
    fn rmse(&self, logarithms: [f64; 2]) -> Result<f64> {
        self.progress.tell("time constants", f64::NAN)?;
        let [tau_heating, tau_cooling] = logarithms.map(f64::exp);
        let body = FirstOrder {
            tau_heating,
            tau_cooling,
            ..FirstOrder::default()
        };
        let thinned = |r: &Recording| Ok(self.thinned(&body.behind(r)?));
        let heated: Result<Vec<Recording>> = self.recordings.iter().map(thinned).collect();
        match fit_weights(&heated?, &self.options, Progress::NONE) {
            Ok(model) => Ok(model.fit.map_or(f64::INFINITY, |fit| fit.rmse)),
            // The body is too slow to reach the plane. Other invalid options are refused by the
            // last fit as well.
            Err(error) if matches!(error.parts().0, Error::Fit(_)) => Ok(f64::INFINITY),
            Err(error) => Err(error),
        }
    }

    /// The best time constants with `N` free logarithms (1: a common time constant, 2: both), and
    /// their RMSE.
    fn best<const N: usize>(
        &self,
        logarithms: impl Fn(&[f64; N]) -> [f64; 2],
    ) -> Result<([f64; 2], f64)> {
        let (start, _) = self.best_of_grid(&logarithms)?;
        self.best_near(start, logarithms)
    }

    /// The best time constants near a point of the grid, and their RMSE.
    fn best_near<const N: usize>(
        &self,
        start: [f64; N],
        logarithms: impl Fn(&[f64; N]) -> [f64; 2],
    ) -> Result<([f64; 2], f64)> {
        let value = |point: &[f64; N]| self.rmse_inside(point, &logarithms);
        let (point, rmse) = minimise(start, 0.5 * GRID.ln(), TOLERANCE, STEPS, value)?;
        Ok((logarithms(&point).map(f64::exp), rmse))
    }

    /// The best point of a grid, and its RMSE.
    pub(super) fn best_of_grid<const N: usize>(
        &self,
        logarithms: impl Fn(&[f64; N]) -> [f64; 2],
    ) -> Result<([f64; N], f64)> {
        let (low, high) = self.bounds;
        let points = 1 + ((high - low) / GRID.ln()) as usize;
        let mut best = ([low; N], f64::INFINITY);
        for number in 0..points.pow(N as u32) {
            let place = |axis: usize| number / points.pow(axis as u32) % points;
            let point = std::array::from_fn(|axis| low + place(axis) as f64 * GRID.ln());
            let rmse = self.rmse_inside(&point, &logarithms)?;
            if rmse < best.1 {
                best = (point, rmse);
            }
        }
        Ok(best)
    }

    /// The RMSE at a point; endless outside what is searched.
    pub(super) fn rmse_inside<const N: usize>(
        &self,
        point: &[f64; N],
        logarithms: impl Fn(&[f64; N]) -> [f64; 2],
    ) -> Result<f64> {
        match point.iter().all(|tau| self.has(*tau)) {
            true => self.rmse(logarithms(point)),
            false => Ok(f64::INFINITY),
        }
    }

    /// Whether every body with either time constant halved or doubled, and the other one free, has
    /// an RMSE above `most`. The first one that has not is enough, and the grid often has it.
    fn all_beside_exceed(&self, taus: &[f64; 2], most: f64) -> Result<bool> {
        for (factor, is_heating) in [(0.5, true), (0.5, false), (2.0, true), (2.0, false)] {
            let [heating, cooling] = taus.map(|tau| (factor * tau).ln());
            let line = |[other]: &[f64; 1]| match is_heating {
                true => [heating, *other],
                false => [*other, cooling],
            };
            let (start, rmse) = self.best_of_grid(line)?;
            if rmse <= most || self.best_near(start, line)?.1 <= most {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
