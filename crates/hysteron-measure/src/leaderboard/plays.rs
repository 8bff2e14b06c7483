//! A ridge on plays, a rival: plays with weights of any sign, a straight line and a constant.
//!
//! Few numbers describe it, so little data is enough. It is not monotone, so it has no inverse.
//! Ridge and number of plays are those with the least error on parts of the training that were left
//! out (Hoerl and Kennard 1970).

use super::prandtl::plays;
use crate::result::Result;
use hysteron::{Recording, branches, range, usual_tolerance};

/// The most plays. A half and a quarter of them are tried too: their radii are among these.
const MOST: usize = 40;
const STRIDES: [usize; 3] = [1, 2, 4];

/// Ridges that are tried, as powers of ten relative to the mean square of a play.
const RIDGES: std::ops::RangeInclusive<i32> = -12..=0;

/// Parts that are left out in turn. With fewer branches than [`ENOUGH`], they are stretches of the
/// recording instead of branches.
const FOLDS: usize = 10;
const ENOUGH: usize = 6;

pub struct RidgeOnPlays {
    low: f64,
    radii: Vec<f64>,
    weights: Vec<f64>,
    constant: f64,
}

impl RidgeOnPlays {
    /// The first radius is 0: that play is the line, which the ridge does not shrink.
    pub fn fit(recording: &Recording) -> Result<Self> {
        let Recording { input, output, .. } = recording;
        let (low, high) = range(input);
        let radius = |k: usize| 0.5 * (high - low) * k as f64 / MOST as f64;
        let radii: Vec<f64> = (0..MOST).map(radius).collect();
        let columns = plays(&radii, low, input);
        let means: Vec<f64> = columns.iter().map(|column| mean(column)).collect();
        let middle = mean(output);
        // The constant is the last column.
        let row = |n: usize| {
            let own = columns.iter().zip(&means).map(|(column, m)| column[n] - m);
            own.chain([1.0]).collect::<Vec<f64>>()
        };
        let mut folds = vec![Sums::new(MOST + 1); FOLDS];
        for (n, fold) in folds_of(input).into_iter().enumerate() {
            folds[fold].add(&row(n), output[n] - middle);
        }
        let mut all = Sums::new(MOST + 1);
        folds.iter().for_each(|fold| all.combine(fold, 1.0));

        let mut best: Option<(f64, Vec<f64>)> = None;
        for stride in STRIDES {
            let members: Vec<usize> = (0..MOST).step_by(stride).chain([MOST]).collect();
            for ridge in RIDGES.map(|power| 10_f64.powi(power)) {
                let left_out = |fold: &Sums| {
                    let mut rest = all.clone();
                    rest.combine(fold, -1.0);
                    Some(fold.error(&rest.solved(&members, ridge)?))
                };
                let error: Option<f64> = folds.iter().map(left_out).sum();
                if let (Some(error), Some(x)) = (error, all.solved(&members, ridge))
                    && best.as_ref().is_none_or(|(least, _)| error < *least)
                {
                    best = Some((error, x));
                }
            }
        }
        let (_, mut weights) = best.ok_or("no ridge makes the plays independent")?;
        let own = weights.pop().unwrap_or_default();
        let moved = weights.iter().zip(&means).map(|(w, m)| w * m);
        Ok(Self {
            constant: middle + own - moved.sum::<f64>(),
            low,
            radii,
            weights,
        })
    }

