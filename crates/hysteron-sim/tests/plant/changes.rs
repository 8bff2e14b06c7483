//! What load, pre-deformation, room, faults, memory and drift do to the plants.

use super::*;

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
    // All of the martensite there was gives back its share; at room temperature the core is
    // austenite.
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

    // A shift, a gain and an offset alone would leave the quartiles of the rising branch in
    // proportion.
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

    // Only the temperatures' shift drives the transformation: without the lengthening the path is
    // the same, 1 mm higher.
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
