//! The piezo stage against its equations: hysteresis, creep, resonance, delay.

use super::*;
use hysteron_sim::plant::{BoucWenPlant, BoucWenPlantOptions};
use std::f64::consts::TAU;

fn stage(options: BoucWenPlantOptions) -> BoucWenPlant {
    BoucWenPlant::new(&options).unwrap()
}

/// The hysteresis alone: a stiff, damped stage that neither creeps nor waits.
const STILL: BoucWenPlantOptions = BoucWenPlantOptions {
    load_n: 0.0,
    limit_v: 100.0,
    alpha: 0.3,
    beta: 0.02,
    gamma: 0.01,
    creep: 0.0,
    resonance_hz: 2e4,
    damping: 0.9,
    delay_s: 0.0,
    sensor: PERFECT,
    seed: 1,
};

const VOLTAGES: [f64; 9] = [80.0, 20.0, 60.0, 35.0, 100.0, 0.0, 50.0, 45.0, 70.0];

#[test]
fn the_hysteresis_follows_its_equation() {
    for (beta, gamma) in [(0.02, 0.01), (0.02, -0.02), (0.05, 0.05), (0.03, -0.01)] {
        let mut plant = stage(BoucWenPlantOptions {
            beta,
            gamma,
            ..STILL
        });
        // Heun's method for dz/du, in steps of 1 mV.
        let (mut u, mut z) = (0.0, 0.0_f64);
        for volts in VOLTAGES {
            let exact = hold(&mut plant, volts, 0.01, 1);
            let du: f64 = 1e-3 * f64::signum(volts - u);
            // ż = α d u̇ − β |u̇| z − γ u̇ |z|, divided by u̇.
            let slope = |z: f64| 0.3 * 0.2 - beta * du.signum() * z - gamma * z.abs();
            for _ in 0..((volts - u).abs() / 1e-3).round() as usize {
                let first = slope(z);
                z += 0.5 * du * (first + slope(z + du * first));
            }
            u = volts;
            assert!(
                (exact - (0.2 * u - z)).abs() < 1e-7,
                "{exact} {}",
                0.2 * u - z
            );
        }
    }
}

#[test]
fn without_creep_and_resonance_only_the_path_counts() {
    let at_rate = |pieces: u32, time_s: f64| {
        let mut plant = stage(STILL);
        let mut from = 0.0;
        VOLTAGES.map(|to| {
            for n in 1..=pieces {
                let share = f64::from(n) / f64::from(pieces);
                plant.write(from + share * (to - from));
                plant.advance(time_s / f64::from(pieces));
            }
            from = to;
            hold(&mut plant, to, 0.01, 1)
        })
    };
    let slow = at_rate(1000, 10.0);
    for (pieces, time_s) in [(1000, 0.01), (1, 1.0), (7, 0.1)] {
        // Rounding: the hysteresis has no time in it, and the stage has come to rest.
        assert!(worst(&slow, &at_rate(pieces, time_s)) < 1e-11, "{pieces}");
    }
}

#[test]
fn the_loop_is_open_and_minor_loops_drift() {
    let mut plant = stage(STILL);
    let reached = outputs(&mut plant, &[100.0, 0.0, 50.0, 100.0, 50.0], 0.01, 1);
    let width = reached[4] - reached[2];
    let stroke = reached[3] - reached[1];
    assert!(
        (0.05..0.2).contains(&(width / stroke)),
        "{width} of {stroke}"
    );
    // A Preisach model would come back to the same output after the first minor loop.
    let minor = outputs(&mut plant, &[60.0, 50.0, 60.0, 50.0], 0.01, 1);
    assert!((minor[3] - minor[1]).abs() > 1e-3 * stroke, "{minor:?}");
}

#[test]
fn creep_is_three_lags() {
    let creep = 0.06;
    let mut plant = stage(BoucWenPlantOptions { creep, ..STILL });
    let fast = hold(&mut stage(STILL), 80.0, 0.01, 1);
    hold(&mut plant, 80.0, 0.0, 1);
    for time_s in [0.1, 0.3, 1.0, 3.0, 30.0, 100.0] {
        let mut plant = plant.clone();
        plant.write(80.0);
        plant.advance(time_s);
        let terms = [0.3, 3.0, 30.0].map(|tau| 1.0 - f64::exp(-time_s / tau));
        let expected = fast * (1.0 + creep / 3.0 * terms.iter().sum::<f64>());
        // The resonance at 20 kHz follows the creep 1.8 ζ/ω late: 14 µs of 4 µm/s.
        assert!((plant.truth().output - expected).abs() < 1e-4, "{time_s} s");
    }
}

