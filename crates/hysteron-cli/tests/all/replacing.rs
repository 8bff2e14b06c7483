//! What a command may replace, from outside: every command, with everything that may stand where
//! its result goes.

use crate::common;

use common::{run, text};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Commands that write a file, `OUT`; the ending is that of its name.
const FILES: [(&str, &str); 15] = [
    (
        "fit run.csv --input x --output y --levels 4 --bootstrap 0 -o OUT",
        "json",
    ),
    ("simulate m.json run.csv --input x -o OUT", "csv"),
    ("simulate m.json run.csv --input x -o OUT", "parquet"),
    ("invert m.json run.csv --target y -o OUT", "csv"),
    ("invert m.json run.csv --target y -o OUT", "parquet"),
    ("invert m.json run.csv --target y -o OUT", "arrow"),
    ("prepare run.csv --input x --output y -o OUT", "arrow"),
    ("prepare run.csv --input x --output y -o OUT", "csv"),
    ("prepare run.csv --input x --output y -o OUT", "parquet"),
    (
        "design --range 20,80 --levels 4 --heating-rate 2 --cooling-rate 1 -o OUT",
        "csv",
    ),
    (
        "design --range 20,80 --levels 4 --heating-rate 2 --cooling-rate 1 -o side.csv \
         --figure OUT",
        "svg",
    ),
    (
        "adapt m.json run.csv --input x --output y --method drift -o OUT",
        "json",
    ),
    (
        "adapt m.json run.csv --input x --output y --method drift -o side.json --table OUT",
        "csv",
    ),
    (
        "adapt m.json run.csv --input x --output y --method drift -o side.json --table OUT",
        "parquet",
    ),
    ("export fmu m.json -o OUT", "fmu"),
];

/// Commands that write a folder, `OUT`.
const FOLDERS: [&str; 4] = [
    "export c m.json -o OUT",
    "evaluate m.json run.csv --input x --output y --report OUT",
    "track short.toml --seeds 1 -o OUT",
    "demo -o OUT",
];

/// A folder with a recording, a model and a scenario that takes a second.
fn bench() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let mut y = 0.0_f64;
    let rows = (0..200).map(|n| {
        let x = 50.0 - 30.0 * (f64::from(n) * 0.05).cos();
        y = y.clamp(x - 5.0, x + 5.0);
        format!("{x},{}\n", 0.2 * y)
    });
    fs::write(
        path.join("run.csv"),
        format!("x,y\n{}", rows.collect::<String>()),
    )
    .unwrap();
    passes(
        path,
        "fit run.csv --input x --output y --levels 4 --bootstrap 0 -o m.json",
    );
    let scenario = text(&run(path, "track load-step --show").stdout)
        .replace("duration_s = 3600", "duration_s = 300")
        .replace("at_s = 1500", "at_s = 150")
        .replace("settle_s = 120", "settle_s = 50")
        .replace("levels = 20", "levels = 5");
    fs::write(path.join("short.toml"), scenario).unwrap();
    folder
}

fn passes(folder: &Path, line: &str) {
    let done = run(folder, line);
    assert!(done.status.success(), "{line}: {}", text(&done.stderr));
}

/// What a path holds: bytes of files, links and folders, by path.
fn held(path: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let Ok(about) = fs::symlink_metadata(path) else {
        return found;
    };
    if about.is_dir() {
        found.insert(path.to_owned(), b"folder".to_vec());
        for entry in fs::read_dir(path).unwrap() {
            found.extend(held(&entry.unwrap().path()));
        }
    } else {
        let bytes = match about.is_symlink() {
            true => fs::read_link(path)
                .unwrap()
                .into_os_string()
                .into_encoded_bytes(),
            false => fs::read(path).unwrap(),
        };
        found.insert(path.to_owned(), bytes);
    }
    found
}

