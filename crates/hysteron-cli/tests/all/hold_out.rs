//! Holding out as a black box: what a fit says of data that it did not see, what `evaluate` says of
//! data that were fitted, and models beside each other.

use crate::common::{json, refused, run, text};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Loops of a play with a small ripple; columns `t`, `x`, `y`.
fn play(samples: i32, phase: f64) -> Vec<[f64; 3]> {
    let mut y = 20.0_f64;
    let row = |n: i32| {
        let n = f64::from(n);
        // From the lowest input: every operator is off.
        let x = 50.0 - 30.0 * (n * 0.05).cos() * (1.0 - (n + phase) / f64::from(3 * samples));
        y = y.clamp(x - 5.0, x + 5.0);
        [n, x, 0.2 * y + 0.01 * (n * 7.3 + phase).sin()]
    };
    (0..samples).map(row).collect()
}

fn write(folder: &Path, name: &str, rows: &[[f64; 3]]) {
    let lines = rows.iter().map(|[t, x, y]| format!("{t},{x},{y}\n"));
    let table = format!("t,x,y\n{}", lines.collect::<String>());
    fs::write(folder.join(name), table).unwrap();
}

fn bench() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "run.csv", &play(900, 0.0));
    write(folder.path(), "other.csv", &play(700, 9.0));
    folder
}

const FIT: &str = "fit run.csv --input x --output y --levels 12 --bootstrap 0";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn every_way_of_holding_out_is_reported_and_kept() {
    let folder = bench();
    let path = folder.path();
    for (what, samples) in [
        ("branches:20%", 0..260),
        ("branches: 30 %", 100..400),
        ("rows:701-900", 200..201),
        ("rows:300-499", 200..201),
        ("other.csv", 700..701),
        ("rows:701-900 --hold-out other.csv", 900..901),
    ] {
        let what = what.replace(": 30 ", ":30");
        let fitted = json(path, &format!("{FIT} --hold-out {what} -o m.json"));
        let held_out = &fitted["hold_out"];
        let count = held_out["model"]["samples"].as_u64().unwrap() as usize;
        assert!(count > 0 && samples.contains(&count), "{what}: {count}");
        // A play is what the model is made for, and neither rival can follow it as well.
        let error = number(&held_out["model"]["nrmse_percent"]);
        assert!(error < 3.0, "{what}: {held_out}");
        let rivals = held_out["rivals"].as_array().unwrap();
        let names: Vec<&str> = rivals.iter().map(|r| r["name"].as_str().unwrap()).collect();
        assert_eq!(names, ["straight line", "interpolation"]);
        assert!(number(&rivals[0]["nrmse_percent"]) > 2.0 * error);
        let file: Value =
            serde_json::from_str(&fs::read_to_string(path.join("m.json")).unwrap()).unwrap();
        assert_eq!(&file["fit"]["hold_out"], held_out);
        // The model can be read again.
        assert!(
            run(path, "simulate m.json run.csv --input x -o s.csv")
                .status
                .success()
        );
        let done = run(path, &format!("{FIT} --hold-out {what} -o m.json"));
        let said = text(&done.stdout);
        assert!(
            said.contains("held out") && said.contains("straight line"),
            "{said}"
        );
    }
    let without = json(path, &format!("{FIT} -o m.json"));
    assert_eq!(without.get("hold_out"), None);
}

/// Reasons and worst sample are of the file that was held out, and the file is named.
#[test]
fn a_file_that_was_held_out_is_judged() {
    let folder = bench();
    let mut other = play(700, 9.0);
    other.iter_mut().for_each(|[_, _, y]| *y *= 1.3);
    other[400][2] += 3.0;
    write(folder.path(), "other.csv", &other);
    let done = run(
        folder.path(),
        &format!("{FIT} --hold-out other.csv -o m.json"),
    );
    let said = text(&done.stdout);
    assert!(
        said.contains("on a recording that was not fitted"),
        "{said}"
    );
    assert!(said.contains("worst    other.csv, sample 401"), "{said}");
    assert!(said.contains("is a gain"), "{said}");
}

