//! The errors of the core, and that a call with an error changes nothing.

use crate::common::{OPERATORS, build};
use hysteron_core::{
    Clipped, Definition, Error, MAX_LEVELS, Model, Operator, Plane, Target, Turn, table_len,
    turn_capacity,
};

#[test]
fn planes() {
    for levels in [0, 1, MAX_LEVELS + 1, 1_000_000, usize::MAX] {
        assert_eq!(Plane::new(0.0, 1.0, levels), Err(Error::Levels(levels)));
    }
    let bad = [
        (0.0, 0.0),
        (1.0, 0.0),
        (f64::NAN, 1.0),
        (0.0, f64::NAN),
        (f64::NEG_INFINITY, 0.0),
        (0.0, f64::INFINITY),
        (-f64::MAX, f64::MAX),
        (1e16, 1e16 + 2.0), // levels would coincide
        (0.0, 1e-320),
    ];
    for (min, max) in bad {
        assert_eq!(
            Plane::new(min, max, 20),
            Err(Error::Range),
            "{min} to {max}"
        );
    }
    // The widest ranges: the call ends, and if it gives a plane, T_max normalises to K.
    for levels in [2, 3, 20, 1000] {
        for max in [1e307, 1.37e308, f64::MAX] {
            if let Ok(plane) = Plane::new(0.0, max, levels) {
                assert_eq!(plane.normalise(max), levels as f64);
            }
        }
    }
}

#[test]
fn weights_and_memory() {
    let plane = Plane::new(0.0, 1.0, 3).unwrap();
    let table = || vec![0.0; table_len(3)];
    let new = |weights: &[f64]| Model::new(plane, Operator::Mkp, weights, table()).map(|_| ());
    assert_eq!(
        new(&[1.0; 5]),
        Err(Error::WeightCount {
            expected: 6,
            found: 5
        })
    );
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        let refused = new(&[1.0, 1.0, 1.0, 1.0, bad, 1.0]);
        assert_eq!(refused, Err(Error::WeightNotFinite { index: 4 }));
    }
    assert!(matches!(
        new(&[f64::MAX; 6]),
        Err(Error::WeightNotFinite { .. })
    ));
    let small = Model::new(plane, Operator::Mkp, &[1.0; 6], vec![0.0; 9]).map(|_| ());
    assert_eq!(
        small,
        Err(Error::MemoryTooSmall {
            needed: 10,
            found: 9
        })
    );
    let model = Model::new(plane, Operator::Mkp, &[1.0; 6], table()).unwrap();
    let small = model
        .state(vec![Turn::default(); turn_capacity(3) - 1])
        .map(|_| ());
    assert_eq!(
        small,
        Err(Error::MemoryTooSmall {
            needed: 20,
            found: 19
        })
    );
    let mut states = [0.0; 5];
    let plain = Definition::new(plane, Operator::Mkp, &[1.0; 6], &mut states).map(|_| ());
    assert_eq!(
        plain,
        Err(Error::MemoryTooSmall {
            needed: 6,
            found: 5
        })
    );
}

#[test]
fn inputs_that_are_no_numbers_leave_the_state_untouched() {
    let plane = Plane::new(0.0, 1.0, 3).unwrap();
    let (model, mut state) = build(plane, Operator::Mkp, &[1.0; 6]);
    model.step(&mut state, 0.7).unwrap();
    let before = state.clone();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(
            model.step(&mut state, bad),
            Err(Error::InputNotFinite { index: 0 })
        );
        let run = model.run(&mut state, &[0.1, 0.9, bad], &mut [0.0; 3]);
        assert_eq!(run, Err(Error::InputNotFinite { index: 2 }));
        assert_eq!(state, before);
    }
    let short = model.run(&mut state, &[0.1; 3], &mut [0.0; 2]);
    assert_eq!(
        short,
        Err(Error::MemoryTooSmall {
            needed: 3,
            found: 2
        })
    );
    assert_eq!(state, before);
}

#[test]
fn inputs_outside_the_plane_are_clipped_and_say_so() {
    let plane = Plane::new(0.0, 1.0, 3).unwrap();
    let (model, mut state) = build(plane, Operator::Mkp, &[1.0; 6]);
    let mut step = |input| model.step(&mut state, input).unwrap();
    assert_eq!(
        (step(1e300).clipped, step(1.0).clipped),
        (Some(Clipped::High), None)
    );
    assert_eq!(step(f64::MAX).output, 6.0);
    // The active range starts one step below the lowest level.
    assert_eq!(
        (step(-0.5).clipped, step(-0.5 - 1e-9).clipped),
        (None, Some(Clipped::Low))
    );
    assert_eq!(step(f64::MIN).output, 0.0);
    let mut out = [0.0; 4];
    let count = model
        .run(&mut state, &[-9.0, 0.5, 9.0, 9.0], &mut out)
        .unwrap();
    assert_eq!((count.low, count.high), (1, 2));
}

