//! The exported adaptation gives the digits of the core's estimator.

use crate::common::programs::{has, links, run, skip};
use crate::common::reference::Number;
use crate::common::{Exported, REALS, answers, same, walks};
use hysteron::{AdaptOptions, DriftBasis, Learner, Model, Sign};
use hysteron_core::{
    Adaptation, Direction, Estimator, Method, Outcome, Plane, State, Target, Turn, estimator_len,
    estimator_len_of_basis, table_len, turn_capacity,
};
use hysteron_export::{COptions, CReal};
use rand::RngExt;
use rand::rngs::StdRng;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

const LEARNERS: [Learner; 3] = [Learner::Increments, Learner::LeastSquares, Learner::Drift];

/// A call of the driver.
enum Call {
    Learn(f64, f64),
    Move(f64),
    Compensate(f64, i32, f64),
    Freeze(bool),
    Keep,
    RollBack,
    Off,
    Weights,
}

struct Case {
    model: Model,
    learner: Learner,
    /// The exported ones, where there are none.
    options: Option<Adaptation<f64>>,
    calls: Vec<Call>,
}

/// What the driver has to print: the core, with offset and sign as the façade's adaptive model has
/// them.
fn script<T: Number>(n: usize, case: &Case, outcomes: &mut [usize; 8]) -> (String, String) {
    let of = T::of;
    let (k, sign) = (case.model.plane().levels(), of(case.model.sign().factor()));
    let falls = case.model.sign() == Sign::Negative;
    let plane = case.model.plane();
    let plane = Plane::new(of(plane.min()), of(plane.max()), k).unwrap();
    let weights: Vec<T> = case.model.weights().iter().map(|&mu| of(mu)).collect();
    let operator = case.model.operator();
    let table = vec![T::ZERO; 2 * table_len(k)];
    let mut model = hysteron_core::Model::new(plane, operator, &weights, table).unwrap();
    let learner = match case.learner {
        Learner::Increments => 1,
        Learner::LeastSquares => 2,
        _ => 3,
    };
    let mut start = format!("m {n} {learner} {}", u8::from(case.options.is_some()));
    let given = case.options.unwrap_or_else(|| {
        let learner = case.learner;
        let usual = AdaptOptions {
            learner,
            ..AdaptOptions::default()
        };
        usual.before(&case.model).unwrap()
    });
    let (method, numbers) = match given.method {
        Method::Increments { gain, span } => {
            let (of_gain, of_span) = (of(gain), of(span));
            let method = Method::Increments {
                gain: of_gain,
                span: of_span,
            };
            (method, [gain, span, 0.0, 0.0, 0.0, 0.0])
        }
        Method::LeastSquares {
            forgetting,
            noise,
            spread,
            correlation,
        } => {
            let method = Method::LeastSquares {
                forgetting: of(forgetting),
                noise: of(noise),
                spread: of(spread),
                correlation: of(correlation),
            };
            (method, [0.0, 0.0, forgetting, noise, spread, correlation])
        }
    };
    if case.options.is_some() {
        let guards = [
            given.offset_share,
            given.dead_zone,
            given.leakage,
            given.movement,
        ];
        for number in numbers.into_iter().chain(guards) {
            write!(start, " {}", of(number).hex()).unwrap();
        }
        write!(start, " {}", given.trial).unwrap();
        write!(start, " {} {}", of(given.gate).hex(), given.burst).unwrap();
    }
    let options = Adaptation {
        method,
        offset_share: of(given.offset_share),
        dead_zone: of(given.dead_zone),
        leakage: of(given.leakage),
        movement: of(given.movement),
        trial: given.trial,
        gate: of(given.gate),
        burst: given.burst,
    };
    let offset = sign * of(case.model.offset());
    let mut estimator = match case.learner {
        Learner::Drift => {
            let drift = DriftBasis::of(&case.model, None).unwrap();
            let basis: Vec<T> = drift.basis.iter().flatten().map(|&mu| of(mu)).collect();
            let coefficients: Vec<T> = drift.coefficients.iter().map(|&c| of(c)).collect();
            let numbers = estimator_len_of_basis(k, method, coefficients.len());
            let memory = vec![T::ZERO; numbers];
            Estimator::of_basis(options, &mut model, &basis, &coefficients, offset, memory).unwrap()
        }
        _ => {
            let memory = vec![T::ZERO; estimator_len(k, method)];
            Estimator::new(options, &mut model, &weights, offset, memory).unwrap()
        }
    };
    let turns = || vec![Turn::default(); turn_capacity(k)];
    let mut state: State<T, _> = model.state(turns()).unwrap();
    let mut compensator: State<T, _> = model.state(turns()).unwrap();

    let (mut commands, mut answers) = (start + "\n", String::from("m 0\n"));
    for call in &case.calls {
        match call {
            Call::Learn(x, y) => {
                let (x, y) = (of(*x), of(*y));
                writeln!(commands, "a {} {}", x.hex(), y.hex()).unwrap();
                match estimator.step(&mut model, &mut state, x, sign * y) {
                    Ok(learning) => {
                        let outcome = match learning.outcome {
                            Outcome::Learned => 0,
                            Outcome::Waiting => 1,
                            Outcome::AtRest => 2,
                            Outcome::Frozen => 3,
                            Outcome::RolledBack => 4,
                            Outcome::Rejected => 5,
                            Outcome::OutputStuck => 6,
                            Outcome::InputStuck => 7,
                        };
                        outcomes[outcome] += 1;
                        writeln!(answers, "a 0 {} {outcome}", (sign * learning.output).hex())
                            .unwrap();
                    }
                    Err(error) => writeln!(answers, "a {} 0 7", error.code()).unwrap(),
                }
            }
            Call::Move(x) => {
                writeln!(commands, "s {}", of(*x).hex()).unwrap();
                model.step(&mut state, of(*x)).unwrap();
                writeln!(answers, "s 0").unwrap();
            }
            Call::Compensate(target, heading, tolerance) => {
                let (target, tolerance) = (of(*target), of(*tolerance));
                writeln!(commands, "i {} {heading} {}", target.hex(), tolerance.hex()).unwrap();
                let heading = match heading * if falls { -1 } else { 1 } {
                    0 => None,
                    way if way > 0 => Some(Direction::Rising),
                    _ => Some(Direction::Falling),
                };
                model.rebase(&mut compensator).unwrap();
                let raw = Target {
                    output: sign * target - estimator.offset(),
                    heading,
                    tolerance,
                };
                let inverse = model.inverse().unwrap();
                let solution = inverse.step(&mut compensator, raw).unwrap();
                let status = match falls {
                    true => solution.status.mirrored(),
                    false => solution.status,
                };
                let status = status.number();
                writeln!(answers, "i 0 {} {status}", solution.input.hex()).unwrap();
            }
            Call::Freeze(frozen) => {
                writeln!(commands, "f {}", u8::from(*frozen)).unwrap();
                estimator.freeze(*frozen);
                writeln!(answers, "f 0").unwrap();
            }
            Call::Keep => {
                writeln!(commands, "k").unwrap();
                estimator.keep();
                writeln!(answers, "k 0").unwrap();
            }
            Call::RollBack => {
                writeln!(commands, "b").unwrap();
                estimator.roll_back(&mut model);
                model.rebase(&mut state).unwrap();
                writeln!(answers, "b 0").unwrap();
            }
            Call::Off => {
                writeln!(commands, "0").unwrap();
                estimator.realign();
                model.reset_off(&mut state).unwrap();
                writeln!(answers, "0 0").unwrap();
            }
            Call::Weights => {
                writeln!(commands, "w").unwrap();
                write!(answers, "w {}", (sign * estimator.offset()).hex()).unwrap();
                for weight in estimator.parameters().iter().rev() {
                    write!(answers, " {}", weight.hex()).unwrap();
                }
                answers.push('\n');
            }
        }
    }
    (commands, answers)
}

