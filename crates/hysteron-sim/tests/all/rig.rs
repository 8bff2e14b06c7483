//! The virtual rig: its integration, its law of transformation, its experiment, its sensors and its
//! filter.

use hysteron::filter::{FilterError, low_pass};
use hysteron::{Origin, Recording};
use hysteron_sim::rig::{
    Direction, Experiment, MaterialPoint, Plant, Rig, RigError, Sensor, Spring, Transformation,
    Wire, prepared,
};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::sync::LazyLock;

/// The default experiment with perfect sensors.
static TRUTH: LazyLock<Recording> = LazyLock::new(|| Experiment::default().truth().unwrap());

fn stroke(recording: &Recording) -> f64 {
    let (_, (low, high)) = recording.ranges();
    high - low
}

/// Root mean square of the differences.
fn rms(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (sum, n) = pairs.fold((0.0, 0), |(sum, n), (a, b)| (sum + (a - b).powi(2), n + 1));
    assert!(n > 0);
    f64::sqrt(sum / f64::from(n))
}

/// A point with `turns` random turning points behind it, and the generator that made them.
fn with_a_past(seed: u64, sigma: f64, turns: usize) -> (MaterialPoint, ChaCha8Rng) {
    let law = Transformation::default();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut point = MaterialPoint::cooled_from_austenite(&law, 20.0, sigma);
    for _ in 0..turns {
        point.advance(&law, rng.random_range(0.0..90.0), sigma);
    }
    (point, rng)
}

// ---------------------------------------------------------------- integration

#[test]
fn halving_either_step_changes_nothing_that_shows() {
    let halved = |substep_s: f64, sample_interval_s: f64| {
        let mut experiment = Experiment {
            sample_interval_s,
            ..Experiment::default()
        };
        experiment.rig.wire.substep_s = substep_s;
        experiment.truth().unwrap()
    };
    let reference = &*TRUTH;
    // A thousandth of the stroke is 1/30 of the LVDT's accuracy.
    let tolerance = 1e-3 * stroke(reference);
    for (what, every, other) in [
        ("plant", 1, halved(0.025, 0.05)),
        ("caller", 2, halved(0.05, 0.025)),
        ("both", 2, halved(0.025, 0.025)),
    ] {
        // The schedules differ by the error of the integration, by a sample at most.
        let samples = other.len().div_ceil(every);
        assert!(
            samples.abs_diff(reference.len()) <= 1,
            "{what}: {samples} samples"
        );
        let common = other.output.iter().step_by(every);
        let worst = reference
            .output
            .iter()
            .zip(common)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        println!("{what} halved: {worst:.2e} mm");
        assert!(worst < tolerance, "{what} halved: {worst} mm");
    }
}

#[test]
fn at_rest_nothing_moves() {
    let law = Transformation::default();
    for seed in 0..50 {
        let (mut point, _) = with_a_past(seed, 200.0, 20);
        point.advance(&law, 40.0, 200.0);
        let before = point.clone();
        for _ in 0..100 {
            point.advance(&law, 40.0, 200.0);
            assert_eq!(point, before);
        }
    }

    let mut plant = Plant::new(Rig::default()).unwrap();
    let new = plant.clone();
    for dt in [1e-6, 0.05, 1.0, 3600.0] {
        plant.step(0.0, dt).unwrap();
        assert_eq!(plant, new, "no current at room temperature, {dt} s");
    }
    assert_eq!(plant.displacement_mm(), 0.0);

    // Amid the transformation, in a room as warm as the wire.
    plant.step(2.0, 20.0).unwrap();
    assert!((0.1..0.9).contains(&plant.martensite_fraction()));
    plant.set_room_degc(plant.temperature_degc()).unwrap();
    let warm = plant.clone();
    for _ in 0..100 {
        plant.step(0.0, 0.7).unwrap();
        plant.step(2.0, 0.0).unwrap();
        plant.set_load_n(plant.rig().load_n).unwrap();
        assert_eq!(plant, warm);
    }
}

// ---------------------------------------------------------------- transformation

