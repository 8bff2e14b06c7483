//! Profiles that determine every operator.

use hysteron::{
    Design, DesignOptions, Error, Excitation, Operator, Plane, Rates, design, excitation,
};

const RATES: Rates = Rates {
    heating: 3.0,
    cooling: 0.8,
};

fn options(levels: usize) -> DesignOptions {
    DesignOptions::new(Plane::new(20.0, 80.0, levels).unwrap(), RATES)
}

fn determined(design: &Design) -> usize {
    design.count(Excitation::Determined)
}

#[test]
fn every_operator_is_determined_in_the_least_travel() {
    for operator in [Operator::Mkp, Operator::Kp, Operator::Relay] {
        for levels in [2, 3, 10, 20, 40] {
            let options = DesignOptions {
                operator,
                ..options(levels)
            };
            let count = options.plane.operators();
            let profile = design(&options, &[]).unwrap();
            assert_eq!(determined(&profile), count, "{operator:?}, K = {levels}");
            assert_eq!(profile.corners, count);
            let travel: f64 = profile
                .legs
                .iter()
                .map(|leg| (leg.to - leg.from).abs())
                .sum();
            // Relays set out half a step further up and are stopped at the top level.
            let least = count as f64 * options.plane.step();
            assert!(
                (travel - least).abs()
                    <= 1e-9 * least
                        + if operator == Operator::Relay {
                            options.plane.step()
                        } else {
                            0.0
                        }
            );
            let range = options.plane.bottom()..=options.plane.max();
            assert!(profile.input.iter().all(|t| range.contains(t)));
        }
    }
}

#[test]
fn one_sample_a_level_is_enough() {
    let plain = options(12);
    let options = DesignOptions {
        step_s: Some(plain.plane.step() / RATES.heating),
        ..plain
    };
    let profile = design(&options, &[]).unwrap();
    assert_eq!(determined(&profile), 78);
    assert!(profile.time.len() < design(&plain, &[]).unwrap().time.len() / 5);
}

#[test]
fn more_time_is_never_worse() {
    for levels in [2, 7, 16] {
        let full = design(&options(levels), &[]).unwrap();
        let (mut operators, mut corners, mut refused) = (0, 0, 0);
        for percent in 1..=100 {
            let budget = full.duration_s() * f64::from(percent) / 100.0;
            let options = DesignOptions {
                budget_s: Some(budget),
                ..options(levels)
            };
            let Ok(profile) = design(&options, &[]) else {
                refused += 1;
                continue;
            };
            assert!(profile.duration_s() <= budget * (1.0 + 1e-9));
            assert!(determined(&profile) >= operators && profile.corners >= corners);
            assert!((profile.full_duration_s - full.duration_s()).abs() < 1e-6);
            (operators, corners) = (determined(&profile), profile.corners);
            // Whatever the rings are, the widest is among them.
            assert_eq!(profile.legs[0], full.legs[0]);
        }
        assert_eq!(operators, options(levels).plane.operators());
        assert!(refused > 0);
    }
}

/// A recording with loops between levels, such as nobody plans.
fn wandering(turns: &[f64]) -> Vec<f64> {
    let (_, input) = hysteron::ramps(turns, RATES, 0.2);
    input
}

#[test]
fn a_recording_is_made_complete() {
    let recordings = [
        wandering(&[15.0, 85.0, 18.0]),
        wandering(&[25.0, 61.3, 33.2, 70.0, 41.7, 52.0, 20.0]),
        wandering(&[15.0, 85.0, 26.6, 73.4, 33.3, 66.0]),
    ];
    for operator in [Operator::Mkp, Operator::Relay] {
        let options = DesignOptions {
            operator,
            ..options(10)
        };
        let full = design(&options, &[]).unwrap();
        for some in [
            &recordings[..1],
            &recordings[1..2],
            &recordings[2..],
            &recordings,
        ] {
            let inputs: Vec<&[f64]> = some.iter().map(Vec::as_slice).collect();
            let profile = design(&options, &inputs).unwrap();
            assert_eq!(determined(&profile), 55);
            assert!(profile.duration_s() <= full.duration_s() + 1e-9);
            if some[0] == recordings[0] {
                // A major loop at least.
                assert!(profile.duration_s() < 0.9 * full.duration_s());
            }
            // As one recording, the profile carried out after the last of them.
            let mut joined = inputs.clone();
            let appended = [inputs[inputs.len() - 1], &profile.input].concat();
            *joined.last_mut().unwrap() = &appended;
            let after = excitation(&joined, options.plane, operator).unwrap();
            assert!(after.iter().all(|class| *class == Excitation::Determined));
        }
    }
}

