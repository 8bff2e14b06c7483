//! Tests of all steps together.

use super::*;
use crate::prepare::test_series::two_rates;
use crate::series::test_series::gaussian;

fn with_noise(recording: &Recording, input: f64, output: f64) -> Recording {
    let add = |values: &[f64], sigma: f64, seed: u64| -> Vec<f64> {
        let noise = gaussian(seed, values.len());
        values
            .iter()
            .zip(noise)
            .map(|(v, e)| v + sigma * e)
            .collect()
    };
    Recording {
        input: add(&recording.input, input, 20),
        output: add(&recording.output, output, 21),
        ..recording.clone()
    }
}

#[test]
fn a_clean_recording_comes_through_unchanged() {
    let clean = two_rates(0.25);
    let (prepared, report) = prepare(&clean, &PrepareOptions::default(), Progress::NONE).unwrap();
    assert_eq!(prepared, clean);
    let low_pass = report.low_pass.unwrap();
    assert_eq!((low_pass.input, low_pass.output), (None, None));
    assert_eq!(report.dead_band.unwrap().samples_changed, 0);
    assert_eq!(report.resampled, None);
}

#[test]
fn switched_off_nothing_is_done() {
    let noisy = with_noise(&two_rates(0.25), 0.5, 0.5);
    let (prepared, report) =
        prepare(&noisy, &PrepareOptions::all(Step::Off), Progress::NONE).unwrap();
    assert_eq!(prepared, noisy);
    assert_eq!(
        (report.spikes, report.low_pass, report.lag, report.dead_band),
        (None, None, None, None)
    );
}

#[test]
fn noise_goes_and_its_reversals_with_it() {
    let truth = two_rates(0.25);
    let noisy = with_noise(&truth, 0.3, 0.3);
    let (prepared, _) = prepare(&noisy, &PrepareOptions::default(), Progress::NONE).unwrap();
    let error = |input: &[f64]| smooth::distance(input, &truth.input);
    // White noise over many samples per branch: the filter leaves only a fraction. Whether it is
    // taken for the input, the data decide; the dead band alone leaves less than there was.
    let cutoff = smooth::cutoff_for(&noisy.input, noise(&noisy.input)).unwrap();
    let filtered = low_pass(&noisy.input, 1.0, cutoff.unwrap()).unwrap();
    assert!(error(&filtered) < 0.5 * error(&noisy.input));
    assert!(error(&prepared.input) < 0.7 * error(&noisy.input));
    assert_eq!(
        band::reversals(&prepared.input),
        band::reversals(&truth.input)
    );
    assert!(band::reversals(&noisy.input) > 200);
    // A second preparation hardly changes the output. It may take a filter of the input: with less
    // noise, its gain is seen.
    let (again, _) = prepare(&prepared, &PrepareOptions::default(), Progress::NONE).unwrap();
    let first = smooth::distance(&noisy.output, &prepared.output);
    assert!(smooth::distance(&prepared.output, &again.output) <= 0.05 * first);
}

#[test]
fn irregular_time_is_resampled_only_for_a_filter() {
    let mut clean = two_rates(0.25);
    let last = clean.len() / 2;
    for time in &mut clean.time.as_mut().unwrap()[last..] {
        *time += 5.0;
    }
    let (prepared, report) = prepare(&clean, &PrepareOptions::default(), Progress::NONE).unwrap();
    assert_eq!((prepared.len(), report.resampled), (clean.len(), None));
    let noisy = with_noise(&clean, 0.3, 0.3);
    let asked = PrepareOptions {
        low_pass: Step::Value(0.5),
        ..PrepareOptions::default()
    };
    let (prepared, report) = prepare(&noisy, &asked, Progress::NONE).unwrap();
    assert_eq!(report.resampled, Some(0.25));
    assert_eq!(prepared.len(), clean.len() + 20);
}

#[test]
fn short_and_constant_recordings_come_through_unchanged() {
    for count in [1, 2, 5, 12] {
        for slope in [0.0, 1.0] {
            let line: Vec<f64> = (0..count).map(|n| f64::from(n) * slope).collect();
            let mut recording = Recording::new(line.clone(), line).unwrap();
            let (prepared, _) =
                prepare(&recording, &PrepareOptions::default(), Progress::NONE).unwrap();
            assert_eq!(prepared, recording);
            recording.time = Some(vec![3.0; recording.len()]);
            let (prepared, _) =
                prepare(&recording, &PrepareOptions::default(), Progress::NONE).unwrap();
            assert_eq!(prepared, recording);
            assert_eq!(rate_dependence(&recording).unwrap(), None);
        }
    }
}

#[test]
fn values_that_cannot_be_are_refused() {
    let recording = two_rates(0.25);
    let default = PrepareOptions::default();
    let bad = [
        PrepareOptions {
            spikes: Step::Value(0.0),
            ..default
        },
        PrepareOptions {
            dead_band: Step::Value(-1.0),
            ..default
        },
        PrepareOptions {
            lag: Step::Value(f64::NAN),
            ..default
        },
        PrepareOptions {
            resample: Step::Value(1e-12),
            ..default
        },
    ];
    for options in bad {
        let refused = prepare(&recording, &options, Progress::NONE);
        assert!(matches!(refused, Err(Error::Preparation(_))), "{options:?}");
    }
    let too_high = PrepareOptions {
        low_pass: Step::Value(2.0),
        ..default
    };
    assert!(matches!(
        prepare(&recording, &too_high, Progress::NONE),
        Err(Error::Filter(_))
    ));
    let timeless = Recording {
        time: None,
        ..recording
    };
    for options in [
        PrepareOptions {
            lag: Step::Auto,
            ..default
        },
        PrepareOptions {
            resample: Step::Value(1.0),
            ..default
        },
    ] {
        let refusal = prepare(&timeless, &options, Progress::NONE).unwrap_err();
        assert_eq!(refusal.code(), Error::Preparation(String::new()).code());
    }
}
