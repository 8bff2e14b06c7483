//! What a call through the C interface costs beside the same step in Rust: `cargo bench -p
//! hysteron-capi`.
#![allow(clippy::unwrap_used)]

#[allow(dead_code, reason = "the tests take the rest")]
#[path = "../../hysteron-core/tests/common/mod.rs"]
mod common;

#[path = "../../hysteron-core/benches/measure/mod.rs"]
mod measure;

use hysteron::{Model, Operator, Sign};
use hysteron_capi::*;
use measure::{definition, random_weights, ratio, seconds, smooth, title, unit_plane};
use std::hint::black_box;
use std::ptr::null_mut;

const SAMPLES: usize = 200_000;
const LEVELS: usize = 20;

/// Seconds per step of the façade.
fn rust(input: &[f64]) -> impl FnMut() -> f64 {
    let (plane, weights) = (unit_plane(LEVELS), random_weights(LEVELS));
    let model = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive).unwrap();
    let mut state = model.start();
    move || {
        seconds(input.len(), || {
            for &t in input {
                black_box(model.step(&mut state, black_box(t)).unwrap());
            }
        })
    }
}

fn ok(status: i32) {
    assert_eq!(status, HYSTERON_OK);
}

/// Seconds per step of a state in memory of the library, or of the caller.
fn state(input: &[f64], of_caller: bool) -> impl FnMut() -> f64 {
    let weights = random_weights(LEVELS);
    let (mut model, mut state) = (0, 0);
    let mut memory = Vec::new();
    // SAFETY: every pointer is one to a variable or array here, with its count.
    unsafe {
        let (weights, count) = (weights.as_ptr(), weights.len());
        ok(hysteron_model_new(
            HYSTERON_MKP,
            20.0,
            80.0,
            LEVELS,
            weights,
            count,
            0.0,
            1,
            &mut model,
        ));
        if of_caller {
            let bytes = hysteron_state_size(model);
            memory.resize(bytes / 8, 0_u64);
            let at = memory.as_mut_ptr().cast();
            ok(hysteron_state_place(model, at, bytes, &mut state));
        } else {
            ok(hysteron_state_new(model, &mut state));
        }
    }
    move || {
        let _ = &memory;
        seconds(input.len(), || {
            let mut output = 0.0;
            for &t in input {
                // SAFETY: as above.
                ok(unsafe { hysteron_step(state, black_box(t), &mut output, null_mut()) });
                black_box(output);
            }
        })
    }
}

fn main() {
    title();
    let input = smooth(SAMPLES);
    ratio(
        "handle / Rust step, K = 20",
        "",
        state(&input, false),
        rust(&input),
    );
    ratio(
        "caller's memory / Rust step, K = 20",
        "",
        state(&input, true),
        rust(&input),
    );
    let few = &input[..SAMPLES / 10];
    ratio(
        "definition / handle, K = 20",
        "",
        definition(LEVELS, few),
        state(&input, false),
    );
}
