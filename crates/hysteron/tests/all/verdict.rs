//! The verdict on a model: faults of a known kind are named, and grades follow the error.

use hysteron::{
    Basis, Cause, Dynamics, Evaluation, Fit, FitOptions, Grade, HoldOut, Model, Operator, PartKind,
    Plane, Recording, Sign, Verdict, error_parts, evaluate, fit_holding_out, forward,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// An input of decreasing loops over 20 to 80, and more of them.
fn input(samples: usize) -> Vec<f64> {
    let wave = |n: usize| {
        let t = n as f64 / samples as f64;
        50.0 - 30.0 * (1.0 - 0.6 * t) * (t * 44.0).cos()
    };
    (0..samples).map(wave).collect()
}

/// Weights of a model with 12 levels, each from 0 to 1.
fn model(weights: &[f64]) -> Model {
    let plane = Plane::new(20.0, 80.0, 12).unwrap();
    Model::new(Operator::Mkp, plane, weights.to_vec(), 3.0, Sign::Positive).unwrap()
}

fn recording(model: &Model, mut change: impl FnMut(usize, f64) -> f64) -> Recording {
    let input = input(900);
    let output = model.simulate(&input).unwrap();
    let output = output
        .iter()
        .enumerate()
        .map(|(n, y)| change(n, *y))
        .collect();
    Recording::new(input, output).unwrap()
}

fn judged(model: &Model, recording: &Recording) -> (Verdict, Evaluation) {
    let evaluation = evaluate(model, recording).unwrap();
    (
        Verdict::of_evaluation(model, recording, &evaluation).unwrap(),
        evaluation,
    )
}

/// Random weights around one pair of levels, and none elsewhere: as a shape-memory alloy, it has
/// plateaus beside the steep branches. Where the slope is the same everywhere, a shift of the input
/// cannot be told from an offset of the output.
fn weights(rng: &mut ChaCha8Rng) -> Vec<f64> {
    let cells = (1..=12).flat_map(|j| (1..=j).map(move |i| (i, j)));
    let is_near = |(i, j): (i32, i32)| (i - 5).abs() <= 1 && (j - 7).abs() <= 1;
    let mut weight = |cell| {
        if is_near(cell) {
            rng.random_range(0.1..1.0)
        } else {
            0.0
        }
    };
    cells.map(&mut weight).collect()
}

/// One fault at a time, from 3 % of the range on: it explains the error.
#[test]
fn a_fault_is_named() {
    for seed in 0..240 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let model = model(&weights(&mut rng));
        let clean = recording(&model, |_, y| y);
        let (_, (low, high)) = clean.ranges();
        let size = rng.random_range(0.03..0.3) * if rng.random() { 1.0 } else { -1.0 };
        let error = size * (high - low);
        let (kind, told, found) = match seed % 5 {
            0 => (PartKind::Offset, error, recording(&model, |_, y| y + error)),
            1 => (
                PartKind::Gain,
                size,
                recording(&model, |_, y| y * (1.0 + size)),
            ),
            2 => {
                // The sensor of the input reads more by 2 % of its range.
                let shift = 1.2_f64.copysign(size);
                let input = clean.input.iter().map(|x| x + shift).collect();
                let moved = Recording::new(input, clean.output.clone()).unwrap();
                (PartKind::Shift, shift, moved)
            }
            3 => {
                let late = 3;
                let of = |n: usize, _| clean.output[n.saturating_sub(late)];
                (PartKind::Late, late as f64, recording(&model, of))
            }
            _ => {
                let drift = |n: usize, y: f64| y + error * n as f64 / 899.0;
                (PartKind::Drift, error, recording(&model, drift))
            }
        };
        let output = model.simulate(&found.input).unwrap();
        let [first, ..] = error_parts(&found, &output);
        assert_eq!(first.kind, kind, "seed {seed}");
        // Slopes are those between samples, and an input outside the plane moves nothing.
        let (least, near) = match kind {
            PartKind::Shift | PartKind::Late => (0.5, 0.5),
            _ => (1.0 - 1e-9, 1e-6),
        };
        assert!(first.share >= least, "seed {seed}: {first:?}");
        let miss = (first.size - told).abs();
        assert!(
            miss <= near * told.abs(),
            "seed {seed}: {first:?}, told {told}"
        );
        let (verdict, _) = judged(&model, &found);
        let is_named = |cause: &Cause| matches!(cause, Cause::Part(part) if part.kind == kind);
        assert!(
            verdict.causes.iter().any(is_named),
            "seed {seed}: {:?}",
            verdict.causes
        );
    }
}

