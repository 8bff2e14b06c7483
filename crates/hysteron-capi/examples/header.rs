//! Writes the header from the code: `cargo run -p hysteron-capi --example header`

use cbindgen::{Builder, Config, Language};
use std::error::Error;
use std::path::{Path, PathBuf};

const ABOUT: &str = "\
/* The C interface of hysteron: models of hysteresis, their exact inverse, and adaptation.
 *
 * Made from the code by `cargo run -p hysteron-capi --example header`: not to be edited.
 *
 * Every function that can fail returns HYSTERON_OK or another of the codes below; outputs are written only with HYSTERON_OK, but
 * for counts that say how much room is needed, and arrays, which may then hold zeros. Pointers point to as many elements as the
 * count beside them says. No two of a call may share memory: HYSTERON_OVERLAP, and nothing is written.
 * Handles (uint64_t) are numbers: one that was freed, or never given, is refused.
 * Functions `hysteron_core_...` allocate nothing: their objects lie in the caller's memory, must not be moved, and
 * end with it. Where an initialisation fails in memory that holds an object, that object is as it was, or refused from
 * then on: HYSTERON_HANDLE. Their outputs are the sum over the operators, without offset and sign. An object that a call
 * changes belongs to one thread at a time there; handles may be used from any thread.
 */";

/// The header that is in the repository.
pub fn place() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("include/hysteron.h")
}

/// The header that follows from the code.
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
