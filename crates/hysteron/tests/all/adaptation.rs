//! Models that are adapted over recordings. Measured ones that are absent are skipped, and named.

use crate::common::shared;
use hysteron::{
    AdaptOptions, Adaptive, Columns, Direction, DriftBasis, Errors, FirstOrder, Fit, FitOptions,
    Learner, Model, Operator, Plane, PrepareOptions, Progress, Recording, Repair, Sign, Start,
    Step, Turning, Window, adapt, evaluate, forward, plane_of, prepare,
};

const LEARNERS: [Learner; 4] = [
    Learner::Refit,
    Learner::Increments,
    Learner::LeastSquares,
    Learner::Drift,
];

/// Loops of different width, from the bottom of a plane from 20 to 80.
fn input() -> Vec<f64> {
    let wave =
        |n: i32| 48.0 - (20.0 + 12.0 * (0.013 * f64::from(n)).cos()) * (0.05 * f64::from(n)).cos();
    (0..2500).map(wave).collect()
}

/// A transformation about the middle of the plane, shifted by so many levels.
fn wire(stroke: f64, shift: i32) -> Model {
    let mut weights = Vec::new();
    for j in 1..=12_i32 {
        for i in 1..=j {
            let off = f64::from((i - 3 - shift).pow(2) + (j - 7 - shift).pow(2));
            weights.push(stroke / 12.0 * (-0.25 * off).exp());
        }
    }
    let plane = Plane::new(20.0, 80.0, 12).unwrap();
    Model::new(Operator::Mkp, plane, weights, 5.0, Sign::Negative).unwrap()
}

fn recorded(model: &Model, start: Start) -> Recording {
    let input = input();
    let mut output = vec![0.0; input.len()];
    let mut state = match start {
        Start::On => model.saturated(),
        _ => model.start(),
    };
    model.run(&mut state, &input, &mut output).unwrap();
    Recording::new(input, output).unwrap()
}

fn by(learner: Learner) -> AdaptOptions {
    AdaptOptions {
        learner,
        ..AdaptOptions::default()
    }
}

#[test]
fn every_learner_follows_a_plant_with_another_stroke() {
    let (model, recording) = (wire(1.0, 0), recorded(&wire(1.6, 0), Start::Off));
    for learner in LEARNERS {
        let adapted = adapt(&model, &recording, &by(learner), Progress::NONE).unwrap();
        let (first, last) = (adapted.thirds[0], adapted.thirds[2]);
        // The plant is the model but for its stroke: what is left after fifty loops is what is
        // still being learned, and with increments a long tail of it.
        assert!(
            last.adapting.rmse < 0.2 * last.fixed.rmse,
            "{learner:?}: {last:?}"
        );
        assert!(last.adapting.rmse < first.adapting.rmse, "{learner:?}");
        assert!(adapted.counts.learned > 0 && adapted.counts.rolled_back == 0);
        assert!(!adapted.worse, "{learner:?}");
        let (before, after) = adapted.drift.weights;
        assert!(after > 1.2 * before, "{learner:?}: {before} to {after}");
    }
}

#[test]
fn drift_follows_a_shift_that_it_has_no_part_for() {
    // Two levels and a third more stroke; the basis is shifted by 1, 3 and 5.
    let (model, recording) = (wire(1.0, 0), recorded(&wire(1.3, 2), Start::Off));
    let adapted = adapt(&model, &recording, &by(Learner::Drift), Progress::NONE).unwrap();
    // A sum of shifted weights is wider than a shift: about a quarter of the error stays.
    let last = adapted.thirds[2];
    assert!(last.adapting.rmse < 0.25 * last.fixed.rmse, "{last:?}");
    assert!(
        adapted.again.rmse < 0.25 * last.fixed.rmse,
        "{:?}",
        adapted.again
    );
}

