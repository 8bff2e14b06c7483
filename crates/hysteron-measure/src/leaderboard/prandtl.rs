//! The Prandtl-Ishlinskii model, a rival: a sum of plays with weights of zero and above.
//!
//! A play of half-width `r` follows the input at a distance of at most `r`,
//! `w ← max(x − r, min(x + r, w))`. It is the sum of MKP operators along a diagonal of the plane,
//! so the model is an MKP model whose weights depend on the width alone. *Two-sided*: the sum of
//! the plays goes through a monotone curve, made of dead zones on both sides (Kuhnen 2003,
//! *Modeling, identification and compensation of complex hysteretic nonlinearities*). This allows
//! loops that are not symmetric.

use hysteron::{Recording, range};

#[derive(Clone, Copy, PartialEq)]
pub enum Shape {
    Plain,
    TwoSided,
}

/// Steps between plays and curve. The last ones change the error by less than a thousandth.
const ROUNDS: usize = 30;

pub struct PrandtlIshlinskii {
    /// The lowest input fitted. There every play is at the end of its branch.
    low: f64,
    radii: Vec<f64>,
    weights: Vec<f64>,
    offset: f64,
    sign: f64,
    curve: Option<Curve>,
}

impl PrandtlIshlinskii {
    /// Least squares with `count` plays, in the better direction of the output.
    pub fn fit(recording: &Recording, shape: Shape, count: usize) -> Self {
        let up = Self::with_sign(recording, shape, count, 1.0);
        let down = Self::with_sign(recording, shape, count, -1.0);
        let squares = |model: &Self| squares(&model.predict(&recording.input), &recording.output);
        match squares(&up) <= squares(&down) {
            true => up,
            false => down,
        }
    }

    fn with_sign(recording: &Recording, shape: Shape, count: usize, sign: f64) -> Self {
        let (low, high) = range(&recording.input);
        let radius = |k: usize| 0.5 * (high - low) * k as f64 / count as f64;
        let mut model = Self {
            low,
            radii: (0..count).map(radius).collect(),
            weights: Vec::new(),
            offset: 0.0,
            sign,
            curve: None,
        };
        let plays = plays(&model.radii, low, &recording.input);
        let target: Vec<f64> = recording.output.iter().map(|y| sign * y).collect();
        (model.weights, model.offset) = with_offset(&plays, &target, &vec![1.0; target.len()]);
        if shape == Shape::TwoSided {
            model.bend(&plays, &target, count);
        }
        model
    }

    /// Finds the curve behind the plays and, in turn, the weights before it: its slope makes the
    /// problem of the weights linear (Gauss-Newton). Keeps the best of all rounds.
    fn bend(&mut self, plays: &[Vec<f64>], target: &[f64], count: usize) {
        let mut weights = self.weights.clone();
        let mut best = f64::INFINITY;
        for _ in 0..ROUNDS {
            let sum = weighted(plays, &weights, target.len());
            let curve = Curve::fit(&sum, target, count);
            let bent: Vec<f64> = sum.iter().map(|p| curve.at(*p)).collect();
            let error = squares(&bent, target);
            if error < best {
                best = error;
                (self.weights, self.offset) = (weights.clone(), 0.0);
                self.curve = Some(curve.clone());
            }
            let slopes: Vec<f64> = sum.iter().map(|p| curve.slope(*p)).collect();
            let steep: Vec<Vec<f64>> = plays
                .iter()
                .map(|play| play.iter().zip(&slopes).map(|(p, s)| p * s).collect())
                .collect();
            let linear = (0..target.len()).map(|n| target[n] - bent[n] + slopes[n] * sum[n]);
            weights = with_offset(&steep, &linear.collect::<Vec<_>>(), &slopes).0;
        }
    }

    pub fn predict(&self, input: &[f64]) -> Vec<f64> {
        let sum = weighted(
            &plays(&self.radii, self.low, input),
            &self.weights,
            input.len(),
        );
        let bent = |p: &f64| match &self.curve {
            Some(curve) => curve.at(*p),
            None => p + self.offset,
        };
        sum.iter().map(|p| self.sign * bent(p)).collect()
    }
}

/// The plays, one series for each radius. Before the input, all were at the end of the branch that
/// falls to `low`.
pub(super) fn plays(radii: &[f64], low: f64, input: &[f64]) -> Vec<Vec<f64>> {
    let play = |r: &f64| {
        let mut w = low + r;
        let step = |x: &f64| {
            w = (x - r).max(w.min(x + r));
            w
        };
        input.iter().map(step).collect()
    };
    radii.iter().map(play).collect()
}

/// A monotone, piecewise linear curve. It goes on beyond its ends.
#[derive(Clone)]
struct Curve {
    begin: f64,
    step: f64,
    offset: f64,
    slopes: Vec<f64>,
}

impl Curve {
    fn fit(from: &[f64], to: &[f64], pieces: usize) -> Self {
        let (low, high) = range(from);
        let step = ((high - low) / pieces as f64).max(f64::MIN_POSITIVE);
        let columns: Vec<Vec<f64>> = (0..pieces)
            .map(|k| {
                from.iter()
                    .map(|p| piece(*p, low, step, k, pieces))
                    .collect()
            })
            .collect();
        let (slopes, offset) = with_offset(&columns, to, &vec![1.0; to.len()]);
        Self {
            begin: low,
            step,
            offset,
            slopes,
        }
    }

