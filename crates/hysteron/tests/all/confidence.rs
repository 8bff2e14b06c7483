//! What a fit says of its own certainty, against known models.

use hysteron::{
    Excitation, Fit, FitOptions, INTERVAL, LoadLaw, Model, Operator, Plane, Recording, Sign,
    Solver, Start, evaluate_from,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

const LEVELS: usize = 8;

fn plane() -> Plane {
    Plane::new(20.0, 80.0, LEVELS).unwrap()
}

/// Weights of which a third are zero, as a material's are.
fn known(rng: &mut ChaCha8Rng) -> Model {
    let weights = (0..plane().operators())
        .map(|_| match rng.random_range(0..3) {
            0 => 0.0,
            _ => rng.random_range(0.2..2.0),
        })
        .collect();
    Model::new(Operator::Mkp, plane(), weights, 3.0, Sign::Positive).unwrap()
}

/// Straight ways between turning points, `count` samples a level.
fn travel(turns: &[f64], count: f64) -> Vec<f64> {
    let mut input = vec![turns[0]];
    for pair in turns.windows(2) {
        let samples = ((pair[1] - pair[0]).abs() / plane().step() * count).ceil();
        let at = |n: f64| pair[0] + (pair[1] - pair[0]) * n / samples;
        input.extend((1..=samples as usize).map(|n| at(n as f64)));
    }
    input
}

fn noisy(model_output: &[f64], part: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let high = model_output
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    let low = model_output.iter().copied().fold(f64::INFINITY, f64::min);
    let mut noise = || -> f64 { StandardNormal.sample(rng) };
    model_output
        .iter()
        .map(|y| y + part * (high - low) * noise())
        .collect()
}

/// Half of the first-order reversal curves, and a random walk from level to level.
fn experiment(rng: &mut ChaCha8Rng) -> Vec<f64> {
    let plane = plane();
    let mut turns = vec![plane.bottom()];
    for level in (2..=LEVELS).step_by(2) {
        turns.extend([plane.level(level), plane.bottom()]);
    }
    turns.extend((0..24).map(|_| plane.level(rng.random_range(0..=LEVELS))));
    travel(&turns, 10.0)
}

#[test]
fn intervals_hold_what_they_say() {
    for noise in [0.01, 0.05] {
        let (mut inside, mut all) = (0, 0);
        for seed in 0..60 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let model = known(&mut rng);
            let input = experiment(&mut rng);
            let output = noisy(&model.simulate(&input).unwrap(), noise, &mut rng);
            let options = FitOptions {
                levels: LEVELS,
                range: Some((20.0, 80.0)),
                bootstrap: 100,
                ..FitOptions::plain()
            };
            let found = Fit::from(&options)
                .run(&Recording::new(input, output).unwrap())
                .unwrap();
            let confidence = found.fit.as_ref().unwrap().confidence.as_ref().unwrap();
            for n in 0..model.weights().len() {
                if confidence.excitation[n] == Excitation::Determined {
                    let error = (found.weights()[n] - model.weights()[n]).abs();
                    inside += usize::from(error <= INTERVAL * confidence.standard_error[n]);
                    all += 1;
                }
            }
        }
        let share = inside as f64 / all as f64;
        println!("noise {noise}: {inside} of {all} weights within their 95 % interval, {share:.3}");
        assert!((0.90..=0.99).contains(&share));
    }
}

