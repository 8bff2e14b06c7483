//! A model that is evaluated on what its fit held out has the verdict that the fit gave.

use hysteron::{
    Fit, HoldOut, Model, Operator, Plane, Recording, Sign, Verdict, evaluate, fit_holding_out,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Random branches through a plant, with noise.
fn recorded(rng: &mut ChaCha8Rng, plant: &Model, branches: usize, noise: f64) -> Recording {
    let mut input = vec![0.1];
    for k in 0..branches {
        let from = *input.last().unwrap();
        let to = rng.random_range(if k % 2 == 0 { 0.5..1.0 } else { 0.1..0.6 });
        input.extend((1..=20).map(|n| from + (to - from) * f64::from(n) / 20.0));
    }
    let mut output = plant.simulate(&input).unwrap();
    for y in &mut output {
        *y += noise * rng.random_range(-1.0..1.0);
    }
    Recording::new(input, output).unwrap()
}

#[test]
fn an_evaluation_on_what_was_held_out_repeats_the_verdict_of_the_fit() {
    let mut with_other_rival = 0;
    for seed in 0..12 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plane = Plane::new(0.1, 1.0, 10).unwrap();
        let weights = (0..55).map(|_| rng.random_range(0.0..1.0)).collect();
        let plant = Model::new(Operator::Mkp, plane, weights, 0.5, Sign::Positive).unwrap();
        let noise = rng.random_range(0.0..2.0);
        let count = rng.random_range(3..14);
        let fitted = recorded(&mut rng, &plant, count, noise);
        let others = vec![recorded(&mut rng, &plant, 8, noise)];
        let what = HoldOut::Recordings(others.clone());
        let fit = Fit::new().bootstrap(0);
        let (model, _) = fit_holding_out(&fit, &fitted, &what).unwrap();
        let of_fit = Verdict::of_fit_holding_out(&model, &fitted, Some(&what)).unwrap();
        let read = Model::from_json(&model.to_json()).unwrap();
        let evaluation = evaluate(&read, &others).unwrap();
        let again = Verdict::of_evaluation(&read, &others, &evaluation).unwrap();
        assert_eq!(again.grade, of_fit.grade, "seed {seed}: {of_fit}\n{again}");
        assert_eq!(again.rival, of_fit.rival, "seed {seed}");
        assert_eq!(again.causes, of_fit.causes, "seed {seed}");
        // On another recording the rival is another one.
        let third = vec![recorded(&mut rng, &plant, 8, noise)];
        let evaluation = evaluate(&read, &third).unwrap();
        let third = Verdict::of_evaluation(&read, &third, &evaluation).unwrap();
        with_other_rival += i32::from(third.rival != of_fit.rival);
    }
    assert_eq!(with_other_rival, 12);
}
