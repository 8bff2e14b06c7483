//! Simple predictors to compare a model with.
//!
//! A model is worth its operators only where it beats what needs none. [`Rival::fit`] fits such a
//! predictor to recordings, and [`Rival::predict`] gives its output for the input of another one.
//!
//! `path` tells on which branch each sample is, and `curve` is the output over the input of one
//! branch. Each of the other files is one predictor.

mod branch_polynomial;
mod curve;
mod interpolation;
mod loads;
mod mean_curve;
mod path;
mod persistence;
mod predictor;

use crate::error::{Error, Result};
use crate::recording::Recording;
pub(crate) use path::Measured;
pub(crate) use predictor::Predictor;
pub use predictor::RivalKind;

/// A simple predictor, fitted to recordings.
///
/// It uses the input alone: the value, the direction of travel and the last reversal. The first
/// input of a recording counts as a reversal. Reversals smaller than 1 % of the range of the input
/// are noise. Where all recordings have a load, there is one predictor for each load, and the
/// output at another load is interpolated between the two nearest ones.
///
/// ```
/// use hysteron::{Recording, Rival, RivalKind};
/// // A play of width 2: the output follows only after the input has gone back by 2.
/// let mut y = 0.0_f64;
/// let input: Vec<f64> = (0..400).map(|n| 5.0 - 5.0 * (f64::from(n) * 0.05).cos()).collect();
/// let output: Vec<f64> = input.iter().map(|x| { y = y.clamp(x - 2.0, *x); y }).collect();
/// let recording = Recording::new(input, output)?;
/// let error = |kind| -> hysteron::Result<f64> {
///     let modelled = Rival::fit(kind, &recording)?.predict(&recording)?;
///     let pairs = modelled.iter().zip(&recording.output);
///     Ok(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
/// };
/// assert!(error(RivalKind::Line)? > 0.8); // it knows nothing of the branches
/// assert!(error(RivalKind::Interpolation)? < 0.1);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Rival {
    kind: RivalKind,
    at_loads: loads::AtLoads,
}

impl Rival {
    /// Fits a predictor to recordings.
    ///
    /// A branch with a single sample is taken for a jump. Nothing is known between its ends, so it
    /// does not count, unless all branches are such.
    ///
    /// # Errors
    /// - [`Error::Fit`] if there is no recording; for [`RivalKind::Persistence`] also if the last
    ///   recording has no whole cycle at its end.
    /// - [`Error::Recording`] for an invalid recording.
    pub fn fit(kind: RivalKind, recordings: &(impl AsRef<[Recording]> + ?Sized)) -> Result<Self> {
        let recordings = recordings.as_ref();
        if recordings.is_empty() {
            return Err(Error::Fit("there is no recording to fit".into()));
        }
        recordings.iter().try_for_each(Recording::check)?;
        let at_loads =
            loads::AtLoads::fit(recordings, |same_load| Predictor::fit(kind, same_load))?;
        Ok(Self { kind, at_loads })
    }

    /// The kind of this predictor.
    #[must_use]
    pub fn kind(&self) -> RivalKind {
        self.kind
    }

    /// Output for each sample, in the unit of the output. Only the input of the recording is used,
    /// and its load.
    ///
    /// # Errors
    /// - [`Error::Recording`] for an invalid recording.
    /// - [`Error::Fit`] for [`RivalKind::Persistence`], if a branch does not repeat the cycle
    ///   fitted; for a predictor with loads, if the recording has none.
    pub fn predict(&self, recording: &Recording) -> Result<Vec<f64>> {
        recording.check()?;
        self.at_loads.predict(recording)
    }
}

/// An error below this, in percent of the range, is no matter.
pub(crate) const SMALL: f64 = 0.05;

/// Whether a rival errs clearly less than a model; errors in percent.
pub(crate) fn wins(rival: f64, model: f64) -> bool {
    model > SMALL && rival < 0.95 * model
}
