//! The stages around the operators: against the formulas written out, and the inverse against the
//! forward chain, for any stages, any order of calls, `f32` and `f64`.

use crate::common;

use common::stages::{Constants, Owned};
use common::{OPERATORS, build, build_f32, inputs, levels, plane, rng, weights};
use hysteron_core::{
    Axis, Body, Constant, Definition, Direction, Error, Load, MAX_CREEP, Model, Operator, Plane,
    Range, Real, Registration, Sample, StageState, Stages, Status, Target, Turn, Wanted, mix, mkp,
    operators, table_len, turn_capacity,
};
use rand::RngExt;
use rand::rngs::StdRng;

/// The value at `x` of the line through the knots, by search from the left.
fn line(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let mut k = 0;
    while k + 2 < xs.len() && x >= xs[k + 1] {
        k += 1;
    }
    ys[k] + (x - xs[k]) / (xs[k + 1] - xs[k]) * (ys[k + 1] - ys[k])
}

/// `e^A` of a small matrix: the series for `A/2^12`, squared 12 times.
fn exponential(a: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let product = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| {
        let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
        [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
    };
    let small = a.map(|row| row.map(|entry| entry / 4096.0));
    let (mut sum, mut term) = ([[1.0, 0.0], [0.0, 1.0]], [[1.0, 0.0], [0.0, 1.0]]);
    for n in 1..12 {
        term = product(term, small).map(|row| row.map(|entry| entry / f64::from(n)));
        for (sum, term) in sum.iter_mut().flatten().zip(term.as_flattened()) {
            *sum += term;
        }
    }
    (0..12).fold(sum, |power, _| product(power, power))
}

#[test]
fn the_chain_is_its_formulas() {
    for seed in 0..200 {
        let mut rng = rng(seed);
        let operator = OPERATORS[seed as usize % 2]; // a relay may switch by an ulp
        let k = levels(&mut rng, 30);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let case = build(plane, operator, &weights);
        let constants = Constants::random(&mut rng, &plane);
        let owned = constants.map(|v| v);
        let stages = owned.stages();
        stages.check(&case.0).unwrap();
        let mut gamma = vec![0.0; weights.len()];
        let mut plain = Definition::new(plane, operator, &weights, &mut gamma).unwrap();
        let (mut state, mut memory) = (case.1.clone(), StageState::default());
        let (mut temperature, mut crept, mut lagged) = (None, Vec::new(), None);
        let mut x = plane.bottom();
        let mut swung: Option<[f64; 2]> = None;
        let size: f64 = 10.0 + 2.0 * weights.iter().sum::<f64>();
        for input in inputs(&mut rng, &plane, 300) {
            let drive = constants
                .body
                .map_or(input, |[ambient, gain, ..]| (input - ambient) / gain);
            let dt = rng.random_range(0.0..2.0);
            let load = rng.random_range(-4.0..8.0);
            let sample = Sample {
                input: drive,
                dt: Some(dt),
                load: Some(load),
            };
            let found = stages
                .step(&case.0, &mut state, &mut memory, sample)
                .unwrap();

            let t = match (constants.body, temperature) {
                (None, _) => drive,
                (Some([ambient, gain, ..]), None) => ambient + gain * drive,
                (Some([ambient, gain, heating, cooling]), Some(last)) => {
                    let rest = ambient + gain * drive;
                    let tau = if rest > last { heating } else { cooling };
                    rest + (last - rest) * (-dt / tau).exp()
                }
            };
            let load = match constants.loads.as_slice() {
                [] => 0.0,
                loads => load.clamp(loads[0], loads[loads.len() - 1]),
            };
            let of = |values: &[f64], other: f64| match (values, constants.loads.len()) {
                ([], _) => other,
                ([one], _) => *one,
                (values, _) => line(&constants.loads, values, load),
            };
            let held = x;
            let seen = |t: f64| {
                let effective = of(&constants.scales, 1.0) * t - of(&constants.shifts, 0.0);
                let [up, down] = [&constants.up, &constants.down].map(|rows| {
                    let rows = if rows.is_empty() { &constants.up } else { rows };
                    let mut x = registered(&constants, rows, load, effective);
                    if !constants.spacing.is_empty() {
                        let levels: Vec<f64> = (0..=k).map(|n| plane.level(n)).collect();
                        x = line(&constants.spacing, &levels, x);
                    }
                    x
                });
                f64::max(up, f64::min(held, down))
            };
            let t = match temperature {
                None => t,
                Some(_) => {
                    let share = |t| share_of(&plane, &weights, plain.states(), seen(t));
                    let before = share_held(&weights, plain.states());
                    balanced(t, constants.latent, |t| share(t) - before)
                }
            };
            temperature = Some(t);
            x = seen(t);
            let mut h = of(&constants.gains, 1.0) * plain.step(x).unwrap();
            if !constants.sums.is_empty() {
                h = line(&constants.sums, &constants.outputs, h);
            }
            if crept.is_empty() {
                crept = vec![h; constants.taus.len()];
            }
            let mut sum = h;
            for ((z, tau), c) in crept
                .iter_mut()
                .zip(&constants.taus)
                .zip(&constants.coefficients)
            {
                *z = h + (*z - h) * (-dt / tau).exp();
                sum += c * *z;
            }
            let fade = if constants.lag > 0.0 {
                (-dt / constants.lag).exp()
            } else {
                0.0
            };
            let y = sum + (lagged.unwrap_or(sum) - sum) * fade;
            lagged = Some(y);
            let y = match constants.ring {
                None => y,
                Some([frequency, damping]) => {
                    let turn = 2.0 * std::f64::consts::PI * frequency * dt;
                    let [at, velocity] = swung.unwrap_or([y, 0.0]);
                    // Output and velocity over ω, from where the input draws them.
                    let [a, b] = exponential([[0.0, turn], [-turn, -2.0 * damping * turn]]);
                    let gap = at - y;
                    let of = |row: [f64; 2]| row[0] * gap + row[1] * velocity;
                    swung = Some([y + of(a), of(b)]);
                    y + of(a)
                }
            };
            let shifted = constants.offset + of(&constants.offsets, 0.0);
            let expected = shifted + if constants.falling { -y } else { y };
            // The slope of the output is up to the sum of the weights for a tenth of a cell, and
            // positions have rounding of some ulps.
            assert!(
                (found.output - expected).abs() < 1e-10 * size,
                "seed {seed}: {} for {expected}",
                found.output
            );
        }
    }
}

/// `Σ μ γ / Σ μ` of operators in these states.
fn share_held(weights: &[f64], states: &[f64]) -> f64 {
    let sum: f64 = weights
        .iter()
        .zip(states)
        .map(|(mu, gamma)| mu * gamma)
        .sum();
    let total: f64 = weights.iter().sum();
    if total > 0.0 { sum / total } else { 0.0 }
}

/// The same after they moved to the input `x`.
fn share_of(plane: &Plane<f64>, weights: &[f64], states: &[f64], x: f64) -> f64 {
    let x = plane.normalise(x);
    let moved = operators(plane.levels()).zip(states);
    let moved: Vec<f64> = moved.map(|((i, j), gamma)| mkp(*gamma, x, i, j)).collect();
    share_held(weights, &moved)
}

/// The `T` with `T + λ h(T) = unbound`, for `h` from −1 to 1 that does not fall: by halves.
fn balanced(unbound: f64, latent: f64, h: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (unbound - latent, unbound + latent);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        match middle + latent * h(middle) < unbound {
            true => low = middle,
            false => high = middle,
        }
    }
    high
}

