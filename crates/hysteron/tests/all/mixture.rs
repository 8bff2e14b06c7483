//! The learner `auto`: what it does over random plants and disturbances, beside the learners that it
//! mixes. The plants are simulated.

use hysteron::{
    AdaptOptions, Learner, Model, Operator, Plane, Progress, Recording, Sign, Start, Status,
    Target, adapt,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// What happens to a plant.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Disturbance {
    /// It is the model, but for noise.
    Nothing,
    /// Its output moves away, and its stroke grows or shrinks.
    Ageing,
    /// Its output jumps.
    Jump,
    /// Its input moves: a load, or a warmer room.
    Load,
    /// Single readings are wrong.
    Spikes,
    /// The sensor ends at a value within the range.
    Saturation,
    /// It starts with all operators on, which the model does not know.
    Start,
}

const ALL: [Disturbance; 7] = [
    Disturbance::Nothing,
    Disturbance::Ageing,
    Disturbance::Jump,
    Disturbance::Load,
    Disturbance::Spikes,
    Disturbance::Saturation,
    Disturbance::Start,
];

/// What `auto` mixes.
const MIXED: [Learner; 5] = [
    Learner::Fixed,
    Learner::Refit,
    Learner::Drift,
    Learner::LeastSquares,
    Learner::Increments,
];

/// Weights along the diagonal, in a ridge of random place and width, with a stroke of 10.
fn actuator(rng: &mut ChaCha8Rng) -> Model {
    let levels = rng.random_range(8..16);
    let (middle, lag) = (rng.random_range(0.4..0.6), rng.random_range(0.1..0.3));
    let at = |n: usize| n as f64 / levels as f64;
    let weight = |(i, j): (usize, usize)| {
        let off = (at(j) - middle - lag / 2.0).powi(2) + (at(i) - middle + lag / 2.0).powi(2);
        (-60.0 * off).exp()
    };
    let mut weights: Vec<f64> = hysteron::operators(levels).map(weight).collect();
    let total: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|mu| *mu *= 10.0 / total);
    let plane = Plane::new(20.0, 80.0, levels).unwrap();
    Model::new(Operator::Mkp, plane, weights, 5.0, Sign::Negative).unwrap()
}

/// A model that is not quite the plant, a run of the plant, and the samples of a cycle.
fn run(rng: &mut ChaCha8Rng, disturbance: Disturbance) -> (Model, Recording, usize) {
    let plant = actuator(rng);
    let wrong: Vec<f64> = plant
        .weights()
        .iter()
        .map(|mu| mu * rng.random_range(0.8..1.2))
        .collect();
    let model = Model::new(
        plant.operator(),
        *plant.plane(),
        wrong,
        plant.offset(),
        plant.sign(),
    );
    let cycle = rng.random_range(100..400);
    let sizes = rng.random_range(0.0..12.0);
    let wave = |n: usize| {
        let turn = n as f64 / cycle as f64;
        48.0 - (34.0 - sizes * (0.31 * turn).cos().abs()) * (TAU * turn).cos()
    };
    let count = 12 * cycle;
    let from = rng.random_range(3 * cycle..6 * cycle);
    let late = |n: usize| if n < from { 0.0 } else { 1.0 };
    let input: Vec<f64> = (0..count).map(wave).collect();
    let size = rng.random_range(-1.0..1.0);
    let felt = |n: usize| match disturbance {
        Disturbance::Load => input[n] + 12.0 * size * late(n),
        _ => input[n],
    };
    let felt: Vec<f64> = (0..count).map(felt).collect();
    let mut state = match disturbance {
        Disturbance::Start => plant.saturated(),
        _ => plant.off(),
    };
    let noise = rng.random_range(0.0..0.05);
    let output = felt.iter().enumerate().map(|(n, x)| {
        let y = plant.step(&mut state, *x).unwrap().output;
        let share = n as f64 / count as f64;
        let y = match disturbance {
            Disturbance::Ageing => y * (1.0 + 0.3 * size * share) + 3.0 * size * share,
            Disturbance::Jump => y + 3.0 * size * late(n),
            Disturbance::Spikes if rng.random_bool(0.02) => y + rng.random_range(-20.0..20.0),
            Disturbance::Saturation => y.max(-1.0),
            _ => y,
        };
        y + noise * rng.random_range(-1.0..1.0)
    });
    let output = output.collect();
    (
        model.unwrap(),
        Recording::new(input, output).unwrap(),
        cycle,
    )
}

/// The output expected of each sample.
fn expected(model: &Model, recording: &Recording, learner: Learner) -> Vec<f64> {
    let options = AdaptOptions {
        learner,
        start: Start::Off,
        ..AdaptOptions::default()
    };
    adapt(model, recording, &options, Progress::NONE)
        .unwrap()
        .output_model
}

