//! The lag of a simulated sensor is found in its recording.

use hysteron::{Errors, PrepareOptions, Progress, Recording, Step, prepare};
use hysteron_sim::rig::Experiment;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// What a first-order sensor reads that starts settled: exact for a truth that is linear between
/// samples.
fn behind_sensor(truth: &[f64], step: f64, tau: f64) -> Vec<f64> {
    let keep = (-step / tau).exp();
    let (mut last, mut lagging) = (truth[0], truth[0]);
    let readings = truth.iter().map(|&x| {
        let slope = (x - last) / step;
        lagging = x - slope * tau + (lagging - last + slope * tau) * keep;
        last = x;
        lagging
    });
    readings.collect()
}

fn with_noise(recording: &Recording, input: f64, output: f64) -> Recording {
    let add = |values: &[f64], sigma: f64, seed: u64| -> Vec<f64> {
        let noise = StandardNormal.sample_iter(ChaCha8Rng::seed_from_u64(seed));
        let pairs = values.iter().zip(noise);
        pairs.map(|(v, e): (&f64, f64)| v + sigma * e).collect()
    };
    Recording {
        input: add(&recording.input, input, 20),
        output: add(&recording.output, output, 21),
        ..recording.clone()
    }
}

/// The thermocouple of the simulated spring, 1.5 s behind, found and undone from a noisy recording.
/// At one current the lag only widens the loops, which a static model can too; so the spring is
/// heated faster as well.
#[test]
fn the_lag_of_the_rigs_thermocouple_is_found() {
    let mut truth: Option<Recording> = None;
    for current_a in [2.0, 3.0] {
        let experiment = Experiment {
            sample_interval_s: 0.1,
            current_a,
            ..Experiment::default()
        };
        let run = experiment.truth().unwrap();
        let Some(all) = &mut truth else {
            truth = Some(run);
            continue;
        };
        all.input.extend(run.input);
        all.output.extend(run.output);
        all.time = Some((0..all.input.len()).map(|n| n as f64 * 0.1).collect());
    }
    let (truth, tau) = (truth.unwrap(), 1.5);
    let lagging = Recording {
        input: behind_sensor(&truth.input, 0.1, tau),
        ..truth.clone()
    };
    let noisy = with_noise(&lagging, 0.1, 0.02);
    let options = PrepareOptions {
        lag: Step::Auto,
        ..PrepareOptions::default()
    };
    let (prepared, report) = prepare(&noisy, &options, Progress::NONE).unwrap();
    let lag = report.lag.unwrap();
    println!("{lag:?}");
    let found = lag.undone.unwrap();
    // Corners of the input that low-pass and derivative have rounded.
    assert!((found / tau - 1.0).abs() < 0.25, "{found}");
    let error = |r: &Recording| {
        Errors::between(&truth.input, &r.input, |_| true)
            .unwrap()
            .rmse
    };
    assert!(
        error(&prepared) < 0.3 * error(&noisy),
        "{} {}",
        error(&prepared),
        error(&noisy)
    );
}