/// The position on the axis at an effective temperature: between the knots linear, beyond them the
/// axis itself.
fn registered(constants: &Constants, rows: &[f64], load: f64, effective: f64) -> f64 {
    let (count, loads) = (constants.knots.len(), &constants.loads);
    if count == 0 {
        return effective;
    }
    let at = |m: usize| match loads.len() {
        0 | 1 => rows[m],
        _ => {
            let column: Vec<f64> = rows.iter().skip(m).step_by(count).copied().collect();
            line(loads, &column, load)
        }
    };
    let row: Vec<f64> = (0..count).map(at).collect();
    let (first, last) = (row[0], row[count - 1]);
    match effective {
        t if t < first => constants.knots[0] + (t - first),
        t if t > last => constants.knots[count - 1] + (t - last),
        t => line(&row, &constants.knots, t),
    }
}

/// Calls in any order; a target that is said to be met is met, and the drive is never outside its
/// range.
fn attack<T: Real>(
    rng: &mut StdRng,
    (model, mut state): common::Owned<T>,
    owned: &Owned<T>,
    number: impl Fn(f64) -> T,
) -> (usize, usize) {
    let (plane, stages) = (*model.plane(), owned.stages());
    stages.check(&model).unwrap();
    let inverse = model.inverse().unwrap();
    let mut memory = StageState::default();
    let (off, on) = model.output_range();
    let (mut met, mut missed) = (0, 0);
    let magnitude = |v: T| v.max(-v);
    for _ in 0..60 {
        let share = number(rng.random_range(-0.1..1.1));
        let dt = match rng.random_range(0..10) {
            0 => T::ZERO,
            1 => number(1e9),
            _ => number(rng.random_range(0.001..3.0)),
        };
        let load = Some(number(rng.random_range(-4.0..8.0)));
        let full = number(1.2);
        let top = owned.body().map_or(plane.max() + plane.step(), |body| {
            full * body.hold(plane.max())
        });
        let bottom = owned.body().map_or(plane.bottom() - plane.step(), |body| {
            body.hold(plane.bottom())
        });
        let drive = match rng.random_range(0..3) {
            0 => (-T::INFINITY, T::INFINITY),
            1 => (bottom, top),
            _ => (bottom, bottom),
        };
        if rng.random_range(0..4) == 0 {
            let input = bottom + share * (top - bottom);
            let sample = Sample {
                input,
                dt: Some(dt),
                load,
            };
            stages
                .step(&model, &mut state, &mut memory, sample)
                .unwrap();
            continue;
        }
        let loaded = stages.axis.load.at(load).unwrap();
        let sum = loaded.gain * (off + share * (on - off));
        let offset = owned.offset + loaded.offset;
        let output = if owned.falling {
            offset - sum
        } else {
            offset + sum
        };
        let heading = [None, Some(Direction::Rising), Some(Direction::Falling)];
        let target = Target::new(output)
            .heading(heading[rng.random_range(0..3)])
            .tolerance(match rng.random() {
                true => number(0.01) * (on - off),
                false => T::ZERO,
            });
        let horizon = if rng.random() { T::ZERO } else { number(1.0) };
        let wanted = Wanted {
            dt: Some(dt),
            load,
            drive,
            horizon,
            ..target.into()
        };
        let (mut again, mut memory_again) = (state.clone(), memory);
        let found = stages
            .invert(&inverse, &mut state, &mut memory, wanted)
            .unwrap();
        assert!(found.input.is_finite());
        assert!(drive.0 <= found.input && found.input <= drive.1);
        let sample = Sample {
            input: found.input,
            dt: Some(dt),
            load,
        };
        let reached = stages
            .step(&model, &mut again, &mut memory_again, sample)
            .unwrap();
        // A ring remembers the target that was wanted as well, which is the last number.
        let numbers = |memory: &StageState<T>| {
            let all = memory.to_numbers();
            all.map(Real::bits)[..all.len() - 1].to_vec()
        };
        assert_eq!(
            (&again, numbers(&memory_again)),
            (&state, numbers(&memory)),
            "it moves as forward does"
        );
        if found.status == Status::Ok {
            met += 1;
            let error = magnitude(reached.output - output);
            // Rounding of positions, times the steepest slope that the weights can have there.
            let place = magnitude(plane.max()) + magnitude(plane.bottom());
            let size = loaded.gain * (magnitude(on) + magnitude(off))
                + magnitude(owned.offset)
                + magnitude(loaded.offset);
            let slope = T::ONE + place / plane.step();
            let rounding = number(2000.0) * T::EPSILON * size * slope;
            assert!(
                error <= target.tolerance + rounding,
                "{error} {rounding} {found:?}"
            );
        } else {
            missed += 1;
        }
    }
    (met, missed)
}

