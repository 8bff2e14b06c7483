//! A thermal body and the weights behind it, from a drive whose temperature nobody measured.
#![allow(clippy::unwrap_used)]

use hysteron::{
    Columns, FirstOrder, FitOptions, Model, Operator, Plane, Recording, Repair, Sign, evaluate,
    fit, fit_thermal,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use std::path::Path;

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
    gain: 1.0,
    tau_heating: 3.0,
    tau_cooling: 6.0,
};

/// Weights by the distance from the diagonal: a band of hysteresis.
fn truth() -> Model {
    let plane = Plane::new(0.1, 1.0, 10).unwrap();
    let rows = (1..=10_i32).flat_map(|j| (1..=j).map(move |i| (i, j)));
    let weight = |(i, j): (i32, i32)| if j - i == 3 { 1.0 } else { 0.02 };
    let weights = rows.map(weight).collect();
    let mut model = Model::new(Operator::Mkp, plane, weights, -2.0, Sign::Positive).unwrap();
    model.thermal = Some(BODY);
    model
}

#[test]
fn a_known_body_is_found_again_through_noise() {
    let (time, input) = drive();
    let heated = BODY.respond(&time, &input).unwrap();
    let clean = truth().simulate(&heated).unwrap();
    let range = clean.iter().fold(0.0_f64, |m, y| m.max(y - clean[0]));
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let noise = Normal::new(0.0, 0.01 * range).unwrap();
    let output = clean.iter().map(|y| y + noise.sample(&mut rng)).collect();
    let mut recording = Recording::new(input, output).unwrap();
    recording.time = Some(time);
    let options = FitOptions {
        levels: 10,
        ..FitOptions::default()
    };
    let model = fit_thermal(&[recording.clone()], &options, &|_, _| Ok(())).unwrap();
    let body = model.thermal.unwrap();
    println!("{body:?}, {}", model.fit.as_ref().unwrap().nrmse_percent);
    // The output crosses its range within about a time constant, so noise of 1 % of it is 1 % of the time constant for
    // one sample, and far less for the hundreds on each flank. What is left is the grid of the weights.
    assert!((body.tau_heating / 3.0 - 1.0).abs() < 0.02, "{body:?}");
    assert!((body.tau_cooling / 6.0 - 1.0).abs() < 0.02, "{body:?}");
    assert_eq!(body.gain, 1.0);
    // Against the clean output, what 2600 samples leave of 1 % of noise in some 50 weights: √(50/2600) of it.
    recording.output = clean;
    let error = evaluate(&model, &recording).unwrap().forward;
    println!("{}", error.nrmse_percent.unwrap());
    assert!(error.nrmse_percent.unwrap() < 0.3);
}

#[test]
fn ramp_and_step_of_a_measured_wire_validate_each_other() {
    let read = |name: &str| {
        let folder = std::env::var("HYSTERON_DATA").unwrap_or("../../../shared/data".into());
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join(folder)
            .join(name);
        if !path.exists() {
            eprintln!("skipped: {} is not there", path.display());
            return None;
        }
        let columns = Columns {
            time: Some("time_s"),
            ..Columns::new("duty", "position_m")
        };
        Some(Recording::read(&path, columns, Repair::Refuse).unwrap().0)
    };
    let ramp = read("sma_baraghini_Ramp02.csv");
    let step = read("sma_baraghini_Step02.csv");
    let (Some(ramp), Some(step)) = (ramp, step) else {
        return;
    };
    for levels in [8, 10, 12, 15, 20, 30] {
        let options = FitOptions {
            levels,
            ..FitOptions::default()
        };
        for (fitted, held_out) in [(&ramp, &step), (&step, &ramp)] {
            let percent = |model: &Model| {
                let error = evaluate(model, held_out).unwrap().forward;
                error.nrmse_percent.unwrap()
            };
            let plain = percent(&fit(fitted, &options).unwrap());
            let started = std::time::Instant::now();
            let model =
                fit_thermal(std::slice::from_ref(fitted), &options, &|_, _| Ok(())).unwrap();
            println!(
                "K = {levels}: static {plain:.1}, thermal {:.1} % {:?} {:?} {:?} {:?}",
                percent(&model),
                model.thermal,
                model.fit.as_ref().unwrap().nrmse_percent,
                model.fit.as_ref().unwrap().other,
                started.elapsed()
            );
        }
        let model = fit_thermal(&[ramp.clone(), step.clone()], &options, &|_, _| Ok(())).unwrap();
        println!(
            "K = {levels}: both {:?} {:?} {:?}",
            model.thermal,
            model.fit.as_ref().unwrap().nrmse_percent,
            model.fit.as_ref().unwrap().other
        );
    }
}
