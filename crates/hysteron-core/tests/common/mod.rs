//! Random models, and input sequences that are hard for a memory of turning points.
#![allow(clippy::unwrap_used)]

pub mod stages;

use hysteron_core::{
    Adaptation, Error, Estimator, Learning, Method, Model, Operator, Plane, State, Turn,
    estimator_len, operator_count, operators, table_len, turn_capacity,
};
use rand::rngs::StdRng;
use rand::{Rng, RngExt, SeedableRng};

pub const OPERATORS: [Operator; 3] = [Operator::Mkp, Operator::Kp, Operator::Relay];

pub fn rng(seed: u64) -> StdRng {
    StdRng::seed_from_u64(seed)
}

/// Levels from 2 to `most`, small ones more often.
pub fn levels(rng: &mut impl Rng, most: usize) -> usize {
    let spread: f64 = rng.random();
    2 + (spread * spread * (most - 1) as f64) as usize
}

/// Weights of several kinds: dense, mostly zero, a single one, and of very different sizes.
pub fn weights(rng: &mut impl Rng, levels: usize) -> Vec<f64> {
    let n = operator_count(levels);
    match rng.random_range(0..5) {
        0 => (0..n)
            .map(|_| {
                if rng.random_bool(0.9) {
                    0.0
                } else {
                    rng.random()
                }
            })
            .collect(),
        1 => {
            let only = rng.random_range(0..n);
            (0..n).map(|k| if k == only { 1.0 } else { 0.0 }).collect()
        }
        2 => (0..n)
            .map(|_| 10f64.powf(rng.random_range(-9.0..3.0)))
            .collect(),
        _ => dense(rng, levels),
    }
}

pub fn dense(rng: &mut impl Rng, levels: usize) -> Vec<f64> {
    (0..operator_count(levels)).map(|_| rng.random()).collect()
}

pub fn unit_plane(levels: usize) -> Plane<f64> {
    Plane::new(20.0, 80.0, levels).unwrap()
}

pub fn plane(rng: &mut impl Rng, levels: usize) -> Plane<f64> {
    let min = rng.random_range(-100.0..100.0);
    Plane::new(min, min + rng.random_range(0.1..200.0), levels).unwrap()
}

/// `count` inputs: walks, grid lines, repeats, out-of-range values, decaying and nested
/// oscillations.
pub fn inputs(rng: &mut impl Rng, plane: &Plane<f64>, count: usize) -> Vec<f64> {
    let k = plane.levels();
    let span = k as f64;
    let mut x: f64 = 0.0;
    let mut out = Vec::with_capacity(count);
    while out.len() < count {
        let burst = rng.random_range(1..=40);
        match rng.random_range(0..6) {
            0 => (0..burst).for_each(|_| {
                x = (x + rng.random_range(-1.0..1.0)).clamp(-1.0, span + 1.0);
                out.push(x);
            }),
            1 => (0..burst).for_each(|_| {
                x = rng.random_range(0..=k) as f64;
                out.push(x);
            }),
            2 => (0..burst).for_each(|_| out.push(x)),
            3 => {
                x = rng.random_range(-0.2..1.2) * span;
                out.push(x);
            }
            4 => {
                // An oscillation that narrows between two random positions.
                let (low, high) = (rng.random::<f64>() * span, rng.random::<f64>() * span);
                let (low, high) = (low.min(high), low.max(high));
                let middle = low + rng.random::<f64>() * (high - low);
                for n in 0..burst {
                    let shrink = 0.9f64.powi(n);
                    out.push(middle + (high - middle) * shrink);
                    out.push(middle - (middle - low) * shrink);
                }
                x = middle;
            }
            _ => nested(rng, k, burst as usize, &mut out),
        }
    }
    out.truncate(count);
    out.iter()
        .map(|&x| plane.min() + (x - 1.0) * plane.step())
        .collect()
}

/// `deep` oscillations with every maximum in one row and every minimum in one column of the grid.
pub fn nested(rng: &mut impl Rng, levels: usize, deep: usize, out: &mut Vec<f64>) {
    let p = rng.random_range(0..levels) as f64;
    let q = rng.random_range(0..=p as usize) as f64;
    // The fractions of the cell to which maxima and minima narrow. In a diagonal cell they must not
    // cross.
    let to_high: f64 = rng.random();
    let to_low = if p == q { to_high } else { rng.random() };
    let widest = (1.0 - f64::EPSILON, 0.0);
    let (mut high, mut low) = widest;
    for _ in 0..deep {
        // From time to time wide again, within the cell.
        if rng.random_bool(0.02) {
            (high, low) = widest;
        }
        high = to_high + (high - to_high) * rng.random_range(0.9..1.0);
        low += (to_low - low) * rng.random_range(0.0..0.1);
        out.push(p + high);
        out.push(q + low);
    }
}