#[test]
fn a_target_said_to_be_met_is_met_through_all_stages() {
    let (mut met, mut missed) = (0, 0);
    for seed in 0..1500 {
        let mut rng = rng(seed);
        let operator = OPERATORS[seed as usize % 3];
        let k = levels(&mut rng, 30);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let constants = Constants::random(&mut rng, &plane).of(operator);
        let single = seed % 2 == 0;
        let (ok, not) = if single {
            let case = build(plane, operator, &weights);
            let pair = (case.0, case.1);
            attack(&mut rng, pair, &constants.map(|v| v), |v| v)
        } else {
            let case = build_f32(&plane, operator, &weights);
            let pair = (case.0, case.1);
            attack(&mut rng, pair, &constants.map(|v| v as f32), |v| v as f32)
        };
        met += ok;
        missed += not;
    }
    assert!(
        met > 10_000 && missed > 10_000,
        "{met} met, {missed} missed"
    );
}

/// Without limits, with time and a body, every target in range is met.
#[test]
fn without_limits_every_target_in_range_is_met() {
    let mut not = 0;
    for seed in 0..300 {
        let mut rng = rng(seed);
        let k = levels(&mut rng, 30);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let case = build(plane, Operator::Mkp, &weights);
        let mut constants = Constants::random(&mut rng, &plane);
        constants.lag = 0.0; // a lag can need more than the operators can give
        constants.ring = None; // a ring too
        constants.coefficients.clear();
        constants.taus.clear();
        let owned = constants.map(|v| v);
        let (stages, inverse) = (owned.stages(), case.0.inverse().unwrap());
        let (mut state, mut memory) = (case.1.clone(), StageState::default());
        let on = case.0.total();
        // Without weights there is no range, of which rounding may be a thousandth.
        if on == 0.0 {
            continue;
        }
        for _ in 0..50 {
            let sum = rng.random_range(0.0..1.0) * on;
            let load = Some(rng.random_range(-4.0..8.0));
            let loaded = stages.axis.load.at(load).unwrap();
            let sum = stages.behind.settled(loaded.gain * sum);
            let offset = owned.offset + loaded.offset;
            let output = if owned.falling {
                offset - sum
            } else {
                offset + sum
            };
            let wanted = Wanted {
                dt: Some(0.1),
                load,
                ..Target::new(output).into()
            };
            let found = stages
                .invert(&inverse, &mut state, &mut memory, wanted)
                .unwrap();
            not += usize::from(found.status != Status::Ok);
        }
    }
    assert_eq!(not, 0);
}

