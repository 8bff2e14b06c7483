//! The normal equations with a prior, from a sparse Gram matrix over Everett corners.

use crate::error::Result;
use crate::identify::weights::corner_gram::CornerGram;
use crate::identify::weights::gram::dot;
use crate::identify::weights::grid_factor::Factor;
use crate::identify::weights::nnls::Quadratic;
use crate::identify::weights::room::check_dense;
use crate::identify::weights::smoothness::Smoothness;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

/// Weights are held at zero by this multiple of the trace. The error that this leaves shrinks by
/// about the same factor in each step of conjugate gradients.
const HELD: f64 = 1e3;

/// Rows that are kept take at most so many bytes. Another row is computed where it is used.
const KEPT_BYTES: usize = 256 << 20;

/// Conjugate gradients end when the residual is this small relative to the right-hand side, or
/// after so many steps. Rounding ends them earlier.
const ENOUGH: f64 = 1e-14;
const STEPS: usize = 60;

/// Steps that may fail to reduce the residual before rounding is taken for the reason.
const PATIENCE: usize = 10;

/// A residual above this share of the right-hand side is no solution. The strongest penalties leave
/// one, because over corners they are worse conditioned than over weights.
const GOOD: f64 = 1e-10;

/// `Aᵀ A`, with the free columns eliminated, plus the prior.
pub(crate) struct CornerSystem {
    gram: Arc<CornerGram>,
    /// `Aᵀ z` of the free columns, and `(Zᵀ Z)⁻¹`.
    mixed: Vec<Vec<f64>>,
    inverse: Vec<Vec<f64>>,
    diagonal: Vec<f64>,
    smoothness: Smoothness,
    pub(crate) ridge: f64,
    /// The elements of Gram matrix and prior over corners, without the free columns.
    elements: OnceLock<Vec<f64>>,
    /// Rows that were computed, as many as [`KEPT_BYTES`] has room for.
    rows: Mutex<HashMap<usize, Arc<Vec<f64>>>>,
}

impl CornerSystem {
    pub(crate) fn new(gram: Arc<CornerGram>, mixed: Vec<Vec<f64>>, inverse: Vec<Vec<f64>>) -> Self {
        let mut diagonal = gram.diagonal().to_vec();
        for (a, left) in mixed.iter().enumerate() {
            for (b, right) in mixed.iter().enumerate() {
                let products = left.iter().zip(right);
                let products = diagonal.iter_mut().zip(products);
                products.for_each(|(d, (x, y))| *d -= inverse[a][b] * x * y);
            }
        }
        Self {
            gram,
            mixed,
            inverse,
            diagonal,
            smoothness: Smoothness::none(),
            ridge: 0.0,
            elements: OnceLock::new(),
            rows: Mutex::default(),
        }
    }

    /// The mean diagonal element.
    pub(crate) fn mean_diagonal(&self) -> f64 {
        self.diagonal.iter().sum::<f64>() / self.diagonal.len() as f64
    }

    /// With a prior.
    pub(crate) fn with(mut self, smoothness: Smoothness, ridge: f64) -> Self {
        let columns = &self.gram.layout.columns;
        smoothness.add_diagonal(&mut self.diagonal, columns);
        self.diagonal.iter_mut().for_each(|d| *d += ridge);
        (self.smoothness, self.ridge) = (smoothness, ridge);
        self
    }

    /// All elements over weights, row by row. Over corners the strongest penalties are worse
    /// conditioned than over weights, so a factor may fail there and exist here.
    pub(crate) fn dense(&self) -> Result<Vec<f64>> {
        let count = self.diagonal.len();
        check_dense(count)?;
        let mut matrix = self.gram.dense();
        eliminate(&mut matrix, &self.mixed, &self.inverse);
        self.smoothness
            .add_to(&mut matrix, &self.gram.layout.columns);
        (0..count).for_each(|n| matrix[n * count + n] += self.ridge);
        Ok(matrix)
    }

