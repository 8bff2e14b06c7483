//! How time is divided does not matter, and the drive is limited.

use super::*;

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
    // The path between two steps of the plant is bent a little: less than a hundredth of the
    // thermocouple's accuracy.
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
            // Rounding only; no relay's threshold lies so near a turning point that rounding
            // switches it.
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
