//! A thermal body and the weights behind it, from a drive whose temperature nobody measured.

use crate::common::shared;
use hysteron::{
    Columns, Error, FirstOrder, Fit, FitOptions, Model, Operator, Plane, Progress, Recording,
    Repair, Sign, evaluate, operators,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};

/// Ramps and steps of different height: a drive that tells heating and cooling apart.
fn drive() -> (Vec<f64>, Vec<f64>) {
    let height = |t: f64| match t {
        t if t < 5.0 => 0.0,
        t if t < 65.0 => (t - 5.0) / 60.0,
        t if t < 125.0 => (125.0 - t) / 60.0,
        t if t < 140.0 => 0.0,
        t => [1.0, 0.0, 0.7, 0.3, 0.9, 0.15, 0.6, 0.0][((t - 140.0) / 15.0) as usize],
    };
    let time: Vec<f64> = (0..2600).map(|n| 0.1 * f64::from(n)).collect();
    let drive = time.iter().map(|t| height(*t)).collect();
    (time, drive)
}

const BODY: FirstOrder = FirstOrder {
    ambient: 0.0,
    gain: 1.0,
    tau_heating: 3.0,
    tau_cooling: 6.0,
};

/// Weights by the distance from the diagonal: a band of hysteresis.
fn truth() -> Model {
    let plane = Plane::new(0.1, 1.0, 10).unwrap();
    let weight = |(i, j): (usize, usize)| if j - i == 3 { 1.0 } else { 0.02 };
    let weights = operators(10).map(weight).collect();
    let mut model = Model::new(Operator::Mkp, plane, weights, -2.0, Sign::Positive).unwrap();
    model.thermal = Some(BODY);
    model
}

/// The first `samples` of the drive and what the model makes of them, with noise of 1 % of the
/// range; and without.
fn recorded(samples: usize) -> (Recording, Vec<f64>) {
    let (time, input) = drive();
    let (time, input) = (time[..samples].to_vec(), input[..samples].to_vec());
    let clean = truth()
        .operators()
        .simulate(&BODY.respond(&time, &input).unwrap())
        .unwrap();
    let range = clean.iter().copied().fold(f64::MIN, f64::max) - clean[0]; // it starts lowest
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let noise = Normal::new(0.0, 0.01 * range).unwrap();
    let output = clean.iter().map(|y| y + noise.sample(&mut rng)).collect();
    let mut recording = Recording::new(input, output).unwrap();
    recording.time = Some(time);
    (recording, clean)
}

#[test]
fn a_known_body_is_found_again_through_noise() {
    let (mut recording, clean) = recorded(2600);
    let options = FitOptions {
        levels: 10,
        ..FitOptions::plain()
    };
    let model = Fit::from(&options)
        .thermal(true)
        .run(&[recording.clone()])
        .unwrap();
    let body = model.thermal.unwrap();
    println!("{body:?}, {}", model.fit.as_ref().unwrap().nrmse_percent);
    // The output crosses its range within about a time constant, so noise of 1 % of it is 1 % of
    // the time constant for one sample, and far less for the hundreds on each flank. What is left
    // is the grid of the weights.
    assert!((body.tau_heating / 3.0 - 1.0).abs() < 0.02, "{body:?}");
    assert!((body.tau_cooling / 6.0 - 1.0).abs() < 0.02, "{body:?}");
    assert_eq!(body.gain, 1.0);
    // Against the clean output, what 2600 samples leave of 1 % of noise in some 50 weights:
    // √(50/2600) of it.
    recording.output = clean;
    let error = evaluate(&model, &recording).unwrap().forward;
    println!("{}", error.nrmse_percent.unwrap());
    assert!(error.nrmse_percent.unwrap() < 0.3);
}

