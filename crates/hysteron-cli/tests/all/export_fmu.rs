//! `hysteron export fmu` as a black box.

use crate::common::{json, refused, run, text};

const MODEL: &str = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
    "plane": {"min": 20, "max": 80, "levels": 2}, "weights": [1, 0.5, 2],
    "input": {"name": "temperature", "unit": "degC"},
    "output": {"name": "displacement", "unit": "mm"}}"#;

#[test]
fn both_blocks_in_both_standards() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("m.json"), MODEL).unwrap();
    let forward = json(here, "export fmu m.json -o sf_MKP.fmu");
    assert_eq!(
        (&forward["name"], &forward["fmi"]),
        (&"sf_MKP".into(), &"2.0".into())
    );
    assert_eq!(forward["inputs"], serde_json::json!(["temperature"]));
    assert_eq!(
        forward["outputs"],
        serde_json::json!(["displacement", "clipped"])
    );
    let inverse = json(
        here,
        "export fmu m.json --inverse --fmi 3 --name back -o back.fmu",
    );
    assert_eq!(
        (&inverse["name"], &inverse["fmi"]),
        (&"back".into(), &"3.0".into())
    );
    assert_eq!(
        inverse["inputs"],
        serde_json::json!(["displacement", "heading"])
    );
    assert_eq!(
        inverse["outputs"],
        serde_json::json!(["temperature", "status"])
    );
    assert_eq!(
        inverse["parameters"],
        serde_json::json!(["tolerance", "start_on"])
    );
    assert_ne!(forward["token"], inverse["token"]);
    let size = std::fs::metadata(here.join("back.fmu")).unwrap().len();
    assert_eq!(inverse["bytes"], size);
    let said = run(here, "export fmu m.json -o sf_MKP.fmu");
    assert!(said.status.success());
    assert!(
        text(&said.stdout).contains("sf_MKP.fmu: block sf_MKP"),
        "{}",
        text(&said.stdout)
    );
}

#[test]
fn a_controller_has_the_drives_of_the_model_or_those_given() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("m.json"), MODEL).unwrap();
    let export = "export fmu m.json --controller --dt 0.05 --gains 1,2";
    let own = json(here, &format!("{export} -o own.fmu"));
    assert_eq!(own["name"], "sf_Controller_MKP");
    // The plane is from 20 to 80 with two levels: its bottom is one step below.
    let same = json(here, &format!("{export} --drive-range -40,80 -o same.fmu"));
    assert_eq!(own["token"], same["token"]);
    let other = json(here, &format!("{export} --drive-range 30,70 -o other.fmu"));
    assert_ne!(own["token"], other["token"]);
    let done = run(here, "export fmu m.json --controller -o none.fmu");
    assert_eq!(done.status.code(), Some(2));
    assert!(
        text(&done.stderr).contains("--dt"),
        "{}",
        text(&done.stderr)
    );
}

#[test]
fn what_cannot_be_exported() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("m.json"), MODEL.replace("0.5", "-0.5")).unwrap();
    let error = refused(here, "export fmu m.json --inverse -o m.fmu");
    assert!(error.contains("weights that are not negative"), "{error}");
    assert!(refused(here, "export fmu m.json -o m.zip").contains("let it end with .fmu"));
    assert!(refused(here, "export fmu m.json -o m.fmu --load 5").contains("load"));
    assert!(
        refused(here, "export fmu m.json -o m.fmu --name 1").contains("choose one with --name")
    );
    assert!(refused(here, "export fmu none.json -o m.fmu").contains("none.json"));
    assert_eq!(
        run(here, "export fmu m.json -o m.fmu --fmi 1")
            .status
            .code(),
        Some(2)
    );
    std::fs::rename(here.join("m.json"), here.join("m.fmu")).unwrap();
    assert!(refused(here, "export fmu m.fmu -o m.fmu").contains("replace a file that is read"));
}
