//! A model that learns on line between the stages around its operators.

use hysteron::{
    AdaptOptions, CreepTerm, FirstOrder, Learner, Model, Operator, Plane, Sample, Sign, Target,
    Wanted,
};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const LEARNERS: [Learner; 5] = [
    Learner::Auto,
    Learner::Refit,
    Learner::Drift,
    Learner::LeastSquares,
    Learner::Increments,
];

/// A model with some of the stages.
fn model(rng: &mut impl Rng) -> Model {
    let levels = rng.random_range(2..7);
    let plane = Plane::new(1.0, levels as f64, levels).unwrap();
    let operator = [Operator::Mkp, Operator::Kp, Operator::Relay][rng.random_range(0..3)];
    let sign = [Sign::Positive, Sign::Negative][rng.random_range(0..2)];
    let weights = (0..plane.operators()).map(|_| rng.random_range(0.1..1.0));
    let weights: Vec<f64> = weights.collect();
    let sum: f64 = weights.iter().sum();
    let mut model =
        Model::new(operator, plane, weights, rng.random_range(-2.0..2.0), sign).unwrap();
    let creep = [CreepTerm {
        coefficient: rng.random_range(0.01..0.2),
        tau: rng.random_range(0.5..5.0),
    }];
    let creep = &creep[..rng.random_range(0..2)];
    let lag = [0.0, 0.3][rng.random_range(0..2)];
    model = model.with_after(creep, lag).unwrap();
    if rng.random_bool(0.5) {
        let knots = [
            ("curve_sums", vec![-4.0 * sum, 0.3 * sum, 4.0 * sum]),
            ("curve_outputs", vec![-6.0 * sum, 0.0, 5.0 * sum]),
        ];
        model = model.with_behind(knots).unwrap();
    }
    if rng.random_bool(0.5) {
        let mut at = 20.0;
        let corners = (0..=levels).map(|_| {
            at += rng.random_range(5.0..15.0);
            at
        });
        model = model.with_spacing(corners.collect()).unwrap();
    }
    if rng.random_bool(0.5) {
        model.thermal = Some(FirstOrder {
            ambient: 0.0,
            gain: 1.1,
            tau_heating: rng.random_range(0.2..2.0),
            tau_cooling: rng.random_range(0.2..2.0),
        });
    }
    model
}

/// Samples over the whole plane.
fn walk(rng: &mut impl Rng, model: &Model, count: usize) -> Vec<Sample> {
    let (low, high) = match model.spacing() {
        [low, .., high] => (*low, *high),
        _ => (model.plane().bottom(), model.plane().max()),
    };
    let mut at = low;
    let samples = (0..count).map(|_| {
        at = match rng.random_range(0..30) {
            0 => at,
            1 => low + (high - low) * rng.random_range(-0.2..1.2),
            _ => at + 0.1 * (high - low) * rng.random_range(-1.0..1.0),
        };
        at = at.clamp(low - 1.0, high + 1.0);
        Sample {
            dt: model.is_timed().then(|| rng.random_range(0.05..0.5)),
            ..at.into()
        }
    });
    samples.collect()
}

fn by(learner: Learner) -> AdaptOptions {
    AdaptOptions {
        learner,
        ..AdaptOptions::default()
    }
}

#[test]
fn a_model_that_learns_nothing_is_the_model_bit_for_bit() {
    for seed in 0..300 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let model = model(&mut rng);
        let mut state = model.off();
        let mut fixed = by(Learner::Fixed).adaptive(&model).unwrap();
        let mut frozen = by(LEARNERS[seed as usize % LEARNERS.len()])
            .adaptive(&model)
            .unwrap();
        frozen.freeze(true);
        // A refit has weights of other states, `drift` a sum of sets, `auto` a mean: they round.
        let exact = matches!(
            LEARNERS[seed as usize % LEARNERS.len()],
            Learner::LeastSquares | Learner::Increments
        );
        for sample in walk(&mut rng, &model, 200) {
            let expected = model.step(&mut state, sample).unwrap();
            let measured = expected.output + rng.random_range(-1.0..1.0);
            let found = fixed.step(sample, measured).unwrap();
            assert_eq!(found.output.to_bits(), expected.output.to_bits(), "{seed}");
            assert_eq!(
                (found.clipped, found.error),
                (expected.clipped, measured - found.output)
            );
            let frozen = frozen.step(sample, measured).unwrap().output;
            match exact {
                true => assert_eq!(frozen.to_bits(), expected.output.to_bits(), "{seed}"),
                false => assert!((frozen - expected.output).abs() < 1e-9, "{seed}"),
            }
        }
        assert_eq!(fixed.model().unwrap().weights(), model.weights());
    }
}