/// Where no operator leaves the plane, a member of the basis is the model at an input so many
/// levels away.
#[test]
fn a_shifted_part_is_a_shifted_model() {
    let mut weights = wire(1.0, 0).weights().to_vec();
    for (n, mu) in weights.iter_mut().enumerate() {
        let j = (1..=12).find(|j| j * (j + 1) / 2 > n).unwrap();
        let i = n + 1 - j * (j - 1) / 2;
        if i < 2 || j > 9 {
            *mu = 0.0;
        }
    }
    let plane = Plane::new(20.0, 80.0, 12).unwrap();
    let of =
        |weights: Vec<f64>| Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive).unwrap();
    let model = of(weights);
    let found = DriftBasis::of(&model, None).unwrap();
    let step = 60.0 / 11.0;
    let here: Vec<f64> = input().iter().map(|t| t.clamp(28.0, 60.0)).collect();
    for (n, shift) in [(1, -1.0), (2, 0.0), (3, 1.0), (4, 3.0)] {
        let there: Vec<f64> = here.iter().map(|t| t + shift * step).collect();
        let expected = model.simulate(&here).unwrap();
        for (a, b) in of(found.basis[n].clone())
            .simulate(&there)
            .unwrap()
            .iter()
            .zip(expected)
        {
            // Rounding of the shifted inputs, a few parts in 10¹⁶, over weights that sum to about
            // one.
            assert!((a - b).abs() < 1e-12, "shift {shift}: {a} {b}");
        }
    }
}

#[test]
fn the_start_is_on_or_found() {
    // Cooled to the middle of the plane first.
    let middle = |recording: Recording| {
        Recording::new(
            recording.input[94..].to_vec(),
            recording.output[94..].to_vec(),
        )
        .unwrap()
    };
    let (model, recording) = (wire(1.0, 0), middle(recorded(&wire(1.0, 0), Start::Off)));
    let from = |start| {
        let options = AdaptOptions {
            start,
            ..by(Learner::Drift)
        };
        adapt(&model, &recording, &options, Progress::NONE).unwrap()
    };
    let [off, on] = [Start::Off, Start::On].map(|start| from(start).whole.fixed.rmse);
    assert!(on < 0.5 * off, "{on} {off}");
    // Before it was cooled it was heated to less than all on.
    let [rest, found] = [Start::Rest, Start::Unknown].map(|start| from(start).whole.fixed.rmse);
    assert!(rest < 0.5 * on, "{rest} {on}");
    assert_eq!(found, rest);
}

#[test]
fn a_load_is_found_from_the_output_alone() {
    let at = |load: f64| Recording {
        load: Some(vec![load; input().len()]),
        ..recorded(&wire(1.0 + load, 0), Start::Off)
    };
    let options = FitOptions {
        levels: 12,
        range: Some((20.0, 80.0)),
        ..FitOptions::plain()
    };
    let model = Fit::from(&options).run(&[at(0.0), at(1.0)]).unwrap();
    let target = Recording {
        load: None,
        ..at(0.9)
    };
    for learner in [Learner::Drift, Learner::Refit] {
        let adapted = adapt(&model, &target, &by(learner), Progress::NONE).unwrap();
        let last = adapted.thirds[2];
        // The two parts hold the plant up to the fit's error, well below a hundredth; a refit has
        // all weights, and the model in the middle to begin with.
        assert!(last.adapting.rmse < 0.05 * last.fixed.rmse, "{last:?}");
        assert!(adapted.model.load.is_none() && adapted.one_load);
    }
    let plain = model.at_load(0.5).unwrap();
    let adapted = adapt(&plain, &target, &by(Learner::Drift), Progress::NONE).unwrap();
    assert!(!adapted.one_load);
    let refused = adapt(&model, &target, &by(Learner::LeastSquares), Progress::NONE).unwrap_err();
    assert!(
        refused.to_string().contains("depends on the load"),
        "{refused}"
    );
    let far = AdaptOptions {
        load: Some(2.0),
        ..by(Learner::Drift)
    };
    let refused = adapt(&model, &target, &far, Progress::NONE).unwrap_err();
    assert!(
        refused.to_string().contains("outside the range"),
        "{refused}"
    );
}

