//! What is held out takes no part in a fit, and is judged beside simple rivals.

use hysteron::{
    Auto, Fit, HeldOut, HoldOut, Model, Operator, Plane, Recording, Sign, Start, fit_holding_out,
    held_out,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A model with random weights, and a random zigzag through it with `noise`.
fn measured(seed: u64, reversals: usize, noise: f64) -> (Model, Recording) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let plane = Plane::new(0.1, 1.0, 10).unwrap();
    let weights = (0..55).map(|_| rng.random_range(0.0..1.0)).collect();
    let model = Model::new(Operator::Mkp, plane, weights, 0.5, Sign::Positive).unwrap();
    let mut input = vec![0.0];
    for k in 0..reversals {
        let from = *input.last().unwrap();
        let to = match k {
            0 => 1.0,
            _ if k % 2 == 0 => rng.random_range(f64::midpoint(from, 1.0)..1.0),
            _ => rng.random_range(0.0..0.5 * from),
        };
        input.extend((1..=20).map(|n| from + (to - from) * f64::from(n) / 20.0));
    }
    let mut output = model.simulate(&input).unwrap();
    let (low, high) = model.output_range();
    for y in &mut output {
        *y += noise * (high - low) * rng.random_range(-1.0..1.0);
    }
    (model, Recording::new(input, output).unwrap())
}

/// Every way of holding out, for a recording of this length.
fn ways(length: usize) -> [HoldOut; 7] {
    [
        HoldOut::Branches(0.2),
        HoldOut::Branches(1.0 / 3.0),
        HoldOut::Rows(vec![length - 100..=length]),
        HoldOut::Rows(vec![120..=260]),
        HoldOut::Rows(vec![1..=50]),
        // Row 51 is left alone between them.
        HoldOut::Rows(vec![1..=50, 52..=90]),
        HoldOut::Rows(vec![300..=340, 1..=50, 120..=180, 150..=200]),
    ]
}

#[test]
fn what_is_held_out_takes_no_part() {
    for seed in 0..6 {
        let (_, recording) = measured(seed, 24, 0.01);
        for what in ways(recording.len()) {
            let split = recording.split(&what).unwrap();
            let mut other = recording.clone();
            for (y, held) in other.output.iter_mut().zip(&split.held_out) {
                if *held {
                    *y = 100.0 - 3.0 * *y;
                }
            }
            let fit = Fit::new().levels(8).smooth(Auto).bootstrap(20);
            let (model, report) = fit_holding_out(&fit, &recording, &what).unwrap();
            let (again, worse) = fit_holding_out(&fit, &other, &what).unwrap();
            assert_eq!(model.weights(), again.weights(), "seed {seed}, {what:?}");
            let summary = |model: &Model| {
                let mut fit = model.fit.clone().unwrap();
                fit.other.remove("hold_out").unwrap();
                fit
            };
            assert_eq!(summary(&model), summary(&again));
            assert!(worse.model.rmse > 10.0 * report.model.rmse);
            let count = split.held_out.iter().filter(|held| **held).count();
            assert_eq!(report.model.samples, count);
            let training: usize = split.training.iter().map(Recording::len).sum();
            assert_eq!(training + count, recording.len());
        }
    }
}

/// The weights of a fit to a part are those of the truth, so the operators have seen the same
/// history as with the whole.
#[test]
fn without_a_branch_the_operators_remember_the_same() {
    for seed in 0..6 {
        let (truth, recording) = measured(seed, 40, 0.0);
        for share in [0.05, 0.1, 0.25, 1.0 / 3.0] {
            let split = recording.split(&HoldOut::Branches(share)).unwrap();
            let modelled = truth.simulate(&recording.input).unwrap();
            let kept: Vec<f64> = (0..recording.len())
                .filter(|n| !split.held_out[*n])
                .map(|n| modelled[n])
                .collect();
            let alone = truth.simulate(&split.training[0].input).unwrap();
            for (a, b) in kept.iter().zip(&alone) {
                // Rounding of sums of 55 weights.
                assert!((a - b).abs() < 1e-10, "seed {seed}, {share}: {a} {b}");
            }
        }
    }
}

#[test]
fn branches_are_spread_and_of_both_directions() {
    for seed in 0..10 {
        for reversals in [3, 4, 5, 8, 21, 40, 77] {
            let (_, recording) = measured(seed, reversals, 0.0);
            for share in [0.01, 0.1, 0.2, 0.25, 0.3] {
                let split = recording.split(&HoldOut::Branches(share)).unwrap();
                let branch = |n: usize| n.saturating_sub(1) / 20;
                let held = (0..recording.len()).filter(|n| split.held_out[*n]);
                let mut branches: Vec<usize> = held.map(branch).collect();
                branches.dedup();
                let wanted = (share * reversals as f64).round().max(1.0) as usize;
                assert!(
                    branches.len() <= wanted && 4 * branches.len() >= 3 * wanted.min(reversals / 3)
                );
                assert!(branches.iter().all(|b| *b > 0));
                assert!(
                    branches.windows(2).all(|pair| pair[1] > pair[0] + 1),
                    "{branches:?}"
                );
                let even = branches.iter().filter(|b| **b % 2 == 0).count();
                let odd = branches.len() - even;
                // Of a handful of branches there may be no two that are apart and differ.
                let balanced = even.abs_diff(odd) <= 1 + branches.len() / 4;
                assert!(balanced || reversals < 8, "{branches:?}");
            }
        }
    }
}