#[test]
fn what_learns_from_the_model_itself_stays_at_the_model() {
    for seed in 0..200 {
        let mut rng = ChaCha8Rng::seed_from_u64(1000 + seed);
        let model = model(&mut rng);
        let learner = LEARNERS[seed as usize % LEARNERS.len()];
        let mut state = model.off();
        let mut adaptive = by(learner).adaptive(&model).unwrap();
        let (off, on) = model.output_range();
        let range = (on - off).abs();
        for (n, sample) in walk(&mut rng, &model, 400).into_iter().enumerate() {
            let measured = model.step(&mut state, sample).unwrap().output;
            let error = match n % 7 {
                0 => adaptive.simulate(sample).unwrap() - measured,
                _ => adaptive.step(sample, measured).unwrap().error,
            };
            // Rounding, which a lag magnifies by its time constant over the time step.
            assert!(
                error.abs() < 1e-7 * range,
                "{seed}, {learner}, {n}: {error}"
            );
        }
    }
}

#[test]
fn a_plant_with_other_weights_is_learned_between_the_stages() {
    for seed in 0..60 {
        let (mut rng, mut other) = (
            ChaCha8Rng::seed_from_u64(2000 + seed),
            ChaCha8Rng::seed_from_u64(2000 + seed),
        );
        // The same stages around other weights: what the plant is after its own have changed.
        let (model, base) = (model(&mut rng), model(&mut other));
        let mut worn = by(Learner::Fixed).adaptive(&base).unwrap().model().unwrap();
        let learned_by = AdaptOptions {
            noise: Some(1e-3),
            ..by(Learner::LeastSquares)
        };
        // A plant that is made by learning from another one, of another stroke.
        let mut maker = learned_by.adaptive(&base).unwrap();
        let mut state = base.off();
        for sample in walk(&mut rng, &base, 2000) {
            let output = base.step(&mut state, sample).unwrap().output;
            let offset = base.offset();
            maker
                .step(sample, offset + 0.7 * (output - offset))
                .unwrap();
        }
        worn = maker.model().unwrap_or(worn);
        let (mut adaptive, mut there) = (learned_by.adaptive(&model).unwrap(), worn.off());
        let mut fixed = by(Learner::Fixed).adaptive(&model).unwrap();
        let mut squares = [0.0; 2];
        for (n, sample) in walk(&mut rng, &model, 4000).into_iter().enumerate() {
            let measured = worn.step(&mut there, sample).unwrap().output;
            for (squares, learner) in squares.iter_mut().zip([&mut adaptive, &mut fixed]) {
                let error = learner.step(sample, measured).unwrap().error;
                *squares += if n < 2000 { 0.0 } else { error * error };
            }
        }
        println!("{seed}: {squares:?} {:?}", model.operator());
        assert!(squares[0] < 0.1 * squares[1], "{seed}: {squares:?}");
    }
}

#[test]
fn the_inverse_of_what_learns_goes_through_the_stages() {
    for seed in 0..100 {
        let mut rng = ChaCha8Rng::seed_from_u64(3000 + seed);
        let model = model(&mut rng);
        let mut adaptive = by(Learner::LeastSquares).adaptive(&model).unwrap();
        let mut wanted = model.off();
        let (off, on) = model.output_range();
        for _ in 0..50 {
            let target = Target::new(off + (on - off) * rng.random::<f64>());
            let wish = Wanted {
                dt: model.is_timed().then_some(0.2),
                ..target.into()
            };
            let expected = model.inverse().unwrap().step(&mut wanted, wish).unwrap();
            assert_eq!(adaptive.solve(wish).unwrap(), expected, "{seed}");
        }
    }
}