fn options(rng: &mut StdRng, learner: Learner, model: &Model) -> Option<Adaptation<f64>> {
    let one_of = |rng: &mut StdRng, values: [f64; 3]| values[rng.random_range(0..3)];
    let (off, on) = model.output_range();
    let range = (on - off).abs();
    let method = match learner {
        Learner::Increments => Method::Increments {
            gain: rng.random_range(0.05..1.9),
            span: one_of(rng, [0.125, 1.0, 2.5]),
        },
        _ => Method::LeastSquares {
            forgetting: one_of(rng, [0.9, 0.999, 1.0]),
            noise: one_of(rng, [0.002, 0.02, 0.1]) * range.max(1e-3),
            spread: match learner {
                Learner::Drift => one_of(rng, [0.1, 0.5, 2.0]),
                _ => one_of(rng, [0.01, 0.05, 0.2]) * range.max(1e-3),
            },
            correlation: match learner {
                Learner::Drift => 0.0,
                _ => one_of(rng, [0.0, 1.0, 3.0]),
            },
        },
    };
    rng.random_bool(0.8).then(|| Adaptation {
        method,
        offset_share: one_of(rng, [0.0, 1.0, 5.0]),
        dead_zone: one_of(rng, [0.0, 0.01, 0.3]),
        leakage: one_of(rng, [0.0, 1e-3, 0.2]),
        movement: one_of(rng, [0.0, 0.05, 0.5]),
        trial: [1, 7, 64][rng.random_range(0..3)],
        gate: one_of(rng, [0.0, 2.0, 12.0]),
        burst: [1, 3, 8][rng.random_range(0..3)],
    })
}

