//! What the command says to those who use it for the first time.

use crate::common::{json, run, text};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const FIT: &str = "fit run.csv --input x --output y --levels 4 --bootstrap 0";

/// A recording of a play with `n` rows, `run.csv`, and a model of it, `model.json`.
fn bench() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut peak = 0.0_f64;
    let rows: String = (0..400)
        .map(|n| {
            let x = 50.0 - 30.0 * (f64::from(n) * 0.05).cos() * (1.0 - f64::from(n) / 800.0);
            peak = peak.clamp(x - 5.0, x + 5.0);
            format!("{n},{x},{}\n", 0.2 * peak)
        })
        .collect();
    fs::write(folder.path().join("run.csv"), format!("t,x,y\n{rows}")).unwrap();
    let done = run(folder.path(), &format!("{FIT} -o model.json"));
    assert!(done.status.success(), "{}", text(&done.stderr));
    folder
}

/// What is said of wrong words: always behind the same prefix, and nothing is written.
fn said(folder: &Path, line: &str, code: i32) -> String {
    let count = || fs::read_dir(folder).unwrap().count();
    let before = count();
    let done = run(folder, line);
    let said = text(&done.stderr);
    assert_eq!(done.status.code(), Some(code), "{line}: {said}");
    assert!(said.starts_with("hysteron: error: "), "{line}: {said}");
    assert_eq!(said.matches("error: ").count(), 1, "{line}: {said}");
    assert_eq!(count(), before, "{line}: something was left behind");
    said
}

#[test]
fn wrong_words_are_told_what_was_meant() {
    let bench = bench();
    let fit = |options: &str| format!("{FIT} {options} -o new.json");
    let design = "design --levels 4 --heating-rate 1 --cooling-rate 1 -o p.csv --range";
    for (line, expected) in [
        ("fti run.csv", "similar subcommand exists: 'fit'"),
        ("predict model.json run.csv", "'simulate'"),
        ("help fti", "'fit'"),
        ("run.csv", "hysteron start run.csv"),
        ("model.json", "hysteron inspect model.json"),
        ("export model.json", "hysteron export c | arduino | fmu"),
        ("export fmi model.json", "'fmu'"),
        ("fit run.csv", "-o <MODEL>"),
        ("prepare run.csv -o t.csv", "hysteron inspect FILE"),
        ("invert model.json run.csv --input x", "--target"),
        (
            "fit run.csv --input x --output y --bootstrap -1 -o n.json",
            "a whole number from 0 to 10000",
        ),
        (&fit("--hold-out 0.2"), "branches:20%"),
        (&fit("--hold-out 100-200"), "rows:100-200"),
        (&fit("--hold-out branch:20%"), "branches:20%"),
        (&format!("{design} 20:80"), "such as 20,80"),
        (&format!("{design} 80,20"), "must not be above the second"),
        ("studio --port many", "a whole number from 0 to 65535"),
    ] {
        let said = said(bench.path(), line, 2);
        assert!(said.contains(expected), "{line}: {said}");
        assert!(!said.contains("invalid digit"), "{line}: {said}");
        assert!(!said.contains("'-- --"), "{line}: {said}");
    }
}

/// A model where a table belongs, a table where a model belongs, and both.
#[test]
fn files_in_the_wrong_place_are_recognised() {
    let bench = bench();
    let path = bench.path();
    fs::write(path.join("data.json"), "{\"x\": [1, 2], \"y\": [1, 2]}").unwrap();
    fs::write(path.join("binary.json"), b"PAR1\xff\xfe").unwrap();
    for (line, expected) in [
        (
            "simulate run.csv model.json --input x",
            "run.csv is no model, and model.json is one: the model comes first: \
             hysteron simulate model.json run.csv --input x",
        ),
        (
            "evaluate run.csv model.json --input x --output y",
            "hysteron evaluate model.json run.csv --input x --output y",
        ),
        (
            "invert run.csv model.json --target y",
            "hysteron invert model.json run.csv --target y",
        ),
        (
            "adapt run.csv model.json --input x --output y -o a.json",
            "hysteron adapt model.json run.csv --input x --output y -o a.json",
        ),
        ("simulate run.csv run.csv --input x", "this is no model"),
        (
            "simulate model.json model.json --input x",
            "this is a model, not a table",
        ),
        (
            "fit model.json --input x --output y -o new.json",
            "this is a model, not a table",
        ),
        (
            "fit data.json --input x --output y -o new.json",
            "this is JSON, not a table",
        ),
        ("start model.json", "this is a model, not a table"),
        ("inspect binary.json", "this is no model"),
        ("export c run.csv -o mcu", "this is no model"),
        (
            "fleet check model.json model.json",
            "this is no table of models",
        ),
        (
            "compare run.csv run.csv --input x --output y",
            "there are no models",
        ),
        (
            "compare model.json model.json --input x --output y",
            "there are no recordings",
        ),
    ] {
        let said = said(path, line, 1);
        assert!(said.contains(expected), "{line}: {said}");
    }
}

#[test]
fn what_depends_on_time_asks_for_its_column() {
    let bench = bench();
    for line in [
        format!("{FIT} --lag auto -o new.json"),
        format!("{FIT} --creep 1 -o new.json"),
        format!("{FIT} --sensor-lag auto -o new.json"),
        "prepare run.csv --input x --output y --lag 2 -o new.csv".to_owned(),
        "prepare run.csv --input x --output y --resample 0.1 -o new.csv".to_owned(),
    ] {
        let said = said(bench.path(), &line, 1);
        assert!(said.contains("name its column (--time)"), "{line}: {said}");
    }
}

/// A share alone is a share of the branches, unless there is a file of this name.
#[test]
fn a_share_is_held_out_in_branches() {
    let bench = bench();
    let path = bench.path();
    let fit = |share: &str| json(path, &format!("{FIT} --hold-out {share} -o {share}.json"));
    let (short, long) = (fit("20%"), fit("branches:20%"));
    assert!(short["hold_out"].is_object());
    assert_eq!(short["hold_out"], long["hold_out"]);
    // A number that is the name of a file is that file.
    let table = fs::read_to_string(path.join("run.csv")).unwrap();
    let (all_but_the_last_row, _) = table.trim_end().rsplit_once('\n').unwrap();
    for name in ["7", "other.csv"] {
        fs::write(path.join(name), all_but_the_last_row).unwrap();
    }
    assert_eq!(fit("7")["hold_out"], fit("other.csv")["hold_out"]);
}

#[test]
fn output_names_the_file_and_no_column() {
    let bench = bench();
    let path = bench.path();
    for (line, name) in [
        ("simulate model.json run.csv --input x --output", "out.csv"),
        ("invert model.json run.csv --target y --output", "in.csv"),
        ("export c model.json --output", "mcu"),
        ("export fmu model.json --output", "block.fmu"),
    ] {
        let done = run(path, &format!("{line} {name}"));
        assert!(done.status.success(), "{line}: {}", text(&done.stderr));
        assert!(path.join(name).exists(), "{line}");
    }
    let line = "simulate model.json run.csv --input x --output y";
    let column = said(path, line, 1);
    assert!(column.contains("`y` is a column of run.csv"), "{column}");
    assert!(
        run(path, &line.replace("--output y", "--output ./y"))
            .status
            .success()
    );
}