/// Shares are shares, and no recording of numbers makes the verdict fail.
#[test]
fn any_recording_gets_a_verdict() {
    for seed in 0..400 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let model = model(&weights(&mut rng));
        let samples = rng.random_range(1..40);
        let exponent = rng.random_range(-12..60);
        let scale = 10.0_f64.powi(exponent);
        let input = (0..samples).map(|_| rng.random_range(-1e6..1e6)).collect();
        let output = (0..samples)
            .map(|_| scale * rng.random_range(-1.0..1.0))
            .collect();
        let recording = Recording::new(input, output).unwrap();
        let (verdict, evaluation) = judged(&model, &recording);
        let parts = error_parts(&recording, &evaluation.output_model);
        let sum: f64 = parts.iter().map(|part| part.share).sum();
        assert!((0.0..=1.0 + 1e-6).contains(&sum), "seed {seed}: {parts:?}");
        assert!(
            parts.iter().all(|part| part.size.is_finite()),
            "seed {seed}: {parts:?}"
        );
        let worst = verdict.worst.clone().unwrap();
        assert_eq!(
            (worst.measured - worst.modelled).abs(),
            evaluation.forward.max_abs
        );
        assert!(!verdict.to_string().contains("NaN"));
    }
}

/// A model of one session says of another that its band is not for it; of its own, it says nothing.
#[test]
fn a_recording_that_the_band_does_not_hold_is_told() {
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let actuator = model(&weights(&mut rng));
        let mut noisy = |offset: f64| {
            let noise: Vec<f64> = (0..900).map(|_| rng.random_range(-0.2..0.2)).collect();
            recording(&actuator, |n, y| y + offset + noise[n])
        };
        let (own, again, other) = (noisy(0.0), noisy(0.0), noisy(4.0));
        let options = FitOptions {
            levels: 12,
            bootstrap: 30,
            ..FitOptions::plain()
        };
        let fitted = Fit::from(&options).run(&own).unwrap();
        let told = |recording| {
            let (verdict, _) = judged(&fitted, recording);
            let mut causes = verdict.causes.iter();
            causes.any(|cause| matches!(cause, Cause::Elsewhere { sessions: 1, .. }))
        };
        assert!(!told(&again), "seed {seed}");
        assert!(told(&other), "seed {seed}");
    }
}

#[test]
fn grades_follow_the_error_on_what_was_not_fitted() {
    let model = model(&[0.5; 78]);
    let graded = |error: f64| {
        let square = |n: usize| if n % 200 < 100 { 1.0 } else { -1.0 };
        let found = recording(&model, |n, y| y + error * square(n));
        let (_, (low, high)) = found.ranges();
        let (verdict, _) = judged(&model, &found);
        (verdict.grade, 100.0 * error / (high - low))
    };
    // The output moves by 39.
    for (error, grade) in [(0.2, Grade::Good), (1.0, Grade::Usable), (4.0, Grade::Poor)] {
        let (found, percent) = graded(error);
        assert_eq!(found, grade, "{percent} %");
    }
}