/// A walk with the output of another model measured, with noise, and bursts of readings that are
/// far off.
fn calls(rng: &mut StdRng, model: &Model, count: usize) -> Vec<Call> {
    let plane = model.plane();
    let k = plane.levels() as f64;
    let scale: Vec<f64> = model
        .weights()
        .iter()
        .map(|mu| (mu + 0.1) * rng.random_range(0.5..2.0))
        .collect();
    let plant = Model::new(
        model.operator(),
        *plane,
        scale,
        model.offset() + 0.3,
        model.sign(),
    )
    .unwrap();
    let mut there = plant.start();
    let (low, high) = model.output_range();
    let mut x = 0.0_f64;
    let mut wild = 0;
    let mut calls = Vec::new();
    for _ in 0..count {
        x = match rng.random_range(0..20) {
            0 => rng.random_range(-0.2..1.2) * k,
            1 => x.round(),
            2 => x,
            _ => (x + rng.random_range(-1.0..1.0)).clamp(-1.0, k + 1.0),
        };
        let input = plane.min() + (x - 1.0) * plane.step();
        let mut measured =
            plant.step(&mut there, input).unwrap().output + rng.random_range(-0.01..0.01);
        if wild == 0 && rng.random_bool(0.01) {
            wild = rng.random_range(1..40);
        }
        if wild > 0 {
            wild -= 1;
            measured *= [10.0, 1e10, 1e25][wild % 3];
        }
        calls.push(Call::Learn(input, measured));
        match rng.random_range(0..40) {
            0 => calls.push(Call::Move(
                plane.level(rng.random_range(0..=plane.levels())),
            )),
            1 => calls.push(Call::Freeze(true)),
            2 | 3 => calls.push(Call::Freeze(false)),
            4 => calls.push(Call::Keep),
            5 if rng.random_bool(0.3) => calls.push(Call::RollBack),
            6 if rng.random_bool(0.3) => calls.push(Call::Off),
            7 => calls.push(Call::Learn(input, f64::NAN)),
            8 => calls.push(Call::Weights),
            9..=18 => {
                let target = low + rng.random_range(-0.1..1.1) * (high - low);
                calls.push(Call::Compensate(target, rng.random_range(-1..=1), 0.01));
            }
            _ => {}
        }
    }
    calls.push(Call::Freeze(false));
    stuck(rng, &plant, &mut calls);
    calls.push(Call::Weights);
    calls
}

/// Loops over the whole plane; then the output stands still, first to the bit and then with some
/// noise, and then the input with some.
fn stuck(rng: &mut StdRng, plant: &Model, calls: &mut Vec<Call>) {
    let (plane, mut there, mut last) = (plant.plane(), plant.start(), 0.0);
    let k = plane.levels() as f64;
    for n in 0..1200 {
        let way = 1.0 - (f64::from(n % 100) / 50.0 - 1.0).abs();
        let at = |x: f64| plane.min() + (x - 1.0) * plane.step();
        let measured = plant.step(&mut there, at(k * way)).unwrap().output;
        let (seen, read) = match n {
            0..250 => (k * way, measured),
            250..475 => (k * way, last),
            475..700 => (k * way, last + rng.random_range(-0.01..0.01)),
            _ => (0.5 * k + rng.random_range(0.0..0.2), measured),
        };
        if n < 250 {
            last = measured;
        }
        calls.push(Call::Learn(at(seen), read));
    }
}

