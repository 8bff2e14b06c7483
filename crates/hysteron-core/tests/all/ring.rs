//! The ring behind the operators: its factors against their identities, and its inverse over the
//! whole domain of frequency, damping, step, start and path.

use crate::common::{build, plane, rng, weights};
use hysteron_core::{
    Behind, Operator, Plane, Ring, Sample, StageState, Stages, Status, Target, Wanted,
};
use rand::RngExt;
use rand::rngs::StdRng;

/// Any ring: a damping from the least to the critical one, and a step from a ten-thousandth of the
/// period to beyond the Nyquist frequency.
fn any(rng: &mut StdRng) -> (Stages<'static, f64>, f64) {
    let damping = 10_f64.powf(rng.random_range(-4.0..0.1)).min(1.0);
    let frequency = 10_f64.powf(rng.random_range(-9.0..9.0));
    let periods = 10_f64.powf(rng.random_range(-4.0..0.3));
    (ringing(frequency, damping), periods / frequency)
}

fn ringing(frequency: f64, damping: f64) -> Stages<'static, f64> {
    let ring = Ring { frequency, damping };
    Stages {
        behind: Behind {
            ring,
            ..Behind::NONE
        },
        ..Stages::NONE
    }
}

/// Those of the ring: `1 − a`, `b`, `d`, and the angle `ωΔ` of the step.
fn factors(stages: &Stages<'_, f64>, dt: f64) -> [f64; 4] {
    let numbers = stages.rates(dt).to_numbers();
    let [.., gain, b, d] = numbers;
    let turn = std::f64::consts::TAU * stages.behind.ring.frequency * dt;
    [gain, b, d, turn]
}

#[test]
fn the_zero_of_a_sample_is_within_the_unit_circle() {
    for seed in 0..20_000 {
        let (stages, dt) = any(&mut rng(seed));
        let [gain, b, d, turn] = factors(&stages, dt);
        let fade = (-stages.behind.ring.damping * turn).exp();
        // `ad + b² = e^(−2ζωΔ)`: the determinant of the step.
        let left = (1.0 - gain) * d + b * b;
        assert!((left - fade * fade).abs() < 1e-13, "{seed}: {left}");
        let zero = d - b / gain * b;
        let slack = 1e-13 / gain;
        assert!(gain > 0.0 && zero.abs() < 1.0 + slack, "{seed}: {zero}");
    }
}

#[test]
fn two_steps_are_one_of_both_lengths() {
    for seed in 0..2000 {
        let mut rng = rng(seed);
        let (stages, dt) = any(&mut rng);
        let part = dt * rng.random_range(0.0..1.0);
        let held = |steps: &[f64]| {
            let rest = stages.after(None, 0.0, 1.0).1;
            let step = |(_, past), dt: &f64| stages.after(Some(past), *dt, 3.0);
            steps.iter().fold((1.0, rest), step).1.to_numbers()
        };
        let (whole, parts) = (held(&[dt]), held(&[part, dt - part]));
        let [.., y, v, _] = whole;
        let [.., y2, v2, _] = parts;
        // The difference `dt − part` is rounded.
        let turn = factors(&stages, dt)[3];
        let rounding = 1e-13 * (1.0 + turn);
        assert!(
            (y - y2).abs() < rounding && (v - v2).abs() < rounding,
            "{seed}"
        );
    }
}

#[test]
fn extreme_steps_are_numbers() {
    for frequency in [1e-9, 1.0, 1e9] {
        for damping in [1e-4, 0.5, 1.0 - 1e-16, 1.0] {
            for dt in [0.0, 1e-300, 1e-9, 1.0, 1e9, 1e300] {
                let numbers = factors(&ringing(frequency, damping), dt);
                let fine = numbers[..3].iter().all(|v| v.abs() <= 2.0);
                assert!(fine, "{frequency} {damping} {dt}: {numbers:?}");
            }
            let settled = ringing(frequency, damping).after(None, 0.0, 2.0).1;
            let (y, _) = ringing(frequency, damping).after(Some(settled), 1e300, 5.0);
            assert_eq!(y, 5.0);
        }
    }
}

/// A path in shares of the range.
fn path(rng: &mut StdRng, count: usize) -> Vec<f64> {
    let (kind, period) = (rng.random_range(0..5), rng.random_range(20.0..300.0));
    let mut last: f64 = rng.random_range(0.0..1.0);
    let place = |n: usize| {
        let phase = n as f64 / period;
        last = match kind {
            0 => 0.5 - 0.45 * (std::f64::consts::TAU * phase).cos(),
            1 => (2.0 * (phase % 1.0) - 1.0).abs(),
            2 if n % 60 == 0 => rng.random_range(-0.2..1.2),
            2 => last,
            3 => rng.random_range(-0.5..1.5),
            _ => (last + rng.random_range(-0.02..0.02)).clamp(-0.1, 1.1),
        };
        last
    };
    (0..count).map(place).collect()
}

/// Weights that are not all zero.
fn some(rng: &mut StdRng) -> Vec<f64> {
    let weights = weights(rng, 6);
    weights.into_iter().map(|mu| mu + 0.01).collect()
}

/// What an inverse along a path gave.
struct Followed {
    met: usize,
    /// The status and the distance from the target, in shares of the range.
    samples: Vec<(Status, f64)>,
}