#[test]
fn steps_of_one_direction_compose() {
    let law = Transformation::default();
    for seed in 0..500 {
        let sigma = 400.0 * (seed % 5) as f64 / 4.0;
        let (mut once, mut rng) = with_a_past(seed, sigma, 12);
        let mut divided = once.clone();
        for _ in 0..10 {
            let from: f64 = rng.random_range(0.0..90.0);
            let to: f64 = rng.random_range(0.0..90.0);
            once.advance(&law, from, sigma);
            divided.advance(&law, from, sigma);

            let direction = if to > from {
                Direction::Heating
            } else {
                Direction::Cooling
            };
            let (ahead, slope) = once.ahead(&law, direction, to, sigma);
            once.advance(&law, to, sigma);
            assert_eq!(once.fraction(), ahead, "ahead() foretells advance()");
            assert!(slope <= 0.0);

            let mut shares: Vec<f64> = (0..7).map(|_| rng.random_range(0.0..1.0)).collect();
            shares.sort_by(f64::total_cmp);
            for share in shares {
                divided.advance(&law, from + share * (to - from), sigma);
            }
            divided.advance(&law, to, sigma);
            // Rounding only: the law has no steps.
            let difference = (once.fraction() - divided.fraction()).abs();
            assert!(
                difference < 1e-12,
                "seed {seed}, {from} to {to}: {difference:e}"
            );
        }
    }
}

#[test]
fn the_fraction_stays_a_fraction() {
    let law = Transformation::default();
    for seed in 0..200 {
        // The highest stress is that of 1000 N on the default spring.
        let most = [0.0, 300.0, 2e3, 6e4][seed as usize % 4];
        let (mut point, mut rng) = with_a_past(seed, 0.0, 0);
        for _ in 0..500 {
            let (t, sigma) = (
                rng.random_range(-50.0..200.0),
                most * rng.random_range(0.0..1.0),
            );
            point.advance(&law, t, sigma);
            let xi = point.fraction();
            assert!(
                (0.0..=1.0).contains(&xi),
                "seed {seed}: {xi} at {t} degC, {sigma} MPa"
            );
        }
    }
}

#[test]
fn the_plant_stays_finite_whatever_drives_it() {
    for seed in 0..10 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut plant = Plant::new(Rig::default()).unwrap();
        for _ in 0..200 {
            plant
                .set_load_n(1000f64.powf(rng.random_range(-1.0..1.0)))
                .unwrap();
            plant.set_room_degc(rng.random_range(-50.0..200.0)).unwrap();
            plant
                .step(rng.random_range(-10.0..10.0), rng.random_range(0.0..20.0))
                .unwrap();
            let xi = plant.martensite_fraction();
            // A mean of fractions with weights that sum to 1 up to rounding.
            assert!((0.0..=1.0 + 1e-12).contains(&xi), "seed {seed}: {xi}");
            assert!(plant.temperature_degc().is_finite() && plant.displacement_mm().is_finite());
            assert!(plant.resistance_ohm() > 0.0);
        }
    }
}

#[test]
fn partial_loops_lie_inside_the_major_loop() {
    let law = Transformation::default();
    for seed in 0..500 {
        let sigma = 400.0 * (seed % 5) as f64 / 4.0;
        let (mut point, mut rng) = with_a_past(seed, sigma, 0);
        for _ in 0..100 {
            let t = rng.random_range(0.0..90.0);
            point.advance(&law, t, sigma);
            let (most, _) = law.major(
                Direction::Heating,
                t - sigma / law.austenite_slope_mpa_per_k,
            );
            let (least, _) = law.major(
                Direction::Cooling,
                t - sigma / law.martensite_slope_mpa_per_k,
            );
            let xi = point.fraction();
            // Rounding only.
            assert!(
                (least - 1e-12..=most + 1e-12).contains(&xi),
                "seed {seed}, {t} degC, {sigma} MPa: {xi} not in {least} to {most}"
            );
        }
    }
}

#[test]
fn the_experiment_stays_inside_the_major_loop() {
    let Rig {
        transformation: law,
        spring,
        load_n,
        room_degc,
        ..
    } = Rig::default();
    let deflection = |direction, t: f64| {
        let slope = match direction {
            Direction::Heating => law.austenite_slope_mpa_per_k,
            Direction::Cooling => law.martensite_slope_mpa_per_k,
        };
        let rings = spring.cross_section().map(|ring| {
            let theta = t - ring.stress_mpa_per_n * load_n / slope;
            (ring.polar_moment_mm4, law.major(direction, theta).0)
        });
        spring.deflection_mm(load_n, rings)
    };
    let cold = deflection(Direction::Cooling, room_degc);
    for (&t, &y) in TRUTH.input.iter().zip(&TRUTH.output) {
        let (low, high) = (
            cold - deflection(Direction::Heating, t),
            cold - deflection(Direction::Cooling, t),
        );
        // Rounding only.
        assert!(
            (low - 1e-9..=high + 1e-9).contains(&y),
            "{t} degC: {y} mm not in {low} to {high}"
        );
    }
}

