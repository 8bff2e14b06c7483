//! The watch: what was learned from a channel that stands still is undone, and nobody else is
//! called stuck.

use crate::common;

use common::{Learner, METHODS, OPERATORS, build, dense, rng, unit_plane};
use hysteron_core::{Adaptation, Method, Operator, Outcome, Plane, operator_count};
use rand::RngExt;
use rand::rngs::StdRng;

/// A plant, what may happen to it, and the learner that follows it.
struct Rig {
    rng: StdRng,
    learner: Learner,
    plant: common::Owned<f64>,
    /// Range of the output.
    range: f64,
    noise: f64,
    /// Step of the sensor's readings; 0 for none.
    quantum: f64,
    /// Offset, gain and shift of the plant, and how they go on from sample to sample.
    now: [f64; 3],
    ramp: [f64; 3],
}

impl Rig {
    fn new(seed: u64, method: Method<f64>) -> Self {
        let mut rng = rng(seed);
        let k = rng.random_range(5..14);
        let plane = unit_plane(k);
        let operator = OPERATORS[seed as usize / 2 % 3];
        let weights = dense(&mut rng, k);
        let plant = build(plane, operator, &weights);
        let (off, on) = plant.0.output_range();
        let range = on - off;
        let method = match method {
            Method::LeastSquares {
                forgetting,
                correlation,
                ..
            } => Method::LeastSquares {
                forgetting,
                correlation,
                noise: 0.02 * range,
                spread: 0.3 * range / (operator_count(k) as f64).sqrt(),
            },
            other => other,
        };
        let options = Adaptation {
            method,
            offset_share: (operator_count(k) as f64).sqrt() * 0.2,
            ..Adaptation::default()
        };
        let learner = Learner::new(plane, operator, &weights, options);
        Self {
            learner,
            plant,
            range,
            noise: [0.0, 0.002, 0.01][rng.random_range(0..3)] * range,
            quantum: [0.0, 0.001, 0.01][rng.random_range(0..3)] * range,
            now: [0.0, 1.0, 0.0],
            ramp: [0.0; 3],
            rng,
        }
    }

    fn measure(&mut self, input: f64) -> f64 {
        for (now, ramp) in self.now.iter_mut().zip(self.ramp) {
            *now += ramp;
        }
        let [offset, gain, shift] = self.now;
        let (plant, state) = &mut self.plant;
        let output = plant.step(state, input - shift).unwrap().output;
        self.sensed(offset + gain * output)
    }

    /// The sensor's reading of an output: with noise, in steps.
    fn sensed(&mut self, output: f64) -> f64 {
        let noisy = output + self.noise * self.rng.random_range(-1.0..1.0);
        match self.quantum {
            0.0 => noisy,
            quantum => (noisy / quantum).round() * quantum,
        }
    }

    fn parameters(&self) -> (Vec<f64>, f64) {
        let estimator = &self.learner.estimator;
        (estimator.parameters().to_vec(), estimator.offset())
    }
}

/// Loops over at least half of the plane, `samples` to each, half of them steady.
fn loops(rng: &mut StdRng, plane: &Plane<f64>, count: usize, samples: usize) -> Vec<f64> {
    let steady = rng.random_bool(0.5);
    loops_of(rng, plane, count, samples, steady)
}

/// The same, all of one size if `steady`, as triangles or sines.
fn loops_of(
    rng: &mut StdRng,
    plane: &Plane<f64>,
    count: usize,
    samples: usize,
    steady: bool,
) -> Vec<f64> {
    let width = plane.max() - plane.bottom();
    let mut inputs = Vec::new();
    let ends = |rng: &mut StdRng| {
        let low = plane.bottom() + rng.random_range(0.0..0.2) * width;
        (low, plane.max() - rng.random_range(0.0..0.2) * width)
    };
    let steady = steady.then(|| ends(rng));
    let sine = rng.random_bool(0.5);
    while inputs.len() < count {
        let (low, high) = steady.unwrap_or_else(|| ends(rng));
        let way = |n: usize| match sine {
            true => 0.5 - 0.5 * (std::f64::consts::TAU * n as f64 / samples as f64).cos(),
            false => 1.0 - (2.0 * n as f64 / samples as f64 - 1.0).abs(),
        };
        inputs.extend((0..samples).map(|n| low + (high - low) * way(n)));
    }
    inputs.truncate(count);
    inputs
}

