#![allow(clippy::unwrap_used)]
mod common;
use common::{OPERATORS, build, levels, plane, rng, weights};
use hysteron_core::*;
use rand::RngExt;

#[test]
fn explore() {
    for relay in 0..3 {
        let mut bad = Vec::new();
        for seed in 0..400 {
            let mut rng = rng(seed);
            let k = levels(&mut rng, 20).max(3);
            let plane = plane(&mut rng, k);
            let truth = std::iter::repeat_with(|| weights(&mut rng, k));
            let truth = truth
                .skip_while(|t| t.iter().all(|mu| *mu == 0.0))
                .take(1)
                .next()
                .unwrap();
            let (model, mut state) = build(plane, OPERATORS[relay], &truth);
            let mut there = state.clone();

            let options = ShiftOptions::usual(&model, &Stages::NONE);
            let reach = options.reach;
            let delta = rng.random_range(-1.0..1.0) * reach;
            let mut est = ShiftEstimator::new(options, &model, &Stages::NONE).unwrap();
            let mut memory = StageState::default();
            let (low, high) = (plane.bottom() - reach, plane.max() + reach);
            let per = 40 * k;
            let mut trail = Vec::new();
            for n in 0..6 * per {
                let phase = (n as f64 / per as f64).fract();
                let t = low + (high - low) * (1.0 - (2.0 * phase - 1.0).abs());
                let y = model.step(&mut there, t - delta).unwrap().output;
                let l = est
                    .step(&Stages::NONE, &model, &mut state, &mut memory, t.into(), y)
                    .unwrap();
                if n % (per / 2) == 0 {
                    trail.push(((est.shift() - delta) / plane.step() * 1000.0).round() / 1000.0);
                }
                let _ = l;
            }
            let err = (est.shift() - delta).abs() / plane.step();
            if err > if relay == 2 { 1.01 } else { 0.05 } {
                bad.push((seed, k, err, delta / plane.step(), trail));
            }
        }
        println!("{:?}: bad {}", OPERATORS[relay], bad.len());
        for b in bad.iter().take(12) {
            println!("{b:?}");
        }
    }
}
