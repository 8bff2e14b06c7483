//! Controllers: PID against exact solutions, limits, loops on both simulated plants, and what is refused.
#![allow(clippy::unwrap_used, clippy::panic)]

mod loops;

use hysteron::control::{
    Action, Compensator, Controller, Device, Gains, InnerLoop, Pid, Reading, Rest, Scheme, Target,
};
use hysteron::track::{Comparison, Kind, track};
use hysteron::{Error, Model, Operator, Plane, Sign};
use loops::{Known, RELAYS, RELAYS_SINE, SPRING, SPRING_SINE, scenario};

const FREE: (f64, f64) = (-1e9, 1e9);

fn gains(gain: f64, integral_s: f64, derivative_s: f64) -> Gains {
    Gains {
        gain,
        integral_s,
        derivative_s,
    }
}

// ---------------------------------------------------------------- PID

/// `τ y' + y = k u`, exact for a drive that is held.
struct FirstOrder {
    lag_s: f64,
    gain: f64,
    y: f64,
}

impl FirstOrder {
    fn hold(&mut self, u: f64, dt: f64) {
        let kept = (-dt / self.lag_s).exp();
        self.y = kept * self.y + (1.0 - kept) * self.gain * u;
    }
}

#[test]
fn the_proportional_loop_is_the_exact_one() {
    let (k, lag_s, dt, gain) = (2.0, 3.0, 0.1, 4.0);
    let mut plant = FirstOrder {
        lag_s,
        gain: k,
        y: 0.0,
    };
    let mut pid = Pid::new(gains(gain, 0.0, 0.0));
    let kept = (-dt / lag_s).exp();
    let end = k * gain / (1.0 + k * gain);
    for n in 0..200 {
        let exact = end * (1.0 - (kept - (1.0 - kept) * k * gain).powi(n));
        assert!((plant.y - exact).abs() < 1e-12);
        let u = pid.step(1.0 - plant.y, dt, 0.0, FREE, (false, false));
        plant.hold(u, dt);
    }
}

#[test]
fn the_loop_whose_integral_cancels_the_lag_is_of_first_order() {
    // With integral_s = τ the loop is y' = (r − y) k gain/τ. What the sampling adds goes with its interval.
    let worst = |dt: f64| {
        let mut plant = FirstOrder {
            lag_s: 3.0,
            gain: 2.0,
            y: 0.0,
        };
        let mut pid = Pid::new(gains(1.5, 3.0, 0.0));
        let mut worst = 0.0_f64;
        for n in 0..(6.0 / dt) as i32 {
            let exact = 1.0 - (-f64::from(n) * dt).exp();
            worst = worst.max((plant.y - exact).abs());
            let u = pid.step(1.0 - plant.y, dt, 0.0, FREE, (false, false));
            plant.hold(u, dt);
        }
        worst
    };
    let (coarse, fine) = (worst(0.02), worst(0.002));
    assert!(
        coarse < 0.02 && (0.08..0.12).contains(&(fine / coarse)),
        "{coarse} {fine}"
    );
}

#[test]
fn after_minutes_at_the_limit_it_is_back_at_once() {
    // Two minutes of a target twice as high as the limit allows, then back.
    let (dt, limits) = (0.1, (0.0, 1.0));
    let run = |mut control: Box<dyn FnMut(f64) -> f64>| {
        let mut plant = FirstOrder {
            lag_s: 3.0,
            gain: 1.0,
            y: 0.0,
        };
        let (mut overshoot, mut settled) = (0.0_f64, 0.0);
        for n in 0..3000 {
            let time = f64::from(n) * dt;
            let target = if time < 120.0 { 2.0 } else { 0.5 };
            plant.hold(control(target - plant.y).clamp(limits.0, limits.1), dt);
            if time >= 120.0 && (plant.y - 0.5).abs() > 0.01 {
                settled = time - 120.0;
            }
            if time >= 121.0 {
                overshoot = overshoot.max(0.5 - plant.y);
            }
        }
        (settled, overshoot)
    };
    let (gain, integral_s) = (2.0, 2.0);
    let mut pid = Pid::new(gains(gain, integral_s, 0.0));
    let (settled, overshoot) = run(Box::new(move |e| {
        pid.step(e, dt, 0.0, limits, (false, false))
    }));
    let mut integral = 0.0;
    let (wound, _) = run(Box::new(move |e| {
        integral += gain * e * dt / integral_s;
        gain * e + integral
    }));
    println!(
        "settled in {settled:.1} s, overshoot {overshoot:.3}; without anti-windup in {wound:.1} s"
    );
    // The plant alone takes 3 ln(50) = 12 s to 1 % of its way.
    assert!(settled < 12.0 && wound > 60.0);
}

#[test]
fn a_limit_further_on_stops_the_integral_too() {
    let mut pid = Pid::new(gains(1.0, 1.0, 0.0));
    for _ in 0..1000 {
        pid.step(1.0, 0.1, 0.0, FREE, (false, true));
    }
    // Nothing was integrated upwards; downwards it goes.
    assert_eq!(pid.step(0.0, 0.1, 0.0, FREE, (false, true)), 0.0);
    assert!(pid.step(-1.0, 0.1, 0.0, FREE, (false, true)) < -1.0);
}