    /// The product with a vector of weights.
    pub(crate) fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut result = self.of_data(x);
        let slopes = self.smoothness.times(x, &self.gram.layout.columns);
        for ((r, slope), x) in result.iter_mut().zip(slopes).zip(x) {
            *r += slope + self.ridge * x;
        }
        result
    }

    /// The product without the prior.
    fn of_data(&self, x: &[f64]) -> Vec<f64> {
        let mut result = self.gram.times(x);
        let products: Vec<f64> = self.mixed.iter().map(|z| dot(z, x)).collect();
        for (row, z) in self.inverse.iter().zip(&self.mixed) {
            let value = dot(row, &products);
            result.iter_mut().zip(z).for_each(|(r, z)| *r -= value * z);
        }
        result
    }

    /// A row over weights.
    pub(crate) fn row(&self, n: usize) -> Arc<Vec<f64>> {
        let known = || Some(self.rows.lock().ok()?.get(&n)?.clone());
        known().unwrap_or_else(|| {
            let mut unit = vec![0.0; self.diagonal.len()];
            unit[n] = 1.0;
            let row = Arc::new(self.times(&unit));
            if let Ok(mut rows) = self.rows.lock()
                && (rows.len() + 1) * 8 * row.len() <= KEPT_BYTES
            {
                rows.insert(n, row.clone());
            }
            row
        })
    }

    fn over_corners(&self, with_gram: bool) -> Option<Vec<f64>> {
        let pattern = self.gram.pattern()?;
        let mut elements = match with_gram {
            true => self.gram.elements(pattern),
            false => vec![0.0; pattern.penalties[0].len()],
        };
        for (penalty, strength) in pattern.penalties.iter().zip(self.smoothness.strengths) {
            if strength > 0.0 {
                let all = elements.iter_mut().zip(penalty);
                all.for_each(|(e, p)| *e += strength * p);
            }
        }
        pattern.add_squares(&mut elements, |_| self.ridge);
        Some(elements)
    }

    /// Half the logarithms of the determinants of the prior alone, and of the whole matrix. The
    /// change from weights to corners has determinant 1.
    pub(crate) fn half_log_determinants(&self) -> Option<(f64, f64)> {
        let pattern = self.gram.pattern()?;
        let prior = pattern.factor(&self.over_corners(false)?)?;
        let everything = vec![true; self.diagonal.len()];
        let solver = Restricted::new(self, &everything)?;
        // |M| = |H| |ZᵀZ − Uᵀ H⁻¹ U| / |ZᵀZ|
        let free = solver.half_log_free?;
        Some((
            prior.half_log_determinant(),
            solver.factor.half_log_determinant() + free,
        ))
    }

    /// Whether the whole matrix has a factor over corners.
    pub(crate) fn can_factor(&self) -> bool {
        Restricted::new(self, &vec![true; self.diagonal.len()]).is_some()
    }

    /// The minimum of `½ xᵀ M x − bᵀ x` over the members alone, without sign constraint. `None`
    /// where rounding over corners is too large.
    pub(crate) fn free_minimum(&self, b: &[f64], members: &[usize]) -> Option<Vec<f64>> {
        let mut inside = vec![false; b.len()];
        members.iter().for_each(|n| inside[*n] = true);
        if members.is_empty() {
            return Some(Vec::new());
        }
        let solver = Restricted::new(self, &inside)?;
        let mut residual = solver.restricted(b.to_vec());
        let size = largest(&residual);
        let mut x = vec![0.0; b.len()];
        let mut best = (size, x.clone());
        let mut direction: Vec<f64> = Vec::new();
        let (mut before, mut patience) = (0.0, PATIENCE);
        for _ in 0..STEPS {
            if best.0 <= ENOUGH * size {
                break;
            }
            let conditioned = solver.apply(&residual)?;
            let product = dot(&conditioned, &residual);
            if direction.is_empty() {
                direction = conditioned;
            } else {
                let share = product / before;
                let all = direction.iter_mut().zip(&conditioned);
                all.for_each(|(d, c)| *d = c + share * *d);
            }
            before = product;
            let moved = solver.restricted(self.times(&direction));
            let curvature = dot(&direction, &moved);
            if curvature.is_nan() || curvature <= 0.0 {
                break;
            }
            let step = product / curvature;
            x.iter_mut()
                .zip(&direction)
                .for_each(|(x, d)| *x += step * d);
            residual
                .iter_mut()
                .zip(&moved)
                .for_each(|(r, m)| *r -= step * m);
            let left = largest(&residual);
            if left < best.0 {
                best = (left, x.clone());
                patience = PATIENCE;
            } else if patience == 0 {
                break;
            } else {
                patience -= 1;
            }
        }
        let found = || members.iter().map(|n| best.1[*n]).collect();
        (best.0 <= GOOD * size).then(found)
    }
}

impl Quadratic for CornerSystem {
    fn diagonal(&self, n: usize) -> f64 {
        self.diagonal[n]
    }

    /// Few weights are above zero, so few rows are needed.
    fn elements(&self, n: usize, columns: &[usize]) -> Vec<f64> {
        let row = self.row(n);
        columns.iter().map(|m| row[*m]).collect()
    }

