//! Recordings that begin warm, or with the drive: the body was at rest with another drive before.

use hysteron::{
    FirstOrder, Fit, Model, Operator, Plane, Recording, Sign, Start, Surroundings, evaluate_from,
    forward, operators,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

const BODY: FirstOrder = FirstOrder {
    ambient: 0.0,
    gain: 1.0,
    tau_heating: 3.0,
    tau_cooling: 5.0,
};

/// Noise of the readings; the output reaches over 9.1.
const NOISE: f64 = 0.01;

/// **Simulated**: a wire with hysteresis of the width of three levels of twelve.
fn truth() -> Model {
    let plane = Plane::new(0.1, 1.0, 12).unwrap();
    let weight = |(i, j): (usize, usize)| if j - i == 3 { 1.0 } else { 0.002 };
    let weights = operators(12).map(weight).collect();
    let mut model = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive).unwrap();
    model.thermal = Some(BODY);
    model
}

/// What the wire does in steps, at rest with `rest` before.
fn recorded(rng: &mut StdRng, samples: usize, rest: Option<f64>) -> Recording {
    let mut level = rng.random();
    let mut held = 0;
    let input: Vec<f64> = (0..samples)
        .map(|_| {
            if held == 0 {
                (level, held) = (rng.random(), rng.random_range(40..160));
            }
            held -= 1;
            level
        })
        .collect();
    let time: Vec<f64> = (0..samples).map(|n| 0.1 * n as f64).collect();
    let around = Surroundings {
        time: Some(&time),
        load: None,
        rest,
    };
    let clean = truth().simulate_in(&input, around).unwrap();
    // Uniform noise of this standard deviation.
    let mut noisy = |y: f64| y + NOISE * 12.0_f64.sqrt() * (rng.random::<f64>() - 0.5);
    let output = clean.into_iter().map(&mut noisy).collect();
    let mut recording = Recording::new(input, output).unwrap();
    recording.time = Some(time);
    recording
}

/// Whatever each recording began with, a default fit finds it, and the body beside it.
#[test]
fn a_default_fit_finds_where_each_recording_began() {
    let mut rng = StdRng::seed_from_u64(7);
    for rests in [
        vec![Some(1.0)],
        vec![Some(0.0)],
        vec![None, Some(0.8), Some(0.0)],
    ] {
        let mut recordings: Vec<Recording> = Vec::new();
        for rest in &rests {
            recordings.push(recorded(&mut rng, 3000, *rest));
        }
        let model = Fit::new().bootstrap(0).run(&recordings).unwrap();
        let body = model.thermal.unwrap();
        let fit = model.fit.as_ref().unwrap();
        println!(
            "{rests:?}: {body:?}, {:.2} %, {:?}",
            fit.nrmse_percent,
            fit.rests()
        );
        // The grid of the weights leaves a few times the noise, which is 0.1 %; a body that takes
        // the first drive for its rest errs 2 to 10 %.
        assert!(fit.nrmse_percent < 0.5);
        for (found, truth) in [(body.tau_heating, 3.0), (body.tau_cooling, 5.0)] {
            assert!((found / truth - 1.0_f64).abs() < 0.1, "{body:?}");
        }
        // What the fit says is what others say of the same recordings.
        let found = evaluate_from(&model, &recordings, Start::Fitted).unwrap();
        // Summed in another order.
        assert!((found.forward.rmse / fit.rmse - 1.0).abs() < 1e-12);
        assert_eq!(
            found.rests.iter().any(Option::is_some),
            !fit.rests().is_empty()
        );
        let ran = forward(&model, &recordings, Start::Fitted).unwrap();
        assert_eq!(ran.output_model, found.output_model);
        // Elsewhere in its plane the wire may have been warmer or colder, and still all on or off.
        for (recording, rest) in recordings.iter().zip(&found.rests) {
            let around = Surroundings {
                rest: *rest,
                ..Surroundings::from_recording(&model, recording)
            };
            let output = model.simulate_in(&recording.input, around).unwrap();
            let squares = output
                .iter()
                .zip(&recording.output)
                .map(|(h, y)| (h - y).powi(2));
            let rmse = (squares.sum::<f64>() / output.len() as f64).sqrt();
            assert!(rmse < 2.0 * fit.rmse);
        }
    }
}

/// One that began elsewhere is judged by what the model says, and not by where it began.
#[test]
fn a_recording_that_began_warm_is_judged_from_there() {
    let mut rng = StdRng::seed_from_u64(8);
    for _ in 0..20 {
        let rest = rng.random_bool(0.7).then(|| rng.random());
        let recording = recorded(&mut rng, 600, rest);
        let found = evaluate_from(&truth(), &recording, Start::Fitted).unwrap();
        println!("{rest:?} {:?} {}", found.rests, found.forward.rmse);
        // The noise, and what is left of a rest where it hardly shows in the noise.
        assert!(found.forward.rmse < 1.5 * NOISE);
    }
}

/// A rest is one more sample before the first, for any model.
#[test]
fn a_rest_is_a_sample_before_all_others() {
    let mut rng = StdRng::seed_from_u64(9);
    let plain = truth().without_body();
    let late = truth().without_body().with_after(&[], 0.7).unwrap();
    for model in [truth(), plain, late] {
        for _ in 0..50 {
            let recording = recorded(&mut rng, 30, None);
            let rest = rng.random();
            let around = Surroundings {
                rest: Some(rest),
                ..Surroundings::from_recording(&model, &recording)
            };
            let mut output = vec![0.0; 30];
            let mut state = model.start();
            model
                .run_in(&mut state, &recording.input, around, &mut output)
                .unwrap();
            let mut stepped = model.start();
            model.step(&mut stepped, rest).unwrap();
            let dt = |n: usize| {
                if n == 0 {
                    0.0
                } else {
                    0.1 * n as f64 - 0.1 * (n - 1) as f64
                }
            };
            for (n, (input, y)) in recording.input.iter().zip(&output).enumerate() {
                let dt = model.is_timed().then(|| dt(n));
                let sample = hysteron::Sample {
                    input: *input,
                    dt,
                    load: None,
                };
                assert_eq!(
                    model.step(&mut stepped, sample).unwrap().output.to_bits(),
                    y.to_bits()
                );
            }
            assert_eq!(state, stepped);
        }
    }
    let around = Surroundings {
        rest: Some(f64::NAN),
        ..Surroundings::default()
    };
    let plain = truth().without_body();
    assert!(
        plain
            .run_in(&mut plain.start(), &[0.5], around, &mut [0.0])
            .is_err()
    );
}
