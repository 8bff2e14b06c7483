//! The inverse against the forward model, and against the chapter's candidate formulas.

use crate::common::{OPERATORS, build, inputs, levels, plane, rng, weights};
use hysteron_core::{
    Definition, Direction, Error, Operator, Plane, Status, Target, operator_count, operator_index,
};
use rand::{Rng, RngExt};

/// `|H(H⁻¹(y)) − y|` over a walk of targets, relative to the range of the output. A separate
/// forward model steps through the inputs.
fn worst_return(plane: Plane<f64>, operator: Operator, weights: &[f64], rng: &mut impl Rng) -> f64 {
    let (model, mut state) = build(plane, operator, weights);
    let (_, mut forward) = build(plane, operator, weights);
    for input in inputs(rng, &plane, 100) {
        model.step(&mut state, input).unwrap();
        model.step(&mut forward, input).unwrap();
    }
    let inverse = model.inverse().unwrap();
    let (low, high) = model.output_range();
    let (mut y, mut worst) = (model.output(&state), 0.0_f64);
    for n in 0..300 {
        y = match n % 7 {
            0 => rng.random_range(low..=high),
            1 => y, // repeated
            2 => high,
            3 => low,
            _ => (y + (high - low) * rng.random_range(-0.2..0.2)).clamp(low, high),
        };
        let solution = inverse.step(&mut state, Target::new(y)).unwrap();
        assert_eq!(solution.status, Status::Ok);
        let reached = model.step(&mut forward, solution.input).unwrap().output;
        worst = worst.max((reached - y).abs() / (high - low));
    }
    assert_eq!(state, forward, "the inverse follows the same states");
    worst
}

#[test]
fn the_forward_model_returns_every_reachable_target() {
    let mut overall = 0.0_f64;
    for seed in 0..500 {
        let mut rng = rng(seed);
        let k = levels(&mut rng, 200);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let operator = if seed % 2 == 0 {
            Operator::Mkp
        } else {
            Operator::Kp
        };
        let worst = worst_return(plane, operator, &weights, &mut rng);
        assert!(worst <= 1e-12, "seed {seed}, K = {k}: {worst:e}");
        overall = overall.max(worst);
    }
    println!("|H(H⁻¹(y)) − y| / range, 500 walks of 300 targets: largest {overall:.1e}");
}

