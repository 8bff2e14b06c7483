//! Identification as a black box: choices, starts, loads, several files, and what a model says of
//! itself.

use crate::common::{json, refused, run, text};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// Loops of a play of width `width`, scaled by `gain`, from the middle of the input's range and an
/// output of `first`: columns `x`, `y`, `load`.
fn play(samples: i32, width: f64, gain: f64, first: f64, load: f64) -> String {
    let mut y = first;
    let rows = (0..samples).map(|n| {
        let n = f64::from(n);
        let x = 50.0 + 30.0 * (n * 0.05).sin() * (1.0 - n / f64::from(2 * samples));
        y = y.clamp(x - width, x + width);
        let rough = 0.02 * (n * 7.3).sin();
        format!("{x},{},{load}\n", gain * (y + rough))
    });
    format!("x,y,load\n{}", rows.collect::<String>())
}

fn bench() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
    file("run.csv", play(600, 5.0, 0.2, 55.0, 6.0));
    file("other.csv", play(500, 5.0, 0.2, 45.0, 6.0));
    file("heavy.csv", play(600, 9.0, 0.3, 55.0, 10.0));
    folder
}

#[test]
fn levels_and_smoothness_are_chosen_and_told() {
    let folder = bench();
    let fit = json(
        folder.path(),
        "fit run.csv --input x --output y --levels auto --smooth auto --bootstrap 0 -o m.json",
    );
    let validation = &fit["fit"]["validation"];
    let scores = validation["scores"].as_array().unwrap();
    assert!(validation["whole_branches"].as_bool().unwrap() && scores.len() > 20);
    let model: Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("m.json")).unwrap()).unwrap();
    assert_eq!(model["fit"]["validation"], *validation);
    assert_eq!(model["plane"]["levels"], fit["plane"]["levels"]);
    for (options, said) in [
        ("--levels many", "or `auto`"),
        ("--smooth -1", "from zero on"),
        ("--start maybe", "unknown"),
    ] {
        let line = format!("fit run.csv --input x --output y {options} -o n.json");
        let done = run(folder.path(), &line);
        assert_eq!(done.status.code(), Some(2), "{options}");
        assert!(text(&done.stderr).contains(said), "{}", text(&done.stderr));
    }
}

#[test]
fn an_open_start_is_told_and_estimated() {
    let folder = bench();
    let line = "fit run.csv --input x --output y --bootstrap 0 --levels 20 -o m.json";
    let done = run(folder.path(), &format!("{line} --start off"));
    assert!(text(&done.stderr).contains("use --start unknown"));
    let off = json(folder.path(), &format!("{line} --start off"));
    // Without options, a start is taken that predicts better.
    let auto = json(folder.path(), line);
    assert_ne!(auto["fit"]["start"], "off");
    let unknown = json(folder.path(), &format!("{line} --start unknown"));
    let percent = |value: &Value| value["nrmse_percent"].as_f64().unwrap();
    assert!(percent(&unknown["fit"]) < 0.8 * percent(&off["fit"]));
    // What was fitted from an unknown start is judged from one.
    let evaluate = "evaluate m.json run.csv --input x --output y";
    let from_fitted = json(folder.path(), evaluate);
    let from_off = json(folder.path(), &format!("{evaluate} --start off"));
    let from_unknown = json(folder.path(), &format!("{evaluate} --start unknown"));
    // A history explains the recording nearly as well as a state of each operator for itself, and
    // the model keeps it.
    assert!(percent(&from_unknown["forward"]) <= 1.1 * percent(&unknown["fit"]));
    assert!(percent(&from_fitted["forward"]) <= 1.1 * percent(&unknown["fit"]));
    assert!(percent(&from_off["forward"]) > percent(&from_unknown["forward"]));
}

#[test]
fn several_files_are_one_experiment() {
    let folder = bench();
    let fit = json(
        folder.path(),
        "fit run.csv other.csv --input x --output y --start unknown --bootstrap 0 -o m.json",
    );
    assert_eq!(fit["fit"]["samples"], 1100);
    assert_eq!(fit["fit"]["other_files"][0], "other.csv");
    let said = refused(
        folder.path(),
        "fit run.csv missing.csv --input x --output y -o n.json",
    );
    assert!(said.contains("missing.csv"), "{said}");
    let said = refused(
        folder.path(),
        "fit run.csv other.csv --input x --output y -o other.csv",
    );
    assert!(said.contains("would replace a file that is read"), "{said}");
    assert!(!folder.path().join("n.json").exists());
}

