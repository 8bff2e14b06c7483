//! Seeds, what is measured, and what the options may be.

use super::*;

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
            matches!(of_the_rig(&error), Some(RigError::NoSuchDisturbance(_))),
            "{error}"
        );
    }
    assert_eq!(plant.truth(), before);
}
