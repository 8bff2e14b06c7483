//! The stages around the operators: against the formulas written out, and the inverse against the
//! forward chain, for any stages, any order of calls, `f32` and `f64`.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{OPERATORS, build, build_f32, inputs, levels, plane, rng, weights};
use hysteron_core::{
    Axis, Body, Creep, Definition, Direction, Error, Load, Model, Operator, Plane, Real, Sample,
    StageState, Stages, Status, Target, Turn, Wanted, mix, table_len, turn_capacity,
};
use rand::RngExt;
use rand::rngs::StdRng;

/// Random constants of all stages. Each is there in half of the cases.
#[derive(Debug, Clone)]
struct Constants {
    body: Option<[f64; 4]>,
    loads: Vec<f64>,
    shifts: Vec<f64>,
    scales: Vec<f64>,
    gains: Vec<f64>,
    offsets: Vec<f64>,
    spacing: Vec<f64>,
    coefficients: Vec<f64>,
    taus: Vec<f64>,
    lag: f64,
    offset: f64,
    falling: bool,
}

fn ascending(rng: &mut StdRng, count: usize, from: f64, span: f64) -> Vec<f64> {
    let steps: Vec<f64> = (0..count).map(|_| rng.random_range(0.2..1.0)).collect();
    let total: f64 = steps.iter().sum();
    let mut at = from;
    let knot = |step: &f64| {
        at += span * step / total;
        at
    };
    steps.iter().map(knot).collect()
}

impl Constants {
    fn random(rng: &mut StdRng, plane: &Plane<f64>) -> Self {
        let span = plane.max() - plane.bottom();
        let count = if rng.random() {
            rng.random_range(1..5)
        } else {
            0
        };
        let creeps = if rng.random() {
            rng.random_range(1..=4)
        } else {
            0
        };
        let mut numbers = |count: usize, low: f64, high: f64| -> Vec<f64> {
            (0..count).map(|_| rng.random_range(low..high)).collect()
        };
        let shifts = numbers(count, -0.2 * span, 0.2 * span);
        let scales = numbers(count, 0.7, 1.4);
        let gains = numbers(count, 0.3, 3.0);
        let offsets = numbers(count, -4.0, 4.0);
        let coefficients = numbers(creeps, 0.0, 0.2);
        let taus = numbers(creeps, 0.05, 20.0);
        let body = numbers(4, 0.3, 3.0);
        let offset = numbers(1, -5.0, 5.0)[0];
        let lag = numbers(1, 0.01, 1.0)[0];
        let (spaced, scaled, gained) = (rng.random(), rng.random(), rng.random());
        let corners = plane.levels() + 1;
        Self {
            body: rng
                .random::<bool>()
                .then(|| [plane.bottom(), span * body[1], body[2], body[3]]),
            loads: ascending(rng, count, -3.0, 10.0),
            shifts,
            scales: if scaled { scales } else { Vec::new() },
            gains: if gained { gains } else { Vec::new() },
            offsets: if gained { offsets } else { Vec::new() },
            spacing: match spaced {
                true => ascending(rng, corners, plane.bottom(), span),
                false => Vec::new(),
            },
            coefficients,
            taus,
            lag: if rng.random() { lag } else { 0.0 },
            offset,
            falling: rng.random(),
        }
    }

    fn map<T: Real>(&self, number: impl Fn(f64) -> T) -> Owned<T> {
        let all = |values: &[f64]| values.iter().map(|v| number(*v)).collect();
        Owned {
            body: self
                .body
                .map(|[ambient, gain, tau_heating, tau_cooling]| Body {
                    ambient: number(ambient),
                    gain: number(gain),
                    tau_heating: number(tau_heating),
                    tau_cooling: number(tau_cooling),
                }),
            lists: [
                &self.loads,
                &self.shifts,
                &self.scales,
                &self.gains,
                &self.offsets,
                &self.spacing,
                &self.coefficients,
                &self.taus,
            ]
            .map(|list| all(list)),
            lag: number(self.lag),
            offset: number(self.offset),
            falling: self.falling,
        }
    }
}

struct Owned<T> {
    body: Option<Body<T>>,
    lists: [Vec<T>; 8],
    lag: T,
    offset: T,
    falling: bool,
}

impl<T: Real> Owned<T> {
    fn stages(&self) -> Stages<'_, T> {
        let [
            loads,
            shifts,
            scales,
            gains,
            offsets,
            spacing,
            coefficients,
            taus,
        ] = &self.lists;
        Stages {
            body: self.body,
            axis: Axis {
                load: Load {
                    loads,
                    shifts,
                    scales,
                    gains,
                    offsets,
                },
                spacing,
            },
            creep: Creep { coefficients, taus },
            lag: self.lag,
            offset: self.offset,
            falling: self.falling,
        }
    }
}

