//! The whole model: its stages in every order of calls, its inverse, its file, and what a fit finds.

use hysteron::{
    Auto, Basis, Choice, CreepTerm, Fit, FitOptions, FittedStart, Grade, HoldOut, LoadLaw, Model,
    Operator, Plane, Policy, Recording, Sample, Sign, Spacing, Start, Status, Surroundings, Target,
    Verdict, Wanted, evaluate, evaluate_from, fit_holding_out,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A model file with every stage.
const WHOLE: &str = r#"{"format": "hysteron-model", "version": 2, "operator": "mkp",
  "plane": {"min": 30.0, "max": 60.0, "levels": 3},
  "input": {"name": "duty"}, "output": {"name": "lift", "unit": "mm", "offset": 2.0, "sign": -1},
  "weights": [1.0, 0.5, 1.0, 0.25, 0.5, 1.0],
  "load": {"name": "stress", "unit": "MPa", "min": 50.0, "max": 200.0,
    "parts": [{"offset": 2.0, "weights": [1.0, 0.5, 1.0, 0.25, 0.5, 1.0]}],
    "curves": {"loads": [50.0, 100.0, 200.0], "shifts": [0.0, 5.0, 20.0],
      "scales": [1.0, 1.1, 1.0], "gains": [1.0, 1.2, 1.3], "offsets": [0.0, 0.5, 0.7]}},
  "thermal": {"kind": "first-order", "ambient": 20.0, "gain": 100.0, "tau_heating": 2.0,
    "tau_cooling": 5.0},
  "drive": {"min": 0.0, "max": 1.0},
  "spacing": [15.0, 35.0, 40.0, 60.0],
  "creep": [{"coefficient": 0.02, "tau": 1.0}, {"coefficient": 0.01, "tau": 30.0}],
  "lag": 0.05,
  "start": {"turning_points": [2.5, 0.5], "input": 20.0}}"#;

fn whole() -> Model {
    Model::from_json(WHOLE).unwrap()
}

fn random(seed: u64, count: usize) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = |low: f64, high: f64| -> Vec<f64> {
        (0..count).map(|_| rng.random_range(low..high)).collect()
    };
    let (drive, load, steps) = (draw(0.0, 1.0), draw(50.0, 200.0), draw(0.0, 1.0));
    let mut now = 0.0;
    let time = steps.iter().map(|step| {
        now += step;
        now
    });
    (drive, load, time.collect())
}

