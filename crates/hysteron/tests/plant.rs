//! The simulated plants: time, load, drift, sensors, and what they refuse.
#![allow(clippy::unwrap_used)]

use hysteron::control::{Device, Disturbance, Reading, SimulatedPlant};
use hysteron::plant::{
    DriftOptions, FatigueOptions, PreisachPlant, PreisachPlantOptions, SensorOptions, SpringPlant,
    SpringPlantOptions,
};
use hysteron::rig::RigError;
use hysteron::{Error, Result};

const PERFECT: SensorOptions = SensorOptions {
    lag_s: 0.0,
    accuracy: 0.0,
    resolution: 0.0,
    range: None,
    dropout: 0.0,
};

fn spring(options: SpringPlantOptions) -> SpringPlant {
    SpringPlant::new(&options).unwrap()
}

fn preisach(options: PreisachPlantOptions) -> PreisachPlant {
    PreisachPlant::new(&options).unwrap()
}

/// Holds `drive` for `time_s`, in `pieces`, and tells the true output.
fn hold(plant: &mut impl SimulatedPlant, drive: f64, time_s: f64, pieces: u32) -> f64 {
    plant.write(drive);
    for _ in 0..pieces {
        plant.advance(time_s / f64::from(pieces));
    }
    plant.truth().output
}

