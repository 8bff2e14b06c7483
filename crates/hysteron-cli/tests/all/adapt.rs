//! `hysteron adapt` as a black box.

use crate::common::{json, refused, run, text};
use serde_json::Value;
use std::fs;

/// A play operator with some slope, and the same with half as much slope again; a model of the
/// first.
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

const METHODS: [&str; 4] = ["refit", "increments", "least-squares", "drift"];

#[test]
fn every_method_prints_and_writes_what_it_learned() {
    let folder = wires();
    for method in METHODS {
        let line = format!("{ADAPT} --method {method} --time t --table table.csv");
        let said = json(folder.path(), &line);
        let rmse = |value: &Value| value["rmse"].as_f64().unwrap();
        let last = &said["thirds"][2];
        // The loops get smaller and their middle is known; a third of the error is far from what is
        // left.
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
        text(&done.stdout).contains("adapted (auto) over 1500 samples"),
        "{}",
        text(&done.stdout)
    );
}

/// A play operator whose axis a load shifts by 2 for each unit, recorded at two loads; and a
/// recording at another one, of which nobody tells the load.
#[test]
fn an_unknown_load_is_found_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let play = |table: &mut String, load: f64, named: bool| {
        let mut play = 15.0_f64;
        for n in 0..800 {
            let x = 50.0 - 35.0 * (f64::from(n) * 0.02).cos() * (1.0 - f64::from(n) / 2000.0);
            let seen = x - 2.0 * load;
            play = play.clamp(seen - 5.0, seen + 5.0);
            let y = ((play - 40.0) / 8.0).tanh();
            *table += &match named {
                true => format!("{x},{y},{load}\n"),
                false => format!("{x},{y}\n"),
            };
        }
    };
    for load in [0.0, 4.0] {
        let mut known = String::from("x,y,load\n");
        play(&mut known, load, true);
        fs::write(folder.path().join(format!("at{load}.csv")), known).unwrap();
    }
    let mut unknown = String::from("x,y\n");
    play(&mut unknown, 3.0, false);
    fs::write(folder.path().join("unknown.csv"), unknown).unwrap();
    let fit = "fit at0.csv at4.csv --input x --output y --load load --levels 20 --bootstrap 0 -o \
               model.json";
    let done = run(folder.path(), fit);
    assert!(done.status.success(), "{}", text(&done.stderr));

    let line = "adapt model.json unknown.csv --input x --output y --method load -o adapted.json \
                --table table.csv";
    let said = json(folder.path(), line);
    assert_eq!(said["one_load"], true);
    let others = "adapt model.json unknown.csv --input x --output y -o one.json --force";
    let others = run(folder.path(), others);
    let told = "for loads from 0 to 4.000; this one is for the load of the recording alone";
    assert!(
        text(&others.stdout).contains(told),
        "{}",
        text(&others.stdout)
    );
    let number = |name: &str| said["shift"][name].as_f64().unwrap();
    // From the middle, 2, to 3: two units of the input, a load to a tenth of the range.
    assert!((number("load") - 3.0).abs() < 0.4, "{said}");
    assert!((number("shift") - 2.0).abs() < 0.8, "{said}");
    assert_eq!(number("from"), 2.0);
    let last = &said["thirds"][2];
    let rmse = |of: &str| last[of]["rmse"].as_f64().unwrap();
    assert!(rmse("adapting") < 0.5 * rmse("fixed"), "{said}");
    let table = fs::read_to_string(folder.path().join("table.csv")).unwrap();
    let mut lines = table.lines();
    let head = "x,y,output_model,error,outcome,shift_model,load_model";
    assert_eq!(lines.next().unwrap(), head);
    let last: Vec<&str> = lines.last().unwrap().split(',').collect();
    let of = |n: usize| last[n].parse::<f64>().unwrap();
    assert!((of(6) - 3.0).abs() < 0.4, "{last:?}");
    // What was written is a model at that load.
    let judged = json(
        folder.path(),
        "evaluate adapted.json unknown.csv --input x --output y",
    );
    let judged = judged["forward"]["rmse"].as_f64().unwrap();
    assert!((judged / said["again"]["rmse"].as_f64().unwrap() - 1.0).abs() < 1e-9);

    let done = run(
        folder.path(),
        &line.replace("-o adapted.json --table table.csv", "-o b.json"),
    );
    let words = text(&done.stdout);
    assert!(words.contains("shift of the axis at the end"), "{words}");
    assert!(words.contains("the load is then about"), "{words}");
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
            format!("adapt model.json after.csv {rest} --method increments --gain 3"),
            "gain",
        ),
        (
            format!("adapt model.json after.csv {rest} --load 3"),
            "`load`",
        ),
        (
            format!("adapt model.json after.csv {rest} --ridge 2"),
            "ridge",
        ),
        (
            format!("adapt model.json after.csv {rest} --method drift --window cycles:2"),
            "`window`",
        ),
        (
            "adapt model.json after.csv --input x --output y -o after.csv".into(),
            "replace",
        ),
        (format!("adapt after.csv after.csv {rest}"), "model"),
        (
            format!("adapt model.json after.csv {rest} --method load --forgetting 1"),
            "`forgetting`",
        ),
        (
            format!("adapt model.json after.csv {rest} --method load --trial 9"),
            "`trial`",
        ),
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
    let gone = run(folder.path(), &format!("{ADAPT} --method gradient"));
    assert_eq!(gone.status.code(), Some(2));
    assert!(text(&gone.stderr).contains("take `increments`"));
    for wrong in ["--gain many", "--method newton", "--trial -1", "--window 3"] {
        let done = run(folder.path(), &format!("{ADAPT} {wrong}"));
        assert_eq!(done.status.code(), Some(2), "{wrong}");
    }
}

