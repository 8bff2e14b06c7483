//! A learner in the shadow of the fixed model, in C: it is used where it is better, and does no harm.

use crate::common::here;
use crate::common::programs::run;
use hysteron::control::{Gains, Scheme};
use hysteron::{Model, Operator, Plane, Sign};
use hysteron_core::operator_count;
use hysteron_export::{COptions, CReal, CSampling, c_controlled};
use std::path::Path;
use std::process::Command;

struct Sample {
    wanted: f64,
    output: f64,
    reading: f32,
    predicted: f32,
    squares: (f32, f32),
    learner: bool,
}

fn build(folder: &Path) {
    let plane = Plane::new(0.0, 1.0, 8).unwrap();
    let count = operator_count(8);
    let weights = (0..count).map(|n| 16.0 / count as f64 * ((n * 7) % 11) as f64 / 11.0);
    let model = Model::new(Operator::Mkp, plane, weights.collect(), 1.0, Sign::Positive).unwrap();
    let gains = Gains {
        gain: 0.01,
        integral_s: 0.3,
        derivative_s: 0.0,
    };
    let scheme = Scheme {
        pid: Some(gains),
        ..Scheme::new(0.05, (0.0, 1.0))
    };
    let options = COptions {
        real: CReal::Float,
        name: None,
        source: Path::new("wire.json"),
        adaptation: true,
    };
    let sampling = CSampling::default();
    let made = c_controlled(&model, folder, &options, &sampling, &scheme).unwrap();
    let sources = made.files.iter();
    let sources = sources.filter(|file| file.extension().is_some_and(|end| end == "c"));
    let mut command = Command::new("cc");
    command
        .args(["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-I."])
        .arg(here("tests/mcu/shadow.c"))
        .args(sources)
        .args(["-o", "shadow"])
        .current_dir(folder);
    run(&mut command);
}

fn samples(folder: &Path, gain: &str, mode: &str, noise: &str) -> Vec<Sample> {
    let mut command = Command::new(folder.join("shadow"));
    let output = command.args([gain, mode, noise]).output().unwrap();
    assert!(output.status.success(), "{gain} {mode}: {}", output.status);
    let text = String::from_utf8(output.stdout).unwrap();
    let sample = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        let double = |n: usize| words[n].parse::<f64>().unwrap();
        let single = |n: usize| words[n].parse::<f32>().unwrap();
        assert_ne!(
            words[6], "9",
            "the inverse has another model than was chosen"
        );
        Sample {
            wanted: double(0),
            output: double(1),
            reading: single(2),
            predicted: single(3),
            squares: (single(4), single(5)),
            learner: words[6] == "1",
        }
    };
    text.lines().map(sample).collect()
}

/// The RMSE of the last third.
fn error(samples: &[Sample]) -> f64 {
    let last = &samples[2 * samples.len() / 3..];
    let squares = last.iter().map(|s| (s.wanted - s.output).powi(2));
    (squares.sum::<f64>() / last.len() as f64).sqrt()
}

#[test]
fn the_choice_is_that_of_the_library() {
    let folder = tempfile::tempdir().unwrap();
    build(folder.path());
    for (gain, noise) in [("1.2", "0.02"), ("1.0", "0.02"), ("1.0", "1.5")] {
        let (mut fixed, mut count, mut learner) = (0f32, 0, false);
        let mut before = (0.0, 0.0);
        let mut switches = 0;
        for sample in samples(folder.path(), gain, "s", noise) {
            // What is not learned from does not count.
            if sample.squares != before {
                before = sample.squares;
                count += 1;
                let error = sample.reading - sample.predicted;
                fixed = 0.99 * fixed + (1.0 - 0.99) * error * error;
                assert_eq!(sample.squares.0, fixed);
                let (one, other) = sample.squares;
                let chosen = match learner {
                    true => one >= 0.8 * other,
                    false => count >= 30 && other < 0.8 * one,
                };
                switches += usize::from(chosen != learner);
                learner = chosen;
            }
            assert_eq!(sample.learner, learner);
        }
        assert!(count > 1000, "{count}");
        // A model that is right leaves nothing to gain.
        assert_eq!(switches > 0, gain == "1.2", "{gain}, {noise}: {switches}");
    }
}

#[test]
fn a_learner_gains_where_the_plant_changed_and_does_no_harm_where_it_errs() {
    let folder = tempfile::tempdir().unwrap();
    build(folder.path());
    let errors =
        |gain, noise| ["f", "s", "l"].map(|mode| error(&samples(folder.path(), gain, mode, noise)));
    for gain in ["0.8", "1.2"] {
        let [fixed, shadow, alone] = errors(gain, "0.02");
        assert!(shadow < 0.6 * fixed, "{gain}: {fixed} {shadow} {alone}");
    }
    let [fixed, shadow, _] = errors("1.0", "0.02");
    assert!(shadow < 1.05 * fixed, "{fixed} {shadow}");
    // Its own guards are off, and the noise is a fifth of the stroke.
    let [fixed, shadow, alone] = errors("1.0", "1.5");
    assert!(
        alone > 1.3 * fixed && shadow < 1.1 * fixed,
        "{fixed} {shadow} {alone}"
    );
}
