//! Model and state over memory that the caller owns: nothing is allocated.
//!
//! An object lies at the beginning of its memory, with its numbers behind it. It must not be moved, and ends with the
//! memory. Outputs are `Σ μ γ` of the operators, without offset and sign. One thread at a time for each object
//! that is written to (a state; model and estimator while weights are learned).

use crate::codes::{HYSTERON_ALIGNMENT, HYSTERON_HANDLE, HYSTERON_NULL};
use crate::fault::{Fault, Result, guard_plain};
use crate::pointer::{Out, apart, array, array_out, check, optional};
use crate::types::{clipped as clipped_constant, operator, policy, status as status_constant};
use hysteron_core::{Error, MAX_LEVELS, Model, Plane, State, Turn, table_len, turn_capacity};
use std::ffi::c_void;

/// A model in the caller's memory.
pub struct HysteronCoreModel {
    mark: u64,
    pub(crate) model: Model<f64, &'static mut [f64]>,
}

/// A state in the caller's memory.
pub struct HysteronCoreState {
    mark: u64,
    pub(crate) state: State<f64, &'static mut [Turn<f64>]>,
}

/// An object that begins with something that random memory hardly has.
pub(crate) trait Marked {
    const MARK: u64;
    /// # Safety
    /// `this` is valid for reads of `Self`, of whatever content.
    unsafe fn mark(this: *const Self) -> u64;
}

macro_rules! marked {
    ($type:ty, $mark:expr) => {
        impl $crate::memory::Marked for $type {
            const MARK: u64 = $mark;
            unsafe fn mark(this: *const Self) -> u64 {
                // SAFETY: the caller's promise.
                unsafe { (&raw const (*this).mark).read() }
            }
        }
    };
}
pub(crate) use marked;
marked!(HysteronCoreModel, 0x6879_7374_6d6f_646c);
marked!(HysteronCoreState, 0x6879_7374_7374_6174);

/// The object behind a pointer that an initialisation gave.
///
/// # Safety
/// `pointer` is null or points to memory of at least the size of `T` that nobody else uses during `'a`.
pub(crate) unsafe fn object<'a, T: Marked>(
    pointer: *mut T,
    name: &'static str,
) -> Result<&'a mut T> {
    check(pointer, name)?;
    // SAFETY: the caller's promise; with its mark it is an object that `Room::finish` has written.
    unsafe {
        if T::mark(pointer) != T::MARK {
            return Err(Fault::Call(HYSTERON_HANDLE, name));
        }
        Ok(&mut *pointer)
    }
}

/// As [`object`], of one that is read only: others may read it too.
///
/// # Safety
/// As for [`object`], but others may read it.
pub(crate) unsafe fn object_ref<'a, T: Marked>(
    pointer: *const T,
    name: &'static str,
) -> Result<&'a T> {
    check(pointer, name)?;
    // SAFETY: as in `object`.
    unsafe {
        if T::mark(pointer) != T::MARK {
            return Err(Fault::Call(HYSTERON_HANDLE, name));
        }
        Ok(&*pointer)
    }
}

/// Bytes of an object `T` with `count` elements `E` behind it.
pub(crate) fn size<T, E>(count: usize) -> Option<usize> {
    const {
        assert!(
            size_of::<T>().is_multiple_of(align_of::<E>()) && align_of::<T>() >= align_of::<E>()
        )
    };
    count
        .checked_mul(size_of::<E>())?
        .checked_add(size_of::<T>())
}

/// The caller's memory, cut into the object's place and the elements behind it.
pub(crate) struct Room<T>(*mut T);

impl<T> Room<T> {
    /// # Safety
    /// `memory` is null or valid for `bytes` bytes that nobody else uses while the object lives.
    pub(crate) unsafe fn cut<E: Default + 'static>(
        memory: *mut c_void,
        bytes: usize,
        count: usize,
    ) -> Result<(Self, &'static mut [E])> {
        if memory.is_null() {
            return Err(Fault::Call(HYSTERON_NULL, "memory"));
        }
        let head = memory.cast::<T>();
        if !head.is_aligned() {
            return Err(Fault::Call(HYSTERON_ALIGNMENT, "memory"));
        }
        let needed = size::<T, E>(count).unwrap_or(usize::MAX);
        if bytes < needed {
            return Err(Error::MemoryTooSmall {
                needed,
                found: bytes,
            }
            .into());
        }
        // SAFETY: `bytes` suffice for the head and `count` elements behind it, aligned because the head is and its size is a
        // multiple; each element is written before the slice is made.
        let elements = unsafe {
            let first = head.add(1).cast::<E>();
            for n in 0..count {
                first.add(n).write(E::default());
            }
            std::slice::from_raw_parts_mut(first, count)
        };
        Ok((Self(head), elements))
    }

    pub(crate) fn finish(self, object: T, out: &Out<*mut T>) {
        // SAFETY: valid, aligned and apart from the elements, as `cut` has seen to.
        unsafe { self.0.write(object) };
        out.set(self.0);
    }
}

/// Bytes for a model of `levels` levels with 1 table, or with the 2 that adaptation by increments needs; 0 where there is no
/// such model. The memory has to be aligned as a `uint64_t` is.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_core_model_size(levels: usize, tables: usize) -> usize {
    if !(2..=MAX_LEVELS).contains(&levels) || !(1..=2).contains(&tables) {
        return 0;
    }
    size::<HysteronCoreModel, f64>(tables * table_len(levels)).unwrap_or(0)
}

