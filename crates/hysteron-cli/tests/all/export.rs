//! `hysteron export c` as a black box.

use crate::common::{json, refused, run, text};
use std::fs;

/// A model with weights that are not negative, and one with some that are.
fn models() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, first) in [("spring.json", "1"), ("butterfly.json", "-1")] {
        let model = format!(
            r#"{{"format": "hysteron-model", "version": 1, "operator": "mkp",
                "plane": {{"min": 20, "max": 80, "levels": 3}},
                "output": {{"name": "lift", "unit": "mm", "offset": 0.5, "sign": -1}},
                "weights": [{first}, 0.5, 1, 0, 0.5, 1]}}"#
        );
        fs::write(folder.path().join(name), model).unwrap();
    }
    folder
}

#[test]
fn files_and_figures_as_json() {
    let folder = models();
    let said = json(folder.path(), "export c spring.json -o mcu");
    let files: Vec<&str> = said["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f.as_str().unwrap())
        .collect();
    assert_eq!(
        files,
        [
            "mcu/hysteron_mcu.h",
            "mcu/hysteron_mcu.c",
            "mcu/hysteron_mcu_inverse.c",
            "mcu/hysteron_mcu_internal.h",
            "mcu/spring.h",
            "mcu/spring.c",
            "mcu/spring.mk",
            "mcu/spring.cmake"
        ]
    );
    for file in files {
        assert!(folder.path().join(file).exists(), "{file}");
    }
    assert_eq!(
        (said["name"].as_str(), said["real"].as_str()),
        (Some("spring"), Some("float"))
    );
    assert_eq!(
        (said["levels"].as_u64(), said["inverse"].as_bool()),
        (Some(3), Some(true))
    );
    // Ten numbers in the table and ten in the struct; 4K + 8 turning points.
    assert_eq!(said["flash_bytes"], 4 * 10 + 52);
    assert_eq!(said["ram_bytes"]["state"], 40);
    assert_eq!(said["ram_bytes"]["turns"], 20 * 8);
    assert_eq!(said["worst_case"]["turning_points_passed"], 6);
    let wide = json(
        folder.path(),
        "export c spring.json -o wide --real double --name left",
    );
    assert_eq!(
        (wide["name"].as_str(), wide["real"].as_str()),
        (Some("left"), Some("double"))
    );
    assert_eq!(wide["ram_bytes"]["turns"], 20 * 16);
}

#[test]
fn a_model_that_learns() {
    let folder = models();
    let said = json(folder.path(), "export c spring.json -o mcu --adaptation");
    assert_eq!(said["files"].as_array().unwrap().len(), 13);
    assert!(
        said["ram_bytes"]["adaptation"].as_u64().unwrap() > 100,
        "{said}"
    );
    assert!(folder.path().join("mcu/hysteron_mcu_adapt.c").exists());
    let said = refused(
        folder.path(),
        "export c butterfly.json -o other --adaptation",
    );
    assert!(said.contains("below zero"), "{said}");
}

#[test]
fn it_says_what_it_wrote() {
    let folder = models();
    let done = run(folder.path(), "export c butterfly.json -o mcu");
    assert!(done.status.success(), "{}", text(&done.stderr));
    let said = text(&done.stdout);
    assert!(
        said.contains("mcu/butterfly.h") && said.contains("bytes") && said.contains("forward only"),
        "{said}"
    );
}

#[test]
fn bad_names_and_folders_are_refused() {
    let folder = models();
    for name in ["7up", "int", "a-b", "hys_spring", "sin"] {
        let said = refused(
            folder.path(),
            &format!("export c spring.json -o mcu --name {name}"),
        );
        assert!(said.contains(name) && said.contains("--name"), "{said}");
    }
    assert!(!folder.path().join("mcu").exists());
    json(folder.path(), "export c spring.json -o mcu");
    let said = refused(folder.path(), "export c spring.json -o mcu --real double");
    assert!(
        said.contains("hysteron_mcu.h") && said.contains("--real float"),
        "{said}"
    );
    let said = refused(folder.path(), "export c absent.json -o mcu");
    assert!(said.contains("absent.json"), "{said}");
    assert_eq!(
        run(folder.path(), "export c spring.json -o mcu --real half")
            .status
            .code(),
        Some(2)
    );
}

#[test]
fn a_model_with_a_thermal_body() {
    let folder = models();
    let spring = fs::read_to_string(folder.path().join("spring.json")).unwrap();
    let thermal = r#""thermal": {"kind": "first-order", "tau_heating": 1.0, "tau_cooling": 1.0,
        "gain": 1.0}, "weights""#;
    fs::write(
        folder.path().join("wire.json"),
        spring.replace("\"weights\"", thermal),
    )
    .unwrap();
    let said = refused(folder.path(), "export c wire.json -o mcu");
    assert!(said.contains("--dt"), "{said}");
    assert!(!folder.path().join("mcu").exists());
    let said = refused(folder.path(), "export c spring.json -o mcu --dt 0.1");
    assert!(said.contains("leave --dt out"), "{said}");
    let said = json(
        folder.path(),
        "export c wire.json -o mcu --dt 0.1 --drive-range 20,80",
    );
    assert_eq!(said["stages"], serde_json::json!(["body"]));
    assert_eq!(
        (&said["dt"], said["files"].as_array().unwrap().len()),
        (&0.1.into(), 14)
    );
    let source = fs::read_to_string(folder.path().join("mcu/wire.c")).unwrap();
    assert!(source.contains(".drive_max = 80.0f"), "{source}");
    let said = json(folder.path(), "export fmu wire.json -o wire.fmu");
    assert_eq!(
        said["outputs"],
        serde_json::json!(["lift", "clipped", "temperature"])
    );
}