#[test]
fn weights_mixed_by_the_load_are_those_of_the_sum() {
    for seed in 0..60 {
        let mut rng = rng(seed);
        let k = levels(&mut rng, 30);
        let plane = plane(&mut rng, k);
        let parts: Vec<Vec<f64>> = (0..3).map(|_| weights(&mut rng, k)).collect();
        let tables: Vec<Vec<f64>> = parts
            .iter()
            .map(|part| build(plane, Operator::Mkp, part).0.table().to_vec())
            .collect();
        let case = build(plane, Operator::Mkp, &parts[0]);
        let (mut model, mut state) = (case.0, case.1);
        for input in inputs(&mut rng, &plane, 40) {
            let share = rng.random_range(0.0..1.0);
            let factors = [share, 0.5 * (1.0 - share), 0.5 * (1.0 - share)];
            mix(&mut model, &mut state, &tables, &factors).unwrap();
            let output = model.step(&mut state, input).unwrap().output;
            let sum: Vec<f64> = (0..parts[0].len())
                .map(|n| (0..3).map(|p| factors[p] * parts[p][n]).sum())
                .collect();
            let turns: Vec<f64> = state.turning_points().collect();
            let other = build(plane, Operator::Mkp, &sum);
            let mut copy = other.1.clone();
            other.0.restore(&mut copy, &turns, state.input()).unwrap();
            let expected = other.0.output(&copy);
            assert!((output - expected).abs() < 1e-12 * (1.0 + sum.iter().sum::<f64>()));
        }
        let short: [&[f64]; 1] = [&[0.0]];
        let refused = mix(&mut model, &mut state, &short, &[1.0]);
        assert!(matches!(refused, Err(Error::MemoryTooSmall { .. })));
    }
}

