//! A start is a history: all off, an input of rest, the first input.

use crate::common::shared;
use hysteron::{
    AdaptOptions, Auto, Cause, Columns, Fit, FitOptions, Model, Operator, Plane, Progress,
    Recording, Repair, Sign, Spacing, Start, Verdict, adapt, evaluate, evaluate_errors, left_out,
    range,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const LEVELS: usize = 10;

fn plant(rng: &mut ChaCha8Rng) -> Model {
    let plane = Plane::new(0.1, 1.0, LEVELS).unwrap();
    let weights = (0..LEVELS * (LEVELS + 1) / 2).map(|_| rng.random_range(0.0..1.0));
    let (weights, sign) = (weights.collect(), [Sign::Positive, Sign::Negative]);
    Model::new(
        Operator::Mkp,
        plane,
        weights,
        0.5,
        sign[rng.random_range(0..2)],
    )
    .unwrap()
}

/// A decaying zigzag around the middle, behind a history of inputs.
fn recorded(model: &Model, history: &[f64], first: f64) -> Recording {
    let mut state = model.off();
    for input in history {
        model.run(&mut state, &[*input], &mut [0.0]).unwrap();
    }
    let mut input = vec![first];
    for swing in 0..9 {
        let from = input[input.len() - 1];
        let side = if swing % 2 == 0 { 1.0 } else { -1.0 };
        let to = 0.5 + side * 0.055 * f64::from(swing);
        input.extend((1..=25).map(|n| from + (to - from) * f64::from(n) / 25.0));
    }
    let mut output = vec![0.0; input.len()];
    model.run(&mut state, &input, &mut output).unwrap();
    Recording::new(input, output).unwrap()
}

fn fit() -> Fit<'static> {
    Fit::new()
        .levels(LEVELS)
        .range(0.1, 1.0)
        .spacing(Spacing::Uniform)
        .smooth(1e-9)
        .robust(false)
        .bootstrap(0)
}

/// RMSE in shares of the range.
fn error(model: &Model, recording: &Recording, start: Start) -> f64 {
    let (low, high) = range(&recording.output);
    let errors = evaluate_errors(model, recording, start).unwrap();
    errors.forward.rmse / (high - low)
}

/// What rested before, is kept, and replayed from another first input.
#[test]
fn a_rest_is_found_and_kept_for_any_recording() {
    let mut worse = 0;
    for seed in 0..12 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plant = plant(&mut rng);
        let rest = rng.random_range(0.5..0.9);
        let own = recorded(&plant, &[rest], 0.45);
        let found = fit().start(Start::Rest).run(&own).unwrap();
        let read = Model::from_json(&found.to_json()).unwrap();
        assert_eq!(read.fit.as_ref().unwrap().start, Start::Rest);
        let other = recorded(&plant, &[rest], 0.4);
        // The zigzag does not reach the whole plane, so the weights are not those of the plant.
        let replayed = error(&read, &other, Start::Fitted);
        assert!(replayed < 0.02, "seed {seed}, rest {rest}: {replayed}");
        worse += usize::from(error(&read, &other, Start::Off) > 2.0 * replayed);
    }
    assert!(worse >= 8, "{worse}");
}

/// In the last row of this recording the input has jumped back and the output has not. That outlier
/// once moved the rest across the range.
#[test]
fn a_wrong_last_row_does_not_move_the_rest() {
    let [Some(path)] = shared(["valve_sine50_1.csv"]) else {
        return;
    };
    let columns = Columns::new("voltage_V", "position");
    let whole = Recording::read(&path, columns, Repair::Refuse).unwrap().0;
    let mut without = whole.clone();
    without.input.pop();
    without.output.pop();
    let fit = Fit::new()
        .levels(14)
        .smooth(1e-8)
        .bootstrap(0)
        .start(Start::Rest);
    let rest = [whole, without].map(|recording| {
        let model = fit.run(&recording).unwrap();
        model.fit.as_ref().unwrap().other["rest"][1]
            .as_f64()
            .unwrap()
    });
    // The levels are 12 V apart: no finer rest is known. With the outlier it was off by 60 V.
    assert!((rest[0] - rest[1]).abs() < 12.0, "{rest:?}");
}

/// Off and on are rests: at the lowest and at the highest input.
#[test]
fn a_rest_is_at_least_as_good_as_off_and_on() {
    for seed in 0..12 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plant = plant(&mut rng);
        let history: &[f64] = [&[] as &[f64], &[1.0], &[1.0, 0.2]][seed as usize % 3];
        let own = recorded(&plant, history, 0.45);
        let squares = |start| {
            let model = fit().start(start).run(&own).unwrap();
            model.fit.unwrap().rmse
        };
        let least = squares(Start::Off).min(squares(Start::On));
        // The highest input of the recording need not be the top of the plane.
        let rested = squares(Start::Rest);
        let rounding = 1e-3 * (plant.output_range().1 - plant.output_range().0).abs();
        assert!(rested <= least + rounding, "seed {seed}: {rested} {least}");
    }
}

