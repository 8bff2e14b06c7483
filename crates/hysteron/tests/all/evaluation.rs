//! An evaluation for its errors alone says what the whole one says.

use hysteron::{Evaluation, Fit, Operator, Recording, Start, evaluate_errors, evaluate_from};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The evaluation without its series.
fn errors_of(mut whole: Evaluation) -> Evaluation {
    whole.output_model = Vec::new();
    if let Some(band) = &mut whole.band {
        band.half_width = Vec::new();
    }
    if let Ok(inverse) = &mut whole.inverse {
        inverse.hold.input_model = Vec::new();
        inverse.anticipate.input_model = Vec::new();
    }
    whole
}

#[test]
fn errors_alone_are_those_of_the_whole_evaluation() {
    for seed in 0..12 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut input = 0.0_f64;
        let (mut play, mut speed) = (0.0_f64, 1.0);
        let samples = (0..400).map(|_| {
            if rng.random_bool(0.05) {
                speed = -speed;
            }
            input = (input + speed * rng.random_range(0.0..3.0)).clamp(0.0, 60.0);
            play = play.clamp(input - 8.0, input);
            (input, 0.2 * play + rng.random_range(-0.01..0.01))
        });
        let (input, output) = samples.unzip();
        let recording = Recording::new(input, output).unwrap();
        let operators = [Operator::Mkp, Operator::Kp, Operator::Relay];
        let fit = Fit::new()
            .operator(operators[seed as usize % 3])
            .levels(10)
            .smooth(1e-4)
            .bootstrap(if seed % 2 == 0 { 20 } else { 0 });
        let model = fit.run(&recording).unwrap();
        for start in [Start::Fitted, Start::Off, Start::On, Start::Unknown] {
            let whole = evaluate_from(&model, &recording, start).unwrap();
            assert_eq!(whole.output_model.len(), recording.len());
            let errors = evaluate_errors(&model, &recording, start).unwrap();
            assert_eq!(errors, errors_of(whole), "seed {seed}, {start:?}");
        }
    }
}
