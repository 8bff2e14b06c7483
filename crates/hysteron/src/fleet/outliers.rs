//! Which actuators are unlike the others: robust distances of their main numbers.

use super::row::FleetRow;
use crate::error::{Error, Result};
use crate::series::noise::median;

/// Names of the numbers that are compared.
const NAMES: [&str; COUNT] = ["stroke", "width", "slope", "position", "error"];
const COUNT: usize = 5;
/// Those that are along the input.
const ON_GRID: [usize; 2] = [1, 3];

/// So far, in distances of the levels, a fit moves width and position of a loop by itself: 40 equal
/// loops of 220 readings had widths that differed by 0.1 of them (root mean square), and by 0.4 at
/// most.
const OF_STEP: f64 = 0.15;

/// What most actuators of a fleet have in common: centre and spread of stroke, width, slope and
/// position of their loops, and of the decimal logarithm of the error in percent.
///
/// Centre and covariance are those of the three quarters of the actuators that lie closest together
/// (minimum covariance determinant, Rousseeuw and Van Driessen 1999; from a fixed beginning, so
/// that the result is always the same), reweighted once. So outliers do not hide each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Norm {
    /// Median and robust deviation of each number.
    scales: [(f64, f64); COUNT],
    /// The numbers that differ among the actuators.
    used: Vec<usize>,
    /// The deviation of each number that the grid of the models makes.
    of_grid: [f64; COUNT],
    centre: Vec<f64>,
    /// Lower triangle of the Cholesky factor of the covariance, row by row.
    factor: Vec<f64>,
}