    /// The output for an input that begins with every play at the lowest input fitted.
    pub fn predict(&self, input: &[f64]) -> Vec<f64> {
        let columns = plays(&self.radii, self.low, input);
        let at = |n: usize| {
            let terms = self.weights.iter().zip(&columns);
            self.constant + terms.map(|(w, column)| w * column[n]).sum::<f64>()
        };
        (0..input.len()).map(at).collect()
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The fold of each sample.
fn folds_of(input: &[f64]) -> Vec<usize> {
    let branch = branches(input, usual_tolerance(input));
    let count = branch.iter().max().map_or(0, |last| last + 1);
    match count >= ENOUGH {
        true => branch.into_iter().map(|branch| branch % FOLDS).collect(),
        false => (0..input.len()).map(|n| n * FOLDS / input.len()).collect(),
    }
}

/// The normal equations of some samples.
#[derive(Clone)]
struct Sums {
    /// `Aᵀ A`, row by row, and `Aᵀ y`.
    gram: Vec<Vec<f64>>,
    right: Vec<f64>,
    squares: f64,
}

impl Sums {
    fn new(count: usize) -> Self {
        Self {
            gram: vec![vec![0.0; count]; count],
            right: vec![0.0; count],
            squares: 0.0,
        }
    }

    fn add(&mut self, row: &[f64], y: f64) {
        for ((gram, right), a) in self.gram.iter_mut().zip(&mut self.right).zip(row) {
            gram.iter_mut().zip(row).for_each(|(g, b)| *g += a * b);
            *right += a * y;
        }
        self.squares += y * y;
    }

    fn combine(&mut self, other: &Self, factor: f64) {
        for (to, from) in self.gram.iter_mut().zip(&other.gram) {
            to.iter_mut().zip(from).for_each(|(t, f)| *t += factor * f);
        }
        let rights = self.right.iter_mut().zip(&other.right);
        rights.for_each(|(t, f)| *t += factor * f);
        self.squares += factor * other.squares;
    }

    /// The sum of squared errors at `x`.
    fn error(&self, x: &[f64]) -> f64 {
        let dot = |a: &[f64]| a.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
        let quadratic = self.gram.iter().zip(x).map(|(row, x)| x * dot(row));
        self.squares - 2.0 * dot(&self.right) + quadratic.sum::<f64>()
    }

    /// The coefficients with a ridge on the plays among the `members`, zero for all others. `None`
    /// where the matrix is singular up to rounding.
    fn solved(&self, members: &[usize], ridge: f64) -> Option<Vec<f64>> {
        let size = members.len();
        let trace: f64 = members[..size - 1].iter().map(|k| self.gram[*k][*k]).sum();
        let added = ridge * trace / (size - 1) as f64;
        let is_play = |n: usize| n > 0 && n + 1 < size;
        // Cholesky: L Lᵀ = A.
        let mut l = vec![vec![0.0; size]; size];
        for i in 0..size {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
                let element = self.gram[members[i]][members[j]] - known;
                if i > j {
                    l[i][j] = element / l[j][j];
                    continue;
                }
                let pivot = element + if is_play(i) { added } else { 0.0 };
                if pivot <= f64::EPSILON * self.gram[members[i]][members[i]] {
                    return None;
                }
                l[i][i] = pivot.sqrt();
            }
        }
        let mut z: Vec<f64> = members.iter().map(|n| self.right[*n]).collect();
        for i in 0..size {
            let known: f64 = (0..i).map(|k| l[i][k] * z[k]).sum();
            z[i] = (z[i] - known) / l[i][i];
        }
        for i in (0..size).rev() {
            let known: f64 = (i + 1..size).map(|k| l[k][i] * z[k]).sum();
            z[i] = (z[i] - known) / l[i][i];
        }
        let mut x = vec![0.0; self.right.len()];
        members.iter().zip(z).for_each(|(n, z)| x[*n] = z);
        Some(x)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// Plays, one of which has a negative weight, are found again, with line and constant.
    #[test]
    fn plays_of_either_sign_are_found_again() {
        let amplitude = |n: f64| 5.0 * (1.0 - n / 2000.0);
        let samples = (0..1200).map(f64::from);
        let input: Vec<f64> = samples
            .map(|n| 5.0 - amplitude(n) * (n * 0.05).cos())
            .collect();
        let (low, high) = range(&input);
        let radius = |k: f64| 0.5 * (high - low) * k / MOST as f64;
        let known = plays(&[radius(8.0), radius(24.0)], low, &input);
        let at = |n: usize| 2.0 + 0.4 * input[n] + 0.7 * known[0][n] - 0.3 * known[1][n];
        let output: Vec<f64> = (0..input.len()).map(at).collect();
        let (low, high) = range(&output);
        let recording = Recording::new(input, output).unwrap();
        let model = RidgeOnPlays::fit(&recording).unwrap();
        let modelled = model.predict(&recording.input);
        let pairs = modelled.iter().zip(&recording.output);
        let largest = pairs.map(|(h, y)| (h - y).abs()).fold(0.0, f64::max);
        // Both radii are among those tried, so what is left is the least ridge.
        assert!(largest < 1e-4 * (high - low), "{largest}");
    }
}