/// On what was fitted, a small error is no promise; a straight line that is better says enough.
#[test]
fn what_was_fitted_is_not_tested_and_a_rival_costs_a_grade() {
    let plain = Fit::from(hysteron::FitOptions::plain())
        .levels(12)
        .smooth(hysteron::Smooth::NONE);
    let plant = model(&[0.5; 78]);
    let whole = recording(&plant, |_, y| y);
    let fitted = plain.run(&whole).unwrap();
    let verdict = Verdict::of_fit(&fitted, &whole).unwrap();
    assert_eq!(
        (verdict.grade, verdict.basis),
        (Grade::Untested, Basis::Fitted)
    );
    let (tested, _) = fit_holding_out(&plain, &whole, &HoldOut::Branches(0.2)).unwrap();
    let verdict = Verdict::of_fit(&tested, &whole).unwrap();
    assert_eq!(
        (verdict.grade, verdict.basis),
        (Grade::Good, Basis::HeldOut)
    );
    // A plant without hysteresis, slightly off the model's play: a line is better.
    let line = Recording::new(input(900), input(900)).unwrap();
    let run = forward(&fitted, &line, hysteron::Start::Fitted).unwrap();
    let verdict = Verdict::of_forward(&fitted, &line, &run).unwrap();
    let (_, rival) = verdict.rival.clone().unwrap();
    assert!(rival < verdict.percent.unwrap());
    assert_eq!(verdict.grade, Grade::Poor);
}

/// Inputs that the model does not know come first, whatever the error says.
#[test]
fn a_recording_outside_the_plane_is_poor() {
    let model = model(&[0.5; 78]);
    let kelvin: Vec<f64> = input(900).iter().map(|x| x + 273.15).collect();
    let output = model.simulate(&kelvin).unwrap();
    let (verdict, _) = judged(&model, &Recording::new(kelvin, output).unwrap());
    assert_eq!(verdict.grade, Grade::Poor);
    assert!(matches!(verdict.causes[0], Cause::Outside { share } if share == 1.0));
    assert!(verdict.next().to_string().contains("unit of the input"));
}

/// Noise that explains the error is named, and the model is not blamed for it.
#[test]
fn noise_is_told_from_misfit() {
    let model = model(&[0.5; 78]);
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut noisy = recording(&model, |_, y| y);
    noisy
        .output
        .iter_mut()
        .for_each(|y| *y += rng.random_range(-1.5..1.5));
    let (verdict, _) = judged(&model, &noisy);
    assert!(
        matches!(verdict.causes[0], Cause::Noise { .. }),
        "{:?}",
        verdict.causes
    );
    assert_eq!(verdict.grade, Grade::Good);
    assert!(verdict.percent.unwrap() > 1.0);
}

/// Without the series there is no worst sample; all else is the same.
#[test]
fn an_evaluation_of_errors_alone_has_no_worst_sample() {
    let model = model(&[0.5; 78]);
    let found = recording(&model, |n, y| y + (n as f64 * 0.3).sin());
    let start = hysteron::Start::On;
    let errors = hysteron::evaluate_errors(&model, &found, start).unwrap();
    let verdict = Verdict::of_evaluation(&model, &found, &errors).unwrap();
    assert_eq!(verdict.worst, None);
    let run = forward(&model, &found, start).unwrap();
    let whole = Verdict::of_forward(&model, &found, &run).unwrap();
    assert_eq!((verdict.grade, verdict.rmse), (whole.grade, whole.rmse));
    let worst = whole.worst.unwrap();
    assert_eq!(
        (worst.measured - worst.modelled).abs(),
        errors.forward.max_abs
    );
}

/// The weights of a fit take up some of a drift. What is left of it has a mean of zero, and is a
/// drift all the same.
#[test]
fn a_drift_in_what_was_fitted_is_named() {
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let truth = model(&weights(&mut rng));
        let clean = recording(&truth, |_, y| y);
        let (_, (low, high)) = clean.ranges();
        let noise: Vec<f64> = (0..clean.len())
            .map(|_| rng.random_range(-0.003..0.003) * (high - low))
            .collect();
        let size = rng.random_range(0.05..0.2) * if rng.random() { 1.0 } else { -1.0 };
        for size in [0.0, size * (high - low)] {
            let along = |n: usize| n as f64 / (clean.len() - 1) as f64;
            let drifting = recording(&truth, |n, y| y + noise[n] + size * along(n));
            let model = Fit::new().levels(12).bootstrap(0).run(&drifting).unwrap();
            let verdict = Verdict::of_fit(&model, &drifting).unwrap();
            let drift = verdict.causes.iter().find_map(|cause| match cause {
                Cause::Part(part) if part.kind == PartKind::Drift => Some(part.size),
                _ => None,
            });
            match size {
                0.0 => assert_eq!(drift, None, "seed {seed}"),
                _ => {
                    let found = drift.unwrap_or(0.0);
                    // The weights take the rest of it.
                    assert!(
                        found / size > 0.3 && found / size < 1.1,
                        "seed {seed}: {found}"
                    );
                }
            }
        }
    }
}