/// How far an actuator is from the norm of its fleet.
#[derive(Debug, Clone, PartialEq)]
pub struct Strangeness {
    /// Robust (Mahalanobis) distance.
    pub distance: f64,
    /// Distance that one of a thousand actuators exceeds, if they are normally distributed.
    pub limit: f64,
    /// Each number by itself: its name, and its distance from the median in robust deviations.
    pub deviations: [(&'static str, f64); COUNT],
}

impl Strangeness {
    /// Whether the actuator is unlike the others.
    #[must_use]
    pub fn is_outlier(&self) -> bool {
        self.distance.is_nan() || self.distance > self.limit
    }

    /// The number that is furthest from its median.
    #[must_use]
    pub fn most(&self) -> (&'static str, f64) {
        let by = |a: &&(&str, f64), b: &&(&str, f64)| a.1.abs().total_cmp(&b.1.abs());
        let most = self.deviations.iter().max_by(by);
        most.copied().unwrap_or((NAMES[0], 0.0))
    }
}

/// The numbers of an actuator.
fn numbers(row: &FleetRow) -> [f64; COUNT] {
    /// Errors below this are none, in percent.
    const NO_ERROR: f64 = 1e-6;
    let shape = &row.shape;
    let known = |number: Option<f64>| number.unwrap_or(f64::NAN);
    let error = row.model.fit.as_ref().map(|fit| fit.nrmse_percent);
    [
        shape.stroke,
        known(shape.width),
        known(shape.slope),
        known(shape.position),
        known(error.map(|error| error.max(NO_ERROR).log10())),
    ]
}

impl Norm {
    /// The fewest actuators that tell what is usual.
    pub const FEWEST: usize = 20;

    /// The norm of these actuators.
    ///
    /// # Errors
    /// [`Error::Fit`] for fewer than [`Norm::FEWEST`] whose loops can be described.
    pub fn from_rows<'a>(rows: impl IntoIterator<Item = &'a FleetRow>) -> Result<Self> {
        let (mut found, mut steps) = (Vec::new(), Vec::new());
        for row in rows {
            steps.push(row.model.plane().step());
            found.push(numbers(row));
        }
        found.retain(|row| row.iter().all(|n| n.is_finite()));
        Self::of_numbers(found, OF_STEP * median(&mut steps))
    }

    /// The norm of these numbers, where the grid moves widths and positions by `of_grid`.
    fn of_numbers(rows: Vec<[f64; COUNT]>, of_grid: f64) -> Result<Self> {
        if rows.len() < Self::FEWEST {
            return Err(Error::Fit(format!(
                "{} actuators do not tell what is usual: {} or more are needed",
                rows.len(),
                Self::FEWEST
            )));
        }
        let scales: Vec<(f64, f64)> = (0..COUNT)
            .map(|n| scale(rows.iter().map(|row| row[n]).collect()))
            .collect();
        let scales: [(f64, f64); COUNT] = std::array::from_fn(|n| scales[n]);
        let used: Vec<usize> = (0..COUNT).filter(|n| scales[*n].1 > 0.0).collect();
        let mut norm = Self {
            scales,
            centre: vec![0.0; used.len()],
            factor: identity(used.len()),
            of_grid: std::array::from_fn(|n| match ON_GRID.contains(&n) {
                true => of_grid,
                false => 0.0,
            }),
            used,
        };
        let points: Vec<Vec<f64>> = rows.iter().map(|row| norm.standard(row)).collect();
        let share = points.len() * 3 / 4;
        let mut chosen: Vec<usize> = Vec::new();
        // Each step makes the determinant smaller, so this ends by itself.
        for _ in 0..100 {
            let distances: Vec<f64> = points.iter().map(|point| norm.square(point)).collect();
            let mut order: Vec<usize> = (0..points.len()).collect();
            order.sort_by(|a, b| distances[*a].total_cmp(&distances[*b]));
            order.truncate(share);
            order.sort_unstable();
            if order == chosen {
                break;
            }
            chosen = order;
            norm.fit(chosen.iter().map(|n| &points[*n]).collect());
        }
        norm.calibrate(&points);
        let within = points.iter();
        let within = within.filter(|point| norm.square(point) <= norm.quantile(&WITHIN));
        norm.fit(within.collect());
        norm.calibrate(&points);
        Ok(norm)
    }

    /// How far an actuator is from this norm.
    #[must_use]
    pub fn strangeness(&self, row: &FleetRow) -> Strangeness {
        let row = numbers(row);
        let deviation = |n: usize| {
            let (median, scale) = self.scales[n];
            match row[n] - median {
                0.0 => 0.0,
                off => off / scale.hypot(self.of_grid[n]),
            }
        };
        // A number that all others share may not differ at all.
        let shared = (0..COUNT).filter(|n| !self.used.contains(n));
        let beyond = |n: usize| match self.of_grid[n] > 0.0 {
            true => deviation(n).abs() > 1.0,
            false => deviation(n) != 0.0,
        };
        let breaks = shared.into_iter().any(beyond);
        Strangeness {
            distance: match breaks {
                true => f64::INFINITY,
                false => self.square(&self.standard(&row)).sqrt(),
            },
            limit: self.quantile(&RARE).sqrt(),
            deviations: std::array::from_fn(|n| (NAMES[n], deviation(n))),
        }
    }

    fn standard(&self, row: &[f64; COUNT]) -> Vec<f64> {
        let used = self.used.iter();
        used.map(|&n| (row[n] - self.scales[n].0) / self.scales[n].1)
            .collect()
    }

    /// Squared distance of a standardised point.
    fn square(&self, point: &[f64]) -> f64 {
        let count = self.centre.len();
        let mut solved: Vec<f64> = Vec::with_capacity(count);
        for n in 0..count {
            let row = &self.factor[n * count..];
            let known: f64 = solved.iter().zip(row).map(|(x, l)| x * l).sum();
            solved.push((point[n] - self.centre[n] - known) / row[n]);
        }
        solved.iter().map(|x| x * x).sum()
    }

    /// Mean and covariance of these points.
    fn fit(&mut self, points: Vec<&Vec<f64>>) {
        /// Share of the variance that no direction falls below: points on a line have a distance
        /// too.
        const LEAST: f64 = 1e-9;
        let count = self.centre.len();
        let share = 1.0 / points.len().max(1) as f64;
        for n in 0..count {
            self.centre[n] = share * points.iter().map(|point| point[n]).sum::<f64>();
        }
        let mut covariance = vec![0.0; count * count];
        for point in points {
            for i in 0..count {
                for j in 0..=i {
                    covariance[i * count + j] +=
                        share * (point[i] - self.centre[i]) * (point[j] - self.centre[j]);
                }
            }
        }
        for n in 0..count {
            let used = self.used[n];
            covariance[n * count + n] += LEAST + (self.of_grid[used] / self.scales[used].1).powi(2);
        }
        self.factor = cholesky(covariance, count);
    }

    /// Scales the covariance so that half of the points are as near as normal ones would be.
    fn calibrate(&mut self, points: &[Vec<f64>]) {
        let mut squares: Vec<f64> = points.iter().map(|point| self.square(point)).collect();
        let found = median(&mut squares);
        if found > 0.0 && !self.used.is_empty() {
            // Where the grid's part is the larger one, the points are nearer than that, and scaling
            // would take it away again.
            let factor = (found / self.quantile(&HALF)).sqrt();
            let factor = match self.of_grid.iter().any(|grid| *grid > 0.0) {
                true => factor.max(1.0),
                false => factor,
            };
            self.factor.iter_mut().for_each(|l| *l *= factor);
        }
    }

    fn quantile(&self, of: &[f64; COUNT]) -> f64 {
        of[self.used.len().clamp(1, COUNT) - 1]
    }
}

/// Quantiles of the χ² distribution with 1 to 5 degrees of freedom: 50 %, 97.5 % and 99.9 %.
const HALF: [f64; COUNT] = [0.4549, 1.3863, 2.3660, 3.3567, 4.3515];
const WITHIN: [f64; COUNT] = [5.0239, 7.3778, 9.3484, 11.1433, 12.8325];
const RARE: [f64; COUNT] = [10.8276, 13.8155, 16.2662, 18.4668, 20.5150];

/// Median and robust deviation. Where more than half of the values are equal, the deviation is that
/// of all; 0 if all are equal up to rounding.
fn scale(mut values: Vec<f64>) -> (f64, f64) {
    /// Ratio of the standard deviation to the median absolute deviation of normal values.
    const NORMAL: f64 = 1.4826;
    let middle = median(&mut values);
    let mut off: Vec<f64> = values.iter().map(|value| (value - middle).abs()).collect();
    let rounding = 1e-12 * middle.abs();
    let robust = NORMAL * median(&mut off);
    if robust > rounding {
        return (middle, robust);
    }
    let squares = off.iter().map(|off| off * off).sum::<f64>() / off.len() as f64;
    match squares.sqrt() {
        deviation if deviation > rounding => (middle, deviation),
        _ => (middle, 0.0),
    }
}

fn identity(count: usize) -> Vec<f64> {
    let mut matrix = vec![0.0; count * count];
    for n in 0..count {
        matrix[n * count + n] = 1.0;
    }
    matrix
}

/// The Cholesky factor of a matrix of which the lower triangle is given.
fn cholesky(mut matrix: Vec<f64>, count: usize) -> Vec<f64> {
    for i in 0..count {
        for j in 0..=i {
            let known: f64 = (0..j)
                .map(|k| matrix[i * count + k] * matrix[j * count + k])
                .sum();
            let left = matrix[i * count + j] - known;
            matrix[i * count + j] = match i == j {
                true => left.max(f64::MIN_POSITIVE).sqrt(),
                false => left / matrix[j * count + j],
            };
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Correlated normal numbers, of different sizes.
    fn fleet(rng: &mut ChaCha8Rng, count: usize) -> Vec<[f64; COUNT]> {
        let mut normal = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
        let mut row = || {
            let z: [f64; COUNT] = std::array::from_fn(|_| normal());
            [
                10.0 + 0.1 * z[0],
                20.0 + z[1],
                0.5 + 0.01 * (z[0] + 0.1 * z[2]),
                60.0 + 2.0 * z[3] - z[1],
                -0.3 + 0.2 * z[4],
            ]
        };
        (0..count).map(|_| row()).collect()
    }

    fn distance(norm: &Norm, row: &[f64; COUNT]) -> f64 {
        norm.square(&norm.standard(row)).sqrt()
    }

    /// Up to a fifth of actuators that are wrong together, in whatever direction, are found, and
    /// few others are.
    #[test]
    fn outliers_do_not_hide_each_other() {
        for seed in 0..40 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut rows = fleet(&mut rng, 400);
            let wrong = rng.random_range(0..80);
            let way: [f64; COUNT] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
            let size = [0.1, 1.0, 0.01, 2.0, 0.2];
            let length = way.iter().map(|w| w * w).sum::<f64>().sqrt();
            for row in rows.iter_mut().take(wrong) {
                for n in 0..COUNT {
                    row[n] += 15.0 * way[n] / length * size[n];
                }
            }
            let norm = Norm::of_numbers(rows.clone(), 0.0).unwrap();
            let limit = norm.quantile(&RARE).sqrt();
            let found = |rows: &[[f64; COUNT]]| {
                rows.iter()
                    .filter(|row| distance(&norm, row) > limit)
                    .count()
            };
            assert_eq!(found(&rows[..wrong]), wrong, "seed {seed}");
            let false_alarms = found(&rows[wrong..]);
            // One of a thousand is expected; the estimate of the spread adds to that.
            assert!(false_alarms <= 8, "seed {seed}: {false_alarms}");
        }
    }

    /// Units do not matter, nor does the order.
    #[test]
    fn distances_do_not_depend_on_units() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let rows = fleet(&mut rng, 100);
        let norm = Norm::of_numbers(rows.clone(), 0.0).unwrap();
        let factors = [1e-3, 1e6, -2.0, 0.5, 1.0];
        let change = |row: &[f64; COUNT]| std::array::from_fn(|n| factors[n] * row[n] + 3.0);
        let changed: Vec<[f64; COUNT]> = rows.iter().rev().map(change).collect();
        let other = Norm::of_numbers(changed, 0.0).unwrap();
        for row in &rows {
            let (a, b) = (distance(&norm, row), distance(&other, &change(row)));
            assert!((a - b).abs() < 1e-6 * (1.0 + a), "{a} {b}");
        }
    }

    /// Widths that only the grid tells apart are alike; a position far beyond it is not.
    #[test]
    fn what_the_grid_does_is_not_unusual() {
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        let mut rows = fleet(&mut rng, 60);
        for (n, row) in rows.iter_mut().enumerate() {
            row[1] = 15.4 + 0.02 * (n as f64).sin();
        }
        rows[7][1] = 17.4;
        rows[8][3] = 90.0;
        let far = |of_grid: f64| {
            let norm = Norm::of_numbers(rows.clone(), of_grid).unwrap();
            let limit = norm.quantile(&RARE).sqrt();
            let is_far = |n: &usize| distance(&norm, &rows[*n]) > limit;
            [7, 8].into_iter().filter(is_far).collect::<Vec<_>>()
        };
        assert_eq!(far(0.0), [7, 8]);
        assert_eq!(far(0.7), [8]);
    }

    #[test]
    fn a_number_that_all_share_is_not_compared() {
        let mut rng = ChaCha8Rng::seed_from_u64(8);
        let mut rows = fleet(&mut rng, 60);
        rows.iter_mut().for_each(|row| row[3] = 42.0);
        let norm = Norm::of_numbers(rows.clone(), 0.0).unwrap();
        assert!(rows.iter().all(|row| distance(&norm, row) < 6.0));
        assert!(Norm::of_numbers(rows[..19].to_vec(), 0.0).is_err());
    }
}
