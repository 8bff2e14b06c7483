//! How many combinations of the weights a recording determines.

use crate::error::Result;
use crate::identify::doubt::excitation::centred_gram;
use crate::identify::initial::Initial;
use crate::identify::weights::not_definite::not_definite;
use crate::identify::weights::room::check_dense;
use crate::identify::weights::sparse::SparseForm;
use crate::model::Plane;
use crate::recording::Recording;
use crate::series::noise::noise;
use crate::series::range;
use faer::{Mat, Side};
use hysteron_core::Operator;

/// Eigenvalues below this share of the largest one are zero up to rounding.
const ROUNDING: f64 = 1e-12;

/// The eigenvalues of a centred Gram matrix that are above rounding. Each belongs to a combination
/// of weights that the data determine. All are counted in samples.
pub(crate) struct Spectrum {
    largest: f64,
    above: Vec<f64>,
}

impl Spectrum {
    /// Of a symmetric matrix in which `ridge` was added to the diagonal.
    pub(crate) fn new(matrix: &[f64], ridge: f64) -> Result<Self> {
        let count = matrix.len().isqrt();
        let values = Mat::from_fn(count, count, |i, j| matrix[i * count + j])
            .self_adjoint_eigenvalues(Side::Lower)
            .map_err(|_| not_definite())?;
        let largest = values.iter().copied().fold(0.0, f64::max);
        let above = values.into_iter().map(|value| value - ridge);
        Ok(Self {
            largest,
            above: above.filter(|value| *value > ROUNDING * largest).collect(),
        })
    }

    /// Number of combinations of weights that the data determine if there is no noise.
    pub(crate) fn rank(&self) -> usize {
        self.above.len()
    }

    /// Ratio of the largest to the smallest singular value of the centred regressor.
    pub(crate) fn condition(&self) -> f64 {
        let smallest = self.above.iter().copied().fold(f64::INFINITY, f64::min);
        match self.above.is_empty() {
            true => 1.0,
            false => (self.largest / smallest).sqrt(),
        }
    }

    /// Number of combinations whose standard error is at most `size`, where each output has the
    /// standard deviation `noise`. The standard error of a combination is the noise over the square
    /// root of its eigenvalue.
    fn above_noise(&self, noise: f64, size: f64) -> usize {
        let seen = |value: &&f64| noise <= size * value.sqrt();
        self.above.iter().filter(seen).count()
    }
}

/// The largest number of operators for which the eigenvalues are found: those of 50 levels. It takes
/// a few seconds.
const MOST_OPERATORS: usize = 1275;

/// The numbers of combinations of the weights of `plane` that recordings determine: without noise,
/// and against the noise of their `output`, one after the other. `None` for more than 50 levels.
///
/// A combination counts against the noise if its standard error is at most the weight that each
/// operator has where all share the range of the output evenly.
pub(crate) fn determined(
    recordings: &[Recording],
    output: &[f64],
    plane: Plane,
) -> Result<Option<(usize, usize)>> {
    let operators = plane.operators();
    if operators > MOST_OPERATORS {
        return Ok(None);
    }
    check_dense(operators)?;
    let form = SparseForm::new(plane, Operator::Mkp)?;
    let inputs: Vec<&[f64]> = recordings.iter().map(|r| r.input.as_slice()).collect();
    let gram = centred_gram(&inputs, &form, Initial::Off)?;
    let spectrum = Spectrum::new(&gram, 0.0)?;
    let (low, high) = range(output);
    let even = (high - low) / operators as f64;
    let against_noise = spectrum.above_noise(noise(output), even);
    Ok(Some((spectrum.rank(), against_noise)))
}