/// The value at `x` of the line through the knots, by search from the left.
fn line(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let mut k = 0;
    while k + 2 < xs.len() && x >= xs[k + 1] {
        k += 1;
    }
    ys[k] + (x - xs[k]) / (xs[k + 1] - xs[k]) * (ys[k + 1] - ys[k])
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
            temperature = Some(t);
            let load = match constants.loads.as_slice() {
                [] => 0.0,
                loads => load.clamp(loads[0], loads[loads.len() - 1]),
            };
            let of = |values: &[f64], other: f64| match (values, constants.loads.len()) {
                ([], _) => other,
                ([one], _) => *one,
                (values, _) => line(&constants.loads, values, load),
            };
            let mut x = of(&constants.scales, 1.0) * t - of(&constants.shifts, 0.0);
            if !constants.spacing.is_empty() {
                let levels: Vec<f64> = (0..=k).map(|n| plane.level(n)).collect();
                x = line(&constants.spacing, &levels, x);
            }
            let h = of(&constants.gains, 1.0) * plain.step(x).unwrap();
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
        let top = owned.body.map_or(plane.max() + plane.step(), |body| {
            full * body.hold(plane.max())
        });
        let bottom = owned.body.map_or(plane.bottom() - plane.step(), |body| {
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
        assert_eq!(
            (&again, &memory_again),
            (&state, &memory),
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
        let constants = Constants::random(&mut rng, &plane);
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
        constants.coefficients.clear();
        constants.taus.clear();
        let owned = constants.map(|v| v);
        let (stages, inverse) = (owned.stages(), case.0.inverse().unwrap());
        let (mut state, mut memory) = (case.1.clone(), StageState::default());
        let on = case.0.total();
        for _ in 0..50 {
            let sum = rng.random_range(0.0..1.0) * on;
            let load = Some(rng.random_range(-4.0..8.0));
            let loaded = stages.axis.load.at(load).unwrap();
            let (sum, offset) = (loaded.gain * sum, owned.offset + loaded.offset);
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
            spacing: &[],
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

    let wrong = |stages: Stages<'_, f64>, stage| {
        assert_eq!(stages.check(&model), Err(Error::Stage { stage }));
    };
    for (stage, body) in [
        ("gain", Body { gain: 0.0, ..body }),
        (
            "ambient",
            Body {
                ambient: f64::NAN,
                ..body
            },
        ),
        (
            "tau_heating",
            Body {
                tau_heating: -1.0,
                ..body
            },
        ),
        (
            "tau_cooling",
            Body {
                tau_cooling: f64::INFINITY,
                ..body
            },
        ),
    ] {
        wrong(
            Stages {
                body: Some(body),
                ..stages
            },
            stage,
        );
    }
    let axis = stages.axis;
    wrong(
        Stages {
            axis: Axis {
                load: Load {
                    loads: &[2.0, 1.0],
                    ..axis.load
                },
                ..axis
            },
            ..stages
        },
        "loads",
    );
    wrong(
        Stages {
            axis: Axis {
                load: Load {
                    shifts: &[2.0],
                    ..axis.load
                },
                ..axis
            },
            ..stages
        },
        "shifts",
    );
    wrong(
        Stages {
            axis: Axis {
                load: Load {
                    scales: &[1.0, 0.0],
                    ..axis.load
                },
                ..axis
            },
            ..stages
        },
        "scales",
    );
    wrong(
        Stages {
            axis: Axis {
                spacing: &[0.0, 2.0, 1.0],
                ..axis
            },
            ..stages
        },
        "spacing",
    );
    wrong(
        Stages {
            axis: Axis {
                spacing: &[0.0, 2.0],
                ..axis
            },
            ..stages
        },
        "spacing",
    );
    wrong(
        Stages {
            axis: Axis {
                load: Load {
                    gains: &[1.0, -1.0],
                    ..axis.load
                },
                ..axis
            },
            ..stages
        },
        "gains",
    );
    wrong(
        Stages {
            axis: Axis {
                load: Load {
                    offsets: &[1.0],
                    ..axis.load
                },
                ..axis
            },
            ..stages
        },
        "offsets",
    );
    let creep = Creep {
        coefficients: &[0.1],
        taus: &[0.0],
    };
    wrong(Stages { creep, ..stages }, "creep");
    wrong(
        Stages {
            creep: Creep {
                coefficients: &[-0.1],
                taus: &[1.0],
            },
            ..stages
        },
        "creep",
    );
    wrong(
        Stages {
            lag: f64::NAN,
            ..stages
        },
        "lag",
    );
    wrong(
        Stages {
            offset: f64::INFINITY,
            ..stages
        },
        "offset",
    );
}
