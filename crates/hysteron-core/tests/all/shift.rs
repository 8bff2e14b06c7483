//! The estimator of the shift finds an unknown load, whatever the model, and stays sane whatever
//! it is fed.

use crate::common;

use common::{OPERATORS, Owned, build, dense, inputs, levels, plane, rng, weights};
use hysteron_core::{
    Axis, Behind, Body, Creep, Error, Lag, Latent, Load, Model, Operator, Outcome, Plane, Sample,
    ShiftEstimator, ShiftOptions, StageState, Stages, State, Target, Turn, Wanted,
};
use rand::RngExt;
use rand::rngs::StdRng;

const SEEDS: u64 = 150;

/// Samples while the temperature moves by one level.
const DENSE: usize = 30;

/// A random model that is not all zero.
fn random(rng: &mut StdRng, operator: Operator, most: usize) -> Owned<f64> {
    let k = levels(rng, most).max(3);
    let plane = plane(rng, k);
    // A staircase with few steps tells nothing between them.
    let mut drawn = std::iter::repeat_with(|| match operator {
        Operator::Relay => dense(rng, k),
        Operator::Mkp | Operator::Kp => weights(rng, k),
    });
    let drawn = drawn.find(|drawn| drawn.iter().any(|mu| *mu > 0.0));
    build(plane, operator, &drawn.unwrap())
}

/// A plant and its estimator, and how far they are apart.
struct Rig<'a> {
    model: &'a Model<f64, Vec<f64>>,
    stages: Stages<'a, f64>,
    there: State<f64, Vec<Turn<f64>>>,
    there_memory: StageState<f64>,
    state: State<f64, Vec<Turn<f64>>>,
    memory: StageState<f64>,
    estimator: ShiftEstimator<f64>,
    phase: usize,
}

impl<'a> Rig<'a> {
    fn new(owned: &'a Owned<f64>, stages: Stages<'a, f64>) -> Self {
        let (model, state) = owned;
        let options = ShiftOptions::usual(model, &stages);
        Self {
            estimator: ShiftEstimator::new(options, model, &stages).unwrap(),
            model,
            stages,
            there: state.clone(),
            there_memory: StageState::default(),
            state: state.clone(),
            memory: StageState::default(),
            phase: 0,
        }
    }

    fn reach(&self) -> f64 {
        self.estimator.options().reach
    }

    /// One sample of a triangle that crosses the whole plane at every shift within reach.
    fn sample(&mut self, shift: f64, wrong: f64) -> Outcome {
        let (plane, reach) = (self.model.plane(), self.reach());
        let (low, high) = (plane.bottom() - reach, plane.max() + reach);
        let period = 4 * DENSE * plane.levels();
        let part = (self.phase % period) as f64 / period as f64;
        self.phase += 1;
        let input = low + (high - low) * (1.0 - (2.0 * part - 1.0).abs());
        let mut sample = Sample::from(input - shift);
        sample.load = self.stages.axis.load.loads.first().copied();
        let plant = self
            .stages
            .step(self.model, &mut self.there, &mut self.there_memory, sample);
        sample.input = input;
        let measured = plant.unwrap().output + wrong;
        let (state, memory) = (&mut self.state, &mut self.memory);
        let learning =
            self.estimator
                .step(&self.stages, self.model, state, memory, sample, measured);
        learning.unwrap().outcome
    }

    /// Whole triangles.
    fn cycles(&mut self, count: usize, shift: f64) {
        for _ in 0..count * 4 * DENSE * self.model.plane().levels() {
            self.sample(shift, 0.0);
        }
    }

    /// How far the shift is off, in levels.
    fn off_by(&self, shift: f64) -> f64 {
        (self.estimator.shift() - shift).abs() / self.model.plane().step()
    }
}

/// A staircase tells a shift to within one step. The others tell it as exactly as the filter has
/// settled: a twentieth of a level.
fn close(operator: Operator) -> f64 {
    match operator {
        Operator::Relay => 1.01,
        Operator::Mkp | Operator::Kp => 0.05,
    }
}

#[test]
fn a_constant_shift_within_reach_is_found_in_six_cycles() {
    for seed in 0..SEEDS {
        let mut rng = rng(seed);
        for operator in OPERATORS {
            let owned = random(&mut rng, operator, 20);
            let mut rig = Rig::new(&owned, Stages::NONE);
            let shift = rng.random_range(-1.0..=1.0) * rig.reach();
            rig.cycles(6, shift);
            let off = rig.off_by(shift);
            assert!(off < close(operator), "{seed} {operator:?}: {off} levels");
        }
    }
}