#[test]
fn what_cannot_be_is_refused_and_moves_nothing() {
    let plane = Plane::new(1.0, 2.0, 2).unwrap();
    let model = Model::new(plane, Operator::Mkp, &[1.0; 3], [0.0; table_len(2)]).unwrap();
    let mut state = model.state([Turn::default(); turn_capacity(2)]).unwrap();
    let body = Body {
        ambient: 0.0,
        gain: 1.0,
        tau_heating: 1.0,
        tau_cooling: 2.0,
    };
    let stages = Stages {
        body: Some(body),
        axis: Axis {
            load: Load {
                loads: &[1.0, 2.0],
                shifts: &[0.0, 0.5],
                ..Load::NONE
            },
            ..Axis::PLAIN
        },
        ..Stages::NONE
    };
    let mut memory = StageState::default();
    let good = Sample {
        input: 1.0,
        dt: Some(1.0),
        load: Some(1.0),
    };
    stages.step(&model, &mut state, &mut memory, good).unwrap();
    let before = (state.clone(), memory);
    let bad = [
        (
            Sample {
                input: f64::NAN,
                ..good
            },
            Error::InputNotFinite { index: 0 },
        ),
        (
            Sample {
                input: f64::INFINITY,
                ..good
            },
            Error::InputNotFinite { index: 0 },
        ),
        (Sample { dt: None, ..good }, Error::TimeStep),
        (
            Sample {
                dt: Some(-1.0),
                ..good
            },
            Error::TimeStep,
        ),
        (
            Sample {
                dt: Some(f64::NAN),
                ..good
            },
            Error::TimeStep,
        ),
        (
            Sample {
                dt: Some(f64::INFINITY),
                ..good
            },
            Error::TimeStep,
        ),
        (Sample { load: None, ..good }, Error::Load),
        (
            Sample {
                load: Some(f64::NAN),
                ..good
            },
            Error::Load,
        ),
    ];
    let inverse = model.inverse().unwrap();
    for (sample, error) in bad {
        assert_eq!(stages.accepts(&memory, sample), Err(error));
        assert_eq!(
            stages.step(&model, &mut state, &mut memory, sample),
            Err(error)
        );
        let wanted = Wanted {
            dt: sample.dt,
            load: sample.load,
            ..Target::new(sample.input).into()
        };
        assert_eq!(
            stages.invert(&inverse, &mut state, &mut memory, wanted),
            Err(error)
        );
        assert_eq!((&state, &memory), (&before.0, &before.1));
    }
    let wanted = Wanted {
        dt: good.dt,
        load: good.load,
        drive: (1.0, 0.0),
        ..Target::new(1.0).into()
    };
    let refused = stages.invert(&inverse, &mut state, &mut memory, wanted);
    assert_eq!(refused, Err(Error::Stage { stage: "drive" }));

    assert_eq!(stages.accepts(&memory, good), Ok(()));
    // Before the first sample there is no time to know.
    let first = Sample { dt: None, ..good };
    assert_eq!(stages.accepts(&StageState::default(), first), Ok(()));
    for drive in [(0.0, f64::NAN), (f64::NAN, 1.0)] {
        let refused = stages.invert(
            &inverse,
            &mut state,
            &mut memory,
            Wanted { drive, ..wanted },
        );
        assert_eq!(refused, Err(Error::Stage { stage: "drive" }));
    }
}

