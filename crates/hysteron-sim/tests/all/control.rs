//! Controllers: what they refuse, sensors that fail, targets out of reach, a device of one's own.

use crate::loops::Known;
use hysteron::control::{
    Action, Compensator, Controller, Course, Device, Disturbance, Gains, InnerLoop, Reading,
    Reference, Scheme, SimulatedPlant, run,
};
use hysteron::{Dynamics, Error, Fit, Model, Operator, Plane, Policy, Progress, Recording, Sign};
use hysteron_sim::plant::{PreisachPlant, PreisachPlantOptions, SensorOptions};
use std::collections::VecDeque;

fn gains(gain: f64, integral_s: f64, derivative_s: f64) -> Gains {
    Gains {
        gain,
        integral_s,
        derivative_s,
    }
}

fn plain() -> Scheme {
    Scheme {
        interval_s: 0.1,
        compensator: None,
        policy: Policy::Hold,
        tolerance: 0.0,
        pid: Some(gains(1.0, 1.0, 0.0)),
        bias: 0.0,
        commands: (0.0, 10.0),
        drives: (0.0, 10.0),
        inner: None,
        filter_s: 0.0,
        stuck_s: None,
        ..Scheme::new(0.1, (0.0, 10.0))
    }
}

fn heated() -> Scheme {
    Scheme {
        bias: 50.0,
        commands: (20.0, 90.0),
        drives: (0.0, 2.0),
        inner: Some(InnerLoop {
            gains: gains(0.1, 10.0, 0.0),
            square_root: true,
        }),
        stuck_s: Some(1.0),
        ..plain()
    }
}

fn at(output: f64) -> Reference {
    Reference {
        output,
        heading: None,
    }
}

#[test]
fn what_no_loop_can_run_with_is_refused() {
    let bad_gains = [
        gains(f64::NAN, 1.0, 0.0),
        gains(1.0, -1.0, 0.0),
        gains(1.0, 1.0, f64::INFINITY),
    ];
    let mut schemes: Vec<(&str, Scheme)> = vec![
        (
            "interval_s",
            Scheme {
                interval_s: 0.0,
                ..plain()
            },
        ),
        (
            "interval_s",
            Scheme {
                interval_s: f64::NAN,
                ..plain()
            },
        ),
        (
            "tolerance",
            Scheme {
                tolerance: -1.0,
                ..plain()
            },
        ),
        (
            "filter_s",
            Scheme {
                filter_s: f64::NAN,
                ..plain()
            },
        ),
        (
            "stuck_s",
            Scheme {
                stuck_s: Some(0.0),
                ..plain()
            },
        ),
        (
            "bias",
            Scheme {
                bias: f64::INFINITY,
                ..plain()
            },
        ),
        (
            "commands",
            Scheme {
                commands: (1.0, 0.0),
                ..plain()
            },
        ),
        (
            "commands",
            Scheme {
                commands: (f64::NAN, 0.0),
                ..plain()
            },
        ),
        (
            "drives",
            Scheme {
                drives: (0.0, f64::INFINITY),
                ..plain()
            },
        ),
        (
            "drives",
            Scheme {
                drives: (-1.0, 1.0),
                ..heated()
            },
        ),
    ];
    for bad in bad_gains {
        schemes.push((
            "gain",
            Scheme {
                pid: Some(bad),
                ..plain()
            },
        ));
        let inner = Some(InnerLoop {
            gains: bad,
            square_root: false,
        });
        schemes.push(("gain", Scheme { inner, ..plain() }));
    }
    for (field, scheme) in schemes {
        match Controller::new(scheme) {
            Err(error @ Error::Control(_)) => {
                assert!(error.to_string().contains(field), "{error}");
                assert_eq!(error.code(), 30);
            }
            other => panic!("{field}: {other:?}"),
        }
    }
    let mut fine = Controller::new(plain()).unwrap();
    let reading = Reading {
        output: 0.0,
        input: None,
    };
    assert!(matches!(
        fine.step(at(f64::NAN), reading),
        Err(Error::Core(_))
    ));
    assert!(matches!(
        fine.step_command(f64::INFINITY, reading),
        Err(Error::Core(_))
    ));
}

#[test]
fn a_model_without_an_inverse_is_refused() {
    let plane = Plane::new(0.0, 10.0, 2).unwrap();
    let model = Model::new(
        Operator::Mkp,
        plane,
        vec![1.0, -1.0, 1.0],
        0.0,
        Sign::Positive,
    );
    assert!(matches!(
        Compensator::fixed(&model.unwrap()),
        Err(Error::Core(_))
    ));
}

