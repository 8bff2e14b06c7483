//! Objects made again and again in the same memory, with success and without, between other calls
//! in any order: an object does what the same object of the library does, or it is refused.
#![allow(clippy::unwrap_used)]

use hysteron::{
    Adaptation, Adaptive, CoreError, Error, Method, Model, Operator, Plane, Sign, State,
};
use hysteron_capi::*;
use hysteron_core::operator_count;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::ptr::null_mut;

const ROOMS: usize = 4;
/// Bytes of each, enough for any object here.
const ROOM: usize = 8192;
const METHODS: [i32; 2] = [HYSTERON_INCREMENTS, HYSTERON_LEAST_SQUARES];

/// What a handle stands for: the same object in the library.
#[allow(clippy::large_enum_variant, reason = "there are four")]
enum Twin {
    State(Model, State),
    Learner(Box<Adaptive>),
}

struct World {
    memory: Vec<u64>,
    /// The objects that live, each with its room and its handle.
    twins: Vec<(usize, u64, Twin)>,
    /// Handles of objects that ended.
    ended: Vec<u64>,
    rng: StdRng,
}

impl World {
    fn new(seed: u64) -> Self {
        Self {
            memory: vec![0; ROOMS * ROOM / 8],
            twins: Vec::new(),
            ended: Vec::new(),
            rng: StdRng::seed_from_u64(seed),
        }
    }

    /// Mostly one that can be.
    fn number(&mut self) -> f64 {
        match self.rng.random_range(0..20) {
            0 => f64::NAN,
            _ => self.rng.random_range(0.0..4.0),
        }
    }

    /// The end of what is in a room.
    fn end(&mut self, room: usize) {
        let ended = self.twins.extract_if(.., |(at, ..)| *at == room);
        self.ended.extend(ended.map(|(_, handle, _)| handle));
    }

    fn make(&mut self) {
        let (room, levels) = (self.rng.random_range(0..ROOMS), self.rng.random_range(2..5));
        let weights: Vec<f64> = (0..operator_count(levels))
            .map(|_| self.rng.random_range(0.0..1.0))
            .collect();
        let (mut handle, mut made, count) = (0, 0, weights.len());
        let sign = if self.rng.random() { 1 } else { -1 };
        let (kind, at) = (HYSTERON_MKP, weights.as_ptr());
        // SAFETY: live memory of the sizes given.
        let code = unsafe {
            hysteron_model_new(kind, 0.0, 3.0, levels, at, count, 1.0, sign, &mut handle)
        };
        assert_eq!(code, HYSTERON_OK);
        let (plane, signed) = (
            Plane::new(0.0, 3.0, levels).unwrap(),
            [Sign::Negative, Sign::Positive][usize::from(sign == 1)],
        );
        let model = Model::new(Operator::Mkp, plane, weights, 1.0, signed).unwrap();
        let short = usize::from(self.rng.random_ratio(1, 4));
        let memory = self.memory[room * ROOM / 8..].as_mut_ptr().cast();
        // SAFETY: all fields are numbers.
        let mut options: HysteronAdaptation = unsafe { std::mem::zeroed() };
        let method = METHODS[self.rng.random_range(0..METHODS.len())];
        // SAFETY: live memory of the sizes given.
        let (code, twin) = unsafe {
            assert_eq!(
                hysteron_adaptation_default(method, &mut options),
                HYSTERON_OK
            );
            if self.rng.random() {
                let bytes = hysteron_state_size(handle) - short;
                let code = hysteron_state_place(handle, memory, bytes, &mut made);
                let start = model.start();
                (code, Twin::State(model, start))
            } else {
                let bytes = hysteron_adaptive_size(handle, &options) - short;
                let code = hysteron_adaptive_place(handle, &options, memory, bytes, &mut made);
                let learner = Adaptive::new(&model, core_options(&options)).unwrap();
                (code, Twin::Learner(Box::new(learner)))
            }
        };
        assert_eq!(hysteron_model_free(handle), HYSTERON_OK);
        if short == 1 {
            // What was there stays.
            return assert_eq!(code, HYSTERON_MEMORY_TOO_SMALL);
        }
        assert_eq!(code, HYSTERON_OK);
        self.end(room);
        self.twins.push((room, made, twin));
    }