#[test]
fn the_adapted_file_says_how_it_came_about() {
    let options = FitOptions {
        levels: 12,
        bootstrap: 20,
        ..FitOptions::plain()
    };
    let model = Fit::from(&options)
        .run(&recorded(&wire(1.0, 0), Start::Off))
        .unwrap();
    assert!(model.fit.as_ref().unwrap().confidence.is_some());
    let recording = recorded(&wire(1.4, 0), Start::Off);
    let adapted = adapt(
        &model,
        &recording,
        &by(Learner::LeastSquares),
        Progress::NONE,
    )
    .unwrap();
    let read = Model::from_json(&adapted.model.to_json()).unwrap();
    assert_eq!(read, adapted.model);
    let summary = read.fit.unwrap();
    assert!(summary.confidence.is_none() && summary.validation.is_none());
    assert_eq!(summary.rmse, adapted.again.rmse);
    let said = &summary.other["adapted"];
    assert_eq!(said["method"], "least-squares");
    assert_eq!(said["options"]["forgetting"], 0.999);
    assert_eq!(said["counts"]["learned"], adapted.counts.learned);
    assert_eq!(said["from"]["samples"], recording.len());
}

#[test]
fn frozen_it_stays_and_what_was_kept_comes_back() {
    for learner in [Learner::LeastSquares, Learner::Auto] {
        stays_and_comes_back(learner);
    }
}

fn stays_and_comes_back(learner: Learner) {
    let (model, recording) = (wire(1.0, 0), recorded(&wire(1.6, 0), Start::Off));
    let options = by(learner);
    let mut adaptive = options.adaptive_after(&model, &recording).unwrap();
    let learn = |adaptive: &mut Adaptive| {
        for (input, output) in recording.input.iter().zip(&recording.output) {
            adaptive.step(*input, *output).unwrap();
        }
    };
    adaptive.freeze(true);
    learn(&mut adaptive);
    assert_eq!(adaptive.weights(), model.weights());
    assert_eq!(adaptive.offset(), model.offset());
    adaptive.freeze(false);
    learn(&mut adaptive);
    adaptive.keep();
    let (kept, offset) = (adaptive.weights(), adaptive.offset());
    // Fewer wrong readings than a trial takes.
    let few = &recording.input[..100];
    for input in few {
        adaptive.step(*input, 50.0).unwrap();
    }
    assert_ne!(adaptive.weights(), kept);
    adaptive.roll_back().unwrap();
    assert_eq!((adaptive.weights(), adaptive.offset()), (kept, offset));
    let all = [&recording.input[..], &recording.input, few].concat();
    let free = adaptive.model().unwrap().simulate(&all).unwrap();
    // Rounding of sums of 78 weights.
    assert!((adaptive.output() - free[all.len() - 1]).abs() < 1e-9);
}

/// Of every operator, also of those whose weights count from −1 to 1.
#[test]
fn a_refit_has_a_plant_of_its_kind_after_a_cycle() {
    for operator in [Operator::Mkp, Operator::Kp, Operator::Relay] {
        for sign in [Sign::Positive, Sign::Negative] {
            let of = |stroke: f64, offset: f64| {
                let plane = Plane::new(20.0, 80.0, 12).unwrap();
                let weights = wire(stroke, 0).weights().to_vec();
                Model::new(operator, plane, weights, offset, sign).unwrap()
            };
            let (model, plant) = (of(1.0, 5.0), of(1.7, 2.0));
            let mut adaptive = by(Learner::Refit).adaptive(&model).unwrap();
            let recording = {
                let output = plant.simulate(&input()).unwrap();
                Recording::new(input(), output).unwrap()
            };
            let learned = adaptive
                .run(&recording.input, &recording.output, Progress::NONE)
                .unwrap();
            let (low, high) = recording.ranges().1;
            for learning in &learned[1250..] {
                // The ridge gives way step by step, over ten cycles with four refits and more.
                assert!(
                    learning.error.abs() < 0.005 * (high - low),
                    "{operator:?} {sign:?}: {learning:?}"
                );
            }
            // What it predicts is what its model says.
            adaptive.refit().unwrap();
            let free = adaptive.model().unwrap().simulate(&input()).unwrap();
            assert!((adaptive.output() - free[free.len() - 1]).abs() < 1e-9);
        }
    }
}

