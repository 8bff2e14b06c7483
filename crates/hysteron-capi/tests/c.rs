//! A C program that uses the whole interface, over the test vectors. It runs under valgrind if that
//! is installed.
#![allow(clippy::unwrap_used)]

#[path = "../../hysteron-export/tests/common/programs.rs"]
mod programs;

use programs::{has, links, run, skip};
use serde_json::Value;
use std::fmt::Write;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

const SANITIZE: &str = "-fsanitize=address,undefined";
const SOURCES: [&str; 9] = [
    "main.c",
    "vector.c",
    "vector_stages.c",
    "handles.c",
    "batch.c",
    "memory.c",
    "stages.c",
    "control.c",
    "misuse.c",
];

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The name that cargo gives the shared library, and the name that linked programs look for.
const SHARED: &str = "libhysteron_capi.so";
const SONAME: &str = "libhysteron_capi.so.0";

/// The folder of the libraries, beside that of the tests.
fn built() -> PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().into()
}

#[derive(Clone, Copy, PartialEq)]
enum Library {
    Static,
    Shared,
    /// The static one, with everything in C and every allocation of both watched by the compiler's
    /// sanitizers.
    Sanitized,
}

/// Compiles strictly and links with one of the libraries.
fn compile(sources: &[PathBuf], library: Library, program: &Path) {
    let folder = program.parent().unwrap();
    let mut cc = Command::new("cc");
    cc.args([
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Wpedantic",
        "-Werror",
        "-g",
    ]);
    cc.arg("-I").arg(here("include")).args(sources);
    if library == Library::Sanitized {
        cc.args([SANITIZE, "-fno-sanitize-recover=all"]);
    }
    if library == Library::Shared {
        cc.arg(built().join(SHARED));
        cc.arg(format!("-Wl,-rpath,{}", folder.display()));
    } else {
        cc.arg(built().join("libhysteron_capi.a"));
    }
    cc.args(["-lpthread", "-ldl", "-lm", "-o"]).arg(program);
    run(&mut cc);
}

/// The program linked in each way, the static library first; none without a C compiler.
fn programs(folder: &Path) -> Vec<PathBuf> {
    if !has("cc") {
        return Vec::new();
    }
    let sources = SOURCES.map(|name| here("tests/c").join(name));
    symlink(built().join(SHARED), folder.join(SONAME)).unwrap();
    let mut kinds = vec![(Library::Static, "static"), (Library::Shared, "shared")];
    if links("cc", &[SANITIZE]) || skip("`cc` has no sanitizers") {
        kinds.push((Library::Sanitized, "sanitized"));
    }
    let compiled = |(library, name)| {
        let program = folder.join(name);
        compile(&sources, library, &program);
        program
    };
    kinds.into_iter().map(compiled).collect()
}

/// Compiled once for all tests, in a temporary folder that the system clears.
fn compiled() -> &'static [PathBuf] {
    static PROGRAMS: OnceLock<(tempfile::TempDir, Vec<PathBuf>)> = OnceLock::new();
    let made = || {
        let folder = tempfile::tempdir().unwrap();
        let programs = programs(folder.path());
        (folder, programs)
    };
    &PROGRAMS.get_or_init(made).1
}