/// What a constant of this range may be at its ends, and what it must not be.
fn ends(range: Range) -> (Vec<f64>, Vec<f64>) {
    let (mut fine, mut wrong) = match range {
        Range::Size => (vec![-1e140, 0.0, 1e140], vec![-1.1e140, 1.1e140]),
        Range::Amount => (vec![0.0, 1e140], vec![-1e-9, 1.1e140]),
        Range::Slope => (vec![1e-140, 1e140], vec![-1.0, 0.0, 0.9e-140, 1.1e140]),
        Range::Share => (vec![0.0, 1e6], vec![-1e-9, 1.1e6]),
        Range::Factor => (vec![1e-6, 1e6], vec![-1.0, 0.0, 0.9e-6, 1.1e6]),
        Range::Time => (vec![1e-9, 1e9], vec![-1.0, 0.0, 0.9e-9, 1.1e9]),
        Range::TimeOrNone => (vec![0.0, 1e-9, 1e9], vec![-1.0, 0.9e-9, 1.1e9]),
        Range::Frequency => (vec![1e-9, 1e9], vec![-1.0, 0.9e-9, 1.1e9]),
        Range::Damping => (vec![1e-4, 1.0], vec![-1.0, 0.0, 0.9e-4, 1.1]),
    };
    fine.push(1.0);
    wrong.extend([f64::NAN, f64::INFINITY, f64::NEG_INFINITY]);
    (fine, wrong)
}

/// Stages with every constant, and a model for them.
fn whole() -> (Lists, Model<f64, [f64; table_len(2)]>) {
    let plane = Plane::new(1.0, 2.0, 2).unwrap();
    let model = Model::new(plane, Operator::Mkp, &[1.0; 3], [0.0; table_len(2)]).unwrap();
    let list = |constant: &Constant| match constant.name {
        "ambient" => vec![0.0],
        "gain" | "tau_heating" | "tau_cooling" | "latent" => vec![1.0],
        "loads" => vec![1.0, 2.0],
        "shifts" | "offsets" => vec![0.0, 0.5],
        "spacing" => vec![0.0, 1.0, 3.0],
        "lag" | "ring_frequency" | "ring_damping" => vec![0.5],
        // A row for each of the loads.
        "rising" => vec![1.0, 2.0, 1.0, 3.0],
        "falling" => vec![0.0, 2.0, 1.0, 2.0],
        _ => vec![1.0, 2.0],
    };
    let constants = Stages::<f64>::declared().flat_map(|stage| stage.constants);
    (constants.map(|c| (c.name, list(c))).collect(), model)
}

