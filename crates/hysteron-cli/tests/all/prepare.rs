//! `hysteron prepare` and the preparation before a fit, as a black box.

use crate::common::{run, text};
use serde_json::Value;
use std::fs;

/// Loops of a play whose readings are a little rough; in lines 102 and 103 the input dropped to
/// zero.
fn rough_recording() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut play = 0.0_f64;
    let rows = (0..900).map(|n| {
        let truth = 40.0 * (f64::from(n) * 0.02).sin();
        play = play.clamp(truth - 5.0, truth + 5.0);
        let rough = |k: i32| f64::from((n * k) % 13 - 6) * 0.05;
        let input = if n == 100 || n == 101 {
            0.0
        } else {
            truth + rough(5)
        };
        format!(
            "{},{input},{}\n",
            f64::from(n) * 0.5,
            play * 0.2 + rough(7) * 0.1
        )
    });
    let table: String = rows.collect();
    fs::write(folder.path().join("run.csv"), format!("t,x,y\n{table}")).unwrap();
    folder
}

const COLUMNS: &str = "run.csv --input x --output y --time t";

#[test]
fn a_rough_recording_is_prepared_and_what_was_done_is_said() {
    let folder = rough_recording();
    let done = run(folder.path(), &format!("prepare {COLUMNS} -o clean.csv"));
    assert!(done.status.success(), "{}", text(&done.stderr));
    let said = text(&done.stdout);
    for part in [
        "clean.csv: 900 samples of 900",
        "noise: ",
        "spikes: 2 in x",
        "samples 101 102",
        // The noise is small: a filter would take more from the loops than it gives.
        "low-pass: none for x, none for y",
        "dead band: ",
        "rate: ",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!said.contains("depend on rate"), "{said}");
    let table = fs::read_to_string(folder.path().join("clean.csv")).unwrap();
    assert!(table.starts_with("t,x,y\n"));
    assert_eq!(table.lines().count(), 901);
    let cells: Vec<f64> = table
        .lines()
        .nth(101)
        .unwrap()
        .split(',')
        .map(|c| c.parse().unwrap())
        .collect();
    assert!((cells[1] - 40.0 * 2.0_f64.sin()).abs() < 0.5, "{cells:?}");

    let done = run(
        folder.path(),
        &format!(
            "prepare {COLUMNS} --low-pass 0.2 --dead-band off --spikes off -o other.csv --json"
        ),
    );
    let json: Value = serde_json::from_str(&text(&done.stdout)).unwrap();
    let [one] = &json["recordings"].as_array().unwrap()[..] else {
        panic!("{json}");
    };
    assert_eq!(one["preparation"]["low_pass"]["input"]["cutoff"], 0.2);
    assert_eq!(one["preparation"]["dead_band"], Value::Null);
    assert_eq!(one["preparation"]["spikes"], Value::Null);
    assert_eq!(one["rate_dependent"], false);
}

#[test]
fn a_fit_prepares_when_told_to() {
    let folder = rough_recording();
    let error = |options: &str| {
        let done = run(
            folder.path(),
            &format!("fit {COLUMNS} --start off --robust off {options} -o model.json --json"),
        );
        assert!(done.status.success(), "{}", text(&done.stderr));
        let json: Value = serde_json::from_str(&text(&done.stdout)).unwrap();
        (
            json["fit"]["nrmse_percent"].as_f64().unwrap(),
            json["preparation"][0].clone(),
            text(&done.stderr),
        )
    };
    let (raw, nothing, said) = error("");
    assert_eq!(nothing, Value::Null);
    // The recording begins in the middle of its range.
    assert!(
        said.contains("use --start unknown") && !said.contains("spikes"),
        "{said}"
    );
    let (prepared, _, said) = error("--prepare");
    assert!(prepared < 0.5 * raw, "{prepared} of {raw}");
    assert!(said.contains("hysteron: spikes: 2 in x"), "{said}");
    let (_, one_step, _) = error("--spikes auto");
    assert_eq!(one_step["spikes"]["input"]["spikes"], 2);
    assert_eq!(one_step["low_pass"], Value::Null);
}

/// An evaluation prepares as the fit did: what was read wrongly is no error of the model.
#[test]
fn an_evaluation_prepares_when_told_to() {
    let folder = rough_recording();
    let path = folder.path();
    let fit = format!("fit {COLUMNS} --prepare --levels 12 --bootstrap 0 -o m.json");
    assert!(run(path, &fit).status.success());
    let largest = |options: &str| {
        let done = run(path, &format!("evaluate m.json {COLUMNS} --json {options}"));
        assert!(done.status.success(), "{}", text(&done.stderr));
        let found: Value = serde_json::from_slice(&done.stdout).unwrap();
        (
            found["forward"]["max_abs"].as_f64().unwrap(),
            text(&done.stderr).contains("spikes: 2 in x"),
        )
    };
    let (as_read, is_silent) = largest("");
    let (prepared, says) = largest("--prepare");
    assert!(prepared < 0.3 * as_read, "{prepared} {as_read}");
    assert!(says && !is_silent);
}

#[test]
fn what_cannot_be_done_is_said_and_leaves_nothing() {
    let folder = rough_recording();
    let cases = [
        (
            "prepare run.csv --input x --output y --lag auto -o no.csv",
            1,
            "time column",
        ),
        (
            "prepare run.csv --input x --output y --low-pass 0.7 -o no.csv",
            1,
            "half the sampling rate",
        ),
        (
            "prepare run.csv --input x --output y --spikes 0 -o no.csv",
            1,
            "above zero",
        ),
        (
            "prepare run.csv --input x --output y --dead-band often -o no.csv",
            2,
            "`auto`, `off` or a number",
        ),
    ];
    for (line, code, part) in cases {
        let done = run(folder.path(), line);
        let said = text(&done.stderr);
        assert_eq!(done.status.code(), Some(code), "{line}: {said}");
        assert!(said.contains(part), "{line}: {said}");
        assert!(!folder.path().join("no.csv").exists(), "{line}");
    }
}

/// Over a day's pause there is nothing to filter: what is before it and after it are two recordings.
#[test]
fn a_long_pause_is_not_filtered_away() {
    let folder = rough_recording();
    let table = fs::read_to_string(folder.path().join("run.csv")).unwrap();
    let later = table
        .lines()
        .enumerate()
        .map(|(n, row)| match row.split_once(',') {
            Some((t, rest)) if n > 450 => {
                format!("{},{rest}\n", t.parse::<f64>().unwrap() + 86_400.0)
            }
            _ => format!("{row}\n"),
        });
    fs::write(folder.path().join("run.csv"), later.collect::<String>()).unwrap();
    let done = run(folder.path(), &format!("prepare {COLUMNS} -o out.csv"));
    let said = text(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert!(said.contains("2 recordings of one experiment"), "{said}");
    let rows = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(
        rows("out.csv").lines().count(),
        rows("run.csv").lines().count()
    );
}
