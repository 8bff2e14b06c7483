//! The inverse of the whole chain finds what the chain gave, in any units.

use crate::common::stages::{Constants, Owned};
use crate::common::{OPERATORS, build, levels, plane, rng, weights};
use hysteron_core::{Direction, Operator, Plane, Sample, StageState, Status, Target, Wanted};
use rand::RngExt;
use rand::rngs::StdRng;

/// A drive that holds a temperature at which the operators' input is within the plane.
fn drive(rng: &mut StdRng, owned: &Owned<f64>, plane: &Plane<f64>, load: Option<f64>) -> f64 {
    let axis = owned.stages().axis;
    let input = plane.bottom() + rng.random::<f64>() * (plane.max() - plane.bottom());
    let temperature = axis.backward(plane, axis.load.at(load).unwrap(), Direction::Rising, input);
    owned
        .body()
        .map_or(temperature, |body| body.hold(temperature))
}

/// Everything far from zero: the numbers lose digits, and their rounding has to be known.
fn far(rng: &mut StdRng, constants: &mut Constants, plane: &Plane<f64>) {
    let span = plane.max() - plane.bottom();
    // One of them alone, or all: the rounding of one would hide that of the others.
    let which = rng.random_range(0..5);
    let mut away = |n: usize| {
        let size = span * 10f64.powf(rng.random_range(0.0..9.0));
        let sign = if rng.random() { size } else { -size };
        if which == n || which == 4 { sign } else { 0.0 }
    };
    let (spacing, shift, ambient, offset) = (away(0), away(1), away(2), away(3));
    let Constants {
        spacing: corners,
        knots,
        up,
        down,
        ..
    } = constants;
    if !corners.is_empty() {
        let axis = [corners, knots, up, down].into_iter().flatten();
        axis.for_each(|x| *x += spacing);
    }
    if constants.loads.is_empty() && !constants.spacing.is_empty() {
        constants
            .body
            .iter_mut()
            .for_each(|body| body[0] += spacing);
    }
    constants.shifts.iter_mut().for_each(|s| *s += shift);
    constants
        .body
        .iter_mut()
        .for_each(|body| body[0] += ambient);
    constants.offset += offset;
    constants.offsets.iter_mut().for_each(|o| *o -= offset);
}

#[test]
fn outputs_of_the_chain_are_met_by_its_inverse() {
    let mut worst = 0.0_f64;
    for seed in 0..1200 {
        let mut rng = rng(seed);
        let operator = OPERATORS[seed as usize / 3 % 3];
        let k = levels(&mut rng, 20);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let (model, mut there) = build(plane, operator, &weights);
        let mut constants = Constants::random(&mut rng, &plane).of(operator);
        // What a ring gives can need a swing beyond the operators afterwards.
        constants.ring = None;
        // Relays jump past a target that is off by rounding: body and spacing alone, whose outputs
        // have none.
        let is_relay = operator == Operator::Relay;
        if is_relay {
            constants.lag = 0.0;
            constants.offset = 0.0;
            for list in [
                &mut constants.sums,
                &mut constants.outputs,
                &mut constants.coefficients,
                &mut constants.taus,
                &mut constants.loads,
                &mut constants.shifts,
                &mut constants.scales,
                &mut constants.gains,
                &mut constants.offsets,
                &mut constants.knots,
                &mut constants.up,
                &mut constants.down,
            ] {
                list.clear();
            }
        }
        let is_far = seed % 3 == 0 && !is_relay;
        if is_far {
            far(&mut rng, &mut constants, &plane);
        }
        let owned = constants.map(|v| v);
        let (stages, inverse) = (owned.stages(), model.inverse().unwrap());
        stages.check(&model).unwrap();
        let mut past = StageState::default();
        let range = model.total() + 1e-9;
        for n in 0..60 {
            let load = Some(rng.random_range(-4.0..8.0));
            // So long that each stage moves by a part that is more than rounding.
            let dt = Some(rng.random_range(0.05..3.0));
            let input = drive(&mut rng, &owned, &plane, load);
            let sample = Sample { input, dt, load };
            let (mut state, mut memory) = (there.clone(), past);
            let y = stages
                .step(&model, &mut there, &mut past, sample)
                .unwrap()
                .output;
            let wanted = Wanted {
                dt,
                load,
                ..Target::new(y).into()
            };
            let mut twin = (state.clone(), memory);
            let found = stages
                .invert(&inverse, &mut state, &mut memory, wanted)
                .unwrap();
            let sample = Sample {
                input: found.input,
                dt,
                load,
            };
            let met = stages
                .step(&model, &mut twin.0, &mut twin.1, sample)
                .unwrap()
                .output;
            assert_eq!(
                found.status,
                Status::Ok,
                "{seed}, {n}: {met} for {y} {constants:?}"
            );
            // On from there: exactly at a level, too.
            if rng.random() {
                (there, past) = (state, memory);
            }
            if !is_far {
                worst = worst.max((met - y).abs() / range);
            }
        }
    }
    println!("outputs of the chain met by its inverse: up to {worst:.1e} of the range");
    assert!(worst < 1e-9, "{worst:e}");
}

/// Powers of two, so that no digit changes with the units.
struct Units {
    input: f64,
    effective: f64,
    temperature: f64,
    drive: f64,
    time: f64,
    load: f64,
    sum: f64,
    output: f64,
}

impl Units {
    fn random(rng: &mut StdRng, constants: &Constants) -> Self {
        let mut unit = || [2f64.powi(-80), 1.0, 2f64.powi(80)][rng.random_range(0..3)];
        let input = unit();
        let effective = if constants.spacing.is_empty() {
            input
        } else {
            unit()
        };
        let temperature = if constants.scales.is_empty() {
            effective
        } else {
            unit()
        };
        let drive = if constants.body.is_none() {
            temperature
        } else {
            unit()
        };
        let sum = unit();
        let output = if constants.gains.is_empty() {
            sum
        } else {
            unit()
        };
        let (time, load) = (unit(), unit());
        Self {
            input,
            effective,
            temperature,
            drive,
            time,
            load,
            sum,
            output,
        }
    }