/// Refused for its place, with nothing in the folder changed, and told of `--force` where that
/// helps.
fn keeps_all(folder: &Path, line: &str, force_helps: bool) {
    let before = held(folder);
    let done = run(folder, line);
    let said = text(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{line}: {said}");
    assert_eq!(said.contains("--force"), force_helps, "{line}: {said}");
    assert!(held(folder) == before, "{line}: something changed");
}

#[test]
fn a_file_is_replaced_only_where_it_is_a_result() {
    let bench = bench();
    for (n, (line, ending)) in FILES.iter().enumerate() {
        let folder = bench.path();
        let name = format!("result-{n}.{ending}");
        let line = line.replace("OUT", &name);
        let out = folder.join(&name);
        // Nothing there, then the command's own result, then one of an edit.
        passes(folder, &line);
        let ours = fs::read(&out).unwrap();
        passes(folder, &line);
        assert!(fs::read(&out).unwrap() == ours, "{line}");
        // Of CSV, an edit is seen in the columns that the command added.
        let edits = [
            [&ours, b"x".as_slice()].concat(),
            [b"x".as_slice(), &ours].concat(),
        ];
        let seen = if *ending == "csv" { 1 } else { 2 };
        for edited in &edits[..seen] {
            fs::write(&out, edited).unwrap();
            keeps_all(folder, &line, true);
        }
        // What others wrote, also through a link, and also where it must not be written to.
        let foreign: [&[u8]; 6] = [
            b"",
            b"by hand\n",
            b"x,y\n1,2\n",
            b"{\"format\": \"hysteron-model\", \"version\": 1}\n",
            b"PAR1PAR1",
            b"PK\x03\x04",
        ];
        for bytes in foreign {
            fs::write(&out, bytes).unwrap();
            keeps_all(folder, &line, true);
        }
        for write in [hard_link as fn(&Path, &Path) -> std::io::Result<()>, link] {
            let theirs = folder.join("theirs");
            fs::rename(&out, &theirs).unwrap();
            write(&theirs, &out).unwrap();
            keeps_all(folder, &line, true);
            fs::remove_file(&out).unwrap();
            fs::rename(&theirs, &out).unwrap();
        }
        passes(folder, &format!("{line} --force"));
        assert!(fs::read(&out).unwrap() == ours, "{line}");
        let mut locked = fs::metadata(&out).unwrap().permissions();
        locked.set_readonly(true);
        fs::set_permissions(&out, locked).unwrap();
        keeps_all(folder, &line, true);
        fs::remove_file(&out).unwrap();
        fs::create_dir(&out).unwrap();
        keeps_all(folder, &line, false);
        keeps_all(folder, &format!("{line} --force"), false);
        fs::remove_dir(&out).unwrap();
        keeps_all(
            folder,
            &line.replace(&name, &format!("missing/{name}")),
            false,
        );
    }
}

fn hard_link(theirs: &Path, out: &Path) -> std::io::Result<()> {
    fs::hard_link(theirs, out)
}

#[cfg(unix)]
fn link(theirs: &Path, out: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(theirs, out)
}

#[cfg(not(unix))]
fn link(theirs: &Path, out: &Path) -> std::io::Result<()> {
    hard_link(theirs, out)
}

#[test]
fn a_model_written_by_hand_is_kept() {
    let bench = bench();
    let path = bench.path();
    let fit = "fit run.csv --input x --output y --levels 4 --bootstrap 0 -o m.json";
    let ours = fs::read_to_string(path.join("m.json")).unwrap();
    let by_hand = r#"{"format":"hysteron-model","version":1,"operator":"mkp",
        "plane":{"min":0.0,"max":1.0,"levels":2},"input":{},"output":{},"weights":[1.0,2.0,3.0]}"#;
    for text in [
        by_hand.to_owned(),
        ours.replace(",\"weights\"", ", \"weights\""),
        format!("{ours}\n"),
    ] {
        fs::write(path.join("m.json"), text).unwrap();
        keeps_all(path, fit, true);
    }
}

#[test]
fn a_folder_keeps_what_is_not_ours() {
    let bench = bench();
    let path = bench.path();
    for (n, line) in FOLDERS.iter().enumerate() {
        let name = format!("a/b/result-{n}");
        let line = line.replace("OUT", &name);
        let out = path.join(&name);
        passes(path, &line);
        let ours = held(&out);
        passes(path, &line);
        let files: Vec<&PathBuf> = ours.keys().filter(|file| file.is_file()).collect();
        assert!(held(&out).keys().eq(ours.keys()), "{line}");
        // A few of the files, edited: the first, the last, the page.
        let some = [0, files.len() / 2, files.len() - 1].map(|n| files[n]);
        for file in some {
            fs::write(file, [&ours[file][..], b"x"].concat()).unwrap();
            keeps_all(path, &line, true);
            fs::write(file, &ours[file]).unwrap();
        }
        // Files and folders of others stay, whoever's the rest is; the folder above is another's
        // too.
        fs::create_dir(out.join("empty")).unwrap();
        passes(path, &line);
        let note = some[1].with_file_name("note.txt");
        fs::write(&note, "mine").unwrap();
        passes(path, &line);
        assert_eq!(fs::read_to_string(&note).unwrap(), "mine");
        assert!(out.join("empty").is_dir());
        assert_eq!(held(&out).len(), ours.len() + 2, "{line}");
        fs::write(some[0], "foreign").unwrap();
        keeps_all(path, &line, true);
        passes(path, &format!("{line} --force"));
        assert_eq!(fs::read_to_string(&note).unwrap(), "mine");
        assert_ne!(fs::read(some[0]).unwrap(), b"foreign");
        // Something of another kind in the way.
        fs::remove_file(some[0]).unwrap();
        fs::create_dir(some[0]).unwrap();
        keeps_all(path, &format!("{line} --force"), false);
        fs::remove_dir_all(&out).unwrap();
        fs::write(&out, "a file").unwrap();
        keeps_all(path, &format!("{line} --force"), false);
    }
}

