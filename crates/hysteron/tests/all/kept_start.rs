//! What a fit says of its error is what its model gives, from the start that the model keeps.

use hysteron::{
    Auto, Errors, FirstOrder, Fit, HoldOut, Model, Operator, Plane, Recording, Sample, Sign, Start,
    State, Surroundings, evaluate, fit_holding_out,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A random model that begins anywhere, recorded over a random zigzag: with noise, a load, a body.
fn recorded(rng: &mut ChaCha8Rng, model: &Model) -> Recording {
    let mut input = vec![rng.random_range(0.0..1.0_f64)];
    for _ in 0..rng.random_range(3..8) {
        let (from, to) = (input[input.len() - 1], rng.random_range(0.0..1.0_f64));
        input.extend((1..=15).map(|n| from + (to - from) * f64::from(n) / 15.0));
    }
    let past: Vec<f64> = (0..6).map(|_| rng.random_range(0.0..1.0_f64)).collect();
    let mut state = match rng.random_range(0..3) {
        0 => model.off(),
        1 => model.saturated(),
        _ => {
            let mut state = model.off();
            model.run(&mut state, &past, &mut [0.0; 6]).unwrap();
            state
        }
    };
    let mut output = vec![0.0; input.len()];
    model.run(&mut state, &input, &mut output).unwrap();
    let noise = rng.random_range(0.0..0.05);
    output
        .iter_mut()
        .for_each(|y| *y += noise * rng.random_range(-1.0..1.0));
    Recording::new(input, output).unwrap()
}

fn plant(rng: &mut ChaCha8Rng) -> Model {
    let plane = Plane::new(0.1, 1.0, 8).unwrap();
    let weights = (0..36).map(|_| rng.random_range(0.0..1.0)).collect();
    Model::new(Operator::Mkp, plane, weights, 0.5, Sign::Positive).unwrap()
}

/// The record of the fit against the model that its file holds.
fn agrees(model: &Model, recordings: &[Recording], which: impl Fn(usize, usize) -> bool, of: &str) {
    let read = Model::from_json(&model.to_json()).unwrap();
    let fit = read.fit.as_ref().unwrap();
    let (mut measured, mut modelled) = (Vec::new(), Vec::new());
    for (n, recording) in recordings.iter().enumerate() {
        let output = evaluate(&read, recording).unwrap().output_model;
        for (sample, h) in output.into_iter().enumerate() {
            let outlier = fit
                .outliers
                .iter()
                .any(|o| (o.recording, o.sample) == (n, sample));
            if which(n, sample) && !outlier {
                measured.push(recording.output[sample]);
                modelled.push(h);
            }
        }
    }
    let errors = Errors::between(&measured, &modelled, |_| true).unwrap();
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + b.abs());
    assert!(
        near(fit.rmse, errors.rmse),
        "{of}: {} {}",
        fit.rmse,
        errors.rmse
    );
    assert!(near(fit.max_abs, errors.max_abs), "{of}");
    assert!(
        near(fit.nrmse_percent, errors.nrmse_percent.unwrap_or_default()),
        "{of}"
    );
}