#[test]
fn nothing_is_left_after_the_profile_itself() {
    let first = design(&options(15), &[]).unwrap();
    let second = design(&options(15), &[&first.input]).unwrap();
    assert!(second.time.is_empty() && second.legs.is_empty());
    assert_eq!(second.corners, 120);
    assert_eq!(second.recorded.as_ref(), Some(&first.excitation));
    // After half of it, only the rest is asked for.
    let half = &first.input[..first.input.len() / 2];
    let rest = design(&options(15), &[half]).unwrap();
    assert!(rest.duration_s() < 0.9 * first.duration_s());
    assert_eq!(determined(&rest), 120);
}

#[test]
fn what_cannot_be_is_refused() {
    let plain = options(10);
    let says = |options: DesignOptions, recorded: &[&[f64]]| {
        let error = design(&options, recorded).unwrap_err();
        assert!(matches!(error, Error::Design(_)), "{error}");
        error.to_string()
    };
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let heating = Rates {
            heating: rate,
            ..RATES
        };
        assert!(
            says(
                DesignOptions {
                    rates: heating,
                    ..plain
                },
                &[]
            )
            .contains("heating rate")
        );
        let cooling = Rates {
            cooling: rate,
            ..RATES
        };
        assert!(
            says(
                DesignOptions {
                    rates: cooling,
                    ..plain
                },
                &[]
            )
            .contains("cooling rate")
        );
        let budget_s = Some(rate);
        assert!(says(DesignOptions { budget_s, ..plain }, &[]).contains("budget"));
    }
    // Said with the time that is needed, and that time is enough.
    let short = says(
        DesignOptions {
            budget_s: Some(60.0),
            ..plain
        },
        &[],
    );
    let least = (80.0 - plain.plane.bottom()) / 3.0 + 60.0 / 0.8;
    assert!(
        short.contains(&format!("{:.4} min", least / 60.0)),
        "{short}"
    );
    design(
        &DesignOptions {
            budget_s: Some(least),
            ..plain
        },
        &[],
    )
    .unwrap();
    assert!(
        says(
            DesignOptions {
                step_s: Some(3.0),
                ..plain
            },
            &[]
        )
        .contains("more than one level")
    );
    assert!(says(plain, &[&[0.0, 5.0]]).contains("between 0 and 5"));
    assert!(says(plain, &[&[30.0, 40.0], &[]]).contains("recording 2 of 2"));
    assert!(matches!(
        design(&plain, &[&[30.0, 50.0, f64::NAN]]),
        Err(Error::Core(_))
    ));
}

#[test]
fn a_profile_stays_in_its_range_and_keeps_its_rates() {
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};
    let mut random = StdRng::seed_from_u64(5);
    for n in 0..300 {
        let low = random.random_range(-200.0..200.0) * 10f64.powi(random.random_range(-3..3));
        let high = low + random.random_range(0.01..300.0);
        let levels = random.random_range(2..40);
        let rates = Rates {
            heating: random.random_range(0.01..50.0),
            cooling: random.random_range(0.01..50.0),
        };
        let mut options = DesignOptions::within((low, high), levels, rates).unwrap();
        options.operator = [Operator::Mkp, Operator::Kp, Operator::Relay][n % 3];
        let loops = (high - low) * (1.0 / rates.heating + 1.0 / rates.cooling);
        if random.random_bool(0.5) {
            options.budget_s = Some(loops * random.random_range(1.5..20.0));
        }
        let found = design(&options, &[]).unwrap();
        let what = format!("{low} to {high}, {levels} levels, {:?}", options.operator);
        let inside = |input: &f64| (low..=high).contains(input);
        assert!(found.input.iter().all(inside), "{what}");
        let travelled = |way: f64| (way - low).abs() <= 0.51 * (high - low);
        assert!(travelled(found.input[0]), "{what}");
        // What is left of a difference of two large numbers.
        let rounding = 1e-6 * (1.0 + low.abs().max(high.abs()) / (high - low));
        for (time, input) in found.time.windows(2).zip(found.input.windows(2)) {
            let rate = (input[1] - input[0]) / (time[1] - time[0]);
            let most = if rate > 0.0 {
                rates.heating
            } else {
                rates.cooling
            };
            assert!(
                rate.abs() <= most * (1.0 + rounding),
                "{what}: {rate} of {most}"
            );
        }
        let within = |most: f64| found.duration_s() <= most * (1.0 + 1e-9);
        assert!(options.budget_s.is_none_or(within), "{what}");
    }
}
