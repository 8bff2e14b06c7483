//! Writes the models and runs as Rust constants, and gives the linker the memory map of the board.

#[path = "src/data.rs"]
#[allow(dead_code)]
mod data;
#[path = "src/staged.rs"]
#[allow(dead_code)]
mod staged;

use std::env::var;
use std::fmt::Write;
use std::path::Path;

fn main() {
    let vectors = Path::new("../../vectors");
    println!("cargo:rerun-if-changed=../../vectors");
    println!("cargo:rerun-if-changed=src/data.rs");
    println!("cargo:rerun-if-changed=src/staged.rs");
    println!("cargo:rerun-if-changed=memory.x");
    let (models, runs) = data::all(vectors);
    let mut text = String::from("pub static MODELS: &[Model] = &[\n");
    for m in &models {
        writeln!(text, "{},", literal(m)).expect("text");
    }
    text.push_str("];\npub static RUNS: &[Run] = &[\n");
    for r in &runs {
        writeln!(
            text,
            "Run {{ name: {:?}, model: {}, tolerance: {:?}, steps: &{:?} }},",
            r.name, r.model, r.tolerance, r.steps
        )
        .expect("text");
    }
    text.push_str("];\n");
    let (staged_models, staged_runs) = staged::all(vectors);
    text.push_str("pub static STAGED: &[Staged] = &[\n");
    for m in &staged_models {
        let constants = m.constants.iter();
        let constants: String = constants
            .map(|(name, list)| format!("({name:?}, &{list:?}), "))
            .collect();
        let parts = m.parts.iter();
        let parts: String = parts
            .map(|(offset, weights)| format!("({offset:?}, &{weights:?}), "))
            .collect();
        writeln!(
            text,
            "Staged {{ model: {}, constants: &[{constants}], parts: &[{parts}], range: {:?}, drive: {:?}, dt: {:?} }},",
            literal(&m.model), m.range, m.drive, m.dt
        )
        .expect("text");
    }
    text.push_str("];\npub static STAGED_RUNS: &[StagedRun] = &[\n");
    for r in &staged_runs {
        writeln!(
            text,
            "StagedRun {{ name: {:?}, model: {}, tolerance: {:?}, steps: &{:?} }},",
            r.name, r.model, r.tolerance, r.steps
        )
        .expect("text");
    }
    text.push_str("];\n");
    let out = var("OUT_DIR").expect("cargo sets it");
    std::fs::write(Path::new(&out).join("runs.rs"), text).expect("the constants");

    // The image whose size is measured has one model.
    println!("cargo:rerun-if-env-changed=LEVELS");
    let levels = var("LEVELS").map_or(20, |levels| levels.parse().expect("LEVELS: a number"));
    let model = models.iter().find(|m| m.name == format!("bench_{levels}"));
    let weights = &model.expect("LEVELS: 10, 20 or 40").weights;
    let text = format!(
        "pub const LEVELS: usize = {levels};\npub static WEIGHTS: [Real; {}] = {weights:?};\n",
        weights.len()
    );
    std::fs::write(Path::new(&out).join("size.rs"), text).expect("the constants");

    if var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "none") {
        let here = var("CARGO_MANIFEST_DIR").expect("cargo sets it");
        println!("cargo:rustc-link-search={here}");
        println!("cargo:rustc-link-arg-bins=-Tlink.x");
    }
}

fn literal(m: &data::Model) -> String {
    let operator = match m.operator.as_str() {
        "mkp" => "Mkp",
        "kp" => "Kp",
        _ => "Relay",
    };
    format!(
        "Model {{ operator: Operator::{operator}, min: {:?}, max: {:?}, levels: {}, offset: {:?}, sign: {:?}, weights: &{:?} }}",
        m.min, m.max, m.levels, m.offset, m.sign, m.weights
    )
}
