//! The program of the page on microcontrollers, word for word.

use crate::common::programs::{has, page, run};
use crate::common::{STRICT, here};
use hysteron::control::Scheme;
use hysteron::{FirstOrder, Model, Operator, Plane, Sign};
use hysteron_export::{COptions, CReal, CSampling, c, c_controlled, c_sampled};
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

/// The second program, of an actuator with stages.
#[test]
fn the_actuator_on_the_page() {
    if !has("cc") {
        return;
    }
    let page = std::fs::read_to_string(here("../../docs/microcontroller.md")).unwrap();
    let program = page.split("```c\n").nth(2).unwrap();
    let program = program.split("```").next().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let vector = std::fs::read_to_string(here("../../vectors/inverse-mkp-20.json")).unwrap();
    let vector: serde_json::Value = serde_json::from_str(&vector).unwrap();
    let mut model = Model::from_json(&vector["model"].to_string()).unwrap();
    model.thermal = Some(FirstOrder {
        gain: 100.0,
        tau_heating: 1.0,
        tau_cooling: 2.0,
        ..FirstOrder::default()
    });
    let options = COptions {
        real: CReal::Float,
        name: None,
        source: std::path::Path::new("wire.json"),
        adaptation: false,
    };
    let sampling = CSampling {
        dt: Some(0.01),
        drive: Some((0.0, 1.0)),
        ..CSampling::default()
    };
    c_sampled(&model, folder.path(), &options, &sampling).unwrap();
    std::fs::write(folder.path().join("main.c"), program).unwrap();
    let sources = [
        "main.c",
        "wire.c",
        "hysteron_mcu.c",
        "hysteron_mcu_inverse.c",
        "hysteron_mcu_stages.c",
        "hysteron_mcu_stages_inverse.c",
    ];
    run(Command::new("cc")
        .args(STRICT)
        .arg("-Wdouble-promotion")
        .args(sources)
        .args(["-o", "main"])
        .current_dir(folder.path()));
    run(Command::new("./main").current_dir(folder.path()));
}

/// The loop around it.
#[test]
fn the_loop_on_the_page() {
    if !has("cc") {
        return;
    }
    let page = std::fs::read_to_string(here("../../docs/microcontroller.md")).unwrap();
    let part = page.split("```c\n").nth(3).unwrap();
    let part = part.split("```").next().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let plane = Plane::new(20.0, 80.0, 5).unwrap();
    let mut model = Model::new(Operator::Mkp, plane, vec![1.0; 15], 0.0, Sign::Positive).unwrap();
    model.thermal = Some(FirstOrder {
        gain: 100.0,
        ..FirstOrder::default()
    });
    let options = COptions {
        real: CReal::Float,
        name: None,
        source: std::path::Path::new("wire.json"),
        adaptation: false,
    };
    let sampling = CSampling {
        dt: Some(0.01),
        drive: None,
        ..CSampling::default()
    };
    let scheme = Scheme::new(0.01, (0.0, 1.0));
    let made = c_controlled(&model, folder.path(), &options, &sampling, &scheme).unwrap();
    let program = format!(
        "#include \"wire.h\"\nstatic hys_real written;\n\
         static void write_drive(hys_real drive) {{ written = drive; }}\n\
         int main(void) {{ hys_real reference = 4, reading = 0;\n{part}\
         return !(written >= 0 && written <= 1); }}\n"
    );
    std::fs::write(folder.path().join("main.c"), program).unwrap();
    let sources = made
        .files
        .iter()
        .filter(|file| file.extension().is_some_and(|end| end == "c"));
    run(Command::new("cc")
        .args(STRICT)
        .arg("-Wdouble-promotion")
        .arg("main.c")
        .args(sources)
        .args(["-o", "main"])
        .current_dir(folder.path()));
    run(Command::new("./main").current_dir(folder.path()));
}

/// The loop that learns.
#[test]
fn the_loop_that_learns_on_the_page() {
    if !has("cc") {
        return;
    }
    let page = std::fs::read_to_string(here("../../docs/microcontroller.md")).unwrap();
    let part = page.split("```c\n").nth(4).unwrap();
    let part = part.split("```").next().unwrap();
    let (before, sample) = part.split_once("/* At each sample").unwrap();
    let sample = sample.split_once("*/").unwrap().1;
    let folder = tempfile::tempdir().unwrap();
    let plane = Plane::new(0.0, 1.0, 5).unwrap();
    let model = Model::new(Operator::Mkp, plane, vec![0.4; 15], 0.0, Sign::Positive).unwrap();
    let options = COptions {
        real: CReal::Float,
        name: None,
        source: std::path::Path::new("spring.json"),
        adaptation: true,
    };
    let scheme = Scheme::new(0.05, (0.0, 1.0));
    let sampling = CSampling::default();
    let made = c_controlled(&model, folder.path(), &options, &sampling, &scheme).unwrap();
    // A plant of 0.7 times the stroke: only a model that has learned leads it to 2.
    let program = format!(
        "#include \"spring.h\"\n#include <stdio.h>\nstatic hys_real written;\n\
         static void write_drive(hys_real drive) {{ written = drive; }}\n\
         int main(void) {{\n\
         static hys_turn own[SPRING_TURNS];\nstatic hys_state plant;\n\
         hys_real reference, reading;\nint n;\n{before}\
         if (hys_start(&spring, &plant, own, SPRING_TURNS) != HYS_OK) {{ return 2; }}\n\
         for (n = 0; n < 2000; n++) {{\n\
         int up = n / 50 % 2;\n\
         reference = n < 1900 ? (up ? 1.0f : 2.5f) + (up ? 1.5f : -1.5f) * (hys_real)(n % 50) / 50 : 2;\n\
         hys_step(&plant, written, &reading);\nreading = 0.7f * reading;\n{sample}}}\n\
         printf(\"%g\\n\", (double)reading);\nreturn !(reading > 1.9f && reading < 2.1f); }}\n"
    );
    std::fs::write(folder.path().join("main.c"), program).unwrap();
    let sources = made.files.iter();
    let sources = sources.filter(|file| file.extension().is_some_and(|end| end == "c"));
    run(Command::new("cc")
        .args(STRICT)
        .arg("-Wdouble-promotion")
        .arg("main.c")
        .args(sources)
        .args(["-o", "main"])
        .current_dir(folder.path()));
    run(Command::new("./main").current_dir(folder.path()));
}
