//! `hysteron start`: from a file alone to commands that work.

use assert_cmd::Command;
use serde_json::Value;

/// Four loops of a play, as a logger writes them.
fn table() -> String {
    let mut text = "time [s];temperature [degC];lift [mm]\n".to_owned();
    let mut y = 20.0_f64;
    for n in 0..500 {
        let t = 50.0 - 30.0 * (f64::from(n) * 0.05).cos() * (1.0 - f64::from(n) / 900.0);
        y = y.clamp(t - 4.0, t + 4.0);
        text += &format!("{};{t};{}\n", f64::from(n) * 0.1, 0.2 * y);
    }
    text
}

fn hysteron(folder: &tempfile::TempDir) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron"));
    command.current_dir(folder.path());
    command
}

#[test]
fn a_file_alone_gives_a_fit_and_commands_that_run() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("run 1.csv"), table()).unwrap();
    let done = hysteron(&folder)
        .args(["start", "run 1.csv", "--json"])
        .assert()
        .success();
    let found: Value = serde_json::from_slice(&done.get_output().stdout).unwrap();
    assert_eq!(found["roles"]["input"], "temperature [degC]");
    assert_eq!(found["roles"]["output"], "lift [mm]");
    assert_eq!(found["roles"]["time"], "time [s]");
    let verdict = &found["verdict"];
    assert_eq!(verdict["basis"], "branches_left_out");
    assert!(verdict["percent"].as_f64().unwrap() < verdict["rival"][1].as_f64().unwrap());
    // Each command is one that the shell and hysteron take.
    let commands = found["commands"].as_array().unwrap();
    let runs = commands.iter().map(|command| command.as_str().unwrap());
    let runs: Vec<&str> = runs.filter(|command| !command.contains("studio")).collect();
    assert_eq!(runs.len(), 3);
    let binary = std::path::Path::new(env!("CARGO_BIN_EXE_hysteron"));
    let path = format!(
        "{}:{}",
        binary.parent().unwrap().display(),
        std::env::var("PATH").unwrap()
    );
    std::fs::copy(
        folder.path().join("run 1.csv"),
        folder.path().join("ANOTHER.csv"),
    )
    .unwrap();
    if cfg!(unix) {
        for run in runs {
            let mut shell = Command::new("sh");
            shell.current_dir(folder.path()).env("PATH", &path);
            shell.args(["-c", run]).assert().success();
        }
        assert!(folder.path().join("report/index.html").exists());
    }
    let done = hysteron(&folder)
        .args(["start", "run 1.csv"])
        .assert()
        .success();
    let text = String::from_utf8(done.get_output().stdout.clone()).unwrap();
    for part in [
        "500 rows",
        "input: `temperature [degC]`",
        "a first fit",
        "Go on with:",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

#[test]
fn a_file_without_two_columns_that_change_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("one.csv"), "a,b\n1,2\n1,3\n1,4\n").unwrap();
    let done = hysteron(&folder)
        .args(["start", "one.csv"])
        .assert()
        .code(1);
    let text = String::from_utf8(done.get_output().stderr.clone()).unwrap();
    assert!(text.contains("input and output are needed"), "{text}");
}

#[test]
fn start_asks_for_roles_that_cannot_be_told() {
    let folder = tempfile::tempdir().unwrap();
    let table = table().replace("temperature [degC];lift [mm]", "channel 1;channel 2");
    std::fs::write(folder.path().join("run.csv"), &table).unwrap();
    let done = hysteron(&folder)
        .args(["start", "run.csv", "-o", "first.json"])
        .assert()
        .code(2);
    let said = String::from_utf8(done.get_output().stderr.clone()).unwrap();
    assert!(done.get_output().stdout.is_empty());
    assert!(!folder.path().join("first.json").exists());
    for part in ["which column is the input?", "`channel 1`", "`channel 2`"] {
        assert!(said.contains(part), "{part} in {said}");
    }
    // The command that is named runs.
    let command = said.lines().last().unwrap().trim();
    let words = "hysteron start run.csv --input 'channel 1' --output 'channel 2' --time 'time [s]'";
    assert_eq!(command, words);
    let named = [
        "--input",
        "channel 1",
        "--output",
        "channel 2",
        "--time",
        "time [s]",
    ];
    hysteron(&folder)
        .args(["start", "run.csv", "-o", "first.json"])
        .args(named)
        .assert()
        .success();
    let model = std::fs::read_to_string(folder.path().join("first.json")).unwrap();
    assert!(model.contains("hysteron-model"));
}

/// A German logger: its time is no output.
#[test]
fn a_time_is_never_the_output() {
    let folder = tempfile::tempdir().unwrap();
    for header in [
        "Zeit;Temperatur;Weg",
        "X_Value;T;foo",
        "Messung;U [V];s [mm]",
    ] {
        let table = table();
        let (_, rows) = table.split_once('\n').unwrap();
        std::fs::write(folder.path().join("run.csv"), format!("{header}\n{rows}")).unwrap();
        let done = hysteron(&folder)
            .args(["start", "run.csv", "--json"])
            .assert()
            .success();
        let found: Value = serde_json::from_slice(&done.get_output().stdout).unwrap();
        let [_, input, output] = header.split(';').collect::<Vec<_>>()[..] else {
            unreachable!();
        };
        assert_eq!(found["roles"]["input"], input, "{header}");
        assert_eq!(found["roles"]["output"], output, "{header}");
    }
}