#[test]
fn without_a_temperature_it_does_not_heat_and_goes_on_as_before() {
    let mut controller = Controller::new(Scheme {
        pid: None,
        ..heated()
    })
    .unwrap();
    let mut noise = 0.0;
    let mut step = |degc: f64| {
        noise = 1e-6 - noise;
        let reading = Reading {
            output: noise,
            input: Some(degc),
        };
        controller.step(at(1.0), reading).unwrap()
    };
    // Held 2 degC below its command, which integrates.
    let before = (0..100)
        .map(|n| step(48.0 + 1e-6 * f64::from(n % 2)))
        .last()
        .unwrap();
    assert!(before.drive > 0.4 && before.drive < 2.0 && !before.status.sensor_fault);
    for n in 0..600 {
        let lost = step(f64::NAN);
        assert!(lost.status.sensor_fault);
        assert_eq!(lost.drive, if n < 9 { before.drive } else { 0.0 }, "{n}");
    }
    let after = step(48.0);
    assert!(!after.status.sensor_fault);
    // One sample of the integral on.
    assert!((after.drive.powi(2) - before.drive.powi(2) - 0.1 * 2.0 * 0.1 / 10.0).abs() < 1e-6);
}

#[test]
fn a_loop_around_the_input_needs_its_sensor() {
    let mut controller = Controller::new(heated()).unwrap();
    for n in 0..20 {
        let output = f64::from(n);
        let action = controller
            .step(
                at(50.0),
                Reading {
                    output,
                    input: None,
                },
            )
            .unwrap();
        assert!(action.status.sensor_fault);
        assert!(action.drive == 0.0);
    }
}

#[test]
fn a_thermocouple_that_sticks_stops_the_heating() {
    let mut controller = Controller::new(heated()).unwrap();
    let mut last = None;
    for n in 0..20 {
        let reading = Reading {
            output: f64::from(n),
            input: Some(30.0),
        };
        last = Some(controller.step(at(50.0), reading).unwrap());
    }
    let last = last.unwrap();
    assert!(last.status.sensor_fault && last.drive == 0.0);
}

/// Reads what was recorded, whatever is written, and keeps that.
struct Replay<'a> {
    readings: std::slice::Iter<'a, Reading>,
    drives: Vec<f64>,
}

impl Device for Replay<'_> {
    fn read(&mut self) -> Reading {
        *self.readings.next().unwrap()
    }

    fn write(&mut self, drive: f64) {
        self.drives.push(drive);
    }
}

/// The loop that anyone would write around a device.
fn drive(device: &mut impl Device, controller: &mut Controller, targets: &[f64]) -> Vec<Action> {
    let step = |target: &f64| {
        let action = controller.step(at(*target), device.read()).unwrap();
        device.write(action.drive);
        action
    };
    targets.iter().map(step).collect()
}

#[test]
fn a_replayed_device_gets_the_same_drives() {
    let known = Known::spring();
    let scheme = || Scheme {
        compensator: Some(Compensator::fixed(&known.model).unwrap()),
        ..known.scheme()
    };
    let targets = &known.scenario.references()[..600];
    let mut plant = known.plant(3);
    let mut controller = Controller::new(scheme()).unwrap();
    let (mut readings, mut drives) = (Vec::new(), Vec::new());
    for target in targets {
        let reading = plant.read();
        let action = controller.step(at(*target), reading).unwrap();
        plant.write(action.drive);
        plant.advance(0.2);
        readings.push(reading);
        drives.push(action.drive);
    }
    let mut replay = Replay {
        readings: readings.iter(),
        drives: Vec::new(),
    };
    drive(
        &mut replay,
        &mut Controller::new(scheme()).unwrap(),
        targets,
    );
    assert_eq!(replay.drives, drives);
    assert!(drives.iter().any(|drive| *drive > 0.0));
}

/// The very model as a plant, the drive being its input.
struct Itself(Model, hysteron::State, f64);

impl Device for Itself {
    fn read(&mut self) -> Reading {
        Reading {
            output: self.2,
            input: None,
        }
    }

    fn write(&mut self, drive: f64) {
        self.2 = self.0.step(&mut self.1, drive).unwrap().output;
    }
}

