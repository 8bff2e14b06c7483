//! The kinds of predictors, each at one load.

use super::path::{self, Measured};
use super::{branch_polynomial, interpolation, mean_curve, persistence};
use crate::error::Result;
use crate::series::Line;

/// The kinds of [`Rival`](crate::Rival).
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

/// A predictor at one load.
#[derive(Debug, Clone)]
pub(crate) enum Predictor {
    Line(Line),
    MeanCurve(mean_curve::MeanCurve),
    BranchPolynomial(branch_polynomial::BranchPolynomial),
    Interpolation(interpolation::Interpolation),
    Persistence(persistence::Persistence),
}

impl Predictor {
    /// Fits to recordings that are valid. There is one at least.
    pub(crate) fn fit(kind: RivalKind, recordings: &[Measured<'_>]) -> Result<Self> {
        Ok(match kind {
            RivalKind::Line => Self::Line(Line::through(recordings.iter().flat_map(|recording| {
                let outputs = recording.output.iter().copied();
                recording.input.iter().copied().zip(outputs)
            }))),
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
    pub(super) fn predict(&self, input: &[f64]) -> Result<Vec<f64>> {
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