/// A model judges a recording that began in another way.
#[test]
fn an_evaluation_finds_the_rest() {
    for seed in 0..12 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plant = plant(&mut rng);
        let other = recorded(&plant, &[rng.random_range(0.5..0.9)], 0.45);
        let found = error(&plant, &other, Start::Rest);
        let known = [Start::Off, Start::On].map(|start| error(&plant, &other, start));
        assert!(found < 0.01, "seed {seed}: {found}");
        assert!(
            found <= known[0].min(known[1]),
            "seed {seed}: {found} {known:?}"
        );
    }
}

/// Levels at other distances, creep behind: the rest is kept in the unit of the input.
#[test]
fn a_rest_stands_in_front_of_all_stages() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let plant = plant(&mut rng);
    let mut own = recorded(&plant, &[0.8], 0.45);
    own.time = Some((0..own.len()).map(|n| n as f64).collect());
    let fit = fit().spacing(Spacing::Auto).creep(1).start(Start::Rest);
    let model = fit.run(&own).unwrap();
    let rest = &model.fit.as_ref().unwrap().other["rest"];
    let inputs = [0, 1].map(|n| rest[n].as_f64().unwrap());
    let (low, high) = range(&own.input);
    assert!(
        inputs.iter().all(|x| (low..=high).contains(x)),
        "{inputs:?}"
    );
    assert!(error(&model, &own, Start::Fitted) < 0.02);
}

#[test]
fn with_a_load_there_is_no_rest() {
    let mut own = recorded(&plant(&mut ChaCha8Rng::seed_from_u64(1)), &[0.8], 0.45);
    own.load = Some((0..own.len()).map(|n| (n / 60 % 3) as f64).collect());
    let refused = fit().start(Start::Rest).run(&own).unwrap_err().to_string();
    assert!(
        refused.contains("without thermal body and load"),
        "{refused}"
    );
}

/// Dead time, ring, lag and body are looked for in a recording with time: no start is in their way.
#[test]
fn every_start_is_fitted_with_time_too() {
    let rng = &mut ChaCha8Rng::seed_from_u64(11);
    for noise in [0.0, 0.05] {
        let mut recording = recorded(&plant(rng), &[0.3], 0.5);
        let (low, high) = range(&recording.output);
        for y in &mut recording.output {
            *y += noise * (high - low) * rng.random_range(-1.0..1.0);
        }
        let mut timed = recording.clone();
        timed.time = Some((0..timed.len()).map(|n| 0.1 * n as f64).collect());
        for start in [Start::Off, Start::On, Start::Rest, Start::Unknown] {
            for recording in [&recording, &timed] {
                let found = Fit::new().bootstrap(0).start(start).run(recording);
                let fit = found.unwrap().fit.unwrap();
                assert_eq!(fit.start, start);
            }
            // A start that is asked for, and then left to the data.
            let open = Fit::new().bootstrap(0).start(start).start(Auto);
            assert!(open.run(&timed).is_ok());
            let options = FitOptions {
                start,
                ..FitOptions::plain()
            };
            let recordings = std::slice::from_ref(&recording);
            assert!(left_out(recordings, &options, None, Progress::NONE).is_ok());
        }
    }
}

/// A small loop never shows where it began. The model that begins elsewhere errs by a constant and a
/// few weights, which is what a learner would learn; and the whole range would pay for it.
#[test]
fn what_another_start_explains_is_told_and_not_learned() {
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let model = plant(&mut rng);
        let from = rng.random_range(0.55..1.0);
        let recording = recorded(&model, &[1.0, 1.0 - from, from], 0.5);
        let evaluation = evaluate(&model, &recording).unwrap();
        let alone = evaluation.forward;
        let error = error(&model, &recording, Start::Rest);
        let verdict = Verdict::of_evaluation(&model, &recording, &evaluation).unwrap();
        let is_other = |cause: &Cause| matches!(cause, Cause::OtherStart { .. });
        let told = verdict.causes.iter().any(is_other);
        let percent = alone.nrmse_percent.unwrap();
        // A good model is not asked why it is no better.
        let has_to = percent > 2.0 && 100.0 * error < percent / 1.6;
        assert!(told || !has_to, "seed {seed}: {verdict}");
        let adapted = adapt(&model, &recording, &AdaptOptions::default(), Progress::NONE).unwrap();
        assert!(
            adapted.whole.fixed.rmse <= alone.rmse,
            "seed {seed}: {:?}",
            adapted.whole
        );
        // Over the whole plane it is the model that it was, as far as the rest explains it.
        let stroke = |n: i32| 0.1 + 0.9 * f64::from(20 - (n - 20).abs()) / 20.0;
        let whole: Vec<f64> = (0..=40).map(stroke).collect();
        let adapted = adapted.model.with_start(None).unwrap();
        let (before, after) = (model.simulate(&whole), adapted.simulate(&whole));
        let (before, after) = (before.unwrap(), after.unwrap());
        let moved = before.iter().zip(&after).map(|(a, b)| (a - b).abs());
        let (low, high) = range(&before);
        let moved = 100.0 * moved.fold(0.0, f64::max) / (high - low);
        // The small loop is a part of the range, so learned errors would be the larger share.
        assert!(moved < 0.2 * percent, "seed {seed}: {moved} of {percent}");
    }
}
