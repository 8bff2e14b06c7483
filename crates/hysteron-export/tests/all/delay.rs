//! Exported C delays its inputs as the library delays those of a series.

use crate::common::programs::has;
use crate::common::reference::Number;
use crate::common::{Exported, answers, same, walks};
use hysteron::{Delay, FirstOrder, Model, Operator, Plane, Sign, Surroundings};
use hysteron_export::{COptions, CReal, CSampling, c_sampled};
use rand::RngExt;
use std::path::Path;
use std::process::Command;

const DT: f64 = 0.0625;

/// Exports a model as `late`, and compares its program with the library.
fn compare(model: &Model, sampling: &CSampling, flags: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let options = COptions {
        real: CReal::Double,
        name: Some("late"),
        source: Path::new("late.json"),
        adaptation: false,
    };
    let made = c_sampled(model, folder.path(), &options, sampling).unwrap();
    let sources = made.files.into_iter();
    let sources = sources.filter(|file| file.extension().unwrap() == "c");
    let exported = Exported::of(folder, CReal::Double, sources.clone().collect());
    let program = exported.compile("cc", flags, "delay.c");
    let mut rng = walks::rng(5);
    let input: Vec<f64> = (0..200).map(|_| rng.random_range(0.0..1.0)).collect();
    let time: Vec<f64> = (0..200).map(|n| DT * f64::from(n)).collect();
    let around = Surroundings {
        time: sampling.dt.map(|_| &time[..]),
        load: None,
        rest: None,
    };
    let expected = model.simulate_in(&input, around).unwrap();
    let (mut commands, mut answered) = (String::new(), String::new());
    for (n, (input, output)) in input.iter().zip(expected).enumerate() {
        if n % 9 == 4 {
            // What is refused delays nothing.
            commands += &format!("{}\n", f64::NAN.hex());
            answered += "7 0\n";
        }
        commands += &format!("{}\n", input.hex());
        answered += &format!("0 {}\n", output.hex());
    }
    let found = answers(&mut Command::new(program), &commands);
    same(
        &commands,
        &answered,
        &found,
        &format!("{:?}", model.delay()),
    );
}

#[test]
fn inputs_act_after_the_dead_time() {
    if !has("cc") {
        return;
    }
    let plane = Plane::new(0.125, 1.0, 5).unwrap();
    let weights: Vec<f64> = (0..15).map(|n| f64::from(1 + n % 4) / 8.0).collect();
    let model = Model::new(Operator::Mkp, plane, weights.clone(), 0.5, Sign::Positive).unwrap();
    for samples in [1, 2, 9, 250] {
        let delay = Delay::new(samples, DT).unwrap();
        let late = model.clone().with_delay(delay);
        compare(&late, &CSampling::default(), &["-O2"]);
        // On a clock of its own, the same time.
        let plane = Plane::new(30.0, 90.0, 5).unwrap();
        let mut body =
            Model::new(Operator::Kp, plane, weights.clone(), 0.5, Sign::Negative).unwrap();
        body.thermal = Some(FirstOrder {
            gain: 100.0,
            ..FirstOrder::default()
        });
        let body = body.with_delay(Delay::new(samples, 2.0 * DT).unwrap());
        let sampling = CSampling {
            dt: Some(DT),
            drive: None,
            ..CSampling::default()
        };
        compare(&body, &sampling, &["-O2", "-DSTAGED"]);
    }
}

#[test]
fn without_a_dead_time_nothing_more_is_written() {
    let plane = Plane::new(0.0, 1.0, 2).unwrap();
    let model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive).unwrap();
    let options = COptions {
        real: CReal::Float,
        name: None,
        source: Path::new("late.json"),
        adaptation: false,
    };
    let names = |model: &Model| {
        let folder = tempfile::tempdir().unwrap();
        let made = c_sampled(model, folder.path(), &options, &CSampling::default()).unwrap();
        let names = made.files.iter().map(|file| file.display().to_string());
        names.filter(|name| name.contains("delay")).count()
    };
    assert_eq!(names(&model), 0);
    assert_eq!(names(&model.with_delay(Delay::new(1, 1.0).unwrap())), 2);
}