/// The input stays in the lower half. Operators that switch on above it never move.
#[test]
fn operators_that_the_window_does_not_move_keep_their_weights() {
    let (model, plant) = (wire(1.0, 0), wire(1.6, 0));
    let low: Vec<f64> = input().iter().map(|t| 20.0 + 0.5 * (t - 16.0)).collect();
    let highest = low.iter().fold(f64::MIN, |most, t| most.max(*t));
    let output = plant.simulate(&low).unwrap();
    let mut adaptive = by(Learner::Refit).adaptive(&model).unwrap();
    adaptive.run(&low, &output, Progress::NONE).unwrap();
    let step = 60.0 / 11.0;
    let mut rested = 0;
    let operators = hysteron::operators(12).zip(model.weights().iter().zip(adaptive.weights()));
    for ((_, j), (before, after)) in operators {
        if 20.0 + (j as f64 - 2.0) * step >= highest {
            rested += 1;
            // Rounding of a weight's own share of the ridge.
            assert!((before - after).abs() < 1e-9, "row {j}: {before} {after}");
        }
    }
    assert!(rested > 20);
}

#[test]
fn a_refit_returns_to_what_was_kept_and_does_not_learn_it_again() {
    let (model, other) = (wire(1.0, 0), recorded(&wire(1.6, 0), Start::Off));
    let mut adaptive = by(Learner::Refit).adaptive(&model).unwrap();
    adaptive.freeze(true);
    let run = |adaptive: &mut Adaptive| {
        adaptive
            .run(&other.input, &other.output, Progress::NONE)
            .unwrap();
    };
    run(&mut adaptive);
    adaptive.refit().unwrap();
    assert_eq!(adaptive.weights(), model.weights());
    adaptive.freeze(false);
    run(&mut adaptive);
    assert_ne!(adaptive.weights(), model.weights());
    adaptive.roll_back().unwrap();
    adaptive.refit().unwrap();
    assert_eq!(adaptive.weights(), model.weights());
    assert_eq!(adaptive.offset(), model.offset());
}

#[test]
fn options_of_a_refit_out_of_range_are_refused() {
    let refit = by(Learner::Refit);
    let with = |options: AdaptOptions| {
        let refused = options.adaptive(&wire(1.0, 0)).unwrap_err();
        refused.to_string()
    };
    let window = |window| AdaptOptions {
        window: Some(window),
        ..refit
    };
    for wrong in [
        Window::Cycles(0),
        Window::Samples(1),
        Window::Samples(1 << 20),
    ] {
        assert!(with(window(wrong)).contains("window"));
    }
    for ridge in [0.0, -1.0, 2.0, f64::NAN] {
        let ridge = Some(ridge);
        assert!(with(AdaptOptions { ridge, ..refit }).contains("ridge"));
    }
    let every = Some(0);
    assert!(with(AdaptOptions { every, ..refit }).contains("every"));
    let trial = Some(9);
    assert!(with(AdaptOptions { trial, ..refit }).contains("`trial`"));
    for learner in &LEARNERS[1..] {
        let ridge = Some(0.1);
        let said = with(AdaptOptions {
            ridge,
            ..by(*learner)
        });
        assert!(said.contains("`ridge`"), "{said}");
    }
}

