//! Writes the header from the code: `cargo run -p hysteron-capi --example header`

use cbindgen::{Builder, Config, Language};
use std::error::Error;
use std::path::{Path, PathBuf};

const ABOUT: &str = "\
/* The C interface of hysteron: models of hysteresis, their exact inverse, and adaptation.
 *
 * Generated from the code by `cargo run -p hysteron-capi --example header`. Do not edit.
 *
 * Every function that can fail returns HYSTERON_OK or another of the codes below. Results are
 * written only with HYSTERON_OK. Exceptions are counts, which then give the size needed, and
 * arrays, which may then have zeros.
 *
 * A pointer points to as many elements as the count beside it says, one where there is no count. No
 * two pointers of a call may share memory: HYSTERON_OVERLAP, and nothing is written.
 *
 * A model may have stages around its operators: a thermal body, a load, creep, a lag, a ring.
 * Samples then need the time since the sample before, or a load. The functions whose names end with `_in` take
 * both; NAN stands for one that is not given. The `input` of a sample is the one held since the
 * sample before.
 *
 * Handles (uint64_t) are numbers. A handle that was freed or never given is refused. Handles may be
 * used from any thread.
 *
 * A state or a learner has its numbers in memory of the library (`..._new`), or in memory of the
 * caller (`..._size`, `..._place`). All other functions are the same for both. Over memory of the
 * caller they allocate nothing, but for `hysteron_adaptive_model`, `hysteron_state_half_width` and
 * the start HYSTERON_START_FITTED. The memory must stay where it is until the object is freed.
 * Another object that is made in it ends the one before, whose handle is then refused.
 */";

/// The header in the repository.
pub fn place() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("include/hysteron.h")
}

/// The header generated from the code.
pub fn generated() -> Result<String, Box<dyn Error>> {
    let config = Config {
        language: Language::C,
        header: Some(ABOUT.into()),
        include_guard: Some("HYSTERON_H".into()),
        no_includes: true,
        sys_includes: vec!["stddef.h".into(), "stdint.h".into()],
        cpp_compat: true,
        usize_is_size_t: true,
        line_length: 120,
        ..Config::default()
    };
    let bindings = Builder::new()
        .with_crate(env!("CARGO_MANIFEST_DIR"))
        .with_config(config)
        .generate()?;
    let mut text = Vec::new();
    bindings.write(&mut text);
    Ok(String::from_utf8(text)?)
}

#[allow(dead_code, reason = "the test takes this file as a module")]
fn main() -> Result<(), Box<dyn Error>> {
    Ok(std::fs::write(place(), generated()?)?)
}
