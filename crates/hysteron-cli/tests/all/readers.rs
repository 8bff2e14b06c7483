//! Files as people have them, through the command: what is kept, shown, refused.

use crate::common::{refused, run, text};
use assert_cmd::Command;
use std::fs;
use std::path::Path;

#[test]
fn prepare_keeps_names_and_all_columns() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |step: &dyn Fn(i32) -> f64| -> String {
        let row = |n: i32| {
            format!(
                "{n};{};{};{};note {n}\n",
                step(n),
                f64::from(n % 20),
                n % 20 * 2
            )
        };
        (0..60).map(row).collect()
    };
    let header = "no;Zeit [ms];T [degC];lift [mm];remark\n";
    fs::write(
        folder.path().join("run.csv"),
        format!("{header}{}", rows(&|n| 500.0 * f64::from(n))),
    )
    .unwrap();
    let line = "prepare run.csv --input T --output lift --time zeit --low-pass off --dead-band off \
                -o out.csv";
    let done = run(folder.path(), line);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert!(text(&done.stderr).contains("is in ms: turned into seconds"));
    let written = fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let mut lines = written.lines();
    assert_eq!(lines.next(), Some("no,Zeit [s],T [degC],lift [mm],remark"));
    assert_eq!(lines.next(), Some("0,0,0,0,note 0"));
    assert_eq!(lines.nth(2), Some("3,1.5,3,6,note 3"));
    // Where the times change, numbers are interpolated and text cannot be.
    let done = run(
        folder.path(),
        &line.replace("out.csv", "again.csv --resample 0.25"),
    );
    assert!(
        text(&done.stderr).contains("left out, because text cannot be resampled: remark"),
        "{}",
        text(&done.stderr)
    );
    let written = fs::read_to_string(folder.path().join("again.csv")).unwrap();
    assert_eq!(
        written.lines().next(),
        Some("no,Zeit [s],T [degC],lift [mm]")
    );
    assert_eq!(written.lines().nth(2), Some("0.5,0.25,0.5,1"));
}

/// What the terminal would act upon: control characters, and marks of direction.
fn acts(text: &str) -> bool {
    text.chars().any(|c| {
        c.is_control() && c != '\n' && c != '\t'
            || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    })
}

/// Names with every control character there is, and the marks of direction.
#[test]
fn no_name_reaches_the_terminal_raw() {
    let folder = tempfile::tempdir().unwrap();
    let codes = (1..0x20).chain(0x7f..0xa0).chain([0x202e, 0x2066]);
    let codes = codes.filter(|code| ![0x0a, 0x0d].contains(code));
    for name in codes
        .filter_map(char::from_u32)
        .map(|c| format!("x{c}[31m"))
    {
        let path = folder.path().join("run.csv");
        fs::write(&path, format!("\"{name}\",y\n1,2\n2,3\n{name},4\n")).unwrap();
        let command = |words: &[&str]| {
            let mut command = Command::cargo_bin("hysteron").unwrap();
            let done = command
                .current_dir(folder.path())
                .args(words)
                .output()
                .unwrap();
            for text in [text(&done.stdout), text(&done.stderr)] {
                assert!(!acts(&text), "{words:?}: {text:?}");
            }
        };
        command(&["inspect", "run.csv"]);
        command(&["inspect", "run.csv", "--json"]);
        command(&[
            "fit", "run.csv", "--input", &name, "--output", "y", "-o", "m.json",
        ]);
        command(&[
            "fit", &name, "--input", "x", "--output", "y", "-o", "m.json", "--levels", &name,
        ]);
        command(&["track", &name]);
        command(&["inspect", &format!("{name}.json")]);
    }
}

#[test]
fn no_name_reaches_a_report_raw() {
    let folder = tempfile::tempdir().unwrap();
    let name = "x\u{1b}[31m\u{202e}";
    let rows: String = (0..80)
        .map(|n| format!("{},{}\n", (n - 40_i32).abs(), n % 40))
        .collect();
    fs::write(folder.path().join("run.csv"), format!("{name},y\n{rows}")).unwrap();
    let made = [
        vec![
            "fit",
            "run.csv",
            "--input",
            name,
            "--output",
            "y",
            "-o",
            "m.json",
            "--bootstrap",
            "0",
        ],
        vec![
            "evaluate", "m.json", "run.csv", "--input", name, "--output", "y", "--report", "report",
        ],
    ];
    for words in made {
        let mut command = Command::cargo_bin("hysteron").unwrap();
        let done = command
            .current_dir(folder.path())
            .args(words)
            .output()
            .unwrap();
        assert!(done.status.success(), "{}", text(&done.stderr));
        assert!(!acts(&text(&done.stderr)) && !acts(&text(&done.stdout)));
    }
    let mut pages = 0;
    for file in fs::read_dir(folder.path().join("report")).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_some_and(|ending| ending != "png") {
            assert!(
                !acts(&fs::read_to_string(&path).unwrap()),
                "{}",
                path.display()
            );
            pages += 1;
        }
    }
    assert!(pages > 1);
}

/// The system gives no more memory than a little above the budget: nothing asks for it.
#[cfg(unix)]
#[test]
fn claims_of_terabytes_are_refused_and_nothing_aborts() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hysteron/tests/fixtures");
    let binary = env!("CARGO_BIN_EXE_hysteron");
    for name in ["claims-contiguous.mat", "claims-chunked.mat"] {
        let file = fixtures.join(name);
        let line = format!(
            "ulimit -v 600000; exec {binary} inspect {} --max-memory 64M",
            file.display()
        );
        let done = Command::new("sh").args(["-c", &line]).output().unwrap();
        assert_eq!(
            done.status.code(),
            Some(1),
            "{name}: {}",
            text(&done.stderr)
        );
        assert!(
            text(&done.stderr).contains("of 64.0 MiB are left"),
            "{}",
            text(&done.stderr)
        );
    }
}

#[test]
fn max_memory_is_a_size() {
    let folder = tempfile::tempdir().unwrap();
    let rows = "1,2\n".repeat(1 << 18);
    fs::write(folder.path().join("run.csv"), format!("x,y\n{rows}")).unwrap();
    let line = "fit run.csv --input x --output y -o m.json --max-memory";
    assert!(refused(folder.path(), &format!("{line} 1M")).contains("the recording needs"));
    for wrong in ["0", "much", "4T", "-1"] {
        let done = run(folder.path(), &format!("{line}={wrong}"));
        assert_eq!(done.status.code(), Some(2), "{wrong}");
        assert!(text(&done.stderr).contains("--max-memory"), "{wrong}");
    }
}
