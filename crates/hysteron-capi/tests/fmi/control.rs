//! The block of a controller gives the drives of the library's, bit for bit.

use crate::api::*;
use crate::staged::every_stage;
use hysteron::control::{Compensator, Controller, Gains, Reading, Reference, Safety, Scheme};
use hysteron::{Delay, Direction, Model, Operator, Plane, Policy, Sample, Sign};
use hysteron_export::Fmi;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::ptr::null_mut;

const DT: f64 = 0.0625;

fn plain() -> Model {
    let plane = Plane::new(0.2, 1.0, 3).unwrap();
    let weights = vec![1.0, 2.0, 1.0, 0.5, 0.25, 1.0];
    Model::new(Operator::Mkp, plane, weights, 1.0, Sign::Negative).unwrap()
}

fn models() -> [Model; 4] {
    let delay = |samples| Delay::new(samples, DT).unwrap();
    let staged = every_stage().at_load(70.0).unwrap();
    [
        plain(),
        plain().with_delay(delay(3)),
        staged.clone(),
        staged.with_delay(delay(5)),
    ]
}

fn scheme(random: &mut StdRng, model: &Model) -> Scheme {
    let (off, on) = model.output_range();
    let some = |random: &mut StdRng, low: f64, high: f64| {
        let value = random.random_range(low..high);
        random.random_bool(0.5).then_some(value)
    };
    let gains = Gains {
        gain: random.random_range(0.01..1.0) / (on - off),
        integral_s: some(random, 0.1, 2.0).unwrap_or(0.0),
        derivative_s: some(random, 0.01, 0.2).unwrap_or(0.0),
    };
    Scheme {
        tolerance: model.usual_tolerance(),
        pid: random.random_bool(0.8).then_some(gains),
        slew: some(random, 0.2, 5.0),
        gate: some(random, 0.001, 0.1).map(|share| share * (on - off).abs()),
        filter_s: some(random, 0.01, 1.0).unwrap_or(0.0),
        safety: Safety {
            lost_s: some(random, 0.2, 0.5),
            stuck_s: some(random, 0.2, 0.5),
        },
        ..Scheme::new(DT, (0.0, 1.0))
    }
}

/// References that wander and jump, readings that are lost or stand still, manual samples, saved
/// states. Returns the flags that were seen.
fn run(model: &Model, scheme: &Scheme, fmi: Fmi, random: &mut StdRng) -> i32 {
    let fmu = Unpacked::controller(model, scheme, fmi);
    let instance = fmu.started();
    let mut controller = Controller::new(Scheme {
        compensator: Some(Compensator::fixed(model).unwrap()),
        policy: Policy::Anticipate, // a heading of none is *hold*
        ..scheme.clone()
    })
    .unwrap();
    assert_eq!(
        instance.outputs(),
        (0f64.to_bits(), 0),
        "at rest before the first sample"
    );
    let due = controller.due();
    let (off, on) = model.output_range();
    let (low, width) = (off.min(on), (on - off).abs());
    let (mut plant, mut drive, mut shown, mut seen) = (model.start(), 0.0, off, 0);
    let (mut reference, mut mode, mut manual, mut was_manual) = (off, 0, false, false);
    for n in 0..600 {
        if random.random_bool(0.05) {
            reference = low + width * random.random_range(-0.1..1.1);
            mode = random.random_range(0..4);
            manual = random.random_bool(0.2);
        }
        let sample = Sample {
            input: drive,
            dt: Some(DT),
            load: None,
        };
        let output = model.step(&mut plant, sample).unwrap().output;
        shown = match mode {
            0 if random.random_bool(0.5) => f64::NAN,
            1 => shown,
            2 => f64::NAN,
            _ => 0.9 * output + 0.002 * width * random.random_range(-1.0..1.0),
        };
        if random.random_bool(0.03) {
            shown += width; // a spike
        }
        let heading = [0, 1, -1][random.random_range(0..3)];
        let ahead = [0.0, 0.02 * width][random.random_range(0..2)];
        let by_hand = random.random_range(0.0..1.0);
        if n % 50 == 20 {
            // What happens in between is forgotten.
            let mut saved = null_mut();
            assert_eq!(instance.save(&mut saved), 0);
            let astray = (
                instance.set(MEASURED, 3.0),
                instance.step(DT * f64::from(n), 0.3),
            );
            assert_eq!(astray, (0, 0));
            assert_eq!(
                (instance.restore(saved), instance.forget(&mut saved)),
                (0, 0)
            );
        }
        for (variable, value) in [
            (SIGNAL, reference),
            (MEASURED, shown),
            (AHEAD, ahead),
            (MANUAL_DRIVE, by_hand),
        ] {
            assert_eq!(instance.set(variable, value), 0);
        }
        let codes = (
            instance.set_integer(HEADING, heading),
            instance.set_boolean(MANUAL, manual),
        );
        assert_eq!(codes, (0, 0));
        assert_eq!(instance.step(DT * f64::from(n), DT), 0);
        let reading = Reading {
            output: shown,
            input: None,
        };
        let action = match manual {
            true => controller.step_command(by_hand, reading).unwrap(),
            false => {
                if was_manual {
                    controller.go_on_from(drive).unwrap();
                }
                let target = Reference {
                    output: reference,
                    heading: match heading {
                        1 => Some(Direction::Rising),
                        -1 => Some(Direction::Falling),
                        _ => None,
                    },
                };
                let next = vec![reference + ahead; due];
                controller.step_ahead(target, &next, reading).unwrap()
            }
        };
        was_manual = manual;
        drive = action.drive;
        let status = action.status;
        let flags = [
            status.saturated,
            status.out_of_reach,
            status.sensor_fault,
            status.stuck,
            status.safe,
            false,
            status.rejected,
        ];
        let flags: i32 = (0..7).map(|bit| i32::from(flags[bit]) << bit).sum();
        assert_eq!(instance.outputs(), (drive.to_bits(), flags), "sample {n}");
        seen |= flags;
    }
    instance.free();
    seen
}