/// Inverts along targets given as shares of the range, after kicks, and simulates the inputs.
fn follow(
    rng: &mut StdRng,
    stages: Stages<'_, f64>,
    dt: impl Fn(&mut StdRng) -> f64,
    kicks: Option<usize>,
    shares: &[f64],
) -> Followed {
    let plane: Plane<f64> = plane(rng, 6);
    let (model, mut state) = build(plane, Operator::Mkp, &some(rng));
    let inverse = model.inverse().unwrap();
    let on = model.total();
    let mut memory = StageState::default();
    // Kicks over the whole plane; without any, the first target is at rest.
    for _ in 0..kicks.unwrap_or_default() {
        let input = plane.bottom() + rng.random_range(0.0..1.0) * (plane.max() - plane.bottom());
        let sample = Sample {
            input,
            dt: Some(dt(rng)),
            load: None,
        };
        stages
            .step(&model, &mut state, &mut memory, sample)
            .unwrap();
    }
    let (mut again, mut memory_again) = (state.clone(), memory);
    let mut samples = Vec::new();
    for share in shares {
        let dt = Some(dt(rng));
        let wanted = Wanted {
            dt,
            ..Target::new(share * on).into()
        };
        let found = stages
            .invert(&inverse, &mut state, &mut memory, wanted)
            .unwrap();
        // The inputs are within the plane, whatever is wanted.
        assert!(
            plane.bottom() <= found.input && found.input <= plane.max(),
            "{found:?}"
        );
        let sample = Sample {
            input: found.input,
            dt,
            load: None,
        };
        let reached = stages
            .step(&model, &mut again, &mut memory_again, sample)
            .unwrap();
        let error = (reached.output - share * on).abs() / on;
        samples.push((found.status, error));
    }
    let met = samples
        .iter()
        .filter(|sample| sample.0 == Status::Ok)
        .count();
    Followed { met, samples }
}

#[test]
fn a_target_said_to_be_met_is_met_behind_any_ring() {
    let (mut met, mut count) = (0, 0);
    for seed in 0..3000 {
        let mut rng = rng(seed);
        let (stages, dt) = any(&mut rng);
        let shares = path(&mut rng, 200);
        // Steps of one length, or of any.
        let even = rng.random::<bool>();
        let step = |rng: &mut StdRng| match even {
            true => dt,
            false => dt * rng.random_range(0.0..1.5),
        };
        let kicks = (rng.random_range(0..3) > 0).then(|| rng.random_range(1..6));
        let followed = follow(&mut rng, stages, step, kicks, &shares);
        for (status, error) in &followed.samples {
            // Positions in the plane are rounded, and the slope of the operators carries that on.
            assert!(*status != Status::Ok || *error < 1e-10, "{seed}: {error}");
        }
        met += followed.met;
        count += followed.samples.len();
    }
    assert!(met > count / 10 && met < count, "{met} of {count}");
}

#[test]
fn a_swinging_output_comes_to_rest_at_a_target_and_is_held() {
    for seed in 0..2000 {
        let mut rng = rng(seed);
        let (stages, mut dt) = any(&mut rng);
        // Beyond the Nyquist frequency one input per sample cannot damp all of it.
        let turn = factors(&stages, dt)[3];
        dt *= f64::min(1.0, 2.0 / turn);
        let turn = f64::min(turn, 2.0);
        let share = rng.random_range(0.02..0.98);
        // Ten cycles.
        let count = (60.0 / turn) as usize + 200;
        let followed = follow(&mut rng, stages, |_| dt, Some(3), &vec![share; count]);
        let last = &followed.samples[count - 50..];
        assert!(
            last.iter().all(|sample| sample.0 == Status::Ok),
            "{seed}: {:?}",
            stages.behind.ring
        );
    }
}

/// A smooth path whose frequency is a fiftieth to a sixteenth of the resonance, at steps of 4 to 200 to
/// a period of the resonance. From rest on it, it is met in every sample. From any other start the
/// inverse comes to it.
#[test]
fn a_smooth_path_below_the_resonance_is_followed() {
    for seed in 0..500 {
        let mut rng = rng(seed);
        let (stages, mut dt) = any(&mut rng);
        let turn = factors(&stages, dt)[3];
        dt *= (1.5 / turn).min(1.0).max(0.03 / turn);
        let turn = turn.clamp(0.03, 1.5);
        let each = turn * rng.random_range(0.02..0.06);
        let smooth = |n: usize| 0.5 - 0.3 * (each * n as f64).cos();
        let coming = (60.0 / turn) as usize + 50;
        let shares: Vec<f64> = (0..coming + 1000).map(smooth).collect();
        let followed = follow(&mut rng, stages, |_| dt, None, &shares);
        let met = followed.samples.iter().filter(|s| s.0 == Status::Ok);
        assert_eq!(met.count(), shares.len(), "{seed}");
        let followed = follow(&mut rng, stages, |_| dt, Some(5), &shares);
        // Calmly it takes the target to go on steadily: it is late by about what the path bends in
        // a period of the resonance, (1 + ωΔ) ÿ/ω².
        let late = 0.3 * (1.0 + turn) * 0.06 * 0.06 + 0.001;
        for (n, (_, error)) in followed.samples.iter().enumerate().skip(coming) {
            assert!(*error < 2.0 * late, "{seed}, {n}: {error} {turn}");
        }
    }
}