pub type Owned<T> = (Model<T, Vec<T>>, State<T, Vec<Turn<T>>>);

pub fn build(plane: Plane<f64>, operator: Operator, weights: &[f64]) -> Owned<f64> {
    let k = plane.levels();
    let model = Model::new(plane, operator, weights, vec![0.0; table_len(k)]).unwrap();
    let state = model
        .state(vec![Turn::default(); turn_capacity(k)])
        .unwrap();
    (model, state)
}

/// The same model in single precision.
pub fn build_f32(plane: &Plane<f64>, operator: Operator, weights: &[f64]) -> Owned<f32> {
    let k = plane.levels();
    let plane = Plane::new(plane.min() as f32, plane.max() as f32, k).unwrap();
    let weights: Vec<f32> = weights.iter().map(|&w| w as f32).collect();
    let model = Model::new(plane, operator, &weights, vec![0.0; table_len(k)]).unwrap();
    let state = model
        .state(vec![Turn::default(); turn_capacity(k)])
        .unwrap();
    (model, state)
}

pub const INCREMENTS: Method<f64> = Method::Increments {
    gain: 0.3,
    span: 1.0,
};
pub const LEAST_SQUARES: Method<f64> = Method::LeastSquares {
    forgetting: 0.99,
    noise: 0.01,
    spread: 1.0,
    correlation: 2.0,
};
pub const METHODS: [Method<f64>; 2] = [INCREMENTS, LEAST_SQUARES];

pub fn options(method: Method<f64>) -> Adaptation<f64> {
    Adaptation {
        method,
        ..Adaptation::default()
    }
}

/// A model with its state and the estimator of its weights.
pub struct Learner {
    pub model: Model<f64, Vec<f64>>,
    pub state: State<f64, Vec<Turn<f64>>>,
    pub estimator: Estimator<f64, Vec<f64>>,
}

impl Learner {
    pub fn new(
        plane: Plane<f64>,
        operator: Operator,
        weights: &[f64],
        options: Adaptation<f64>,
    ) -> Self {
        let k = plane.levels();
        let mut model = Model::new(plane, operator, weights, vec![0.0; 2 * table_len(k)]).unwrap();
        let memory = vec![0.0; estimator_len(k, options.method)];
        let estimator = Estimator::new(options, &mut model, weights, 0.0, memory).unwrap();
        let state = model
            .state(vec![Turn::default(); turn_capacity(k)])
            .unwrap();
        Self {
            model,
            state,
            estimator,
        }
    }

    pub fn step(&mut self, input: f64, measured: f64) -> Result<Learning<f64>, Error> {
        self.estimator
            .step(&mut self.model, &mut self.state, input, measured)
    }
}

/// The covariance that least squares starts from, of all weights and the offset.
pub fn start_covariance(levels: usize, spread: f64, correlation: f64) -> Vec<Vec<f64>> {
    let n = operator_count(levels);
    let places: Vec<_> = operators(levels).collect();
    let at = |a: usize, b: usize| match (places.get(a), places.get(b)) {
        _ if a == b => spread * spread,
        (Some(&(i, j)), Some(&(k, l))) if correlation > 0.0 => {
            let square = |p: usize, q: usize| (p.abs_diff(q) as f64 / correlation).powi(2);
            spread * spread / (1.0 + square(i, k) + square(j, l))
        }
        _ => 0.0,
    };
    let row = |a: usize| (0..=n).map(|b| at(a, b)).collect();
    (0..=n).map(row).collect()
}

/// Strokes of `samples` samples with random reversals over the whole plane. In the long run they
/// excite every operator.
pub fn strokes(rng: &mut impl Rng, plane: &Plane<f64>, count: usize, samples: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(count);
    let mut from = plane.bottom();
    let mut up = true;
    while out.len() < count {
        let share: f64 = rng.random();
        let to = if up {
            from + share * (plane.max() - from)
        } else {
            from - share * (from - plane.bottom())
        };
        out.extend((1..=samples).map(|n| from + (to - from) * n as f64 / samples as f64));
        (from, up) = (to, !up);
    }
    out.truncate(count);
    out
}