/// The true output after each held drive, each held for `time_s` in `pieces`.
fn outputs(plant: &mut impl SimulatedPlant, drives: &[f64], time_s: f64, pieces: u32) -> Vec<f64> {
    drives
        .iter()
        .map(|&drive| hold(plant, drive, time_s, pieces))
        .collect()
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn refused<T>(result: Result<T>) -> bool {
    matches!(result, Err(Error::Rig(RigError::OutOfRange { .. })))
}

// ---------------------------------------------------------------- time

const CURRENTS: [f64; 8] = [2.0, 0.5, 1.5, 0.0, 1.8, 1.0, 2.0, 0.0];

#[test]
fn the_spring_does_not_depend_on_the_sampling_time() {
    let options = SpringPlantOptions {
        fatigue: Some(FatigueOptions {
            cycles: 2.0,
            ..FatigueOptions::default()
        }),
        ..SpringPlantOptions::default()
    };
    let reference = outputs(&mut spring(options), &CURRENTS, 12.0, 1);
    for pieces in [7, 120, 1200, 5000] {
        let divided = outputs(&mut spring(options), &CURRENTS, 12.0, pieces);
        let difference = worst(&reference, &divided);
        println!("{pieces} pieces: {difference:.1e} mm");
        // The error of the rig's own integration: a thousandth of the stroke.
        assert!(difference < 0.0135, "{pieces} pieces: {difference}");
    }
}

#[test]
fn the_lag_of_the_thermocouple_does_not_depend_on_the_sampling_time() {
    let reading = |pieces| {
        let mut plant = spring(SpringPlantOptions {
            thermocouple: SensorOptions {
                lag_s: 1.0,
                ..PERFECT
            },
            ..SpringPlantOptions::default()
        });
        hold(&mut plant, 2.0, 8.0, pieces);
        let truth = plant.truth().input.unwrap();
        let read = plant.read().input.unwrap();
        assert!(read < truth - 1.0, "it lags: {read} of {truth}");
        read
    };
    // The path between two steps of the plant is bent a little: less than a hundredth of the thermocouple's accuracy.
    for pieces in [3, 800, 4000] {
        assert!((reading(1) - reading(pieces)).abs() < 0.01);
    }
}

#[test]
fn the_lag_of_a_sensor_on_the_relays_does_not_depend_on_the_sampling_time() {
    let reading = |pieces| {
        let lag = |options| SensorOptions {
            lag_s: 0.2,
            ..options
        };
        let mut plant = preisach(PreisachPlantOptions {
            output_sensor: lag(PERFECT),
            measure_input: true,
            input_sensor: lag(PERFECT),
            ..PreisachPlantOptions::default()
        });
        hold(&mut plant, 120.0, 0.3, pieces);
        plant.read()
    };
    // Two bodies in series, τ and T: the answer to a step is known.
    let (tau, lag) = (0.02, 0.2);
    let decay = |body: f64| f64::exp(-0.3 / body);
    let expected = 120.0 * (1.0 - (lag * decay(lag) - tau * decay(tau)) / (lag - tau));
    for pieces in [1, 3, 1000] {
        let (read, once) = (reading(pieces), reading(1));
        // A tenth of the sensors' default noise.
        assert!((read.input.unwrap() - expected).abs() < 0.01);
        assert!((read.output - once.output).abs() < 0.01, "{pieces} pieces");
    }
}

const VOLTAGES: [f64; 9] = [110.0, 40.0, 90.0, 60.0, 75.0, 20.0, 140.0, 5.0, 66.0];

#[test]
fn the_relays_do_not_depend_on_the_sampling_time_at_all() {
    let drifting = DriftOptions {
        threshold_v: 12.0,
        gain: -0.1,
        time_s: 15.0,
    };
    let falling = DriftOptions {
        threshold_v: -12.0,
        ..drifting
    };
    for (lag_s, drift) in [
        (0.02, DriftOptions::default()),
        (0.02, drifting),
        (0.5, drifting),
        (0.5, falling),
        (0.0, falling),
    ] {
        let options = PreisachPlantOptions {
            lag_s,
            drift,
            ..PreisachPlantOptions::default()
        };
        let reference = outputs(&mut preisach(options), &VOLTAGES, 1.3, 1);
        for pieces in [2, 7, 1000] {
            let divided = outputs(&mut preisach(options), &VOLTAGES, 1.3, pieces);
            // Rounding only; no relay's threshold lies so near a turning point that rounding switches it.
            let difference = worst(&reference, &divided);
            assert!(
                difference < 1e-10,
                "lag {lag_s}, {pieces} pieces: {difference:e}"
            );
        }
    }
}

#[test]
fn the_amplifier_is_a_first_order_body() {
    let mut plant = preisach(PreisachPlantOptions::default());
    hold(&mut plant, 100.0, 0.03, 1);
    let expected = 100.0 * (1.0 - f64::exp(-1.5));
    assert!((plant.truth().input.unwrap() - expected).abs() < 1e-9);
}

#[test]
fn no_time_and_no_number_change_nothing() {
    fn check(mut plant: impl SimulatedPlant, drive: f64) {
        hold(&mut plant, drive, 10.0, 1);
        let before = plant.truth();
        for dt_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            plant.advance(dt_s);
            assert_eq!(plant.truth(), before);
        }
    }
    check(spring(SpringPlantOptions::default()), 1.5);
    check(preisach(PreisachPlantOptions::default()), 60.0);
}

// ---------------------------------------------------------------- drive

#[test]
fn the_drive_is_limited_and_nan_leaves_it() {
    fn check<P: SimulatedPlant + Clone>(new: P, limit: f64) {
        let run = |drives: [f64; 2]| {
            let mut plant = new.clone();
            for drive in drives {
                plant.write(drive);
            }
            plant.advance(5.0);
            plant.truth()
        };
        assert_ne!(run([0.0, limit]), run([0.0, 0.5 * limit]));
        assert_eq!(run([0.0, limit]), run([0.0, 1e3 * limit]));
        assert_eq!(run([0.0, limit]), run([0.0, f64::INFINITY]));
        assert_eq!(run([0.0, 0.0]), run([0.0, -limit]));
        assert_eq!(run([limit, limit]), run([limit, f64::NAN]));
    }
    check(spring(SpringPlantOptions::default()), 2.0);
    check(preisach(PreisachPlantOptions::default()), 150.0);
}

// ---------------------------------------------------------------- disturbances

