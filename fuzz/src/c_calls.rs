//! Sequences of calls of the C interface, over handles that live or not, and memory of the caller
//! of any size and place: every call gives a code that there is, and what it refuses leaves the
//! caller's numbers as they were.

mod room;

use crate::given::Number;
use arbitrary::Arbitrary;
use hysteron_capi::*;
use room::{Array, Room, Slot};

/// One of the handles that were given out so far, freed ones too, or any number.
#[derive(Arbitrary, Debug, Clone, Copy)]
pub enum Handle {
    Given(u8),
    Any(u64),
}

#[derive(Arbitrary, Debug, Clone)]
pub enum Call {
    ModelNew {
        kind: i8,
        min: Number,
        max: Number,
        levels: u8,
        weights: Array,
        sign: i8,
    },
    ModelParse(String),
    ModelFree(Handle),
    ModelInfo(Handle),
    ModelWeights(Handle, Array),
    StateNew(Handle),
    StateFree(Handle),
    StateReset(Handle, bool),
    Step(Handle, Number, Array),
    Run(Handle, Array, Array),
    InverseStep(Handle, Number, i8, Number, Array),
    InverseRun(Handle, Array, Array, Number, Array, Array),
    Headings(Array, Number, Array),
    Save(Handle, Array, Array),
    Restore(Handle, Array, Number),
    AdaptiveNew(Handle, i8),
    AdaptiveFree(Handle),
    AdaptiveStep(Handle, Number, Number),
    AdaptivePredict(Handle, Number, Array),
    AdaptiveModel(Handle),
    StatePlace(Handle, Slot),
    AdaptivePlace(Handle, i8, Slot),
    Error(u8),
}

/// Calls one after the other, in a room of their own.
pub fn run(calls: &[Call]) {
    let mut user = User::default();
    for call in calls {
        let before = user.room.numbers.clone();
        let code = user.call(call);
        let known = matches!(code, 0..=14 | 20..=31 | 100..=105);
        assert!(known, "{code} of {call:?}");
        assert!(
            code == HYSTERON_OK || user.room.numbers == before,
            "{code}: {call:?} wrote"
        );
    }
    user.free();
}

#[derive(Default)]
struct User {
    room: Room,
    handles: Vec<u64>,
}

impl User {
    fn handle(&self, handle: Handle) -> u64 {
        match handle {
            Handle::Given(n) if self.handles.is_empty() => u64::from(n),
            Handle::Given(n) => self.handles[usize::from(n) % self.handles.len()],
            Handle::Any(handle) => handle,
        }
    }

    /// Keeps the handle that a call gives out.
    fn made(&mut self, make: impl FnOnce(&mut Self, *mut u64) -> i32) -> i32 {
        let mut handle = 0;
        let code = make(self, &mut handle);
        if code == HYSTERON_OK {
            self.handles.push(handle);
        }
        code
    }

    fn free(self) {
        for handle in self.handles {
            // Each handle is of one of these kinds; the others refuse it.
            hysteron_state_free(handle);
            hysteron_adaptive_free(handle);
            hysteron_model_free(handle);
        }
    }