#[test]
fn ramp_and_step_of_a_measured_wire_validate_each_other() {
    let names = ["sma_baraghini_Ramp02.csv", "sma_baraghini_Step02.csv"];
    let [Some(ramp), Some(step)] = shared(names) else {
        return;
    };
    let [ramp, step] = [ramp, step].map(|path| {
        let columns = Columns {
            time: Some("time_s"),
            ..Columns::new("duty", "position_m")
        };
        Recording::read(&path, columns, Repair::Refuse).unwrap().0
    });
    let options = FitOptions::plain();
    // Fitted on the other one, the static model errs by 39 % and 32 % of the range.
    for (fitted, held_out) in [(&ramp, &step), (&step, &ramp)] {
        let percent = |model: &Model| {
            let error = evaluate(model, held_out).unwrap().forward;
            error.nrmse_percent.unwrap()
        };
        let plain = percent(&Fit::from(&options).run(fitted).unwrap());
        let model = Fit::from(&options)
            .thermal(true)
            .run(std::slice::from_ref(fitted))
            .unwrap();
        let heated = percent(&model);
        println!(
            "held out: static {plain:.2} %, {heated:.2} % with {:?}",
            model.thermal
        );
        // With 8 to 30 levels the factor was 3.7 to 5.5.
        assert!(heated < plain / 3.0);
    }
    let both = [ramp, step];
    let model = Fit::from(&options).thermal(true).run(&both).unwrap();
    let body = model.thermal.unwrap();
    let percent = model.fit.as_ref().unwrap().nrmse_percent;
    println!("both fitted: {percent:.2} % with {body:?}");
    // Ramp and step together tell heating and cooling apart, and one body serves both about as well
    // as each its own (1 %).
    assert!(body.tau_heating > 1.2 * body.tau_cooling && percent < 2.0);
}

#[test]
fn one_loop_does_not_tell_heating_from_cooling_and_says_so() {
    let (recording, _) = recorded(1400); // the ramp up and down
    let options = FitOptions {
        levels: 10,
        ..FitOptions::plain()
    };
    let model = Fit::from(&options).thermal(true).run(&[recording]).unwrap();
    let body = model.thermal.unwrap();
    println!("{body:?}, {:?}", model.fit.as_ref().unwrap().nrmse_percent);
    assert_eq!(body.tau_heating, body.tau_cooling);
    assert_eq!(model.fit.unwrap().other["thermal"]["told_apart"], false);
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let recording = Recording::new(vec![0.0, 1.0, 0.0], vec![0.0, 1.0, 0.5]).unwrap();
    let fault = |recording: &Recording| {
        let fitted = Fit::from(&FitOptions::plain())
            .thermal(true)
            .run(std::slice::from_ref(recording));
        fitted.unwrap_err().to_string()
    };
    assert!(fault(&recording).contains("depends on time"));
    let still = Recording {
        time: Some(vec![3.0; 3]),
        ..recording
    };
    assert!(fault(&still).contains("time does not pass"));
}

#[test]
fn the_file_keeps_the_body_and_refuses_one_that_cannot_be() {
    let model = truth();
    let text = model.to_json();
    assert_eq!(Model::from_json(&text).unwrap(), model);
    let body = r#""thermal":{"kind":"first-order","gain":1.0,"tau_heating":3.0,"tau_cooling":6.0}"#;
    assert!(text.contains(body), "{text}");
    for (from, to, fault) in [
        (
            "\"tau_heating\":3.0",
            "\"tau_heating\":0",
            "`thermal.tau_heating`: 0 is not",
        ),
        (
            "\"tau_cooling\":6.0",
            "\"tau_cooling\":-1",
            "`thermal.tau_cooling`: -1 is not",
        ),
        ("\"gain\":1.0,", "", "missing field `gain`"),
        (
            "first-order",
            "second-order",
            "unknown variant `second-order`",
        ),
        (
            "\"gain\":1.0",
            "\"gain\":1.0,\"delay\":1",
            "unknown field `delay`",
        ),
    ] {
        let error = Model::from_json(&text.replace(from, to))
            .unwrap_err()
            .to_string();
        assert!(error.contains(fault), "{error}");
    }
}