#[test]
fn a_load_is_followed() {
    let folder = bench();
    let path = folder.path();
    let fit = "fit run.csv heavy.csv --input x --output y --load load --bootstrap 20 -o m.json";
    let fitted = json(path, fit);
    // The loops have different widths, which one shape for both loads cannot follow.
    assert!(fitted["fit"]["nrmse_percent"].as_f64().unwrap() < 4.0);
    let weights = json(path, &format!("{fit} --load-law weights"));
    assert!(weights["fit"]["nrmse_percent"].as_f64().unwrap() < 3.0);
    json(path, fit);
    for (file, load) in [("run.csv", "6"), ("heavy.csv", "10")] {
        let forward = |load: &str| {
            let line = format!("evaluate m.json {file} --input x --output y --load {load}");
            json(path, &line)["forward"]["rmse"].as_f64().unwrap()
        };
        let by_column = forward("load");
        assert!((by_column - forward(load)).abs() < 1e-9);
        let simulate = format!("simulate m.json {file} --input x --load load -o a.csv");
        assert!(run(path, &simulate).status.success());
        let simulate = format!("simulate m.json {file} --input x --load {load} -o b.csv");
        assert!(run(path, &simulate).status.success());
        let last = |name: &str| -> Vec<f64> {
            let table = fs::read_to_string(path.join(name)).unwrap();
            let cells = table
                .lines()
                .skip(1)
                .map(|row| row.rsplit(',').next().unwrap());
            cells.map(|cell| cell.parse().unwrap()).collect()
        };
        for (a, b) in last("a.csv").iter().zip(last("b.csv")) {
            assert!((a - b).abs() < 1e-9);
        }
    }
    let done = run(path, "invert m.json run.csv --target y --load 6 -o i.csv");
    assert!(done.status.success(), "{}", text(&done.stderr));
    for (line, expected) in [
        (
            "simulate m.json run.csv --input x -o n.csv",
            "depends on the load `load`",
        ),
        (
            "evaluate m.json run.csv --input x --output y",
            "depends on the load `load`",
        ),
        ("invert m.json run.csv --target y -o n.csv", "--load"),
        (
            "invert m.json run.csv --target y --load 11 -o n.csv",
            "outside the range 6 to 10",
        ),
        (
            "fit run.csv --input x --output y --load load -o n.json",
            "6 throughout",
        ),
    ] {
        let said = refused(path, line);
        assert!(said.contains(expected), "{line}: {said}");
    }
    assert!(!path.join("n.csv").exists() && !path.join("n.json").exists());
}

#[test]
fn a_model_says_what_its_data_did_not() {
    let folder = bench();
    let path = folder.path();
    let fit = json(
        path,
        "fit run.csv --input x --output y --levels 8 -o m.json",
    );
    let confidence = &fit["fit"]["confidence"];
    assert_eq!(confidence["replicates"], 200);
    assert_eq!(confidence["excitation"].as_array().unwrap().len(), 36);
    assert_eq!(confidence["standard_error"].as_array().unwrap().len(), 36);
    let said = text(&run(path, "inspect m.json").stdout);
    assert!(
        said.contains("well determined") && said.contains("the data determine"),
        "{said}"
    );
    let simulate = run(path, "simulate m.json run.csv --input x --band -o o.csv");
    assert!(simulate.status.success());
    let table = fs::read_to_string(path.join("o.csv")).unwrap();
    assert!(table.starts_with("x,y,load,output_model,output_low,output_high\n"));
    for row in table.lines().skip(1) {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!(cells[4] < cells[3] && cells[3] < cells[5]);
    }
    json(
        path,
        "fit run.csv --input x --output y --bootstrap 0 -o plain.json",
    );
    let said = refused(
        path,
        "simulate plain.json run.csv --input x --band -o n.csv",
    );
    assert!(said.contains("--bootstrap"), "{said}");
}

/// Whether a process that runs handles Ctrl-C (signal 2) itself; true where the system does not say.
#[cfg(unix)]
fn listens(pid: &str) -> bool {
    let about = fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let mask = about.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask & 2 != 0)
}

