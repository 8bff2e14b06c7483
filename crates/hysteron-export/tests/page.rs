//! The program of the page on microcontrollers, word for word.
#![allow(clippy::unwrap_used)]

mod common;

use common::programs::{has, page, run};
use common::{STRICT, here};
use hysteron::Model;
use hysteron_export::{COptions, CReal, c};
use std::process::Command;

#[test]
fn the_page_on_microcontrollers() {
    let (text, program) = page("microcontroller.md");
    // Wherever its lines are wrapped.
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let folder = tempfile::tempdir().unwrap();
    let vector = std::fs::read_to_string(here("../../vectors/inverse-mkp-20.json")).unwrap();
    let vector: serde_json::Value = serde_json::from_str(&vector).unwrap();
    let model = Model::from_json(&vector["model"].to_string()).unwrap();
    let options = COptions {
        real: CReal::Float,
        name: None,
        source: std::path::Path::new("spring.json"),
        adaptation: false,
    };
    let memory = c(&model, folder.path(), &options).unwrap().memory;
    for figure in [
        format!(
            "With 20 levels in `float` the constants take {} bytes",
            memory.constants
        ),
        format!("takes {} bytes of RAM", memory.state + memory.turns),
    ] {
        assert!(text.contains(&figure), "{figure}");
    }
    if !has("cc") {
        return;
    }
    std::fs::write(folder.path().join("main.c"), program).unwrap();
    let sources = [
        "main.c",
        "spring.c",
        "hysteron_mcu.c",
        "hysteron_mcu_inverse.c",
    ];
    run(Command::new("cc")
        .args(STRICT)
        .arg("-Wdouble-promotion")
        .args(sources)
        .args(["-o", "main"])
        .current_dir(folder.path()));
    run(Command::new("./main").current_dir(folder.path()));
}