/// Thermal cycles of a specimen that does not come back. A refit that was frozen at the end of a
/// cycle errs in the next one as a model fitted to that cycle does.
#[test]
fn one_cycle_ahead_a_refit_is_as_good_as_a_fit_to_the_last_cycle() {
    let [Some(path)] = shared(["sma_isobaric_cycles_1_to_4.csv"]) else {
        return;
    };
    let columns = Columns::new("temperature_C", "extension_mm");
    let raw = Recording::read(&path, columns, Repair::Refuse).unwrap().0;
    let steps = PrepareOptions {
        signs: true,
        spikes: Step::Value(4.0),
        ..PrepareOptions::all(Step::Off)
    };
    let (whole, _) = prepare(&raw, &steps, Progress::NONE).unwrap();
    let (low, high) = whole.ranges().0;
    let cold = |t: &f64| *t < whole.input[0] - 0.02 * (high - low);
    let begin = whole.input.iter().position(cold).unwrap();
    let mut turning = Turning::new(0.2 * (high - low));
    let mut bounds = vec![begin];
    for &t in &whole.input {
        if let Some((n, Direction::Falling)) = turning.push(t) {
            bounds.extend((n > begin).then_some(n));
        }
    }
    let cycle = |n: usize| {
        let range = bounds[n]..bounds[n + 1];
        Recording::new(
            whole.input[range.clone()].to_vec(),
            whole.output[range].to_vec(),
        )
        .unwrap()
    };
    let plane = plane_of(&whole, 20).unwrap();
    let fit = |recording: &Recording| {
        let options = FitOptions {
            start: Start::On,
            range: Some((plane.min(), plane.max())),
            ..FitOptions::plain()
        };
        Fit::from(&options).run(recording).unwrap()
    };
    let first = fit(&cycle(0));
    let options = AdaptOptions {
        start: Start::On,
        ..by(Learner::Refit)
    };
    let mut adaptive = options.adaptive_after(&first, &cycle(0)).unwrap();
    for n in 1..bounds.len() - 2 {
        let (last, next) = (cycle(n), cycle(n + 1));
        adaptive
            .run(&last.input, &last.output, Progress::NONE)
            .unwrap();
        adaptive.refit().unwrap();
        let mut frozen = adaptive.clone();
        let ahead = next.input.iter().map(|&t| frozen.simulate(t).unwrap());
        let ahead: Vec<f64> = ahead.collect();
        let fitted = fit(&last);
        let mut of_fit = vec![0.0; next.len()];
        fitted
            .run(&mut fitted.saturated(), &next.input, &mut of_fit)
            .unwrap();
        let rmse = |output: &[f64]| {
            Errors::between(&next.output, output, |_| true)
                .unwrap()
                .rmse
        };
        assert!(rmse(&ahead) <= 1.05 * rmse(&of_fit), "cycle {n}");
    }
}

#[test]
fn what_cannot_be_adapted_is_refused() {
    let (model, recording) = (wire(1.0, 0), recorded(&wire(1.6, 0), Start::Off));
    let refused = |model: &Model, recording: &Recording, options: AdaptOptions| {
        adapt(model, recording, &options, Progress::NONE)
            .unwrap_err()
            .to_string()
    };
    let mut heated = model.clone();
    heated.thermal = Some(FirstOrder {
        ambient: 0.0,
        gain: 1.0,
        tau_heating: 1.0,
        tau_cooling: 2.0,
    });
    for learner in LEARNERS {
        let said = refused(&heated, &recording, by(learner));
        assert!(said.contains("needs the time"), "{learner:?}: {said}");
    }
    let mut broken = recording.clone();
    broken.output[3] = f64::NAN;
    assert!(refused(&model, &broken, by(Learner::Drift)).contains("sample 3"));
    let gain = AdaptOptions {
        gain: Some(0.5),
        ..by(Learner::LeastSquares)
    };
    assert!(refused(&model, &recording, gain).contains("`gain`"));
    let gain = AdaptOptions {
        gain: Some(2.5),
        ..by(Learner::Increments)
    };
    assert!(refused(&model, &recording, gain).contains("gain"));
    let load = AdaptOptions {
        load: Some(1.0),
        ..by(Learner::Drift)
    };
    assert!(refused(&model, &recording, load).contains("`load`"));
    // 46,000 numbers squared do not fit into 4 GiB.
    let plane = Plane::new(20.0, 80.0, 300).unwrap();
    let fine = Model::new(Operator::Mkp, plane, vec![1.0; 45_150], 0.0, Sign::Positive).unwrap();
    assert!(refused(&fine, &recording, by(Learner::LeastSquares)).contains("GiB"));
}

#[test]
fn two_samples_have_no_thirds() {
    let two = Recording::new(vec![20.0, 30.0], vec![5.0, 4.9]).unwrap();
    let adapted = adapt(&wire(1.0, 0), &two, &by(Learner::Drift), Progress::NONE).unwrap();
    assert_eq!(adapted.outcomes.len(), 2);
    assert!(adapted.thirds.is_empty());
}