/// The last reading, 0, or that of a rig without an actuator.
const FROZEN: [fn(f64) -> f64; 3] = [|last| last, |_| 0.0, |last| -last];

#[test]
fn what_was_learned_from_a_frozen_output_is_undone() {
    let mut cycles = [vec![], vec![]];
    for seed in 0..600 {
        let method = METHODS[seed as usize % METHODS.len()];
        let mut rig = Rig::new(seed, method);
        let samples = rig.rng.random_range(60..400);
        let plane = *rig.learner.model.plane();
        let steady = rig.rng.random_bool(0.5);
        let inputs = loops_of(&mut rig.rng, &plane, 12 * samples, samples, steady);
        let frozen = rig.rng.random_range(3 * samples..6 * samples);
        rig.ramp[0] = 0.3 * rig.range / inputs.len() as f64 * rig.rng.random_range(-1.0..1.0);
        let (mut before, mut last) = (Vec::new(), 0.0);
        let mut found = None;
        for (n, &input) in inputs.iter().enumerate() {
            let measured = match n < frozen {
                true => {
                    before.push(rig.parameters());
                    last = rig.measure(input);
                    last
                }
                false => {
                    let held = FROZEN[seed as usize / 6 % 3](last);
                    rig.sensed(held)
                }
            };
            let outcome = rig.learner.step(input, measured).unwrap().outcome;
            if outcome.is_stuck() {
                found = found.or(Some(n));
            }
            let may = matches!(
                outcome,
                Outcome::OutputStuck | Outcome::AtRest | Outcome::Rejected
            );
            assert!(found.is_none() || may, "{seed}, {n}: {outcome:?}");
        }
        let late = found.expect("found") - frozen;
        // Two cycles of the largest loop are at most asked of a run, whose band may hold the output
        // for one before it froze, and of the span lately, which is that of up to a cycle before.
        // Of 3000 other seeds four took more than two cycles, one 3.3.
        assert!(late <= 4 * samples, "{seed}: {late} of {samples}");
        cycles[usize::from(steady)].push(late as f64 / samples as f64);
        let at = before.iter().rposition(|kept| *kept == rig.parameters());
        assert!(
            at.is_some_and(|at| frozen - at <= 2 * samples),
            "{seed}: {at:?}"
        );
        let (anew, _) = build(plane, rig.learner.model.operator(), &rig.parameters().0);
        assert_eq!(
            rig.learner.model.output_range(),
            anew.output_range(),
            "{seed}"
        );
    }
    for cycles in &mut cycles {
        cycles.sort_by(f64::total_cmp);
        assert!(
            cycles[cycles.len() / 2] <= 1.0,
            "a cycle is enough for most"
        );
        // The half is for what was larger before, and for what moved in the band.
        assert!(cycles[cycles.len() * 9 / 10] <= 1.5, "nearly all");
    }
}

#[test]
fn no_plant_that_changes_is_called_stuck() {
    for seed in 0..1200 {
        let method = METHODS[seed as usize % METHODS.len()];
        let mut rig = Rig::new(seed, method);
        let samples = rig.rng.random_range(20..400);
        let plane = *rig.learner.model.plane();
        let inputs = loops(&mut rig.rng, &plane, 12 * samples, samples);
        let count = inputs.len();
        let mut change = |most: f64| rig.rng.random_range(-most..most);
        let mut offset = change(2.0) * rig.range;
        let mut gain = 2.0_f64.powf(change(1.0));
        let shift = change(0.2) * (plane.max() - plane.bottom());
        if seed % 3 == 0 {
            // A stroke far smaller than the model's, of which a tenth is noise, is alive too. It is
            // so only while it changes by its own size, and without spikes. Of 1000 such plants 2
            // are called stuck with spikes, 19 with noise up to a percent of the model's range, and
            // 194 that jump or drift by up to twice that range: what they follow is lost in it.
            let small = rig.rng.random_range(0.02..0.2);
            rig.now[1] = small;
            rig.noise = rig.noise.min(0.05 * small * rig.range);
            rig.quantum = rig.quantum.min(0.1 * small * rig.range);
            offset *= small;
            gain *= small;
        }
        let at = rig.rng.random_range(0..count);
        let step = seed % 2 == 0;
        if !step {
            let over = 1.0 / count as f64;
            rig.ramp = [offset * over, (gain - rig.now[1]) * over, shift * over];
        }
        for (n, &input) in inputs.iter().enumerate() {
            if step && n == at {
                rig.now = [offset, gain, shift];
            }
            let spike = seed % 5 == 0 && seed % 3 > 0 && rig.rng.random_bool(0.01);
            let measured = rig.measure(input) * if spike { 4.0 } else { 1.0 };
            let outcome = rig.learner.step(input, measured).unwrap().outcome;
            assert!(!outcome.is_stuck(), "{seed}, {n}: {outcome:?}");
        }
    }
}