    fn take_from(&self, gradient: &mut [f64], x: &[f64], _: &[usize]) {
        let moved = self.times(x);
        gradient.iter_mut().zip(moved).for_each(|(g, m)| *g -= m);
    }
}

/// The factor with all weights but some held at zero.
struct Restricted<'a> {
    system: &'a CornerSystem,
    factor: Factor<'a>,
    inside: Vec<bool>,
    /// The factor applied to the free columns, and the inverse of `ZᵀZ − Uᵀ H⁻¹ U`.
    solved: Vec<Vec<f64>>,
    middle: Option<Mat<f64>>,
    /// Half the logarithm of the determinant of that matrix, relative to that of `ZᵀZ`.
    half_log_free: Option<f64>,
}

impl<'a> Restricted<'a> {
    fn new(system: &'a CornerSystem, inside: &[bool]) -> Option<Self> {
        let pattern = system.gram.pattern()?;
        let elements = match system.elements.get() {
            Some(elements) => elements,
            None => {
                let found = system.over_corners(true)?;
                system.elements.get_or_init(|| found)
            }
        };
        let held = HELD * system.diagonal.iter().sum::<f64>();
        let mut elements = elements.clone();
        pattern.add_squares(&mut elements, |n| if inside[n] { 0.0 } else { held });
        let mut found = Self {
            system,
            factor: pattern.factor(&elements)?,
            inside: inside.to_vec(),
            solved: Vec::new(),
            middle: None,
            half_log_free: Some(0.0),
        };
        let mixed: Vec<Vec<f64>> = system
            .mixed
            .iter()
            .map(|z| found.restricted(z.clone()))
            .collect();
        found.solved = mixed
            .iter()
            .map(|z| found.with_factor(z))
            .collect::<Option<_>>()?;
        let count = mixed.len();
        if count == 0 {
            return Some(found);
        }
        let inverse = Mat::from_fn(count, count, |a, b| system.inverse[a][b]);
        let own = inverse.llt(Side::Lower).ok()?;
        let products = own.solve(&Mat::<f64>::identity(count, count));
        let middle = Mat::from_fn(count, count, |a, b| {
            products[(a, b)] - dot(&mixed[a], &found.solved[b])
        });
        // Where rounding leaves nothing of it, the factor alone is still a preconditioner.
        let middle = middle.llt(Side::Lower).ok();
        found.half_log_free = middle.as_ref().map(|middle| {
            let diagonal =
                |l: faer::MatRef<'_, f64>| (0..count).map(|n| l[(n, n)].ln()).sum::<f64>();
            diagonal(middle.L()) + diagonal(own.L())
        });
        found.middle = middle.map(|middle| middle.solve(&Mat::<f64>::identity(count, count)));
        Some(found)
    }

    /// The vector, with zeros outside.
    fn restricted(&self, mut x: Vec<f64>) -> Vec<f64> {
        let outside = x
            .iter_mut()
            .zip(&self.inside)
            .filter(|(_, inside)| !**inside);
        outside.for_each(|(x, _)| *x = 0.0);
        x
    }

    fn with_factor(&self, right: &[f64]) -> Option<Vec<f64>> {
        let layout = &self.system.gram.layout;
        let mut corners = layout.spread(right);
        self.factor.solve(&mut corners)?;
        Some(self.restricted(layout.weights(&corners)))
    }

    /// The factor applied to a vector, with the free columns eliminated (Woodbury).
    fn apply(&self, right: &[f64]) -> Option<Vec<f64>> {
        let mut x = self.with_factor(right)?;
        if let Some(middle) = &self.middle {
            let products: Vec<f64> = self.solved.iter().map(|z| dot(z, right)).collect();
            for (a, solved) in self.solved.iter().enumerate() {
                let value: f64 = products
                    .iter()
                    .enumerate()
                    .map(|(b, p)| middle[(a, b)] * p)
                    .sum();
                x.iter_mut().zip(solved).for_each(|(x, s)| *x += value * s);
            }
        }
        Some(x)
    }
}

