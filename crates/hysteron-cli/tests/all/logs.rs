//! `fit`, `adapt` and `evaluate` take the logs of `run` and the runs of `track` as they are. The plant
//! is simulated.

use assert_cmd::Command;
use std::fs;
use std::path::Path;

/// Standard output, standard error.
fn done(folder: &Path, line: &str) -> (String, String) {
    let output = Command::cargo_bin("hysteron")
        .unwrap()
        .current_dir(folder)
        .args(line.split_whitespace())
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{line}: {}", text(&output.stderr));
    (text(&output.stdout), text(&output.stderr))
}

fn write_bench(folder: &Path, name: &str, controller: &str) {
    let text = format!(
        "mode = \"control\"\nlog = \"{name}.csv\"\ndevice = {{ simulated = \"preisach\" }}\n\
         reference = {{ table = \"reference.csv\" }}\n[controller]\n{controller}\n"
    );
    fs::write(folder.join(format!("{name}.toml")), text).unwrap();
}

/// Root mean square of reference less output, after the start.
fn error(folder: &Path, log: &str) -> f64 {
    let text = fs::read_to_string(folder.join(log)).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = |name: &str| names.iter().position(|column| *column == name).unwrap();
    let (reference, output) = (at("reference"), at("output"));
    let rows = lines
        .skip(50)
        .map(|line| line.split(',').collect::<Vec<_>>());
    let rows: Vec<Vec<&str>> = rows.filter(|row| !row[reference].is_empty()).collect();
    let squares = rows.iter().map(|row| {
        let number = |n: usize| row[n].parse::<f64>().unwrap();
        (number(reference) - number(output)).powi(2)
    });
    (squares.sum::<f64>() / rows.len() as f64).sqrt()
}

#[test]
fn a_loop_learns_from_its_own_log() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut rows = String::from("time,reference\n");
    for n in 0..3000 {
        let n = f64::from(n);
        let reference = 30.0 - 22.0 * (0.03 * n).cos() * (1.0 - n / 4000.0);
        rows += &format!("{},{reference}\n", 0.01 * n);
    }
    fs::write(folder.join("reference.csv"), rows).unwrap();
    let gains = "proportional = 0.2\nintegral_s = 0.05";
    write_bench(folder, "pid", &format!("kind = \"pid\"\n{gains}"));
    done(folder, "run pid.toml");
    let (_, said) = done(folder, "fit pid.csv -o pid.json");
    let roles = "a log of `hysteron run`: input `drive`, output `output`";
    assert!(said.contains(roles), "{said}");
    write_bench(
        folder,
        "model",
        "kind = \"inverse-pid\"\nmodel = \"pid.json\"",
    );
    done(folder, "run model.toml");
    let (before, after) = (error(folder, "pid.csv"), error(folder, "model.csv"));
    println!("simulated plant: {before:.3} um by PID, {after:.3} um with the model of its log");
    assert!(after < 0.5 * before, "{before} {after}");
    // The log of that run adapts the model, and judges it.
    done(folder, "adapt pid.json model.csv --force -o adapted.json");
    let (out, _) = done(folder, "evaluate adapted.json model.csv --json");
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(
        object["forward"]["nrmse_percent"].as_f64().unwrap() < 5.0,
        "{out}"
    );
}

#[test]
fn readings_that_the_loop_did_not_believe_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut rows =
        String::from("time,reference,drive,command,output,output_model,status,learner,sample\n");
    for n in 0..2000 {
        let drive = 50.0 - 40.0 * (0.02 * f64::from(n)).cos();
        let (output, status) = match n % 50 {
            7 => ("nan".into(), "missing"),
            19 => ("900".into(), "rejected+limited"),
            23..26 => ("-70".into(), "stuck"),
            _ => (drive.to_string(), "ok"),
        };
        let time = 0.1 * f64::from(n);
        rows += &format!("{time},1,{drive},{drive},{output},,{status},,{n}\n");
    }
    fs::write(folder.join("log.csv"), rows).unwrap();
    let (out, said) = done(
        folder,
        "fit log.csv -o m.json --levels 10 --bootstrap 0 --json",
    );
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(
        said.contains("whose reading the loop did not believe"),
        "{said}"
    );
    assert_eq!(object["fit"]["samples"], 1800, "{out}");
}