#[test]
fn states_of_other_models_and_broken_saves() {
    let plane = |k| Plane::new(0.0, 1.0, k).unwrap();
    let (model, mut state) = build(plane(3), Operator::Mkp, &[1.0; 6]);
    let (_, mut larger) = build(plane(4), Operator::Mkp, &[1.0; 10]);
    let (_, mut relay) = build(plane(3), Operator::Relay, &[1.0; 6]);
    assert_eq!(model.step(&mut larger, 0.5), Err(Error::StateMismatch));
    assert_eq!(model.step(&mut relay, 0.5), Err(Error::StateMismatch));
    // The same levels, but other weights, or another plane.
    let (other, mut heavier) = build(plane(3), Operator::Mkp, &[2.0; 6]);
    let (_, mut wider) = build(Plane::new(0.0, 2.0, 3).unwrap(), Operator::Mkp, &[1.0; 6]);
    assert_eq!(model.step(&mut heavier, 0.5), Err(Error::StateMismatch));
    assert_eq!(model.step(&mut wider, 0.5), Err(Error::StateMismatch));
    // A history can be restored in another model.
    model.step(&mut state, 0.7).unwrap();
    let points: Vec<f64> = state.turning_points().collect();
    model.restore(&mut heavier, &points, 0.7).unwrap();
    assert_eq!(model.output(&heavier), model.output(&state));
    assert_eq!(other.step(&mut heavier, 0.5), Err(Error::StateMismatch));
    assert_eq!(model.reset_on(&mut larger), Err(Error::StateMismatch));
    let inverse = model.inverse().unwrap();
    assert_eq!(
        inverse.step(&mut larger, Target::new(0.5)),
        Err(Error::StateMismatch)
    );
    let before = state.clone();
    let mut restore = |points: &[f64]| model.restore(&mut state, points, 0.5);
    assert_eq!(
        restore(&[2.0, 1.0, 2.5]),
        Err(Error::TurningPoints { index: 2 })
    );
    assert_eq!(restore(&[f64::NAN]), Err(Error::TurningPoints { index: 0 }));
    assert_eq!(restore(&[3.1]), Err(Error::TurningPoints { index: 0 }));
    assert_eq!(restore(&[-0.1]), Err(Error::TurningPoints { index: 0 }));
    assert_eq!(state, before);
    assert_eq!(state.gamma(2, 1), Err(Error::Operator { i: 2, j: 1 }));
    assert_eq!(state.gamma(1, 4), Err(Error::Operator { i: 1, j: 4 }));
    assert_eq!(state.gamma(0, 1), Err(Error::Operator { i: 0, j: 1 }));
    // −0 is 0: the bottom of the plane, from where 1 is reached again.
    assert_eq!(model.restore(&mut state, &[2.0, -0.0, 1.0], 0.0), Ok(()));
    assert!(state.turning_points().eq([1.0]));
}

/// Operators of ±1 span twice the sum of the weights' sizes. That has to be a number.
#[test]
fn weights_of_any_size_and_sign_are_taken_up_to_half_the_largest_number() {
    let plane = Plane::new(0.0, 1.0, 3).unwrap();
    let alternating = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
    for operator in OPERATORS {
        for signs in [[1.0; 6], [-1.0; 6], alternating] {
            for (share, fine) in [(1e-100, true), (0.49, true), (0.51, false), (0.9, false)] {
                let weights = signs.map(|sign| sign * share * (f64::MAX / 6.0));
                let model = Model::new(plane, operator, &weights, [0.0; table_len(3)]);
                assert_eq!(model.is_ok(), fine, "{operator:?}, {signs:?}, {share}");
            }
        }
    }
}

/// The weight of operator (1, K) is in one entry of the table only.
#[test]
fn a_model_that_differs_in_one_bit_refuses_the_state() {
    let plane = Plane::new(0.0, 1.0, 3).unwrap();
    let last = |weight| [0.0, 0.0, 0.0, weight, 0.0, 0.0];
    let (model, _) = build(plane, Operator::Mkp, &last(1.0));
    for bit in 0..52 {
        let other = f64::from_bits(1.0_f64.to_bits() ^ (1 << bit));
        let (_, mut state) = build(plane, Operator::Mkp, &last(other));
        let refused = model.step(&mut state, 0.5);
        assert_eq!(refused, Err(Error::StateMismatch), "bit {bit}");
    }
}