/// Subtracts `Aᵀ Z (Zᵀ Z)⁻¹ Zᵀ A` from the Gram matrix, with `mixed` the `Aᵀ z`.
pub(crate) fn eliminate(gram: &mut [f64], mixed: &[Vec<f64>], inverse: &[Vec<f64>]) {
    for (a, left) in mixed.iter().enumerate() {
        for (b, right) in mixed.iter().enumerate() {
            let factor = inverse[a][b];
            for (row, x) in gram.chunks_exact_mut(right.len()).zip(left) {
                let scale = factor * x;
                row.iter_mut().zip(right).for_each(|(g, y)| *g -= scale * y);
            }
        }
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use crate::identify::options::{FitOptions, Prior};
    use crate::identify::weights::gram::Gram;
    use crate::identify::weights::nnls::Quadratic;
    use crate::identify::weights::problem::Problem;
    use crate::identify::weights::solve::{NormalEquations, Penalised};
    use crate::model::{Sign, Smooth, Solver, Start};
    use crate::progress::Progress;
    use crate::recording::Recording;
    use hysteron_core::Operator;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::sync::Arc;

    /// A walk with legs of any length, in some problems with noise on every sample.
    fn recording(rng: &mut ChaCha8Rng, load: bool) -> Recording {
        let samples = rng.random_range(30..1500);
        let noise = [0.0, 0.0, 0.02][rng.random_range(0..3)];
        let (mut x, mut to) = (rng.random_range(0.0..1.0), rng.random_range(0.0..1.0));
        let step = rng.random_range(0.002..0.2);
        let mut input: Vec<f64> = Vec::new();
        for _ in 0..samples {
            if f64::abs(to - x) < step {
                to = rng.random_range(0.0..1.0);
            }
            x += f64::clamp(to - x, -step, step);
            input.push(x + noise * rng.random_range(-1.0..1.0));
        }
        let mut y = 0.0;
        let output = input.iter().map(|x| {
            y = f64::clamp(y, x - 0.2, x + 0.1);
            y + 0.05 * rng.random_range(-1.0..1.0) + 3.0
        });
        let mut recording = Recording::new(input.clone(), output.collect()).unwrap();
        recording.load = load.then(|| (0..samples).map(|n| f64::from(n % 5)).collect());
        recording
    }

    fn options(rng: &mut ChaCha8Rng, round: usize) -> FitOptions {
        let strength = |rng: &mut ChaCha8Rng| match rng.random_range(0..4) {
            0 => 0.0,
            _ => 10_f64.powi(rng.random_range(-10..=3)),
        };
        FitOptions {
            operator: [Operator::Mkp, Operator::Kp, Operator::Relay][round % 3],
            levels: rng.random_range(24..30),
            offset: round.is_multiple_of(5).then_some(2.9),
            smooth: Smooth::from((strength(rng), strength(rng))),
            ridge: [1e-6, 1e-3, 1.0][rng.random_range(0..3)],
            start: [Start::Off, Start::On, Start::Unknown][rng.random_range(0..3)],
            sign: Some(Sign::Positive),
            load_degree: Some(1),
            ..FitOptions::plain()
        }
    }

    /// The largest breach of the Karush-Kuhn-Tucker conditions of the dense problem, as a multiple
    /// of what is allowed: a billionth of the right-hand side, or a thousand times the rounding of
    /// the products, whose parts are far larger where the penalty is strong.
    fn breach(dense: &Penalised, b: &[f64], x: &[f64], solver: Solver) -> f64 {
        let size = b.iter().fold(0.0_f64, |size, b| size.max(b.abs()));
        let moved = dense.times(x);
        let parts = |row: &[f64]| row.iter().zip(x).map(|(m, x)| (m * x).abs()).sum::<f64>();
        let parts = dense.elements().unwrap().chunks(b.len()).map(parts);
        let each = b.iter().zip(moved).zip(x).zip(parts);
        let each = each.map(|(((b, m), x), parts)| {
            let breach = match solver {
                Solver::Ols => (b - m).abs(),
                Solver::Nnls => {
                    assert!(*x >= 0.0);
                    if *x > 0.0 {
                        (b - m).abs()
                    } else {
                        (b - m).max(0.0)
                    }
                }
            };
            breach / (1e-9 * size + 1e-13 * parts)
        });
        each.fold(0.0, f64::max)
    }

    /// The sparse form against the dense one: the same matrix, the same determinants, and at its
    /// solution the conditions of the dense problem's minimum, which is unique.
    #[test]
    fn the_sparse_form_finds_the_minimum_of_the_dense_problem() {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let (mut sparse_problems, mut within, mut solved) = (0, 0, 0);
        for round in 0..40 {
            let load = round % 7 == 0;
            let recordings = [recording(&mut rng, load)];
            let options = options(&mut rng, round);
            let Ok(problem) = Problem::new(&recordings, &options) else {
                continue;
            };
            let (regressor, experiment) = (&problem.regressor, &problem.experiment);
            let group = |_| Some(0);
            let mut found = regressor
                .corner_grams(experiment, 1, group, Progress::NONE)
                .unwrap();
            let Some(gram) = found.take().and_then(|mut all| all.pop()) else {
                continue;
            };
            sparse_problems += 1;
            let plain = regressor
                .grams(experiment, 1, group, Progress::NONE)
                .unwrap();
            let largest = plain[0].iter().fold(0.0_f64, |most, g| most.max(g.abs()));
            for (a, b) in gram.dense().iter().zip(&plain[0]) {
                // Sums of some thousand products, in another order.
                assert!(
                    (a - b).abs() <= 1e-11 * largest,
                    "round {round}: {a} for {b}"
                );
            }
            let free = problem.free(None).unwrap();
            let of = |gram: Gram| {
                let prior = Prior { ..options.prior() };
                NormalEquations::of_gram(regressor, experiment, &free, None, prior, gram).unwrap()
            };
            let dense = of(Gram::Dense(plain[0].clone()));
            let sparse = of(Gram::Corners(Arc::new(gram)));
            // The strongest penalties are not definite in floating point, in either form.
            let [whole, corners] =
                [&dense, &sparse].map(|own| own.penalised.half_log_determinants(regressor));
            if let Ok((p, m)) = whole {
                let (q, n) = corners.unwrap();
                // Rounding of the factors. A difference of 1 is the least that matters.
                assert!(
                    (p - q).abs() < 1e-3,
                    "round {round}: {p} for {q} with {options:?}"
                );
                assert!(
                    (m - n).abs() < 1e-3,
                    "round {round}: {m} for {n} with {options:?}"
                );
            }
            let (b, _) = dense.right(problem.targets(Sign::Positive)).unwrap();
            for solver in [Solver::Nnls, Solver::Ols] {
                let factor = sparse.penalised.factor(solver).unwrap();
                let start = match rng.random_range(0..2) {
                    0 => vec![0.0; b.len()],
                    _ => b.iter().map(|_| rng.random_range(0.0..1.0)).collect(),
                };
                let own = &sparse.penalised;
                let x = own
                    .minimum(&b, &start, factor.as_ref(), Progress::NONE)
                    .unwrap();
                let own_breach = breach(&dense.penalised, &b, &x, solver);
                // With the strongest penalties rounding stops the dense way too.
                let factor = dense.penalised.factor(solver).unwrap_or_default();
                let other = &dense.penalised;
                let x = other
                    .minimum(&b, &start, factor.as_ref(), Progress::NONE)
                    .unwrap();
                let other = breach(&dense.penalised, &b, &x, solver);
                assert!(
                    own_breach <= other.max(1.0),
                    "round {round}, {solver:?}: {own_breach}, dense {other}, with {options:?}"
                );
                within += usize::from(own_breach < 1.0);
                solved += 1;
            }
            for n in [0, b.len() / 2, b.len() - 1] {
                let rows = [&dense, &sparse].map(|own| own.penalised.row_of(n));
                let largest = rows[0].iter().fold(0.0_f64, |most, g| most.max(g.abs()));
                let close = rows[0].iter().zip(&rows[1]);
                assert!(
                    close
                        .into_iter()
                        .all(|(a, b)| (a - b).abs() <= 1e-10 * largest)
                );
            }
        }
        assert!(
            10 * within >= 9 * solved,
            "{within} of {solved} solutions meet the conditions"
        );
        assert!(
            sparse_problems > 30,
            "{sparse_problems} of 40 problems had a sparse form"
        );
    }

    #[test]
    fn the_diagonal_is_that_of_the_rows() {
        let mut rng = ChaCha8Rng::seed_from_u64(12);
        let recordings = [recording(&mut rng, false)];
        let options = FitOptions {
            smooth: Smooth::from((1e-6, 1e-8)),
            start: Start::Unknown,
            ..options(&mut rng, 1)
        };
        let problem = Problem::new(&recordings, &options).unwrap();
        let (regressor, experiment) = (&problem.regressor, &problem.experiment);
        let mut found = regressor
            .corner_grams(experiment, 1, |_| Some(0), Progress::NONE)
            .unwrap();
        let gram = found.take().and_then(|mut all| all.pop()).unwrap();
        let free = problem
            .free(None)
            .unwrap()
            .mixed(regressor, experiment)
            .unwrap();
        let system = super::CornerSystem::new(Arc::new(gram), free.columns, free.inverse);
        let smoothness =
            super::Smoothness::new(problem.regressor.plane().levels(), options.smooth, 100.0);
        let system = system.with(smoothness, 1e-3);
        for n in (0..regressor.columns().len()).step_by(7) {
            let (a, b) = (system.diagonal(n), system.row(n)[n]);
            // Differences of sums over all samples.
            assert!(
                (a - b).abs() <= 1e-10 * b.abs().max(100.0),
                "{n}: {a} for {b}"
            );
        }
    }
}
