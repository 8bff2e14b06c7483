//! The gate of an estimator judges errors as the documentation of its options says.

use crate::common::{Learner, options, rng, unit_plane};
use hysteron_core::{Adaptation, Method, Operator, Outcome};
use rand::RngExt;
use rand::rngs::StdRng;

/// These hardly move a parameter, so that the error of a reading is what a test wants it to be.
const STILL: [Method<f64>; 2] = [
    Method::Increments {
        gain: f64::MIN_POSITIVE,
        span: 1.0,
    },
    Method::LeastSquares {
        forgetting: 1.0,
        noise: 1.0,
        spread: 1e-100,
        correlation: 0.0,
    },
];

/// A learner that judges readings and learns nothing. The range of its output is 1.
struct Judge {
    learner: Learner,
    samples: usize,
}

impl Judge {
    fn new(method: Method<f64>, gate: f64, burst: u32) -> Self {
        let guards = Adaptation {
            gate,
            burst,
            trial: u32::MAX,
            ..options(method)
        };
        let weights = [0.25, 0.25, 0.5];
        Self {
            learner: Learner::new(unit_plane(2), Operator::Mkp, &weights, guards),
            samples: 0,
        }
    }

    /// Whether it refuses a reading with this error. The input moves.
    fn refuses(&mut self, error: f64) -> bool {
        // Where the output depends little on the input: a watch has nothing to say of it.
        let input = [-28.0, 8.0][self.samples % 2];
        self.samples += 1;
        let (model, mut there) = (&self.learner.model, self.learner.state.clone());
        let output = model.step(&mut there, input).unwrap().output;
        let learning = self.learner.step(input, output + error).unwrap();
        assert_ne!(learning.outcome, Outcome::AtRest);
        learning.outcome == Outcome::Rejected
    }
}

/// The gate as documented, for a model with the range 1.
struct Documented {
    usual: f64,
    left: f64,
    refused: Vec<f64>,
}

impl Documented {
    fn refuses(&mut self, error: f64, gate: f64, burst: usize) -> bool {
        let surprise = error - self.left;
        if surprise.abs() <= gate * self.usual {
            self.usual += (surprise.abs() - self.usual) / 64.0;
        } else {
            self.refused.push(surprise);
            let agree =
                |two: &[f64]| (two[0] - two[1]).abs() <= 0.5 * two[0].abs().max(two[1].abs());
            let last = self.refused.iter().rev().take(burst).copied();
            let last: Vec<f64> = last.collect();
            if last.len() < burst || !last.windows(2).all(agree) {
                if self.refused.len() % burst == 0 {
                    self.usual *= 2.0;
                }
                return true;
            }
            self.usual = surprise.abs();
        }
        self.usual = self.usual.max(1e-3);
        self.refused.clear();
        self.left = error;
        false
    }
}

/// Errors that stay, change a little, change their sign, or are of any size.
fn errors(rng: &mut StdRng, count: usize) -> Vec<f64> {
    let mut errors = Vec::new();
    let mut base = 0.0;
    while errors.len() < count {
        if rng.random_bool(0.3) {
            base = 10f64.powf(rng.random_range(-4.0..4.0)) * [1.0, -1.0][rng.random_range(0..2)];
        }
        let kind = rng.random_range(0..5);
        for n in 0..[1, 5, 30, 300][rng.random_range(0..4)] {
            errors.push(match kind {
                0 => base,
                1 => base * rng.random_range(0.6..1.6),
                2 => base * [1.0, -1.0][n % 2],
                3 => base * [1.0, 3.0][n % 2],
                _ => base + 1e-3 * rng.random_range(-1.0..1.0),
            });
        }
    }
    errors
}

#[test]
fn readings_are_refused_and_accepted_as_documented() {
    let (mut refused, mut count) = (0, 0);
    for seed in 0..300 {
        let mut rng = rng(seed);
        let method = STILL[seed as usize % 2];
        let gate = [2.0, 12.0, 50.0][rng.random_range(0..3)];
        let burst = [1, 2, 3, 8, 20][rng.random_range(0..5)];
        let mut judge = Judge::new(method, gate, burst);
        let mut documented = Documented {
            usual: 0.02,
            left: 0.0,
            refused: Vec::new(),
        };
        for (n, error) in errors(&mut rng, 1000).into_iter().enumerate() {
            let expected = documented.refuses(error, gate, burst as usize);
            assert_eq!(judge.refuses(error), expected, "{seed}, {n}: {error}");
            refused += usize::from(expected);
            count += 1;
        }
    }
    // Both are common.
    assert!(
        refused > count / 20 && refused < count / 2,
        "{refused} of {count}"
    );
}

#[test]
fn an_error_made_again_and_again_is_no_surprise() {
    for method in STILL {
        for error in [5.0, -5.0, 1e4] {
            let mut judge = Judge::new(method, 12.0, 8);
            let first: Vec<bool> = (0..8).map(|_| judge.refuses(error)).collect();
            assert_eq!(first, [true, true, true, true, true, true, true, false]);
            assert!((0..3000).all(|_| !judge.refuses(error)));
            // The usual surprise is down at a thousandth of the range.
            assert!(judge.refuses(error + 0.1) && judge.refuses(error - 0.1));
            assert!(!judge.refuses(error + 0.01));
        }
    }
}
