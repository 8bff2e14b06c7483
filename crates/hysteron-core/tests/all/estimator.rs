//! The errors of estimators, their memory and their number types.

use crate::common::{
    INCREMENTS, LEAST_SQUARES, Learner, METHODS, build, dense, options, rng, strokes, unit_plane,
};
use hysteron_core::{
    Adaptation, Error, Estimator, Method, Model, Operator, Plane, Real, State, Turn, estimator_len,
    estimator_len_of_basis, operator_count, table_len, turn_capacity,
};
use rand::RngExt;

const K: usize = 4;
const N: usize = operator_count(K);

fn refused(options: Adaptation<f64>) -> Error {
    let (mut model, _) = build(unit_plane(K), Operator::Mkp, &[1.0; N]);
    let memory = vec![0.0; 1000];
    Estimator::new(options, &mut model, &[1.0; N], 0.0, memory).unwrap_err()
}

#[test]
fn options_out_of_range_are_refused_by_name() {
    let least_squares = |forgetting, noise, spread, correlation| Method::LeastSquares {
        forgetting,
        noise,
        spread,
        correlation,
    };
    let span = |span| Method::Increments { gain: 0.5, span };
    let gain = |gain| Method::Increments { gain, span: 1.0 };
    let (nan, infinite) = (f64::NAN, f64::INFINITY);
    let mut cases = Vec::new();
    for bad in [0.0, -0.1, 2.0, nan, infinite] {
        cases.push((options(gain(bad)), "gain"));
    }
    for bad in [0.0, 0.12, 8.1, nan, infinite] {
        cases.push((options(span(bad)), "span"));
    }
    for bad in [0.0, -0.1, 1.001, nan] {
        cases.push((options(least_squares(bad, 1.0, 1.0, 0.0)), "forgetting"));
    }
    for bad in [0.0, -1.0, 1e-200, 1e200, nan, infinite] {
        cases.push((options(least_squares(0.9, bad, 1.0, 0.0)), "noise"));
        cases.push((options(least_squares(0.9, 1.0, bad, 0.0)), "spread"));
    }
    for bad in [-1.0, nan, infinite] {
        cases.push((options(least_squares(0.9, 1.0, 1.0, bad)), "correlation"));
        let guards = options(INCREMENTS);
        let (offset_share, dead_zone, movement) = (bad, bad, bad);
        cases.push((
            Adaptation {
                offset_share,
                ..guards
            },
            "offset_share",
        ));
        cases.push((
            Adaptation {
                dead_zone,
                ..guards
            },
            "dead_zone",
        ));
        cases.push((Adaptation { movement, ..guards }, "movement"));
        cases.push((
            Adaptation {
                leakage: bad,
                ..guards
            },
            "leakage",
        ));
    }
    cases.push((
        Adaptation {
            leakage: 1.1,
            ..options(INCREMENTS)
        },
        "leakage",
    ));
    cases.push((
        Adaptation {
            trial: 0,
            ..options(INCREMENTS)
        },
        "trial",
    ));
    for (options, option) in cases {
        assert_eq!(
            refused(options),
            Error::Adaptation { option },
            "{options:?}"
        );
    }
    // Codes never change.
    assert_eq!(Error::Adaptation { option: "gain" }.code(), 11);
}

#[test]
fn weights_memory_and_offset() {
    for method in METHODS {
        let new = |weights: &[f64], offset: f64, tables: usize, memory: usize| {
            let table = vec![0.0; tables * table_len(K)];
            let mut model = Model::new(unit_plane(K), Operator::Mkp, &[1.0; N], table).unwrap();
            let before = model.clone();
            let memory = vec![0.0; memory];
            let made = Estimator::new(options(method), &mut model, weights, offset, memory);
            assert!(
                made.is_ok() || model == before,
                "refused, and nothing changed"
            );
            made.map(|_| ())
        };
        let needed = estimator_len(K, method);
        assert_eq!(new(&[2.0; N], 0.0, 2, needed), Ok(()));
        let small = Error::MemoryTooSmall {
            needed,
            found: needed - 1,
        };
        assert_eq!(new(&[2.0; N], 0.0, 2, needed - 1), Err(small));
        let mut negative = [1.0; N];
        negative[2] = -1e-12;
        assert!(matches!(
            new(&negative, 0.0, 2, needed),
            Err(Error::NegativeWeights(which)) if which.first[0] == Some((2, 2))
        ));
        assert!(matches!(
            new(&[f64::NAN; N], 0.0, 2, needed),
            Err(Error::WeightNotFinite { .. })
        ));
        assert!(matches!(
            new(&[1.0; N - 1], 0.0, 2, needed),
            Err(Error::WeightCount { .. })
        ));
        let offset = new(&[1.0; N], f64::NAN, 2, needed);
        assert_eq!(offset, Err(Error::InputNotFinite { index: 0 }));
        if method == INCREMENTS {
            let (needed_table, found) = (2 * table_len(K), table_len(K));
            let small = Error::MemoryTooSmall {
                needed: needed_table,
                found,
            };
            assert_eq!(new(&[1.0; N], 0.0, 1, needed), Err(small));
        }
    }
}