#[test]
fn a_good_model_beats_the_rivals_and_a_line_beats_a_bad_one() {
    let (_, recording) = measured(3, 24, 0.0);
    let fit = Fit::new().levels(10).bootstrap(0);
    for what in ways(recording.len()).iter().take(4) {
        let (model, report) = fit_holding_out(&fit, &recording, what).unwrap();
        assert_eq!(report.better().count(), 0, "{what:?}: {report:?}");
        // The fit of a part of the same model finds nearly the whole of it.
        assert!(
            report.model.nrmse_percent.unwrap() < 1.0,
            "{what:?}: {report:?}"
        );
        let fit = model.fit.unwrap();
        let kept = &fit.other["hold_out"];
        assert_eq!(kept["model"]["rmse"].as_f64(), Some(report.model.rmse));
        assert_eq!(kept["rivals"][0]["name"], "straight line");
    }
    // A line with noise, and an operator for each sample.
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let input: Vec<f64> = (0..90).map(|n| (f64::from(n) * 0.35).sin()).collect();
    let output = input
        .iter()
        .map(|x| x + rng.random_range(-0.2..0.2))
        .collect();
    let line = Recording::new(input, output).unwrap();
    let fit = Fit::new().levels(30).smooth(0.0).bootstrap(0);
    let (_, report) = fit_holding_out(&fit, &line, &HoldOut::Rows(vec![61..=90])).unwrap();
    let better: Vec<&str> = report.better().map(|rival| rival.name).collect();
    assert!(better.contains(&"straight line"), "{report:?}");
}

#[test]
fn other_recordings_can_be_held_out() {
    let (truth, recording) = measured(5, 24, 0.0);
    let (_, mut other) = measured(6, 12, 0.0);
    other.output = truth.simulate(&other.input).unwrap();
    let model = Fit::new().levels(10).bootstrap(0).run(&recording).unwrap();
    let report = held_out(&model, &recording, &other).unwrap();
    let evaluated = hysteron::evaluate(&model, &other).unwrap();
    assert_eq!(report.model, evaluated.forward);
    assert!(held_out(&model, &recording, &[]).is_err());
    // After a fit from all operators on, the model starts there too.
    let model = Fit::new()
        .start(Start::On)
        .bootstrap(0)
        .run(&recording)
        .unwrap();
    let report = held_out(&model, &recording, &other).unwrap();
    let from_on = hysteron::evaluate_from(&model, &other, Start::On).unwrap();
    assert_eq!(report.model, from_on.forward);
}

#[test]
fn what_cannot_be_held_out_is_refused() {
    let (_, recording) = measured(1, 12, 0.0);
    let length = recording.len();
    for what in [
        HoldOut::Branches(0.0),
        HoldOut::Branches(-0.2),
        HoldOut::Branches(0.5),
        HoldOut::Branches(f64::NAN),
        HoldOut::Rows(vec![0..=3]),
        HoldOut::Rows(vec![1..=9, 0..=3]),
        HoldOut::Rows(vec![1..=100, 101..=length]),
        HoldOut::Rows(vec![]),
        HoldOut::Rows(vec![1..=length]),
        HoldOut::Rows(vec![length..=length + 1]),
        #[allow(clippy::reversed_empty_ranges)]
        HoldOut::Rows(vec![9..=3]),
    ] {
        assert!(recording.split(&what).is_err(), "{what:?}");
    }
    let one_loop = recording.only(|n| n < 30).unwrap();
    let refused = one_loop.split(&HoldOut::Branches(0.2)).unwrap_err();
    assert!(refused.to_string().contains("three or more"), "{refused}");
    let two = [recording.clone(), recording.clone()];
    let rows = HoldOut::Rows(vec![1..=2 * length]);
    assert!(fit_holding_out(&Fit::new(), &two, &rows).is_err());
    // A lag needs every sample before a row.
    let mut timed = recording;
    timed.time = Some((0..length).map(|n| n as f64).collect());
    let fit = Fit::new().levels(8).bootstrap(0);
    // Nobody asked for a ring: branches can be held out as without time.
    assert!(fit_holding_out(&fit, &timed, &HoldOut::Branches(0.2)).is_ok());
    let lag = fit.lag(2.0);
    let refused = fit_holding_out(&lag, &timed, &HoldOut::Rows(vec![9..=20])).unwrap_err();
    assert!(refused.to_string().contains("rows at the"), "{refused}");
    assert!(fit_holding_out(&lag, &timed, &HoldOut::Rows(vec![length - 50..=length])).is_ok());
    // So the last branches are held out, and not some between.
    assert!(fit_holding_out(&lag, &timed, &HoldOut::Branches(0.2)).is_ok());
}