// ---------------------------------------------------------------- experiment

#[test]
fn stroke_and_temperatures_are_those_of_the_chapter() {
    let recording = &*TRUTH;
    let ((_, hottest), (lowest, _)) = recording.ranges();
    // The chapter tells of 13.5 mm and 20 to 80 degC.
    assert!((13.0..=15.0).contains(&stroke(recording)));
    assert!((80.0..90.0).contains(&hottest));
    // The spring starts cold: no later point hangs lower, up to rounding.
    assert!(lowest >= -1e-12);
    let peak = recording.input.iter().position(|&t| t > 80.0).unwrap();
    assert!(recording.input[peak..].iter().any(|&t| t < 26.0));
    assert!(*recording.input.last().unwrap() < 26.0);
    assert_eq!(recording.origin, Origin::Simulated);
}

#[test]
fn more_load_lifts_further_and_transforms_hotter() {
    const STEP_N: f64 = 2.0;
    let run = |load_n: f64| {
        let mut experiment = Experiment {
            // At 10 N the skin has become austenite at 89 degC.
            targets_degc: vec![95.0, 23.0],
            ..Experiment::default()
        };
        experiment.rig.load_n = load_n;
        let recording = experiment.truth().unwrap();
        let (_, (low, high)) = recording.ranges();
        let half = 0.5 * (low + high);
        let up = recording.output.iter().position(|&y| y > half).unwrap();
        let down = recording.output.iter().rposition(|&y| y > half).unwrap();
        (high - low, recording.input[up], recording.input[down])
    };
    let Rig {
        transformation: law,
        spring,
        ..
    } = Rig::default();
    // von Mises stress at the skin, MPa for a newton.
    let skin = 3f64.sqrt() * 8.0 * spring.coil_diameter_mm
        / (std::f64::consts::PI * spring.wire_diameter_mm.powi(3));
    // What carries the load lies between half the radius and the skin (J grows with r⁴), so the
    // shift of half the stroke lies between half of the skin's and all of it.
    let shifts = |slope: f64| 0.5 * skin * STEP_N / slope..skin * STEP_N / slope;

    let runs = [6.0, 8.0, 10.0].map(run);
    println!("{runs:?}");
    for pair in runs.windows(2) {
        let ((stroke, up, down), (more_stroke, more_up, more_down)) = (pair[0], pair[1]);
        // Nearly in proportion to the load; 1 mm is a third of the 15 % that 2 N in 10 N or more
        // make of 20 mm.
        assert!(more_stroke > stroke + 1.0);
        assert!(shifts(law.austenite_slope_mpa_per_k).contains(&(more_up - up)));
        assert!(shifts(law.martensite_slope_mpa_per_k).contains(&(more_down - down)));
    }
}

// ---------------------------------------------------------------- sensors

#[test]
fn a_seed_makes_a_recording() {
    let experiment = Experiment::default();
    let [first, again, other] = [1, 1, 2].map(|seed| experiment.record(seed).unwrap());
    assert_eq!(first, again);
    assert_eq!(first.time, other.time);
    assert_ne!(first.input, other.input);
    assert_ne!(first.output, other.output);

    for recording in [first, other] {
        for (read, truth, accuracy) in [
            (&recording.input, &TRUTH.input, 1.0),
            (&recording.output, &TRUTH.output, 0.5),
        ] {
            assert_eq!(read.len(), truth.len());
            let errors = || read.iter().zip(truth).map(|(a, b)| (a - b).abs());
            // The sum of truth and noise is rounded.
            assert!(errors().all(|e| e <= accuracy + 1e-12));
            // The noise is there: of ten thousand readings, some forty lie between 2.7 and 3
            // standard deviations.
            assert!(errors().fold(0.0, f64::max) > 0.9 * accuracy);
        }
    }
}