#[test]
fn a_heavier_load_stretches_the_spring_at_once_and_lengthens_its_stroke() {
    let stroke = |plant: &mut SpringPlant| {
        let hot = hold(plant, 2.0, 300.0, 1);
        hot - hold(plant, 0.0, 600.0, 1)
    };
    let mut plant = spring(SpringPlantOptions::default());
    let light = stroke(&mut plant);
    let before = plant.truth();
    plant.disturb(Disturbance::Load(10.0)).unwrap();
    let after = plant.truth();
    assert_eq!(after.input, before.input, "at constant temperature");
    assert!(after.output < before.output - 5.0);
    let heavy = stroke(&mut plant);
    // The stroke of one phase pair is in proportion to the load: 10/6.
    assert!(heavy > 1.4 * light, "{light} to {heavy}");
}

#[test]
fn pre_deformation_expands_the_loop_and_leaves_the_temperatures() {
    let run = |predeformation_mm| {
        let mut plant = spring(SpringPlantOptions {
            predeformation_mm,
            ..SpringPlantOptions::default()
        });
        let mut path = vec![];
        for drive in [2.0, 0.0] {
            for _ in 0..60 {
                hold(&mut plant, drive, 1.0, 1);
                path.push(plant.truth());
            }
        }
        path
    };
    let (none, some) = (run(0.0), run(5.0));
    for (none, some) in none.iter().zip(&some) {
        assert_eq!(none.input, some.input);
        assert!(some.output >= none.output);
    }
    let highest = |path: &[Reading]| path.iter().map(|r| r.output).fold(0.0, f64::max);
    let longer = highest(&some) - highest(&none);
    // All of the martensite there was gives back its share; at room temperature the core is austenite.
    assert!((4.0..=5.0).contains(&longer), "{longer}");
}

#[test]
fn a_warmer_room_leaves_the_spring_warmer() {
    let mut plant = spring(SpringPlantOptions::default());
    plant.disturb(Disturbance::Room(30.0)).unwrap();
    hold(&mut plant, 0.0, 3000.0, 1);
    assert!((plant.truth().input.unwrap() - 30.0).abs() < 0.1);
}

/// Lowest and highest output, once the first cycle is over.
fn range(plant: &mut PreisachPlant) -> (f64, f64) {
    let [.., high, low] = outputs(plant, &[150.0, 0.0, 150.0, 0.0], 1.0, 1)[..] else {
        unreachable!()
    };
    (low, high)
}

#[test]
fn a_load_moves_and_deforms_the_cloud() {
    let mut plant = preisach(PreisachPlantOptions::default());
    let (low, high) = range(&mut plant);
    let full = high - low;
    for drive in [50.0, 60.0, 80.0, 100.0, 150.0] {
        let before = hold(&mut plant, drive, 1.0, 1);
        plant.disturb(Disturbance::Load(10.0)).unwrap();
        let fall = (before - plant.truth().output) / full;
        assert!((0.2..0.4).contains(&fall), "{drive} V: falls by {fall}");
        plant.disturb(Disturbance::Load(6.0)).unwrap();
    }
    plant.disturb(Disturbance::Load(10.0)).unwrap();
    let (loaded_low, loaded_high) = range(&mut plant);
    let common = high.min(loaded_high) - low.max(loaded_low);
    assert!(common > 0.6 * full, "{common} of {full} in common");

    // A shift, a gain and an offset alone would leave the quartiles of the rising branch in proportion.
    let quartiles = |load_n| {
        let mut plant = preisach(PreisachPlantOptions {
            load_n,
            ..PreisachPlantOptions::default()
        });
        let (low, high) = range(&mut plant);
        [0.25, 0.5, 0.75].map(|share| {
            let target = low + share * (high - low);
            (0..1500)
                .map(|n| 0.1 * f64::from(n))
                .find(|&drive| hold(&mut plant, drive, 1.0, 1) >= target)
                .inspect(|_| {
                    hold(&mut plant, 0.0, 1.0, 1);
                })
                .unwrap()
        })
    };
    let skew = |[a, b, c]: [f64; 3]| (c - b) / (b - a);
    let (light, heavy) = (skew(quartiles(6.0)), skew(quartiles(10.0)));
    assert!((light - 1.0).abs() > 0.05, "an asymmetric density: {light}");
    assert!((light - heavy).abs() > 0.01, "{light} to {heavy}");
}