#[test]
fn a_jump_of_the_shift_is_found_in_six_cycles() {
    for seed in 0..SEEDS {
        let mut rng = rng(seed);
        for operator in OPERATORS {
            let owned = random(&mut rng, operator, 20);
            let mut rig = Rig::new(&owned, Stages::NONE);
            let mut shift = || rng.random_range(-1.0..=1.0) * owned.0.plane().step();
            let half = 0.5 * owned.0.plane().levels() as f64;
            let (first, second) = (shift() * half, shift() * half);
            rig.cycles(6, first);
            rig.cycles(6, second);
            let off = rig.off_by(second);
            assert!(off < close(operator), "{seed} {operator:?}: {off} levels");
        }
    }
}

#[test]
fn one_wrong_reading_moves_the_shift_by_one_level_at_most_and_not_for_long() {
    for seed in 0..SEEDS {
        let mut rng = rng(seed);
        let owned = random(&mut rng, Operator::Mkp, 20);
        let mut rig = Rig::new(&owned, Stages::NONE);
        let shift = rng.random_range(-1.0..=1.0) * rig.reach();
        rig.cycles(6, shift);
        for _ in 0..rng.random_range(0..4 * DENSE * owned.0.plane().levels()) {
            rig.sample(shift, 0.0);
        }
        let before = rig.estimator.shift();
        // From invisible to absurd.
        let size = owned.0.total() * 10f64.powf(rng.random_range(-3.0..6.0));
        let wrong = if rng.random_bool(0.5) { size } else { -size };
        rig.sample(shift, wrong);
        let moved = (rig.estimator.shift() - before).abs() / owned.0.plane().step();
        assert!(moved <= 1.0 + 1e-9, "{seed}: {moved} levels");
        rig.cycles(2, shift);
        let off = rig.off_by(shift);
        assert!(off < 0.05, "{seed}: {off} levels after");
    }
}

#[test]
fn a_reading_far_outside_the_usual_moves_nothing() {
    for seed in 0..SEEDS {
        let mut rng = rng(seed);
        let owned = random(&mut rng, Operator::Mkp, 20);
        let mut rig = Rig::new(&owned, Stages::NONE);
        rig.cycles(3, 0.0);
        for _ in 0..100 {
            // The usual surprise is at least 1/1000 of the range, and the gate lets 12 of them in;
            // the scale of the start has long been forgotten.
            rig.sample(0.0, 0.0);
            let before = rig.estimator.clone();
            let outcome = rig.sample(0.0, owned.0.total() * rng.random_range(1.0..1e6));
            assert!(
                matches!(outcome, Outcome::Rejected | Outcome::AtRest),
                "{seed}"
            );
            assert_eq!(rig.estimator.shift(), before.shift());
            assert_eq!(rig.estimator.variance(), before.variance());
        }
    }
}

#[test]
fn nothing_is_learned_in_saturation_and_the_variance_stays() {
    for seed in 0..SEEDS {
        let mut rng = rng(seed);
        let owned = random(&mut rng, OPERATORS[seed as usize % 3], 20);
        let (model, mut state) = owned.clone();
        let stages = Stages::NONE;
        let options = ShiftOptions::usual(&model, &stages);
        let mut estimator = ShiftEstimator::new(options, &model, &stages).unwrap();
        let mut memory = StageState::default();
        for _ in 0..5000 {
            let above = rng.random_range(0.001..10.0) * options.reach;
            let sample = (model.plane().max() + above).into();
            let wrong = model.total() * rng.random_range(-2.0..2.0);
            let learning = estimator.step(&stages, &model, &mut state, &mut memory, sample, wrong);
            assert_ne!(learning.unwrap().outcome, Outcome::Learned, "{seed}");
            assert_eq!(estimator.shift(), 0.0);
            assert!(estimator.variance() <= options.spread * options.spread);
        }
    }
}

/// Random stages: some of body, load, spacing, creep and lag.
struct Parts {
    loads: [f64; 3],
    shifts: [f64; 3],
    scales: [f64; 3],
    gains: [f64; 3],
    offsets: [f64; 3],
    spacing: Vec<f64>,
    body: Option<Body<f64>>,
    creep: bool,
    lag: f64,
    falling: bool,
}

