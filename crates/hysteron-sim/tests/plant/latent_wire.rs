//! The wire with latent heat against its physics: heat, loops, fractions, time steps.

use super::*;
use hysteron_sim::plant::{HeatingDrive, LatentWirePlant, LatentWirePlantOptions};

fn wire(options: LatentWirePlantOptions) -> LatentWirePlant {
    LatentWirePlant::new(&options).unwrap()
}

fn perfect() -> LatentWirePlantOptions {
    LatentWirePlantOptions {
        sensor: PERFECT,
        ..LatentWirePlantOptions::default()
    }
}

/// Full and partial heating and cooling, each held for so long, s.
const DUTIES: [(f64, f64); 9] = [
    (0.8, 4.0),
    (0.0, 12.0),
    (0.3, 5.0),
    (0.1, 3.0),
    (0.25, 4.0),
    (0.05, 5.0),
    (0.45, 2.0),
    (0.12, 6.0),
    (0.0, 20.0),
];

#[test]
fn over_a_cycle_no_heat_is_lost() {
    let mut plant = wire(perfect());
    let cold = plant.heat_j();
    // Trapezoids of the net power between steps that are finer than the plant's own.
    let h = 0.002;
    let (mut flown, mut turned_over, mut hottest) = (0.0, 0.0, cold);
    for (duty, time_s) in DUTIES {
        plant.write(duty);
        for _ in 0..(time_s / h) as usize {
            let before = plant.net_power_w();
            plant.advance(h);
            let mean = 0.5 * (before + plant.net_power_w());
            flown += mean * h;
            turned_over += (mean * h).abs();
            hottest = f64::max(hottest, plant.heat_j());
        }
    }
    assert!(plant.martensite_fraction() > 0.99);
    // The latent heat of 11.4 mg, and more to warm it.
    assert!(hottest - cold > 0.228, "{}", hottest - cold);
    let lost = (flown - (plant.heat_j() - cold)).abs();
    println!("{lost:.1e} J lost of {turned_over:.2} J");
    // The trapezoids' own error: h²/12 of the power's change over some hundred time constants.
    assert!(lost < 1e-4 * turned_over, "{lost} of {turned_over}");
}

#[test]
fn latent_heat_holds_the_temperature_up() {
    let half_s = |latent_heat_j_per_g| {
        let mut plant = wire(LatentWirePlantOptions {
            latent_heat_j_per_g,
            ..perfect()
        });
        hold(&mut plant, 0.8, 10.0, 1);
        let mut time = 0.0;
        while hold(&mut plant, 0.0, 0.05, 1) > 2.0 {
            time += 0.05;
        }
        time
    };
    let (without, with) = (half_s(0.0), half_s(20.0));
    // Half of 0.228 J leaves through some 4.7 mW/K at 16 K above the room.
    let more = with - without;
    assert!((1.0..2.0).contains(&more), "{without} s, {with} s");
}

/// Ramps slowly, so that the drive decides the temperature: temperature and displacement.
fn ramp(plant: &mut LatentWirePlant, from: f64, to: f64) -> Vec<(f64, f64)> {
    let steps = 4000;
    let path = (0..=steps).map(|n| {
        let share = f64::from(n) / f64::from(steps);
        hold(plant, from + share * (to - from), 0.05, 1);
        let truth = plant.truth();
        (truth.input.unwrap(), truth.output)
    });
    let path = path.collect();
    // Until the heat has gone where it goes.
    hold(plant, to, 100.0, 1);
    path
}

/// The displacement of a rising path at a temperature.
fn at(path: &[(f64, f64)], degc: f64) -> f64 {
    let n = path.partition_point(|(t, _)| *t < degc);
    let n = n.clamp(1, path.len() - 1);
    let ((t0, y0), (t1, y1)) = (path[n - 1], path[n]);
    (y0 + (degc - t0) / (t1 - t0) * (y1 - y0)).clamp(y0.min(y1), y0.max(y1))
}

#[test]
fn minor_loops_stay_inside_the_major_one_and_close() {
    for stiffness_n_per_mm in [0.0, 0.1] {
        let wire = || {
            wire(LatentWirePlantOptions {
                stiffness_n_per_mm,
                ..perfect()
            })
        };
        let mut plant = wire();
        let heating = ramp(&mut plant, 0.0, 0.6);
        let mut cooling = ramp(&mut plant, 0.6, 0.0);
        cooling.reverse();
        let mut plant = wire();
        let (low, high) = (0.14, 0.43);
        ramp(&mut plant, 0.0, high);
        let mut previous = Vec::new();
        let changes = [0, 1, 2].map(|_| {
            let down = ramp(&mut plant, high, low);
            let up = ramp(&mut plant, low, high);
            for &(degc, mm) in down.iter().chain(&up) {
                // The paths of the major loop are linear between its samples.
                let fuzz = 2e-3;
                assert!(mm > at(&heating, degc) - fuzz, "{mm} mm at {degc} °C");
                assert!(mm < at(&cooling, degc) + fuzz, "{mm} mm at {degc} °C");
            }
            assert!(up[up.len() - 1].1 - up[0].1 > 0.5);
            let outputs: Vec<f64> = up.iter().map(|(_, mm)| *mm).collect();
            let change = match previous.is_empty() {
                true => f64::INFINITY,
                false => worst(&outputs, &previous),
            };
            previous = outputs;
            change
        });
        println!("{stiffness_n_per_mm} N/mm: {changes:?} mm");
        // What is left of the transients of 2 s after 100 s, and of the integration.
        assert!(changes[1] < 1e-6 && changes[2] < 1e-6, "{changes:?}");
    }
}