#[test]
fn a_step_of_the_load_is_where_a_plant_under_that_load_would_be() {
    let mut stepped = preisach(PreisachPlantOptions::default());
    range(&mut stepped);
    stepped.disturb(Disturbance::Load(10.0)).unwrap();
    let mut heavy = preisach(PreisachPlantOptions {
        load_n: 10.0,
        ..PreisachPlantOptions::default()
    });
    assert_eq!(range(&mut stepped), range(&mut heavy));
}

#[test]
fn faults_reach_the_output_sensor() {
    fn check(mut plant: impl SimulatedPlant, drive: f64) {
        let stuck = plant.read().output;
        plant.disturb(Disturbance::Stuck(true)).unwrap();
        let truth = hold(&mut plant, drive, 30.0, 1);
        assert_eq!(plant.read().output, stuck);
        plant.disturb(Disturbance::Stuck(false)).unwrap();
        plant.disturb(Disturbance::Lost(true)).unwrap();
        assert!(plant.read().output.is_nan());
        plant.disturb(Disturbance::Lost(false)).unwrap();
        assert!((plant.read().output - truth).abs() < 0.6);
    }
    check(spring(SpringPlantOptions::default()), 2.0);
    check(preisach(PreisachPlantOptions::default()), 100.0);
}

// ---------------------------------------------------------------- the relays' memory

#[test]
fn the_cloud_forgets_what_is_wiped_out_and_its_loops_are_congruent() {
    let mut plant = preisach(PreisachPlantOptions::default());
    // Wiping out: after the loops inside, the branch goes on as if they had not been.
    let plain = outputs(&mut plant.clone(), &[130.0, 10.0, 120.0], 1.0, 1);
    let nested = outputs(
        &mut plant.clone(),
        &[130.0, 10.0, 90.0, 50.0, 80.0, 60.0, 90.0, 120.0],
        1.0,
        1,
    );
    assert_eq!(plain[2], nested[7]);

    // Congruency: a loop between two inputs is as high whatever came before.
    let from_below = outputs(&mut plant, &[0.0, 95.0, 60.0, 95.0], 1.0, 1);
    let from_above = outputs(&mut plant, &[150.0, 60.0, 95.0, 60.0], 1.0, 1);
    let heights = [from_below[3] - from_below[2], from_above[2] - from_above[3]];
    assert!(
        (from_below[3] - from_above[2]).abs() > 1.0,
        "at different places"
    );
    // The amplifier comes to rest e⁻⁵⁰ short of its drive: no relay tells.
    assert!((heights[0] - heights[1]).abs() < 1e-9, "{heights:?}");
}

// ---------------------------------------------------------------- drift

/// The displacement at the cold end of each cycle, of a spring that tires within `fatigue`.
fn cold_ends(fatigue: Option<FatigueOptions>, cycles: usize, pieces: u32) -> Vec<f64> {
    let mut plant = spring(SpringPlantOptions {
        fatigue,
        ..SpringPlantOptions::default()
    });
    (0..cycles)
        .map(|_| {
            hold(&mut plant, 2.0, 60.0, pieces);
            hold(&mut plant, 0.0, 200.0, pieces)
        })
        .collect()
}