/// What comes late is found although a share of the branches is held out: these are the last ones.
/// Of an input that dies down they would be the easy ones, so there they are spread, and it is said
/// that nothing was looked for.
#[test]
fn a_dead_time_is_found_beside_branches_that_are_held_out() {
    let plane = Plane::new(0.0, 100.0, 15).unwrap();
    let plant = Model::new(Operator::Mkp, plane, vec![1.0; 120], 3.0, Sign::Positive).unwrap();
    let recorded = |dies_down: bool| {
        let size = |n: f64| match dies_down {
            true => 50.0 * (1.0 - n / 1500.0),
            false => 35.0 + 15.0 * (0.31 * n).sin(),
        };
        let swing = (0..1500).map(|n| 50.0 - size(f64::from(n)) * (0.05 * f64::from(n)).cos());
        let input: Vec<f64> = swing.collect();
        let late: Vec<f64> = (0..1500)
            .map(|n: usize| input[n.saturating_sub(3)])
            .collect();
        Recording {
            time: Some((0..1500).map(|n| 0.1 * f64::from(n)).collect()),
            ..Recording::new(input, plant.simulate(&late).unwrap()).unwrap()
        }
    };
    let fit = Fit::new().levels(12).bootstrap(0);
    let (found, report) = fit_holding_out(&fit, &recorded(false), &HoldOut::Branches(0.2)).unwrap();
    assert_eq!(found.delay().samples(), 3);
    assert!(!report.without_dynamics && report.at_end);
    let held = recorded(false).split_end(0.2).unwrap().held_out;
    let count = held.iter().filter(|held| **held).count();
    assert!(held.ends_with(&vec![true; count]) && report.model.samples == count);
    assert_eq!(
        HeldOut::from_record(&found.fit.as_ref().unwrap().other["hold_out"]),
        Some(report.clone())
    );
    assert!(report.model.nrmse_percent.unwrap() < 1.0, "{report:?}");
    let (found, report) = fit_holding_out(&fit, &recorded(true), &HoldOut::Branches(0.2)).unwrap();
    assert!(found.delay().is_none() && report.without_dynamics);
    assert!(!report.at_end);
}

/// Rows are counted through all recordings: a span over the border takes the end of one and the
/// beginning of the next, and a whole recording may be held out.
#[test]
fn rows_of_several_recordings_are_counted_through_all() {
    let (_, recording) = measured(1, 12, 0.0);
    let length = recording.len();
    let three = [0.0, 0.01, 0.02].map(|offset| {
        let mut other = recording.clone();
        other.output.iter_mut().for_each(|y| *y += offset);
        other
    });
    let three = three.to_vec();
    let fit = Fit::new().levels(8).bootstrap(0);
    let held = |rows: std::ops::RangeInclusive<usize>| {
        let what = HoldOut::Rows(vec![rows.clone()]);
        let (model, report) = fit_holding_out(&fit, &three, &what).unwrap();
        assert_eq!(report.model.samples, rows.count());
        let fitted = model.fit.unwrap().samples;
        assert_eq!(fitted + report.model.samples, 3 * length);
    };
    held(2 * length - 20..=2 * length + 30);
    held(length + 1..=2 * length);
    held(1..=length + 5);
    // One recording held out as rows is that recording held out as a file.
    let rows = HoldOut::Rows(vec![2 * length + 1..=3 * length]);
    let (as_rows, tested) = fit_holding_out(&fit, &three, &rows).unwrap();
    let other = HoldOut::Recordings(three[2..].to_vec());
    let (as_file, told) = fit_holding_out(&fit, &three[..2], &other).unwrap();
    assert_eq!(as_rows.weights(), as_file.weights());
    assert_eq!(tested.model.rmse, told.model.rmse);
    // A part and a recording together: the model is that of the part alone, the errors are over both.
    let part = || HoldOut::Branches(0.2);
    let both = HoldOut::together(Some(part()), three[2..].to_vec()).unwrap();
    let (with_both, of_both) = fit_holding_out(&fit, &three[..2], &both).unwrap();
    let (with_part, of_part) = fit_holding_out(&fit, &three[..2], &part()).unwrap();
    assert_eq!(with_both.weights(), with_part.weights());
    let of_file = held_out(&with_part, &three[..2], &three[2..]).unwrap();
    let samples = |report: &HeldOut| report.model.samples as f64;
    assert_eq!(samples(&of_both), samples(&of_part) + samples(&of_file));
    let squares = |report: &HeldOut| samples(report) * report.model.rmse.powi(2);
    let sum = squares(&of_part) + squares(&of_file);
    // Sums in another order differ by rounding.
    assert!((squares(&of_both) / sum - 1.0).abs() < 1e-9);
    // What was fitted is no test.
    let again = HoldOut::Recordings(three[..1].to_vec());
    let refused = fit_holding_out(&fit, &three[..2], &again).unwrap_err();
    assert!(
        refused.to_string().contains("among those fitted"),
        "{refused}"
    );
}