#[test]
fn preparing_takes_the_noise_away() {
    let experiment = Experiment::default();
    let mut end = 0.0;
    let mut corners: Vec<f64> = vec![0.0];
    for phase in experiment.schedule().unwrap() {
        end += phase.duration_s;
        corners.push(end);
    }
    // The filter's response to a corner dies down by e every 1/(√2 π 0.3 Hz) = 0.75 s: by 800 in 5
    // s.
    let away = |t: f64| corners.iter().all(|corner| (t - corner).abs() > 5.0);

    for seed in [1, 2] {
        let raw = experiment.record(seed).unwrap();
        let smooth = prepared(&raw).unwrap();
        // Each prepared sample that is away from corners, with its place in the raw recording.
        let places: Vec<(usize, usize)> = (smooth.time.as_ref().unwrap().iter().enumerate())
            .filter(|(_, t)| away(**t))
            .map(|(k, t)| (k, (t / experiment.sample_interval_s).round() as usize))
            .collect();
        assert!(places.len() * 2 > smooth.len(), "most samples are compared");
        for (what, truth, raw, smooth) in [
            ("temperature", &TRUTH.input, &raw.input, &smooth.input),
            ("displacement", &TRUTH.output, &raw.output, &smooth.output),
        ] {
            let before = rms(places.iter().map(|&(_, n)| (raw[n], truth[n])));
            let after = rms(places.iter().map(|&(k, n)| (smooth[k], truth[n])));
            println!("{what}: {before:.4} to {after:.4}");
            assert!(after * 4.0 <= before, "{what}: {before} to {after}");
        }
    }
}

#[test]
fn what_cannot_be_prepared_is_told() {
    let mut recording = Recording::new(vec![20.0], vec![0.0]).unwrap();
    assert_eq!(prepared(&recording), Err(RigError::NoTime));
    recording.time = Some(vec![0.0]);
    assert_eq!(
        prepared(&recording),
        Err(RigError::Filter(FilterError::TooShort(1)))
    );

    let mut recording = Recording::new(vec![20.0; 9], vec![0.0; 9]).unwrap();
    recording.time = Some(vec![0.0; 9]);
    assert!(matches!(
        prepared(&recording),
        Err(RigError::Filter(FilterError::SampleRate(_)))
    ));
    recording.time = Some((0..9).map(|k| 2.0 * f64::from(k)).collect());
    assert!(matches!(
        prepared(&recording),
        Err(RigError::Filter(FilterError::Cutoff { .. }))
    ));
}

// ---------------------------------------------------------------- filter

#[test]
fn the_filter_has_no_phase() {
    let pulse: Vec<f64> = (-300..=300)
        .map(|k| (-f64::from(k * k) / 200.0).exp())
        .collect();
    let smooth = low_pass(&pulse, 20.0, 0.3).unwrap();
    // The response has died down to e^(-1.33 · 15) of the pulse where the passes begin, 15 s from
    // it.
    for (a, b) in smooth.iter().zip(smooth.iter().rev()) {
        assert!((a - b).abs() < 1e-8, "{a} and {b}");
    }
    let top = smooth.iter().copied().fold(0.0, f64::max);
    assert!(smooth[300] == top && top < 0.9, "lower and not shifted");
}

#[test]
fn the_filter_has_unit_gain_at_rest_and_half_at_the_cut_off() {
    for value in [0.0, -3.7, 1e6] {
        let smooth = low_pass(&[value; 50], 20.0, 0.3).unwrap();
        assert!(smooth.iter().all(|x| *x == value));
    }
    // The area of a pulse is its spectrum at frequency 0. It has left the ends, as above.
    let mut pulse = vec![0.0; 601];
    pulse[300] = 1.0;
    let area: f64 = low_pass(&pulse, 20.0, 0.3).unwrap().iter().sum();
    assert!((area - 1.0).abs() < 1e-8, "{area}");

    let wave = |k: i32| (std::f64::consts::TAU * 0.3 * f64::from(k) / 20.0).sin();
    let waves: Vec<f64> = (0..2000).map(wave).collect();
    let smooth = low_pass(&waves, 20.0, 0.3).unwrap();
    for k in 500..1500 {
        // 25 s from the ends, as above.
        assert!((smooth[k] - 0.5 * waves[k]).abs() < 1e-9);
    }
}

#[test]
fn the_filter_preserves_a_ramp_of_any_length() {
    for samples in [2, 3, 10, 60, 400, 5000] {
        for cutoff in [0.01, 0.3, 9.0] {
            let ramp: Vec<f64> = (0..samples).map(|k| 5.0 - 0.03 * f64::from(k)).collect();
            let smooth = low_pass(&ramp, 20.0, cutoff).unwrap();
            for (a, b) in smooth.iter().zip(&ramp) {
                // Rounding, over a ramp of up to 150.
                assert!(
                    (a - b).abs() < 1e-9,
                    "{samples} samples, {cutoff} Hz: {a}, not {b}"
                );
            }
        }
    }
}