/// Readings of full scale, as of a sensor whose wire is off.
#[test]
fn wrong_readings_are_refused_counted_and_in_the_table() {
    let folder = wires();
    let text_of = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let mut rows: Vec<String> = text_of("after.csv").lines().map(str::to_owned).collect();
    // The header is line 0: samples 399 and the last.
    for n in [400, 1500] {
        let x = rows[n].split(',').nth(1).unwrap().to_owned();
        rows[n] = format!("{n},{x},4095");
    }
    fs::write(folder.path().join("after.csv"), rows.join("\n") + "\n").unwrap();
    let said = json(folder.path(), &format!("{ADAPT} --table table.csv"));
    assert_eq!(
        (&said["probation"], &said["worse"]),
        (&8.into(), &false.into())
    );
    assert_eq!(said["fit"]["adapted"]["options"]["gate"], 12.0);
    let offset = &said["drift"]["offset"];
    let [before, after] = [0, 1].map(|n| offset[n].as_f64().unwrap());
    // All of the plant's output is half as large again, its offset too; its stroke is 18. What
    // operators that stay on give is the offset's as well.
    assert!((after - 1.5 * before).abs() < 2.0, "{said}");
    let table = text_of("table.csv");
    let outcome = |n: usize| table.lines().nth(n).unwrap().rsplit(',').next().unwrap();
    assert_eq!((outcome(400), outcome(1500)), ("rejected", "rejected"));
    let rejected = table.lines().filter(|line| line.ends_with(",rejected"));
    assert_eq!(said["counts"]["rejected"], rejected.count());
    let done = run(folder.path(), ADAPT);
    let printed = text(&done.stdout);
    assert!(printed.contains(" readings rejected"), "{printed}");
    assert!(
        printed.contains("the last 8 samples are not in the model"),
        "{printed}"
    );
}

/// The output freezes two thirds through.
#[test]
fn a_frozen_output_is_named_and_nothing_is_learned_from_it() {
    let folder = wires();
    let table = fs::read_to_string(folder.path().join("after.csv")).unwrap();
    let mut rows: Vec<String> = table.lines().map(str::to_owned).collect();
    let held = rows[1000].rsplit(',').next().unwrap().to_owned();
    for row in &mut rows[1001..] {
        let cut = row.rfind(',').unwrap();
        row.replace_range(cut + 1.., &held);
    }
    fs::write(folder.path().join("frozen.csv"), rows.join("\n") + "\n").unwrap();
    for method in METHODS {
        let line = format!("{ADAPT} --method {method}").replace("after", "frozen");
        let said = refused(folder.path(), &line);
        assert!(
            said.contains("the output stands still from row 1000"),
            "{said}"
        );
        assert!(!folder.path().join("adapted.json").exists());
        let said = json(folder.path(), &format!("{line} --force --table table.csv"));
        let [before, after] = [0, 1].map(|n| said["drift"]["weights"][n].as_f64().unwrap());
        assert!(after > 0.9 * before, "{method}: {before} {after}");
        assert_eq!(said["stuck"][0]["channel"], "output", "{method}");
        let table = fs::read_to_string(folder.path().join("table.csv")).unwrap();
        assert!(table.lines().last().unwrap().ends_with(",output-stuck"));
        fs::remove_file(folder.path().join("adapted.json")).unwrap();
    }
}

/// A plant whose offset moves by twice the model's range, slowly.
#[test]
fn a_model_that_moved_too_far_needs_a_word() {
    let folder = wires();
    let table = fs::read_to_string(folder.path().join("before.csv")).unwrap();
    let mut rows: Vec<String> = vec!["x,y".into()];
    for (n, row) in table.lines().skip(1).enumerate() {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        rows.push(format!(
            "{},{}",
            cells[1],
            cells[2] + 30.0 * n as f64 / 1500.0
        ));
    }
    fs::write(folder.path().join("ramp.csv"), rows.join("\n") + "\n").unwrap();
    let line = ADAPT.replace("after", "ramp");
    let said = refused(folder.path(), &line);
    assert!(
        said.contains("--max-drift") && said.contains("offset by"),
        "{said}"
    );
    assert!(!folder.path().join("adapted.json").exists());
    json(folder.path(), &format!("{line} --max-drift 400"));
    assert!(folder.path().join("adapted.json").exists());
}

