//! Heat that is bound: what cannot be is refused, hostile constants stay numbers, and what is taken
//! is given back. That the step is the solution of its equation is tested with the whole chain.

use crate::common;

use common::stages::Constants;
use common::{build, build_f32, levels, plane, rng, weights};
use hysteron_core::{
    Body, Error, Latent, Operator, Real, Sample, StageState, Stages, Target, Wanted,
};
use rand::RngExt;
use rand::rngs::StdRng;

const BODY: Body<f64> = Body {
    ambient: 0.0,
    gain: 1.0,
    tau_heating: 1.0,
    tau_cooling: 1.0,
};

#[test]
fn only_continuous_operators_behind_a_body_bind_heat() {
    let mut rng = rng(1);
    let plane = plane(&mut rng, 3);
    let stages = Stages {
        body: Some(BODY),
        latent: Latent { heat: 1.0 },
        ..Stages::NONE
    };
    let check = |stages: &Stages<'_, f64>, operator, weights: &[f64]| {
        stages.check(&build(plane, operator, weights).0)
    };
    let refused = Err(Error::Stage { stage: "latent" });
    for operator in [Operator::Mkp, Operator::Kp] {
        assert_eq!(check(&stages, operator, &[1.0; 6]), Ok(()));
        assert_eq!(check(&stages, operator, &[0.0; 6]), Ok(()));
    }
    assert_eq!(check(&stages, Operator::Relay, &[1.0; 6]), refused);
    let mut below = [1.0; 6];
    below[4] = -0.5;
    assert_eq!(check(&stages, Operator::Mkp, &below), refused);
    let bodiless = Stages {
        body: None,
        ..stages
    };
    assert_eq!(check(&bodiless, Operator::Mkp, &[1.0; 6]), refused);
}

/// The heat of the body, bound and not, is what the drive brings it to, wherever the operators are.
#[test]
fn what_is_taken_is_given_back() {
    for seed in 0..100 {
        let mut rng = rng(seed);
        let k = levels(&mut rng, 20);
        let plane = plane(&mut rng, k);
        let (model, mut state) = build(plane, Operator::Mkp, &weights(&mut rng, k));
        let span = plane.max() - plane.bottom();
        let heat = span * 10_f64.powf(rng.random_range(-2.0..1.5));
        let stages = Stages {
            body: Some(BODY),
            latent: Latent { heat },
            ..Stages::NONE
        };
        let total = model.total().max(f64::MIN_POSITIVE);
        let mut memory = StageState::default();
        let mut bound = 0.0;
        for n in 0..300 {
            let input = rng.random_range(plane.bottom() - heat..plane.max() + heat);
            let dt = 10_f64.powf(rng.random_range(-3.0..1.0));
            let unbound = match n {
                0 => BODY.rest(input),
                _ => BODY.step(memory.temperature(), input, BODY.decay(dt)),
            };
            let sample = Sample {
                input,
                dt: Some(dt),
                load: None,
            };
            let found = stages.step(&model, &mut state, &mut memory, sample);
            let now = heat * (found.unwrap().output / total);
            let whole = memory.temperature() + if n == 0 { 0.0 } else { now - bound };
            bound = now;
            // A cell is a `K`-th of the span, and may bind all of the heat: rounding of the
            // temperature is that of the heat times their ratio.
            let size = (span + heat) * (1.0 + heat * k as f64 / span);
            let place = plane.max().abs() + plane.bottom().abs() + heat;
            let rounding = 64.0 * f64::EPSILON * size * (1.0 + place / span);
            assert!(
                (whole - unbound).abs() < rounding,
                "{seed}: {whole} {unbound}"
            );
        }
    }
}

/// Any constants in their ranges, and drives from nothing to everything.
fn hostile<T: Real>(
    rng: &mut StdRng,
    (model, mut state): common::Owned<T>,
    constants: &Constants,
    (number, least): (impl Fn(f64) -> T, f64),
) {
    let heat = number(10_f64.powf(rng.random_range(least..-least)));
    let owned = constants.map(&number);
    let stages = Stages {
        latent: Latent { heat },
        ..owned.stages()
    };
    let Some(body) = stages.body else { return };
    assert_eq!(stages.check(&model), Ok(()));
    let inverse = model.inverse().unwrap();
    let mut memory = StageState::default();
    for n in 0..60 {
        let size = number(10_f64.powf(rng.random_range(-3.0..6.0)));
        let sign = if rng.random() { T::ONE } else { -T::ONE };
        let drive = body.hold(model.plane().min() + sign * size);
        let dt = number(rng.random_range(0.0..2.0));
        let load = Some(number(rng.random_range(-4.0..8.0)));
        if n % 3 == 2 {
            let (off, on) = model.output_range();
            let share = number(rng.random_range(-0.1..1.1));
            let target = Target::new(off + share * (on - off));
            let wanted = Wanted {
                dt: Some(dt),
                load,
                ..target.into()
            };
            let found = stages
                .invert(&inverse, &mut state, &mut memory, wanted)
                .unwrap();
            assert!(found.input.is_finite());
            continue;
        }
        let (before, was) = (memory.temperature(), memory.is_started());
        let sample = Sample {
            input: drive,
            dt: Some(dt),
            load,
        };
        stages
            .step(&model, &mut state, &mut memory, sample)
            .unwrap();
        let unbound = body.step(before, drive, body.decay(dt));
        let found = memory.temperature();
        assert!(found.is_finite());
        // Without a load nothing but the drive moves the operators: what binds only holds back.
        if was && constants.loads.is_empty() {
            let (low, high) = if unbound > before {
                (before, unbound)
            } else {
                (unbound, before)
            };
            let size = before.max(-before) + unbound.max(-unbound);
            let place = model.plane().max().max(-model.plane().bottom());
            let rounding = number(64.0) * T::EPSILON * (size + place);
            assert!(
                low - rounding <= found && found <= high + rounding,
                "{low} {found} {high}"
            );
        }
    }
}

#[test]
fn hostile_heat_only_holds_the_temperature_back() {
    for seed in 0..600 {
        let mut rng = rng(seed);
        let k = levels(&mut rng, 20);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let constants = Constants::random(&mut rng, &plane);
        if seed % 2 == 0 {
            let case: common::Owned<f64> = build(plane, Operator::Kp, &weights);
            hostile(&mut rng, case, &constants, (|v| v, -120.0));
        } else {
            let case: common::Owned<f32> = build_f32(&plane, Operator::Mkp, &weights);
            hostile(&mut rng, case, &constants, (|v| v as f32, -12.0));
        }
    }
}
