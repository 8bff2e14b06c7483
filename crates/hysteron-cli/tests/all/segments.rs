//! A file whose clock was set back: several recordings of one experiment, for every command.

use crate::common::{json, refused, run, text};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const COLUMNS: &str = "--input x --output y --time t";

/// `whole.csv` holds the rows of `first.csv` and of `second.csv`, with the clock of each.
fn bench() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let part = |speed: f64, rows: u32| {
        let mut y = 20.0_f64;
        let rows = (0..rows).map(|n| {
            let x = 50.0 - 30.0 * (speed * f64::from(n)).cos() * (1.0 - f64::from(n) / 900.0);
            y = y.clamp(x - 4.0, x + 4.0);
            format!("{},{x},{}\n", 0.1 * f64::from(n), 0.2 * y)
        });
        rows.collect::<String>()
    };
    let (first, second) = (part(0.05, 400), part(0.07, 300));
    for (name, rows) in [
        ("first.csv", first.clone()),
        ("second.csv", second.clone()),
        ("whole.csv", first + &second),
    ] {
        fs::write(folder.path().join(name), format!("t,x,y\n{rows}")).unwrap();
    }
    let fit = "fit first.csv --input x --output y --levels 8 --start off --bootstrap 0 -o m.json";
    assert!(run(folder.path(), fit).status.success());
    folder
}

/// The cells of a column of a table.
fn column(path: &Path, name: &str) -> Vec<String> {
    let table = fs::read_to_string(path).unwrap();
    let mut lines = table.lines();
    let at = lines
        .next()
        .unwrap()
        .split(',')
        .position(|cell| cell == name);
    let cell = |line: &str| line.split(',').nth(at.unwrap()).unwrap().to_owned();
    lines.map(cell).collect()
}

#[test]
fn every_command_takes_the_segments_of_a_file() {
    let bench = bench();
    let path = bench.path();
    let lines = [
        format!("fit DATA {COLUMNS} --levels 8 --bootstrap 0 -o f.json"),
        format!("evaluate m.json DATA {COLUMNS}"),
        format!("compare m.json DATA {COLUMNS}"),
        format!("inspect DATA {COLUMNS}"),
        format!("adapt m.json DATA {COLUMNS} --force -o a.json"),
        format!("prepare DATA {COLUMNS} -o p.csv"),
        "simulate m.json DATA --input x --time t -o s.csv".to_owned(),
        "invert m.json DATA --target y --time t -o i.csv".to_owned(),
        "start DATA".to_owned(),
    ];
    for line in lines {
        let line = line.replace("DATA", "whole.csv");
        let why = refused(path, &line);
        assert!(
            why.contains("line 402") && why.contains("--repair"),
            "{line}: {why}"
        );
        let done = run(path, &format!("{line} --repair"));
        let said = text(&done.stderr);
        assert!(done.status.success(), "{line}: {said}");
        assert!(
            said.contains("2 recordings of one experiment"),
            "{line}: {said}"
        );
    }
    // Every row is there, in the order of the file.
    let time = column(&path.join("whole.csv"), "t");
    for name in ["s.csv", "i.csv"] {
        assert_eq!(column(&path.join(name), "t"), time, "{name}");
    }
    assert_eq!(column(&path.join("p.csv"), "t").len(), time.len());
}

/// The model begins anew in each segment: it gives what it gives on each file alone.
#[test]
fn a_segment_is_as_a_file_of_its_own() {
    let bench = bench();
    let path = bench.path();
    for (line, name) in [
        (
            "simulate m.json DATA --input x --time t --repair -o ",
            "output_model",
        ),
        (
            "invert m.json DATA --target y --time t --repair -o ",
            "input_model",
        ),
        (
            "invert m.json DATA --target y --time t --repair --policy anticipate -o ",
            "input_model",
        ),
    ] {
        let of = |data: &str| {
            let line = line.replace("DATA", &format!("{data}.csv"));
            let done = run(path, &format!("{line}{data}-out.csv --force"));
            assert!(done.status.success(), "{}", text(&done.stderr));
            column(&path.join(format!("{data}-out.csv")), name)
        };
        assert_eq!(of("whole"), [of("first"), of("second")].concat(), "{line}");
    }
    let errors = |data: &str| {
        let found = json(
            path,
            &format!("evaluate m.json {data}.csv {COLUMNS} --repair"),
        );
        let forward = &found["forward"];
        let samples = forward["samples"].as_f64().unwrap();
        (forward["rmse"].as_f64().unwrap().powi(2) * samples, samples)
    };
    let [whole, first, second] = ["whole", "first", "second"].map(errors);
    assert_eq!(whole.1, first.1 + second.1);
    // Sums of squares in another order.
    assert!((whole.0 - first.0 - second.0).abs() <= 1e-12 * whole.0);
}