    fn free(&mut self) {
        let room = self.rng.random_range(0..ROOMS);
        for (_, handle, twin) in self.twins.iter().filter(|(at, ..)| *at == room) {
            let code = match twin {
                Twin::State(..) => hysteron_state_free(*handle),
                Twin::Learner(_) => hysteron_adaptive_free(*handle),
            };
            assert_eq!(code, HYSTERON_OK);
        }
        self.end(room);
    }

    fn step(&mut self) {
        let (input, measured, way) = (self.number(), self.number(), self.rng.random_range(0..4));
        let Some(n) = self.twins.len().checked_sub(1) else {
            return;
        };
        let n = self.rng.random_range(0..=n);
        let (_, handle, twin) = &mut self.twins[n];
        let (mut found, mut status, handle) = (0.0, 0, *handle);
        // SAFETY: all fields are numbers.
        let mut learning: HysteronLearning = unsafe { std::mem::zeroed() };
        let (nan, out, hold) = (f64::NAN, &mut found, HYSTERON_HOLD);
        let target = hysteron::Target::new(input);
        // SAFETY: live memory.
        let (code, expected) = unsafe {
            match (twin, way) {
                (Twin::State(model, state), 0 | 1) => (
                    hysteron_step(handle, input, out, null_mut()),
                    model.step(state, input).map(|step| step.output),
                ),
                (Twin::State(model, state), _) => (
                    hysteron_inverse_step(handle, input, hold, 0.0, out, &mut status),
                    model
                        .inverse()
                        .and_then(|inverse| inverse.step(state, target))
                        .map(|solution| solution.input),
                ),
                (Twin::Learner(learner), 0 | 1) => {
                    let code = hysteron_adaptive_step(handle, input, nan, measured, &mut learning);
                    *out = learning.output;
                    let expected = learner.step(input, measured);
                    (code, expected.map(|learning| learning.output))
                }
                (Twin::Learner(learner), 2) => (
                    hysteron_adaptive_inverse_step(handle, input, hold, 0.0, nan, out, &mut status),
                    learner.solve(target).map(|solution| solution.input),
                ),
                (Twin::Learner(learner), _) => {
                    learner.keep();
                    learner.roll_back().unwrap();
                    learner.align();
                    for call in [
                        hysteron_adaptive_keep,
                        hysteron_adaptive_roll_back,
                        hysteron_adaptive_align,
                    ] {
                        assert_eq!(call(handle), HYSTERON_OK);
                    }
                    (
                        hysteron_adaptive_simulate(handle, input, nan, out),
                        learner.simulate(input),
                    )
                }
            }
        };
        match expected {
            Ok(expected) => {
                assert_eq!(code, HYSTERON_OK);
                assert_eq!(found.to_bits(), expected.to_bits());
            }
            Err(Error::Core(CoreError::InputNotFinite { .. })) => {
                assert_eq!(code, HYSTERON_INPUT_NOT_FINITE);
            }
            Err(error) => assert_eq!(code, error.code(), "{error}"),
        }
    }

    fn what_ended_is_refused(&self) {
        for handle in &self.ended {
            // SAFETY: null pointers.
            unsafe {
                let code = hysteron_step(*handle, 0.0, &mut 0.0, null_mut());
                assert_eq!(code, HYSTERON_HANDLE);
            }
            assert_eq!(hysteron_adaptive_reset(*handle), HYSTERON_HANDLE);
        }
    }
}

fn core_options(options: &HysteronAdaptation) -> Adaptation<f64> {
    let method = match options.method {
        HYSTERON_INCREMENTS => Method::Increments {
            gain: options.gain,
            span: options.span,
        },
        _ => Method::LeastSquares {
            forgetting: options.forgetting,
            noise: options.noise,
            spread: options.spread,
            correlation: options.correlation,
        },
    };
    Adaptation {
        method,
        ..Adaptation::default()
    }
}

#[test]
fn an_object_works_as_in_the_library_or_is_refused() {
    for seed in 0..4000 {
        let mut world = World::new(seed);
        for _ in 0..200 {
            match world.rng.random_range(0..12) {
                0..2 => world.make(),
                2 => world.free(),
                _ => world.step(),
            }
        }
        world.what_ended_is_refused();
        (0..ROOMS).for_each(|room| world.end(room));
    }
}
