//! Recursive least squares against its formulas with whole matrices.

use crate::common::{
    Learner, OPERATORS, build, dense, inputs, options, plane, rng, start_covariance, strokes,
    unit_plane,
};
use hysteron_core::{Adaptation, Method, Operator, Outcome, operator_count, operators};
use rand::RngExt;

/// The estimate and its covariance.
struct Textbook {
    theta: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    start: Vec<Vec<f64>>,
}

impl Textbook {
    fn learn(&mut self, phi: &[f64], measured: f64, forgetting: f64, noise: f64) {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let gain: Vec<f64> = self.covariance.iter().map(|row| dot(row, phi)).collect();
        let total = noise * noise + dot(phi, &gain);
        let error = measured - dot(phi, &self.theta);
        for (a, row) in self.covariance.iter_mut().enumerate() {
            self.theta[a] += gain[a] * error / total;
            for (b, p) in row.iter_mut().enumerate() {
                let learned = *p - gain[a] * gain[b] / total;
                *p = forgetting * learned + (1.0 - forgetting) * self.start[a][b];
            }
        }
    }

    /// Leads one negative weight in four back to zero, the farthest first.
    fn project(&mut self) {
        let weights = self.theta.len() - 1;
        for _ in 0..weights / 4 + 1 {
            let far = |k: &usize| self.theta[*k].powi(2) / self.covariance[*k][*k];
            let negative = (0..weights).filter(|k| self.theta[*k] < 0.0);
            let Some(k) = negative.max_by(|a, b| far(a).total_cmp(&far(b))) else {
                break;
            };
            let step = self.theta[k] / self.covariance[k][k];
            for (theta, row) in self.theta.iter_mut().zip(&self.covariance) {
                *theta -= step * row[k];
            }
            self.theta[k] = 0.0;
        }
    }
}

#[test]
fn every_sample_is_learned_by_the_textbook() {
    let (mut at_zero, mut without_operators, mut worst) = (0, 0, 0.0_f64);
    for seed in 0..120 {
        let mut rng = rng(4000 + seed);
        let operator = OPERATORS[seed as usize % 3];
        let k = rng.random_range(2..6);
        let plane = plane(&mut rng, k);
        let n = operator_count(k);
        // No two weights are alike, so that no two are equally far from zero.
        let offline: Vec<f64> = (0..n).map(|_| rng.random()).collect();
        let forgetting = [1.0, 0.99, 0.9][rng.random_range(0..3)];
        let (noise, spread) = (0.1, 0.5);
        let correlation = [0.0, 2.0][rng.random_range(0..2)];
        let share = [0.0, 1.0, 3.0][rng.random_range(0..3)];
        let guards = Adaptation {
            offset_share: share,
            trial: u32::MAX,
            gate: 0.0,
            ..options(Method::LeastSquares {
                forgetting,
                noise,
                spread,
                correlation,
            })
        };
        let mut learner = Learner::new(plane, operator, &offline, guards);
        let start = start_covariance(k, spread, correlation);
        let mut textbook = Textbook {
            theta: offline.into_iter().chain([0.0]).collect(),
            covariance: start.clone(),
            start,
        };
        for input in inputs(&mut rng, &plane, 400) {
            let measured = rng.random_range(-2.0..3.0);
            if learner.step(input, measured).unwrap().outcome != Outcome::Learned {
                continue;
            }
            let state = |(i, j)| operator.output(learner.state.gamma(i, j).unwrap());
            let phi: Vec<f64> = operators(k).map(state).chain([share]).collect();
            without_operators += usize::from(phi.iter().all(|phi| *phi == 0.0));
            textbook.learn(&phi, measured, forgetting, noise);
            textbook.project();
            let found = learner.estimator.parameters();
            for (found, theta) in found.iter().zip(&textbook.theta) {
                worst = worst.max((found - theta.max(0.0)).abs());
            }
            at_zero += found.iter().filter(|weight| **weight == 0.0).count();
            worst = worst.max((learner.estimator.offset() - share * textbook.theta[n]).abs());
            // Rounding of numbers of about 1, times the condition of the covariance, up to 1e3, and
            // samples.
            assert!(worst < 1e-8, "{seed}: {worst:e}");
        }
    }
    println!("least squares against the textbook: largest difference {worst:.1e}");
    assert!(
        at_zero > 10_000 && without_operators > 100,
        "{at_zero} {without_operators}"
    );
}

/// Rounding makes the covariance indefinite where noisy readings are taken as exact. A restart
/// keeps the estimate from running away.
#[test]
fn readings_taken_as_exact_do_not_break_the_covariance() {
    for seed in 0..60 {
        let mut rng = rng(4200 + seed);
        let k = 2 + seed as usize % 4;
        let plane = unit_plane(k);
        let (plant, mut there) = build(plane, Operator::Mkp, &dense(&mut rng, k));
        let spread = [1.0, 1e3, 1e6][rng.random_range(0..3)];
        let guards = Adaptation {
            trial: u32::MAX,
            gate: 0.0,
            ..options(Method::LeastSquares {
                forgetting: 1.0,
                noise: [1e-3, 1e-6, 1e-12][rng.random_range(0..3)],
                spread,
                correlation: [0.0, 2.0][rng.random_range(0..2)],
            })
        };
        let mut learner = Learner::new(plane, Operator::Mkp, &vec![0.5; operator_count(k)], guards);
        for input in strokes(&mut rng, &plane, 4000, 20) {
            let clean = plant.step(&mut there, input).unwrap().output;
            let measured = clean + rng.random_range(-0.1..0.1);
            let learning = learner.step(input, measured).unwrap();
            // With variances of a thousand rounding errors the estimate is of no use. But it does not
            // run away: without a restart it goes to 1e70.
            let off = (learning.output - clean).abs();
            assert!(off < 1e20, "{seed}: {off:e}, {:?}", guards.method);
        }
    }
}

/// A reading from which no step can be computed.
#[test]
fn a_reading_of_any_size_does_not_undo_what_was_learned() {
    let k = 4;
    let mut rng = rng(4300);
    let plane = unit_plane(k);
    let (plant, mut there) = build(plane, Operator::Mkp, &dense(&mut rng, k));
    let guards = Adaptation {
        trial: u32::MAX,
        gate: 0.0,
        ..options(Method::LeastSquares {
            forgetting: 1.0,
            noise: 0.01,
            spread: 0.5,
            correlation: 0.0,
        })
    };
    let mut learner = Learner::new(plane, Operator::Mkp, &vec![0.5; operator_count(k)], guards);
    for input in strokes(&mut rng, &plane, 2000, 20) {
        let measured = plant.step(&mut there, input).unwrap().output;
        learner.step(input, measured).unwrap();
    }
    let learned = learner.estimator.parameters().to_vec();
    for (input, measured) in [(40.0, f64::MAX), (60.0, -f64::MAX)] {
        learner.step(input, measured).unwrap();
        assert_eq!(learner.estimator.parameters(), learned);
    }
}
