//! What `adapt` makes of a single stroke or loop: another offset, gain and shift, where these say
//! far more than the model as it was. The plants are simulated.

use hysteron::{
    AdaptOptions, Adapted, Model, Operator, Plane, Progress, Recording, Sign, Start, adapt,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// What another session does to a plant.
#[derive(Debug, Clone, Copy)]
struct Change {
    gain: f64,
    /// Of the stroke.
    lift: f64,
    /// Of the plane.
    shift: f64,
}

/// Weights in a ridge along the diagonal, of random place, width and kind.
fn actuator(rng: &mut ChaCha8Rng) -> Model {
    let levels = rng.random_range(8..24);
    let (middle, lag) = (rng.random_range(0.4..0.6), rng.random_range(0.1..0.3));
    let at = |n: usize| n as f64 / levels as f64;
    let weight = |(i, j): (usize, usize)| {
        let off = (at(j) - middle - lag / 2.0).powi(2) + (at(i) - middle + lag / 2.0).powi(2);
        (-60.0 * off).exp()
    };
    let weights = hysteron::operators(levels).map(weight).collect();
    let operator = [Operator::Mkp, Operator::Kp, Operator::Relay][rng.random_range(0..3)];
    let sign = [Sign::Positive, Sign::Negative][rng.random_range(0..2)];
    let low = rng.random_range(-100.0..100.0);
    let plane = Plane::new(low, low + rng.random_range(0.01..100.0), levels).unwrap();
    Model::new(
        operator,
        plane,
        weights,
        rng.random_range(-50.0..50.0),
        sign,
    )
    .unwrap()
}

/// From turn to turn, as shares of the plane.
fn path(model: &Model, turns: &[f64], count: usize) -> Vec<f64> {
    let plane = model.plane();
    let at = |share: f64| plane.min() + share * (plane.max() - plane.min());
    let legs = turns.windows(2).flat_map(|leg| {
        let step = (leg[1] - leg[0]) / count as f64;
        (0..count).map(move |n| leg[0] + step * n as f64)
    });
    legs.map(at).collect()
}

/// The plant of another session under an input, which it feels as moved.
fn plant(model: &Model, change: Change, input: &[f64]) -> Vec<f64> {
    let plane = model.plane();
    let shift = change.shift * (plane.max() - plane.min());
    let felt: Vec<f64> = input.iter().map(|x| x - shift).collect();
    let (off, on) = model.output_range();
    let output = model.simulate(&felt).unwrap();
    let moved = |y: &f64| off + change.gain * (y - off) + change.lift * (on - off);
    output.iter().map(moved).collect()
}

/// One loop at most: a stroke, a stroke and the way back, or a loop from within.
fn turns(rng: &mut ChaCha8Rng) -> Vec<f64> {
    let (low, high) = (rng.random_range(0.0..0.15), rng.random_range(0.85..1.0));
    let from = rng.random_range(0.3..0.7);
    match rng.random_range(0..3) {
        0 => vec![low, high],
        1 => vec![low, high, low],
        _ => vec![from, high, low, from],
    }
}

/// A model that learned from one recording of a plant that changed, the model before, and the root
/// of the mean squared error of both over random strokes, in shares of the range.
fn learned(rng: &mut ChaCha8Rng, change: Change, turns: &[f64], noise: f64) -> (Adapted, [f64; 2]) {
    let model = actuator(rng);
    let (off, on) = model.output_range();
    let range = (on - off).abs();
    let input = path(&model, turns, rng.random_range(60..400));
    let mut output = plant(&model, change, &input);
    for y in &mut output {
        *y += noise * range * rng.random_range(-1.0..1.0);
    }
    let recording = Recording::new(input, output).unwrap();
    let options = AdaptOptions {
        start: Start::Off,
        ..AdaptOptions::default()
    };
    let adapted = adapt(&model, &recording, &options, Progress::NONE).unwrap();
    let mut next = vec![0.0];
    next.extend((0..20).map(|_| rng.random_range(0.0..1.0)));
    let next = path(&model, &next, 50);
    let truth = plant(&model, change, &next);
    let error = |model: &Model| {
        let output = model.simulate(&next).unwrap();
        let squares: f64 = truth.iter().zip(output).map(|(y, h)| (y - h).powi(2)).sum();
        (squares / truth.len() as f64).sqrt() / range
    };
    let errors = [error(&model), error(&adapted.model)];
    (adapted, errors)
}

fn is_session(adapted: &Adapted) -> bool {
    matches!(adapted.shares[..], [("session", _)])
}

#[test]
fn offset_and_gain_of_another_session_are_found_from_one_stroke() {
    let (mut sessions, count) = (0, 60);
    for seed in 0..count {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let change = Change {
            gain: rng.random_range(0.7..1.4),
            lift: [-1.0, 1.0][seed as usize % 2] * rng.random_range(0.05..0.3),
            shift: 0.0,
        };
        let turns = turns(&mut rng);
        let (adapted, [before, after]) = learned(&mut rng, change, &turns, 0.003);
        assert!(!adapted.worse, "{seed}");
        if is_session(&adapted) {
            sessions += 1;
            // The noise, and a twentieth of what its readings and the prior say of the gain.
            assert!(
                after < 0.05 * before + 0.003,
                "{seed} {change:?}: {before} {after}"
            );
        }
    }
    // Where relays hardly switch in the recording, a refit may follow its noise better.
    assert!(10 * sessions > 9 * count, "{sessions}");
}

#[test]
fn a_shift_is_found_between_the_levels_where_both_branches_are_seen() {
    for seed in 0..60 {
        let mut rng = ChaCha8Rng::seed_from_u64(100 + seed);
        let change = Change {
            gain: rng.random_range(0.8..1.2),
            lift: rng.random_range(-0.2..0.2),
            shift: [-1.0, 1.0][seed as usize % 2] * rng.random_range(0.03..0.06),
        };
        let turns = turns(&mut rng);
        let (adapted, [before, after]) = learned(&mut rng, change, &turns, 0.003);
        // Relays switch at their thresholds alone: a mean of two sets of weights is none of a shift
        // between them.
        match adapted.model.operator() {
            Operator::Relay => assert!(after < 1.1 * before, "{seed}: {before} {after}"),
            // Means of weights are wider than the weights that moved: 3 % of the range at most.
            _ if turns.len() > 2 => {
                assert!(after < (0.3 * before).max(0.03), "{seed}: {before} {after}");
            }
            _ => assert!(after < before, "{seed} {change:?}: {before} {after}"),
        }
    }
}

#[test]
fn where_nothing_changed_or_more_was_seen_it_is_no_other_session() {
    for seed in 0..60 {
        let mut rng = ChaCha8Rng::seed_from_u64(200 + seed);
        let same = Change {
            gain: 1.0,
            lift: 0.0,
            shift: 0.0,
        };
        let one = turns(&mut rng);
        let (adapted, _) = learned(&mut rng, same, &one, 0.01);
        assert!(!is_session(&adapted), "{seed}");
        let changed = Change { lift: 0.3, ..same };
        let many = [0.0, 1.0, 0.1, 0.9, 0.2];
        let (adapted, _) = learned(&mut rng, changed, &many, 0.01);
        assert!(!is_session(&adapted), "{seed}");
    }
}