/// Makes a model in `memory`; the weights as for `hysteron_model_new`, and not needed afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_model_init(
    memory: *mut c_void,
    bytes: usize,
    operator_kind: i32,
    min: f64,
    max: f64,
    levels: usize,
    weights: *const f64,
    count: usize,
    model: *mut *mut HysteronCoreModel,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (weights, out) =
            unsafe { (array(weights, count, "weights")?, Out::new(model, "model")?) };
        let (plane, operator) = (Plane::new(min, max, levels)?, operator(operator_kind)?);
        let two = hysteron_core_model_size(levels, 2);
        let tables = if two != 0 && bytes >= two { 2 } else { 1 };
        // SAFETY: the contract of the crate.
        let (room, table) = unsafe { Room::cut(memory, bytes, tables * table_len(levels))? };
        let model = Model::new(plane, operator, weights, table)?;
        let mark = HysteronCoreModel::MARK;
        room.finish(HysteronCoreModel { mark, model }, &out);
        Ok(())
    })
}

/// Bytes for a state of a model of `levels` levels; 0 where there is no such model. Aligned as a `uint64_t` is.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_core_state_size(levels: usize) -> usize {
    if !(2..=MAX_LEVELS).contains(&levels) {
        return 0;
    }
    size::<HysteronCoreState, Turn<f64>>(turn_capacity(levels)).unwrap_or(0)
}

/// Makes a state of `model` in `memory`, all operators off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_init(
    model: *const HysteronCoreModel,
    memory: *mut c_void,
    bytes: usize,
    state: *mut *mut HysteronCoreState,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, out) = unsafe {
            (
                &object_ref(model, "model")?.model,
                Out::new(state, "state")?,
            )
        };
        // SAFETY: the contract of the crate.
        let (room, turns) =
            unsafe { Room::cut(memory, bytes, turn_capacity(model.plane().levels()))? };
        let state = model.state(turns)?;
        let mark = HysteronCoreState::MARK;
        room.finish(HysteronCoreState { mark, state }, &out);
        Ok(())
    })
}

/// All operators off.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_reset(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        Ok(model.model.reset_off(&mut state.state)?)
    })
}

/// Moves to `input` and gives `Σ μ γ`; `clipped` may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_step(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    input: f64,
    output: *mut f64,
    clipped: *mut i32,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        // SAFETY: the contract of the crate.
        let (output, clipped) =
            unsafe { (Out::new(output, "output")?, optional(clipped, "clipped")?) };
        let step = model.model.step(&mut state.state, input)?;
        output.set(step.output);
        if let Some(clipped) = clipped {
            clipped.set(clipped_constant(step.clipped));
        }
        Ok(())
    })
}

/// As `hysteron_run`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_run(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    input: *const f64,
    output: *mut f64,
    count: usize,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        if count > 0 {
            apart(input, output, count, "output")?;
        }
        // SAFETY: the contract of the crate, and apart as checked.
        let (input, output) = unsafe {
            (
                array(input, count, "input")?,
                array_out(output, count, "output")?,
            )
        };
        model.model.run(&mut state.state, input, output)?;
        Ok(())
    })
}

/// As `hysteron_inverse_step`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_inverse_step(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    target: f64,
    heading: i32,
    tolerance: f64,
    input: *mut f64,
    status: *mut i32,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        // SAFETY: the contract of the crate.
        let (input, status) = unsafe { (Out::new(input, "input")?, Out::new(status, "status")?) };
        let policy = policy(heading, tolerance)?;
        let solution = model
            .model
            .inverse()?
            .step(&mut state.state, target, policy)?;
        input.set(solution.input);
        status.set(status_constant(solution.status));
        Ok(())
    })
}

/// As `hysteron_state_save`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_save(
    state: *const HysteronCoreState,
    points: *mut f64,
    capacity: usize,
    count: *mut usize,
    input: *mut f64,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (count, input) = unsafe { (Out::new(count, "count")?, Out::new(input, "input")?) };
        // SAFETY: the contract of the crate.
        let state = unsafe { &object_ref(state, "state")?.state };
        let needed = state.held() + 1;
        count.set(needed);
        if capacity < needed {
            return Err(Error::MemoryTooSmall {
                needed,
                found: capacity,
            }
            .into());
        }
        // SAFETY: the contract of the crate, and no more than the capacity.
        let points = unsafe { array_out(points, needed, "points")? };
        points
            .iter_mut()
            .zip(state.turning_points())
            .for_each(|(to, x)| *to = x);
        input.set(state.input());
        Ok(())
    })
}

/// As `hysteron_state_restore`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_core_state_restore(
    model: *const HysteronCoreModel,
    state: *mut HysteronCoreState,
    points: *const f64,
    count: usize,
    input: f64,
) -> i32 {
    guard_plain(|| {
        // SAFETY: the contract of the crate.
        let (model, state) = unsafe { (object_ref(model, "model")?, object(state, "state")?) };
        // SAFETY: the contract of the crate.
        let points = unsafe { array(points, count, "points")? };
        Ok(model.model.restore(&mut state.state, points, input)?)
    })
}
