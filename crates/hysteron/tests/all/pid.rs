//! The PID controller against exact solutions, its limits, and readings that go and come.

use hysteron::control::{Gains, Pid};

const FREE: (f64, f64) = (-1e9, 1e9);

fn gains(gain: f64, integral_s: f64, derivative_s: f64) -> Gains {
    Gains {
        gain,
        integral_s,
        derivative_s,
    }
}

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
    // With integral_s = τ the loop is y' = (r − y) k gain/τ. What the sampling adds goes with its
    // interval.
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
fn beside_a_feedforward_only_the_integral_outlives_the_readings() {
    let limits = (-100.0, 100.0);
    let at_work = || {
        let mut pid = Pid::new(gains(2.0, 5.0, 0.5));
        let errors = (0..200).map(|n| f64::from(n % 7) - 2.5);
        let drives = errors.map(|error| pid.step(error, 0.1, 20.0, limits, (false, false)));
        let drive = drives.last().unwrap();
        (pid, drive)
    };
    // Without an error and a derivative there is the integral alone.
    let (mut pid, before) = at_work();
    pid.hold(20.0, limits);
    let integral = pid.step(0.0, 0.1, 20.0, limits, (false, false)) - 20.0;
    let moment = before - 20.0 - integral;
    assert!(moment.abs() > 1.0, "{moment}");
    let (mut pid, _) = at_work();
    for n in 1..200 {
        let bias = f64::from(n % 3);
        let drive = pid.relax(0.1, bias, limits);
        let expected = bias + integral + moment * (1.0_f64 + 0.1 / 5.0).powi(-n);
        // Rounding of two hundred steps.
        assert!((drive - expected).abs() < 1e-11, "{n}: {drive} {expected}");
    }
    // A feedforward that asks for a limit: all is held.
    let (mut pid, _) = at_work();
    let held = pid.hold(20.0, limits);
    (0..99).for_each(|_| _ = pid.relax(0.1, 100.0, limits));
    assert_eq!(pid.hold(20.0, limits), held);
    // Without an integral nothing is a memory, and all is held.
    let mut pid = Pid::new(gains(2.0, 0.0, 0.0));
    let drive = pid.step(1.5, 0.1, 20.0, limits, (false, false));
    let later = (0..9).map(|_| pid.relax(0.1, 20.0, limits)).last();
    assert_eq!(later, Some(drive));
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