impl Parts {
    fn random(rng: &mut StdRng, plane: &Plane<f64>) -> Self {
        let corners = (0..=plane.levels()).scan(plane.bottom(), |x, _| {
            *x += plane.step() * rng.random_range(0.2..2.0);
            Some(*x)
        });
        let spacing = corners.collect();
        let width = plane.max() - plane.bottom();
        let body = Body {
            ambient: plane.bottom(),
            gain: width * rng.random_range(0.5..2.0),
            tau_heating: rng.random_range(0.1..5.0),
            tau_cooling: rng.random_range(0.1..5.0),
        };
        let mut three = |from: f64, to: f64| [0, 1, 2].map(|_| rng.random_range(from..to));
        Self {
            loads: [0.0, 1.0, 3.0],
            shifts: three(-width, width),
            scales: three(0.5, 2.0),
            gains: three(0.1, 3.0),
            offsets: three(-5.0, 5.0),
            spacing: if rng.random() { spacing } else { Vec::new() },
            body: rng.random_bool(0.5).then_some(body),
            creep: rng.random(),
            lag: if rng.random() { 0.3 } else { 0.0 },
            falling: rng.random(),
        }
    }

    fn stages(&self, loaded: bool) -> Stages<'_, f64> {
        let load = Load {
            loads: &self.loads,
            shifts: &self.shifts,
            scales: &self.scales,
            gains: &self.gains,
            offsets: &self.offsets,
        };
        let creep = Creep {
            coefficients: &[0.1, 0.05],
            taus: &[0.5, 5.0],
        };
        Stages {
            body: self.body,
            latent: Latent::NONE,
            axis: Axis {
                load: if loaded { load } else { Load::NONE },
                spacing: &self.spacing,
                ..Axis::PLAIN
            },
            behind: Behind {
                creep: if self.creep { creep } else { Creep::NONE },
                lag: Lag { tau: self.lag },
                ..Behind::NONE
            },
            offset: 1.5,
            falling: self.falling,
        }
    }
}

#[test]
fn whatever_comes_every_number_stays_a_number() {
    const HARD: [f64; 9] = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        f64::MIN,
        f64::MIN_POSITIVE,
        1e300,
        -1e-300,
        0.0,
    ];
    for seed in 0..SEEDS {
        let mut rng = rng(seed);
        let owned = random(&mut rng, OPERATORS[seed as usize % 3], 12);
        let (model, mut state) = owned;
        let plane = *model.plane();
        let parts = Parts::random(&mut rng, &plane);
        let loaded = rng.random();
        let stages = parts.stages(loaded);
        let options = ShiftOptions {
            gate: if rng.random() { 12.0 } else { 0.0 },
            burst: rng.random_range(1..10),
            movement: rng.random_range(0.0..0.2),
            walk: plane.step() * rng.random_range(0.0..2.0),
            ..ShiftOptions::usual(&model, &stages)
        };
        let mut estimator = ShiftEstimator::new(options, &model, &stages).unwrap();
        let mut memory = StageState::default();
        for input in inputs(&mut rng, &plane, 600) {
            let hard = |rng: &mut StdRng, usual: f64| match rng.random_range(0..30) {
                0 => HARD[rng.random_range(0..HARD.len())],
                _ => usual,
            };
            let measured = model.total() * rng.random_range(-3.0..3.0);
            let sample = Sample {
                input: hard(&mut rng, input),
                dt: (rng.random_range(0..20) > 0).then(|| hard(&mut rng, 0.1)),
                load: (rng.random_range(0..20) > 0).then(|| hard(&mut rng, 1.3)),
            };
            let measured = hard(&mut rng, measured);
            match rng.random_range(0..20) {
                0 => estimator.freeze(rng.random()),
                1 => estimator.realign(),
                2 => {
                    let shift = hard(&mut rng, plane.step());
                    assert_eq!(estimator.reset(shift).is_ok(), shift.is_finite());
                }
                3 => {
                    let target = Target::new(measured);
                    let wanted = Wanted {
                        dt: sample.dt,
                        load: sample.load,
                        ..target.into()
                    };
                    let inverse = model.inverse().unwrap();
                    let (state, memory) = (&mut state.clone(), &mut memory.clone());
                    if let Ok(found) = estimator.invert(&stages, &inverse, state, memory, wanted) {
                        assert!(!found.input.is_nan(), "{seed}");
                    }
                }
                _ => {
                    let before = (estimator.clone(), state.clone(), memory);
                    let step =
                        estimator.step(&stages, &model, &mut state, &mut memory, sample, measured);
                    if step.is_err() {
                        assert_eq!((estimator.clone(), state.clone(), memory), before);
                    }
                }
            }
            let (shift, variance) = (estimator.shift(), estimator.variance());
            assert!(shift.abs() <= options.reach, "{seed}: {shift}");
            let most = options.spread * options.spread;
            assert!((0.0..=most).contains(&variance), "{seed}: {variance}");
        }
    }
}

