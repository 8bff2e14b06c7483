//! `hysteron design` as a black box.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;

const PLAN: &str = "design --range 20,80 --levels 8 --heating-rate 2 --cooling-rate 0.5";

/// Exit code, standard output, standard error.
fn run(folder: &Path, line: &str) -> (i32, String, String) {
    let output = Command::cargo_bin("hysteron")
        .unwrap()
        .current_dir(folder)
        .args(line.split_whitespace())
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code().unwrap(),
        text(output.stdout),
        text(output.stderr),
    )
}

fn json(folder: &Path, line: &str) -> Value {
    let (code, out, err) = run(folder, line);
    assert_eq!(code, 0, "{line}: {err}");
    serde_json::from_str(&out).unwrap()
}

fn table(path: &Path) -> Vec<(f64, f64)> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time [s],input"));
    lines
        .map(|line| {
            let (time, input) = line.split_once(',').unwrap();
            (time.parse().unwrap(), input.parse().unwrap())
        })
        .collect()
}

#[test]
fn plans_a_profile_that_determines_everything() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let object = json(
        path,
        &format!("{PLAN} -o profile.csv --figure plane.svg --json"),
    );
    assert_eq!(object["operators"], 36);
    assert_eq!(object["excitation"]["determined"], 36);
    assert_eq!(object["classes"].as_array().unwrap().len(), 36);
    assert_eq!(object["corners"], 36);
    assert_eq!(object["recorded"], Value::Null);
    let samples = table(&path.join("profile.csv"));
    assert_eq!(object["samples"], samples.len());
    // At the lowest input everything is off, and no sample leaves the range.
    assert!((samples[0].1 - 20.0).abs() < 1e-9 && samples[0].0 == 0.0);
    assert!(
        samples
            .iter()
            .all(|(_, input)| (20.0..=80.0).contains(input))
    );
    assert_eq!(object["plane"]["min"], 27.5);
    assert!(samples.iter().any(|(_, input)| *input == 80.0));
    assert_eq!(object["duration_s"], samples[samples.len() - 1].0);
    for pair in samples.windows(2) {
        let rate = (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
        assert!((rate - 2.0).abs() < 1e-6 || (rate + 0.5).abs() < 1e-6);
    }
    let figure = fs::read_to_string(path.join("plane.svg")).unwrap();
    assert!(figure.starts_with("<svg") && figure.contains("well determined: 36"));

    let (code, out, _) = run(path, &format!("{PLAN} -o profile.csv"));
    assert!(code == 0 && out.contains("36 well determined"), "{out}");
}

#[test]
fn a_budget_is_kept_and_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let object = json(path, &format!("{PLAN} --budget 5 -o profile.csv --json"));
    assert!(object["duration_s"].as_f64().unwrap() <= 300.0);
    assert!(object["full_duration_s"].as_f64().unwrap() > 300.0);
    assert!(object["excitation"]["determined"].as_u64().unwrap() < 36);
    let (_, out, _) = run(path, &format!("{PLAN} --budget 5 -o profile.csv"));
    assert!(
        out.contains("corners of the plane") && out.contains("all operators would take"),
        "{out}"
    );
}

#[test]
fn recordings_are_completed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    // The major loop and one inner loop, as somebody may have recorded them.
    let mut rows = String::from("t,x\n");
    let turns = [10.0, 82.0, 12.0, 50.0, 30.0];
    for leg in turns.windows(2) {
        for k in 0..200 {
            let input = leg[0] + (leg[1] - leg[0]) * f64::from(k) / 200.0;
            rows += &format!("0,{input}\n");
        }
    }
    fs::write(path.join("run.csv"), rows).unwrap();
    let line = format!("{PLAN} --from run.csv --input x -o next.csv");
    let object = json(path, &format!("{line} --json"));
    assert_eq!(object["excitation"]["determined"], 36);
    let recorded = object["recorded"]["determined"].as_u64().unwrap();
    assert!(recorded > 0 && recorded < 36);
    let whole = json(path, &format!("{PLAN} -o whole.csv --json"));
    assert!(object["duration_s"].as_f64() < whole["duration_s"].as_f64());
    let (_, out, _) = run(path, &line);
    assert!(
        out.contains("measure next") && out.contains("  fall from "),
        "{out}"
    );

    // Both files together leave nothing to do, and nothing is written.
    let both = format!("{PLAN} --from whole.csv --from next.csv --input input -o none.csv");
    let (code, out, _) = run(path, &both);
    assert!(code == 0 && out.contains("nothing is missing"), "{out}");
    assert!(!path.join("none.csv").exists());
    assert_eq!(
        json(path, &format!("{both} --json"))["profile"],
        Value::Null
    );
}

