//! The table: one row for a function.

use super::Argument::{
    Characters, Control, Doubles, Integers, Json, Limits, Memory, ModelHandle, Options, Path,
    ShiftOptions, Word,
};
use super::{Call, LEVELS, WEIGHTS, adaptive_load_size, adaptive_size, state_size};
use hysteron_capi::*;

/// One number, of whatever value.
const ONE: super::Argument = Doubles(&[0.5]);
const SERIES: super::Argument = Doubles(&[0.5, 1.0, 0.25]);
const TIMES: super::Argument = Doubles(&[0.0, 1.0, 1.5]);
const LOADS: super::Argument = Doubles(&[1.0, 2.0, 1.25]);
const ROOM: super::Argument = Doubles(&[0.0; 16]);
/// As many numbers as an action has.
const ACTION: super::Argument = Doubles(&[0.0; 6]);
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
        (h.adaptive, 1.0, HYSTERON_HOLD, 0.0, f64::NAN, input.cast(), status.cast());
    hysteron_adaptive_load_new(options: ShiftOptions, adaptive: Word) |h|
        (h.model, f64::NAN, options.cast(), adaptive.cast());
    hysteron_adaptive_load_place(
        options: ShiftOptions, memory: Memory(adaptive_load_size), adaptive: Word
    ) |h| (
        h.model, f64::NAN, options.cast(), memory, adaptive_load_size(h), adaptive.cast()
    );
    hysteron_adaptive_new(options: Options, adaptive: Word) |h|
        (h.model, options.cast(), adaptive.cast());
    hysteron_adaptive_place(
        options: Options, memory: Memory(adaptive_size), adaptive: Word
    ) |h| (h.model, options.cast(), memory, adaptive_size(h), adaptive.cast());
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
    hysteron_controller_new(control: Control, controller: Word) |h|
        (control.cast(), h.model, 0, controller.cast());
    hysteron_controller_step(next: SERIES, action: ACTION) |h| (
        h.controller, f64::NAN, 1.0, HYSTERON_HOLD, next.cast(), 3, 0.5, f64::NAN, action.cast()
    );
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
    hysteron_state_place(memory: Memory(state_size), state: Word) |h|
        (h.model, memory, state_size(h), state.cast());
    hysteron_state_save(points: ROOM, count: Word, input: ONE) |h|
        (h.state, points.cast(), 16, count.cast(), input.cast());
    hysteron_state_save_inputs(inputs: ROOM, count: Word) |h|
        (h.state, inputs.cast(), 16, count.cast());
    hysteron_step(output: ONE, clipped: Integers(1)) |h|
        (h.state, 0.5, output.cast(), clipped.cast());
    hysteron_step_in(output: ONE, clipped: Integers(1)) |h|
        (h.loaded, 0.5, 0.1, 1.5, output.cast(), clipped.cast());
}