#[test]
fn a_body_needs_time() {
    let model = truth();
    let mut recording = Recording::new(vec![0.0, 1.0, 1.0], vec![0.0, 1.0, 2.0]).unwrap();
    assert!(
        evaluate(&model, &recording)
            .unwrap_err()
            .to_string()
            .contains("depends on time")
    );
    recording.time = Some(vec![0.0, 1.0, 5.0]);
    let evaluation = evaluate(&model, &recording).unwrap();
    // The inverse is compared with the temperature behind the body.
    assert!(evaluation.inverse.is_ok());
    // The drive of a sample is the one held since the sample before: at 1 s the body has warmed for
    // 1 s, at 5 s for 5 s.
    let after = |seconds: f64| 1.0 - (-seconds / 3.0).exp();
    let warmed = model
        .operators()
        .simulate(&[0.0, after(1.0), after(5.0)])
        .unwrap();
    let pairs = evaluation.output_model.iter().zip(&warmed);
    // Some roundings of numbers up to 4.
    assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-14));
}

/// The search looks at few samples of a long recording. A drive that turns often must not lose its
/// turning points there.
#[test]
fn a_long_recording_of_a_fast_drive_keeps_its_turning_points() {
    let time: Vec<f64> = (0..30_000).map(|n| 0.1 * f64::from(n)).collect();
    // Steps of 3 s up and 2 s down to one height after the other: 50 samples a period, where one of
    // 15 is looked at.
    let heights = [1.0, 0.4, 0.8, 0.6, 0.9];
    let height = |t: &f64| {
        if t % 5.0 < 3.0 {
            heights[(t / 5.0) as usize % 5]
        } else {
            0.0
        }
    };
    let input: Vec<f64> = time.iter().map(height).collect();
    let body = FirstOrder {
        ambient: 0.0,
        gain: 1.0,
        tau_heating: 1.0,
        tau_cooling: 2.0,
    };
    let mut model = truth();
    model.thermal = Some(body);
    let output = model
        .operators()
        .simulate(&body.respond(&time, &input).unwrap())
        .unwrap();
    let mut recording = Recording::new(input, output).unwrap();
    recording.time = Some(time);
    let options = FitOptions {
        levels: 10,
        ..FitOptions::plain()
    };
    let found = Fit::from(&options).thermal(true).run(&[recording]).unwrap();
    let body = found.thermal.unwrap();
    println!("{body:?}");
    // Exact data; what is left is that the plane found is not that of the truth.
    assert!((body.tau_heating / 1.0 - 1.0).abs() < 0.1, "{body:?}");
    assert!((body.tau_cooling / 2.0 - 1.0).abs() < 0.1, "{body:?}");
    assert!(found.fit.unwrap().nrmse_percent < 1.0);
}

#[test]
fn a_model_at_one_load_keeps_its_body() {
    let (recording, _) = recorded(2600);
    let mut heavy = recording.clone();
    heavy.output.iter_mut().for_each(|y| *y *= 1.3);
    let loads = [recording, heavy].into_iter().zip([6.0, 10.0]);
    let recordings: Vec<Recording> = loads
        .map(|(mut recording, load)| {
            recording.load = Some(vec![load; recording.len()]);
            recording
        })
        .collect();
    let options = FitOptions {
        levels: 6,
        ..FitOptions::plain()
    };
    let model = Fit::from(&options).thermal(true).run(&recordings).unwrap();
    let light = model.at_load(6.0).unwrap();
    assert!(light.thermal.is_some() && light.thermal == model.thermal);
    assert!(light.inverse().is_ok());
}

/// Where nothing moves there is no heat to find, and the fit is that of a body alone.
#[test]
fn a_still_output_binds_no_heat() {
    let (time, drive) = drive();
    let mut recording = Recording::new(drive, vec![1.5; time.len()]).unwrap();
    recording.time = Some(time);
    let run = |fit: Fit<'_>| {
        fit.run(std::slice::from_ref(&recording))
            .map(|m| m.to_json())
    };
    let fit = Fit::from(FitOptions::plain());
    let auto = run(fit.clone().thermal(hysteron::Auto));
    assert_eq!(auto.ok(), run(fit.thermal(true)).ok());
}