/// The root of the mean squared error over the samples to `keep`.
fn rms(measured: &[f64], expected: &[f64], keep: impl Fn(usize) -> bool) -> f64 {
    let pairs = measured
        .iter()
        .zip(expected)
        .enumerate()
        .filter(|(n, _)| keep(*n));
    let squares: Vec<f64> = pairs.map(|(_, (y, h))| (y - h).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn auto_does_no_harm_and_is_near_the_best() {
    for disturbance in ALL {
        let mut ratios = Vec::new();
        for seed in 0..12 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let (model, recording, cycle) = run(&mut rng, disturbance);
            let y = &recording.output;
            let fixed = expected(&model, &recording, Learner::Fixed);
            let auto = expected(&model, &recording, Learner::Auto);
            // No model expects a spike.
            let usual = |n: usize| (y[n] - fixed[n]).abs() < 6.0;
            let error = |learner| rms(y, &expected(&model, &recording, learner), usual);
            let best = MIXED.map(error).into_iter().fold(f64::INFINITY, f64::min);
            ratios.push(rms(y, &auto, usual) / best);
            for begin in (0..y.len() - cycle).step_by(cycle / 4) {
                let here = |n: usize| (begin..begin + cycle).contains(&n) && usual(n);
                let harm = rms(y, &auto, here) / rms(y, &fixed, here);
                assert!(
                    harm <= 1.05,
                    "{disturbance:?} {seed}, cycle at {begin}: {harm}"
                );
            }
        }
        // In single runs the first samples after a jump count, in which the best one is not known.
        let mean = ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64;
        assert!(
            mean.exp() <= 1.1,
            "{disturbance:?}: {} {ratios:.2?}",
            mean.exp()
        );
    }
}

#[test]
fn single_wrong_readings_do_not_move_the_mixture() {
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(100 + seed);
        let (model, clean, cycle) = run(&mut rng, Disturbance::Nothing);
        let mut wrong = clean.clone();
        let mut spikes = Vec::new();
        for n in (3 * cycle..wrong.len()).step_by(cycle / 3) {
            wrong.output[n] += [-1.0, 1.0][n % 2] * rng.random_range(5.0..1e6);
            spikes.push(n);
        }
        let right = |n: usize| !spikes.contains(&n);
        let [before, after] = [&clean, &wrong].map(|recording| {
            rms(
                &clean.output,
                &expected(&model, recording, Learner::Auto),
                right,
            )
        });
        // The recording's noise is up to 0.5 % of the range.
        assert!(after < 1.1 * before + 0.01, "{seed}: {before} {after}");
    }
}

#[test]
fn the_model_of_a_mixture_has_an_inverse_at_every_instant() {
    for disturbance in ALL {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let (model, recording, _) = run(&mut rng, disturbance);
        let mut adaptive = AdaptOptions::default().adaptive(&model).unwrap();
        let samples = recording.input.iter().zip(&recording.output);
        for (n, (&x, &y)) in samples.enumerate() {
            adaptive.step(x, y).unwrap();
            if n % 7 == 0 {
                let (off, on) = adaptive.model().unwrap().output_range();
                let target = off + (on - off) * rng.random_range(0.1..0.9);
                adaptive.align();
                let found = adaptive.solve(Target::new(target)).unwrap();
                assert_eq!(found.status, Status::Ok, "{disturbance:?} {n}: {found:?}");
                let mut there = adaptive.clone();
                let output = there.simulate(found.input).unwrap();
                // Rounding of sums of a hundred weights.
                assert!(
                    (output - target).abs() < 1e-9,
                    "{disturbance:?} {n}: {output}"
                );
            }
        }
    }
}

/// A loop is not told how the operators began. What another start explains is not learned before it
/// is forgotten, by readings or without them; what is left then is a change.
#[test]
fn a_loop_waits_until_its_start_is_forgotten() {
    let mut waited = 0;
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plant = actuator(&mut rng);
        let (low, high) = (plant.plane().min(), plant.plane().max());
        let at = |share: f64| low + share * (high - low);
        let (mut state, mut off) = (plant.saturated(), plant.off());
        let (first, last) = plant.output_range();
        let mut adaptive = AdaptOptions::default().adaptive(&plant).unwrap();
        let (mut least, mut missed) = (f64::INFINITY, f64::NAN);
        // From the middle up, and back: one turn, which does not reach the end.
        let ramp =
            |from: f64, to: f64| (0..=40).map(move |n| from + (to - from) * f64::from(n) / 40.0);
        for share in ramp(0.4, 0.7).chain(ramp(0.7, 0.5)) {
            let output = plant.step(&mut state, at(share)).unwrap().output;
            let other = plant.step(&mut off, at(share)).unwrap().output;
            least = least.min((output - other).abs() / (last - first).abs());
            adaptive.step(at(share), output).unwrap();
        }
        // Where the ridge ends below 0.7, the start is forgotten there.
        if least > 0.05 {
            let model = adaptive.model().unwrap();
            assert!(model.weights() == plant.weights(), "seed {seed}");
            assert_eq!(model.offset(), plant.offset(), "seed {seed}");
            waited += 1;
        }
        // A full stroke without readings, and then another offset.
        for share in ramp(0.5, 1.0).chain(ramp(1.0, 0.0)) {
            plant.step(&mut state, at(share)).unwrap();
            adaptive.simulate(at(share)).unwrap();
        }
        for share in ramp(0.0, 1.0).chain(ramp(1.0, 0.0)).chain(ramp(0.0, 1.0)) {
            let output = plant.step(&mut state, at(share)).unwrap().output + 1.0;
            adaptive.step(at(share), output).unwrap();
        }
        // In the middle of the stroke the model as it was misses the offset of 1.
        for share in ramp(1.0, 0.5) {
            let output = plant.step(&mut state, at(share)).unwrap().output + 1.0;
            missed = output - adaptive.simulate(at(share)).unwrap();
        }
        assert!(missed.abs() < 0.3, "seed {seed}: {missed}");
    }
    assert!(waited >= 5, "{waited}");
}
