//! What a model file says of the files that its fit has seen.

use hysteron::{Fit, Model, Recording, Source, Start, evaluate, forward};

/// A play; recordings of other phases are other sessions.
fn recording(phase: f64, digest: &str) -> Recording {
    let mut y = 20.0_f64;
    let input: Vec<f64> = (0..400)
        .map(|n| 50.0 - 30.0 * (f64::from(n) * 0.05 + phase).cos())
        .collect();
    let output = input.iter().map(|x| {
        y = y.clamp(x - 5.0, x + 5.0);
        y
    });
    let output = output.collect();
    Recording {
        source: Some(Source::new(format!("{digest}.csv").into(), digest.into())),
        ..Recording::new(input, output).unwrap()
    }
}

/// Every file of a fit is known again, also from the model file, and no other.
#[test]
fn every_file_of_a_fit_is_known_again() {
    let all: Vec<Recording> = ["a", "b", "c", "d", "e", "f"]
        .iter()
        .zip(0..)
        .map(|(digest, n)| recording(0.3 * f64::from(n), digest))
        .collect();
    for fitted in 1..=3 {
        for repeats in 0..=2 {
            let fit = Fit::new().levels(6).smooth(1e-8).bootstrap(10);
            let fit = fit.start(Start::Off);
            let fit = fit.repeats(all[fitted..fitted + repeats].to_vec());
            let model = fit.run(&all[..fitted]).unwrap();
            let model = Model::from_json(&model.to_json()).unwrap();
            for (n, recording) in all.iter().enumerate() {
                let run = forward(&model, recording, Start::Unknown).unwrap();
                let judged = evaluate(&model, recording).unwrap();
                let band = (fitted..fitted + repeats).contains(&n);
                assert_eq!(run.was_fitted, n < fitted, "{n} of {fitted}");
                assert_eq!(run.seen_for_band, band, "{n} of {fitted}, {repeats}");
                assert_eq!(judged.was_fitted, run.was_fitted);
                assert_eq!(judged.seen_for_band, run.seen_for_band);
            }
            // The same samples without a file are unknown.
            let arrays = Recording {
                source: None,
                ..all[0].clone()
            };
            assert!(!forward(&model, &arrays, Start::Off).unwrap().was_fitted);
        }
    }
}

/// What was fitted says nothing of another session, whatever file it comes from.
#[test]
fn a_repeat_of_what_was_fitted_is_refused() {
    let one = recording(0.0, "a");
    let copy = Recording {
        source: None,
        ..one.clone()
    };
    let refused = Fit::new().levels(6).repeats(vec![copy]).run(&one);
    let said = refused.unwrap_err().to_string();
    assert!(said.contains("among those fitted"), "{said}");
}

/// Without a band there is nothing that repeats could have widened.
#[test]
fn repeats_count_only_where_there_is_a_band() {
    let (one, other) = (recording(0.0, "a"), recording(0.4, "b"));
    for (replicates, seen) in [(0, false), (10, true)] {
        let fit = Fit::new().levels(6).smooth(1e-8).bootstrap(replicates);
        let model = fit.repeats(vec![other.clone()]).run(&one).unwrap();
        let run = forward(&model, &other, Start::Unknown).unwrap();
        assert_eq!(run.seen_for_band, seen);
    }
}