/// What was fitted says the same wherever it is judged, but not of outputs that are others.
#[test]
fn an_evaluation_of_what_was_fitted_is_the_verdict_of_the_fit() {
    let plant = model(&[0.5; 78]);
    let mut whole = recording(&plant, |n, y| y + 0.1 * (n as f64 * 0.7).sin());
    whole.source = Some(hysteron::Source::new("run.csv".into(), "1".repeat(64)));
    let fit = Fit::new().levels(12).bootstrap(0);
    let fitted = fit.run(&whole).unwrap();
    let of_fit = Verdict::of_fit(&fitted, &whole).unwrap();
    assert_eq!(of_fit.basis, Basis::BranchesLeftOut);
    let (again, _) = judged(&fitted, &whole);
    assert_eq!(of_fit, again);
    let run = forward(&fitted, &whole, hysteron::Start::Fitted).unwrap();
    let forward = Verdict::of_forward(&fitted, &whole, &run).unwrap();
    assert_eq!(
        (forward.grade, forward.percent),
        (of_fit.grade, of_fit.percent)
    );
    // As from another start, or with weights that were changed since.
    let mut other = evaluate(&fitted, &whole).unwrap();
    other.output_model.iter_mut().for_each(|y| *y += 9.0);
    (other.forward.rmse, other.forward.nrmse_percent) = (9.0, Some(24.0));
    let other = Verdict::of_evaluation(&fitted, &whole, &other).unwrap();
    assert_eq!((other.basis, other.grade), (Basis::Fitted, Grade::Poor));
}

/// Readings that stand out are named where the error is in them, and what mends them. The worst
/// sample of a fit is none of its outliers.
#[test]
fn wrong_readings_are_named() {
    for seed in 0..20 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let truth = model(&weights(&mut rng));
        let clean = recording(&truth, |_, y| y);
        let (_, (low, high)) = clean.ranges();
        let mut places: Vec<usize> = (0..12).map(|_| rng.random_range(20..880)).collect();
        places.sort_unstable();
        places.dedup_by(|a, b| *a < *b + 5);
        let spike = (high - low) * if rng.random() { 1.5 } else { -1.5 };
        let spiky = recording(&truth, |n, y| match places.contains(&n) {
            true => y + spike,
            false => y,
        });
        let (verdict, _) = judged(&truth, &spiky);
        let first = &verdict.causes[0];
        assert!(
            matches!(first, Cause::Readings { .. }),
            "seed {seed}: {first:?}"
        );
        assert!(
            verdict.next().to_string().contains("`prepare`"),
            "seed {seed}"
        );
        let fitted = Fit::new().levels(12).bootstrap(0).run(&spiky).unwrap();
        let outliers = &fitted.fit.as_ref().unwrap().outliers;
        assert!(!outliers.is_empty(), "seed {seed}");
        let worst = Verdict::of_fit(&fitted, &spiky).unwrap().worst.unwrap();
        let mut outliers = outliers.iter();
        assert!(
            outliers.all(|outlier| outlier.sample != worst.sample),
            "seed {seed}"
        );
    }
}

/// A grade that a rival or the load lowers has its reason, and what is given is not asked for.
#[test]
fn a_lowered_grade_has_a_reason_and_no_step_asks_for_what_is_given() {
    for seed in 0..60 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let truth = model(&weights(&mut rng));
        let size = rng.random_range(0.0..3.0);
        let mut found = match seed % 2 {
            0 => recording(&truth, |n, y| y + size * (n as f64 * 0.37).sin()),
            _ => Recording::new(input(900), input(900)).unwrap(),
        };
        if rng.random() {
            found.time = Some((0..900).map(f64::from).collect());
        }
        if rng.random() {
            found.load = Some(vec![1.0; 900]);
        }
        let (verdict, _) = judged(&truth, &found);
        let percent = verdict.percent.unwrap();
        let lowered = match verdict.grade {
            Grade::Usable => percent <= 1.0,
            Grade::Poor => percent <= 5.0,
            _ => false,
        };
        assert!(
            !lowered || !verdict.causes.is_empty(),
            "seed {seed}: {verdict}"
        );
        let next = verdict.next().to_string();
        assert!(
            !(verdict.has_time && next.contains("`time`")),
            "seed {seed}: {next}"
        );
        let asks = next.contains("`load`") && !next.contains("with the time as");
        assert!(!(verdict.has_load && asks), "seed {seed}: {next}");
    }
}

