//! The command as a black box: its forms, JSON, exit codes and errors.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder with the recording of a known model: `t,x,y` with two loops, and a model fitted to it.
struct Bench {
    folder: TempDir,
}

struct Done {
    code: i32,
    out: String,
    err: String,
}

impl Done {
    fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap()
    }
}

impl Bench {
    fn new() -> Self {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        let input = (0..400)
            .map(|n| 50.0 - 30.0 * (f64::from(n) * 0.05).cos() * (1.0 - f64::from(n) / 800.0));
        let mut peak = 0.0_f64;
        let rows: Vec<String> = input
            .enumerate()
            .map(|(n, x)| {
                // A play operator: half the width either way, and some slope.
                peak = peak.clamp(x - 5.0, x + 5.0);
                format!("{n},{x},{}", peak * 0.2)
            })
            .collect();
        bench.file("run.csv", &format!("t,x,y\n{}\n", rows.join("\n")));
        bench
    }

    fn fitted() -> Self {
        let bench = Self::new();
        let done = bench
            .run("fit run.csv --input x --output y --levels 20 --spacing uniform -o model.json");
        assert_eq!(done.code, 0, "{}", done.err);
        bench
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.folder.path().join(name)
    }

    fn file(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    fn run(&self, line: &str) -> Done {
        self.run_with(line, "")
    }

    fn run_with(&self, line: &str, stdin: &str) -> Done {
        let mut command = Command::cargo_bin("hysteron").unwrap();
        let output = command
            .current_dir(self.folder.path())
            .args(line.split_whitespace())
            .write_stdin(stdin)
            .output()
            .unwrap();
        Done {
            code: output.status.code().unwrap(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Runs a line that must fail, and returns what it says.
    fn refused(&self, line: &str) -> String {
        let before = entries(self.folder.path());
        let done = self.run(line);
        assert_eq!(done.code, 1, "{line}: {}{}", done.out, done.err);
        assert!(done.err.starts_with("hysteron: error: "), "{}", done.err);
        assert_eq!(
            entries(self.folder.path()),
            before,
            "{line}: something was left behind"
        );
        done.err
    }
}

fn entries(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

#[test]
fn from_a_recording_to_a_model_and_back() {
    let bench = Bench::fitted();
    let model: Value = serde_json::from_str(&bench.read("model.json")).unwrap();
    assert_eq!(model["format"], "hysteron-model");
    assert_eq!(model["version"], 1);
    assert_eq!(model["operator"], "mkp");
    assert_eq!(model["weights"].as_array().unwrap().len(), 210);
    assert_eq!(model["fit"]["samples"], 400);
    assert_eq!(model["fit"]["sha256"].as_str().unwrap().len(), 64);

    assert_eq!(
        bench
            .run("simulate model.json run.csv --input x -o out.csv")
            .code,
        0
    );
    let out = bench.read("out.csv");
    assert!(out.starts_with("t,x,y,output_model\n"));
    assert_eq!(out.lines().count(), 401);
    let errors = out.lines().skip(1).map(|line| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        (cells[2] - cells[3]).abs()
    });
    assert!(errors.fold(0.0, f64::max) < 0.5);

    // What the model gives, its inverse takes back.
    assert_eq!(
        bench
            .run("invert model.json out.csv --target output_model -o back.csv")
            .code,
        0
    );
    let back = bench.read("back.csv");
    let header = "t,x,y,output_model,input_model,output_low,output_high,status\n";
    assert!(back.starts_with(header), "{back:.80}");
    bench.file("again.csv", &back.replace("output_model", "wanted"));
    assert_eq!(
        bench
            .run("simulate model.json again.csv --input input_model -o again-out.csv")
            .code,
        0
    );
    for line in bench.read("again-out.csv").lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells[7], "ok");
        let (wanted, got): (f64, f64) = (cells[3].parse().unwrap(), cells[8].parse().unwrap());
        assert!((wanted - got).abs() < 1e-11, "{line}");
    }
}

#[test]
fn invert_says_where_the_output_may_really_be_or_that_nobody_knows() {
    let bench = Bench::new();
    let fit = "fit run.csv --input x --output y --levels 20 --spacing uniform --smooth off";
    let invert = "invert model.json run.csv --target y --json -o inputs.csv";
    assert_eq!(
        bench
            .run(&format!("{fit} --bootstrap 0 -o model.json"))
            .code,
        0
    );
    let done = bench.run(invert);
    assert!(
        done.err.contains("no columns output_low and output_high"),
        "{}",
        done.err
    );
    assert!(done.err.contains("--hold-out"), "{}", done.err);
    assert_eq!(done.json()["half_width"], Value::Null);
    assert!(
        bench
            .read("inputs.csv")
            .starts_with("t,x,y,input_model,status\n")
    );
    let knows = format!("{fit} --bootstrap 0 --hold-out branches:20% -o model.json");
    assert_eq!(bench.run(&knows).code, 0);
    // The table of the run before is the command's own, and so is that of this run.
    bench.run(invert);
    let done = bench.run(invert);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(!done.err.contains("output_low"), "{}", done.err);
    let half = done.json()["half_width"].as_f64().unwrap();
    let inputs = bench.read("inputs.csv");
    let header = "t,x,y,input_model,output_low,output_high,status\n";
    assert!(inputs.starts_with(header), "{inputs:.60}");
    for line in inputs.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [y, low, high] = [2, 4, 5].map(|n| cells[n].parse::<f64>().unwrap());
        assert!((high - low - 2.0 * half).abs() < 1e-12, "{line}");
        assert!(cells[6] != "ok" || (low <= y && y <= high), "{line}");
    }
}

#[test]
fn columns_that_are_not_named_are_those_of_the_model() {
    let bench = Bench::fitted();
    for (short, long) in [
        ("simulate model.json run.csv", "--input x"),
        ("invert model.json run.csv", "--target y"),
    ] {
        let named = bench.run(&format!("{short} {long}"));
        assert_eq!(bench.run(short).out, named.out, "{short}");
        assert_eq!(named.out.lines().count(), 401);
    }
    bench.file("other.csv", "a,b\n1,2\n2,3\n");
    let said = bench.refused("simulate model.json other.csv");
    assert!(said.contains("no column `x`: there are `a`, `b`"), "{said}");
}

#[test]
fn tables_go_to_standard_output_and_json_stands_alone() {
    let bench = Bench::fitted();
    let done = bench.run("simulate model.json run.csv --input x");
    assert_eq!(done.out.lines().count(), 401);
    assert_eq!(done.err, "");
    let done = bench.run_with("simulate model.json - --input x", &bench.read("run.csv"));
    assert_eq!(done.out.lines().count(), 401, "{}", done.err);
    let done = bench.run("simulate model.json run.csv --input x --json");
    assert_eq!(done.json()["samples"], 400);
    let done =
        bench.run("invert model.json run.csv --target y --policy anticipate --json -o inv.csv");
    assert_eq!(done.json()["samples"], 400);
    assert_eq!(bench.read("inv.csv").lines().count(), 401);
    let done = bench.run(
        "fit run.csv --input x --output y --solver ols --operator kp --levels 5 -o kp.json --json",
    );
    assert_eq!(done.json()["fit"]["solver"], "ols");
    let done = bench.run("evaluate model.json run.csv --input x --output y --json");
    for test in ["forward", "inverse"] {
        for measure in ["rmse", "max_abs", "nrmse_percent", "samples"] {
            assert!(done.json()[test][measure].is_number(), "{test} {measure}");
        }
    }
    let done = bench.run("inspect run.csv --input x --output y --time t --json");
    assert_eq!(done.json()["samples"], 400);
    assert_eq!(done.json()["time"]["median_step"], 1.0);
    let count = |name: &str| done.json()[name].as_u64().unwrap();
    assert!(count("excited") > 100);
    assert!(0 < count("determined") && count("determined") <= count("rank"));
    assert!(count("rank") < count("excited"));
    assert_eq!(
        bench.run("inspect run.csv --json").json()["columns"][1]["name"],
        "x"
    );
    assert_eq!(
        bench.run("inspect model.json --json").json()["model"]["operators"],
        210
    );
    for line in [
        "inspect run.csv",
        "inspect model.json",
        "inspect run.csv --input x --output y",
        "evaluate model.json run.csv --input x --output y",
    ] {
        let done = bench.run(line);
        assert!(
            done.code == 0 && done.out.lines().count() > 2,
            "{line}: {}",
            done.err
        );
    }
}

#[test]
fn evaluate_writes_a_report() {
    let bench = Bench::fitted();
    let done =
        bench.run("evaluate model.json run.csv --input x --output y --time t --report report");
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(bench.read("report/index.html").contains("<svg"));
    assert!(!bench.read("report/index.html").contains("simulated plant"));
    assert!(bench.path("report/fig11-loops.png").exists());
}

#[test]
fn the_demo_reproduces_the_chapter_on_a_simulated_spring() {
    let bench = Bench::new();
    let done = bench.run("demo -o demo --json");
    assert_eq!(done.code, 0, "{}", done.err);
    let demo = done.json();
    assert_eq!(demo["simulated"], true);
    // Section 6.1: within ±0.5 mm; 6.2: less than 2 °C while the output moves.
    assert!(demo["forward"]["max_abs"].as_f64().unwrap() < 0.5);
    assert!(demo["inverse_hold"]["moving"]["max_abs"].as_f64().unwrap() < 2.0);
    let names = [
        "hysteron.sha256",
        "model.json",
        "recording-1-raw.csv",
        "recording-1.csv",
        "recording-2-raw.csv",
        "recording-2.csv",
        "report",
    ];
    assert_eq!(entries(&bench.path("demo")), names);
    assert!(
        bench
            .read("demo/recording-1.csv")
            .starts_with("time [s],temperature [degC],displacement [mm],simulated\n")
    );
    assert!(
        bench
            .read("demo/report/index.html")
            .contains("simulated plant")
    );
}

#[test]
fn time_makes_a_default_fit_no_worse() {
    let bench = Bench::new();
    assert_eq!(bench.run("demo -o demo").code, 0);
    // The same with stamps of whole seconds, of which some come twice.
    let text = bench.read("demo/recording-1.csv");
    let whole = text.lines().map(|line| match line.split_once(',') {
        Some((time, rest)) if line.starts_with(|c: char| c.is_ascii_digit()) => {
            format!("{},{rest}\n", time.parse::<f64>().unwrap().floor())
        }
        _ => format!("{line}\n"),
    });
    std::fs::write(bench.path("whole.csv"), whole.collect::<String>()).unwrap();
    let error_with = |file: &str, time: &str, fixed: &str| {
        let columns = format!("--input temperature --output displacement{time}");
        let done = bench.run(&format!("fit {file} {columns}{fixed} -o m.json --force"));
        assert_eq!(done.code, 0, "{}", done.err);
        let found = bench.read("m.json");
        let done = bench.run(&format!(
            "evaluate m.json demo/recording-2.csv {columns} --json"
        ));
        let errors = done.json()["forward"]["nrmse_percent"].as_f64().unwrap();
        (errors, found)
    };
    let error = |file: &str, time: &str| error_with(file, time, "");
    let (plain, _) = error("demo/recording-1.csv", "");
    let (timed, model) = error("demo/recording-1.csv", " --time time");
    // The spring answers at once: what is found besides would be an error of the grid.
    assert!(!model.contains("\"delay\""), "{model}");
    // Small differences come from the choice of smoothness.
    assert!(timed < 1.15 * plain, "{timed} and {plain}");
    let (whole, model) = error("whole.csv", " --time time --repair");
    assert!(!model.contains("ring_frequency"), "{model}");
    assert!(whole < 1.15 * plain, "{whole} and {plain}");
    // Where all else is fixed, nothing is left out that could speak against a dead time.
    let fixed = " --levels 20 --smooth 1e-8";
    let (plain, _) = error_with("demo/recording-1.csv", "", fixed);
    let (timed, model) = error_with("demo/recording-1.csv", " --time time", fixed);
    assert!(!model.contains("\"delay\""), "{model}");
    assert!(timed < 1.15 * plain, "{timed} and {plain}");
}

#[test]
fn wrong_usage_is_code_two() {
    let bench = Bench::fitted();
    for line in [
        "",
        "unknown",
        "fit run.csv --input x --output y",
        "fit run.csv --input x --output y -o m.json --levels many",
        "fit run.csv --input x --output y -o m.json --range 80,20",
        "fit run.csv --input x --output y -o m.json --range 1",
        "fit run.csv --input x --output y -o m.json --operator preisach",
        "inspect run.csv --input x",
        "fit run.csv --input x --output y -o m.json --levels 0",
        "fit run.csv --input x --output y -o m.json --levels 1000000",
        "fit run.csv --input x --output y -o m.json --offset nan",
        "fit run.csv --input x --output y -o m.json --range 0,inf",
        "invert model.json run.csv --target y --tolerance -1",
    ] {
        let done = bench.run(line);
        assert_eq!(done.code, 2, "{line}: {}", done.err);
    }
    assert_eq!(bench.run("--help").code, 0);
    assert_eq!(bench.run("fit --help").code, 0);
}

#[test]
fn bad_recordings_are_refused_with_file_line_and_column() {
    let bench = Bench::fitted();
    let cases = [
        ("", "the file is empty"),
        ("\n\n", "the file is empty"),
        ("1,2,3\n4,5,6\n", "no column `x`: there are `1`, `2`, `3`"),
        ("t,x,y\n", "there are no rows"),
        ("t,x\n1,2\n", "no column `y`: there are `t`, `x`"),
        ("x,x,y\n1,2,3\n", "two columns are called `x`"),
        (
            "t,x,y\n1,2,3\n4,5\n",
            "line 3: 2 cells where the header has 3",
        ),
        (
            "t,x,y\n1,2,3\n4,5,6,7\n",
            "line 3: 4 cells where the header has 3",
        ),
        (
            "t,x,y\n1,2,3\n4,abc,6\n",
            "line 3, column `x`: `abc` where a finite number is needed",
        ),
        ("t,x,y\n1,2,3\n4,,6\n", "line 3, column `x`: an empty cell"),
        ("t,x,y\n1,2,NaN\n", "line 2, column `y`: `NaN`"),
        ("t,x,y\n1,inf,3\n", "line 2, column `x`: `inf`"),
        ("t,x,y\n1,1e999,3\n", "line 2, column `x`: `1e999`"),
        ("t,x,y\n1,5,3\n2,5,4\n", "column `x`: it is 5 throughout"),
        ("t;x\n1;2\n", "no column `y`: there are `t`, `x`"),
        ("t,x,y\r\n1,2,3\r\n\r\n4,a,6\r\n", "line 4, column `x`: `a`"),
        ("t,x,y\n\n\n1,2,3\n4,a,6\n", "line 5, column `x`: `a`"),
        (
            "x,y,note\n1,2,ok\n2,3,\"oops\n3,1,ok\n4,5,ok\n",
            "line 3: a quote is opened here and never closed",
        ),
        (
            "t,x,y\n1,2,3\n2,3,1e160\n",
            "column `y`: 1e160 is too large",
        ),
        (
            "t,x,y\n1,2,0\n2,3,1e-200\n",
            "column `y`: it moves by 1e-200 only",
        ),
    ];
    for (text, expected) in cases {
        bench.file("bad.csv", text);
        let said = bench.refused("fit bad.csv --input x --output y -o m.json");
        assert!(
            said.contains("bad.csv") && said.contains(expected),
            "{text:?}: {said}"
        );
    }
    fs::write(bench.path("bad.csv"), b"t,x,y\n1,\xff,3\n").unwrap();
    let said = bench.refused("fit bad.csv --input x --output y -o m.json");
    assert!(said.contains("line 2, column `x`"), "{said}");
    bench.file("bad.csv", "t,x,y\n2,1,3\n1,5,4\n");
    let said = bench.refused("evaluate model.json bad.csv --input x --output y --time t");
    assert!(
        said.contains("line 3, column `t`: time goes back from 2 to 1"),
        "{said}"
    );
    for line in [
        "simulate model.json bad.csv --input z -o o.csv",
        "invert model.json none.csv --target y -o o.csv",
        "fit . --input x --output y -o m.json",
    ] {
        bench.refused(line);
    }
    // A fault in the middle leaves no half table.
    bench.file("bad.csv", &(bench.read("run.csv") + "400,oops,1\n"));
    let said = bench.refused("simulate model.json bad.csv --input x -o o.csv");
    assert!(said.contains("line 402, column `x`: `oops`"), "{said}");
    // A column that the result is to have is there already.
    bench.file("bad.csv", "x,output_model\n1,2\n");
    assert!(
        bench
            .refused("simulate model.json bad.csv --input x -o o.csv")
            .contains("`output_model` already")
    );
}

#[test]
fn recordings_are_mended_where_that_is_asked_for() {
    let bench = Bench::fitted();
    let run = bench.read("run.csv");
    let european = |line: &str| line.replace(',', ";").replace('.', ",");
    let mut rows: Vec<String> = run.lines().map(european).collect();
    rows[8] = "7;oops;1".into();
    rows.extend(["500;70;8", "500;72;8,4"].map(String::from));
    bench.file("raw.csv", &(rows.join("\n") + "\n"));
    let said = bench.refused("fit raw.csv --input x --output y -o m.json");
    assert!(
        said.contains("raw.csv, line 9, column `x`: `oops`"),
        "{said}"
    );
    let done = bench.run("fit raw.csv --input x --output y --repair -o m.json");
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(
        done.err,
        "hysteron: raw.csv: line 9 without a number: dropped\n"
    );
    for line in [
        "evaluate model.json raw.csv --input x --output y --time t --repair --json",
        "inspect raw.csv --input x --output y --time t --repair --json",
    ] {
        let done = bench.run(line);
        assert_eq!(done.code, 0, "{line}: {}", done.err);
        done.json();
        let notes: Vec<&str> = done.err.lines().collect();
        assert_eq!(
            notes,
            [
                "hysteron: raw.csv: line 9 without a number: dropped",
                "hysteron: raw.csv: line 403 at the time of the row before: kept",
                "hysteron: raw.csv: line 402 after a gap of over three times the median time step",
                "hysteron: raw.csv: line 402 after a gap in which the input may have turned: a \
                 segment begins, with a history of its own",
                "hysteron: raw.csv: 2 recordings of one experiment, line 2 to line 401, line 402 to \
                 line 403",
            ]
        );
    }
    assert_eq!(bench.run("fit").code, 2);
}

#[test]
fn columns_of_every_format_are_listed() {
    let bench = Bench::new();
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hysteron/tests/fixtures");
    for name in ["v5.mat", "v7.mat", "v73.mat", "snappy.parquet"] {
        let done = bench.run(&format!("inspect {} --json", fixtures.join(name).display()));
        assert_eq!(done.json()["rows"], 6, "{name}: {}", done.err);
        let columns = done.json()["columns"].as_array().unwrap().clone();
        let x = columns.iter().find(|column| column["name"] == "x").unwrap();
        assert_eq!((&x["min"], &x["max"]), (&20.0.into(), &80.0.into()));
    }
}

#[test]
fn bad_models_are_refused_by_field() {
    let bench = Bench::fitted();
    let good: Value = serde_json::from_str(&bench.read("model.json")).unwrap();
    let change = |pointer: &str, value: Value| {
        let mut model = good.clone();
        *model.pointer_mut(pointer).unwrap() = value;
        model.to_string()
    };
    let cases = [
        (String::new(), "field `.`"),
        ("[]".into(), "field `.`"),
        ("{\"format\": 3}".into(), "field `format`"),
        (
            change("/format", "other".into()),
            "field `format`: is `other`",
        ),
        (
            change("/version", 5.into()),
            "field `version`: version 5 is not known",
        ),
        (
            change("/operator", "preisach".into()),
            "field `operator`: unknown variant `preisach`",
        ),
        (
            change("/plane/levels", 19.into()),
            "field `weights`: 210 weights where K(K+1)/2 = 190",
        ),
        (change("/plane/levels", 1.into()), "field `plane`: 1 levels"),
        (
            change("/plane/levels", 1_000_000.into()),
            "field `plane`: 1000000 levels",
        ),
        (change("/plane/levels", (-1).into()), "field `plane.levels`"),
        (change("/plane/min", 1e9.into()), "field `plane`"),
        (change("/plane/min", "low".into()), "field `plane.min`"),
        (
            change("/output/sign", 2.into()),
            "field `output.sign`: 2 is neither",
        ),
        (
            change("/output/offset", Value::Null),
            "field `output.offset`",
        ),
        (change("/weights/7", Value::Null), "field `weights[7]`"),
        (change("/weights/7", "one".into()), "field `weights[7]`"),
        (
            // The last of that name: the fit before it has weights of its own.
            good.to_string()
                .rsplit_once("\"weights\":[")
                .map(|(head, tail)| format!("{head}\"weights\":[NaN,{tail}"))
                .unwrap(),
            "field `weights`",
        ),
        (good.to_string() + "x", "field `.`"),
    ];
    for (text, expected) in cases {
        bench.file("bad.json", &text);
        let said = bench.refused("simulate bad.json run.csv --input x -o o.csv");
        assert!(
            said.contains("bad.json") && said.contains(expected),
            "{expected}: {said}"
        );
    }
    // A fit of other tools, or none, is no fault.
    for fit in ["{}", r#"{"solver": "nnls", "smoothing": 0.1}"#] {
        bench.file(
            "other.json",
            &change("/fit", serde_json::from_str(fit).unwrap()),
        );
        assert_eq!(bench.run("simulate other.json run.csv --input x").code, 0);
    }
    bench.file("bad.json", &change("/weights/4", (-1.5).into()));
    assert_eq!(bench.run("simulate bad.json run.csv --input x").code, 0);
    let said = bench.refused("invert bad.json run.csv --target y -o o.csv");
    assert!(
        said.contains("1 negative weight(s): operators i=2 j=3"),
        "{said}"
    );
    let done = bench.run("evaluate bad.json run.csv --input x --output y --json");
    assert!(done.json()["inverse"].is_null() && done.json()["inverse_refused"].is_string());
}

#[test]
fn bad_options_are_refused() {
    let bench = Bench::fitted();
    let said = bench.refused("fit run.csv --input x --output y -o m.json --levels 1000");
    assert!(said.contains("take fewer levels"), "{said}");
    let said = bench.refused("fit run.csv --input x --output y -o m.json --range -50,0");
    assert!(said.contains("take another range"), "{said}");
    let said = bench.refused("fit run.csv --input x --output y -o run.csv");
    assert!(said.contains("would replace a file that is read"), "{said}");
    for levels in 2..30 {
        let done = bench.run(&format!(
            "fit run.csv --input x --output y -o m.json --levels {levels}"
        ));
        assert_eq!(done.err, "", "nothing lies outside a plane made for it");
    }
    bench.refused("fit run.csv --input x --output y -o no/such/folder/m.json");
    bench.refused("fit run.csv --input x --output y -o .");
}

#[test]
fn columns_of_any_name_are_inspected() {
    let bench = Bench::new();
    bench.file("odd.csv", "x,x,\n1,a,3\n2,5,4\n");
    let done = bench.run("inspect odd.csv --json");
    assert_eq!(
        done.json()["columns"].as_array().unwrap().len(),
        3,
        "{}",
        done.err
    );
    assert_eq!(done.json()["columns"][1]["not_numbers"], 1);
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_devices_written_to() {
    let bench = Bench::fitted();
    bench.file("real.csv", "old");
    std::os::unix::fs::symlink(bench.path("real.csv"), bench.path("link.csv")).unwrap();
    assert_eq!(
        bench
            .run("simulate model.json run.csv --input x -o link.csv --force")
            .code,
        0
    );
    assert!(bench.path("link.csv").is_symlink());
    assert_eq!(bench.read("real.csv").lines().count(), 401);
    assert_eq!(
        bench
            .run("simulate model.json run.csv --input x -o /dev/null")
            .code,
        0
    );
    let said = bench.refused("simulate model.json run.csv --input x -o /dev/full");
    assert!(said.contains("/dev/full"), "{said}");
}

#[cfg(unix)]
#[test]
fn ended_in_the_middle_it_leaves_nothing() {
    let bench = Bench::fitted();
    let hysteron = assert_cmd::cargo::cargo_bin("hysteron");
    // Standard input that never ends.
    let mut child = std::process::Command::new(hysteron)
        .args([
            "simulate",
            "model.json",
            "-",
            "--input",
            "x",
            "-o",
            "out.csv",
        ])
        .current_dir(bench.folder.path())
        .stdin(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    std::io::Write::write_all(&mut stdin, b"x\n1\n2\n").unwrap();
    let names = || entries(bench.folder.path());
    let started = |names: Vec<String>| names.iter().any(|name| name.starts_with(".hysteron-"));
    // A minute is for a machine with much other work.
    for _ in 0..6000 {
        if started(names()) {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert!(
        started(names()),
        "the file beside is there while it is written"
    );
    let kill = std::process::Command::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(names(), ["model.json", "run.csv"]);
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_had_enough_is_no_fault() {
    let bench = Bench::fitted();
    let rows: String = (0..200_000).map(|n| format!("{n}\n")).collect();
    bench.file("long.csv", &format!("x\n{rows}"));
    let hysteron = assert_cmd::cargo::cargo_bin("hysteron");
    let line = format!(
        "set -o pipefail; {} simulate model.json long.csv --input x 2> err | head -n 2",
        hysteron.display()
    );
    let status = std::process::Command::new("bash")
        .args(["-c", &line])
        .current_dir(bench.folder.path())
        .stdout(std::process::Stdio::null())
        .status()
        .unwrap();
    assert!(
        status.success() && !bench.read("err").contains("roken"),
        "{}",
        bench.read("err")
    );
}

#[test]
fn inputs_outside_the_plane_are_told_of() {
    let bench = Bench::fitted();
    bench.file("far.csv", "x\n1000\n-1000\n50\n");
    let done = bench.run("simulate model.json far.csv --input x --json");
    assert_eq!(
        (&done.json()["high"], &done.json()["low"]),
        (&1.into(), &1.into())
    );
    assert!(
        done.err.contains("1 of 3 inputs above the plane"),
        "{}",
        done.err
    );
    let done = bench.run("invert model.json far.csv --target x");
    let statuses: Vec<&str> = done
        .out
        .lines()
        .skip(1)
        .filter_map(|l| l.rsplit(',').next())
        .collect();
    assert_eq!(statuses, ["high", "low", "high"]);
}

/// What looks like an option in a path is part of the path; options in the advice are the
/// command's.
#[test]
fn a_path_is_printed_as_it_is() {
    let bench = Bench::new();
    let here = bench.folder.path();
    let said = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("hysteron").unwrap();
        let done = command.current_dir(here).args(arguments).output().unwrap();
        assert_eq!(done.status.code(), Some(1));
        String::from_utf8(done.stderr).unwrap()
    };
    let none = said(&["inspect", "run --old/m.json"]);
    assert!(
        none.starts_with("hysteron: error: run --old/m.json: "),
        "{none}"
    );
    let path = "./--start unknown.csv";
    std::fs::write(here.join(path), "x,y\n1,2\n,3\n").unwrap();
    let broken = said(&["fit", path, "--input", "x", "--output", "y", "-o", "m.json"]);
    assert!(
        broken.contains("recording ./--start unknown.csv, line 3"),
        "{broken}"
    );
    assert!(broken.trim_end().ends_with("or use --repair"), "{broken}");
}