/// The drive rests, at the same place or with noise, and so does the output, but for its noise.
#[test]
fn a_drive_that_rests_is_not_stuck() {
    for seed in 0..60 {
        let mut rig = Rig::new(seed, METHODS[seed as usize % METHODS.len()]);
        let plane = *rig.learner.model.plane();
        let inputs = loops(&mut rig.rng, &plane, 900, 200);
        let jitter = [0.0, 0.02, 0.2][seed as usize / 2 % 3] * plane.step();
        for n in 0..20_000 {
            let rest = inputs[n.min(899)];
            let input = rest + jitter * rig.rng.random_range(-1.0..1.0);
            let measured = rig.measure(input);
            let outcome = rig.learner.step(input, measured).unwrap().outcome;
            assert!(!outcome.is_stuck(), "{seed}, {n}: {outcome:?}");
        }
    }
}

/// The input's sensor goes on with one value and noise, while the plant goes through its loops.
#[test]
fn what_was_learned_at_a_frozen_input_is_undone() {
    for seed in 0..150 {
        let mut rig = Rig::new(seed, METHODS[seed as usize % METHODS.len()]);
        // Relays see levels alone: noise between two of them is motion to them, elsewhere none.
        if rig.learner.model.operator() == Operator::Relay {
            continue;
        }
        let plane = *rig.learner.model.plane();
        let samples = rig.rng.random_range(60..400);
        let inputs = loops(&mut rig.rng, &plane, 12 * samples, samples);
        let frozen = rig.rng.random_range(3 * samples..6 * samples);
        let mut before = Vec::new();
        let mut found = false;
        for (n, &input) in inputs.iter().enumerate() {
            let measured = rig.measure(input);
            let seen = match n < frozen {
                true => {
                    before.push(rig.parameters());
                    input
                }
                false => inputs[frozen] + 0.1 * plane.step() * rig.rng.random_range(-1.0..1.0),
            };
            let outcome = rig.learner.step(seen, measured).unwrap().outcome;
            assert!(outcome != Outcome::OutputStuck, "{seed}, {n}");
            found |= outcome == Outcome::InputStuck;
        }
        let now = rig.parameters();
        assert!(found && before.contains(&now), "{seed}: {found}");
    }
}

/// The channel comes back: learning goes on.
#[test]
fn learning_goes_on_where_the_channel_is_back() {
    for seed in 0..60 {
        let mut rig = Rig::new(seed, METHODS[seed as usize % METHODS.len()]);
        let plane = *rig.learner.model.plane();
        let inputs = loops(&mut rig.rng, &plane, 6000, 200);
        let mut last = Outcome::AtRest;
        let mut stuck = 0;
        for (n, &input) in inputs.iter().enumerate() {
            let measured = rig.measure(input);
            let measured = if (1000..3000).contains(&n) {
                0.0
            } else {
                measured
            };
            last = rig.learner.step(input, measured).unwrap().outcome;
            stuck += usize::from(last.is_stuck());
            assert!(n < 3600 || !last.is_stuck(), "{seed}, {n}");
        }
        assert!(stuck > 0, "{seed}: {last:?}");
    }
}