#[test]
fn the_filter_refuses_what_it_cannot_filter() {
    let flat = [1.0; 8];
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut samples = flat;
        samples[5] = value;
        assert_eq!(
            low_pass(&samples, 20.0, 0.3),
            Err(FilterError::NotFinite(5))
        );
    }
    for samples in [0, 1] {
        assert_eq!(
            low_pass(&flat[..samples], 20.0, 0.3),
            Err(FilterError::TooShort(samples))
        );
    }
    for cutoff in [10.0, 11.0, 0.0, -0.3, f64::INFINITY, f64::NAN] {
        let refused = low_pass(&flat, 20.0, cutoff);
        assert!(
            matches!(refused, Err(FilterError::Cutoff { nyquist: 10.0, .. })),
            "{refused:?}"
        );
    }
    for rate in [0.0, -20.0, f64::INFINITY, f64::NAN] {
        let refused = low_pass(&flat, rate, 0.3);
        assert!(
            matches!(refused, Err(FilterError::SampleRate(_))),
            "{refused:?}"
        );
    }
}

// ---------------------------------------------------------------- refusals

#[test]
fn the_plant_refuses_absurd_input_and_stays_as_it_was() {
    let mut plant = Plant::new(Rig::default()).unwrap();
    plant.step(2.0, 15.0).unwrap();
    let before = plant.clone();
    let absurd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e3, 1e6];
    for value in absurd {
        let refusals = [
            plant.step(value, 1.0),
            plant.step(2.0, value),
            plant.set_load_n(value),
            plant.set_room_degc(value),
            plant.set_predeformation_mm(value),
            plant.set_transformation_shift_k(value),
        ];
        for refused in refusals {
            assert!(
                matches!(refused, Err(RigError::OutOfRange { .. })),
                "{value}: {refused:?}"
            );
        }
        assert_eq!(plant, before);
    }
    assert!(plant.step(2.0, -1e-9).is_err());
    assert!(plant.set_load_n(-1e-9).is_err());
    assert_eq!(plant, before);
}

#[test]
fn a_rig_that_cannot_be_is_refused() {
    let spring = Spring::default();
    let law = Transformation::default();
    let with_spring = |spring| Rig {
        spring,
        ..Rig::default()
    };
    let with_law = |transformation| Rig {
        transformation,
        ..Rig::default()
    };
    let rigs = [
        Rig {
            load_n: f64::INFINITY,
            ..Rig::default()
        },
        Rig {
            predeformation_mm: -1.0,
            ..Rig::default()
        },
        Rig {
            room_degc: f64::NAN,
            ..Rig::default()
        },
        Rig {
            wire: Wire {
                substep_s: 0.0,
                ..Wire::default()
            },
            ..Rig::default()
        },
        with_spring(Spring { rings: 0, ..spring }),
        with_spring(Spring {
            wire_diameter_mm: -0.75,
            ..spring
        }),
        with_spring(Spring {
            martensite_modulus_gpa: 68.0,
            ..spring
        }),
        with_law(Transformation {
            martensite_start_degc: 8.0,
            ..law
        }),
        with_law(Transformation {
            austenite_finish_degc: f64::NAN,
            ..law
        }),
        with_law(Transformation {
            austenite_slope_mpa_per_k: 0.0,
            ..law
        }),
    ];
    for rig in rigs {
        let refused = Plant::new(rig);
        assert!(
            matches!(refused, Err(RigError::OutOfRange { .. })),
            "{refused:?}"
        );
    }
}

#[test]
fn an_experiment_that_cannot_be_run_is_refused() {
    let default = Experiment::default;
    // Beyond what 2 A heat to, below the room, no number.
    for target in [500.0, 10.0, f64::NAN] {
        let experiment = Experiment {
            targets_degc: vec![60.0, target],
            ..default()
        };
        match experiment.record(1) {
            Err(RigError::TargetNotReached { reached_degc, .. }) => {
                assert!(reached_degc.is_finite());
            }
            other => assert!(other.is_err(), "{target} degC: a recording"),
        }
        assert!(matches!(
            experiment.schedule(),
            Err(RigError::TargetNotReached { .. })
        ));
    }
    let sensor = |accuracy| Sensor { accuracy };
    for experiment in [
        Experiment {
            current_a: f64::NAN,
            ..default()
        },
        Experiment {
            rest_s: -1.0,
            ..default()
        },
        Experiment {
            sample_interval_s: 0.0,
            ..default()
        },
        Experiment {
            sample_interval_s: f64::NAN,
            ..default()
        },
        Experiment {
            thermocouple: sensor(-1.0),
            ..default()
        },
        Experiment {
            lvdt: sensor(f64::INFINITY),
            ..default()
        },
    ] {
        assert!(matches!(
            experiment.record(1),
            Err(RigError::OutOfRange { .. })
        ));
    }
}