#[test]
fn cycling_drifts_and_saturates() {
    let tired = FatigueOptions {
        cycles: 3.0,
        ..FatigueOptions::default()
    };
    let drifted = cold_ends(Some(tired), 25, 1);
    let steps: Vec<f64> = drifted
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .collect();
    assert!(steps[0] > 0.05, "{steps:?}");
    assert!(
        steps.windows(2).all(|pair| pair[1] < pair[0]),
        "ever less: {steps:?}"
    );
    assert!(steps[23] < 0.01 * steps[0], "{steps:?}");

    // Only the temperatures' shift drives the transformation: without the lengthening the path is the same, 1 mm higher.
    let kept = FatigueOptions {
        irrecoverable_mm: 0.0,
        ..tired
    };
    let kept = cold_ends(Some(kept), 25, 1);
    assert!((kept[24] - drifted[24] - 1.0).abs() < 1e-3);
    let steady = cold_ends(None, 25, 1);
    assert!(
        kept[24] > steady[24] + 0.1,
        "5 K less to cool to: {} and {}",
        kept[24],
        steady[24]
    );
    assert!(
        worst(&steady, &[steady[0]; 25]) < 1e-3,
        "off by default: {steady:?}"
    );

    // Within the integration's error, as without drift.
    let divided = cold_ends(Some(tired), 3, 20_000);
    assert!(worst(&drifted[..3], &divided) < 0.0135);
}

#[test]
fn the_relays_drift_to_their_end() {
    let drift = DriftOptions {
        threshold_v: 10.0,
        gain: -0.2,
        time_s: 10.0,
    };
    let mut plant = preisach(PreisachPlantOptions {
        drift,
        ..PreisachPlantOptions::default()
    });
    let mut fixed = preisach(PreisachPlantOptions::default());
    hold(&mut plant, 0.0, 1e3, 1);
    // What is shifted by 10 V shows at a drive 10 V higher, with four fifths of the gain.
    for (drive, shifted) in [(60.0, 70.0), (30.0, 40.0), (100.0, 110.0)] {
        let expected = 0.8 * hold(&mut fixed, drive, 1.0, 1);
        assert!((hold(&mut plant, shifted, 1.0, 1) - expected).abs() < 1e-9);
    }
}

// ---------------------------------------------------------------- sensors and seeds

#[test]
fn a_seed_makes_the_readings() {
    fn bits(mut plant: impl SimulatedPlant, drive: f64) -> Vec<(u64, Option<u64>)> {
        plant.write(drive);
        let mut bits = || {
            plant.advance(0.1);
            let Reading { output, input } = plant.read();
            (output.to_bits(), input.map(f64::to_bits))
        };
        (0..50).map(|_| bits()).collect()
    }
    let of_spring = |seed| {
        bits(
            spring(SpringPlantOptions {
                seed,
                ..SpringPlantOptions::default()
            }),
            2.0,
        )
    };
    let of_cloud = |seed| {
        bits(
            preisach(PreisachPlantOptions {
                seed,
                measure_input: true,
                ..PreisachPlantOptions::default()
            }),
            50.0,
        )
    };
    assert_eq!(of_spring(3), of_spring(3));
    assert_ne!(of_spring(3), of_spring(4));
    assert_eq!(of_cloud(3), of_cloud(3));
    assert_ne!(of_cloud(3), of_cloud(4));
}

#[test]
fn the_input_is_read_where_it_is_measured() {
    assert!(
        preisach(PreisachPlantOptions::default())
            .read()
            .input
            .is_none()
    );
    let measure_input = true;
    let mut plant = preisach(PreisachPlantOptions {
        measure_input,
        ..PreisachPlantOptions::default()
    });
    hold(&mut plant, 80.0, 1.0, 1);
    assert!((plant.read().input.unwrap() - 80.0).abs() < 0.31);
}

// ---------------------------------------------------------------- configuration

