//! A ring that a fit finds: on a simulated plant of its own, on recordings that do not excite one,
//! and on a measured valve.

use crate::common::shared;
use hysteron::{
    Columns, Dynamics, Fit, Model, Policy, Recording, Repair, Start, Status, Surroundings,
    evaluate_from,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::PathBuf;

const DT: f64 = 1e-4;

/// A simulated piezo stage: plays with many thresholds in front of a mass on a spring, whose
/// differential equation is solved in small steps, and a sensor with noise. It shares nothing with
/// the models.
struct Plant {
    noise: f64,
    random: ChaCha8Rng,
    /// Position and velocity of the mass, and the plays.
    at: [f64; 2],
    plays: [f64; 24],
}

/// Frequency in Hz and damping of the plant.
const RESONANCE: [f64; 2] = [640.0, 0.04];

impl Plant {
    fn new(noise: f64) -> Self {
        Self {
            noise,
            random: ChaCha8Rng::seed_from_u64(3),
            at: [0.0; 2],
            plays: [0.0; 24],
        }
    }

    /// The reading at the end of a sample in which the input was held.
    fn step(&mut self, input: f64) -> f64 {
        const PARTS: usize = 40;
        for (n, play) in (1..).zip(&mut self.plays) {
            let half = 0.12 * f64::from(n);
            *play = (input - half).max(play.min(input + half));
        }
        let force = 0.4 * input + 0.025 * self.plays.iter().sum::<f64>();
        let [mut y, mut v] = self.at;
        let omega = std::f64::consts::TAU * RESONANCE[0];
        let bend = |y: f64, v: f64| omega * omega * (force - y) - 2.0 * RESONANCE[1] * omega * v;
        let dt = DT / PARTS as f64;
        for _ in 0..PARTS {
            // The midpoint rule.
            let (ym, vm) = (y + 0.5 * dt * v, v + 0.5 * dt * bend(y, v));
            (y, v) = (y + dt * vm, v + dt * bend(ym, vm));
        }
        self.at = [y, v];
        // About normal: the sum of twelve uniform numbers.
        let sum: f64 = (0..12).map(|_| self.random.random_range(-0.5..0.5)).sum();
        y + self.noise * sum
    }

    /// The readings for inputs, from rest at the first one.
    fn run(&mut self, inputs: &[f64]) -> Vec<f64> {
        (0..2000).for_each(|_| {
            self.step(inputs[0]);
        });
        inputs.iter().map(|input| self.step(*input)).collect()
    }
}

fn clock(count: usize) -> Vec<f64> {
    (0..count).map(|n| n as f64 * DT).collect()
}

/// A recording of random levels, each held for some samples: it excites the resonance.
fn jumps(noise: f64, count: usize) -> Recording {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut inputs = vec![0.0];
    while inputs.len() < count {
        let (level, hold) = (random.random_range(0.0..10.0), random.random_range(4..60));
        inputs.extend(std::iter::repeat_n(level, hold));
    }
    inputs.truncate(count);
    let outputs = Plant::new(noise).run(&inputs);
    let mut recording = Recording::new(inputs, outputs).unwrap();
    recording.time = Some(clock(count));
    recording
}

fn quick() -> Fit<'static> {
    Fit::new().bootstrap(0)
}

fn ring_of(model: &Model) -> Option<[f64; 2]> {
    let constants = model.constants();
    let number = |name| constants.get(name).first().copied();
    Some([number("ring_frequency")?, number("ring_damping")?])
}

fn rmse(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / a.len() as f64).sqrt()
}

/// Few strokes of a steep loop, without any dynamics: a plane that they do not determine may be
/// mended by a ring, on some of what is left out.
#[test]
fn few_strokes_of_a_still_plant_do_not_ring() {
    let widths: Vec<f64> = (0..14).map(|n| 0.5 + 11.5 / 13.0 * f64::from(n)).collect();
    for seed in 0..6 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut inputs = vec![20.0_f64];
        let mut ends = vec![80.0, 20.0];
        while ends.len() < 8 {
            let end = match ends.len() % 2 == 0 {
                true => random.random_range(50.0..80.0),
                false => random.random_range(20.0..45.0),
            };
            ends.push(end);
        }
        for end in ends {
            let from = inputs[inputs.len() - 1];
            let count = ((end - from).abs() / 0.6).ceil();
            inputs.extend((1..=count as i32).map(|n| from + (end - from) * f64::from(n) / count));
        }
        let mut plays = vec![inputs[0]; widths.len()];
        let mut output = |x: &f64| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for (play, width) in plays.iter_mut().zip(&widths) {
                *play = play.clamp(x - width, x + width);
                sum += (-width / 5.0).exp() * *play;
                weights += (-width / 5.0).exp();
            }
            let noise = 0.01 * random.random_range(-1.0..1.0);
            5.0 + 5.0 * ((sum / weights - 50.0) / 4.0).tanh() + noise
        };
        let outputs = inputs.iter().map(&mut output).collect();
        let mut recording = Recording::new(inputs, outputs).unwrap();
        recording.time = Some((0..recording.len()).map(|n| n as f64).collect());
        let found = quick().run(&recording).unwrap();
        assert_eq!(ring_of(&found), None, "seed {seed}");
    }
}