/// Each run of each vector, as a model file and a table that C reads easily.
fn vectors(folder: &Path) -> Vec<(PathBuf, PathBuf)> {
    let mut runs = Vec::new();
    for entry in std::fs::read_dir(here("../../vectors")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "json") {
            continue;
        }
        let file: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let model = folder.join(format!("{name}.model.json"));
        std::fs::write(&model, file["model"].to_string()).unwrap();
        let kind = file["kind"].as_str().unwrap();
        let (mut columns, tolerance) = match kind {
            "forward" => (vec!["input", "output"], "output"),
            _ => (vec!["heading", "target", "input", "status"], "input"),
        };
        let staged = file["version"] == 2;
        if staged {
            columns.extend(["dt", "load"]);
        }
        for (n, run) in file["runs"].as_array().unwrap().iter().enumerate() {
            let count = run["input"].as_array().unwrap().len();
            let (tolerance, policy) = (&file["tolerance"][tolerance], &run["tolerance"]);
            let policy = policy.as_f64().unwrap_or(0.0);
            let mut text = format!("{kind} {count} {tolerance} {policy}\n");
            if staged {
                let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
                let range = &run["drive_range"];
                let limits = [&range[0], &range[1], &run["horizon"]].map(number);
                text = format!("stages {text}{} {} {}\n", limits[0], limits[1], limits[2]);
            }
            for row in 0..count {
                for column in &columns {
                    match &run[column][row] {
                        Value::Null => text.push_str("nan "),
                        number => write!(text, "{number} ").unwrap(),
                    }
                }
                text.push('\n');
            }
            let table = folder.join(format!("{name}.{n}.txt"));
            std::fs::write(&table, text).unwrap();
            runs.push((model.clone(), table));
        }
    }
    assert!(runs.len() >= 120, "{} runs", runs.len());
    runs
}

/// Model and table of this run: the vector's name and the run's number.
fn one_of(runs: &[(PathBuf, PathBuf)], name: &str) -> (PathBuf, PathBuf) {
    let of = |(_, table): &&(PathBuf, PathBuf)| table.to_str().unwrap().contains(name);
    runs.iter().find(of).unwrap().clone()
}

#[test]
fn the_vectors_in_c() {
    let folder = tempfile::tempdir().unwrap();
    for (model, table) in vectors(folder.path()) {
        for program in compiled() {
            run(Command::new(program).arg(&model).arg(&table));
        }
    }
}

#[test]
fn all_of_the_interface_in_c() {
    let folder = tempfile::tempdir().unwrap();
    for program in compiled() {
        run(Command::new(program).current_dir(folder.path()));
    }
}

#[test]
fn valgrind_finds_nothing() {
    let [program, ..] = compiled() else {
        return;
    };
    if !has("valgrind") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let valgrind = || {
        let mut command = Command::new("valgrind");
        command.args(["--quiet", "--error-exitcode=9", "--leak-check=full"]);
        let suppressions = here("tests/c/valgrind.supp");
        command.arg(format!("--suppressions={}", suppressions.display()));
        command.arg(program);
        command
    };
    run(valgrind().current_dir(folder.path()));
    let runs = vectors(folder.path());
    for name in [
        "forward-mkp-20.1",
        "inverse-mkp-5-negative.1",
        "forward-chain-kp-5.2",
        "inverse-chain-kp-5.4",
    ] {
        let (model, table) = one_of(&runs, name);
        run(valgrind().arg(model).arg(table));
    }
}

/// A test of the test: the program fails if an expected number is changed.
#[test]
fn a_wrong_vector_is_noticed() {
    let [program, ..] = compiled() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let (model, table) = one_of(&vectors(folder.path()), "forward-mkp-20.0");
    let text = std::fs::read_to_string(&table).unwrap();
    let (head, rest) = text.split_once('\n').unwrap();
    let moved = rest.replacen(' ', "1 ", 1);
    std::fs::write(&table, format!("{head}\n{moved}")).unwrap();
    let output = Command::new(program)
        .arg(&model)
        .arg(&table)
        .output()
        .unwrap();
    assert!(!output.status.success());
}