#[test]
fn options_are_plain_data_with_defaults() {
    let plant: SpringPlantOptions =
        serde_json::from_str(r#"{"load_n": 8, "fatigue": {}, "lvdt": {"accuracy": 0.1}}"#).unwrap();
    let lvdt = SensorOptions {
        accuracy: 0.1,
        ..PERFECT
    };
    let fatigue = Some(FatigueOptions::default());
    assert_eq!(
        plant,
        SpringPlantOptions {
            load_n: 8.0,
            fatigue,
            lvdt,
            ..SpringPlantOptions::default()
        }
    );
    let plant: PreisachPlantOptions = serde_json::from_str(r#"{"drift": {"gain": 0.1}}"#).unwrap();
    let drift = DriftOptions {
        gain: 0.1,
        ..DriftOptions::default()
    };
    assert_eq!(
        plant,
        PreisachPlantOptions {
            drift,
            ..PreisachPlantOptions::default()
        }
    );
    assert!(serde_json::from_str::<SpringPlantOptions>(r#"{"laod_n": 8}"#).is_err());
    assert!(serde_json::from_str::<PreisachPlantOptions>(r#"{"drift": {"gian": 1}}"#).is_err());
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let default = SpringPlantOptions::default;
    let fatigue = FatigueOptions::default();
    for options in [
        SpringPlantOptions {
            load_n: 12.0,
            ..default()
        },
        SpringPlantOptions {
            load_n: f64::NAN,
            ..default()
        },
        SpringPlantOptions {
            room_degc: -60.0,
            ..default()
        },
        SpringPlantOptions {
            predeformation_mm: -1.0,
            ..default()
        },
        SpringPlantOptions {
            limit_a: 0.0,
            ..default()
        },
        SpringPlantOptions {
            lvdt: SensorOptions {
                dropout: 2.0,
                ..PERFECT
            },
            ..default()
        },
        SpringPlantOptions {
            fatigue: Some(FatigueOptions {
                cycles: 0.0,
                ..fatigue
            }),
            ..default()
        },
        SpringPlantOptions {
            fatigue: Some(FatigueOptions {
                shift_k: 90.0,
                ..fatigue
            }),
            ..default()
        },
    ] {
        assert!(
            refused(SpringPlant::new(&options).map_err(Error::from)),
            "{options:?}"
        );
    }
    let default = PreisachPlantOptions::default;
    let drift = DriftOptions::default();
    for options in [
        PreisachPlantOptions {
            load_n: 13.0,
            ..default()
        },
        PreisachPlantOptions {
            lag_s: -0.1,
            ..default()
        },
        PreisachPlantOptions {
            limit_v: f64::INFINITY,
            ..default()
        },
        PreisachPlantOptions {
            levels: 1,
            ..default()
        },
        PreisachPlantOptions {
            drift: DriftOptions {
                time_s: 0.0,
                ..drift
            },
            ..default()
        },
        PreisachPlantOptions {
            output_sensor: SensorOptions {
                lag_s: -1.0,
                ..PERFECT
            },
            ..default()
        },
    ] {
        assert!(
            refused(PreisachPlant::new(&options).map_err(Error::from)),
            "{options:?}"
        );
    }

    let mut plant = spring(SpringPlantOptions::default());
    hold(&mut plant, 2.0, 15.0, 1);
    let before = plant.truth();
    for value in [f64::NAN, f64::INFINITY, -1e3, 1e3] {
        assert!(refused(plant.disturb(Disturbance::Load(value))));
        assert!(refused(plant.disturb(Disturbance::Room(value))));
        assert!(refused(plant.disturb(Disturbance::Predeformation(value))));
    }
    assert_eq!(plant.truth(), before);

    let mut plant = preisach(PreisachPlantOptions::default());
    hold(&mut plant, 80.0, 1.0, 1);
    let before = plant.truth();
    assert!(refused(plant.disturb(Disturbance::Load(f64::NAN))));
    for unknown in [Disturbance::Room(22.0), Disturbance::Predeformation(1.0)] {
        let error = plant.disturb(unknown).unwrap_err();
        assert!(
            matches!(error, Error::Rig(RigError::NoSuchDisturbance(_))),
            "{error}"
        );
    }
    assert_eq!(plant.truth(), before);
}