/// An input that goes from set point to set point: what is right of it is not called wrong, and a few
/// of them are no test.
#[test]
fn few_set_points_are_no_promise() {
    let mut rng = ChaCha8Rng::seed_from_u64(31);
    let plant = model(&weights(&mut rng));
    let range = plant.output_range();
    let noise = 0.003 * (range.1 - range.0);
    // The last ones are at eight places, over and over.
    for (points, held, again) in [(30, 40, false), (400, 3, false), (400, 3, true)] {
        let mut input = Vec::new();
        for _ in 0..points {
            let at = match again {
                true => 20.0 + 60.0 / 7.0 * f64::from(rng.random_range(0..8)),
                false => rng.random_range(20.0..80.0),
            };
            input.extend(std::iter::repeat_n(at, held));
        }
        let output = plant.simulate(&input).unwrap();
        let noisy = |y: f64| y + noise * rng.random_range(-1.0..1.0);
        let output = output.into_iter().map(noisy).collect();
        let recording = Recording::new(input, output).unwrap();
        let model = Fit::new().run(&recording).unwrap();
        let verdict = Verdict::of_fit(&model, &recording).unwrap();
        let is_few = |cause: &Cause| matches!(cause, Cause::FewPoints { .. });
        let few = verdict.causes.iter().any(is_few);
        assert_eq!(few, points == 30 || again, "{verdict}");
        assert_eq!(verdict.grade == Grade::Good, !few, "{verdict}");
        let advice = hysteron::advice(&model, &[recording]).unwrap();
        let is_cured = |one: &hysteron::Advice| one.is_cured_by_preparation();
        assert!(!advice.iter().any(is_cured), "{advice:?}");
    }
}

/// One or two loops over and over: what a fit leaves out is a copy of what it keeps. As many
/// branches that differ are a test.
#[test]
fn copies_of_few_branches_are_no_promise() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let plant = model(&weights(&mut rng));
    let range = plant.output_range();
    let noise = 0.001 * (range.1 - range.0);
    let mut recorded = |sizes: &dyn Fn(f64) -> f64| {
        let swing = |n: i32| 50.0 - sizes(f64::from(n)) * (0.1 * f64::from(n)).cos();
        let input: Vec<f64> = (0..1500).map(swing).collect();
        let output = plant.simulate(&input).unwrap();
        let noisy = |y: f64| y + noise * rng.random_range(-1.0..1.0);
        Recording::new(input, output.into_iter().map(noisy).collect()).unwrap()
    };
    let equal = recorded(&|_| 30.0);
    let two = recorded(&|n| {
        if (n * 0.1 / std::f64::consts::TAU) as i32 % 2 == 0 {
            30.0
        } else {
            17.0
        }
    });
    let many = recorded(&|n| 30.0 - 0.015 * n);
    let fit = |recording: &Recording| Fit::new().run(recording).unwrap();
    for recording in [&equal, &two] {
        let model = fit(recording);
        let verdict = Verdict::of_fit(&model, recording).unwrap();
        assert!(verdict.percent.unwrap() < 1.0, "{verdict}");
        assert_eq!(verdict.grade, Grade::Usable, "{verdict}");
        assert!(verdict.to_string().contains("the other"), "{verdict}");
        assert_eq!(Verdict::of_record(&model).unwrap().grade, Grade::Usable);
    }
    // The same loop again is no test of a model of it; other loops are.
    let model = fit(&equal);
    assert_eq!(judged(&model, &recorded(&|_| 30.0)).0.grade, Grade::Usable);
    let model = fit(&many);
    let verdict = Verdict::of_fit(&model, &many).unwrap();
    assert_eq!(verdict.grade, Grade::Good, "{verdict}");
    assert_eq!(judged(&model, &equal).0.grade, Grade::Good);
}