    fn call(&mut self, call: &Call) -> i32 {
        // Every pointer is null or into the room, which has as many elements from there on as are
        // told; only the interface writes into the slots, whose objects it gave out.
        match *call {
            Call::ModelNew {
                kind,
                min,
                max,
                levels,
                weights,
                sign,
            } => self.made(|user, to| unsafe {
                let (weights, count) = user.room.doubles(weights);
                let (kind, levels) = (i32::from(kind), usize::from(levels % 8));
                let sign = i32::from(sign);
                hysteron_model_new(
                    kind,
                    min.get(),
                    max.get(),
                    levels,
                    weights,
                    count,
                    1.0,
                    sign,
                    to,
                )
            }),
            Call::ModelParse(ref text) => self.made(|_, to| {
                let Ok(text) = std::ffi::CString::new(text.as_str()) else {
                    return HYSTERON_TEXT;
                };
                unsafe { hysteron_model_parse(text.as_ptr(), to) }
            }),
            Call::ModelFree(handle) => hysteron_model_free(self.handle(handle)),
            Call::ModelInfo(handle) => unsafe {
                let mut info = std::mem::MaybeUninit::uninit();
                hysteron_model_info(self.handle(handle), info.as_mut_ptr())
            },
            Call::ModelWeights(handle, array) => unsafe {
                let (to, capacity) = self.room.doubles(array);
                hysteron_model_weights(self.handle(handle), to, capacity, &mut 0)
            },
            Call::StateNew(handle) => {
                let model = self.handle(handle);
                self.made(|_, to| unsafe { hysteron_state_new(model, to) })
            }
            Call::StateFree(handle) => hysteron_state_free(self.handle(handle)),
            Call::StateReset(handle, on) if on => hysteron_state_saturate(self.handle(handle)),
            Call::StateReset(handle, _) => hysteron_state_reset(self.handle(handle)),
            Call::Step(handle, input, to) => unsafe {
                let (to, _) = self.room.doubles(to);
                hysteron_step(self.handle(handle), input.get(), to, &mut 0)
            },
            Call::Run(handle, from, to) => unsafe {
                let ((from, a), (to, b)) = (self.room.doubles(from), self.room.doubles(to));
                hysteron_run(self.handle(handle), from, to, a.min(b))
            },
            Call::InverseStep(handle, target, heading, tolerance, to) => unsafe {
                let (to, _) = self.room.doubles(to);
                let (target, heading) = (target.get(), i32::from(heading));
                let state = self.handle(handle);
                hysteron_inverse_step(state, target, heading, tolerance.get(), to, &mut 0)
            },
            Call::InverseRun(handle, target, heading, tolerance, to, status) => unsafe {
                let ((target, a), (heading, b)) =
                    (self.room.doubles(target), self.room.ints(heading));
                let ((to, c), (status, d)) = (self.room.doubles(to), self.room.ints(status));
                let (state, count) = (self.handle(handle), a.min(b).min(c).min(d));
                hysteron_inverse_run(state, target, heading, tolerance.get(), to, status, count)
            },
            Call::Headings(target, tolerance, to) => unsafe {
                let ((target, a), (to, b)) = (self.room.doubles(target), self.room.ints(to));
                hysteron_headings(target, a.min(b), tolerance.get(), to)
            },
            Call::Save(handle, points, input) => unsafe {
                let ((points, capacity), (input, _)) =
                    (self.room.doubles(points), self.room.doubles(input));
                hysteron_state_save(self.handle(handle), points, capacity, &mut 0, input)
            },
            Call::Restore(handle, points, input) => unsafe {
                let (points, count) = self.room.doubles(points);
                hysteron_state_restore(self.handle(handle), points, count, input.get())
            },
            Call::AdaptiveNew(handle, method) => {
                let (model, options) = (self.handle(handle), options(method));
                self.made(|_, to| unsafe { hysteron_adaptive_new(model, &options, to) })
            }
            Call::AdaptiveFree(handle) => hysteron_adaptive_free(self.handle(handle)),
            Call::AdaptiveStep(handle, input, measured) => unsafe {
                let mut learning = std::mem::MaybeUninit::uninit();
                let adaptive = self.handle(handle);
                let (input, measured) = (input.get(), measured.get());
                hysteron_adaptive_step(adaptive, input, f64::NAN, measured, learning.as_mut_ptr())
            },
            Call::AdaptivePredict(handle, input, to) => unsafe {
                let (to, _) = self.room.doubles(to);
                hysteron_adaptive_simulate(self.handle(handle), input.get(), f64::NAN, to)
            },
            Call::AdaptiveModel(handle) => {
                let adaptive = self.handle(handle);
                self.made(|_, to| unsafe { hysteron_adaptive_model(adaptive, to) })
            }
            Call::StatePlace(handle, slot) => {
                let model = self.handle(handle);
                self.made(|user, to| unsafe {
                    let (memory, bytes) = user.room.memory(slot);
                    hysteron_state_place(model, memory, bytes, to)
                })
            }
            Call::AdaptivePlace(handle, method, slot) => {
                let (model, options) = (self.handle(handle), options(method));
                self.made(|user, to| unsafe {
                    let (memory, bytes) = user.room.memory(slot);
                    hysteron_adaptive_place(model, &options, memory, bytes, to)
                })
            }
            Call::Error(size) => unsafe {
                let mut text = vec![0; usize::from(size)];
                hysteron_last_error(text.as_mut_ptr(), text.len());
                HYSTERON_OK
            },
        }
    }
}

/// The usual ones; those of the gradient where there is no such method.
fn options(method: i8) -> HysteronAdaptation {
    let mut options = std::mem::MaybeUninit::uninit();
    // SAFETY: a place for one; filled in with the first call or the second.
    unsafe {
        if hysteron_adaptation_default(i32::from(method), options.as_mut_ptr()) != HYSTERON_OK {
            hysteron_adaptation_default(HYSTERON_INCREMENTS, options.as_mut_ptr());
        }
        let mut options = options.assume_init();
        options.method = i32::from(method);
        options
    }
}