/// Gear play and a slide that sticks and slips, ten samples late, at several speeds. A ring that
/// hardly rings smooths the slips, which no model follows, and comes late as well.
#[test]
fn a_dead_time_of_a_plant_that_slips_is_no_ring() {
    const LATE: usize = 10;
    for seed in 0..3 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut inputs = vec![20.0_f64];
        while inputs.len() < 3000 {
            let from = inputs[inputs.len() - 1];
            let to = random.random_range(20.0..80.0);
            let speed = [0.25, 0.6, 1.5][random.random_range(0..3)];
            let count = ((to - from) / speed).abs().ceil();
            inputs.extend((1..=count as i32).map(|n| from + (to - from) * f64::from(n) / count));
        }
        let (mut gear, mut slide) = (inputs[0], inputs[0]);
        let mut moved = vec![0.0; LATE];
        for x in &inputs {
            gear = gear.clamp(x - 3.0, x + 3.0);
            if (gear - slide).abs() > 5.76 {
                slide = gear - f64::copysign(1.2, gear - slide);
            }
            moved.push(0.15 * (slide - 20.0));
        }
        let noisy = |y: &f64| y + 0.01 * random.random_range(-1.0..1.0);
        let outputs = moved[..inputs.len()].iter().map(noisy).collect();
        let mut recording = Recording::new(inputs, outputs).unwrap();
        recording.time = Some((0..recording.len()).map(|n| 0.5 * n as f64).collect());
        let found = quick().run(&recording).unwrap();
        assert_eq!(ring_of(&found), None, "seed {seed}");
        assert!(found.delay().samples().abs_diff(LATE) <= 1, "seed {seed}");
    }
}

#[test]
fn a_ring_that_is_excited_is_found_and_its_inverse_follows_a_path() {
    let noise = 0.005;
    let recording = jumps(noise, 6000);
    let ringing = quick().run(&recording).unwrap();
    let still = quick().dynamics(Dynamics::Off).run(&recording).unwrap();
    let [frequency, damping] = ring_of(&ringing).unwrap();
    assert!((frequency / RESONANCE[0] - 1.0).abs() < 0.01, "{frequency}");
    assert!((damping / RESONANCE[1] - 1.0).abs() < 0.15, "{damping}");
    // A path with kinks and bends, at up to a fourteenth of the resonance.
    let path = |n: usize| {
        let t = n as f64 * DT;
        let bend = 1.0 - (std::f64::consts::TAU * 30.0 * t).cos();
        let kink = 1.0 - (2.0 * (45.0 * t % 1.0) - 1.0).abs();
        1.0 + bend + 3.0 * kink
    };
    let path: Vec<f64> = (0..3000).map(path).collect();
    let time = clock(path.len());
    let around = Surroundings {
        time: Some(&time),
        load: None,
        rest: None,
    };
    let missed = |model: &Model| {
        let mut state = model.start();
        let inverse = model.inverse().unwrap();
        let found = inverse.series_in(&mut state, &path, Policy::Hold, 0.0, around);
        let found = found.unwrap();
        let met = found.iter().filter(|found| found.status == Status::Ok);
        let met = met.count() as f64 / path.len() as f64;
        let inputs: Vec<f64> = found.iter().map(|found| found.input).collect();
        let readings = Plant::new(noise).run(&inputs);
        (rmse(&readings[100..], &path[100..]), met)
    };
    let ((with, met), (without, _)) = (missed(&ringing), missed(&still));
    let fitted = ringing.fit.as_ref().unwrap().rmse;
    assert!(met > 0.9, "{met}");
    // What the model errs on its recording, with noise, and no more.
    assert!(
        with < 1.5 * fitted && with < 0.7 * without,
        "{with} {without} {fitted}"
    );
}

#[test]
fn what_is_not_excited_leaves_the_model_as_it_is() {
    // A slow sine of growing amplitude on the same plant, and a recording without time.
    let count = 4000;
    let inputs = (0..count).map(|n| {
        let phase = n as f64 / count as f64;
        5.0 - 5.0 * phase * (std::f64::consts::TAU * 12.0 * phase).cos()
    });
    let inputs: Vec<f64> = inputs.collect();
    let outputs = Plant::new(0.005).run(&inputs);
    let mut recording = Recording::new(inputs, outputs).unwrap();
    recording.time = Some(clock(count));
    let text = |fit: Fit<'_>, recording: &Recording| fit.run(recording).unwrap().to_json();
    let off = text(quick().dynamics(Dynamics::Off), &recording);
    assert_eq!(text(quick(), &recording), off);
    recording.time = None;
    assert!(!text(quick(), &recording).contains("ring"));
    let refused = quick()
        .dynamics(Dynamics::Ring)
        .run(&recording)
        .unwrap_err();
    assert!(refused.to_string().contains("depend on time"), "{refused}");
}

#[test]
fn a_valve_that_was_shaken_is_known_at_slow_sines() {
    let names = [
        "valve_prbn_1.csv",
        "valve_sine100_1.csv",
        "valve_sine50_1.csv",
    ];
    let [Some(shaken), Some(fast), Some(slow)] = shared(names) else {
        return;
    };
    let columns = Columns {
        time: Some("time_s"),
        ..Columns::new("voltage_V", "position")
    };
    let read = |path: &PathBuf| Recording::read(path, columns, Repair::Refuse).unwrap().0;
    let shaken = read(&shaken);
    let ringing = quick().run(&shaken).unwrap();
    let still = quick().dynamics(Dynamics::Off).run(&shaken).unwrap();
    let [frequency, damping] = ring_of(&ringing).unwrap();
    assert!((frequency - 725.0).abs() < 10.0 && (0.02..0.04).contains(&damping));
    for path in [fast, slow] {
        let recording = read(&path);
        let own = quick().run(&recording).unwrap();
        let error = |model: &Model, start| {
            let judged = evaluate_from(model, &recording, start).unwrap();
            judged.forward.rmse
        };
        let (with, without) = (error(&ringing, Start::Rest), error(&still, Start::Rest));
        let own = error(&own, Start::Fitted);
        assert!(
            with < 1.2 * own && with < 0.85 * without,
            "{with} {without} {own}"
        );
    }
}