#[test]
fn a_loop_and_a_library_for_arduino() {
    let folder = models();
    let gains = "--gains 0.5,0.2";
    let said = json(
        folder.path(),
        &format!("export c spring.json -o loop --controller --dt 0.05 {gains}"),
    );
    assert_eq!(said["files"].as_array().unwrap().len(), 10);
    assert_eq!(said["control"]["gains"]["integral_s"], 0.2);
    assert!(
        said["ram_bytes"]["controller"].as_u64().unwrap() > 80,
        "{said}"
    );
    // Parts that are asked for.
    let parts = "--gate 0.1 --filter 0.2 --measured-dt";
    let more = json(
        folder.path(),
        &format!("export c spring.json -o parts --controller --dt 0.05 {gains} {parts}"),
    );
    assert_eq!(more["files"].as_array().unwrap().len(), 14);
    assert_eq!(
        (&more["control"]["gate"], &more["control"]["filter_s"]),
        (&0.1.into(), &0.2.into())
    );
    let bytes = |said: &serde_json::Value| said["ram_bytes"]["controller"].as_u64().unwrap();
    // Of a gate 18 numbers and 3 bytes, of a filter 3 numbers, and the time.
    assert_eq!(bytes(&more), bytes(&said) + 92);
    // A loop whose model learns.
    let said = json(
        folder.path(),
        &format!("export c spring.json -o both --controller --adaptation --dt 0.05 {gains}"),
    );
    assert_eq!(said["files"].as_array().unwrap().len(), 17);
    assert!(said["ram_bytes"]["adaptation"].is_u64() && said["control"]["dt"] == 0.05);
    // Without gains they come from the model.
    let said = json(
        folder.path(),
        "export arduino spring.json -o spring --drive-range 20,80",
    );
    assert!(
        said["control"]["gains"]["gain"].as_f64().unwrap() < 0.0,
        "{said}"
    );
    assert!(
        said["sketch_bytes"]["ram"].as_u64().unwrap() <= 2048,
        "{said}"
    );
    let done = run(
        folder.path(),
        &format!("export arduino spring.json -o spring {gains}"),
    );
    assert!(
        text(&done.stdout).contains("of 32256 and"),
        "{}",
        text(&done.stdout)
    );
    let refusals = [
        ("export c spring.json -o other --controller", "--dt"),
        (
            "export arduino butterfly.json -o other --gains 1",
            "weights below zero",
        ),
        (
            "export arduino spring.json -o other --gains 1,2,3,4",
            "0.05,0.5,0",
        ),
    ];
    for (command, words) in refusals {
        let done = run(folder.path(), command);
        assert!(
            !done.status.success() && text(&done.stderr).contains(words),
            "{command}"
        );
        assert!(!folder.path().join("other").exists());
    }
}