/// Where another recording was held out, its error, its reasons and its worst sample are told.
#[test]
fn what_was_held_out_is_judged_by_itself() {
    let plant = model(&[0.5; 78]);
    let first = recording(&plant, |_, y| y);
    let mut second = recording(&plant, |n, y| 1.3 * y + if n == 500 { 8.0 } else { 0.0 });
    // Other inputs, so that it is another recording.
    second.input.iter_mut().for_each(|x| *x += 1e-6);
    let what = HoldOut::Recordings(vec![second]);
    let (model, report) = fit_holding_out(&Fit::new().bootstrap(0), &first, &what).unwrap();
    let verdict = Verdict::of_fit_holding_out(&model, &first, Some(&what)).unwrap();
    assert_eq!(verdict.basis, Basis::OtherRecording);
    assert_eq!(verdict.percent, report.model.nrmse_percent);
    let best = report
        .rivals
        .iter()
        .map(|rival| rival.errors.nrmse_percent.unwrap());
    assert_eq!(
        verdict.rival.as_ref().unwrap().1,
        best.fold(f64::INFINITY, f64::min)
    );
    assert!(
        matches!(&verdict.causes[0], Cause::Part(part) if part.kind == PartKind::Gain),
        "{verdict}"
    );
    assert_eq!(verdict.worst.as_ref().unwrap().sample, 500);
    assert!(
        !verdict.next().to_string().contains("another recording"),
        "{verdict}"
    );
    // A part of the recording that was fitted is judged with it.
    let part = HoldOut::Branches(0.2);
    let (model, _) = fit_holding_out(&Fit::new().bootstrap(0), &first, &part).unwrap();
    let of_part = Verdict::of_fit_holding_out(&model, &first, Some(&part)).unwrap();
    assert_eq!(of_part, Verdict::of_fit(&model, &first).unwrap());
}

/// A recording of a plant whose output comes late, with the speeds in turn.
fn late(plant: &Model, seed: u64, speeds: [f64; 3]) -> Recording {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut input = vec![20.0_f64];
    for n in 0..40 {
        let last = input[input.len() - 1];
        let end = match n % 2 == 0 {
            true => rng.random_range(55.0..80.0),
            false => rng.random_range(20.0..45.0),
        };
        let count = ((end - last).abs() / speeds[n % 3]).ceil();
        input.extend((1..=count as i32).map(|k| last + (end - last) * f64::from(k) / count));
    }
    let mut lagged = 3.0;
    let late = plant.simulate(&input).unwrap().into_iter().map(|y| {
        lagged += (y - lagged) / 5.0;
        lagged + 0.01 * rng.random_range(-1.0..1.0)
    });
    let output = late.collect();
    let mut recording = Recording::new(input, output).unwrap();
    recording.time = Some((0..recording.len()).map(|n| n as f64).collect());
    recording
}

fn is_at_one_speed(verdict: &Verdict) -> bool {
    let one = |cause: &Cause| matches!(cause, Cause::OneSpeed { .. });
    verdict.causes.iter().any(one)
}

/// A lag that was found at one speed is a wider loop at that speed; at several it is a lag.
#[test]
fn a_lag_found_at_one_speed_is_no_promise() {
    let plant = model(&weights(&mut ChaCha8Rng::seed_from_u64(3)));
    for (speeds, is_one) in [([0.8, 0.8, 0.8], true), ([0.4, 0.8, 1.6], false)] {
        let recording = late(&plant, 4, speeds);
        let model = Fit::new().bootstrap(0).run(&recording).unwrap();
        assert!(model.is_timed());
        let verdict = Verdict::of_fit(&model, &recording).unwrap();
        assert_eq!(is_at_one_speed(&verdict), is_one, "{verdict}");
        assert_eq!(verdict.grade == Grade::Good, !is_one, "{verdict}");
        assert_eq!(
            verdict.next().to_string().contains("two speeds"),
            is_one,
            "{verdict}"
        );
    }
}