/// A model file keeps the heat that is bound, and refuses it where nothing can bind it.
#[test]
fn heat_that_is_bound_is_in_the_file() {
    let plane = Plane::new(1.0, 2.0, 2).unwrap();
    let model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive).unwrap();
    let mut heated = model.clone();
    heated.thermal = Some(BODY);
    let bound = heated.clone().with_latent(3.0).unwrap();
    let again = Model::from_json(&bound.to_json()).unwrap();
    assert_eq!(again, bound);
    assert_eq!(again.latent(), 3.0);
    assert_eq!(bound.constants().get("latent"), [3.0]);
    assert_eq!(bound.without_body().latent(), 0.0);
    let (time, drive) = ([0.0, 1.0, 2.0, 3.0], [0.0, 5.0, 5.0, 0.0]);
    let mut recording = Recording::new(drive.to_vec(), vec![0.0; 4]).unwrap();
    recording.time = Some(time.to_vec());
    let [slow, fast] = [&bound, &heated].map(|m| m.behind_body(&recording).unwrap().into_owned());
    assert!(slow.input[1] < fast.input[1] && slow.input[0] == fast.input[0]);

    assert!(heated.clone().with_latent(-1.0).is_err());
    assert!(heated.with_latent(f64::NAN).is_err());
    assert!(model.with_latent(3.0).is_err());
    let several = bound
        .to_json()
        .replace(r#""latent":[3.0]"#, r#""latent":[3.0,1.0]"#);
    assert!(Model::from_json(&several).is_err());
}

/// Where nothing heats, nobody finds a body: the output comes late by a lag or a dead time, or the
/// body is so fast that its rows cannot show it.
#[test]
fn what_does_not_heat_gets_no_body() {
    let (time, input) = drive();
    let model = truth().without_body();
    let clean = model.simulate(&input).unwrap();
    for seed in 0..6_u64 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let noise = Normal::new(0.0, 0.5).unwrap(); // of a range of some 10
        let mut held = clean[0];
        let late: Vec<f64> = match seed % 3 {
            0 => clean
                .iter()
                .map(|y| {
                    held += 0.05 * (y - held);
                    held
                })
                .collect(),
            1 => (0..clean.len())
                .map(|n| clean[n.saturating_sub(20)])
                .collect(),
            _ => {
                let fast = FirstOrder {
                    tau_heating: 0.05,
                    tau_cooling: 0.05,
                    ..BODY
                };
                let seen = fast.respond(&time, &input).unwrap();
                model.simulate(&seen).unwrap()
            }
        };
        let output = late.iter().map(|y| y + noise.sample(&mut rng)).collect();
        let mut recording = Recording::new(input.clone(), output).unwrap();
        recording.time = Some(time.clone());
        let found = Fit::new().bootstrap(0).run(&recording).unwrap();
        let fit = found.fit.as_ref().unwrap();
        let left_out = fit.validation.as_ref().unwrap().nrmse_percent;
        println!(
            "{seed}: {left_out:.2} %, {:?} {:?}",
            found.thermal,
            found.delay()
        );
        // A body is looked for from 1 % on.
        assert!(
            left_out > 1.0 && found.thermal.is_none(),
            "{seed}: {left_out}"
        );
    }
}

/// An end that the callback asks for ends the fit, also while a body is looked for.
#[test]
fn a_fit_that_is_ended_while_it_looks_for_a_body_is_no_cold_one() {
    let (recording, _) = recorded(2600);
    let end = |what: &'static str, _: f64| match what {
        "time constants" => Err(Error::Fit("that is enough".into())),
        _ => Ok(()),
    };
    let ended = Fit::new().progress(Progress::new(&end)).run(&recording);
    let text = ended.unwrap_err().to_string();
    assert!(text.contains("that is enough"), "{text}");
}