#[test]
fn bad_arguments_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("cold.csv"), "x\n1\n2\n").unwrap();
    fs::write(path.join("bad.csv"), "x\n30\nwarm\n").unwrap();
    let cases = [
        ("--heating-rate 0 --cooling-rate 1", 2, "above zero"),
        ("--heating-rate 1 --cooling-rate -2", 2, "above zero"),
        (
            "--heating-rate 1 --cooling-rate 1 --budget 0.1",
            1,
            "which takes",
        ),
        (
            "--heating-rate 1 --cooling-rate 1 --step 100",
            1,
            "more than one level",
        ),
        (
            "--heating-rate 1 --cooling-rate 1 --from cold.csv --input x",
            1,
            "moves no operator",
        ),
        (
            "--heating-rate 1 --cooling-rate 1 --from cold.csv --input y",
            1,
            "no column `y`",
        ),
        (
            "--heating-rate 1 --cooling-rate 1 --from bad.csv --input x",
            1,
            "line 3",
        ),
        (
            "--heating-rate 1 --cooling-rate 1 --from cold.csv",
            2,
            "--input",
        ),
        ("--heating-rate 1 --cooling-rate 1 --levels 1", 2, "levels"),
        ("--heating-rate nan --cooling-rate 1", 2, "finite"),
        ("--heating-rate 1", 2, "--cooling-rate"),
    ];
    for (arguments, expected, says) in cases {
        let levels = if arguments.contains("--levels") {
            ""
        } else {
            "--levels 8"
        };
        let line =
            format!("design --range 20,80 {levels} {arguments} -o profile.csv --figure plane.svg");
        let (code, out, err) = run(path, &line);
        assert_eq!(code, expected, "{line}: {out}{err}");
        assert!(err.contains(says), "{line}: {err}");
        assert!(!path.join("profile.csv").exists() && !path.join("plane.svg").exists());
    }
}

/// A model with a body that heats: the profile is of drives, and none leaves the range.
#[test]
fn a_model_with_a_body_gets_a_profile_of_drives() {
    let folder = tempfile::tempdir().unwrap();
    let model = r#"{"format": "hysteron-model", "version": 2, "operator": "mkp",
        "plane": {"min": 30, "max": 80, "levels": 2}, "weights": [1, 1, 1],
        "thermal": {"kind": "first-order", "ambient": 20, "gain": 10, "tau_heating": 3,
                    "tau_cooling": 6}}"#;
    fs::write(folder.path().join("m.json"), model).unwrap();
    let line = "design --model m.json --range 0,8 --levels 6 -o drives.csv --json";
    let (code, out, err) = run(folder.path(), line);
    assert_eq!(code, 0, "{err}");
    let said: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(said["excitation"]["determined"], 21);
    let drives = table(&folder.path().join("drives.csv"));
    assert!(drives.iter().all(|(_, drive)| (0.0..=8.0).contains(drive)));
    // Hardly any is at rest.
    assert!(drives.iter().any(|(_, drive)| *drive > 7.0));
    let (code, _, err) = run(folder.path(), "design --levels 6 -o more.csv");
    assert!(code != 0 && err.contains("--range"), "{err}");
}