/// The command lines and the program of the page on C, word for word, in a folder like a clone with
/// built libraries.
#[test]
fn the_page_on_c() {
    if !has("cc") {
        return;
    }
    let (page, program) = programs::page("c.md");
    let commands = page.split("```text\n").nth(1).unwrap();
    let commands = commands.split("```").next().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (include, libraries) = ("crates/hysteron-capi/include", "target/release");
    let make = |name: &str| std::fs::create_dir_all(folder.path().join(name)).unwrap();
    make("crates/hysteron-capi");
    make(libraries);
    symlink(here("include"), folder.path().join(include)).unwrap();
    for name in [SHARED, "libhysteron_capi.a"] {
        symlink(built().join(name), folder.path().join(libraries).join(name)).unwrap();
    }
    std::fs::write(folder.path().join("spring.c"), program).unwrap();
    let shell = |line: &str| {
        let mut shell = Command::new("sh");
        shell.args(["-euc", line]).current_dir(folder.path());
        shell
    };
    run(&mut shell(commands));
    let names = ["./spring-static", "./spring-shared"];
    for name in names {
        let alone = shell(name).status().unwrap();
        assert!(!alone.success(), "without the model it says why");
    }
    let (model, _) = one_of(&vectors(folder.path()), "forward-mkp-20.0");
    std::fs::rename(model, folder.path().join("spring.json")).unwrap();
    for name in names {
        run(&mut shell(name));
    }
    // The second program, of a model with stages.
    let program = page.split("```c\n").nth(2).unwrap();
    let program = program.split("```").next().unwrap();
    std::fs::write(folder.path().join("spring.c"), program).unwrap();
    run(&mut shell(commands));
    let (model, _) = one_of(&vectors(folder.path()), "inverse-chain-mkp-5.0");
    std::fs::rename(model, folder.path().join("wire.json")).unwrap();
    for name in names {
        run(&mut shell(name));
    }
    // The third one has its state in memory of its own.
    let program = page.split("```c\n").nth(3).unwrap();
    let program = program.split("```").next().unwrap();
    std::fs::write(folder.path().join("spring.c"), program).unwrap();
    run(&mut shell(commands));
    for name in names {
        run(&mut shell(name));
    }
    // The page on loops.
    let (_, program) = programs::page("c-loop.md");
    std::fs::write(folder.path().join("spring.c"), program).unwrap();
    run(&mut shell(commands));
    for name in names {
        let told = shell(name).output().unwrap();
        let told = String::from_utf8(told.stdout).unwrap();
        let missed = told.split(", off by ").nth(1).unwrap();
        let missed: f64 = missed.split(' ').next().unwrap().parse().unwrap();
        assert!(missed.abs() < 0.05, "{told}");
    }
    // The fourth one follows a load, and finds it.
    let program = page.split("```c\n").nth(4).unwrap();
    let program = program.split("```").next().unwrap();
    std::fs::write(folder.path().join("spring.c"), program).unwrap();
    run(&mut shell(commands));
    for name in names {
        let told = shell(name).output().unwrap();
        let told = String::from_utf8(told.stdout).unwrap();
        let load = told
            .split("load of ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next());
        let load: f64 = load.unwrap().parse().unwrap();
        assert!((load - 150.0).abs() < 5.0, "{told}");
    }
    assert!(commands.contains(&native_libraries()), "{commands}");
}

/// What a static library in Rust needs beside itself, as the compiler says.
fn native_libraries() -> String {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("empty.rs");
    std::fs::write(&source, "").unwrap();
    let mut rustc = Command::new("rustc");
    rustc.args(["--crate-type=staticlib", "--print=native-static-libs"]);
    let done = rustc.current_dir(folder.path()).arg(&source).output();
    let text = String::from_utf8(done.unwrap().stderr).unwrap();
    let line = text.lines().find_map(|line| line.split_once("libs: "));
    line.unwrap().1.trim().to_owned()
}

#[test]
fn the_shared_library_has_the_name_that_programs_look_for() {
    if !has("readelf") {
        return;
    }
    let mut readelf = Command::new("readelf");
    let done = readelf.arg("-d").arg(built().join(SHARED)).output();
    let text = String::from_utf8(done.unwrap().stdout).unwrap();
    let line = text.lines().find(|line| line.contains("(SONAME)"));
    assert!(line.unwrap().contains(&format!("[{SONAME}]")), "{text}");
}