#[test]
fn the_slope_is_that_of_the_output_along_the_branch() {
    for seed in 0..SEEDS {
        let mut rng = rng(seed);
        let operator = OPERATORS[seed as usize % 2];
        let (model, mut state) = random(&mut rng, operator, 20);
        let plane = *model.plane();
        for input in inputs(&mut rng, &plane, 300) {
            let before = state.input();
            let output = model.step(&mut state, input).unwrap().output;
            // A little further along the branch, in a cell where the output is straight.
            let small = if input >= before { 1e-6 } else { -1e-6 } * plane.step();
            let inside = |x: f64| plane.clipped(x).is_none();
            if input == before || !inside(input) || !inside(input + 2.0 * small) {
                continue;
            }
            let next = input + small;
            let small = next - input;
            let there = model.step(&mut state.clone(), next);
            let there = there.unwrap().output;
            let slope = (there - output) / small;
            let found = model.slope(&state);
            // Rounding of the outputs over the small step. At a grid line or the end of a branch the
            // slope changes within the step.
            let rounding = f64::EPSILON * model.total() * plane.levels() as f64 / small.abs();
            let x = (input - plane.bottom()) / plane.step();
            let corner = state.turning_points().any(|turn| {
                let part = |x: f64| x - x.floor();
                let apart = (part(turn) - part(x)).abs();
                let near = apart.min(1.0 - apart) < 1e-5;
                near && turn != state.position()
            });
            let line = (x - x.round()).abs() < 1e-5;
            let close = (slope - found).abs() <= 8.0 * rounding + 1e-9 * found.abs();
            assert!(close || corner || line, "{seed}: {slope} {found} at {x}");
        }
    }
}

#[test]
fn a_load_is_told_by_its_shift_and_brings_gain_and_offset() {
    for seed in 0..SEEDS {
        let mut rng = rng(seed);
        let k = levels(&mut rng, 20).max(3);
        let plane = common::unit_plane(k);
        let (model, state) = &build(plane, Operator::Mkp, &dense(&mut rng, k));
        let width = model.plane().max() - model.plane().bottom();
        let load = Load {
            loads: &[0.0, 100.0, 250.0],
            shifts: &[0.0, 0.1 * width, 0.3 * width],
            scales: &[1.0, 1.05, 1.1],
            gains: &[1.0, 1.2, 1.3],
            offsets: &[0.0, 0.02 * model.total(), 0.05 * model.total()],
        };
        let axis = Axis {
            load,
            ..Axis::PLAIN
        };
        let stages = Stages {
            axis,
            ..Stages::NONE
        };
        let options = ShiftOptions::usual(model, &stages);
        let mut estimator = ShiftEstimator::new(options, model, &stages).unwrap();
        let (mut here, mut there) = (state.clone(), state.clone());
        let (mut memory, mut other) = (StageState::default(), StageState::default());
        let truth = rng.random_range(0.0..250.0);
        let told = rng.random_range(0.0..250.0);
        let period = 100 * model.plane().levels();
        for n in 0..8 * period {
            let part = (n % period) as f64 / period as f64;
            let input = model.plane().bottom() - 0.1 * width
                + 1.6 * width * (1.0 - (2.0 * part - 1.0).abs());
            let at = |load| Sample {
                load: Some(load),
                ..input.into()
            };
            let y = stages.step(model, &mut there, &mut other, at(truth));
            let y = y.unwrap().output;
            let step = estimator.step(&stages, model, &mut here, &mut memory, at(told), y);
            step.unwrap();
        }
        let found = estimator.load(&load, Some(told)).unwrap().unwrap();
        // A twentieth of a level, as load.
        let slope: f64 = 0.1 * width / 100.0;
        let close = 0.05 * model.plane().step() / slope;
        assert!((found - truth).abs() < close, "{seed}: {found} for {truth}");
    }
}