#[test]
fn the_derivative_of_a_ramp_comes_with_its_filter() {
    let (dt, derivative_s, rate) = (0.01, 0.4, 3.0);
    let mut pid = Pid::new(gains(2.0, 0.0, derivative_s));
    let kept: f64 = 1.0 - dt / (dt + derivative_s / 8.0);
    for n in 0..300 {
        let error = rate * f64::from(n) * dt;
        let exact = 2.0 * (error + derivative_s * rate * (1.0 - kept.powi(n)));
        assert!((pid.step(error, dt, 0.0, FREE, (false, false)) - exact).abs() < 1e-9);
    }
}

#[test]
fn nothing_jumps_when_the_reading_goes_and_comes() {
    let mut pid = Pid::new(gains(2.0, 5.0, 0.5));
    let limits = (0.0, 100.0);
    let before = (0..200)
        .map(|_| pid.step(0.3, 0.1, 20.0, limits, (false, false)))
        .last();
    let held: Vec<f64> = (0..50).map(|_| pid.hold(20.0, limits)).collect();
    assert!(held.iter().all(|out| Some(*out) == before));
    // The feedforward goes on meanwhile.
    assert!((pid.hold(25.0, limits) - held[0] - 5.0).abs() < 1e-12);
    let after = pid.step(0.3, 0.1, 20.0, limits, (false, false));
    // One sample of the integral, no derivative of the time in between.
    assert!((after - held[0] - 2.0 * 0.3 * 0.1 / 5.0).abs() < 1e-9);
}

#[test]
fn no_number_makes_it_leave_its_limits() {
    let wild = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        f64::MIN,
        1e-300,
        0.0,
        1.0,
    ];
    let mut pid = Pid::new(gains(3.0, 0.1, 0.1));
    for (n, error) in wild.iter().cycle().take(500).enumerate() {
        let bias = wild[(n * 7 + n / 8) % wild.len()];
        let out = pid.step(*error, 0.1, bias, (-2.0, 5.0), (n % 3 == 0, n % 5 == 0));
        assert!((-2.0..=5.0).contains(&out), "{error} {bias}: {out}");
        assert!((-2.0..=5.0).contains(&pid.hold(bias, (-2.0, 5.0))));
    }
    // And it has forgotten all of it once the integral had its time.
    let mut plant = FirstOrder {
        lag_s: 1.0,
        gain: 1.0,
        y: 0.0,
    };
    for _ in 0..1000 {
        plant.hold(
            pid.step(1.0 - plant.y, 0.01, 0.0, (-2.0, 5.0), (false, false)),
            0.01,
        );
    }
    assert!((plant.y - 1.0).abs() < 0.01);
}

// ---------------------------------------------------------------- controller

fn plain() -> Scheme {
    Scheme {
        interval_s: 0.1,
        compensator: None,
        rest: Rest::Hold,
        tolerance: 0.0,
        pid: Some(gains(1.0, 1.0, 0.0)),
        bias: 0.0,
        commands: (0.0, 10.0),
        drives: (0.0, 10.0),
        inner: None,
        filter_s: 0.0,
        stuck_s: None,
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

fn at(output: f64) -> Target {
    Target {
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
        Compensator::fixed(model.unwrap()),
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
        compensator: Some(Compensator::fixed(known.model.clone()).unwrap()),
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
            compensator: Some(Compensator::fixed(model.clone()).unwrap()),
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

// ---------------------------------------------------------------- on the simulated plants

fn rmse(found: &Comparison, kind: Kind, window: usize) -> f64 {
    let place = found.controllers.iter().position(|k| *k == kind).unwrap();
    found.scores[place][0][window].rmse
}

fn compare(base: &str, reference: &str, disturbance: &str) {
    let kinds = r#"controllers = ["pid", "inverse-pid", "adaptive-pid"]"#;
    let found = track(
        &scenario(&[base, kinds, reference, disturbance]),
        &|_, _| (),
    )
    .unwrap();
    let last = found.windows.len() - 1;
    for (w, window) in found.windows.iter().enumerate() {
        let all = found.controllers.iter().map(|kind| rmse(&found, *kind, w));
        println!("{}: {:.3?}", window.name, all.collect::<Vec<_>>());
    }
    assert!(rmse(&found, Kind::InversePid, 0) < 0.7 * rmse(&found, Kind::Pid, 0));
    assert!(rmse(&found, Kind::AdaptivePid, last) < 0.8 * rmse(&found, Kind::InversePid, last));
}

#[test]
fn inverse_beats_pid_and_adaptation_the_fixed_inverse_on_the_spring() {
    let step = "[[disturbance]]\nat_s = 920\nload_n = 10.0";
    compare(SPRING, SPRING_SINE, step);
}

#[test]
fn inverse_beats_pid_and_adaptation_the_fixed_inverse_on_the_relays() {
    let step = "[[disturbance]]\nat_s = 25\nload_n = 10.0";
    compare(RELAYS, RELAYS_SINE, step);
}

#[test]
fn anticipating_shortens_the_lag_after_a_rest() {
    let rests = r#"
[[reference]]
kind = "trapezoid"
low = 3.0
high = 7.0
ramp_s = 60
rest_s = 60
"#;
    let kinds = r#"controllers = ["inverse-pid", "inverse-pid-anticipate"]"#;
    let found = track(&scenario(&[SPRING, kinds, rests]), &|_, _| ()).unwrap();
    for (w, window) in found.windows.iter().enumerate() {
        let [hold, anticipate] = [0, 1].map(|k| found.scores[k][0][w].lag_s);
        println!(
            "{}: hold {hold:.1} s, anticipate {anticipate:.1} s",
            window.name
        );
        assert!(anticipate < 0.8 * hold);
    }
}
