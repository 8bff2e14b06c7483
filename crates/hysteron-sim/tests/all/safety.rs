//! What keeps a wire whole: no bump, no kick, no spike, no drive to a limit by a broken sensor.

use hysteron::control::{Compensator, Controller, Gains, Reading, Reference, Safety, Scheme};
use hysteron::{AdaptOptions, Learner, Model, Operator, Plane, Policy, Sign};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const DT: f64 = 0.05;

fn model(weight: f64) -> Model {
    let plane = Plane::new(1.0, 10.0, 6).unwrap();
    Model::new(Operator::Mkp, plane, vec![weight; 21], 0.5, Sign::Positive).unwrap()
}

/// PID, inverse, both, and a learner in the shadow of the model.
fn schemes() -> Vec<Scheme> {
    let pid = |integral_s, derivative_s| {
        Some(Gains {
            gain: 0.4,
            integral_s,
            derivative_s,
        })
    };
    let options = AdaptOptions {
        learner: Learner::LeastSquares,
        ..AdaptOptions::default()
    };
    let learner = Compensator::adaptive(options.adaptive(&model(0.3)).unwrap());
    let shadow = Compensator::shadowed(&model(0.3), learner).unwrap();
    let fixed = Compensator::fixed(&model(0.3)).unwrap();
    let each = [
        (None, pid(0.5, 0.1)),
        (None, pid(0.0, 0.1)),
        (Some(fixed.clone()), None),
        (Some(fixed.clone()), pid(0.5, 0.0)),
        (Some(fixed), pid(0.0, 0.0)),
        (Some(shadow.clone()), pid(0.5, 0.1)),
        (Some(shadow), None),
    ];
    let scheme = |(compensator, pid)| Scheme {
        compensator,
        pid,
        gate: Some(0.1),
        ..Scheme::new(DT, (0.0, 10.0))
    };
    each.into_iter().map(scheme).collect()
}

fn at(output: f64) -> Reference {
    Reference {
        output,
        heading: None,
    }
}

fn read(output: f64) -> Reading {
    Reading {
        output,
        input: None,
    }
}

/// Noise between ±0.5 from a fixed sequence.
fn noise(n: usize) -> f64 {
    let turns = (n as f64 * 12.9898).sin() * 43758.5453;
    turns - turns.floor() - 0.5
}

/// The drives of a loop around a lag of 0.3 s behind a model, until a run would be given up; `spoil`
/// changes the readings.
fn drives(
    scheme: Scheme,
    from: f64,
    reference: impl Fn(usize) -> f64,
    mut spoil: impl FnMut(usize, f64) -> f64,
) -> Vec<f64> {
    let (plant, mut state) = (model(0.33), model(0.33).start());
    let (mut controller, mut output, mut drive) = (Controller::new(scheme).unwrap(), 0.5, from);
    controller.go_on_from(from).unwrap();
    let (mut found, mut lost_s) = (Vec::new(), 0.0);
    for n in 0..300 {
        let still = plant.step(&mut state, drive).unwrap().output;
        output += DT / 0.3 * (still - output);
        let reading = read(spoil(n, output + 0.01 * noise(n)));
        let action = controller.step_after(DT, at(reference(n)), &[], reading);
        drive = action.unwrap().drive;
        found.push(drive);
        lost_s = if reading.output.is_nan() {
            lost_s + DT
        } else {
            0.0
        };
        // A run is given up then, and its drive goes safe.
        if lost_s >= 0.5 || controller.stuck_s().is_some_and(|time| time >= 1.0) {
            break;
        }
    }
    found
}

fn sine(n: usize) -> f64 {
    3.5 - 2.5 * (0.05 * n as f64).cos()
}

#[test]
fn every_loop_goes_on_from_where_the_drive_is() {
    for scheme in schemes() {
        for from in [0.0, 0.7, 5.0, 9.9] {
            for reference in [0.6, 3.0, 6.0] {
                let begun = drives(scheme.clone(), from, |_| reference, |_, y| y)[0];
                // One sample of the integral, and a tenth of what fades.
                assert!(
                    (begun - from).abs() < 0.6,
                    "{:?} {from} {reference}: {begun}",
                    scheme.pid
                );
            }
        }
    }
}

