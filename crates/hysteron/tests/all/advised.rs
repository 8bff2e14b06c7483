//! What is advised is what is then done.

use hysteron::{Advice, PrepareOptions, Progress, Recording, Step, advice_before_fit, prepare};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Loops of a play with pulses of the input, which the output follows or not.
fn pulsed(rng: &mut ChaCha8Rng, follows: bool) -> Recording {
    let mut input = vec![0.0];
    for k in 0..12 {
        let from = *input.last().unwrap();
        let to = rng.random_range(if k % 2 == 0 { 30.0..60.0 } else { 0.0..20.0 });
        input.extend((1..=60).map(|n| from + (to - from) * f64::from(n) / 60.0));
    }
    let mut read = input.clone();
    for _ in 0..8 {
        let at = rng.random_range(10..input.len() - 10);
        let by = rng.random_range(15.0..40.0);
        read[at] += by;
        read[at + 1] += by;
    }
    let acting = if follows { &read } else { &input };
    let play = |y: &mut f64, x: &f64| {
        *y = y.clamp(x - 3.0, x + 3.0);
        Some(*y)
    };
    let noise = |y: f64| y + 0.02 * rng.random_range(-1.0..1.0);
    let output = acting.iter().scan(0.0, play).map(noise).collect();
    Recording::new(read, output).unwrap()
}

#[test]
fn preparation_is_advised_where_it_replaces_readings() {
    let options = PrepareOptions {
        spikes: Step::Auto,
        believe: true,
        ..PrepareOptions::all(Step::Off)
    };
    let (mut replaced_some, mut left_some) = (0, 0);
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let recording = pulsed(&mut rng, seed % 2 == 0);
        let (prepared, _) = prepare(&recording, &options, Progress::NONE).unwrap();
        for advice in advice_before_fit(std::slice::from_ref(&recording)) {
            let Advice::Spikes { ref series, .. } = advice else {
                continue;
            };
            let changes = match series == "input" {
                true => prepared.input != recording.input,
                false => prepared.output != recording.output,
            };
            let said = advice.remedy().to_string();
            assert_eq!(said.contains("`prepare`"), changes, "seed {seed}: {said}");
            replaced_some += i32::from(changes);
            left_some += i32::from(!changes);
        }
    }
    assert!(
        replaced_some > 4 && left_some > 4,
        "{replaced_some} {left_some}"
    );
}