    fn at(&self, p: f64) -> f64 {
        let pieces = self.slopes.len();
        let terms = self.slopes.iter().enumerate();
        let sum = terms.map(|(k, s)| s * piece(p, self.begin, self.step, k, pieces));
        self.offset + sum.sum::<f64>()
    }

    fn slope(&self, p: f64) -> f64 {
        let k = ((p - self.begin) / self.step).max(0.0) as usize;
        self.slopes[k.min(self.slopes.len() - 1)]
    }
}

/// How far `p` has come along piece `k`; the first and the last piece have no outer end.
fn piece(p: f64, begin: f64, step: f64, k: usize, pieces: usize) -> f64 {
    let along = p - begin - step * k as f64;
    let low = if k == 0 { f64::NEG_INFINITY } else { 0.0 };
    let high = if k + 1 == pieces { f64::INFINITY } else { step };
    along.clamp(low, high)
}

fn weighted(columns: &[Vec<f64>], weights: &[f64], length: usize) -> Vec<f64> {
    let mut sum = vec![0.0; length];
    for (column, weight) in columns.iter().zip(weights) {
        sum.iter_mut()
            .zip(column)
            .for_each(|(s, c)| *s += weight * c);
    }
    sum
}

fn squares(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Weights of zero and above, and the free factor of `one`. That factor is taken out before: what
/// is left of each column and of the target is at right angles to `one`.
fn with_offset(columns: &[Vec<f64>], target: &[f64], one: &[f64]) -> (Vec<f64>, f64) {
    let ones = dot(one, one).max(f64::MIN_POSITIVE);
    let rest = |series: &[f64]| -> Vec<f64> {
        let share = dot(series, one) / ones;
        series.iter().zip(one).map(|(s, o)| s - share * o).collect()
    };
    let centred: Vec<Vec<f64>> = columns.iter().map(|column| rest(column)).collect();
    let aim = rest(target);
    let gram: Vec<Vec<f64>> = centred
        .iter()
        .map(|a| centred.iter().map(|b| dot(a, b)).collect())
        .collect();
    let right: Vec<f64> = centred.iter().map(|a| dot(a, &aim)).collect();
    let weights = non_negative(&gram, &right);
    let modelled = weighted(columns, &weights, target.len());
    let left: Vec<f64> = target.iter().zip(&modelled).map(|(y, h)| y - h).collect();
    let offset = dot(&left, one) / ones;
    (weights, offset)
}

/// Non-negative least squares from the normal equations, by one coordinate after the other. It ends
/// when a sweep hardly changes the weights any more.
fn non_negative(gram: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; right.len()];
    for _ in 0..20_000 {
        let (mut moved, mut size) = (0.0_f64, 0.0_f64);
        for k in 0..weights.len() {
            if gram[k][k] <= 0.0 {
                continue;
            }
            let gradient = right[k] - dot(&gram[k], &weights);
            let new = (weights[k] + gradient / gram[k][k]).max(0.0);
            let scale = gram[k][k].sqrt();
            moved = moved.max(scale * (new - weights[k]).abs());
            size = size.max(scale * new);
            weights[k] = new;
        }
        if moved <= 1e-10 * size {
            break;
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use hysteron::{Model, Operator, Plane, Sign};

    /// Loops of falling amplitude from the lowest input.
    fn input() -> Vec<f64> {
        let amplitude = |n: f64| 5.0 * (1.0 - n / 2000.0);
        let samples = (0..1200).map(f64::from);
        samples
            .map(|n| 5.0 - amplitude(n) * (n * 0.05).cos())
            .collect()
    }

    fn error(shape: Shape, recording: &Recording) -> f64 {
        let model = PrandtlIshlinskii::fit(recording, shape, 20);
        let (low, high) = range(&recording.output);
        let squares = squares(&model.predict(&recording.input), &recording.output);
        (squares / recording.len() as f64).sqrt() / (high - low)
    }

    /// An MKP model whose weights depend on the width alone is a Prandtl-Ishlinskii model, in both
    /// directions of the output.
    #[test]
    fn it_is_the_model_with_weights_tied_along_the_diagonal() {
        let levels = 20;
        for sign in [Sign::Positive, Sign::Negative] {
            let plane = Plane::new(0.5, 10.0, levels).unwrap();
            let widths = |j: usize| (1..=j).map(move |i| 1.0 / (1 + j - i) as f64);
            let weights = (1..=levels).flat_map(widths).collect();
            let model = Model::new(Operator::Mkp, plane, weights, 2.0, sign).unwrap();
            let input = input();
            let output = model.simulate(&input).unwrap();
            let recording = Recording::new(input, output).unwrap();
            // The thresholds are the same, so only the end of the search is left.
            let error = error(Shape::Plain, &recording);
            assert!(error < 1e-4, "{error}");
        }
    }

    #[test]
    fn dead_zones_on_both_sides_follow_loops_that_are_not_symmetric() {
        let mut w = 1.0_f64;
        let input = input();
        let play = |x: &f64| {
            w = (x - 1.0).max(w.min(x + 1.0));
            (0.5 * w).exp()
        };
        let output = input.iter().map(play).collect();
        let recording = Recording::new(input, output).unwrap();
        let (plain, bent) = (
            error(Shape::Plain, &recording),
            error(Shape::TwoSided, &recording),
        );
        // Twenty straight pieces of an exponential curve are off by less than this.
        assert!(bent < 0.004 && bent < 0.1 * plain, "{bent} of {plain}");
    }
}