#[test]
fn the_fraction_stays_a_fraction_whatever_happens() {
    let mut plant = wire(LatentWirePlantOptions {
        stiffness_n_per_mm: 0.2,
        latent_heat_j_per_g: 40.0,
        ..perfect()
    });
    let mut seed = 7_u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 40) as f64 / (1_u64 << 24) as f64
    };
    for n in 0..3000 {
        plant.write(random());
        plant.advance(3.0 * random().powi(4));
        let disturbance = match n % 7 {
            0 => Some(Disturbance::Load(1.0 + 3.0 * random())),
            3 => Some(Disturbance::Room(-20.0 + 70.0 * random())),
            5 => Some(Disturbance::Gain(0.5 + 0.5 * random())),
            _ => None,
        };
        let heat = plant.heat_j();
        if let Some(disturbance) = disturbance {
            plant.disturb(disturbance).unwrap();
            assert_eq!(plant.heat_j(), heat, "nothing flows at once");
        }
        let xi = plant.martensite_fraction();
        assert!((0.0..=1.0).contains(&xi), "{xi}");
        assert!((0.0..300.0).contains(&plant.stress()), "{}", plant.stress());
        let Reading { output, input } = plant.truth();
        assert!((-2.0..5.0).contains(&output), "{output}");
        assert!((-20.0..300.0).contains(&input.unwrap()), "{input:?}");
    }
}

#[test]
fn finer_steps_converge() {
    let run = |pieces: u32| {
        let mut plant = wire(perfect());
        let held = DUTIES.map(|(duty, time_s)| {
            let rounds = (time_s * 10.0) as u32;
            (0..rounds)
                .map(|_| hold(&mut plant, duty, 0.1, pieces))
                .collect::<Vec<_>>()
        });
        held.concat()
    };
    let finest = run(640);
    let errors = [10, 20, 40, 80].map(|pieces| worst(&run(pieces), &finest));
    println!("{errors:?} mm");
    // With the plant's own steps, as `LONGEST_S` states. Corners of the law keep the method from its
    // order, so that twice as many steps need not do better.
    assert!(errors[0] < 1e-7, "{errors:?}");
    assert!(errors[3] < 0.1 * errors[0], "{errors:?}");
}

#[test]
fn a_current_heats_by_its_square() {
    let run = |drive, share| {
        let mut plant = wire(LatentWirePlantOptions { drive, ..perfect() });
        outputs(&mut plant, &[share, 0.0], 5.0, 1)
    };
    assert_eq!(
        run(HeatingDrive::Duty, 0.25),
        run(HeatingDrive::Current, 0.5)
    );
}

#[test]
fn room_load_and_age_do_what_they_do() {
    let hot = |change: Option<Disturbance>| {
        let mut plant = wire(perfect());
        if let Some(change) = change {
            plant.disturb(change).unwrap();
        }
        let warm = hold(&mut plant, 0.36, 60.0, 1);
        (warm, hold(&mut plant, 0.8, 20.0, 1))
    };
    let (warm, stroke) = hot(None);
    let (warmer, same) = hot(Some(Disturbance::Room(30.0)));
    assert!(warmer > warm + 0.5, "{warm} {warmer}");
    assert!((same - stroke).abs() < 1e-9);
    // 0.5 N more stretch the cold wire by F ℓ/(E A), and move the transformation up by 2 K.
    let (heavier, less) = hot(Some(Disturbance::Load(3.5)));
    assert!(heavier < warm - 0.2 && less < stroke);
    let (_, aged) = hot(Some(Disturbance::Gain(0.9)));
    // A tenth of 4 mm, less what the spring pulls less.
    assert!((0.39..0.41).contains(&(stroke - aged)), "{stroke} {aged}");
    let mut plant = wire(perfect());
    let unknown = plant.disturb(Disturbance::Predeformation(1.0)).unwrap_err();
    assert!(matches!(
        of_the_rig(&unknown),
        Some(RigError::NoSuchDisturbance(_))
    ));
    for wrong in [
        Disturbance::Load(0.0),
        Disturbance::Room(f64::NAN),
        Disturbance::Gain(1.1),
    ] {
        assert!(refused(plant.disturb(wrong)));
    }
}

#[test]
fn what_no_wire_can_be_is_refused() {
    for wrong in [
        LatentWirePlantOptions {
            load_n: 5.0,
            ..perfect()
        },
        LatentWirePlantOptions {
            stiffness_n_per_mm: 0.3,
            ..perfect()
        },
        LatentWirePlantOptions {
            room_degc: f64::NAN,
            ..perfect()
        },
        LatentWirePlantOptions {
            latent_heat_j_per_g: -1.0,
            ..perfect()
        },
        LatentWirePlantOptions {
            strain: 0.1,
            ..perfect()
        },
        LatentWirePlantOptions {
            limit_a: 1.0,
            ..perfect()
        },
    ] {
        assert!(
            refused(LatentWirePlant::new(&wrong).map_err(Error::from)),
            "{wrong:?}"
        );
    }
    assert!(serde_json::from_str::<LatentWirePlantOptions>(r#"{"drive": "current"}"#).is_ok());
    assert!(serde_json::from_str::<LatentWirePlantOptions>(r#"{"drive": "heat"}"#).is_err());
}