/// The error of a fit on another experiment, without noise.
fn error_elsewhere(found: &Model, model: &Model, rng: &mut ChaCha8Rng) -> f64 {
    let input = experiment(rng);
    let mut output = vec![0.0; input.len()];
    found.run(&mut found.off(), &input, &mut output).unwrap();
    let pairs = output.into_iter();
    let squares: Vec<f64> = pairs
        .zip(model.simulate(&input).unwrap())
        .map(|(a, b)| (a - b).powi(2))
        .collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn an_unknown_start_costs_little() {
    for truth in [Start::Off, Start::On] {
        let (mut known_start, mut unknown_start, mut wrong_start) = (0.0, 0.0, 0.0);
        for seed in 0..40 {
            let mut rng = ChaCha8Rng::seed_from_u64(1000 + seed);
            let model = known(&mut rng);
            // From the middle of the plane, where half of the operators are open.
            let mut turns = vec![50.0];
            turns.extend((0..60).map(|_| plane().level(rng.random_range(0..=LEVELS))));
            let input = travel(&turns, 10.0);
            let mut output = vec![0.0; input.len()];
            let mut state = match truth {
                Start::On => model.saturated(),
                _ => model.start(),
            };
            model.run(&mut state, &input, &mut output).unwrap();
            let output = noisy(&output, 0.01, &mut rng);
            let recording = Recording::new(input, output).unwrap();
            let error = |start| {
                let options = FitOptions {
                    levels: LEVELS,
                    range: Some((20.0, 80.0)),
                    start,
                    ..FitOptions::plain()
                };
                let found = Fit::from(&options).run(&recording).unwrap();
                // The fit may set each operator for itself. A start of a model is a history, which
                // can explain the recording a little less well.
                let again = evaluate_from(&found, &recording, start).unwrap().forward;
                let fitted = found.fit.as_ref().unwrap().rmse;
                assert!(
                    again.rmse
                        <= fitted
                            * if start == Start::Unknown {
                                1.1
                            } else {
                                1.0 + 1e-6
                            },
                    "{start:?}: {again:?}, {fitted}"
                );
                error_elsewhere(&found, &model, &mut ChaCha8Rng::seed_from_u64(seed))
            };
            known_start += error(truth) / 40.0;
            unknown_start += error(Start::Unknown) / 40.0;
            wrong_start += error(match truth {
                Start::On => Start::Off,
                _ => Start::On,
            }) / 40.0;
        }
        println!(
            "start {truth:?}: error {known_start:.4} known, {unknown_start:.4} unknown, {wrong_start:.4} taken wrongly"
        );
        assert!(unknown_start <= 1.1 * known_start);
        assert!(wrong_start > 2.0 * known_start);
    }
}

/// A butterfly loop that begins inside its range: what plain least squares fits, evaluation finds
/// again.
#[test]
fn an_unknown_start_with_weights_of_either_sign() {
    let input: Vec<f64> = (0..600)
        .map(|n| 50.0 + 30.0 * (f64::from(n) * 0.03).sin())
        .collect();
    let mut play = 50.0_f64;
    let output = input.iter().map(|x| {
        play = play.clamp(x - 4.0, x + 4.0);
        (play - 50.0).powi(2)
    });
    let recording = Recording::new(input.clone(), output.collect()).unwrap();
    let options = FitOptions {
        solver: Solver::Ols,
        start: Start::Unknown,
        smooth: (0.0, 1e-8).into(),
        ..FitOptions::plain()
    };
    let found = Fit::from(&options).run(&recording).unwrap();
    let fitted = found.fit.as_ref().unwrap().rmse;
    let again = evaluate_from(&found, &recording, Start::Unknown).unwrap();
    assert!(again.inverse.is_err());
    // One coordinate at a time ends near, not at, what the fit has solved for.
    assert!(
        again.forward.rmse <= 1.05 * fitted,
        "{:?}, {fitted}",
        again.forward
    );
}

/// Three recordings of one material, each after another history: together they are fitted as well
/// as any, which no common pattern of starts would allow.
#[test]
fn recordings_with_starts_of_their_own_are_one_experiment() {
    let mut rng = ChaCha8Rng::seed_from_u64(77);
    let model = known(&mut rng);
    let recordings: Vec<Recording> = (0..3)
        .map(|_| {
            let mut state = model.start();
            for _ in 0..30 {
                let level = plane().level(rng.random_range(0..=LEVELS));
                model.step(&mut state, level).unwrap();
            }
            // Open operators: those between the first sample and the range travelled so far.
            let mut turns = vec![50.0];
            turns.extend((0..8).map(|_| plane().level(rng.random_range(2..LEVELS))));
            turns.extend((0..20).map(|_| plane().level(rng.random_range(0..=LEVELS))));
            let input = travel(&turns, 4.0);
            let mut output = vec![0.0; input.len()];
            model.run(&mut state, &input, &mut output).unwrap();
            Recording::new(input, output).unwrap()
        })
        .collect();
    let fitted = |start| {
        let options = FitOptions {
            levels: LEVELS,
            range: Some((20.0, 80.0)),
            start,
            ..FitOptions::plain()
        };
        Fit::from(&options).run(&recordings).unwrap()
    };
    let unknown = fitted(Start::Unknown).fit.unwrap();
    // The error of the fit is that from the one start that the model keeps. That of the weights
    // alone, with a start of each recording's own, stands beside it.
    let free = |name: &str| unknown.other["start_found"][name].as_f64().unwrap();
    let percent = free("free_nrmse_percent");
    // Whole operators on or off are fitted exactly; an operator that starts half on is, only as
    // long as its ridge is not met half-way.
    assert!(percent < 0.5, "{percent}");
    assert!(percent <= unknown.nrmse_percent);
    assert_eq!(
        unknown.samples,
        recordings.iter().map(Recording::len).sum::<usize>()
    );
    for start in [Start::Off, Start::On] {
        let known = fitted(start).fit.unwrap();
        assert!(
            known.rmse > 5.0 * free("free_rmse"),
            "{start:?}: {}",
            known.rmse
        );
    }
}

/// Weights that change with the load in a straight line are found again, also at a load between.
#[test]
fn weights_that_depend_on_a_load_are_recovered() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let ends = [known(&mut rng), known(&mut rng)];
    let mixed = |s: f64| {
        let pairs = ends[0].weights().iter().zip(ends[1].weights());
        let weights = pairs.map(|(a, b)| (1.0 - s) * a + s * b).collect();
        Model::new(Operator::Mkp, plane(), weights, 3.0 - s, Sign::Positive).unwrap()
    };
    let recordings: Vec<Recording> = [0.0, 0.3, 1.0]
        .into_iter()
        .map(|s| {
            let input = experiment(&mut rng);
            let output = mixed(s).simulate(&input).unwrap();
            let mut recording = Recording::new(input, output).unwrap();
            recording.load = Some(vec![6.0 + 4.0 * s; recording.len()]);
            recording
        })
        .collect();
    let options = FitOptions {
        levels: LEVELS,
        range: Some((20.0, 80.0)),
        load_law: LoadLaw::Weights,
        // The data are exact, so nothing has to keep the weights small.
        ridge: 0.0,
        ..FitOptions::plain()
    };
    let found = Fit::from(&options).run(&recordings).unwrap();
    assert_eq!(found.load.as_ref().unwrap().range(), (6.0, 10.0));
    let between = found.at_load(8.0).unwrap();
    let error = error_elsewhere(&between, &mixed(0.5), &mut rng);
    // Exact data: what is left is what the solver takes for nothing, 1e-13 of squares of about
    // 1000.
    assert!(error < 1e-5, "{error}");
    assert!(between.inverse().is_ok());
    let text = found.to_json();
    assert_eq!(Model::from_json(&text).unwrap(), found);
    assert!(found.at_load(10.1).is_err());
}