#[test]
fn a_step_of_the_reference_gives_no_derivative_kick() {
    let kick = |derivative_s: f64| {
        let scheme = Scheme {
            pid: Some(Gains {
                gain: 0.2,
                integral_s: 1.0,
                derivative_s,
            }),
            ..Scheme::new(DT, (0.0, 10.0))
        };
        let step = |n: usize| if n < 200 { 2.0 } else { 5.0 };
        let drives = drives(scheme, 0.0, step, |_, y| y);
        drives[200] - drives[199]
    };
    // Of the noise alone: 0.01 · 0.2 · 0.2 s / (0.05 + 0.025) s.
    assert!(
        (kick(0.2) - kick(0.0)).abs() < 0.02,
        "{} {}",
        kick(0.2),
        kick(0.0)
    );
}

#[test]
fn a_spike_moves_no_loop() {
    for scheme in schemes() {
        let plain = drives(scheme.clone(), 0.0, sine, |_, y| y);
        for size in [-1e9, -1.0, 1.0, 1e9] {
            for at in [40, 90, 150, 217] {
                let spoilt = |n, y| if n == at { y + size } else { y };
                let spiked = drives(scheme.clone(), 0.0, sine, spoilt);
                // The loop itself may do what it likes with the rest of it later.
                let pairs = plain.iter().zip(&spiked).skip(at).take(4);
                let moved = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(moved < 0.4, "{:?} {size} at {at}: {moved}", scheme.pid);
            }
        }
    }
}

#[test]
fn a_stuck_or_lost_output_never_drives_to_a_limit() {
    for scheme in schemes() {
        for at in [60, 90, 120] {
            let plain = drives(scheme.clone(), 0.0, sine, |_, y| y);
            let most = plain.iter().copied().fold(0.0, f64::max);
            for lost in [false, true] {
                let mut last = f64::NAN;
                let broken = |n, y| {
                    if n < at {
                        last = y;
                    }
                    if n >= at && lost { f64::NAN } else { last }
                };
                let found = drives(scheme.clone(), 0.0, sine, broken);
                let largest = found[at..].iter().copied().fold(0.0, f64::max);
                // Half of the way from where it stood is left.
                let left = most + 0.62 * (10.0 - most);
                assert!(largest < left, "{:?} at {at}: {largest} {most}", scheme.pid);
            }
        }
    }
}

#[test]
fn the_drive_keeps_to_its_slew_and_the_integral_does_not_wind_up() {
    for scheme in schemes() {
        let slew = 2.0;
        let slow = Scheme {
            slew: Some(slew),
            ..scheme
        };
        let square = |n: usize| if (n / 60).is_multiple_of(2) { 1.0 } else { 5.0 };
        let drives = drives(slow, 0.0, square, |_, y| y);
        for pair in drives.windows(2) {
            assert!((pair[1] - pair[0]).abs() <= slew * DT + 1e-12);
        }
    }
}

#[test]
fn intervals_are_those_that_were_measured() {
    // Two samples of half the time come to one: the integral of a constant error.
    let scheme = Scheme {
        pid: Some(Gains {
            gain: 0.1,
            integral_s: 1.0,
            derivative_s: 0.0,
        }),
        policy: Policy::Hold,
        ..Scheme::new(DT, (0.0, 10.0))
    };
    let run = |times: &[f64]| {
        let mut controller = Controller::new(scheme.clone()).unwrap();
        let step = |dt: &f64| {
            controller
                .step_after(*dt, at(3.0), &[], read(1.0))
                .unwrap()
                .drive
        };
        times.iter().map(step).last().unwrap()
    };
    assert!((run(&[0.1, 0.1]) - run(&[0.1, 0.04, 0.06])).abs() < 1e-12);
    let mut controller = Controller::new(scheme.clone()).unwrap();
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            controller
                .step_after(wrong, at(3.0), &[], read(1.0))
                .is_err()
        );
    }
}