    fn of(&self, constants: &Constants) -> Constants {
        let all = |values: &[f64], unit: f64| values.iter().map(|v| v * unit).collect();
        Constants {
            body: constants.body.map(|[ambient, gain, heating, cooling]| {
                [
                    ambient * self.temperature,
                    gain * (self.temperature / self.drive),
                    heating * self.time,
                    cooling * self.time,
                ]
            }),
            latent: constants.latent * self.temperature,
            loads: all(&constants.loads, self.load),
            shifts: all(&constants.shifts, self.effective),
            scales: all(&constants.scales, self.effective / self.temperature),
            gains: all(&constants.gains, self.output / self.sum),
            offsets: all(&constants.offsets, self.output),
            knots: all(&constants.knots, self.effective),
            up: all(&constants.up, self.effective),
            down: all(&constants.down, self.effective),
            spacing: all(&constants.spacing, self.effective),
            sums: all(&constants.sums, self.output),
            outputs: all(&constants.outputs, self.output),
            coefficients: constants.coefficients.clone(),
            taus: all(&constants.taus, self.time),
            lag: constants.lag * self.time,
            ring: constants
                .ring
                .map(|[frequency, damping]| [frequency / self.time, damping]),
            offset: constants.offset * self.output,
            falling: constants.falling,
        }
    }
}

#[test]
fn the_units_do_not_matter() {
    let mut missed = 0;
    for seed in 0..600 {
        let mut rng = rng(5000 + seed);
        let operator = OPERATORS[seed as usize % 3];
        let k = levels(&mut rng, 12);
        let plane = plane(&mut rng, k);
        let weights = weights(&mut rng, k);
        let constants = Constants::random(&mut rng, &plane).of(operator);
        let units = Units::random(&mut rng, &constants);
        let scaled = units.of(&constants);
        let other_plane = Plane::new(plane.min() * units.input, plane.max() * units.input, k);
        let other_weights: Vec<f64> = weights.iter().map(|mu| mu * units.sum).collect();
        let (one, mut state) = build(plane, operator, &weights);
        let (other, mut other_state) = build(other_plane.unwrap(), operator, &other_weights);
        let (constants, scaled) = (constants.map(|v| v), scaled.map(|v| v));
        let (stages, others) = (constants.stages(), scaled.stages());
        let (inverse, other_inverse) = (one.inverse().unwrap(), other.inverse().unwrap());
        let (mut memory, mut other_memory) = (StageState::default(), StageState::default());
        let (low, high) = one.output_range();
        for n in 0..40 {
            let load = rng.random_range(-4.0..8.0);
            let dt = rng.random_range(0.0..2.0);
            let (now, then) = (Some(load), Some(load * units.load));
            if rng.random_bool(0.3) {
                let input = drive(&mut rng, &constants, &plane, now);
                let sample = Sample {
                    input,
                    dt: Some(dt),
                    load: now,
                };
                let expected = stages.step(&one, &mut state, &mut memory, sample).unwrap();
                let sample = Sample {
                    input: input * units.drive,
                    dt: Some(dt * units.time),
                    load: then,
                };
                let found = others
                    .step(&other, &mut other_state, &mut other_memory, sample)
                    .unwrap();
                assert_eq!(found.output, expected.output * units.output, "{seed}, {n}");
                continue;
            }
            let sum = low + rng.random_range(-0.1..1.1) * (high - low);
            let loaded = stages.axis.load.at(now).unwrap();
            let outward = if constants.falling { -sum } else { sum };
            let output = constants.offset + loaded.offset + loaded.gain * outward;
            let headings = [None, Some(Direction::Rising), Some(Direction::Falling)];
            let heading = headings[rng.random_range(0..3)];
            let tolerance = [0.0, 0.01 * (high - low)][rng.random_range(0..2)];
            let ends = [0, 1].map(|_| drive(&mut rng, &constants, &plane, now));
            let range = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            let hold = |drive| constants.body().map_or(drive, |body| body.rest(drive));
            let stays = (hold(range.0), hold(range.1));
            let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
            let wanted = Wanted {
                target: Target {
                    output,
                    heading,
                    tolerance,
                },
                dt: Some(dt),
                load: now,
                drive: [range, everywhere][rng.random_range(0..2)],
                horizon: [0.0, 0.5][rng.random_range(0..2)],
                temperature: [stays, everywhere][rng.random_range(0..2)],
            };
            let ends = |(low, high): (f64, f64), unit: f64| (low * unit, high * unit);
            let other_wanted = Wanted {
                target: Target {
                    output: output * units.output,
                    heading,
                    tolerance: tolerance * units.output,
                },
                dt: Some(dt * units.time),
                load: then,
                drive: ends(wanted.drive, units.drive),
                horizon: wanted.horizon * units.time,
                temperature: ends(wanted.temperature, units.temperature),
            };
            let expected = stages
                .invert(&inverse, &mut state, &mut memory, wanted)
                .unwrap();
            let found = others
                .invert(
                    &other_inverse,
                    &mut other_state,
                    &mut other_memory,
                    other_wanted,
                )
                .unwrap();
            assert_eq!(found.status, expected.status, "{seed}, {n}");
            assert_eq!(found.input, expected.input * units.drive, "{seed}, {n}");
            missed += u32::from(found.status != Status::Ok);
        }
    }
    assert!(missed > 1000, "{missed}");
}
