//! Wrong readings in what a model is adapted to: a cell of full scale in the last row, some all
//! over, some in a loop.

use hysteron::control::{Compensator, Controller, Reading, Reference, Scheme};
use hysteron::{
    AdaptOptions, Adapted, Learner, Model, Operator, Outcome, Plane, Policy, Progress, Recording,
    Sign, adapt,
};

/// What a converter of twelve bits says when its wire is off.
const FULL_SCALE: f64 = 4095.0;
const LEARNERS: [Learner; 4] = [
    Learner::Refit,
    Learner::Increments,
    Learner::LeastSquares,
    Learner::Drift,
];

fn spring(stroke: f64) -> Model {
    let mut weights = Vec::new();
    for j in 1..=12_i32 {
        for i in 1..=j {
            let off = f64::from((i - 4).pow(2) + (j - 7).pow(2));
            weights.push((-0.25 * off).exp());
        }
    }
    let total: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|mu| *mu *= stroke / total);
    let plane = Plane::new(20.0, 80.0, 12).unwrap();
    Model::new(Operator::Mkp, plane, weights, 5.0, Sign::Negative).unwrap()
}

fn recorded(plant: &Model) -> Recording {
    let wave =
        |n: i32| 48.0 - (20.0 + 12.0 * (0.013 * f64::from(n)).cos()) * (0.05 * f64::from(n)).cos();
    let input: Vec<f64> = (0..3000).map(wave).collect();
    let output = plant.simulate(&input).unwrap();
    Recording::new(input, output).unwrap()
}

fn with_wrong(recording: &Recording, wrong: impl Iterator<Item = usize>) -> Recording {
    let mut recording = recording.clone();
    wrong.for_each(|n| recording.output[n] = FULL_SCALE);
    recording
}

fn by(learner: Learner) -> AdaptOptions {
    AdaptOptions {
        learner,
        ..AdaptOptions::default()
    }
}

/// Both end where they end without wrong readings: to a hundredth of the stroke. A reading refused
/// is one that is not learned from, as if it had not been taken.
fn same(clean: &Adapted, other: &Adapted, what: &str) {
    let stroke = clean.drift.weights.0;
    let (a, b) = (&clean.drift, &other.drift);
    assert!(
        (a.weights.1 - b.weights.1).abs() < 0.01 * stroke,
        "{what}: {a:?} {b:?}"
    );
    assert!(
        (a.offset.1 - b.offset.1).abs() < 0.01 * stroke,
        "{what}: {a:?} {b:?}"
    );
}

#[test]
fn a_cell_of_full_scale_in_the_last_row_is_not_in_the_model() {
    let recording = recorded(&spring(13.5));
    for learner in LEARNERS {
        let clean = adapt(&spring(10.0), &recording, &by(learner), Progress::NONE).unwrap();
        let last = recording.len() - 1;
        for first in [last, last - 1, last - 6, last - 14] {
            let wrong = with_wrong(&recording, first..=last);
            let adapted = adapt(&spring(10.0), &wrong, &by(learner), Progress::NONE).unwrap();
            same(&clean, &adapted, &format!("{learner:?} from {first}"));
            assert_eq!(adapted.probation, 8);
            assert!(
                adapted.counts.rejected >= 1 && !adapted.worse,
                "{learner:?} from {first}: {:?} {:?}",
                adapted.counts,
                adapted.late
            );
        }
        // Without a gate, the last one alone is in it.
        let open = AdaptOptions {
            gate: Some(0.0),
            ..by(learner)
        };
        let adapted = adapt(
            &spring(10.0),
            &with_wrong(&recording, last..=last),
            &open,
            Progress::NONE,
        )
        .unwrap();
        assert_eq!((adapted.probation, adapted.counts.rejected), (0, 0));
    }
}

#[test]
fn one_cell_in_five_hundred_leaves_the_weights_as_they_are_without() {
    let recording = recorded(&spring(13.5));
    for learner in LEARNERS {
        let clean = adapt(&spring(10.0), &recording, &by(learner), Progress::NONE).unwrap();
        for first in [0, 137, 499] {
            let cells = (first..recording.len()).step_by(500);
            let wrong = with_wrong(&recording, cells.clone());
            let adapted = adapt(&spring(10.0), &wrong, &by(learner), Progress::NONE).unwrap();
            same(&clean, &adapted, &format!("{learner:?} from {first}"));
            for n in cells {
                // At rest nothing is learned anyway.
                let found = adapted.outcomes[n];
                assert!(
                    matches!(found, Outcome::Rejected | Outcome::AtRest),
                    "{found:?}"
                );
            }
        }
    }
}