/// The same model, whatever was measured in the rows held out.
#[test]
fn rows_held_out_do_not_change_the_model() {
    let folder = bench();
    let path = folder.path();
    let mut rows = play(900, 0.0);
    rows[600..]
        .iter_mut()
        .for_each(|row| row[2] = 100.0 - row[2]);
    fs::create_dir(path.join("changed")).unwrap();
    write(&path.join("changed"), "run.csv", &rows);
    let fit = "fit run.csv --input x --output y --levels auto --smooth auto --bootstrap 10";
    let model = |folder: &Path| -> (Value, Value) {
        let done = json(folder, &format!("{fit} --hold-out rows:601-900 -o m.json"));
        let file = fs::read_to_string(folder.join("m.json")).unwrap();
        let mut file: Value = serde_json::from_str(&file).unwrap();
        let fit = file["fit"].as_object_mut().unwrap();
        fit.remove("hold_out").unwrap();
        // The digest of the file differs, as it has to.
        fit.remove("sha256").unwrap();
        (file, done["hold_out"]["model"]["rmse"].clone())
    };
    let (as_measured, small) = model(path);
    let (changed, large) = model(&path.join("changed"));
    assert_eq!(as_measured, changed);
    assert!(number(&large) > 10.0 * number(&small));
}

#[test]
fn a_rival_that_wins_is_named() {
    let folder = bench();
    let path = folder.path();
    // A straight line with noise, and far more operators than it takes.
    let noise = |n: f64| 0.3 * ((n * 12.9898).sin() * 43758.5453).fract();
    let rows: Vec<[f64; 3]> = (0..120)
        .map(f64::from)
        .map(|n| [n, (n * 0.4).sin(), (n * 0.4).sin() + noise(n)])
        .collect();
    write(path, "line.csv", &rows);
    let fit = "fit line.csv --input x --output y --levels 40 --smooth off --bootstrap 0";
    let done = run(path, &format!("{fit} --hold-out rows:81-120 -o m.json"));
    let said = text(&done.stderr);
    assert!(
        done.status.success() && said.contains("straight line errs"),
        "{said}"
    );
    let done = run(path, &format!("{FIT} --hold-out branches:20% -o m.json"));
    assert!(!text(&done.stderr).contains("on what was left out"));
}

#[test]
fn what_cannot_be_held_out_is_refused() {
    let folder = bench();
    let path = folder.path();
    for (what, said) in [
        ("branches:many", "branches:20%"),
        ("branches:-5%", "branches:20%"),
        ("rows:5", "rows:100-200"),
        ("rows:a-b", "rows:100-200"),
    ] {
        let done = run(path, &format!("{FIT} --hold-out {what} -o n.json"));
        assert_eq!(done.status.code(), Some(2), "{what}");
        assert!(text(&done.stderr).contains(said), "{}", text(&done.stderr));
    }
    for (what, said) in [
        ("branches:60%", "33 %"),
        ("rows:0-10", "rows 1 to 900"),
        ("rows:10-901", "rows 1 to 900"),
        ("missing.csv", "missing.csv"),
        (
            "rows:1-9 --hold-out branches:20%",
            "one part of the recording",
        ),
    ] {
        let refusal = refused(path, &format!("{FIT} --hold-out {what} -o n.json"));
        assert!(refusal.contains(said), "{what}: {refusal}");
    }
    let own = refused(path, &format!("{FIT} --hold-out other.csv -o other.csv"));
    assert!(own.contains("would replace a file that is read"), "{own}");
    let two = "fit run.csv other.csv --input x --output y --hold-out rows:1-9999 -o n.json";
    assert!(refused(path, two).contains("some have to be left"));
    assert!(!path.join("n.json").exists());
    // Rows are counted through all that is fitted.
    let two = "fit run.csv other.csv --input x --output y --levels 12 --bootstrap 0";
    let fitted = json(path, &format!("{two} --hold-out rows:896-905 -o n.json"));
    assert_eq!(fitted["hold_out"]["model"]["samples"], 10);
}

#[test]
fn a_recording_that_was_fitted_is_recognised() {
    let folder = bench();
    let path = folder.path();
    json(path, &format!("{FIT} -o m.json"));
    fs::copy(path.join("run.csv"), path.join("copy.csv")).unwrap();
    let evaluate = |data: &str| format!("evaluate m.json {data} --input x --output y");
    for (data, fitted) in [("run.csv", true), ("copy.csv", true), ("other.csv", false)] {
        assert_eq!(json(path, &evaluate(data))["was_fitted"], fitted, "{data}");
        let said = text(&run(path, &evaluate(data)).stdout);
        assert_eq!(said.contains("the model was fitted to"), fitted, "{said}");
    }
}

