//! `hysteron track` as a black box.

use crate::common::{json, refused, run, text};
use std::fs;
use std::path::Path;

/// A scenario that takes a second: the load step, cut short and coarse.
fn short(folder: &Path) -> String {
    let shown = run(folder, "track load-step --show");
    assert!(shown.status.success());
    let scenario = text(&shown.stdout)
        .replace("duration_s = 3600", "duration_s = 500")
        .replace("at_s = 1500", "at_s = 250")
        .replace("settle_s = 120", "settle_s = 50")
        .replace("levels = 20", "levels = 10");
    fs::write(folder.join("short.toml"), &scenario).unwrap();
    scenario
}

#[test]
fn compares_controllers_and_writes_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    short(path);
    let object = json(path, "track short.toml --seeds 2 -o out");
    assert_eq!(object["simulated"], true);
    assert_eq!(object["seeds"], 2);
    let medians = object["medians"].as_array().unwrap();
    // Seven controllers in three windows.
    assert_eq!(medians.len(), 21);
    assert!(medians.iter().all(|m| m["rmse"].as_f64().unwrap() > 0.0));
    let page = fs::read_to_string(path.join("out/report/index.html")).unwrap();
    assert!(page.contains("simulated") && page.contains("adaptive inverse + PID, hold"));
    let scores = fs::read_to_string(path.join("out/scores.csv")).unwrap();
    assert_eq!(scores.lines().count(), 1 + 7 * 2 * 3);
    let curve = fs::read_to_string(path.join("out/adaptive-pid.csv")).unwrap();
    assert_eq!(curve.lines().count(), 1 + 2500);
    // The model that the first run was made with is one that other commands read.
    let model = json(path, "inspect out/model.json");
    assert_eq!(
        model["model"]["levels"]
            .as_u64()
            .or(model["levels"].as_u64()),
        Some(10)
    );

    let again = json(path, "track short.toml --seeds 2");
    assert_eq!(
        again["medians"], object["medians"],
        "the same seeds, the same figures"
    );
}

#[test]
fn names_its_scenarios() {
    let folder = tempfile::tempdir().unwrap();
    let listed = text(&run(folder.path(), "track --list").stdout);
    for name in listed.lines() {
        let shown = run(folder.path(), &format!("track {name} --show"));
        assert!(text(&shown.stdout).contains("[plant]"), "{name}");
    }
    assert!(listed.lines().any(|name| name == "load-step"));
}

#[test]
fn says_what_is_wrong_with_a_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let scenario = short(path);
    let cases = [
        ("interval_s = 0.2", "interval_s = -0.2", "`interval_s`"),
        ("interval_s = 0.2", "intervals_s = 0.2", "unknown field"),
        ("kind = \"spring\"", "kind = \"rubber\"", "rubber"),
        ("load_n = 6.0", "load_n = 60.0", "60"),
        ("at_s = 250", "at_s = 9000", "disturbance"),
        ("period_s = 300", "period_s = 0", "reference"),
        (
            "[loop]",
            "[adaptation]\nmethod = \"least-squares\"\nforgetting = 1.5\n[loop]",
            "forgetting",
        ),
        ("levels = 10", "levels = 1", "levels"),
    ];
    for (from, to, expected) in cases {
        assert!(scenario.contains(from), "{from}");
        fs::write(path.join("bad.toml"), scenario.replace(from, to)).unwrap();
        let said = refused(path, "track bad.toml --seeds 1 -o out");
        assert!(said.contains(expected), "{to}: {said}");
        assert!(!path.join("out").exists(), "{to}: nothing is half-written");
    }
    let said = refused(path, "track nowhere.toml");
    assert!(said.contains("load-step"), "{said}");
    assert!(refused(path, "track mine --show").contains("no built-in"));
    assert_eq!(run(path, "track").status.code(), Some(2));
    assert_eq!(
        run(path, "track load-step --seeds 0").status.code(),
        Some(2)
    );
}