#[test]
fn the_error_of_a_fit_is_that_of_its_model() {
    for seed in 0..50 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let model = plant(&mut rng);
        let count = rng.random_range(1..4);
        let mut recordings: Vec<Recording> =
            (0..count).map(|_| recorded(&mut rng, &model)).collect();
        let mut fit = Fit::new().levels(8).smooth(1e-7).bootstrap(0);
        let kind = rng.random_range(0..4);
        fit = match seed % 5 {
            0 => fit.start(Start::Off),
            1 => fit.start(Start::On),
            2 => fit.start(Start::Unknown),
            3 if kind != 1 => fit.start(Start::Rest),
            _ => fit.start(Auto),
        };
        if kind == 1 {
            for (n, own) in recordings.iter_mut().enumerate() {
                let load = |k: usize| 1.0 + ((k / 20 + n) % 3) as f64;
                own.load = Some((0..own.len()).map(load).collect());
            }
        }
        let timed = kind == 2;
        if timed {
            for own in &mut recordings {
                own.time = Some((0..own.len()).map(|n| n as f64).collect());
            }
            fit = fit.lag(3.0);
        }
        let of = format!("seed {seed}, kind {kind}, {count} recordings");
        let found = fit.run(&recordings).unwrap();
        agrees(&found, &recordings, |_, _| true, &of);
        let start = found.fit.as_ref().unwrap().start;
        match kind {
            // States that have seen no load are not equal: a number of theirs is none.
            1 => assert!(start != Start::Off || found.fitted().is_none(), "{of}"),
            _ => assert_eq!(
                found.fitted().is_none(),
                start == Start::Off || found.start() == found.off(),
                "{of}"
            ),
        }
        if start == Start::On {
            // At the first sample, or before it where recordings begin at different inputs.
            let mut first = found.saturated();
            let begins = Sample {
                input: recordings[0].input[0],
                dt: timed.then_some(0.0),
                load: recordings[0].load.as_ref().map(|load| load[0]),
            };
            found.step(&mut first, begins).unwrap();
            let turns = |state: &State| state.turning_points().collect::<Vec<_>>();
            let kept = turns(&found.start());
            let squares = |state: &State| -> f64 {
                let of = |one: &Recording| {
                    let mut from = found.restore(&turns(state), state.input()).unwrap();
                    let mut output = vec![0.0; one.len()];
                    let around = Surroundings::from_recording(&found, one);
                    found
                        .run_in(&mut from, &one.input, around, &mut output)
                        .unwrap();
                    let pairs = output.iter().zip(&one.output);
                    pairs.map(|(h, y)| (h - y).powi(2)).sum::<f64>()
                };
                recordings.iter().map(of).sum()
            };
            let before = found.saturated();
            let [on, moved] = [&before, &first].map(squares);
            let expected = match count > 1 && moved > 1.01 * on {
                true => before,
                false => first,
            };
            assert_eq!(kept, turns(&expected), "{of}: {on} {moved}");
        }

        let what = HoldOut::Branches(0.3);
        if kind == 0 && recordings.iter().all(|own| own.split(&what).is_ok()) {
            let (found, report) = fit_holding_out(&fit, &recordings, &what).unwrap();
            let held: Vec<Vec<bool>> = recordings
                .iter()
                .map(|own| own.split(&what).unwrap().held_out)
                .collect();
            agrees(&found, &recordings, |n, sample| !held[n][sample], &of);
            assert!(report.model.samples > 0);
        }
        if kind == 0 && count == 1 {
            for rows in [1..=10, 20..=30] {
                let what = HoldOut::Rows(vec![rows]);
                let (found, _) = fit_holding_out(&fit, &recordings, &what).unwrap();
                let held = recordings[0].split(&what).unwrap().held_out;
                agrees(&found, &recordings, |_, sample| !held[sample], &of);
            }
        }
    }
}

/// A drive with a thermal body in front.
#[test]
fn the_error_of_a_fit_with_a_body_is_that_of_its_model() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let body = FirstOrder {
        tau_heating: 5.0,
        tau_cooling: 5.0,
        ..FirstOrder::default()
    };
    let mut model = plant(&mut rng);
    model.thermal = Some(body);
    let drive = |n: u32| 0.5 - 0.5 * (f64::from(n) * 0.07).cos() * (1.0 - f64::from(n) / 400.0);
    let input: Vec<f64> = (0..300).map(drive).collect();
    let time: Vec<f64> = (0..300).map(f64::from).collect();
    let around = hysteron::Surroundings {
        time: Some(&time),
        load: None,
        rest: None,
    };
    let output = model.simulate_in(&input, around).unwrap();
    let mut recording = Recording::new(input, output).unwrap();
    recording.time = Some(time);
    for start in [Start::Off, Start::On, Start::Unknown] {
        let fit = Fit::new()
            .levels(8)
            .smooth(1e-7)
            .bootstrap(0)
            .thermal(true)
            .start(start);
        let found = fit.run(&recording).unwrap();
        agrees(
            &found,
            std::slice::from_ref(&recording),
            |_, _| true,
            &format!("{start:?}"),
        );
    }
}