/// Equations (9) and (10): the input for a larger output, from the operator states.
fn rising_candidates(plane: &Plane<f64>, mu: &[f64], xi: &[f64], target: f64) -> f64 {
    let k = plane.levels();
    let at = |i: usize, j: usize| operator_index(i, j);
    let rows_above = |m: usize| -> f64 {
        (m + 1..=k)
            .flat_map(|j| (1..=j).map(move |i| at(i, j)))
            .map(|n| xi[n] * mu[n])
            .sum()
    };
    // The output at β_m: rows up to m fully on, the others as they are.
    let below = |m: usize| -> f64 { mu[..operator_count(m)].iter().sum() };
    let m = (1..=k)
        .find(|&m| below(m) + rows_above(m) >= target)
        .unwrap_or(k);
    let e = (1..=m).filter(|&i| xi[at(i, m)] >= 1.0).count();
    let f = (1..=m)
        .filter(|&i| xi[at(i, m)] > 0.0 && xi[at(i, m)] < 1.0)
        .count();
    let rest = target - below(m - 1) - rows_above(m) - (1..=e).map(|i| mu[at(i, m)]).sum::<f64>();
    (0..=f)
        .filter_map(|n| {
            let still: f64 = (e + 1..=e + f - n)
                .map(|i| xi[at(i, m)] * mu[at(i, m)])
                .sum();
            let moved: f64 = (e + f - n + 1..=m).map(|i| mu[at(i, m)]).sum();
            // Where no operator moves, there is no candidate.
            (moved > 0.0).then(|| plane.level(m - 1) + plane.step() * (rest - still) / moved)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Equations (12) and (13): the input for a smaller output.
fn falling_candidates(plane: &Plane<f64>, mu: &[f64], xi: &[f64], target: f64) -> f64 {
    let k = plane.levels();
    let at = |i: usize, j: usize| operator_index(i, j);
    let columns_left = |m: usize| -> f64 {
        (1..m)
            .flat_map(|i| (i..=k).map(move |j| at(i, j)))
            .map(|n| xi[n] * mu[n])
            .sum()
    };
    // The output at α_{m−1}: columns from m on fully off.
    let m = (1..=k)
        .rev()
        .find(|&m| columns_left(m) <= target)
        .unwrap_or(1);
    let on = (m..=k).filter(|&j| xi[at(m, j)] >= 1.0).count();
    let f = (m..=k)
        .filter(|&j| xi[at(m, j)] > 0.0 && xi[at(m, j)] < 1.0)
        .count();
    (0..=f)
        .filter_map(|n| {
            let moved: f64 = (m..m + on + n).map(|j| mu[at(m, j)]).sum();
            let still: f64 = (m + on + n..m + on + f)
                .map(|j| xi[at(m, j)] * mu[at(m, j)])
                .sum();
            let rest = target - columns_left(m) - still;
            (moved > 0.0).then(|| plane.level(m - 1) + plane.step() * rest / moved)
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn equals_the_candidate_formulas_of_the_chapter() {
    let (mut rises, mut falls, mut worst) = (0, 0, 0.0_f64);
    for seed in 0..400 {
        let mut rng = rng(9000 + seed);
        let k = levels(&mut rng, 30);
        let plane = plane(&mut rng, k);
        // Weights have a lower bound, so that the output determines the input well.
        let mu: Vec<f64> = (0..operator_count(k))
            .map(|_| rng.random_range(0.1..1.0))
            .collect();
        let (model, mut state) = build(plane, Operator::Mkp, &mu);
        let mut xi = vec![0.0; mu.len()];
        let mut plain = Definition::new(plane, Operator::Mkp, &mu, &mut xi).unwrap();
        let inverse = model.inverse().unwrap();
        for input in inputs(&mut rng, &plane, 60) {
            model.step(&mut state, input).unwrap();
            let now = plain.step(input).unwrap();
            let (_, high) = model.output_range();
            let target = rng.random_range(0.0..high);
            let expected = if target > now {
                rises += 1;
                rising_candidates(&plane, &mu, plain.states(), target)
            } else {
                falls += 1;
                falling_candidates(&plane, &mu, plain.states(), target)
            };
            let found = inverse.solve(&state, Target::new(target)).unwrap().input;
            worst = worst.max((found - expected).abs() / plane.step());
        }
    }
    assert!(
        rises > 5000 && falls > 5000,
        "{rises} rising, {falls} falling"
    );
    // Both solve the same linear pieces. Slopes of at least 0.1 amplify the rounding errors of the
    // sums.
    assert!(worst <= 1e-9, "{worst:e}");
    println!(
        "inverse against (9), (10), (12), (13): {rises} rising, {falls} falling targets, largest difference {worst:.1e} ΔT"
    );
}

#[test]
fn out_of_reach_and_equal_targets() {
    for operator in OPERATORS {
        let plane = Plane::new(20.0, 80.0, 20).unwrap();
        let weights = vec![0.1; 210];
        let (model, mut state) = build(plane, operator, &weights);
        let inverse = model.inverse().unwrap();
        let (low, high) = model.output_range();
        let above = inverse.step(&mut state, Target::new(high + 1.0)).unwrap();
        assert_eq!((above.input, above.status), (80.0, Status::High));
        let below = inverse.step(&mut state, Target::new(low - 1.0)).unwrap();
        assert_eq!((below.input, below.status), (plane.bottom(), Status::Low));
        model.step(&mut state, 51.3).unwrap();
        let same = inverse
            .solve(&state, Target::new(model.output(&state)))
            .unwrap();
        assert_eq!((same.input, same.status), (51.3, Status::Ok));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let before = state.clone();
            let refused = inverse.step(&mut state, Target::new(bad));
            assert_eq!(refused, Err(Error::InputNotFinite { index: 0 }));
            assert_eq!(state, before);
        }
    }
}

/// A single operator: the output rests from 80 down to its left ridge, and from there up to its
/// right one.
fn dead_band() -> (Plane<f64>, Vec<f64>) {
    let mut weights = vec![0.0; operator_count(7)];
    weights[operator_index(2, 6)] = 3.0;
    (Plane::new(20.0, 80.0, 7).unwrap(), weights)
}

#[test]
fn anticipation_crosses_the_dead_band_to_its_edge() {
    let (plane, weights) = dead_band();
    let (model, mut state) = build(plane, Operator::Mkp, &weights);
    let inverse = model.inverse().unwrap();
    let up = inverse.step(&mut state, Target::new(2.0)).unwrap();
    let y = model.output(&state);
    assert_eq!(
        inverse.solve(&state, Target::new(y)).unwrap().input,
        up.input
    );
    let falling = |y| Target::new(y).heading(Some(Direction::Falling));
    let edge = inverse.step(&mut state, falling(y)).unwrap();
    // Operator (2, 6): the left ridge rises from α_1 = 20 to α_2 = 30; two thirds up it stands at
    // 2.
    assert!(
        (edge.input - (20.0 + 10.0 * 2.0 / 3.0)).abs() < 1e-9,
        "{edge:?}"
    );
    assert!((model.output(&state) - y).abs() < 1e-12);
    // At the edge again, nothing is left to cross. Then up, across the whole band.
    assert!((inverse.solve(&state, falling(y)).unwrap().input - edge.input).abs() < 1e-9);
    let rising = Target::new(y).heading(Some(Direction::Rising));
    let back = inverse.solve(&state, rising).unwrap();
    assert!((back.input - up.input).abs() < 1e-9, "{back:?}");
    // A tolerance in the output moves the edge that much further. A target beyond it is held, not
    // anticipated.
    let loose = |y| falling(y).tolerance(0.3);
    assert!((inverse.solve(&state, loose(y)).unwrap().input - (edge.input - 1.0)).abs() < 1e-9);
    let moved = inverse.solve(&state, loose(y + 0.5)).unwrap();
    assert_eq!(moved, inverse.solve(&state, Target::new(y + 0.5)).unwrap());
    // The right ridge rises as steeply, so upwards the edge moves as far.
    let loose = inverse.solve(&state, rising.tolerance(0.3)).unwrap();
    assert!((loose.input - (up.input + 1.0)).abs() < 1e-9);
}

#[test]
fn a_tolerance_keeps_noise_from_crossing_the_dead_band() {
    let (plane, weights) = dead_band();
    // Tolerances are in the output's unit. The output of KP spans twice as much.
    for (operator, unit, offset) in [(Operator::Mkp, 1.0, 0.0), (Operator::Kp, 2.0, -3.0)] {
        let (model, mut state) = build(plane, operator, &weights);
        let inverse = model.inverse().unwrap();
        let mut to = |sum: f64| {
            let held = Target::new(unit * sum + offset).tolerance(0.3 * unit);
            inverse.step(&mut state, held).unwrap()
        };
        let up = to(2.0);
        // Back by less than the tolerance: the input stays. On by as little: it follows. Back by
        // more, but less than twice: it crosses.
        assert_eq!(to(1.8).input, up.input);
        assert!(to(2.1).input > up.input);
        let down = to(1.7);
        assert!(down.input < up.input - 30.0, "{operator:?}: {down:?}");
        assert_eq!(to(1.9).input, down.input);
        assert!((model.output(&state) - (unit * 1.7 + offset)).abs() < 1e-12);
    }
}

#[test]
fn on_a_flat_stretch_the_first_input_is_returned() {
    let (plane, weights) = dead_band();
    let (model, mut state) = build(plane, Operator::Mkp, &weights);
    let inverse = model.inverse().unwrap();
    // Full output is reached at β_6 = 70, and rests up to 80.
    assert!((inverse.step(&mut state, Target::new(3.0)).unwrap().input - 70.0).abs() < 1e-9);
    model.step(&mut state, 80.0).unwrap();
    // Zero is reached at α_1 = 20.
    assert!((inverse.step(&mut state, Target::new(0.0)).unwrap().input - 20.0).abs() < 1e-9);
}

/// Whole numbers, most of them zero, so that flat stretches are common.
fn sparse(rng: &mut impl Rng, levels: usize) -> Vec<f64> {
    let weight = |rng: &mut _| match Rng::next_u32(rng) % 4 {
        0 => f64::from(1 + Rng::next_u32(rng) % 3),
        _ => 0.0,
    };
    (0..operator_count(levels)).map(|_| weight(rng)).collect()
}

#[test]
fn shortly_before_the_solution_the_target_is_not_reached() {
    let mut found = 0;
    for seed in 0..600 {
        let mut rng = rng(600 + seed);
        let k = levels(&mut rng, 8);
        // Inputs equal positions. They are eighths, so that nothing is rounded.
        let plane = Plane::new(1.0, k as f64, k).unwrap();
        let operator = [Operator::Mkp, Operator::Kp][seed as usize % 2];
        let (model, mut state) = build(plane, operator, &sparse(&mut rng, k));
        let inverse = model.inverse().unwrap();
        let mut outputs = Vec::new();
        for _ in 0..40 {
            let input = rng.random_range(0..=8 * k) as f64 / 8.0;
            let now = model.step(&mut state, input).unwrap().output;
            outputs.push(now);
            // Past outputs are often those of turning points.
            let target = outputs[rng.random_range(0..outputs.len())];
            if target == now {
                continue;
            }
            let input = inverse.solve(&state, Target::new(target)).unwrap().input;
            let way = (target - now).signum();
            let before = input - way * 1e-3;
            let short = model.step(&mut state.clone(), before).unwrap().output;
            assert!(way * (target - short) > 1e-4, "seed {seed}: {input}");
            found += 1;
        }
    }
    assert!(found > 5000, "{found}");
}

/// Weights that make nearly flat stretches beside steep ones.
fn steep_and_flat(rng: &mut impl Rng, levels: usize) -> Vec<f64> {
    (0..operator_count(levels))
        .map(|_| [0.0, 1e-13, 2e-13, 1.0][rng.random_range(0..4)])
        .collect()
}

/// An input on a grid line, close to one or halfway between two, where inputs equal positions.
fn among_lines(rng: &mut impl Rng, levels: usize) -> f64 {
    let part = [0.0, 0.01, 0.5, 0.99][rng.random_range(0..4)];
    rng.random_range(0..levels) as f64 + part
}

/// Behind a nearly flat stretch a step too far would give an output far away.
#[test]
fn targets_a_few_rounding_errors_away_are_met() {
    let mut worst = 0.0_f64;
    for seed in 0..4000 {
        let mut rng = rng(700_000 + seed);
        let k = rng.random_range(2..5);
        let plane = Plane::new(1.0, k as f64, k).unwrap();
        let mu = steep_and_flat(&mut rng, k);
        let (model, mut state) = build(plane, Operator::Mkp, &mu);
        let inverse = model.inverse().unwrap();
        for _ in 0..10 {
            let input = among_lines(&mut rng, k);
            let now = model.step(&mut state, input).unwrap().output;
            let away = rng.random_range(-10.0..10.0) * inverse.rounding();
            let target = (now + away).clamp(0.0, model.total());
            for heading in [None, Some(Direction::Rising), Some(Direction::Falling)] {
                let wanted = Target::new(target).heading(heading);
                let input = inverse.solve(&state, wanted).unwrap().input;
                let reached = model.step(&mut state.clone(), input).unwrap().output;
                worst = worst.max((reached - target).abs());
            }
        }
    }
    assert!(worst <= 1e-13, "{worst:e}");
}

/// The tolerance is the way to an output that the model can give, up to less than rounding.
#[test]
fn at_the_edge_the_output_is_further_by_the_tolerance() {
    let mut worst = 0.0_f64;
    for seed in 0..4000 {
        let mut rng = rng(710_000 + seed);
        let k = rng.random_range(2..5);
        let plane = Plane::new(1.0, k as f64, k).unwrap();
        let mu = steep_and_flat(&mut rng, k);
        let operator = OPERATORS[seed as usize % 3];
        let (model, mut state) = build(plane, operator, &mu);
        let inverse = model.inverse().unwrap();
        let mut input = plane.bottom();
        for _ in 0..10 {
            let before = input;
            input = among_lines(&mut rng, k);
            let now = model.step(&mut state, input).unwrap().output;
            let there = before + (input - before) * [0.0, 0.25, 0.5][rng.random_range(0..3)];
            let goal = model.step(&mut state.clone(), there).unwrap().output;
            let noise = rng.random_range(-0.4..0.4) * inverse.rounding();
            let heading = match there > input {
                true => Direction::Rising,
                false => Direction::Falling,
            };
            let wanted = Target::new(now).heading(Some(heading));
            let wanted = wanted.tolerance((now - goal).abs() + noise);
            let edge = inverse.solve(&state, wanted).unwrap().input;
            let reached = model.step(&mut state.clone(), edge).unwrap().output;
            worst = worst.max((reached - goal).abs());
        }
    }
    assert!(worst <= 1e-13, "{worst:e}");
}

#[test]
fn outputs_closer_than_the_rounding_error_are_equal() {
    let (plane, weights) = dead_band();
    let (model, mut state) = build(plane, Operator::Mkp, &weights);
    let inverse = model.inverse().unwrap();
    let rounding = inverse.rounding();
    assert_eq!(rounding, 4.0 * f64::EPSILON * 3.0);
    let now = model.step(&mut state, 65.0).unwrap().output;
    let input = |by| inverse.solve(&state, Target::new(now + by)).unwrap().input;
    for way in [-1.0, 1.0] {
        assert_eq!(input(0.9 * way * rounding), 65.0);
        assert_ne!(input(2.0 * way * rounding), 65.0);
    }
}

#[test]
fn a_target_away_from_where_the_branch_began_is_held() {
    let mut held = 0;
    for seed in 0..600 {
        let mut rng = rng(800 + seed);
        let k = levels(&mut rng, 12);
        let plane = plane(&mut rng, k);
        let (model, mut state) = build(plane, OPERATORS[seed as usize % 3], &sparse(&mut rng, k));
        let inverse = model.inverse().unwrap();
        for heading in [Direction::Rising, Direction::Falling] {
            match heading {
                Direction::Rising => model.reset_off(&mut state).unwrap(),
                Direction::Falling => model.reset_on(&mut state).unwrap(),
            }
            let began = model.output(&state);
            let input = rng.random_range(plane.bottom()..plane.max());
            let now = model.step(&mut state, input).unwrap().output;
            if (now - began).abs() > 1e-9 {
                let target = Target::new(now).heading(Some(heading));
                assert_eq!(inverse.solve(&state, target).unwrap().input, input);
                held += 1;
            }
        }
    }
    assert!(held > 500, "{held}");
}

#[test]
fn without_weights_the_dead_band_is_the_whole_plane() {
    for operator in [Operator::Mkp, Operator::Kp] {
        let mut rng = rng(900);
        let plane = plane(&mut rng, 6);
        let (model, mut state) = build(plane, operator, &[0.0; 21]);
        let inverse = model.inverse().unwrap();
        for input in inputs(&mut rng, &plane, 200) {
            model.step(&mut state, input).unwrap();
            let to = |heading| {
                let target = Target::new(0.0).heading(Some(heading));
                inverse.solve(&state, target).unwrap().input
            };
            let ends = (to(Direction::Falling), to(Direction::Rising));
            assert_eq!(ends, (plane.bottom(), plane.max()));
        }
    }
}

#[test]
fn relays_jump_to_or_past_the_target() {
    for seed in 0..100 {
        let mut rng = rng(400 + seed);
        let k = levels(&mut rng, 40);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let (model, mut state) = build(plane, Operator::Relay, &weights);
        let inverse = model.inverse().unwrap();
        let (low, high) = model.output_range();
        let rounding = 1e-12 * (high - low);
        for _ in 0..100 {
            let before = state.clone();
            let target = rng.random_range(low..=high);
            let input = inverse.step(&mut state, Target::new(target)).unwrap().input;
            let (start, reached) = (model.output(&before), model.output(&state));
            let rising = target > start;
            assert!(if rising {
                reached >= target - rounding
            } else {
                reached <= target + rounding
            });
            // One level less would not have been enough.
            let mut short = before.clone();
            let less = if rising {
                input - plane.step()
            } else {
                input + plane.step()
            };
            if (less > before.input()) == rising {
                let missed = model.step(&mut short, less).unwrap().output;
                assert!(if rising {
                    missed < target + rounding
                } else {
                    missed > target - rounding
                });
            }
        }
    }
}

#[test]
fn a_relay_holds_beyond_the_plane_too() {
    let plane = Plane::new(0.0, 1.0, 2).unwrap();
    let (model, mut state) = build(plane, Operator::Relay, &[1.0, 2.0, 4.0]);
    model.step(&mut state, 1.5).unwrap();
    let inverse = model.inverse().unwrap();
    let held = inverse.step(&mut state, Target::new(7.0)).unwrap();
    assert_eq!((held.input, model.output(&state)), (1.5, 7.0));
}

#[test]
fn negative_weights_are_refused_by_name() {
    let plane = Plane::new(0.0, 1.0, 4).unwrap();
    let mut weights = vec![1.0; 10];
    weights[operator_index(2, 3)] = -0.1;
    weights[operator_index(1, 4)] = -0.2;
    let (model, _) = build(plane, Operator::Mkp, &weights);
    let error = model.inverse().map(|_| ()).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("2 negative") && text.contains("i=2 j=3, i=1 j=4"),
        "{text}"
    );
}