/// Ctrl-C in the middle of a long choice: nothing is left behind.
#[cfg(unix)]
#[test]
fn an_interrupted_fit_leaves_nothing() {
    let folder = bench();
    fs::write(
        folder.path().join("long.csv"),
        play(200_000, 5.0, 0.2, 55.0, 6.0),
    )
    .unwrap();
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("hysteron"))
        .args("fit long.csv --input x --output y --levels auto --smooth auto -o m.json".split(' '))
        .current_dir(folder.path())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let pid = child.id().to_string();
    // On a busy machine it may not yet listen to the signal.
    while !listens(&pid) {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    std::thread::sleep(std::time::Duration::from_millis(500));
    assert!(child.try_wait().unwrap().is_none(), "it is still at work");
    let kill = std::process::Command::new("kill")
        .args(["-INT", &pid])
        .status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let mut names: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["heavy.csv", "long.csv", "other.csv", "run.csv"]);
}

#[test]
fn what_cannot_be_is_refused_and_nothing_is_replaced() {
    let folder = bench();
    let path = folder.path();
    json(
        path,
        "fit run.csv --input x --output y --levels 6 --bootstrap 0 -o m.json",
    );
    let two = "fit run.csv heavy.csv --input x --output y --load load";
    let design = "design --range 20,80 --levels 5 --heating-rate 2 --cooling-rate 1";
    for (line, expected) in [
        (
            format!("{two} --load-degree 2 -o n.json"),
            "2 different loads cannot tell weights of order 2",
        ),
        (
            "fit run.csv --input x --output x -o n.json".into(),
            "named twice",
        ),
        (
            "fit run.csv --input x --output y -o -".into(),
            "a model goes to a file",
        ),
        (
            "simulate m.json run.csv --input x --load load -o n.csv".into(),
            "does not depend on a load",
        ),
        (
            "simulate m.json run.csv --input x -o run.csv".into(),
            "would replace a file that is read",
        ),
        (
            "invert m.json run.csv --target y --load load -o n.csv".into(),
            "does not depend on a load",
        ),
        (
            format!("{design} --from run.csv --input x -o run.csv"),
            "would replace a file that is read",
        ),
        (
            format!("{design} -o n.csv --figure ./n.csv"),
            "this one file",
        ),
        (
            format!("{design} --step 1e-9 -o n.csv"),
            "samples, more than",
        ),
        (
            "prepare run.csv --input x --output y --dead-band 1e9 -o n.csv".into(),
            "the whole range of the input",
        ),
    ] {
        let said = refused(path, &line);
        assert!(said.contains(expected), "{line}: {said}");
    }
    assert!(!path.join("n.json").exists() && !path.join("n.csv").exists());
    assert!(
        fs::read_to_string(path.join("run.csv"))
            .unwrap()
            .starts_with("x,y,load\n")
    );
    assert!(
        fs::read_to_string(path.join("m.json"))
            .unwrap()
            .starts_with('{')
    );
}

#[test]
fn a_broken_confidence_is_named_by_its_field() {
    let folder = bench();
    let path = folder.path();
    json(
        path,
        "fit run.csv --input x --output y --levels 5 --bootstrap 20 -o m.json",
    );
    let good: Value =
        serde_json::from_str(&fs::read_to_string(path.join("m.json")).unwrap()).unwrap();
    for (pointer, value, field) in [
        ("/noise", Value::from(-1.0), "fit.confidence.noise"),
        ("/noise", Value::from(1e300), "fit.confidence.noise"),
        (
            "/standard_error/3",
            Value::from(-1.0),
            "fit.confidence.standard_error",
        ),
        (
            "/standard_error",
            Value::from(vec![0.0; 14]),
            "fit.confidence.standard_error",
        ),
        (
            "/excitation",
            Value::from(Vec::<String>::new()),
            "fit.confidence.excitation",
        ),
        (
            "/factors/0/weights",
            Value::from(vec![1.0]),
            "fit.confidence.factors[0].weights",
        ),
    ] {
        let mut model = good.clone();
        *model["fit"]["confidence"].pointer_mut(pointer).unwrap() = value;
        fs::write(path.join("bad.json"), model.to_string()).unwrap();
        let said = refused(path, "inspect bad.json");
        assert!(
            said.contains("bad.json") && said.contains(field),
            "{field}: {said}"
        );
    }
}