/// Also those beside the first, and those that widened the band.
#[test]
fn every_file_of_a_fit_is_recognised() {
    let folder = bench();
    let path = folder.path();
    write(path, "third.csv", &play(500, 4.0));
    write(path, "fourth.csv", &play(500, 7.0));
    let fit = "fit run.csv other.csv --repeat third.csv --input x --output y --levels 8 \
               --bootstrap 10 -o m.json";
    json(path, fit);
    for (data, fitted, band) in [
        ("run.csv", true, false),
        ("other.csv", true, false),
        ("third.csv", false, true),
        ("fourth.csv", false, false),
    ] {
        let evaluate = format!("evaluate m.json {data} --input x --output y");
        let found = json(path, &evaluate);
        assert_eq!(found["was_fitted"], fitted, "{data}");
        assert_eq!(found["seen_for_band"], band, "{data}");
        let said = text(&run(path, &evaluate).stdout);
        assert_eq!(
            said.contains("that the model was fitted to"),
            fitted,
            "{said}"
        );
        assert_eq!(said.contains("band was widened to"), band, "{said}");
        let compared = json(path, &format!("compare m.json {data} --input x --output y"));
        let model = &compared["recordings"][0]["models"][0];
        assert_eq!(model["was_fitted"], fitted, "{data}");
        assert_eq!(model["seen_for_band"], band, "{data}");
    }
}

/// A band is widened by the readings that a fit would see, not by their noise or another lag.
#[test]
fn repeats_are_prepared_as_the_recording_fitted() {
    let folder = bench();
    let path = folder.path();
    let mut rows = play(700, 9.0);
    // One reading in eight is lost.
    rows.iter_mut().step_by(8).for_each(|row| row[2] = 0.0);
    write(path, "lost.csv", &rows);
    let fit = "fit run.csv --input x --output y --levels 12 --bootstrap 20 -o m.json";
    let noise = |options: &str| {
        let found = json(path, &format!("{fit} {options}"));
        number(&found["fit"]["confidence"]["noise"])
    };
    let whole = noise("--repeat other.csv");
    let raw = noise("--repeat lost.csv");
    let prepared = noise("--repeat lost.csv --spikes 4");
    assert!(raw > 10.0 * whole, "{whole} {raw}");
    // The readings that were put back are straight lines between their neighbours.
    assert!(prepared < 1.1 * whole, "{whole} {prepared}");
}

#[test]
fn models_are_put_beside_each_other() {
    let folder = bench();
    let path = folder.path();
    json(path, &format!("{FIT} -o good.json"));
    let few = "fit run.csv --input x --output y --levels 3 --bootstrap 0 -o few.json";
    json(path, few);
    let columns = "--input x --output y";
    let compared = json(
        path,
        &format!("compare few.json good.json other.csv run.csv {columns}"),
    );
    let recordings = compared["recordings"].as_array().unwrap();
    assert_eq!(recordings.len(), 2);
    for (recording, data) in recordings.iter().zip(["other.csv", "run.csv"]) {
        assert_eq!(recording["recording"], data);
        for (model, name) in recording["models"]
            .as_array()
            .unwrap()
            .iter()
            .zip(["few.json", "good.json"])
        {
            assert_eq!(model["model"], name);
            assert_eq!(model["was_fitted"], data == "run.csv");
            let alone = json(path, &format!("evaluate {name} {data} {columns}"));
            for measure in ["rmse", "max_abs", "nrmse_percent", "samples"] {
                assert_eq!(model[measure], alone["forward"][measure], "{name}, {data}");
            }
        }
    }
    // The text has the better one first.
    let said = text(
        &run(
            path,
            &format!("compare few.json good.json other.csv {columns}"),
        )
        .stdout,
    );
    assert!(
        said.find("good.json").unwrap() < said.find("few.json").unwrap(),
        "{said}"
    );
    for figure in ["residuals-time", "residuals-input", "residuals-histogram"] {
        for (data, place) in [
            ("other.csv", format!("one/{figure}")),
            ("other.csv run.csv", format!("two/recording-2/{figure}")),
        ] {
            let report = place.split('/').next().unwrap();
            let line = format!("compare few.json good.json {data} {columns} --report {report}");
            assert!(run(path, &line).status.success());
            assert!(path.join(format!("{place}.svg")).exists(), "{place}");
            assert!(path.join(format!("{place}.png")).exists(), "{place}");
        }
    }
    let page = fs::read_to_string(path.join("one/index.html")).unwrap();
    assert!(page.contains("few.json") && page.contains("good.json"));
    for (line, said) in [
        ("compare few.json good.json", "and recordings"),
        ("compare other.csv run.csv", "needs models"),
        ("compare few.json missing.csv", "missing.csv"),
        ("compare none.json other.csv", "none.json"),
    ] {
        let refusal = refused(path, &format!("{line} {columns}"));
        assert!(refusal.contains(said), "{refusal}");
    }
}
