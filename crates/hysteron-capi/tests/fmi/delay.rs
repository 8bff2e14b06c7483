//! A model with a dead time: the input acts so many communication steps later.

use crate::api::*;
use crate::staged::every_stage;
use hysteron::{Delay, Model, Operator, Plane, Sample, Sign, Surroundings};
use hysteron_export::Fmi;
use std::ptr::null_mut;

fn plain() -> Model {
    let plane = Plane::new(0.2, 1.0, 3).unwrap();
    let weights = vec![1.0, 2.0, 1.0, 0.5, 0.25, 1.0];
    Model::new(Operator::Mkp, plane, weights, 1.0, Sign::Negative).unwrap()
}

#[test]
#[cfg_attr(miri, ignore = "it is about digits, and takes Miri hours")]
fn inputs_act_after_the_dead_time() {
    let loaded = every_stage().at_load(70.0).unwrap();
    for (model, samples, fmi) in [
        (plain(), 1, Fmi::V2),
        (plain(), 6, Fmi::V3),
        (loaded.clone(), 3, Fmi::V3),
        (loaded, 400, Fmi::V2),
    ] {
        let model = model.with_delay(Delay::new(samples, 0.125).unwrap());
        let fmu = Unpacked::new(&model, false, fmi);
        let input: Vec<f64> = (0..90).map(|n| f64::from(n * n % 17) / 16.0).collect();
        for dt in [0.125, 0.25] {
            let time: Vec<f64> = (0..90).map(|n| dt * f64::from(n)).collect();
            let around = Surroundings {
                time: Some(&time),
                load: None,
                rest: None,
            };
            let acting = model.acting(&input, around).unwrap();
            let (mut state, mut instance) = (model.start(), fmu.instance());
            assert_eq!(instance.enter(0.0), 0);
            for (n, input) in input.iter().enumerate() {
                assert_eq!(instance.set(SIGNAL, *input), 0);
                match n {
                    0 => assert_eq!(instance.exit(), 0),
                    _ => assert_eq!(instance.step(time[n - 1], dt), 0),
                }
                let step = if n == 0 { 0.0 } else { dt };
                let sample = Sample {
                    input: acting[n],
                    dt: Some(step),
                    load: None,
                };
                let expected = model.step(&mut state, sample).unwrap().output;
                assert_eq!(
                    instance.outputs().0,
                    expected.to_bits(),
                    "{samples} {dt} {n}"
                );
                if n % 7 == 4 {
                    // The inputs under way are saved with the state.
                    let mut saved = null_mut();
                    assert_eq!(instance.save(&mut saved), 0);
                    let bytes = instance.serialise(saved);
                    let other = fmu.instance();
                    let mut there = null_mut();
                    assert_eq!(other.deserialise(&bytes, &mut there), 0);
                    assert_eq!(other.restore(there), 0);
                    instance.free();
                    instance = other;
                }
            }
            instance.free();
        }
    }
}