/// A nickel-titanium-hafnium alloy at 200 MPa, and then at 400.
#[test]
fn a_measured_alloy_is_followed_to_another_stress() {
    let loops = [200, 400].map(|stress| format!("sma_nitihf_bigelow_{stress}MPa.csv"));
    let [Some(before), Some(after)] = shared(loops) else {
        return;
    };
    let [before, after] = [before, after].map(|path| {
        let columns = Columns::new("temperature_C", "strain_percent");
        Recording::read(&path, columns, Repair::Refuse).unwrap().0
    });
    let model = Fit::from(FitOptions::plain()).run(&before).unwrap();
    let adapted = adapt(&model, &after, &AdaptOptions::default(), Progress::NONE).unwrap();
    // docs/measured/adaptation.md: a tenth.
    assert!(
        adapted.again.rmse < 0.25 * adapted.whole.fixed.rmse,
        "{:?}",
        adapted.again
    );
}

/// A model with a wrong lag gets wrong operators. The errors are those of the whole model, as an
/// evaluation finds them, and what errs more than the model left alone is called worse.
#[test]
fn what_a_wrong_lag_teaches_is_judged_by_the_whole_model() {
    let plant = wire(1.0, 0).with_after(&[], 1.0).unwrap();
    let mut recording = recorded(&wire(1.0, 0), Start::Off);
    let time: Vec<f64> = (0..recording.len()).map(|n| n as f64).collect();
    recording.time = Some(time.clone());
    recording.output = forward(&plant, &recording, Start::Off)
        .unwrap()
        .output_model;
    let last_third = |model: &Model| {
        let output = forward(model, &recording, Start::Off).unwrap().output_model;
        let late = 2 * recording.len() / 3;
        let errors = Errors::between(&recording.output, &output, |n| n >= late).unwrap();
        errors.rmse
    };
    let mut worse = 0;
    for lag in [1.0, 4.0, 16.0, 40.0] {
        for learner in LEARNERS.into_iter().chain([Learner::Auto]) {
            let model = wire(1.3, 1).with_after(&[], lag).unwrap();
            let options = AdaptOptions {
                start: Start::Off,
                ..by(learner)
            };
            let adapted = adapt(&model, &recording, &options, Progress::NONE).unwrap();
            let fixed = forward(&model, &recording, Start::Off).unwrap();
            let rmse = adapted.whole.fixed.rmse;
            assert!((rmse / fixed.errors.rmse - 1.0).abs() < 1e-9);
            let again = forward(&adapted.model, &recording, Start::Off).unwrap();
            assert!((adapted.again.rmse / again.errors.rmse - 1.0).abs() < 1e-9);
            worse += usize::from(adapted.worse);
            // Samples on probation do not count there, so a little is left.
            assert!(
                adapted.worse || last_third(&adapted.model) < 1.12 * last_third(&model),
                "{learner:?} with a lag of {lag}"
            );
        }
    }
    assert!((1..20).contains(&worse), "{worse}");
}

#[test]
fn a_recording_begins_where_the_fit_found_the_actuator() {
    // Operators that were not all off: a rest inside the range, as of a demagnetised core.
    let plant = wire(1.0, 0);
    let input: Vec<f64> = (0..1200)
        .map(|n| 50.0 + 25.0 * (0.05 * f64::from(n)).sin() * (1.0 - f64::from(n) / 1300.0))
        .collect();
    let mut state = plant.saturated();
    let output = input
        .iter()
        .map(|t| plant.step(&mut state, *t).unwrap().output);
    let recording = Recording::new(input.clone(), output.collect()).unwrap();
    let model = Fit::new().levels(8).bootstrap(0).run(&recording).unwrap();
    assert!(model.fitted().is_some(), "the start is not all off");
    let own = evaluate(&model, &recording).unwrap().forward.rmse;
    for start in [Start::Fitted, Start::Unknown] {
        let options = AdaptOptions {
            learner: Learner::Fixed,
            start,
            ..AdaptOptions::default()
        };
        let adapted = adapt(&model, &recording, &options, Progress::NONE).unwrap();
        // Sums in another order.
        assert!(
            (adapted.whole.fixed.rmse - own).abs() <= 1e-12 * own.max(1.0),
            "{start:?}"
        );
        let again = evaluate(&adapted.model, &recording).unwrap().forward.rmse;
        assert!(
            (again - own).abs() <= 1e-9,
            "the adapted model begins there, too"
        );
    }
}