#[test]
fn a_model_that_ended_worse_is_not_written_without_force() {
    let folder = wires();
    // The plant has not changed; what there is to learn is noise, with a gain that more than
    // follows it.
    let mut table = String::from("x,y\n");
    let mut play = 20.0_f64;
    for n in 0..1500 {
        let x = 50.0 - 30.0 * (f64::from(n) * 0.05).cos() * (1.0 - f64::from(n) / 3000.0);
        play = play.clamp(x - 5.0, x + 5.0);
        table += &format!("{x},{}\n", play * 0.2 + 0.3 * (1.7 * f64::from(n)).sin());
    }
    fs::write(folder.path().join("same.csv"), table).unwrap();
    let line = "adapt model.json same.csv --input x --output y -o adapted.json --table table.csv \
                --method increments --gain 1.5 --dead-zone 0";
    let said = refused(folder.path(), line);
    assert!(
        said.contains("adapted.json: the model is not written"),
        "{said}"
    );
    assert!(said.contains("RMSE") && said.contains("--force"), "{said}");
    let there = |name: &str| folder.path().join(name).exists();
    assert!(!there("adapted.json") && there("table.csv"));

    let done = run(folder.path(), &format!("{line} --json"));
    assert_eq!(done.status.code(), Some(1));
    let said: Value = serde_json::from_str(&text(&done.stdout)).unwrap();
    assert_eq!(
        (&said["worse"], &said["model"]),
        (&true.into(), &Value::Null)
    );
    let rmse = |of: &str| said["late"][of]["rmse"].as_f64().unwrap();
    assert!(rmse("adapting") > rmse("fixed"));

    // So it is with every method that follows the noise.
    for method in METHODS {
        let follow = match method {
            "refit" => "",
            "increments" => "--gain 1.5 --dead-zone 0",
            _ => "--noise 0.01 --dead-zone 0",
        };
        let line = format!("{ADAPT} --method {method} {follow}").replace("after", "same");
        assert!(
            refused(folder.path(), &line).contains("--force writes it"),
            "{method}"
        );
        assert!(!there("adapted.json"), "{method}");
    }

    let said = json(folder.path(), &format!("{line} --force"));
    assert_eq!(
        (&said["worse"], &said["model"]),
        (&true.into(), &"adapted.json".into())
    );
    assert!(there("adapted.json"));
}

/// A model that knows more of the output is not bent to the end of a sensor, unless it is forced.
/// What the model does not go beyond is a stop, and is followed.
#[test]
fn the_end_of_a_sensor_is_not_learned_unasked() {
    let folder = wires();
    let table = |limit: f64| {
        let mut play = 20.0_f64;
        let mut table = String::from("t,x,y\n");
        for n in 0..1500 {
            let x = 50.0 - 30.0 * (f64::from(n) * 0.05).cos();
            play = play.clamp(x - 5.0, x + 5.0);
            let noise = 1e-3 * (f64::from(n) * 12.9898).sin();
            table += &format!("{n},{x},{}\n", (play * 0.2 + noise).min(limit));
        }
        fs::write(folder.path().join("after.csv"), table).unwrap();
    };
    table(12.0);
    let line = format!("{ADAPT} --json");
    let done = run(folder.path(), &line);
    assert_eq!(done.status.code(), Some(1));
    let said = text(&done.stderr);
    assert!(said.contains("its sensor may end there"), "{said}");
    assert!(!folder.path().join("adapted.json").exists());
    let said = json(folder.path(), &format!("{ADAPT} --force"));
    assert_eq!(said["cut_off"]["value"], 12.0);
    table(f64::INFINITY);
    let said = json(folder.path(), &format!("{ADAPT} --force"));
    assert!(said["cut_off"].is_null());
}

/// What a small part of the range teaches is a guess elsewhere, and the command says so.
#[test]
fn how_much_of_the_range_was_covered_is_told() {
    let folder = wires();
    let mut play = 20.0_f64;
    let mut table = String::from("t,x,y\n");
    for n in 0..900 {
        let x = 50.0 + 6.0 * (f64::from(n) * 0.05).sin();
        play = play.clamp(x - 5.0, x + 5.0);
        table += &format!("{n},{x},{}\n", play * 0.3 + 1.0);
    }
    fs::write(folder.path().join("after.csv"), table).unwrap();
    let done = run(folder.path(), &format!("{ADAPT} --force"));
    assert!(
        text(&done.stdout).contains("the input covered 22 % of the model's range"),
        "{}",
        text(&done.stdout)
    );
}