/// A part of what was fitted has one speed where all of it has two: that is no cause.
#[test]
fn all_of_what_was_fitted_tells_its_speeds() {
    let plant = model(&weights(&mut ChaCha8Rng::seed_from_u64(3)));
    let both = [0.4, 1.6].map(|speed| late(&plant, 4, [speed; 3]));
    let fitted = Fit::new().bootstrap(0).run(&both).unwrap();
    assert!(fitted.is_timed());
    for one in &both {
        let evaluation = evaluate(&fitted, one).unwrap();
        let verdict = Verdict::of_evaluation(&fitted, one, &evaluation).unwrap();
        assert!(!is_at_one_speed(&verdict), "{verdict}");
    }
}

/// What another speed changes looks like a gain: to adapt to it would spoil the model.
#[test]
fn another_speed_is_told_of_a_model_without_what_comes_late() {
    let plant = model(&weights(&mut ChaCha8Rng::seed_from_u64(3)));
    let [slow, fast] = [0.4, 3.2].map(|speed| late(&plant, 4, [speed; 3]));
    let fit = Fit::new().bootstrap(0).dynamics(Dynamics::Off).delay(0);
    let fitted = fit.run(&slow).unwrap();
    assert!(!fitted.is_timed());
    let evaluation = evaluate(&fitted, &fast).unwrap();
    let verdict = Verdict::of_evaluation(&fitted, &fast, &evaluation).unwrap();
    let first = &verdict.causes[0];
    assert!(
        matches!(first, Cause::OtherSpeed { late: false, .. }),
        "{verdict}"
    );
    assert!(
        verdict.next().to_string().contains("both recordings"),
        "{verdict}"
    );
}

/// A sensor at its limit, and one that is read seldom: a model follows both, and errs elsewhere.
#[test]
fn what_a_sensor_did_not_see_is_no_promise() {
    let plant = model(&[0.5; 78]);
    let (off, on) = plant.output_range();
    let high = on - 0.3 * (on - off);
    let clean = recording(&plant, |_, y| y);
    let mut held = clean.clone();
    for n in 0..held.len() {
        held.input[n] = clean.input[n - n % 6];
    }
    let cases = [
        (clean.clone(), None),
        (recording(&plant, |_, y| y.min(high)), Some("clipped")),
        (held, Some("held_input")),
    ];
    for (recording, name) in cases {
        let fitted = Fit::new().bootstrap(0).run(&recording).unwrap();
        let verdict = Verdict::of_fit(&fitted, &recording).unwrap();
        let names: Vec<_> = verdict.causes.iter().map(Cause::name).collect();
        let mut both = ["clipped", "held_input"].into_iter();
        let found = both.find(|name| names.contains(name));
        assert_eq!(found, name, "{verdict}");
        assert!(name.is_none() || verdict.grade != Grade::Good, "{verdict}");
    }
}

/// What is held out may be much easier than what is fitted: then what was fitted tells.
#[test]
fn an_easy_part_is_no_proof_of_the_rest() {
    let plant = model(&[0.5; 78]);
    let disturbed = |size: f64| {
        move |n: usize, y: f64| match n < 600 {
            true => y + size * (n as f64 * 0.9).sin().signum(),
            false => y,
        }
    };
    let end = HoldOut::Branches(0.2);
    for size in [0.0, 1.0] {
        let mut recording = recording(&plant, disturbed(size));
        recording.time = Some((0..recording.len()).map(|n| n as f64).collect());
        let fit = Fit::new().bootstrap(0).robust(false);
        let (model, report) = fit_holding_out(&fit, &recording, &end).unwrap();
        let verdict = Verdict::of_fit(&model, &recording).unwrap();
        assert_eq!(verdict.basis, Basis::HeldOut, "{verdict}");
        assert_ne!(verdict.grade, Grade::Untested, "{verdict}");
        let easier = verdict.causes.iter().find_map(|cause| match cause {
            Cause::Easier { percent } => Some(*percent),
            _ => None,
        });
        let fitted = model.fit.as_ref().unwrap();
        let is_easy = fitted.rmse > 1.5 * report.model.rmse;
        assert_eq!(easier, is_easy.then_some(fitted.nrmse_percent), "{verdict}");
        if size > 0.0 {
            assert!(is_easy && verdict.grade != Grade::Good, "{verdict}");
        }
    }
}