#[test]
fn out_of_reach_it_stays_at_the_end_and_comes_back_on_the_model() {
    let plane = Plane::new(0.0, 10.0, 8).unwrap();
    for sign in [Sign::Positive, Sign::Negative] {
        let model = Model::new(Operator::Mkp, plane, vec![0.5; 36], 1.0, sign).unwrap();
        let factor = if sign == Sign::Positive { 1.0 } else { -1.0 };
        let mut controller = Controller::new(Scheme {
            pid: None,
            compensator: Some(Compensator::fixed(&model).unwrap()),
            // From the lowest level on: the input of every operator off is below the plane's range.
            commands: (plane.bottom(), plane.max()),
            drives: (plane.bottom(), plane.max()),
            ..plain()
        })
        .unwrap();
        let wave = |n: i32| 1.0 + factor * (9.0 - 8.0 * (0.05 * f64::from(n)).cos());
        let far = |n: i32| (700..1300).contains(&n);
        let targets: Vec<f64> = (0..2000)
            .map(|n| wave(n) + if far(n) { 1e3 } else { 0.0 })
            .collect();
        let state = model.start();
        let mut plant = Itself(model, state, 1.0);
        let mut outputs = Vec::new();
        for (n, target) in (0..).zip(&targets) {
            let action = controller.step(at(*target), plant.read()).unwrap();
            plant.write(action.drive);
            outputs.push(plant.2);
            assert_eq!(action.status.out_of_reach, far(n), "{n}");
            assert!((plane.bottom()..=plane.max()).contains(&action.drive));
        }
        for n in (0..700).chain(1300..2000) {
            // The inverse is exact to rounding.
            assert!((outputs[n] - targets[n]).abs() < 1e-9, "{n}");
        }
    }
}

/// A plant that gets each drive so many samples late, as from a bus or an amplifier with a buffer.
struct Late {
    plant: Box<dyn SimulatedPlant>,
    under_way: VecDeque<f64>,
}

impl Device for Late {
    fn read(&mut self) -> Reading {
        self.plant.read()
    }
    fn write(&mut self, drive: f64) {
        self.under_way.push_back(drive);
        let arrived = self.under_way.pop_front().unwrap();
        self.plant.write(arrived);
    }
}

impl SimulatedPlant for Late {
    fn advance(&mut self, dt_s: f64) {
        self.plant.advance(dt_s);
    }
    fn truth(&self) -> Reading {
        self.plant.truth()
    }
    fn disturb(&mut self, disturbance: Disturbance) -> hysteron::Result<()> {
        self.plant.disturb(disturbance)
    }
}

/// A simulated piezo stage without a lag or noise.
fn stage() -> PreisachPlant {
    let options = PreisachPlantOptions::default();
    PreisachPlant::new(&PreisachPlantOptions {
        lag_s: 0.0,
        output_sensor: SensorOptions {
            accuracy: 0.0,
            ..options.output_sensor
        },
        ..options
    })
    .unwrap()
}

/// A row holds the input that has acted up to its reading.
fn recording_of(plant: &mut dyn SimulatedPlant, dt: f64) -> Recording {
    let (mut time, mut input, mut output) = (vec![], vec![], vec![]);
    for n in 0..6000 {
        let phase = 0.04 * f64::from(n);
        let drive = 75.0 - (75.0 - 0.011 * f64::from(n)) * phase.cos();
        plant.write(drive);
        plant.advance(dt);
        time.push(dt * f64::from(n));
        input.push(drive);
        output.push(plant.truth().output);
    }
    Recording {
        time: Some(time),
        ..Recording::new(input, output).unwrap()
    }
}

/// The inverse alone on a simulated stage whose drives come `late` samples late: aimed at the
/// sample where the drive arrives it errs least by far, and that is the default.
#[test]
fn the_inverse_aims_where_the_drive_arrives() {
    let dt = 0.01;
    for late in [0, 1, 3] {
        let plant = || Late {
            plant: Box::new(stage()),
            under_way: VecDeque::from(vec![0.0; late]),
        };
        let fit = Fit::new().levels(40).bootstrap(0).dynamics(Dynamics::Off);
        let model = fit
            .delay(late)
            .run(&recording_of(&mut plant(), dt))
            .unwrap();
        let reference: Vec<f64> = (0..1200)
            .map(|n| 45.0 - 30.0 * (0.06 * f64::from(n)).cos())
            .collect();
        let error = |delay: Option<usize>| {
            let compensator = Compensator::fixed(&model).unwrap();
            let mut controller = Controller::new(Scheme {
                compensator: Some(compensator),
                delay,
                ..Scheme::new(dt, (0.0, 150.0))
            })
            .unwrap();
            let course = Course {
                reference: &reference,
                headings: &[],
                ahead: 0,
                events: &[],
            };
            let trace = run(&mut plant(), &mut controller, &course, Progress::NONE).unwrap();
            let errors = trace.output.iter().zip(&reference).skip(300);
            crate::loops::rms(errors.map(|(y, r)| y - r))
        };
        let default = error(None);
        let aimed: Vec<f64> = (0..late + 3).map(|ahead| error(Some(ahead))).collect();
        println!("late {late}: default {default:.4}, aimed 0, 1, … ahead {aimed:.4?}");
        assert_eq!(default, aimed[late + 1]);
        for (ahead, error) in aimed.iter().enumerate().filter(|(n, _)| *n != late + 1) {
            assert!(
                10.0 * default < *error,
                "{late}, {ahead}: {default} {error}"
            );
        }
    }
}