#[test]
fn no_more_memory_than_the_arrays_need() {
    for levels in 2..20 {
        let n = operator_count(levels);
        // Parameters with the offset: now, off-line, good, candidate, trusted, pending, regressor;
        // states.
        let common = 7 * (n + 1) + n;
        let triangle = operator_count(n + 1);
        assert_eq!(estimator_len(levels, INCREMENTS), common + n);
        let matrices = 2 * triangle + 2 * (n + 1);
        assert_eq!(estimator_len(levels, LEAST_SQUARES), common + matrices);
        for count in 1..5 {
            let common = 7 * (count + 1) + count * table_len(levels);
            let matrices = 2 * operator_count(count + 1) + 2 * (count + 1);
            let len = |method| estimator_len_of_basis(levels, method, count);
            assert_eq!(len(LEAST_SQUARES), common + matrices);
        }
    }
}

/// Least squares of coefficients.
const COEFFICIENTS: Method<f64> = Method::LeastSquares {
    forgetting: 0.99,
    noise: 0.01,
    spread: 1.0,
    correlation: 0.0,
};

#[test]
fn parts_and_shares() {
    let new = |method, basis: &[f64], coefficients: &[f64]| {
        let (mut model, _) = build(unit_plane(K), Operator::Mkp, &[1.0; N]);
        let memory = vec![0.0; estimator_len_of_basis(K, method, coefficients.len())];
        let options = options(method);
        Estimator::of_basis(options, &mut model, basis, coefficients, 0.0, memory).map(|_| ())
    };
    let basis = [1.0; 2 * N];
    assert_eq!(new(COEFFICIENTS, &basis, &[1.0, 0.0]), Ok(()));
    let bad = |option| Err(Error::Adaptation { option });
    for coefficients in [
        [-1.0, 1.0],
        [f64::NAN, 1.0],
        [1.0, f64::INFINITY],
        [1e308, 1e308],
    ] {
        assert_eq!(
            new(COEFFICIENTS, &basis, &coefficients),
            bad("coefficients")
        );
    }
    assert_eq!(new(COEFFICIENTS, &[], &[]), bad("coefficients"));
    assert_eq!(new(INCREMENTS, &basis, &[1.0, 1.0]), bad("method"));
    assert_eq!(new(LEAST_SQUARES, &basis, &[1.0, 1.0]), bad("correlation"));
    let (expected, found) = (3 * N, 2 * N);
    let count = Error::WeightCount { expected, found };
    assert_eq!(new(COEFFICIENTS, &basis, &[1.0; 3]), Err(count));
    // Twice the sum of the weights has to be a number, as for every model.
    let all = |share: f64| [share * (f64::MAX / (2 * N) as f64); 2];
    assert_eq!(new(COEFFICIENTS, &basis, &all(0.49)), Ok(()));
    assert_eq!(new(COEFFICIENTS, &basis, &all(0.51)), bad("coefficients"));
    let negative = [-1.0; 2 * N];
    assert!(matches!(
        new(COEFFICIENTS, &negative, &[1.0, 1.0]),
        Err(Error::NegativeWeights(_))
    ));
}

#[test]
fn readings_that_are_no_numbers_change_nothing() {
    for method in METHODS {
        let mut learner = Learner::new(unit_plane(K), Operator::Mkp, &[1.0; N], options(method));
        for input in strokes(&mut rng(1), &unit_plane(K), 500, 20) {
            learner.step(input, 1.0).unwrap();
        }
        let kept = (
            learner.model.clone(),
            learner.state.clone(),
            learner.estimator.clone(),
        );
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let index = |index| Err(Error::InputNotFinite { index });
            assert_eq!(learner.step(bad, 1.0), index(0));
            assert_eq!(learner.step(30.0, bad), index(1));
        }
        assert_eq!((learner.model, learner.state, learner.estimator), kept);
        let (mut other, mut state) = build(unit_plane(K), Operator::Kp, &[1.0; N]);
        let mut estimator = kept.2;
        let step = estimator.step(&mut other, &mut state, 30.0, 1.0);
        assert_eq!(step, Err(Error::StateMismatch));
    }
}