/// An output that has nothing to do with the input, in any size and with any noise of the input: it
/// is called so, and nothing is said of noise to be averaged. One that has, is not called so.
#[test]
fn an_output_that_does_not_follow_is_called_so() {
    for seed in 0..12 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let model = model(&weights(&mut rng));
        let clean = recording(&model, |_, y| y);
        let (_, (low, high)) = clean.ranges();
        let size = (high - low) * 10_f64.powi(rng.random_range(-3..4));
        let mut walk = 0.0;
        let output: Vec<f64> = clean
            .input
            .iter()
            .map(|_| {
                let step = size * rng.random_range(-1.0..1.0);
                // White, or a bounded walk.
                walk = 0.9 * walk + step;
                if seed % 2 == 0 { step } else { walk }
            })
            .collect();
        let noise = Recording::new(clean.input.clone(), output).unwrap();
        let fitted = Fit::new().run(&noise).unwrap();
        for verdict in [
            Verdict::of_fit(&fitted, &noise).unwrap(),
            judged(&model, &noise).0,
        ] {
            let names: Vec<&str> = verdict.causes.iter().map(Cause::name).collect();
            assert_eq!(names.first(), Some(&"unrelated"), "seed {seed}: {verdict}");
            assert!(!names.contains(&"noise"), "seed {seed}: {verdict}");
            assert_eq!(verdict.grade, Grade::Poor, "seed {seed}");
        }
        let noisy = recording(&model, |_, y| {
            y + (high - low) * rng.random_range(-0.2..0.2)
        });
        let (verdict, _) = judged(&model, &noisy);
        let names: Vec<&str> = verdict.causes.iter().map(Cause::name).collect();
        assert!(!names.contains(&"unrelated"), "seed {seed}: {verdict}");
    }
}

/// A model of one loop errs elsewhere because it saw one loop, whatever else may be said.
#[test]
fn few_branches_are_told_of_another_recording_too() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    // A few operators anywhere: the outermost loop does not tell them apart.
    let few: Vec<f64> = (0..78)
        .map(|_| rng.random_range(-8.0_f64..1.0).max(0.0))
        .collect();
    let model = model(&few);
    let loops = recording(&model, |_, y| y);
    let rows = one_loop(&loops);
    let one = Recording::new(loops.input[..rows].to_vec(), loops.output[..rows].to_vec()).unwrap();
    let fitted = Fit::new().bootstrap(0).run(&one).unwrap();
    let (verdict, evaluation) = judged(&fitted, &loops);
    assert!(evaluation.forward.nrmse_percent.unwrap() > 1.0, "{verdict}");
    let few = |cause: &Cause| matches!(cause, Cause::FewBranches { .. });
    assert!(verdict.causes.iter().any(few), "{verdict}");
}

/// The rows from the start to the second reversal.
fn one_loop(recording: &Recording) -> usize {
    let turns = recording.input.windows(3).enumerate();
    let mut turns = turns.filter(|(_, x)| (x[1] - x[0]) * (x[2] - x[1]) < 0.0);
    turns.nth(1).map_or(recording.len(), |(n, _)| n + 2)
}

#[test]
fn doubts_come_before_all_else() {
    let model = model(&weights(&mut ChaCha8Rng::seed_from_u64(6)));
    let recording = recording(&model, |_, y| 2.0 * y);
    let (verdict, _) = judged(&model, &recording);
    let same = verdict.clone().doubting(0);
    assert_eq!(same, verdict);
    let doubted = verdict.doubting(2);
    assert_eq!(doubted.causes[0].name(), "doubted");
    let lines = doubted.lines(|setting| setting.name.to_owned());
    let next = &lines
        .iter()
        .find(|(heading, _)| *heading == "next")
        .unwrap()
        .1;
    assert!(next.starts_with("look at the rows in doubt"), "{next}");
}
