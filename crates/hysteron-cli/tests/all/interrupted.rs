//! Runs that end in the middle: a full disk, a signal, a reader that goes.
#![cfg(unix)]

use crate::common::{run, text};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;
use tempfile::TempDir;

const REPORT: &str = "evaluate m.json run.csv --input x --output y --report out/report";

fn bench() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..20_000)
        .map(|n| {
            let x = 50.0 - 30.0 * (f64::from(n) * 0.01).cos();
            format!("{x},{}\n", 0.2 * x)
        })
        .collect();
    fs::write(folder.path().join("run.csv"), format!("x,y\n{rows}")).unwrap();
    let fit = "fit run.csv --input x --output y --levels 4 --bootstrap 0 -o m.json";
    let done = run(folder.path(), fit);
    assert!(done.status.success(), "{}", text(&done.stderr));
    folder
}

fn hysteron(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("hysteron"));
    command.current_dir(folder).args(line.split_whitespace());
    command
}

/// Runs with files of so many kilobytes at most, as a disk that is full then.
fn with_room(folder: &Path, kilobytes: u64, line: &str) -> Output {
    let hysteron = assert_cmd::cargo::cargo_bin("hysteron");
    let limited = format!(
        "trap '' XFSZ; ulimit -f {kilobytes}; exec {} {line}",
        hysteron.display()
    );
    Command::new("bash")
        .args(["-c", &limited])
        .current_dir(folder)
        .output()
        .unwrap()
}

fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => found.extend(files(&path)),
            false => _ = found.insert(path.clone(), fs::read(&path).unwrap()),
        }
    }
    found
}

#[test]
fn on_a_full_disk_the_old_stays_whole() {
    let bench = bench();
    let path = bench.path();
    let lines = [
        "simulate m.json run.csv --input x -o out.csv",
        "simulate m.json run.csv --input x -o out.parquet",
        "invert m.json out.parquet --target y -o copied.parquet",
        "simulate m.json run.csv --input x -o out.arrow",
        "invert m.json out.arrow --target y -o copied.arrow",
        "invert m.json out.arrow --target y -o other.parquet",
        "prepare run.csv --input x --output y -o clean.csv",
        "adapt m.json run.csv --input x --output y -o adapted.json --table adapted.parquet",
        "export fmu m.json -o m.fmu",
        "export c m.json -o mcu",
        REPORT,
        "demo -o demo",
    ];
    for line in lines {
        // Without and with an earlier result.
        for _ in 0..2 {
            let before = files(path);
            for kilobytes in [0, 1, 8, 64] {
                let done = with_room(path, kilobytes, line);
                if done.status.success() {
                    continue;
                }
                let said = text(&done.stderr);
                assert!(
                    said.contains("File too large"),
                    "{kilobytes} {line}: {said}"
                );
                assert!(
                    !said.contains(".hysteron-"),
                    "a name that nobody knows: {said}"
                );
                assert!(
                    files(path) == before,
                    "{kilobytes} {line}: something changed"
                );
            }
            assert_eq!(with_room(path, 0, line).status.code(), Some(1), "{line}");
            let done = run(path, line);
            assert!(done.status.success(), "{line}: {}", text(&done.stderr));
        }
    }
}

/// What is being written in a folder.
fn hidden(folder: &Path) -> Vec<PathBuf> {
    let paths = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let begins = |path: &PathBuf| {
        path.file_name()
            .unwrap()
            .to_str()
            .unwrap()
            .starts_with(".hysteron-")
    };
    paths.filter(begins).collect()
}

