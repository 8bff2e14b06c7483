//! The table: one row for a function.

use super::Argument::{
    Characters, Constants, Doubles, Estimator, Found, Integers, Json, Learning, Limits, Memory,
    Model, ModelHandle, Options, Path, Shift, ShiftOptions, StageState, Stages, State, Word,
};
use super::{
    Call, LEVELS, WEIGHTS, estimator_size, model_size, shift_size, stages_size, state_size,
};
use hysteron_capi::*;

/// One number, of whatever value.
const ONE: super::Argument = Doubles(&[0.5]);
const SERIES: super::Argument = Doubles(&[0.5, 1.0, 0.25]);
const TIMES: super::Argument = Doubles(&[0.0, 1.0, 1.5]);
const LOADS: super::Argument = Doubles(&[1.0, 2.0, 1.25]);
const POINTS: super::Argument = Doubles(&[1.5, 0.5]);
const ROOM: super::Argument = Doubles(&[0.0; 16]);
const SPRING: super::Argument = Doubles(&WEIGHTS);

/// `name(pointers: what they point to) = the arguments of the call`, `h` the handles.
macro_rules! calls {
    ($($name:ident($($pointer:ident: $what:expr),*) |$h:ident| ($($argument:expr),*);)*) => {
        pub const CALLS: &[Call] = &[$(Call {
            name: stringify!($name),
            arguments: &[$((stringify!($pointer), $what)),*],
            run: |$h, pointers| {
                let _ = $h;
                let [$($pointer),*] = pointers else { return -1 };
                $(let $pointer = *$pointer;)*
                // SAFETY: pointers into live memory, of the sizes that the table gives.
                unsafe { $name($($argument),*) }
            },
        }),*];
    };
}