#[test]
#[cfg_attr(miri, ignore = "it is about digits, and takes Miri hours")]
fn the_drives_are_those_of_the_library() {
    let mut random = StdRng::seed_from_u64(11);
    let mut seen = 0;
    for round in 0..6 {
        for model in models() {
            let scheme = scheme(&mut random, &model);
            let fmi = [Fmi::V2, Fmi::V3][round % 2];
            seen |= run(&model, &scheme, fmi, &mut random);
        }
    }
    assert_eq!(seen, 95, "a flag that was never seen");
}

#[test]
fn what_no_loop_can_run_with_is_an_error_of_the_step() {
    let scheme = Scheme {
        pid: Some(Gains {
            gain: 0.1,
            integral_s: 0.0,
            derivative_s: 0.0,
        }),
        ..Scheme::new(DT, (0.0, 1.0))
    };
    for fmi in [Fmi::V2, Fmi::V3] {
        let fmu = Unpacked::controller(&plain(), &scheme, fmi);
        let instance = fmu.started();
        assert_eq!(instance.get(GAIN), Ok(0.1));
        for (variable, wrong, right) in [
            (GAIN, f64::NAN, 0.2),
            (GAIN + 1, -1.0, 0.5),
            (GAIN + 3, 2.0, 0.1), // the lowest drive above the highest
            (SIGNAL, f64::INFINITY, 2.0),
            (AHEAD, f64::NAN, 0.0),
            (MANUAL_DRIVE, f64::NAN, 0.0),
        ] {
            let before = instance.outputs();
            assert_eq!(instance.set(variable, wrong), 0);
            assert!(instance.step(0.0, DT) != 0, "{variable}");
            assert_eq!(instance.outputs(), before);
            assert_eq!(instance.set(variable, right), 0);
        }
        // A missing reading is none.
        assert_eq!(instance.set(MEASURED, f64::NAN), 0);
        assert_eq!(instance.step(0.0, DT), 0);
        assert_eq!(instance.outputs().1 & 4, 4);
        assert!(
            instance.set(GAIN + 10, 1.0) != 0,
            "there is no such variable"
        );
        // Its states have no bytes.
        let mut saved = null_mut();
        assert_eq!(instance.save(&mut saved), 0);
        assert!(instance.deserialise(&[0; 64], &mut saved) != 0);
        instance.free();
    }
    let mut loaded = scheme.clone();
    let target = std::path::Path::new("no.fmu");
    let options = hysteron_export::FmuOptions::default();
    let refused = |model: &Model, scheme: &Scheme| {
        hysteron_export::fmu_controlled(model, scheme, &options, target).is_err()
    };
    assert!(refused(&every_stage(), &loaded));
    loaded.gate = Some(0.0);
    assert!(refused(&plain(), &loaded));
    loaded.gate = None;
    loaded.delay = Some(7);
    assert!(refused(&plain(), &loaded));
}
