//! Gate, filter and measured time of a loop: what they take, what has to fit, and that nothing of
//! them is exported where they are not asked for.

use crate::common::programs::{has, run};
use crate::common::{STRICT, here};
use hysteron::control::Scheme;
use hysteron::{Error, FirstOrder, Model, Operator, Plane, Sign};
use hysteron_export::{ArduinoOptions, CExport, COptions, CReal, CSampling, arduino};
use hysteron_export::{c_controlled, c_sampled};
use std::path::Path;
use std::process::Command;

fn plain() -> Model {
    let plane = Plane::new(0.0, 1.0, 5).unwrap();
    Model::new(Operator::Mkp, plane, vec![1.0; 15], 0.0, Sign::Positive).unwrap()
}

/// With a thermal body.
fn staged() -> Model {
    let mut model = plain();
    model.thermal = Some(FirstOrder::default());
    model
}

fn export(model: &Model, name: &str, real: CReal, parts: u8, folder: &Path) -> CExport {
    let options = COptions {
        real,
        name: Some(name),
        source: Path::new("some model.json"),
        adaptation: false,
    };
    let sampling = CSampling {
        dt: model.is_timed().then_some(0.05),
        drive: None,
        measured: parts & 4 > 0,
    };
    let scheme = Scheme {
        gate: (parts & 1 > 0).then_some(0.1),
        filter_s: if parts & 2 > 0 { 0.3 } else { 0.0 },
        delay: Some(3),
        ..Scheme::new(0.05, (0.0, 1.0))
    };
    c_controlled(model, folder, &options, &sampling, &scheme).unwrap()
}

/// Also counts the files: nothing else in them is compiled.
#[test]
fn each_part_takes_what_is_told_where_it_is_asked_for() {
    const ARM: &str = "arm-none-eabi-gcc";
    let compiles = has(ARM);
    for (parts, real) in (0..8).flat_map(|parts| [(parts, CReal::Float), (parts, CReal::Double)]) {
        for model in [plain(), staged()] {
            let folder = tempfile::tempdir().unwrap();
            let made = export(&model, "one", real, parts, folder.path());
            let clocked = parts & 4 > 0 && model.is_timed();
            for (file, is_there) in [
                ("hysteron_mcu_gate.c", parts & 1 > 0),
                ("hysteron_mcu_filter.h", parts & 2 > 0),
                ("hysteron_mcu_decay.c", parts & 2 > 0 || clocked),
                ("hysteron_mcu_clock.c", clocked),
            ] {
                assert_eq!(
                    folder.path().join(file).exists(),
                    is_there,
                    "{parts} {file}"
                );
            }
            let header = folder.path().join("hysteron_mcu_control.h");
            let header = std::fs::read_to_string(header).unwrap();
            assert!(header.contains(&format!("#define HYS_LOOP {parts}u\n")));
            let (mut constants, mut ram) = (
                "sizeof(hys_model) + sizeof table + sizeof(hys_control)".to_owned(),
                "sizeof(hys_controller) + 2 * sizeof(hys_real)".to_owned(),
            );
            if model.is_timed() {
                constants += " + sizeof(hys_actuator)";
            }
            if clocked {
                constants += " + sizeof(hys_times)";
                ram += " + sizeof(hys_actuator)";
            }
            let text = format!(
                "#include \"one.c\"\n\
                 typedef char constants[{constants} == {} ? 1 : -1];\n\
                 typedef char ram[{ram} == {} ? 1 : -1];\n",
                made.memory.constants,
                made.memory.controller.unwrap()
            );
            std::fs::write(folder.path().join("sizes.c"), text).unwrap();
            let flags = ["-std=c99", "-ffreestanding", "-mcpu=cortex-m4", "-c"];
            if compiles {
                let mut arm = Command::new(ARM);
                run(arm.args(flags).arg("sizes.c").current_dir(folder.path()));
            }
        }
    }
}

#[test]
fn models_of_a_folder_need_the_same_parts() {
    let folder = tempfile::tempdir().unwrap();
    let made = export(&plain(), "one", CReal::Float, 1, folder.path());
    let other = export(&plain(), "other", CReal::Float, 3, folder.path());
    if !has("cc") {
        return;
    }
    let compiles = |name: &str| {
        let mut cc = Command::new("cc");
        cc.args(["-std=c99", "-c", name]).current_dir(folder.path());
        let done = cc.output().unwrap();
        (
            done.status.success(),
            String::from_utf8(done.stderr).unwrap(),
        )
    };
    assert!(compiles("one.c").0 && compiles("other.c").0, "it has more");
    export(&plain(), "other", CReal::Float, 2, folder.path());
    let (done, said) = compiles("one.c");
    assert!(
        !done && said.contains("one: export all models of this folder"),
        "{said}"
    );
    assert!(compiles("other.c").0 && made.files != other.files);
}

#[test]
fn a_time_that_cannot_be_changes_nothing() {
    if !has("cc") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let made = export(&staged(), "wire", CReal::Double, 7, folder.path());
    let sources = made.files.iter();
    let sources = sources.filter(|file| file.extension().is_some_and(|end| end == "c"));
    run(Command::new("cc")
        .args(STRICT)
        .arg(here("tests/mcu/parts.c"))
        .args(sources)
        .args(["-I.", "-o", "main", "-lm"])
        .current_dir(folder.path()));
    run(Command::new("./main").current_dir(folder.path()));
}

#[test]
fn what_the_target_does_not_have_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let options = COptions {
        real: CReal::Float,
        name: Some("one"),
        source: Path::new("one.json"),
        adaptation: false,
    };
    let sampling = CSampling {
        dt: Some(0.05),
        drive: None,
        measured: true,
    };
    let says = |error: Error, what: &str| assert!(error.to_string().contains(what), "{error}");
    let alone = c_sampled(&staged(), folder.path(), &options, &sampling);
    says(alone.unwrap_err(), "for a controller");
    let mut file: serde_json::Value = serde_json::from_str(&plain().to_json()).unwrap();
    file["version"] = 3.into();
    file["stages"] = serde_json::json!({"ring_frequency": [2.0], "ring_damping": [0.5]});
    let model = Model::from_json(&file.to_string()).unwrap();
    let scheme = Scheme::new(0.05, (0.0, 1.0));
    let rings = c_controlled(&model, folder.path(), &options, &sampling, &scheme);
    says(rings.unwrap_err(), "a ring");
    let sketch = ArduinoOptions {
        name: Some("one"),
        source: Path::new("one.json"),
        board: hysteron_export::Board::Uno,
        adaptation: false,
    };
    let gated = Scheme {
        gate: Some(0.1),
        ..scheme
    };
    let still = CSampling::default();
    let sketched = arduino(&plain(), folder.path(), &sketch, &still, &gated);
    says(sketched.unwrap_err(), "no gate");
}
