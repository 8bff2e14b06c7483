//! What `adapt` makes of a single stroke or loop: another offset, gain and shift, where these say
//! far more than the model as it was. The plants are simulated.

use hysteron::{
    AdaptOptions, Adapted, CreepTerm, Fit, Model, Operator, Plane, Progress, Recording, Sign,
    Start, Surroundings, adapt, evaluate_from,
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
    let (low, high) = (rng.random_range(0.0..0.1), rng.random_range(0.9..1.0));
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
    let adapted = adapt(&model, &recording, &AdaptOptions::default(), Progress::NONE).unwrap();
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
        if adapted.session {
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
    let mut sessions = 0;
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
                let levels = adapted.model.plane().levels() as f64;
                let off = (adapted.drift.shift - change.shift).abs() * levels;
                assert!(!adapted.session || off < 0.75, "{seed}: {off}");
                sessions += usize::from(adapted.session);
                assert!(after < (0.3 * before).max(0.03), "{seed}: {before} {after}");
            }
            // One stroke does not tell a shift: the learners do what they can.
            _ => assert!(after < 1.1 * before, "{seed} {change:?}: {before} {after}"),
        }
    }
    assert!(sessions > 20, "{sessions}");
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
        assert!(!adapted.session, "{seed}");
        let changed = Change { lift: 0.3, ..same };
        let many = [0.0, 1.0, 0.1, 0.9, 0.2];
        let (adapted, _) = learned(&mut rng, changed, &many, 0.01);
        assert!(!adapted.session, "{seed}");
    }
}

#[test]
fn one_loop_is_told_from_many_and_from_next_to_no_readings() {
    let mut rng = ChaCha8Rng::seed_from_u64(300);
    let change = Change {
        gain: 1.0,
        lift: 0.3,
        shift: 0.0,
    };
    // Strokes of a single step, and an input far outside among three loops.
    let model = actuator(&mut rng);
    let plane = *model.plane();
    let (low, high) = (plane.min(), plane.max());
    let steps: Vec<f64> = (0..200).map(|n| [low, high][n % 2]).collect();
    let mut loops = path(&model, &[0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0], 60);
    loops[150] = high + 20.0 * (high - low);
    let few = path(&model, &[0.0, 1.0], 12);
    for input in [steps, loops, few] {
        let output = plant(&model, change, &input);
        let recording = Recording::new(input, output).unwrap();
        let adapted = adapt(&model, &recording, &AdaptOptions::default(), Progress::NONE).unwrap();
        assert!(!adapted.session, "{} samples", recording.len());
    }
}

/// An offset in front of stages behind the operators is written in front of them.
#[test]
fn a_model_with_stages_errs_as_it_was_judged() {
    for seed in 0..12 {
        let mut rng = ChaCha8Rng::seed_from_u64(400 + seed);
        let model = actuator(&mut rng);
        let (off, on) = model.output_range();
        let range = (on - off).abs();
        let creep = CreepTerm {
            coefficient: 0.4,
            tau: 2.0,
        };
        let staged = model.clone().with_after(&[creep], 0.0).unwrap();
        let input = path(&model, &turns(&mut rng), 200);
        let time: Vec<f64> = (0..input.len()).map(|n| 0.1 * n as f64).collect();
        let mut recording = Recording::new(input.clone(), input).unwrap();
        recording.time = Some(time);
        let around = Surroundings::from_recording(&staged, &recording);
        let output = staged.simulate_in(&recording.input, around).unwrap();
        recording.output = output.iter().map(|y| y + 0.3 * range).collect();
        let adapted = adapt(
            &staged,
            &recording,
            &AdaptOptions::default(),
            Progress::NONE,
        )
        .unwrap();
        let written = evaluate_from(&adapted.model, &recording, Start::Fitted).unwrap();
        let (again, written) = (adapted.again.rmse, written.forward.rmse);
        assert!(
            (again - written).abs() < 1e-6 * range,
            "{seed}: {again} {written}"
        );
        assert!(written < 0.05 * range, "{seed}: {written}");
    }
}

/// An actuator that changes little: its repeats say so, and one noisy loop then moves it less.
#[test]
fn repeats_tell_how_much_an_actuator_changes() {
    let (mut known, mut usual) = (0.0, 0.0);
    for seed in 0..30 {
        let mut rng = ChaCha8Rng::seed_from_u64(300 + seed);
        let truth = actuator(&mut rng);
        let (off, on) = truth.output_range();
        let mut recorded = |change: Change, turns: &[f64], noise: f64| {
            let input = path(&truth, turns, 100);
            let mut output = plant(&truth, change, &input);
            for y in &mut output {
                *y += noise * (on - off) * rng.random_range(-1.0..1.0);
            }
            Recording::new(input, output).unwrap()
        };
        let still = Change {
            gain: 1.0,
            lift: 0.0,
            shift: 0.0,
        };
        let strokes = [0.0, 1.0, 0.0, 0.8, 0.2, 0.6, 0.0, 0.4, 0.1, 1.0, 0.0];
        let first = recorded(still, &strokes, 0.003);
        let signs = [-1.0, 1.0, -1.0, 1.0];
        let repeats = signs.map(|sign| {
            let change = Change {
                gain: 1.0 + 0.01 * sign,
                lift: 0.2 * sign,
                shift: 0.0,
            };
            recorded(change, &strokes, 0.003)
        });
        let fit = Fit::new()
            .bootstrap(0)
            .levels(12)
            .operator(truth.operator());
        let alone = fit.clone().run(&first).unwrap();
        let told = fit.repeats(repeats.to_vec()).run(&first).unwrap();
        assert!(alone.fit.as_ref().unwrap().change().is_none());
        let change = told.fit.as_ref().unwrap().change().unwrap();
        // One usual session and four that changed next to nothing.
        assert!(
            (change.gain / (0.2 / 5.0_f64.sqrt()) - 1.0).abs() < 0.05,
            "{change:?}"
        );
        assert!(change.shift < 0.012, "{change:?}");

        let next = Change {
            gain: 1.01,
            lift: -0.2,
            shift: 0.0,
        };
        let noisy = recorded(next, &[0.0, 1.0, 0.0], 0.2);
        let clean = recorded(next, &strokes, 0.0);
        let error = |model: &Model| {
            let adapted = adapt(model, &noisy, &AdaptOptions::default(), Progress::NONE).unwrap();
            let ran = adapted.model.simulate(&clean.input).unwrap();
            let squares: f64 = ran
                .iter()
                .zip(&clean.output)
                .map(|(h, y)| (h - y).powi(2))
                .sum();
            (squares / ran.len() as f64).ln()
        };
        known += error(&told);
        usual += error(&alone);
    }
    println!(
        "{:.3} of the squared error",
        ((known - usual) / 30.0_f64).exp()
    );
    assert!(known < usual);
}
