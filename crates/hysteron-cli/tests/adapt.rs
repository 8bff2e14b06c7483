//! `hysteron adapt` as a black box.
#![allow(clippy::unwrap_used)]

mod common;

use common::{json, refused, run, text};
use serde_json::Value;
use std::fs;

/// A play operator with some slope, and the same with half as much slope again; a model of the first.
fn wires() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, slope) in [("before.csv", 0.2), ("after.csv", 0.3)] {
        let mut play = 20.0_f64;
        let mut table = String::from("t,x,y\n");
        for n in 0..1500 {
            let x = 50.0 - 30.0 * (f64::from(n) * 0.05).cos() * (1.0 - f64::from(n) / 3000.0);
            play = play.clamp(x - 5.0, x + 5.0);
            table += &format!("{n},{x},{}\n", play * slope);
        }
        fs::write(folder.path().join(name), table).unwrap();
    }
    let fit = "fit before.csv --input x --output y --levels 10 --bootstrap 20 -o model.json";
    let done = run(folder.path(), fit);
    assert!(done.status.success(), "{}", text(&done.stderr));
    folder
}

const ADAPT: &str = "adapt model.json after.csv --input x --output y -o adapted.json";

#[test]
fn every_method_prints_and_writes_what_it_learned() {
    let folder = wires();
    for method in ["gradient", "increments", "least-squares", "drift"] {
        let line = format!("{ADAPT} --method {method} --time t --table table.csv");
        let said = json(folder.path(), &line);
        let rmse = |value: &Value| value["rmse"].as_f64().unwrap();
        let last = &said["thirds"][2];
        // The loops get smaller and their middle is known; a third of the error is far from what is left.
        assert!(
            rmse(&last["adapting"]) < 0.33 * rmse(&last["fixed"]),
            "{method}: {said}"
        );
        assert_eq!(said["fit"]["adapted"]["method"], method);
        assert_eq!(said["fit"]["adapted"]["from"]["model"], "model.json");
        assert!(said["fit"]["confidence"].is_null());

        let table = fs::read_to_string(folder.path().join("table.csv")).unwrap();
        let mut lines = table.lines();
        assert_eq!(
            lines.next().unwrap(),
            "time [s],x,y,output_model,error,outcome"
        );
        let (mut squares, mut learned) = (0.0, 0);
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            let error: f64 = cells[4].parse().unwrap();
            squares += error * error;
            learned += u64::from(cells[5] == "learned");
        }
        assert_eq!(said["counts"]["learned"], learned);
        // The same numbers, written in full, in the same order.
        let found = (squares / 1500.0_f64).sqrt();
        assert!((found / rmse(&said["whole"]["adapting"]) - 1.0).abs() < 1e-9);

        // The adapted model is a model: from the start it gives what was said of it.
        let judged = json(
            folder.path(),
            "evaluate adapted.json after.csv --input x --output y",
        );
        assert!((rmse(&judged["forward"]) / rmse(&said["again"]) - 1.0).abs() < 1e-9);
    }
    let done = run(folder.path(), ADAPT);
    assert!(text(&done.stdout).contains("each sample before it was learned from"));
    let done = run(folder.path(), "inspect adapted.json");
    assert!(
        text(&done.stdout).contains("adapted (drift) over 1500 samples"),
        "{}",
        text(&done.stdout)
    );
}

#[test]
fn faults_are_named_and_nothing_is_written() {
    let folder = wires();
    let rest = "--input x --output y -o none.json";
    let cases = [
        (
            "adapt model.json after.csv --input x --output z -o none.json".into(),
            "`z`",
        ),
        (
            format!("adapt model.json after.csv {rest} --method drift --gain 0.5"),
            "`gain`",
        ),
        (
            format!("adapt model.json after.csv {rest} --method gradient --gain 3"),
            "gain",
        ),
        (
            format!("adapt model.json after.csv {rest} --load 3"),
            "`load`",
        ),
        (
            "adapt model.json after.csv --input x --output y -o after.csv".into(),
            "replace",
        ),
        (format!("adapt after.csv after.csv {rest}"), "model"),
    ];
    for (line, word) in cases {
        let said = refused(folder.path(), &line);
        assert!(said.contains(word), "{line}: {said}");
    }
    fs::write(folder.path().join("nan.csv"), "x,y\n20,1\n30,nan\n").unwrap();
    let said = refused(folder.path(), &format!("adapt model.json nan.csv {rest}"));
    assert!(
        said.contains("nan.csv") && said.contains("line 3"),
        "{said}"
    );
    assert!(!folder.path().join("none.json").exists());
    // Not a number, and not a method: wrong usage.
    for wrong in ["--gain many", "--method newton", "--trial -1"] {
        let done = run(folder.path(), &format!("{ADAPT} {wrong}"));
        assert_eq!(done.status.code(), Some(2), "{wrong}");
    }
}
