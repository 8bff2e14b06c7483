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
mod line;
mod loads;
mod mean_curve;
mod path;
mod persistence;

use crate::error::{Error, Result};
use crate::recording::Recording;
pub(crate) use path::Measured;

/// The kinds of [`Rival`].
///
/// | kind | what it predicts |
/// | --- | --- |
/// | `Line` | a straight line through all samples, by least squares |
/// | `MeanCurve` | the mean of all branches at that input: a curve without hysteresis |
/// | `BranchPolynomial` | for each direction of travel a polynomial of degree 0 to 5 |
/// | `Interpolation` | between the branches of the same direction, by their reversals |
/// | `Persistence` | what was measured one cycle before |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RivalKind {
    /// A straight line through all samples, by least squares.
    Line,
    /// The mean of all branches at the same input.
    MeanCurve,
    /// A polynomial for each direction of travel. Its degree, at most 5, is the one with the
    /// smallest error on samples left out.
    BranchPolynomial,
    /// Linear interpolation over the input and over the last reversal, among the branches of the
    /// same direction; the nearest branch where there is no neighbour.
    Interpolation,
    /// The last branch of the same direction, as it was measured. Reversals up to a tenth of the
    /// range are part of a branch here.
    Persistence,
}

impl RivalKind {
    /// Every kind.
    pub const ALL: [Self; 5] = [
        Self::Line,
        Self::MeanCurve,
        Self::BranchPolynomial,
        Self::Interpolation,
        Self::Persistence,
    ];

    /// The name for tables and messages, for example `straight line`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Line => "straight line",
            Self::MeanCurve => "mean curve",
            Self::BranchPolynomial => "branch polynomial",
            Self::Interpolation => "interpolation",
            Self::Persistence => "persistence",
        }
    }
}

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

/// A predictor at one load.
#[derive(Debug, Clone)]
pub(crate) enum Predictor {
    Line(line::Line),
    MeanCurve(mean_curve::MeanCurve),
    BranchPolynomial(branch_polynomial::BranchPolynomial),
    Interpolation(interpolation::Interpolation),
    Persistence(persistence::Persistence),
}

impl Predictor {
    /// Fits to recordings that are valid. There is one at least.
    pub(crate) fn fit(kind: RivalKind, recordings: &[Measured<'_>]) -> Result<Self> {
        Ok(match kind {
            RivalKind::Line => Self::Line(line::Line::fit(recordings)),
            RivalKind::MeanCurve => Self::MeanCurve(mean_curve::MeanCurve::fit(recordings)),
            RivalKind::BranchPolynomial => {
                Self::BranchPolynomial(branch_polynomial::BranchPolynomial::fit(recordings))
            }
            RivalKind::Interpolation => {
                Self::Interpolation(interpolation::Interpolation::fit(recordings))
            }
            RivalKind::Persistence => Self::Persistence(persistence::Persistence::fit(recordings)?),
        })
    }

    /// The output at each sample.
    fn predict(&self, input: &[f64]) -> Result<Vec<f64>> {
        let mut output = Vec::with_capacity(input.len());
        self.each(input, |_| true, |_, y| output.push(y))?;
        Ok(output)
    }

    /// Gives the number of each sample that is wanted to `take`, and the output there, in order.
    pub(crate) fn each(
        &self,
        input: &[f64],
        wanted: impl Fn(usize) -> bool,
        mut take: impl FnMut(usize, f64),
    ) -> Result<()> {
        let legs = match self {
            Self::Persistence(cycle) => cycle.legs(input)?,
            _ => path::legs(input),
        };
        for leg in &legs {
            for n in leg.samples.clone().filter(|n| wanted(*n)) {
                take(n, self.at(leg, input[n]));
            }
        }
        Ok(())
    }

    fn at(&self, leg: &path::Leg, x: f64) -> f64 {
        match self {
            Self::Line(line) => line.at(x),
            Self::MeanCurve(curve) => curve.at(x),
            Self::BranchPolynomial(polynomials) => polynomials.at(leg, x),
            Self::Interpolation(branches) => branches.at(leg, x),
            Self::Persistence(cycle) => cycle.at(leg, x),
        }
    }
}