#[test]
fn files_of_an_earlier_run_go_with_it() {
    let bench = bench();
    let path = bench.path();
    let evaluate = "evaluate m.json run.csv --input x --output y --report report";
    passes(path, evaluate);
    let report = path.join("report");
    let figures = held(&report).len();
    // A model with weights below zero has no inverse, and no figures of one.
    passes(
        path,
        "fit run.csv --input x --output y --levels 4 --solver ols --sign negative -o m.json",
    );
    fs::write(report.join("fig13-input-time.svg"), "edited").unwrap();
    passes(path, evaluate);
    assert!(held(&report).len() < figures);
    assert_eq!(
        fs::read(report.join("fig13-input-time.svg")).unwrap(),
        b"edited"
    );
}

#[cfg(unix)]
#[test]
fn no_result_replaces_what_is_read() {
    let bench = bench();
    let path = bench.path();
    fs::hard_link(path.join("run.csv"), path.join("hard.csv")).unwrap();
    link(Path::new("run.csv"), &path.join("soft.csv")).unwrap();
    link(Path::new("."), &path.join("here")).unwrap();
    fs::hard_link(path.join("m.json"), path.join("hard.json")).unwrap();
    fs::copy(path.join("m.json"), path.join("m.fmu")).unwrap();
    let absolute = path.join("run.csv");
    let names = [
        "run.csv",
        "./run.csv",
        "hard.csv",
        "soft.csv",
        "here/run.csv",
        absolute.to_str().unwrap(),
    ];
    let mut lines = Vec::new();
    for (line, ending) in FILES {
        match (ending, line.contains("run.csv")) {
            ("csv", true) => lines.extend(names.map(|name| line.replace("OUT", name))),
            ("json", _) => lines.extend(names.map(|name| line.replace("OUT", name))),
            _ => {}
        }
    }
    lines.extend([
        "adapt m.json run.csv --input x --output y --method drift -o hard.json".into(),
        "design --range 20,80 --levels 4 --heating-rate 2 --cooling-rate 1 --from run.csv \
         --input x -o hard.csv"
            .into(),
        "design --range 20,80 --levels 4 --heating-rate 2 --cooling-rate 1 --from run.csv \
         --input x -o p.csv --figure here/run.csv"
            .into(),
        "export fmu m.fmu -o ./m.fmu".into(),
    ]);
    for line in lines {
        for line in [format!("{line} --force"), line] {
            let before = held(path);
            let done = run(path, &line);
            let said = text(&done.stderr);
            assert_eq!(done.status.code(), Some(1), "{line}: {said}");
            assert!(
                said.contains("would replace a file that is read"),
                "{line}: {said}"
            );
            assert!(held(path) == before, "{line}");
        }
    }
    for table in ["x.json", "./x.json", "here/x.json"] {
        let line = format!(
            "adapt m.json run.csv --input x --output y --method drift -o x.json --table {table}"
        );
        assert!(
            common::refused(path, &line).contains("this one file"),
            "{line}"
        );
    }
}

#[test]
fn an_ending_that_cannot_be_written_is_refused() {
    let bench = bench();
    for (line, _) in FILES.iter().filter(|(_, ending)| *ending == "parquet") {
        for ending in ["mat", "xlsx", "tsv", "MAT"] {
            let line = line.replace("OUT", &format!("out.{ending}"));
            let said = common::refused(bench.path(), &line);
            assert!(
                said.contains(".parquet") && said.contains(".csv"),
                "{line}: {said}"
            );
        }
    }
}
