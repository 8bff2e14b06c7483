//! `hysteron run` as a user has it: the commands of docs/bench.md, exit codes, signals.
#![cfg(unix)]

use crate::common::{refused, run, text};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

const PAGE: &str = include_str!("../../../../docs/bench.md");

fn bash(folder: &Path, script: &str) -> std::process::Output {
    let hysteron = assert_cmd::cargo::cargo_bin("hysteron");
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{path}", hysteron.parent().unwrap().display());
    Command::new("bash")
        .args(["-euo", "pipefail", "-c", script])
        .env("PATH", path)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// The folder that the commands of the page make; `None` where there is no Python to run them.
fn page() -> Option<TempDir> {
    if Command::new("python3").arg("--version").output().is_err() {
        eprintln!("skipped: the commands of docs/bench.md: python3 is not there");
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let blocks = PAGE.split("```sh\n").skip(1);
    let script: String = blocks
        .filter_map(|block| block.split("```").next())
        .collect();
    let done = bash(folder.path(), &script);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let last = text(&done.stderr);
    assert_eq!(last.lines().last(), Some("hysteron: done: all was run"));
    Some(folder)
}

#[test]
fn the_page_goes_from_an_empty_folder_to_a_controlled_plant() {
    let Some(folder) = page() else {
        return;
    };
    let bench = folder.path().join("bench");
    let log = fs::read_to_string(bench.join("controlled.csv")).unwrap();
    let rows = log
        .lines()
        .skip(1)
        .map(|row| row.split(',').collect::<Vec<_>>());
    let errors = rows.skip(100).map(|row| {
        let [reference, output] = [1, 4].map(|n| row[n].parse::<f64>().unwrap());
        (reference - output).powi(2)
    });
    let errors: Vec<f64> = errors.collect();
    let rmse = (errors.iter().sum::<f64>() / errors.len() as f64).sqrt();
    assert!(rmse < 0.2, "{rmse} mm of 4");

    // The same once more replaces its own log; a log that was changed is kept.
    assert!(run(&bench, "run control.toml").status.success());
    fs::write(bench.join("controlled.csv"), "mine").unwrap();
    assert!(refused(&bench, "run control.toml").contains("--force"));
    assert!(run(&bench, "run control.toml --force").status.success());

    let wrong = fs::read_to_string(bench.join("control.toml"))
        .unwrap()
        .replace("slew", "slow");
    fs::write(bench.join("wrong.toml"), wrong).unwrap();
    let said = refused(&bench, "run wrong.toml");
    assert!(
        said.contains("wrong.toml, line 8") && said.contains("slow"),
        "{said}"
    );

    ends_by_signals(&bench);
}

/// Ctrl-C and SIGTERM: the drive is safe, the child is gone, the log is whole.
fn ends_by_signals(bench: &Path) {
    let plant = fs::read_to_string(bench.join("plant.py")).unwrap();
    let slow = plant.replace(
        "    heat +=",
        "    import time; time.sleep(0.02)\n    heat +=",
    );
    fs::write(
        bench.join("slow.py"),
        slow.replace("        break", "        open('quit', 'w')\n        break"),
    )
    .unwrap();
    let config = fs::read_to_string(bench.join("control.toml")).unwrap();
    fs::write(
        bench.join("slow.toml"),
        config.replace("plant.py", "slow.py"),
    )
    .unwrap();
    for signal in ["INT", "TERM"] {
        let hysteron = assert_cmd::cargo::cargo_bin("hysteron");
        let child = Command::new(hysteron)
            .args(["run", "slow.toml", "-o", "slow.csv"])
            .current_dir(bench)
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let log = bench.join("slow.csv");
        let rows = || fs::read_to_string(&log).map_or(0, |text| text.lines().count());
        while rows() < 10 {
            std::thread::sleep(Duration::from_millis(20));
        }
        let kill = bash(bench, &format!("kill -{signal} {}", child.id()));
        assert!(kill.status.success());
        let done = child.wait_with_output().unwrap();
        assert_eq!(done.status.code(), Some(130));
        let said = text(&done.stderr);
        assert!(
            said.trim_end().ends_with("stopped: by Ctrl-C or a signal"),
            "{said}"
        );
        assert!(fs::read_to_string(&log).unwrap().ends_with('\n'));
        fs::remove_file(bench.join("quit")).expect("the device was told to quit");
        fs::remove_file(&log).unwrap();
    }
}