type Lists = Vec<(&'static str, Vec<f64>)>;

/// The same lists with another one of this name.
fn with(lists: &Lists, name: &'static str, numbers: Vec<f64>) -> Lists {
    let mut lists = lists.clone();
    lists.iter_mut().find(|list| list.0 == name).unwrap().1 = numbers;
    lists
}

fn checked(lists: &Lists, model: &Model<f64, [f64; table_len(2)]>) -> Result<(), Error> {
    let list = |name| &lists.iter().find(|list| list.0 == name).unwrap().1;
    Stages::with_constants(|constant| list(constant.name))?.check(model)
}

#[test]
fn constants_out_of_range_are_refused_by_name() {
    let (lists, model) = whole();
    assert_eq!(checked(&lists, &model), Ok(()));
    for declared in Stages::<f64>::declared() {
        assert!(!declared.about.is_empty() && !declared.constants.is_empty());
        for constant in declared.constants {
            let named = Err(Error::Stage {
                stage: constant.name,
            });
            let (fine, wrong) = ends(constant.range);
            assert!(
                fine.iter().all(|value| constant.range.has(*value)),
                "{constant:?}"
            );
            let count = lists
                .iter()
                .find(|list| list.0 == constant.name)
                .unwrap()
                .1
                .len();
            for value in wrong {
                assert!(!constant.range.has(value), "{constant:?}: {value}");
                for n in 0..count {
                    let mut numbers: Vec<f64> = (0..count).map(|k| k as f64).collect();
                    numbers[n] = value;
                    let found = checked(&with(&lists, constant.name, numbers), &model);
                    // A list of factors that starts at 0 is wrong before it, by the same name.
                    assert_eq!(found, named, "{constant:?}: {value}");
                }
            }
        }
    }
}

#[test]
fn lists_that_do_not_fit_each_other_are_refused_by_name() {
    let (lists, model) = whole();
    let refused = |name: &'static str, numbers: &[f64], stage: &'static str| {
        let found = checked(&with(&lists, name, numbers.to_vec()), &model);
        assert_eq!(found, Err(Error::Stage { stage }), "{name}: {numbers:?}");
    };
    for name in ["ambient", "gain", "tau_heating", "tau_cooling"] {
        refused(name, &[], "body");
        refused(name, &[1.0, 2.0], "body");
    }
    refused("latent", &[1.0, 2.0], "latent");
    refused("lag", &[1.0, 2.0], "lag");
    for name in ["ring_frequency", "ring_damping"] {
        refused(name, &[], "ring");
        refused(name, &[0.5, 0.5], "ring");
    }
    refused("loads", &[2.0, 1.0], "loads");
    refused("loads", &[1.0, 1.0], "loads");
    for curve in ["shifts", "scales", "gains", "offsets"] {
        refused(curve, &[1.0], curve);
        refused(curve, &[1.0, 2.0, 3.0], curve);
    }
    for name in ["creep", "creep_taus"] {
        refused(name, &[], "creep");
        refused(name, &[1.0], "creep");
    }
    let many = with(&lists, "creep", vec![0.1; MAX_CREEP + 1]);
    let many = with(&many, "creep_taus", vec![1.0; MAX_CREEP + 1]);
    assert_eq!(checked(&many, &model), Err(Error::Stage { stage: "creep" }));
    let list = |name: &'static str| &lists.iter().find(|list| list.0 == name).unwrap().1;
    let stages = Stages::with_constants(|constant| list(constant.name)).unwrap();
    for offset in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let found = Stages { offset, ..stages }.check(&model);
        assert_eq!(found, Err(Error::Stage { stage: "offset" }));
    }
    for name in ["curve_sums", "curve_outputs"] {
        refused(name, &[], "curve_sums");
        refused(name, &[1.0], "curve_sums");
        refused(name, &[2.0, 1.0], name);
        refused(name, &[1.0, 1.0 + f64::EPSILON], name);
    }
    // A slope of 2 millions.
    refused("curve_outputs", &[0.0, 2e6], "curve_outputs");
    let registration = Registration::NONE;
    let axis = Axis {
        registration,
        ..stages.axis
    };
    let load = axis.load;
    // Corners need to be several rounding units apart, where they are far from zero too.
    let ulp = f64::EPSILON;
    for (spacing, fine) in [
        (&[0.0, 1.0][..], false),
        (&[0.0, 1.0, 2.0, 3.0], false),
        (&[0.0, 2.0, 1.0], false),
        (&[0.0, 1.0, 1.0], false),
        (&[0.0, 0.0, 1.0], false),
        (&[0.0, 1.0, 1.0 + 2.0 * ulp], false),
        (&[0.0, 1.0, 1.0 + 8.0 * ulp], true),
        (&[-1.0 - 2.0 * ulp, -1.0, 0.0], false),
        (&[-1.0 - 8.0 * ulp, -1.0, 0.0], true),
        (&[1e-100, 2e-100, 3e-100], true),
        // A slope of 1e300 is beyond the bound of slopes.
        (&[1e-300, 2e-300, 3e-300], false),
    ] {
        let stages = Stages {
            axis: Axis { spacing, ..axis },
            ..stages
        };
        assert_eq!(stages.check(&model).is_ok(), fine, "{spacing:?}");
    }
    // A curve is empty, or as long as the loads.
    for load in [
        Load {
            shifts: &[],
            ..load
        },
        Load {
            scales: &[],
            ..load
        },
        Load {
            gains: &[],
            offsets: &[],
            ..load
        },
        Load::NONE,
    ] {
        assert_eq!(
            Stages {
                axis: Axis { load, ..axis },
                ..stages
            }
            .check(&model),
            Ok(())
        );
    }
    let load = Load {
        shifts: &[1.0],
        ..Load::NONE
    };
    let axis = Axis { load, ..axis };
    let found = Stages { axis, ..stages }.check(&model);
    assert_eq!(found, Err(Error::Stage { stage: "shifts" }));
}