#[test]
fn the_resonance_shows_in_the_step_response() {
    for (resonance_hz, damping) in [(400.0, 0.03), (725.0, 0.03), (200.0, 0.1)] {
        let mut plant = stage(BoucWenPlantOptions {
            resonance_hz,
            damping,
            ..STILL
        });
        let end = hold(&mut stage(STILL), 50.0, 0.01, 1);
        plant.write(50.0);
        let dt = 1e-5;
        let path: Vec<f64> = (0..4000)
            .map(|_| {
                plant.advance(dt);
                plant.truth().output - end
            })
            .collect();
        // Rising crossings of the end, a period apart; overshoots a logarithmic decrement apart.
        let crossings: Vec<f64> = (1..path.len())
            .filter(|&n| path[n - 1] < 0.0 && path[n] >= 0.0)
            .map(|n| (n as f64 - path[n] / (path[n] - path[n - 1])) * dt)
            .take(5)
            .collect();
        let period = (crossings[4] - crossings[0]) / 4.0;
        let damped = resonance_hz * (1.0 - damping * damping).sqrt();
        assert!(
            (1.0 / period / damped - 1.0).abs() < 1e-4,
            "{} {damped}",
            1.0 / period
        );
        let overshoot = path.iter().fold(0.0, |most: f64, x| most.max(*x)) / end;
        let expected = f64::exp(-damping * TAU / 2.0 / (1.0 - damping * damping).sqrt());
        assert!(
            (overshoot / expected - 1.0).abs() < 1e-3,
            "{overshoot} {expected}"
        );
    }
}

#[test]
fn how_time_is_divided_does_not_matter_at_all() {
    let run = |pieces| {
        let mut plant = stage(BoucWenPlantOptions {
            sensor: PERFECT,
            load_n: 3.0,
            delay_s: 0.0007,
            ..BoucWenPlantOptions::default()
        });
        outputs(&mut plant, &VOLTAGES, 0.0113, pieces)
    };
    for pieces in [2, 7, 1000] {
        // Rounding, on 20 µm.
        assert!(worst(&run(1), &run(pieces)) < 1e-11, "{pieces}");
    }
}

#[test]
fn a_drive_acts_when_its_time_has_come() {
    let mut plant = stage(BoucWenPlantOptions {
        sensor: PERFECT,
        ..BoucWenPlantOptions::default()
    });
    assert_eq!(hold(&mut plant, 100.0, 0.0005, 1), 0.0);
    assert_eq!(plant.truth().input, Some(100.0));
    plant.advance(1e-4);
    assert!(plant.truth().output > 0.0);
    // Of two that are written in the same instant the last one acts.
    plant.write(10.0);
    plant.write(30.0);
    plant.advance(0.0005);
    assert_eq!(plant.truth().input, Some(30.0));
}

#[test]
fn load_and_age_do_what_they_do() {
    let rest = |change: Option<Disturbance>| {
        let mut plant = stage(BoucWenPlantOptions {
            sensor: PERFECT,
            ..BoucWenPlantOptions::default()
        });
        hold(&mut plant, 60.0, 1.0, 1);
        if let Some(change) = change {
            plant.disturb(change).unwrap();
        }
        hold(&mut plant, 60.0, 200.0, 1)
    };
    let first = rest(None);
    assert!((rest(Some(Disturbance::Load(5.0))) - (first - 1.0)).abs() < 1e-9);
    assert!((rest(Some(Disturbance::Gain(0.8))) / first - 0.8).abs() < 1e-3);
    let mut plant = stage(STILL);
    for unknown in [Disturbance::Room(20.0), Disturbance::Predeformation(1.0)] {
        let error = plant.disturb(unknown).unwrap_err();
        assert!(matches!(
            of_the_rig(&error),
            Some(RigError::NoSuchDisturbance(_))
        ));
    }
    for wrong in [Disturbance::Load(-1.0), Disturbance::Gain(f64::NAN)] {
        assert!(refused(plant.disturb(wrong)));
    }
}

#[test]
fn what_no_stage_can_be_is_refused() {
    for wrong in [
        BoucWenPlantOptions {
            load_n: 21.0,
            ..STILL
        },
        BoucWenPlantOptions {
            limit_v: 0.0,
            ..STILL
        },
        BoucWenPlantOptions {
            alpha: 1.0,
            ..STILL
        },
        BoucWenPlantOptions { beta: 0.0, ..STILL },
        BoucWenPlantOptions {
            gamma: 0.021,
            ..STILL
        },
        BoucWenPlantOptions {
            creep: f64::NAN,
            ..STILL
        },
        BoucWenPlantOptions {
            resonance_hz: 1.0,
            ..STILL
        },
        BoucWenPlantOptions {
            damping: 1.0,
            ..STILL
        },
        BoucWenPlantOptions {
            delay_s: -1.0,
            ..STILL
        },
    ] {
        assert!(
            refused(BoucWenPlant::new(&wrong).map_err(Error::from)),
            "{wrong:?}"
        );
    }
}