#[test]
fn a_learner_is_used_only_while_it_predicts_better() {
    let options = AdaptOptions {
        learner: Learner::LeastSquares,
        ..AdaptOptions::default()
    };
    for (weight, learns) in [(0.3, false), (0.5, true)] {
        let learner = Compensator::adaptive(options.adaptive(&model(0.3)).unwrap());
        let shadow = Compensator::shadowed(&model(0.3), learner).unwrap();
        let scheme = Scheme {
            compensator: Some(shadow),
            ..Scheme::new(DT, (0.0, 10.0))
        };
        let (plant, mut state) = (model(weight), model(weight).start());
        let mut controller = Controller::new(scheme).unwrap();
        let mut drive = 0.0;
        for n in 0..2000 {
            let output = plant.step(&mut state, drive).unwrap().output + 1e-3 * noise(n);
            drive = controller
                .step_after(DT, at(sine(n)), &[], read(output))
                .unwrap()
                .drive;
        }
        let used = controller.compensator().unwrap().trusts_learner();
        assert_eq!(used, learns, "{weight}");
    }
}

/// How a loop with inverse and PID goes on around a plant for 2000 samples: the sample at which it is
/// given up, and those with full drive until then. `plant` gives the output for a drive.
fn given_up(
    reference: impl Fn(usize) -> f64,
    mut plant: impl FnMut(usize, f64) -> f64,
) -> (Option<usize>, usize) {
    let pid = schemes().remove(5).pid;
    let scheme = Scheme {
        compensator: Some(Compensator::fixed(&model(0.3)).unwrap()),
        pid,
        safety: Safety {
            lost_s: None,
            stuck_s: Some(1.0),
        },
        ..Scheme::new(DT, (0.0, 10.0))
    };
    let (mut controller, mut drive, mut full) = (Controller::new(scheme).unwrap(), 0.0, 0);
    for n in 0..2000 {
        let reading = read(plant(n, drive) + 0.02 * noise(n));
        let action = controller.step_after(DT, at(reference(n)), &[], reading);
        let action = action.unwrap();
        if action.status.safe {
            return (Some(n), full);
        }
        drive = action.drive;
        full += usize::from(drive > 9.9);
    }
    (None, full)
}

/// The model's outputs go from 0.5 to 6.8: noise of a third of a percent.
#[test]
fn a_jam_with_noise_is_given_up_before_full_drive_lasts() {
    for at in [30, 60, 100, 140, 500] {
        let (plant, mut state) = (model(0.3), model(0.3).start());
        let mut output = 0.5;
        let (ended, full) = given_up(sine, |n, drive| {
            let still = plant.step(&mut state, drive).unwrap().output;
            if n < at {
                output += DT / 0.3 * (still - output);
            }
            output
        });
        // A second of proof, and what the loop takes to wind up: the reference's period is 6 s.
        assert!(ended.is_some_and(|n| n < at + 140), "{at}: {ended:?}");
        assert!(full < 40, "{at}: {full}");
    }
}

/// Weaker and stronger, slower, colder and warmer than the model, and references beyond its reach.
#[test]
fn an_honest_plant_is_never_given_up() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let mut full = 0;
    for case in 0..600 {
        let plant = model(0.3 * rng.random_range(0.2..1.7));
        let (lag, colder) = (rng.random_range(0.05..1.5), rng.random_range(-2.0..2.0));
        let (mut state, mut output) = (plant.start(), 0.5);
        let (middle, swing) = (rng.random_range(1.0..6.0), rng.random_range(0.0..3.0));
        let (speed, jumps) = (rng.random_range(0.001..0.1), rng.random_bool(0.3));
        let reference = |n: usize| {
            let wave = (speed * n as f64).sin();
            middle + swing * if jumps { wave.signum() } else { wave }
        };
        let (ended, most) = given_up(reference, |_, drive| {
            let still = plant.step(&mut state, drive - colder).unwrap().output;
            output += DT / lag * (still - output);
            output
        });
        full += usize::from(most > 100);
        assert_eq!(ended, None, "{case}: lag {lag}, colder {colder}");
    }
    // Many are driven as far as they can be.
    assert!(full > 100, "{full}");
}
