//! Initialisation again and again in the same memory, with success and without, between other calls
//! in any order: an object does what the same object of the core does, or it is refused.
#![allow(clippy::unwrap_used)]

use hysteron_capi::*;
use hysteron_core::{
    Adaptation, Error, Estimator, Inverse, Method, Model, Operator, Plane, State, Target, Turn,
    estimator_len, operator_count, table_len, turn_capacity,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::ptr::null_mut;

const ROOMS: usize = 4;
/// Bytes of each, enough for any object here.
const ROOM: usize = 8192;
const METHODS: [i32; 2] = [HYSTERON_INCREMENTS, HYSTERON_LEAST_SQUARES];

/// What a room holds: the same object, made with the core.
#[derive(Default, Clone)]
#[allow(clippy::large_enum_variant, reason = "there are four")]
enum Twin {
    #[default]
    None,
    Model(Model<f64, Vec<f64>>),
    State(State<f64, Vec<Turn<f64>>>),
    Estimator(Box<Estimator<f64, Vec<f64>>>),
}

impl Twin {
    fn is_model(&self) -> bool {
        matches!(self, Self::Model(_))
    }

    fn is_state(&self) -> bool {
        matches!(self, Self::State(_))
    }

    fn is_estimator(&self) -> bool {
        matches!(self, Self::Estimator(_))
    }
}

struct World {
    memory: Vec<u64>,
    twins: [Twin; ROOMS],
    rng: StdRng,
}

impl World {
    fn new(seed: u64) -> Self {
        Self {
            memory: vec![0; ROOMS * ROOM / 8],
            twins: Default::default(),
            rng: StdRng::seed_from_u64(seed),
        }
    }

    fn room(&mut self) -> usize {
        self.rng.random_range(0..ROOMS)
    }

    /// Mostly one that holds such an object, where there is one.
    fn room_of(&mut self, wanted: fn(&Twin) -> bool) -> usize {
        let any = self.room();
        let mut from = (0..ROOMS).map(|n| (any + n) % ROOMS);
        let found = from.find(|&room| wanted(&self.twins[room]));
        if self.rng.random_ratio(1, 8) {
            return any;
        }
        found.unwrap_or(any)
    }

    fn at<T>(&mut self, room: usize) -> *mut T {
        self.memory[room * ROOM / 8..].as_mut_ptr().cast()
    }

    /// Mostly one that can be.
    fn number(&mut self) -> f64 {
        match self.rng.random_range(0..20) {
            0 => f64::NAN,
            1 => -1.0,
            _ => self.rng.random_range(0.0..4.0),
        }
    }

    fn weights(&mut self, levels: usize) -> Vec<f64> {
        let number = |_| match self.rng.random_range(0..60) {
            0 => f64::NAN,
            _ => self.rng.random_range(0.0..1.0),
        };
        (0..operator_count(levels)).map(number).collect()
    }

    /// The kind of object that is found in a room; each kind's function looks for its object before
    /// it asks for more.
    fn found(&mut self, room: usize) -> [bool; 3] {
        // SAFETY: null pointers, and memory as large as any object.
        let codes = unsafe {
            [
                hysteron_core_state_rebase(self.at(room), null_mut()),
                hysteron_core_state_save(self.at(room), null_mut(), 0, null_mut(), null_mut()),
                hysteron_core_estimator_offset(self.at(room), null_mut()),
            ]
        };
        codes.map(|code| match code {
            HYSTERON_NULL => true,
            code => {
                assert_eq!(code, HYSTERON_HANDLE);
                false
            }
        })
    }

    /// After a call that makes an object. Where it failed, the room has the object that it had, or
    /// none.
    fn made(&mut self, room: usize, found: i32, twin: Result<Twin, Error>) {
        match twin {
            Ok(twin) => {
                assert_eq!(found, HYSTERON_OK);
                self.twins[room] = twin;
            }
            Err(error) => {
                assert_eq!(found, error.code());
                if self.found(room) == [false; 3] {
                    self.twins[room] = Twin::None;
                }
            }
        }
    }

    fn make_model(&mut self) {
        let (room, levels) = (self.room(), self.rng.random_range(2..5));
        let (max, weights) = (self.number(), self.weights(levels));
        let tables = self.rng.random_range(0..3);
        let bytes = hysteron_core_model_size(levels, tables);
        let (memory, mut model) = (self.at(room), null_mut());
        let (first, count) = (weights.as_ptr(), weights.len());
        // SAFETY: live memory of the sizes given.
        let found = unsafe {
            let kind = HYSTERON_MKP;
            hysteron_core_model_init(
                memory, bytes, kind, 0.0, max, levels, first, count, &mut model,
            )
        };
        let twin = || {
            let plane = Plane::new(0.0, max, levels)?;
            let table = vec![0.0; tables * table_len(levels)];
            if tables == 0 {
                let (needed, found) = (table_len(levels), 0);
                return Err(Error::MemoryTooSmall { needed, found });
            }
            Ok(Twin::Model(Model::new(
                plane,
                Operator::Mkp,
                &weights,
                table,
            )?))
        };
        self.made(room, found, twin());
    }

    fn make_state(&mut self) {
        let (room, of) = (self.room(), self.room_of(Twin::is_model));
        let short = usize::from(self.rng.random_ratio(1, 4));
        let (memory, model, mut state) = (self.at(room), self.at(of), null_mut());
        let Twin::Model(twin) = self.twins[of].clone() else {
            // SAFETY: live memory of the size given.
            let found = unsafe { hysteron_core_state_init(model, memory, ROOM, &mut state) };
            return assert_eq!(found, HYSTERON_HANDLE);
        };
        let levels = twin.plane().levels();
        let bytes = hysteron_core_state_size(levels) - short;
        // SAFETY: live memory of the size given.
        let found = unsafe { hysteron_core_state_init(model, memory, bytes, &mut state) };
        if room == of {
            return assert_eq!(found, HYSTERON_OVERLAP);
        }
        let turns = vec![Turn::default(); turn_capacity(levels) - short];
        self.made(room, found, twin.state(turns).map(Twin::State));
    }

    fn make_estimator(&mut self) {
        let (room, of) = (self.room(), self.room_of(Twin::is_model));
        let (offset, method) = (self.number(), METHODS[self.rng.random_range(0..2)]);
        // SAFETY: all fields are numbers.
        let mut options = unsafe { std::mem::zeroed() };
        // SAFETY: a live structure.
        assert_eq!(
            unsafe { hysteron_adaptation_default(method, &mut options) },
            0
        );
        let levels = match &self.twins[of] {
            Twin::Model(twin) => twin.plane().levels(),
            _ => 2,
        };
        let weights = self.weights(levels);
        let (memory, model, mut estimator) = (self.at(room), self.at(of), null_mut());
        let (first, count) = (weights.as_ptr(), weights.len());
        // SAFETY: live memory of the sizes given.
        let found = unsafe {
            let bytes = hysteron_core_estimator_size(levels, &options);
            hysteron_core_estimator_init(
                model,
                &options,
                first,
                count,
                offset,
                memory,
                bytes,
                &mut estimator,
            )
        };
        let Twin::Model(twin) = &mut self.twins[of] else {
            return assert_eq!(found, HYSTERON_HANDLE);
        };
        if room == of {
            return assert_eq!(found, HYSTERON_OVERLAP);
        }
        let method = core_method(&options);
        let options = Adaptation {
            method,
            ..Adaptation::default()
        };
        let memory = vec![0.0; estimator_len(levels, method)];
        let made = Estimator::new(options, twin, &weights, offset, memory);
        self.made(
            room,
            found,
            made.map(|estimator| Twin::Estimator(Box::new(estimator))),
        );
    }

    /// A step of the model in one room, or of its inverse, with the state in another.
    fn step(&mut self) {
        let (of, with) = (self.room_of(Twin::is_model), self.room_of(Twin::is_state));
        let number = self.number();
        let (model, state) = (self.at(of), self.at(with));
        let (mut result, mut status) = (0.0, 0);
        let forward = self.rng.random();
        // SAFETY: live memory, of whatever content.
        let found = unsafe {
            if forward {
                hysteron_core_step(model, state, number, &mut result, null_mut())
            } else {
                let hold = HYSTERON_HOLD;
                hysteron_core_inverse_step(
                    model,
                    state,
                    number,
                    hold,
                    0.0,
                    &mut result,
                    &mut status,
                )
            }
        };
        let (Twin::Model(model), Twin::State(mut state)) =
            (&self.twins[of], self.twins[with].clone())
        else {
            return assert_eq!(found, HYSTERON_HANDLE);
        };
        let expected = if forward {
            model.step(&mut state, number).map(|step| step.output)
        } else {
            let solve = |inverse: Inverse<'_, _, _>| inverse.step(&mut state, Target::new(number));
            model
                .inverse()
                .and_then(solve)
                .map(|solution| solution.input)
        };
        same(found, result, expected);
        self.twins[with] = Twin::State(state);
    }

    fn learn(&mut self) {
        let by = self.room_of(Twin::is_estimator);
        let (of, with) = (self.room_of(Twin::is_model), self.room_of(Twin::is_state));
        let (input, measured) = (self.number(), self.number());
        let (estimator, model, state) = (self.at(by), self.at(of), self.at(with));
        // SAFETY: all fields are numbers.
        let mut learning: HysteronLearning = unsafe { std::mem::zeroed() };
        // SAFETY: live memory, of whatever content.
        let found = unsafe {
            hysteron_core_estimator_step(estimator, model, state, input, measured, &mut learning)
        };
        let twins = [by, of, with].map(|room| self.twins[room].clone());
        let [
            Twin::Estimator(mut estimator),
            Twin::Model(mut model),
            Twin::State(mut state),
        ] = twins
        else {
            return assert_eq!(found, HYSTERON_HANDLE);
        };
        let expected = estimator.step(&mut model, &mut state, input, measured);
        same(
            found,
            learning.output,
            expected.map(|learning| learning.output),
        );
        self.twins[by] = Twin::Estimator(estimator);
        self.twins[of] = Twin::Model(model);
        self.twins[with] = Twin::State(state);
    }

    fn rebase(&mut self) {
        let (of, with) = (self.room_of(Twin::is_model), self.room_of(Twin::is_state));
        // SAFETY: live memory, of whatever content.
        let found = unsafe { hysteron_core_state_rebase(self.at(of), self.at(with)) };
        let (Twin::Model(model), Twin::State(mut state)) =
            (&self.twins[of], self.twins[with].clone())
        else {
            return assert_eq!(found, HYSTERON_HANDLE);
        };
        same(found, 0.0, model.rebase(&mut state).map(|()| 0.0));
        self.twins[with] = Twin::State(state);
    }

    fn every_room_has_its_twin(&mut self) {
        for room in 0..ROOMS {
            let twin = &self.twins[room];
            let kinds = [twin.is_model(), twin.is_state(), twin.is_estimator()];
            assert_eq!(self.found(room), kinds);
        }
    }
}

/// The code of a call and its result, to the last bit, beside those of the core.
fn same(found: i32, result: f64, expected: Result<f64, Error>) {
    match expected {
        Ok(expected) => {
            assert_eq!(found, HYSTERON_OK);
            assert_eq!(result.to_bits(), expected.to_bits());
        }
        Err(error) => assert_eq!(found, error.code()),
    }
}

fn core_method(options: &HysteronAdaptation) -> Method<f64> {
    match options.method {
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
    }
}

#[test]
fn an_object_works_as_in_the_core_or_is_refused() {
    for seed in 0..4000 {
        let mut world = World::new(seed);
        for _ in 0..200 {
            match world.rng.random_range(0..12) {
                0..2 => world.make_model(),
                2 => world.make_state(),
                3 => world.make_estimator(),
                4..8 => world.step(),
                8..11 => world.learn(),
                _ => world.rebase(),
            }
            world.every_room_has_its_twin();
        }
    }
}