#[test]
fn single_precision_finds_the_shift_too() {
    for seed in 0..SEEDS {
        let mut rng = rng(seed);
        let k = levels(&mut rng, 20).max(3);
        let plane = common::unit_plane(k);
        let (model, mut state) = common::build_f32(&plane, Operator::Mkp, &dense(&mut rng, k));
        let mut there = state.clone();
        let stages = Stages::NONE;
        let options = ShiftOptions::usual(&model, &stages);
        let mut estimator = ShiftEstimator::new(options, &model, &stages).unwrap();
        let mut memory = StageState::default();
        let shift = rng.random_range(-1.0..=1.0) * options.reach;
        for n in 0..6 * 120 * k {
            let part = (n % (120 * k)) as f32 / (120 * k) as f32;
            let width = model.plane().max() - model.plane().bottom() + 2.0 * options.reach;
            let input =
                model.plane().bottom() - options.reach + width * (1.0 - (2.0 * part - 1.0).abs());
            let y = model.step(&mut there, input - shift).unwrap().output;
            let step = estimator.step(&stages, &model, &mut state, &mut memory, input.into(), y);
            step.unwrap();
        }
        let off = (estimator.shift() - shift).abs() / model.plane().step();
        assert!(off < 0.05, "{seed}: {off} levels");
    }
}

#[test]
fn options_out_of_range_are_refused_by_name() {
    let (model, _) = build(common::unit_plane(4), Operator::Mkp, &[1.0; 10]);
    let usual = ShiftOptions::usual(&model, &Stages::NONE);
    let bad = [f64::NAN, f64::INFINITY, -1.0];
    type Set = fn(&mut ShiftOptions<f64>, f64);
    let options: [(&str, Set); 7] = [
        ("noise", |o, v| o.noise = v),
        ("spread", |o, v| o.spread = v),
        ("walk", |o, v| o.walk = v),
        ("reach", |o, v| o.reach = v),
        ("dead_zone", |o, v| o.dead_zone = v),
        ("movement", |o, v| o.movement = v),
        ("gate", |o, v| o.gate = v),
    ];
    for (name, set) in options {
        for value in bad {
            let mut options = usual;
            set(&mut options, value);
            let refused = ShiftEstimator::new(options, &model, &Stages::NONE).unwrap_err();
            assert_eq!(refused, Error::Adaptation { option: name });
        }
    }
    let none = ShiftOptions { burst: 0, ..usual };
    assert_eq!(none.check(), Err(Error::Adaptation { option: "burst" }));
    assert_eq!(usual.check(), Ok(()));
}

/// The load for the weights follows the load found in steps of 1/256 of the range, and stays within
/// the range.
#[test]
fn weights_are_renewed_where_the_load_moved() {
    let plane = Plane::new(20.0_f64, 80.0, 4).unwrap();
    let model = Model::new(plane, Operator::Mkp, &[1.0; 10], vec![0.0; 15]).unwrap();
    let load = Load {
        loads: &[0.0, 100.0],
        shifts: &[0.0, 10.0],
        ..Load::NONE
    };
    let axis = Axis {
        load,
        ..Axis::PLAIN
    };
    let stages = Stages {
        axis,
        ..Stages::NONE
    };
    let options = ShiftOptions::usual(&model, &stages);
    let mut estimator = ShiftEstimator::new(options, &model, &stages).unwrap();
    let mut placed = 50.0;
    // A range of loads of 64, so a step is 0.25.
    let range = (20.0, 84.0);
    for (shift, expected) in [
        (0.0, 50.0),
        (0.024, 50.0),
        (0.026, 50.26),
        (0.002, 50.26),
        (0.0, 50.0),
        (-0.5, 45.0),
        (-4.9, 20.0),
        (20.0, 84.0),
        (3.38, 84.0),
    ] {
        estimator.reset(shift).unwrap();
        placed = estimator.renewed(&load, Some(50.0), placed, range).unwrap();
        assert!((placed - expected).abs() < 1e-9, "{shift}: {placed}");
    }
    // Without a curve of shifts no load is told.
    let placed = estimator.renewed(&Load::NONE, None, 33.0, range).unwrap();
    assert_eq!(placed, 33.0);
    let refused = estimator.renewed(&load, None, 33.0, range);
    assert_eq!(refused, Err(Error::Load));
}