#[test]
fn a_file_of_version_2_is_kept_to_the_last_digit() {
    let model = whole();
    let text = model.to_json();
    assert!(text.contains(r#""version":2"#));
    assert_eq!(Model::from_json(&text).unwrap(), model);
    let plane = Plane::new(0.0, 1.0, 2).unwrap();
    let plain = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive).unwrap();
    assert!(plain.to_json().contains(r#""version":1"#));
}

#[test]
fn wrong_fields_of_version_2_are_named() {
    let cases = [
        (r#""version": 2"#, r#""version": 1"#, "load.curves"),
        (r#""version": 2"#, r#""version": 5"#, "version"),
        (
            "[50.0, 100.0, 200.0]",
            "[50.0, 200.0, 100.0]",
            "load.curves.loads",
        ),
        ("[50.0, 100.0, 200.0]", "[]", "load.curves.loads"),
        ("[0.0, 5.0, 20.0]", "[0.0, 5.0]", "load.curves.shifts"),
        ("[1.0, 1.1, 1.0]", "[1.0, 0.0, 1.0]", "load.curves.scales"),
        ("[1.0, 1.2, 1.3]", "[1.0, -1.0, 1.0]", "load.curves.gains"),
        ("[0.0, 0.5, 0.7]", "[0.0]", "load.curves.offsets"),
        (r#""ambient": 20.0"#, r#""ambient": "warm""#, "thermal"),
        (r#""gain": 100.0"#, r#""gain": 0.0"#, "thermal.gain"),
        (
            r#""tau_cooling": 5.0"#,
            r#""tau_cooling": -5.0"#,
            "thermal.tau_cooling",
        ),
        (r#""max": 1.0}"#, r#""max": -1.0}"#, "drive"),
        ("[15.0, 35.0, 40.0, 60.0]", "[15.0, 35.0, 60.0]", "spacing"),
        (
            "[15.0, 35.0, 40.0, 60.0]",
            "[15.0, 35.0, 35.0, 60.0]",
            "spacing",
        ),
        (r#""tau": 1.0"#, r#""tau": 0.0"#, "creep"),
        (r#""coefficient": 0.02"#, r#""coefficient": -0.02"#, "creep"),
        (r#""lag": 0.05"#, r#""lag": -0.05"#, "lag"),
        ("[2.5, 0.5]", "[0.5, 2.5]", "start.turning_points"),
        (r#""tau": 30.0}"#, r#""tau": 30.0, "more": 1}"#, "creep"),
    ];
    for (from, to, field) in cases {
        assert!(WHOLE.contains(from), "{from}");
        let error = Model::from_json(&WHOLE.replace(from, to)).unwrap_err();
        let said = error.to_string();
        assert!(said.contains(field), "{from} -> {to}: {said}");
    }
}

#[test]
fn series_and_single_steps_agree() {
    let model = whole();
    let (drive, load, time) = random(1, 500);
    let around = Surroundings {
        time: Some(&time),
        load: Some(&load),
        rest: None,
    };
    let all = model.simulate_in(&drive, around).unwrap();
    let mut state = model.start();
    for n in 0..drive.len() {
        let dt = Some(time[n] - time[n.saturating_sub(1)]);
        let sample = Sample {
            input: drive[n],
            dt,
            load: Some(load[n]),
        };
        assert_eq!(model.step(&mut state, sample).unwrap().output, all[n]);
    }
}

#[test]
fn the_inverse_is_met_by_the_model_where_it_says_so() {
    let model = whole();
    let (targets, load, time) = random(2, 2000);
    let targets: Vec<f64> = targets.iter().map(|share| 3.0 - 8.0 * share).collect();
    let around = Surroundings {
        time: Some(&time),
        load: Some(&load),
        rest: None,
    };
    let inverse = model.inverse().unwrap();
    let found = inverse
        .series_in(&mut model.start(), &targets, Policy::Hold, 0.0, around)
        .unwrap();
    let drives: Vec<f64> = found.iter().map(|solution| solution.input).collect();
    let back = model.simulate_in(&drives, around).unwrap();
    let (mut met, mut limited) = (0, 0);
    for ((solution, target), output) in found.iter().zip(&targets).zip(&back) {
        assert!((0.0..=1.0).contains(&solution.input));
        match solution.status {
            Status::Ok => {
                met += 1;
                assert!(
                    (target - output).abs() < 1e-9,
                    "{solution:?} {target} {output}"
                );
            }
            Status::Limited => limited += 1,
            _ => {}
        }
    }
    assert!(met > 50 && limited > 500, "{met} {limited}");
}

#[test]
fn a_constant_load_is_a_model_of_its_own() {
    let model = whole();
    let (drive, _, time) = random(3, 300);
    for load in [50.0, 80.0, 200.0] {
        let at = model.at_load(load).unwrap();
        assert!(at.load.is_none());
        let loads = vec![load; drive.len()];
        let with = Surroundings {
            time: Some(&time),
            load: Some(&loads),
            rest: None,
        };
        let without = Surroundings {
            time: Some(&time),
            load: None,
            rest: None,
        };
        let left = model.simulate_in(&drive, with).unwrap();
        let right = at.simulate_in(&drive, without).unwrap();
        // Some roundings of numbers up to 100, where the output moves by 1 in 5.
        let near = left.iter().zip(&right).all(|(a, b)| (a - b).abs() < 1e-11);
        assert!(near, "{load}");
    }
}

#[test]
fn what_a_sample_lacks_is_said_and_moves_nothing() {
    let model = whole();
    let mut state = model.start();
    let good = Sample {
        input: 0.5,
        dt: Some(0.1),
        load: Some(60.0),
    };
    model.step(&mut state, good).unwrap();
    let before = state.clone();
    let inverse = model.inverse().unwrap();
    for (sample, word) in [
        (Sample { dt: None, ..good }, "time"),
        (
            Sample {
                dt: Some(-1.0),
                ..good
            },
            "time",
        ),
        (
            Sample {
                dt: Some(f64::NAN),
                ..good
            },
            "time",
        ),
        (Sample { load: None, ..good }, "stress"),
        (
            Sample {
                load: Some(300.0),
                ..good
            },
            "stress",
        ),
        (
            Sample {
                load: Some(f64::NAN),
                ..good
            },
            "stress",
        ),
        (
            Sample {
                input: f64::NAN,
                ..good
            },
            "finite",
        ),
    ] {
        let said = model.step(&mut state, sample).unwrap_err().to_string();
        assert!(said.contains(word), "{sample:?}: {said}");
        assert_eq!(state, before, "{sample:?}");
        let Sample { input, dt, load } = sample;
        let wanted = Wanted {
            dt,
            load,
            ..Target::new(input).into()
        };
        let said = inverse.step(&mut state, wanted).unwrap_err().to_string();
        assert!(said.contains(word), "{sample:?}: {said}");
        assert_eq!(state, before, "{sample:?}");
    }
    assert!(model.inverse().unwrap().drive_range(1.0, 0.0).is_err());
    assert!(model.inverse().unwrap().drive_range(f64::NAN, 1.0).is_err());
    assert!(model.inverse().unwrap().horizon(-1.0).is_err());
    let one = inverse.drive_range(0.3, 0.3).unwrap();
    let wanted = Wanted {
        dt: Some(1e9),
        load: Some(60.0),
        ..Target::new(0.0).into()
    };
    assert_eq!(one.step(&mut state, wanted).unwrap().input, 0.3);
    let plain = model.operators().start();
    assert!(model.run(&mut plain.into(), &[0.1], &mut [0.0]).is_err());
}

/// Wires under four stresses: shifted, and with a stroke that grows and saturates.
fn under_load(stress: f64) -> Recording {
    let plane = Plane::new(35.0, 90.0, 12).unwrap();
    let weight = |(i, j): (usize, usize)| if j - i == 4 { 1.0 } else { 0.01 };
    let weights: Vec<f64> = hysteron::operators(12).map(weight).collect();
    let model = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Negative).unwrap();
    let input: Vec<f64> = (0..600)
        .map(|n| 80.0 - 50.0 * (f64::from(n) * 0.021).cos())
        .collect();
    let seen: Vec<f64> = input.iter().map(|t| t - 0.12 * stress).collect();
    let output = model.simulate(&seen).unwrap().into_iter();
    let output = output
        .map(|y| 0.002 * stress + (stress / 50.0).sqrt() * y)
        .collect();
    let mut recording = Recording::new(input, output).unwrap();
    recording.load = Some(vec![stress; 600]);
    recording
}

/// Weights that are straight in the load, and an axis that stays where it is: nothing has to be
/// moved.
#[test]
fn weights_that_follow_the_load_alone_are_found() {
    let plane = Plane::new(0.0, 10.0, 12).unwrap();
    let model = |weight: &dyn Fn(usize, usize) -> f64| {
        let weights = hysteron::operators(12).map(|(i, j)| weight(i, j)).collect();
        Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive).unwrap()
    };
    let narrow = model(&|i, j| f64::from(u8::from(j - i < 3)));
    let wide = model(&|i, j| f64::from(u8::from(j - i > 4 && i > 2)));
    let recorded = |load: f64| {
        let swing = |n: i32| 5.0 - (5.0 - 0.004 * f64::from(n)) * (0.05 * f64::from(n)).cos();
        let input: Vec<f64> = (0..900).map(swing).collect();
        let [a, b] = [&narrow, &wide].map(|model| model.simulate(&input).unwrap());
        let output = a.iter().zip(b).map(|(a, b)| a + 0.01 * load * b).collect();
        let mut recording = Recording::new(input, output).unwrap();
        recording.load = Some(vec![load; 900]);
        recording
    };
    let fitted = [50.0, 100.0, 150.0, 200.0].map(recorded);
    let fit = Fit::new().levels(12).smooth(0.0).bootstrap(0);
    let fit = fit.spacing(Spacing::Uniform);
    let found = fit.run(&fitted).unwrap();
    assert!(found.load.as_ref().unwrap().curves.is_none());
    let unseen = recorded(120.0);
    let error = evaluate_from(&found, &unseen, Start::Off).unwrap();
    // As good as a load that is nearer by a factor of ten.
    let nearest = recorded(100.0).output;
    let apart = unseen
        .output
        .iter()
        .zip(nearest)
        .map(|(a, b)| (a - b).powi(2));
    let apart = (apart.sum::<f64>() / 900.0).sqrt();
    assert!(
        error.forward.rmse < apart / 10.0,
        "{:?} {apart}",
        error.forward
    );
}

#[test]
fn a_load_that_was_left_out_is_predicted_by_the_shift() {
    let fitted = [50.0, 100.0, 200.0].map(under_load);
    let unseen = under_load(150.0);
    let error = |law| {
        let model = Fit::from(FitOptions::plain())
            .load_law(law)
            .run(&fitted)
            .unwrap();
        let found = evaluate(&model, &unseen)
            .unwrap()
            .forward
            .nrmse_percent
            .unwrap();
        (model, found)
    };
    let (model, shifted) = error(LoadLaw::Shift);
    let (_, weights) = error(LoadLaw::Weights);
    assert!(
        shifted < 2.0 && shifted < 0.3 * weights,
        "{shifted} {weights}"
    );
    let slope = model.load.unwrap().curves.unwrap().slope();
    assert!((slope - 0.12).abs() < 0.006, "{slope}");
}

/// A simulated wire whose loop moves and widens with the stress: heating is delayed by more than
/// cooling. `least` is its stroke without stress, of that at 200.
fn widening(least: f64) -> Model {
    let weight = |(i, j): (usize, usize)| if j - i == 3 { 1.0 } else { 0.02 };
    let weights: Vec<f64> = hysteron::operators(12).map(weight).collect();
    let text = serde_json::json!({
        "format": "hysteron-model", "version": 3, "operator": "mkp",
        "plane": {"min": 35.0, "max": 90.0, "levels": 12}, "weights": weights,
        "output": {"sign": -1},
        "load": {
            "min": 0.0, "max": 200.0, "parts": [{"offset": 0.0, "weights": weights}],
            "curves": {"loads": [0.0, 200.0], "gains": [least, 1.0], "offsets": [0.0, 0.5]},
        },
        "stages": {
            "knots": [30.0, 60.0, 90.0],
            "rising": [30.0, 60.0, 90.0, 62.0, 84.0, 120.0],
            "falling": [30.0, 60.0, 90.0, 46.0, 76.0, 100.0],
        },
    });
    Model::from_json(&text.to_string()).unwrap()
}

fn recorded(plant: &Model, stress: f64) -> Recording {
    let input: Vec<f64> = (0..500)
        .map(|n| 80.0 - 60.0 * (f64::from(n) * 0.025).cos())
        .collect();
    let load = vec![stress; input.len()];
    let around = Surroundings {
        time: None,
        load: Some(&load),
        rest: None,
    };
    let output = plant.simulate_in(&input, around).unwrap();
    let mut recording = Recording::new(input, output).unwrap();
    recording.load = Some(load);
    recording
}

#[test]
fn a_loop_that_widens_with_the_load_is_registered() {
    let plant = widening(0.5);
    let fitted = [25.0, 75.0, 125.0, 175.0].map(|stress| recorded(&plant, stress));
    let unseen = recorded(&plant, 100.0);
    let error = |law| {
        let fit = Fit::from(FitOptions::plain()).load_law(law);
        let model = fit.run(&fitted).unwrap();
        let found = evaluate(&model, &unseen).unwrap().forward;
        (model, found.nrmse_percent.unwrap())
    };
    let (model, registered) = error(LoadLaw::Auto);
    let (shift, shifted) = error(LoadLaw::Shift);
    assert!(!model.registration().is_none() && shift.registration().is_none());
    // A shift cannot widen the loop. What is left is that of 20 levels.
    assert!(
        registered < 1.0 && registered < 0.6 * shifted,
        "{registered} {shifted}"
    );
    // A file carries all of it.
    let again = Model::from_json(&model.to_json()).unwrap();
    assert_eq!(again, model);
    // The model at one load is the model with that load.
    let at = model.at_load(100.0).unwrap();
    let mut alone = unseen.clone();
    alone.load = None;
    let outputs = |model: &Model, recording: &Recording| {
        let around = Surroundings::from_recording(model, recording);
        model.simulate_in(&recording.input, around).unwrap()
    };
    let (at_load, with_load) = (outputs(&at, &alone), outputs(&model, &unseen));
    for (a, b) in at_load.iter().zip(with_load) {
        // Rounding of positions, times the slope of the operators.
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    // Every output is reached, at any load, however it changes.
    let inverse = model.inverse().unwrap();
    let mut state = model.start();
    for n in 0..200 {
        let load = 25.0 + 150.0 * (0.5 + 0.5 * (f64::from(n) * 0.7).sin());
        let (off, on) = model.at_load(load).unwrap().output_range();
        let target = off + (on - off) * (0.5 + 0.5 * (f64::from(n) * 0.3).cos());
        let wanted = Wanted {
            load: Some(load),
            ..Target::new(target).into()
        };
        let found = inverse.step(&mut state, wanted).unwrap();
        assert_eq!(found.status, Status::Ok, "{n}");
    }
}

/// A load with hardly any stroke says nothing about the others.
#[test]
fn a_load_with_hardly_any_stroke_has_no_say() {
    let plant = widening(0.003);
    let all = [0.0, 50.0, 100.0, 150.0, 200.0];
    for law in [LoadLaw::Auto, LoadLaw::Shift] {
        let of = |loads: &[f64]| -> f64 {
            let fitted: Vec<Recording> = loads.iter().map(|s| recorded(&plant, *s)).collect();
            let fit = Fit::from(FitOptions::plain()).load_law(law);
            let model = fit.run(&fitted).unwrap();
            let found = evaluate(&model, &recorded(&plant, 100.0)).unwrap().forward;
            found.nrmse_percent.unwrap()
        };
        let without: Vec<f64> = all.into_iter().filter(|stress| *stress != 100.0).collect();
        let (with_silent, alone) = (of(&without), of(&without[1..]));
        // Stroke and shift between 50 and 150 do not come from the load 0.
        assert!(
            with_silent < alone + 1.5,
            "{law:?}: {with_silent} with it, {alone} without"
        );
    }
}

#[test]
fn levels_move_to_where_a_sharp_loop_moves() {
    let plane = Plane::new(-1.0, 1.0, 400).unwrap();
    let sharp = |(i, j): (usize, usize)| {
        if j - i == 30 && i > 180 && i < 200 {
            1.0
        } else {
            0.0
        }
    };
    let weights = hysteron::operators(400).map(sharp).collect();
    let model = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive).unwrap();
    let input: Vec<f64> = (0..900).map(|n| -(f64::from(n) * 0.015).cos()).collect();
    let output = model.simulate(&input).unwrap();
    let recording = Recording::new(input, output).unwrap();
    let error = |spacing| {
        let fit = Fit::from(FitOptions::plain())
            .spacing(spacing)
            .run(&recording);
        let model = fit.unwrap();
        let found = evaluate(&model, &recording)
            .unwrap()
            .forward
            .nrmse_percent
            .unwrap();
        let said = model.fit.unwrap().nrmse_percent;
        assert!((found - said).abs() < 1e-6, "{found} {said}");
        found
    };
    let (uniform, auto) = (error(Spacing::Uniform), error(Spacing::Auto));
    assert!(auto < 0.35 * uniform, "{auto} {uniform}");
}

/// A loop with creep and a lag, that begins in the middle.
fn creeping() -> Recording {
    let plane = Plane::new(-0.8, 1.0, 10).unwrap();
    let model = Model::new(Operator::Mkp, plane, vec![1.0; 55], 3.0, Sign::Positive)
        .unwrap()
        .with_after(
            &[CreepTerm {
                coefficient: 0.15,
                tau: 4.0,
            }],
            0.0,
        )
        .unwrap();
    let time: Vec<f64> = (0..4000).map(|n| 0.01 * f64::from(n)).collect();
    let wave = |t: &f64| 0.9 * (0.9 * t).sin() * (0.31 * t).cos();
    let input: Vec<f64> = time.iter().map(wave).collect();
    let around = Surroundings {
        time: Some(&time),
        load: None,
        rest: None,
    };
    let output = model.simulate_in(&input, around).unwrap();
    let mut recording = Recording::new(input, output).unwrap();
    recording.time = Some(time);
    recording
}

#[test]
fn creep_is_taken_where_there_is_some_and_left_where_there_is_none() {
    let recording = creeping();
    let fit = Fit::from(FitOptions::plain())
        .levels(10)
        .creep(Auto)
        .lag(Auto);
    let model = fit.run(&recording).unwrap();
    assert!(!model.creep().is_empty());
    let without = Fit::from(FitOptions::plain())
        .levels(10)
        .run(&recording)
        .unwrap();
    let error = |model: &Model| evaluate(model, &recording).unwrap().forward.rmse;
    let (with, none) = (error(&model), error(&without));
    assert!(
        with < 0.6 * none,
        "{with} {none} {:?} {}",
        model.creep(),
        model.lag()
    );
    let mut still = recording.clone();
    still.output = without.simulate(&still.input).unwrap();
    let none = fit.run(&still).unwrap();
    assert!(none.creep().is_empty() && none.lag() == 0.0);
}

#[test]
fn a_start_that_was_found_is_kept() {
    let plane = Plane::new(0.1, 1.0, 10).unwrap();
    let model = Model::new(Operator::Mkp, plane, vec![1.0; 55], 3.0, Sign::Positive).unwrap();
    // It begins in the middle, after 0.9 and 0.3.
    let input: Vec<f64> = (0..800)
        .map(|n| 0.5 + 0.5 * (f64::from(n) * 0.03).sin() * (f64::from(n) / 800.0))
        .collect();
    let mut state = model.off();
    let history = [0.9, 0.3, 0.5];
    model.run(&mut state, &history, &mut [0.0; 3]).unwrap();
    let mut output = vec![0.0; input.len()];
    model.run(&mut state, &input, &mut output).unwrap();
    let recording = Recording::new(input.clone(), output).unwrap();
    let fit = Fit::from(FitOptions::plain())
        .levels(10)
        .start(Start::Unknown);
    let found = fit.run(&recording).unwrap();
    let file = Model::from_json(&found.to_json()).unwrap();
    let error = |start| {
        let evaluation = evaluate_from(&file, &recording, start).unwrap();
        evaluation.forward.nrmse_percent.unwrap()
    };
    assert!(error(Start::Fitted) < 1.5, "{}", error(Start::Fitted));
    assert!(error(Start::Off) > 5.0);
    assert_eq!(
        file.simulate(&input).unwrap(),
        evaluate(&file, &recording).unwrap().output_model
    );
    let unknown = evaluate_from(&file, &recording, Start::Unknown).unwrap();
    assert!(unknown.estimated_from.is_some());
    let wrong = FittedStart {
        turning_points: vec![1.0, 9.0],
        input: 0.0,
    };
    assert!(file.with_start(Some(wrong)).is_err());
}

#[test]
fn the_noise_of_a_load_cell_is_not_another_load() {
    let fitted = [50.0, 100.0, 150.0].map(under_load);
    let fit = Fit::new().levels(8).bootstrap(0);
    // A hundredth of the range of 100 beyond an end is taken for that end.
    for (load, accepted) in [(49.01, true), (150.99, true), (48.9, false), (151.1, false)] {
        let others = HoldOut::Recordings(vec![under_load(load)]);
        let found = fit_holding_out(&fit, &fitted, &others);
        match found {
            Ok((_, held_out)) => {
                assert!(accepted, "{load}");
                let error = held_out.model.nrmse_percent.unwrap();
                assert!(error < 5.0, "{load}: {error}");
            }
            Err(error) => assert!(!accepted, "{load}: {error}"),
        }
    }
}

/// A model with an output curve, falling.
fn curved() -> Model {
    let plane = Plane::new(0.0, 1.0, 2).unwrap();
    let model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.5, Sign::Negative).unwrap();
    let knots = [
        ("curve_sums", vec![0.0, 1.0, 3.0]),
        ("curve_outputs", vec![0.0, 4.0, 5.0]),
    ];
    model.with_behind(knots).unwrap()
}

#[test]
fn a_file_of_version_3_has_the_stages_that_version_2_does_not_know() {
    let model = curved();
    let text = model.to_json();
    assert!(text.contains(r#""version":3"#) && text.contains(r#""curve_sums":[0.0,1.0,3.0]"#));
    assert_eq!(Model::from_json(&text).unwrap(), model);
    let constants = model.constants();
    assert_eq!(constants.get("curve_outputs"), [0.0, 4.0, 5.0]);
    assert_eq!(model.output_range(), (0.5, -4.5));
    for (from, to, said) in [
        (
            r#""version":3"#,
            r#""version":2"#,
            "field `stages`: this needs `version` 3",
        ),
        (
            "curve_sums",
            "none",
            "field `stages.none`: there is no such constant",
        ),
        (
            "curve_sums",
            "lag",
            "field `stages.lag`: there is no such constant",
        ),
        (
            "[0.0,1.0,3.0]",
            "[0.0,3.0,1.0]",
            "field `stages.curve_sums`",
        ),
        (
            "[0.0,4.0,5.0]",
            "[0.0,5.0,4.0]",
            "field `stages.curve_outputs`",
        ),
        ("[0.0,4.0,5.0]", "[0.0,5.0]", "field `stages.curve_sums`"),
    ] {
        assert!(text.contains(from), "{from}");
        let error = Model::from_json(&text.replace(from, to))
            .unwrap_err()
            .to_string();
        assert!(error.contains(said), "{from} -> {to}: {error}");
    }
}

#[test]
fn a_curve_is_taken_only_where_there_is_one() {
    let plane = Plane::new(0.1, 1.0, 10).unwrap();
    // Plays: weights that depend on the width alone.
    let weight = |i: usize, j: usize| {
        if j - i < 4 {
            0.1 / (1 + j - i) as f64
        } else {
            0.0
        }
    };
    let weights = (1..=10).flat_map(|j| (1..=j).map(move |i| weight(i, j)));
    let model = Model::new(Operator::Mkp, plane, weights.collect(), 0.5, Sign::Negative).unwrap();
    let input: Vec<f64> = (0..600)
        .map(|n| 0.5 - (0.5 - 0.0006 * f64::from(n)) * (f64::from(n) * 0.11).cos())
        .collect();
    let total: f64 = model.weights().iter().sum();
    let knots = |shares: [f64; 3]| shares.map(|share| share * total).to_vec();
    let bent = model.clone().with_behind([
        ("curve_sums", knots([0.0, 0.4, 1.0])),
        ("curve_outputs", knots([0.0, 0.2, 1.0])),
    ]);
    for (model, pieces) in [(model, 0), (bent.unwrap(), 1)] {
        let recording = Recording::new(input.clone(), model.simulate(&input).unwrap()).unwrap();
        let options = FitOptions {
            levels: 10,
            curve: Choice::Auto,
            ..FitOptions::plain()
        };
        let fitted = Fit::from(&options).run(&recording).unwrap();
        let found = fitted.constants().get("curve_sums").len();
        assert_eq!(found.min(1), pieces, "{found} knots");
        // The inverse of the chain meets its own outputs.
        let outputs = fitted.simulate(&input).unwrap();
        let mut state = fitted.start();
        let inverse = fitted.inverse().unwrap();
        for output in outputs {
            let found = inverse
                .step(&mut state, hysteron::Target::new(output))
                .unwrap();
            assert_eq!(found.status, hysteron::Status::Ok);
        }
        if pieces > 0 {
            let plain = Fit::from(FitOptions {
                curve: Choice::Fixed(0),
                ..options
            });
            let plain = plain.run(&recording).unwrap();
            // Loops that the fit did not see: of other sizes, about other middles.
            let other: Vec<f64> = (0..400)
                .map(|n| 0.45 + 0.3 * (f64::from(n) * 0.17).sin() * (f64::from(n) * 0.013).cos())
                .collect();
            let truth = model.simulate(&other).unwrap();
            let rmse = |found: &Model| {
                let outputs = found.simulate(&other).unwrap();
                let squares = outputs.iter().zip(&truth).map(|(a, b)| (a - b).powi(2));
                (squares.sum::<f64>() / truth.len() as f64).sqrt()
            };
            let (bent, plain) = (rmse(&fitted), rmse(&plain));
            assert!(bent < 0.5 * plain, "{bent} against {plain}");
        }
    }
}

#[test]
fn the_page_has_the_constants_that_stages_declare() {
    let page = include_str!("../../../../docs/constants.md");
    for stage in hysteron_core::Stages::<f64>::declared() {
        for constant in stage.constants {
            use hysteron_core::Unit;
            let unit = match constant.unit {
                Unit::One => "1",
                Unit::Second => "s",
                Unit::Hertz => "Hz",
                Unit::Temperature => "temperature",
                Unit::TemperaturePerDrive => "temperature per drive",
                Unit::Load => "load",
                Unit::Output => "output",
            };
            let row = format!(
                "| {} | `{}` | {unit} | {} | {} |",
                stage.name,
                constant.name,
                constant.range.words(),
                constant.meaning
            );
            assert!(page.contains(&row), "docs/constants.md has no row {row}");
        }
        let row = format!("| {} | ", stage.name);
        assert!(
            page.contains(&row),
            "docs/constants.md does not name {}",
            stage.name
        );
    }
}

/// A lag of half a sampling step to sixty of them is found, and the levels that are chosen are those
/// of the output before it: the model is as good as that of the same plant without a lag.
#[test]
fn a_lag_of_any_length_is_found() {
    let plane = Plane::new(-0.9, 1.0, 20).unwrap();
    let weights = (0..210).map(|n| f64::from(n % 7)).collect();
    let plant = Model::new(Operator::Mkp, plane, weights, 3.0, Sign::Positive).unwrap();
    let time: Vec<f64> = (0..3000).map(|n| 0.01 * f64::from(n)).collect();
    // From the bottom: a start in the middle is found before the lag, from an output that is late.
    let wave = |t: &f64| -(2.1 * t).cos() * (0.7 + 0.3 * (0.43 * t).cos());
    let input: Vec<f64> = time.iter().map(wave).collect();
    for lag in [0.0, 0.02, 0.1, 0.6] {
        let plant = plant.clone().with_after(&[], lag).unwrap();
        let around = Surroundings {
            time: Some(&time),
            load: None,
            rest: None,
        };
        let output = plant.simulate_in(&input, around).unwrap();
        let mut recording = Recording::new(input.clone(), output).unwrap();
        recording.time = Some(time.clone());
        // Asked for, and unasked. A lag of a fifth of the period is also a wider loop: unasked it need
        // not be found.
        let unasked = (lag < 0.6).then(Fit::new);
        for fit in [Fit::new().lag(Auto)].into_iter().chain(unasked) {
            let model = fit.bootstrap(0).run(&recording).unwrap();
            // A plane of other levels takes some of its width for a lag, or gives some.
            let found = model.lag();
            assert!((found - lag).abs() <= 0.1 * lag, "{found} for {lag}");
            assert!(model.delay().is_none(), "{lag}");
            let verdict = Verdict::of_fit(&model, &recording).unwrap();
            assert_eq!(verdict.grade, Grade::Good, "{lag}: {verdict}");
            assert_eq!(verdict.basis, Basis::BranchesLeftOut, "{lag}");
        }
    }
}