#[test]
fn five_wrong_readings_in_a_loop_do_not_move_the_next_prediction() {
    for learner in LEARNERS {
        let mut adaptive = by(learner).adaptive(&spring(10.0)).unwrap();
        let recording = recorded(&spring(10.0));
        let pairs = recording.input.iter().zip(&recording.output).enumerate();
        for (n, (&input, &output)) in pairs {
            let wrong = (1000..1005).contains(&n);
            let learning = adaptive
                .step(input, if wrong { FULL_SCALE } else { output })
                .unwrap();
            // The plant is the model: there is no error but rounding. A refit takes gradients below
            // 1e-12 of the largest for zero. With a ridge of a tenth the condition number is
            // some hundreds, and the stroke is ten.
            let off = (learning.output - output).abs();
            assert!(off < 1e-7, "{learner:?}, {n}: {off}");
        }
    }
}

#[test]
fn a_controller_says_which_reading_was_rejected() {
    let recording = recorded(&spring(10.0));
    let adaptive = by(Learner::LeastSquares).adaptive(&spring(10.0)).unwrap();
    let mut controller = Controller::new(Scheme {
        interval_s: 1.0,
        compensator: Some(Compensator::adaptive(adaptive)),
        policy: Policy::Hold,
        tolerance: 0.0,
        pid: None,
        bias: 0.0,
        commands: (20.0, 80.0),
        drives: (20.0, 80.0),
        inner: None,
        filter_s: 0.0,
        stuck_s: None,
        ..Scheme::new(1.0, (20.0, 80.0))
    })
    .unwrap();
    let target = Reference {
        output: 0.0,
        heading: None,
    };
    let mut rejected = 0;
    for (n, (&input, &output)) in recording.input.iter().zip(&recording.output).enumerate() {
        let wrong = (1000..1005).contains(&n);
        let reading = Reading {
            output: if wrong { FULL_SCALE } else { output },
            input: Some(input),
        };
        let status = controller.step(target, reading).unwrap().status;
        match wrong {
            true => assert!(!status.adapted, "{n}"),
            false => assert!(!status.rejected, "{n}"),
        }
        rejected += u32::from(status.rejected || status.stuck);
    }
    // Of the five, those at which the input moved. The last ones stand still where the model
    // expects the output to move, which is another word for wrong.
    assert!((3..=5).contains(&rejected), "{rejected}");
}

/// Only noise to learn, and options with which each follows it.
#[test]
fn whatever_learns_is_told_to_be_no_better_where_nothing_changed() {
    let mut recording = recorded(&spring(10.0));
    for (n, output) in recording.output.iter_mut().enumerate() {
        *output += 0.3 * (1.7 * n as f64).sin();
    }
    for learner in LEARNERS {
        let steps = learner == Learner::Increments;
        let squares = matches!(learner, Learner::LeastSquares | Learner::Drift);
        let options = AdaptOptions {
            gain: steps.then_some(1.5),
            noise: squares.then_some(0.01),
            dead_zone: (steps || squares).then_some(0.0),
            ..by(learner)
        };
        let adapted = adapt(&spring(10.0), &recording, &options, Progress::NONE).unwrap();
        let late = adapted.late.unwrap();
        assert!(adapted.worse, "{learner:?}: {late:?}");
        assert!(late.adapting.rmse > late.fixed.rmse, "{learner:?}");
    }
    // A refit that comes only after the last reading: nothing has judged it.
    let late = AdaptOptions {
        every: Some(1_000_000),
        ..by(Learner::Refit)
    };
    let adapted = adapt(&spring(10.0), &recording, &late, Progress::NONE).unwrap();
    assert!(adapted.worse && adapted.drift.moved > 0.0);
}

#[test]
fn a_model_that_ends_worse_is_told() {
    // Nothing to learn but noise that is told from none: what is learned makes it worse.
    let mut recording = recorded(&spring(10.0));
    for (n, output) in recording.output.iter_mut().enumerate() {
        *output += 0.3 * (1.7 * n as f64).sin();
    }
    let options = AdaptOptions {
        gain: Some(1.5),
        dead_zone: Some(0.0),
        ..by(Learner::Increments)
    };
    let adapted = adapt(&spring(10.0), &recording, &options, Progress::NONE).unwrap();
    let late = adapted.late.unwrap();
    assert!(
        adapted.worse && late.adapting.rmse > late.fixed.rmse,
        "{late:?}"
    );
    let better = adapt(
        &spring(10.0),
        &recorded(&spring(13.5)),
        &by(Learner::Increments),
        Progress::NONE,
    )
    .unwrap();
    assert!(!better.worse);
    // The model itself: both work out the same, and nothing is learned.
    let same = adapt(
        &spring(10.0),
        &recorded(&spring(10.0)),
        &by(Learner::LeastSquares),
        Progress::NONE,
    )
    .unwrap();
    assert!(!same.worse, "{:?}", same.late);
}