/// Waits until something is being written.
fn started(folder: &Path) -> Vec<PathBuf> {
    for _ in 0..6000 {
        let hidden = hidden(folder);
        if !hidden.is_empty() {
            return hidden;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("nothing is written")
}

/// A simulation whose rows have not all come.
fn half_a_table(folder: &Path, out: &str) -> Child {
    let line = format!("simulate m.json - --input x -o {out}");
    let mut child = hysteron(folder, &line)
        .stdin(Stdio::piped())
        .spawn()
        .unwrap();
    let rows = "25\n".repeat(100_000);
    write!(child.stdin.as_mut().unwrap(), "x\n{rows}").unwrap();
    child
}

#[test]
fn what_a_killed_run_left_is_removed_by_the_next() {
    let bench = bench();
    let path = bench.path();
    for out in ["out.csv", "out.parquet", "out.arrow"] {
        let mut killed = half_a_table(path, out);
        started(path);
        killed.kill().unwrap();
        killed.wait().unwrap();
        assert_eq!(hidden(path).len(), 1);
        let done = run(path, "simulate m.json run.csv --input x -o other.csv");
        assert!(done.status.success());
        assert!(hidden(path).is_empty() && !path.join(out).exists());
    }
    // A folder that is written into one that is there, and beside it.
    for out in ["into", "anew"] {
        fs::create_dir_all(path.join("into")).unwrap();
        fs::write(path.join("into/note"), "mine").unwrap();
        let line = format!("track load-step --seeds 50 -o {out}");
        let mut killed = hysteron(path, &line).stderr(Stdio::null()).spawn().unwrap();
        let at = if out == "into" {
            path.join("into")
        } else {
            path.to_owned()
        };
        started(&at);
        killed.kill().unwrap();
        killed.wait().unwrap();
        let next = REPORT.replace("out/report", out);
        let done = run(path, &next);
        assert!(done.status.success(), "{}", text(&done.stderr));
        assert!(hidden(&at).is_empty());
        assert_eq!(fs::read(path.join("into/note")).unwrap(), b"mine");
    }
}

#[test]
fn what_another_run_is_writing_stays() {
    let bench = bench();
    let path = bench.path();
    let mut first = half_a_table(path, "first.csv");
    let writing = started(path);
    let done = run(path, "simulate m.json run.csv --input x -o second.csv");
    assert!(done.status.success());
    assert_eq!(hidden(path), writing);
    drop(first.stdin.take());
    assert!(first.wait().unwrap().success());
    assert!(hidden(path).is_empty());
    assert_eq!(
        fs::read_to_string(path.join("first.csv"))
            .unwrap()
            .lines()
            .count(),
        100_001
    );
}

/// Rows that come one by one are answered one by one. When the reader of the answers is gone, the
/// next row ends the run.
#[test]
fn each_row_is_answered_before_the_next_one_comes() {
    let bench = bench();
    let mut child = hysteron(bench.path(), "simulate m.json - --input x")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut rows = child.stdin.take().unwrap();
    let mut answers = BufReader::new(child.stdout.take().unwrap());
    // So many rows tell the dialect.
    write!(rows, "x\n20\n30\n40\n").unwrap();
    let mut line = String::new();
    for expected in ["x,output_model", "20,", "30,", "40,"] {
        line.clear();
        answers.read_line(&mut line).unwrap();
        assert!(line.starts_with(expected), "{line}");
    }
    for n in 0..200 {
        writeln!(rows, "{n}").unwrap();
        line.clear();
        answers.read_line(&mut line).unwrap();
        assert!(line.starts_with(&format!("{n},")), "{line}");
    }
    drop(answers);
    writeln!(rows, "50").unwrap();
    // Its standard input stays open.
    assert!(child.wait().unwrap().success());
}

#[test]
fn a_pipe_whose_reader_goes_is_a_fault() {
    let bench = bench();
    let path = bench.path();
    for name in ["pipe", "pipe.parquet"] {
        let made = Command::new("mkfifo")
            .arg(path.join(name))
            .status()
            .unwrap();
        assert!(made.success());
        let read = format!("head -c 1 {name} > /dev/null");
        let mut reader = Command::new("bash")
            .args(["-c", &read])
            .current_dir(path)
            .spawn()
            .unwrap();
        let done = run(
            path,
            &format!("simulate m.json run.csv --input x -o {name}"),
        );
        reader.wait().unwrap();
        let said = text(&done.stderr);
        assert_eq!(done.status.code(), Some(1), "{name}: {said}");
        assert!(said.contains(name), "{said}");
    }
}

/// Killed at any moment, a run over an earlier report leaves one of the two, whole.
#[test]
fn a_report_killed_at_any_moment_is_the_old_or_the_new() {
    let bench = bench();
    let path = bench.path();
    let line = REPORT.replace("out/report", "report");
    let began = std::time::Instant::now();
    assert!(run(path, &line).status.success());
    let takes = began.elapsed();
    let old = files(&path.join("report"));
    // The new one has another title.
    fs::copy(path.join("m.json"), path.join("n.json")).unwrap();
    let line = line.replace("m.json", "n.json");
    const TRIES: u32 = 20;
    let mut new = None;
    for n in 0..TRIES {
        let mut child = hysteron(path, &line)
            .stderr(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        // Most of the moments are near the end, where the report takes its place.
        std::thread::sleep(takes.mul_f64(0.6 + 0.6 * f64::from(n) / f64::from(TRIES)));
        // It may have come to its end.
        let _ = child.kill();
        child.wait().unwrap();
        let found = files(&path.join("report"));
        if found != old {
            assert!(
                *new.get_or_insert_with(|| found.clone()) == found,
                "neither old nor new"
            );
        }
    }
    assert!(run(path, &line).status.success());
    let found = files(&path.join("report"));
    assert!(found != old && new.is_none_or(|new| new == found));
    assert!(hidden(path).is_empty());
}