/// The largest error at the end, in ranges, of least squares at ten levels in either precision, and
/// the weights.
fn in_precision<T: Real>(number: impl Fn(f64) -> T, back: impl Fn(T) -> f64) -> (f64, Vec<f64>) {
    const K: usize = 10;
    let mut rng = rng(70);
    let method = Method::LeastSquares {
        forgetting: number(0.99),
        noise: number(0.05),
        spread: number(0.5),
        correlation: number(2.0),
    };
    let guards = Adaptation {
        method,
        ..Adaptation::default()
    };
    let plane = Plane::new(number(20.0), number(80.0), K).unwrap();
    let weights = dense(&mut rng, K);
    let (plant, mut there) = build(unit_plane(K), Operator::Mkp, &weights);
    // All memory is in arrays, as on a microcontroller.
    let offline = [number(0.5); operator_count(K)];
    let mut model = Model::new(plane, Operator::Mkp, &offline, [T::ZERO; table_len(K)]).unwrap();
    let turns = [Turn::default(); turn_capacity(K)];
    let mut state: State<T, [Turn<T>; turn_capacity(K)]> = model.state(turns).unwrap();
    let mut memory = vec![T::ZERO; estimator_len(K, method)];
    let mut estimator =
        Estimator::new(guards, &mut model, &offline, T::ZERO, &mut memory[..]).unwrap();
    let mut worst = 0.0_f64;
    for (n, input) in strokes(&mut rng, &unit_plane(K), 100_000, 40)
        .into_iter()
        .enumerate()
    {
        let output = plant.step(&mut there, input).unwrap().output;
        let measured = number(output + rng.random_range(-0.05..0.05));
        let learning = estimator
            .step(&mut model, &mut state, number(input), measured)
            .unwrap();
        assert!(
            estimator
                .parameters()
                .iter()
                .all(|weight| weight.is_finite())
        );
        if n > 50_000 {
            worst = worst.max((back(learning.output) - output).abs());
        }
    }
    let found = estimator.parameters().iter().map(|&weight| back(weight));
    (worst / plant.output_range().1, found.collect())
}

#[test]
fn least_squares_in_single_precision() {
    let (double, weights) = in_precision(|x| x, |x| x);
    let (single, weights_f32) = in_precision(|x| x as f32, f64::from);
    assert!(double < 0.02 && single < 1.2 * double, "{double} {single}");
    let difference = weights.iter().zip(&weights_f32).map(|(a, b)| (a - b).abs());
    let largest = difference.fold(0.0, f64::max);
    println!(
        "least squares, K = 10, 1e5 samples: largest error {double:.4} in f64, {single:.4} in f32, weights apart by {largest:.4}"
    );
    assert!(largest < 0.01, "{largest}");
}

#[test]
fn memory_may_be_arrays_slices_or_vectors() {
    const METHOD: Method<f64> = LEAST_SQUARES;
    let mut slice = [0.0; estimator_len(K, METHOD)];
    let mut tables = [[0.0; table_len(K)]; 2];
    let [one, two] = &mut tables;
    let mut model = Model::new(unit_plane(K), Operator::Mkp, &[1.0; N], &mut one[..]).unwrap();
    let guards = options(METHOD);
    let array = [0.0; estimator_len(K, METHOD)];
    let mut on_array = Estimator::new(guards, &mut model, &[1.0; N], 0.0, array).unwrap();
    let mut other = Model::new(unit_plane(K), Operator::Mkp, &[1.0; N], &mut two[..]).unwrap();
    let mut on_slice = Estimator::new(guards, &mut other, &[1.0; N], 0.0, &mut slice[..]).unwrap();
    let mut turns = [Turn::default(); turn_capacity(K)];
    let mut state = model.state(&mut turns[..]).unwrap();
    let mut vector = other
        .state(vec![Turn::default(); turn_capacity(K)])
        .unwrap();
    for input in strokes(&mut rng(80), &unit_plane(K), 300, 20) {
        let one = on_array.step(&mut model, &mut state, input, 3.0).unwrap();
        let other = on_slice.step(&mut other, &mut vector, input, 3.0).unwrap();
        assert_eq!(one, other);
    }
}

#[test]
fn messages_say_the_range() {
    let ranges = [
        ("gain", "above 0 and below 2"),
        ("span", "from 1/8 to 8"),
        ("forgetting", "above 0 and up to 1"),
        ("noise", "above 0, and its square a number too"),
        ("spread", "above 0, and its square a number too"),
        (
            "correlation",
            "a finite number from 0 on, and 0 where the coefficients of a basis are adapted",
        ),
        ("offset_share", "a finite number from 0 on"),
        ("dead_zone", "a finite number from 0 on"),
        ("leakage", "from 0 to 1"),
        ("movement", "a finite number from 0 on"),
        ("trial", "1 or more"),
        ("gate", "a finite number from 2 on, or 0 for none"),
        ("burst", "1 or more"),
        (
            "method",
            "least squares where the coefficients of a basis are adapted",
        ),
        ("coefficients", "finite numbers from 0 on, at least one"),
    ];
    for (option, range) in ranges {
        let text = Error::Adaptation { option }.to_string();
        let expected = format!("the estimator's option `{option}` must be {range}");
        assert_eq!(text, expected);
    }
}