fn exports_as_float(model: &Model) -> bool {
    let options = COptions {
        real: CReal::Float,
        name: Some("m"),
        source: Path::new("some model.json"),
        adaptation: true,
    };
    hysteron_export::c(model, tempfile::tempdir().unwrap().path(), &options).is_ok()
}

fn cases(seed: u64, count: usize) -> Vec<Case> {
    let mut rng = walks::rng(seed);
    let levels = [2, 3, 4, 6, 9, 20];
    let each = levels
        .iter()
        .flat_map(|&k| walks::OPERATORS.map(|operator| (k, operator)))
        .flat_map(|case| LEARNERS.map(|learner| (case, learner)))
        // Least squares of all weights are for few levels.
        .filter(|((k, _), learner)| *learner != Learner::LeastSquares || *k < 9);
    each.map(|((k, operator), learner)| {
        // Weights that are not negative.
        let model = loop {
            let model = walks::model(&mut rng, operator, k);
            // Beside a large offset, `float` does not hold a small range: it is not exported.
            let is_held = exports_as_float(&model);
            if is_held && model.inverse().is_ok() {
                break model;
            }
        };
        let options = options(&mut rng, learner, &model);
        let calls = calls(&mut rng, &model, count);
        Case {
            model,
            learner,
            options,
            calls,
        }
    })
    .collect()
}

fn compare(exported: &Exported, program: &mut Command, cases: &[Case], what: &str) -> [usize; 8] {
    let (mut commands, mut expected) = (String::new(), String::new());
    let mut outcomes = [0; 8];
    for (n, case) in cases.iter().enumerate() {
        let (lines, answers) = match exported.real {
            CReal::Float => script::<f32>(n, case, &mut outcomes),
            CReal::Double => script::<f64>(n, case, &mut outcomes),
        };
        commands += &lines;
        expected += &answers;
    }
    let found = answers(program, &commands);
    same(&commands, &expected, &found, what);
    outcomes
}

fn exported(cases: &[Case], real: CReal) -> Exported {
    let models: Vec<&Model> = cases.iter().map(|case| &case.model).collect();
    Exported::learning(&models, real)
}

#[test]
fn learning_has_the_same_digits() {
    if !has("cc") {
        return;
    }
    for (seed, levels) in [(0, &["-O0", "-O3"][..]), (1, &["-O2"])] {
        let cases = cases(seed, 1000);
        for real in REALS {
            let exported = exported(&cases, real);
            for level in levels {
                let program = exported.compile("cc", &[level], "adapt.c");
                let what = format!("seed {seed}, {}, {level}", real.name());
                let outcomes = compare(&exported, &mut Command::new(program), &cases, &what);
                // Each outcome was met, rolling back among them.
                assert!(outcomes.iter().all(|&count| count > 10), "{outcomes:?}");
            }
        }
    }
}

#[test]
fn sanitizers_and_valgrind_find_nothing() {
    const SANITIZE: [&str; 3] = [
        "-O1",
        "-fsanitize=address,undefined",
        "-fno-sanitize-recover=all",
    ];
    if !has("cc") {
        return;
    }
    let cases = cases(7, 200);
    let small = &cases[..1];
    for real in REALS {
        let all = exported(&cases, real);
        let one = exported(small, real);
        if links("cc", &SANITIZE) || skip("`cc` has no sanitizers") {
            let program = all.compile("cc", &SANITIZE, "adapt.c");
            compare(&all, &mut Command::new(program), &cases, "sanitized");
            run(&mut Command::new(one.compile(
                "cc",
                &SANITIZE,
                "adapt_misuse.c",
            )));
        }
        if has("valgrind") {
            let program = one.compile("cc", &["-O2"], "adapt_misuse.c");
            run(Command::new("valgrind")
                .args(["--quiet", "--error-exitcode=9"])
                .arg(program));
        }
    }
}
