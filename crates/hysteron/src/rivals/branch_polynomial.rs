//! A polynomial for each direction of travel.

use super::path::{Leg, Measured, legs};

/// Highest degree.
const HIGHEST: usize = 5;

/// Groups of samples that are left out in turn to choose the degree.
const FOLDS: usize = 5;

#[derive(Debug, Clone)]
pub(crate) struct BranchPolynomial {
    rising: Polynomial,
    falling: Polynomial,
}

/// A sample, and the leg that it is on.
#[derive(Clone, Copy)]
struct Sample {
    x: f64,
    y: f64,
    leg: usize,
}

impl BranchPolynomial {
    pub(super) fn fit(recordings: &[Measured<'_>]) -> Self {
        let mut of: [Vec<Sample>; 2] = [Vec::new(), Vec::new()];
        let mut count = [0, 0];
        for recording in recordings {
            for leg in legs(recording.input) {
                let way = usize::from(leg.rises);
                let sample = |n: usize| Sample {
                    x: recording.input[n],
                    y: recording.output[n],
                    leg: count[way],
                };
                of[way].extend(leg.samples.clone().map(sample));
                count[way] += 1;
            }
        }
        let chosen =
            |samples: &[Sample]| (!samples.is_empty()).then(|| Polynomial::chosen(samples));
        let [falling, rising] = of.map(|samples| chosen(&samples));
        // A recording has at least one sample, so at least one direction.
        let either = rising.clone().or(falling.clone()).unwrap_or_default();
        Self {
            rising: rising.unwrap_or(either.clone()),
            falling: falling.unwrap_or(either),
        }
    }

    pub(super) fn at(&self, leg: &Leg, x: f64) -> f64 {
        let polynomial = match leg.rises {
            true => &self.rising,
            false => &self.falling,
        };
        polynomial.at(x)
    }
}

/// A polynomial in Chebyshev's basis over a range of the input. Beyond the range it is level,
/// because a polynomial says nothing there.
#[derive(Debug, Clone, Default)]
struct Polynomial {
    low: f64,
    high: f64,
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// Of the degree with the smallest error on what is left out: whole legs in turn where there
    /// are three or more, otherwise every fifth sample.
    fn chosen(samples: &[Sample]) -> Self {
        let whole = samples.last().is_some_and(|last| last.leg >= 2);
        let fold = |n: usize, sample: &Sample| if whole { sample.leg } else { n } % FOLDS;
        let squares = |degree: usize| -> f64 {
            let mut squares = 0.0;
            for f in 0..FOLDS {
                let (mut kept, mut left_out) = (Vec::new(), Vec::new());
                for (n, sample) in samples.iter().enumerate() {
                    let side = if fold(n, sample) == f {
                        &mut left_out
                    } else {
                        &mut kept
                    };
                    side.push(*sample);
                }
                if !kept.is_empty() {
                    let found = Self::of_degree(&kept, degree);
                    // Beyond the inputs kept, no degree is better than another.
                    let inside = left_out
                        .iter()
                        .filter(|s| (found.low..=found.high).contains(&s.x));
                    squares += inside.map(|s| (found.at(s.x) - s.y).powi(2)).sum::<f64>();
                }
            }
            squares
        };
        let mut best = (f64::INFINITY, 0);
        for degree in 0..=HIGHEST {
            let squares = squares(degree);
            if squares < best.0 {
                best = (squares, degree);
            }
        }
        Self::of_degree(samples, best.1)
    }

    /// Least squares, of the given degree or of the highest one that the samples determine.
    fn of_degree(samples: &[Sample], degree: usize) -> Self {
        let low = samples.iter().map(|s| s.x).fold(f64::INFINITY, f64::min);
        let high = samples
            .iter()
            .map(|s| s.x)
            .fold(f64::NEG_INFINITY, f64::max);
        let mut found = Self {
            low,
            high,
            coefficients: Vec::new(),
        };
        let pairs: Vec<(f64, f64)> = samples.iter().map(|s| (found.position(s.x), s.y)).collect();
        found.coefficients = least_squares(&pairs, degree + 1);
        found
    }

    /// The input from −1 to 1.
    fn position(&self, x: f64) -> f64 {
        match self.high > self.low {
            true => (2.0 * (x - self.low) / (self.high - self.low) - 1.0).clamp(-1.0, 1.0),
            false => 0.0,
        }
    }

    fn at(&self, x: f64) -> f64 {
        let values = chebyshev(self.position(x));
        let terms = self.coefficients.iter().zip(values);
        terms.map(|(c, value)| c * value).sum()
    }
}

/// Chebyshev's polynomials of degree 0 to [`HIGHEST`].
fn chebyshev(t: f64) -> [f64; HIGHEST + 1] {
    let mut values = [1.0; HIGHEST + 1];
    values[1] = t;
    for k in 2..=HIGHEST {
        values[k] = 2.0 * t * values[k - 1] - values[k - 2];
    }
    values
}

/// Coefficients of the first `count` basis functions, by orthogonalising them over the samples
/// (modified Gram-Schmidt). A function that the samples do not tell apart from the others gets 0.
fn least_squares(pairs: &[(f64, f64)], count: usize) -> Vec<f64> {
    let mut residual: Vec<f64> = pairs.iter().map(|pair| pair.1).collect();
    // Each orthogonal column, and how it is made of the basis.
    let mut columns: Vec<(Vec<f64>, [f64; HIGHEST + 1])> = Vec::new();
    let mut coefficients = vec![0.0; count];
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for k in 0..count {
        let mut column: Vec<f64> = pairs.iter().map(|pair| chebyshev(pair.0)[k]).collect();
        let mut made_of = [0.0; HIGHEST + 1];
        made_of[k] = 1.0;
        let whole = dot(&column, &column);
        for (other, other_made_of) in &columns {
            let share = dot(&column, other) / dot(other, other);
            column
                .iter_mut()
                .zip(other)
                .for_each(|(a, b)| *a -= share * b);
            made_of
                .iter_mut()
                .zip(other_made_of)
                .for_each(|(a, b)| *a -= share * b);
        }
        let norm = dot(&column, &column);
        // What is left of a dependent column is rounding.
        if norm <= 1e-20 * whole.max(1.0) {
            continue;
        }
        let amount = dot(&residual, &column) / norm;
        residual
            .iter_mut()
            .zip(&column)
            .for_each(|(r, c)| *r -= amount * c);
        coefficients
            .iter_mut()
            .zip(made_of)
            .for_each(|(c, m)| *c += amount * m);
        columns.push((column, made_of));
    }
    coefficients
}