calls! {
    hysteron_adaptive_inverse_step(input: ONE, status: Integers(1)) |h|
        (h.adaptive, 1.0, HYSTERON_HOLD, 0.0, input.cast(), status.cast());
    hysteron_adaptive_load_inverse_step(input: ONE, status: Integers(1)) |h|
        (h.follower, 1.0, HYSTERON_HOLD, 0.0, f64::NAN, input.cast(), status.cast());
    hysteron_adaptive_load_new(options: ShiftOptions, adaptive_load: Word) |h|
        (h.model, f64::NAN, options.cast(), adaptive_load.cast());
    hysteron_adaptive_new(options: Options, adaptive: Word) |h|
        (h.model, options.cast(), adaptive.cast());
    hysteron_batch_new(models: ModelHandle, batch: Word) |_h|
        (models.cast(), 1, batch.cast());
    hysteron_batch_run(input: SERIES, output: SERIES) |h|
        (h.plain_batch, input.cast(), output.cast(), 3);
    hysteron_batch_run_in(input: SERIES, time: ONE, load: LOADS, output: SERIES) |h|
        (h.batch, input.cast(), time.cast(), 1, f64::NAN, load.cast(), output.cast(), 3);
    hysteron_batch_step(input: SERIES, output: SERIES) |h|
        (h.plain_batch, input.cast(), output.cast(), 3);
    hysteron_batch_step_in(input: SERIES, load: LOADS, output: SERIES) |h|
        (h.batch, input.cast(), 0.1, load.cast(), output.cast(), 3);
    hysteron_core_estimator_init(
        model: Model, options: Options, weights: SPRING, memory: Memory(estimator_size), estimator: Word
    ) |_h| (
        model.cast(), options.cast(), weights.cast(), WEIGHTS.len(), 0.0, memory, estimator_size(),
        estimator.cast()
    );
    hysteron_core_estimator_offset(estimator: Estimator, offset: ONE) |_h|
        (estimator.cast(), offset.cast());
    hysteron_core_estimator_step(
        estimator: Estimator, model: Model, state: State, learning: Learning
    ) |_h| (estimator.cast(), model.cast(), state.cast(), 0.5, 1.0, learning.cast());
    hysteron_core_inverse_step(model: Model, state: State, input: ONE, status: Integers(1)) |_h|
        (model.cast(), state.cast(), 1.0, HYSTERON_HOLD, 0.0, input.cast(), status.cast());
    hysteron_core_model_init(memory: Memory(model_size), weights: SPRING, model: Word) |_h| (
        memory, model_size(), HYSTERON_MKP, 0.0, 1.0, LEVELS, weights.cast(), WEIGHTS.len(),
        model.cast()
    );
    hysteron_core_run(model: Model, state: State, input: SERIES, output: SERIES) |_h|
        (model.cast(), state.cast(), input.cast(), output.cast(), 3);
    hysteron_core_shift_init(
        model: Model, stages: Stages, options: ShiftOptions, memory: Memory(shift_size), shift: Word
    ) |_h| (
        model.cast(), stages.cast(), options.cast(), memory, shift_size(), shift.cast()
    );
    hysteron_core_shift_inverse_step(
        shift: Shift, stages: Stages, model: Model, state: State, memory: StageState,
        limits: Limits, input: ONE, status: Integers(1)
    ) |_h| (
        shift.cast(), stages.cast(), model.cast(), state.cast(), memory.cast(), 1.0, HYSTERON_HOLD,
        0.0, 0.1, f64::NAN, limits.cast(), input.cast(), status.cast()
    );
    hysteron_core_shift_read(shift: Shift, stages: Stages, found: Found) |_h|
        (shift.cast(), stages.cast(), f64::NAN, found.cast());
    hysteron_core_shift_step(
        shift: Shift, stages: Stages, model: Model, state: State, memory: StageState,
        learning: Learning
    ) |_h| (
        shift.cast(), stages.cast(), model.cast(), state.cast(), memory.cast(), 0.5, 0.1, f64::NAN,
        1.0, learning.cast()
    );
    hysteron_core_shift_usual(model: Model, stages: Stages, options: ShiftOptions) |_h|
        (model.cast(), stages.cast(), options.cast());
    hysteron_core_stages_init(
        model: Model, constants: Constants, memory: Memory(stages_size), stages: Word
    ) |_h| (model.cast(), constants.cast(), memory, stages_size(), stages.cast());
    hysteron_core_stages_inverse_step(
        stages: Stages, model: Model, state: State, memory: StageState, limits: Limits, input: ONE,
        status: Integers(1)
    ) |_h| (
        stages.cast(), model.cast(), state.cast(), memory.cast(), 1.0, HYSTERON_HOLD, 0.0, 0.1,
        f64::NAN, limits.cast(), input.cast(), status.cast()
    );
    hysteron_core_stages_step(
        stages: Stages, model: Model, state: State, memory: StageState, output: ONE,
        clipped: Integers(1)
    ) |_h| (
        stages.cast(), model.cast(), state.cast(), memory.cast(), 0.5, 0.1, f64::NAN, output.cast(),
        clipped.cast()
    );
    hysteron_core_state_init(model: Model, memory: Memory(state_size), state: Word) |_h|
        (model.cast(), memory, state_size(), state.cast());
    hysteron_core_state_rebase(model: Model, state: State) |_h| (model.cast(), state.cast());
    hysteron_core_state_reset(model: Model, state: State) |_h| (model.cast(), state.cast());
    hysteron_core_state_restore(model: Model, state: State, points: POINTS) |_h|
        (model.cast(), state.cast(), points.cast(), 2, 0.5);
    hysteron_core_state_save(state: State, points: ROOM, count: Word, input: ONE) |_h|
        (state.cast(), points.cast(), 16, count.cast(), input.cast());
    hysteron_core_step(model: Model, state: State, output: ONE, clipped: Integers(1)) |_h|
        (model.cast(), state.cast(), 0.5, output.cast(), clipped.cast());
    hysteron_headings(target: SERIES, heading: Integers(3)) |_h|
        (target.cast(), 3, 0.0, heading.cast());
    hysteron_inverse_run(
        target: SERIES, heading: Integers(3), input: SERIES, status: Integers(3)
    ) |h| (h.state, target.cast(), heading.cast(), 0.0, input.cast(), status.cast(), 3);
    hysteron_inverse_run_in(
        target: SERIES, heading: Integers(3), time: TIMES, load: LOADS, limits: Limits,
        input: SERIES, status: Integers(3)
    ) |h| (
        h.loaded, target.cast(), heading.cast(), 0.0, time.cast(), 0.0, load.cast(), limits.cast(),
        input.cast(), status.cast(), 3
    );
    hysteron_inverse_step(input: ONE, status: Integers(1)) |h|
        (h.state, 1.0, HYSTERON_HOLD, 0.0, input.cast(), status.cast());
    hysteron_inverse_step_in(limits: Limits, input: ONE, status: Integers(1)) |h| (
        h.loaded, 1.0, HYSTERON_HOLD, 0.0, 0.1, 1.5, limits.cast(), input.cast(), status.cast()
    );
    hysteron_model_new(weights: SPRING, model: Word) |_h|
        (HYSTERON_MKP, 0.0, 1.0, LEVELS, weights.cast(), WEIGHTS.len(), 0.0, 1, model.cast());
    hysteron_model_parse(json: Json, model: Word) |_h| (json.cast(), model.cast());
    hysteron_model_quantity(text: Characters(32), needed: Word) |h|
        (h.model, 0, text.cast(), 32, needed.cast());
    hysteron_model_read(path: Path, model: Word) |_h| (path.cast(), model.cast());
    hysteron_model_weights(weights: ROOM, count: Word) |h|
        (h.model, weights.cast(), 16, count.cast());
    hysteron_run(input: SERIES, output: SERIES) |h| (h.state, input.cast(), output.cast(), 3);
    hysteron_run_in(
        input: SERIES, time: TIMES, load: LOADS, output: SERIES, clipped: Integers(3)
    ) |h| (
        h.loaded, input.cast(), time.cast(), 0.0, load.cast(), output.cast(), clipped.cast(), 3
    );
    hysteron_state_save(points: ROOM, count: Word, input: ONE) |h|
        (h.state, points.cast(), 16, count.cast(), input.cast());
    hysteron_step(output: ONE, clipped: Integers(1)) |h|
        (h.state, 0.5, output.cast(), clipped.cast());
    hysteron_step_in(output: ONE, clipped: Integers(1)) |h|
        (h.loaded, 0.5, 0.1, 1.5, output.cast(), clipped.cast());
}
