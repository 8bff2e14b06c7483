//! A thermal body in front of the model, as a black box.

use crate::common::{run, text};
use serde_json::Value;
use std::fs;

/// A wire of 2 s heating and 5 s cooling with a play, under a slow ramp and steps; irregular in
/// time.
fn wire() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let (mut theta, mut play, mut before) = (0.0_f64, 0.0_f64, 0.0);
    let mut drive: f64;
    let mut table = String::from("t,duty,y\n");
    for n in 0..1200 {
        let t = 0.2 * f64::from(n) + 0.05 * f64::from(n % 3);
        drive = match n {
            0..200 => f64::from(n) / 200.0,
            200..400 => f64::from(400 - n) / 200.0,
            _ => [0.0, 1.0, 0.0, 0.6, 0.2, 0.9, 0.1, 0.0][(n as usize - 400) / 100],
        };
        let tau = if drive > theta { 2.0 } else { 5.0 };
        theta = drive + (theta - drive) * (-(t - before) / tau).exp();
        before = t;
        play = play.clamp(theta - 0.1, theta + 0.1);
        table += &format!("{t},{drive},{play}\n");
    }
    fs::write(folder.path().join("run.csv"), table).unwrap();
    folder
}

const COLUMNS: &str = "run.csv --input duty --output y";

#[test]
fn a_body_is_fitted_simulated_and_judged() {
    let folder = wire();
    let fit = format!(
        "fit {COLUMNS} --time t --thermal first-order --levels 10 --bootstrap 0 -o wire.json"
    );
    let done = run(folder.path(), &fit);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert!(
        text(&done.stdout).contains("thermal body: time constants "),
        "{}",
        text(&done.stdout)
    );
    let done = run(folder.path(), &format!("{fit} --json"));
    let said: Value = serde_json::from_slice(&done.stdout).unwrap();
    // The ten levels of the fit resolve the play to about a twentieth of the range.
    for (field, tau) in [("tau_heating", 2.0), ("tau_cooling", 5.0)] {
        let found = said["thermal"][field].as_f64().unwrap();
        assert!((found / tau - 1.0).abs() < 0.05, "{said}");
    }
    assert_eq!(said["fit"]["thermal"]["told_apart"], true);

    let done = run(
        folder.path(),
        &format!("evaluate wire.json {COLUMNS} --time t --json --report report"),
    );
    assert!(done.status.success(), "{}", text(&done.stderr));
    let judged: Value = serde_json::from_slice(&done.stdout).unwrap();
    // The page shows the temperature, and says the same of the drive as the terminal.
    let page = fs::read_to_string(folder.path().join("report/index.html")).unwrap();
    assert!(page.contains("temperature of the body"));
    let causes = judged["verdict"]["causes"].as_array().unwrap();
    for cause in causes {
        let said = cause[1].as_str().unwrap();
        assert!(page.contains(said), "{said}");
    }
    let rmse = |value: &Value| value["rmse"].as_f64().unwrap();
    // Both run the same body and weights over the same rows, in another order of additions.
    assert!((rmse(&judged["forward"]) / rmse(&said["fit"]) - 1.0).abs() < 1e-9);
    // The inverse is compared with the temperature behind the body.
    assert!(judged["inverse"]["nrmse_percent"].as_f64().unwrap() < 10.0);

    let done = run(
        folder.path(),
        "simulate wire.json run.csv --input duty --time t -o out.csv",
    );
    assert!(done.status.success(), "{}", text(&done.stderr));
    let table = fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let squares = table.lines().skip(1).map(|line| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        (cells[2] - cells[3]).powi(2)
    });
    let simulated = (squares.sum::<f64>() / 1200.0).sqrt();
    assert!((simulated / rmse(&judged["forward"]) - 1.0).abs() < 1e-9);
}

#[test]
fn what_a_body_cannot_do_is_refused_with_a_reason() {
    let folder = wire();
    fs::write(
        folder.path().join("wire.json"),
        r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
            "plane": {"min": 0.5, "max": 1, "levels": 2}, "weights": [1, 0, 1],
            "thermal": {"kind": "first-order", "gain": 1, "tau_heating": 2, "tau_cooling": 5}}"#,
    )
    .unwrap();
    fs::write(folder.path().join("back.csv"), "t,duty\n0,0\n2,1\n1,1\n").unwrap();
    for (line, code, reason) in [
        (format!("evaluate wire.json {COLUMNS}"), 1, "--time"),
        (
            "simulate wire.json run.csv --input duty -o out.csv".into(),
            1,
            "--time",
        ),
        (
            "simulate wire.json back.csv --input duty --time t -o out.csv".into(),
            1,
            "line 4, column `t`",
        ),
        (
            "invert wire.json run.csv --target y -o out.csv".into(),
            1,
            "--time",
        ),
        (
            format!("fit {COLUMNS} --thermal first-order -o out.csv"),
            1,
            "--time",
        ),
        (
            "invert wire.json run.csv --target y --time t --drive-range 1,0 -o out.csv".into(),
            2,
            "--drive-range",
        ),
        (
            "invert wire.json back.csv --target duty --time t -o out.csv".into(),
            1,
            "line 4, column `t`",
        ),
    ] {
        let done = run(folder.path(), &line);
        assert_eq!(done.status.code(), Some(code), "{line}");
        assert!(
            text(&done.stderr).contains(reason),
            "{}",
            text(&done.stderr)
        );
        assert!(!folder.path().join("out.csv").exists(), "{line}");
    }
}
