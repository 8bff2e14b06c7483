//! The inverse of a series is that of its targets one after the other, for any model without
//! stages.

use hysteron::{
    Direction, Error, FirstOrder, Model, Operator, Plane, Sample, Sign, Target, Wanted,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

#[test]
fn a_series_is_solved_as_its_targets_one_by_one() {
    for round in 0..400 {
        let mut rng = ChaCha8Rng::seed_from_u64(round);
        let operators = [Operator::Mkp, Operator::Kp, Operator::Relay];
        let operator = operators[rng.random_range(0..3)];
        let levels = rng.random_range(2..8);
        let plane = Plane::new(20.0, 80.0, levels).unwrap();
        let weights = (0..plane.operators()).map(|_| rng.random_range(0.0..1.0_f64));
        let weights = weights.map(|mu| if mu < 0.2 { 0.0 } else { mu }).collect();
        let sign = [Sign::Positive, Sign::Negative][rng.random_range(0..2)];
        let offset = rng.random_range(-3.0..3.0);
        let model = Model::new(operator, plane, weights, offset, sign).unwrap();
        let mut inverse = model.inverse().unwrap();
        if rng.random_bool(0.3) {
            inverse = inverse.drive_range(30.0, 70.0).unwrap();
        }
        let (low, high) = model.output_range();
        let beyond = 0.2 * (high - low).abs() + 0.1;
        let (low, high) = (low.min(high) - beyond, low.max(high) + beyond);
        let targets: Vec<f64> = (0..60).map(|_| rng.random_range(low..high)).collect();
        let headings = (0..rng.random_range(0..60)).map(|_| match rng.random_range(0..3) {
            0 => None,
            1 => Some(Direction::Rising),
            _ => Some(Direction::Falling),
        });
        let headings: Vec<Option<Direction>> = headings.collect();
        let tolerance = [0.0, 0.05, f64::NAN][rng.random_range(0..3)];

        let (mut series, mut alone) = (model.start(), model.start());
        let found = inverse.headed(&mut series, &targets, &headings, tolerance);
        let one = |(n, &output): (usize, &f64)| {
            let heading = headings.get(n).copied().flatten();
            let target = Target {
                output,
                heading,
                tolerance,
            };
            inverse.step(&mut alone, Wanted::from(target)).unwrap()
        };
        let expected: Vec<_> = targets.iter().enumerate().map(one).collect();
        assert_eq!(found.unwrap(), expected, "round {round}");
        assert_eq!(series, alone, "round {round}");

        let mut faulty = targets.clone();
        let at = rng.random_range(0..faulty.len());
        faulty[at] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][rng.random_range(0..3)];
        let error = inverse
            .headed(&mut series, &faulty, &headings, tolerance)
            .unwrap_err();
        let expected = Error::from(hysteron_core::Error::InputNotFinite { index: at });
        assert_eq!(error.to_string(), expected.to_string(), "round {round}");
        assert_eq!(series, alone, "round {round}: moved before an error");
    }
}

#[test]
fn an_empty_series_leaves_the_state_as_it_is() {
    let plane = Plane::new(20.0, 80.0, 3).unwrap();
    let plain = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive).unwrap();
    let mut heated = plain.clone();
    heated.thermal = Some(FirstOrder::default());
    let mut state = heated.start();
    let sample = Sample {
        dt: Some(0.1),
        ..Sample::from(0.5)
    };
    heated.step(&mut state, sample).unwrap();
    let before = state.clone();
    let found = plain.inverse().unwrap().headed(&mut state, &[], &[], 0.0);
    assert!(found.unwrap().is_empty());
    assert_eq!(state, before);
}
