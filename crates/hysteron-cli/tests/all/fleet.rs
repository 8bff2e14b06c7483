//! `hysteron fleet`: every actuator as `fit` alone would have it, whatever happens to the others.

use crate::common::{json, refused, run, text};
use hysteron::{
    Columns, Destination, FleetOptions, FleetRow, HoldOut, Model, Operator, Progress, ReadOptions,
    Recording, Repair, Sign, Solver, Start, fit_fleet, read_fleet,
};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use tempfile::TempDir;

/// Steele, Lea and Flood 2014.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to 1.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }
}

/// Loops of a random actuator: a few play operators of random width, with noise.
fn actuator(random: &mut SplitMix, samples: usize) -> Vec<(f64, f64)> {
    let plays: Vec<(f64, f64)> = (0..4)
        .map(|_| (30.0 * random.unit(), random.unit()))
        .collect();
    let (offset, sign) = (random.unit(), if random.unit() < 0.5 { 1.0 } else { -1.0 });
    let mut held = [0.0_f64; 4];
    let mut x: f64 = 0.0;
    let mut goal: f64 = 100.0;
    (0..samples)
        .map(|_| {
            if (goal - x).abs() < 1.0 {
                goal = 100.0 * random.unit();
            }
            x += (goal - x).signum() * (1.0 + random.unit()).min((goal - x).abs());
            let mut y = offset + 1e-3 * random.unit();
            for (held, (width, weight)) in held.iter_mut().zip(&plays) {
                *held = held.clamp(x - width, x);
                y += sign * weight * *held;
            }
            (x, y)
        })
        .collect()
}

fn csv(rows: &[(f64, f64)]) -> String {
    let mut text = "x,y\n".to_owned();
    for (x, y) in rows {
        writeln!(text, "{x},{y}").unwrap();
    }
    text
}

/// A fleet: as a table `all.csv` with the column `id`, and as a folder `each` with files.
fn fleet(folder: &Path, seed: u64, count: usize) -> Vec<String> {
    let mut random = SplitMix(seed);
    fs::create_dir_all(folder.join("each")).unwrap();
    let mut all = "id,x,y\n".to_owned();
    let mut ids = Vec::new();
    for n in 0..count {
        let id = format!("a{n:03}");
        let samples = 150 + random.below(150);
        let rows = actuator(&mut random, samples);
        for (x, y) in &rows {
            writeln!(all, "{id},{x},{y}").unwrap();
        }
        fs::write(folder.join(format!("each/{id}.csv")), csv(&rows)).unwrap();
        ids.push(id);
    }
    fs::write(folder.join("all.csv"), all).unwrap();
    ids
}

fn rows(path: &Path) -> Vec<FleetRow> {
    let mut rows = Vec::new();
    read_fleet(path, |row| {
        rows.push(row);
        Ok(true)
    })
    .unwrap();
    rows
}

const FAST: &str = "--input x --output y --levels 6 --smooth off --bootstrap 0 --spacing uniform";

fn ran(folder: &Path, line: &str) -> String {
    let done = run(folder, line);
    assert!(done.status.success(), "{line}: {}", text(&done.stderr));
    text(&done.stdout)
}

/// Random actuators, random options: the model of each is that of `fit` alone, to the last bit.
#[test]
fn each_actuator_has_the_model_of_a_fit_alone() {
    for seed in 0..12 {
        let bench = tempfile::tempdir().unwrap();
        let folder = bench.path();
        let mut random = SplitMix(1000 + seed);
        let ids = fleet(folder, seed, 4);
        let pick = |random: &mut SplitMix, of: &[&'static str]| of[random.below(of.len())];
        let mut line = "--input x --output y".to_owned();
        for options in [
            &["--levels 3", "--levels 7", "--levels 12", "--levels auto"][..],
            &["--smooth off", "--smooth 1e-8", "--smooth 1e-7,1e-9", ""],
            &["--bootstrap 0", "--bootstrap 0", "--bootstrap 8"],
            &["--start off", "--start unknown", "--start on", ""],
            &["--solver nnls", "--solver nnls", "--solver ols"],
            &[
                "--operator mkp",
                "--operator mkp",
                "--operator kp",
                "--operator relay",
            ],
            &["--robust off", "--robust auto"],
            &["--spacing uniform", "--spacing auto"],
            &[
                "",
                "--hold-out branches:20%",
                "--range 5,90",
                "--offset 0.5",
                "--low-pass 0.2",
            ],
            &["", "--ridge 1e-3", "--sign positive", "--input-unit V"],
        ] {
            write!(line, " {}", pick(&mut random, options)).unwrap();
        }
        ran(folder, &format!("fleet fit each {line} -o models.parquet"));
        ran(
            folder,
            &format!("fleet fit all.csv --by id {line} -o by.parquet"),
        );
        let (each, by) = (
            rows(&folder.join("models.parquet")),
            rows(&folder.join("by.parquet")),
        );
        assert_eq!(each.len(), ids.len());
        for ((row, other), id) in each.iter().zip(&by).zip(&ids) {
            assert_eq!((&row.id, &other.id), (id, id));
            assert_eq!(row.digest, other.digest);
            ran(
                folder,
                &format!("fit each/{id}.csv {line} -o alone.json --force"),
            );
            let mut alone = Model::read(&folder.join("alone.json")).unwrap();
            if let Some(fit) = &mut alone.fit {
                fit.confidence = None;
            }
            assert_eq!(row.model, alone, "{line}: {id}");
            // A table has no digest of a file.
            let of_table = |mut model: Model| {
                let fit = model.fit.as_mut().unwrap();
                (fit.file, fit.sha256) = (None, None);
                model
            };
            assert_eq!(
                of_table(other.model.clone()),
                of_table(alone),
                "{line}: {id}"
            );
        }
    }
}

#[test]
fn the_table_has_the_same_bits_whatever_the_threads() {
    let bench = tempfile::tempdir().unwrap();
    fleet(bench.path(), 1, 30);
    let with = |threads: &str, name: &str| {
        let line = format!("fleet fit all.csv --by id {FAST} -o {name}");
        let done = Command::new(assert_cmd::cargo::cargo_bin("hysteron"))
            .env("RAYON_NUM_THREADS", threads)
            .current_dir(bench.path())
            .args(line.split_whitespace())
            .output()
            .unwrap();
        assert!(done.status.success(), "{}", text(&done.stderr));
        fs::read(bench.path().join(name)).unwrap()
    };
    let one = with("1", "one.parquet");
    assert!(one == with("2", "two.parquet"));
    assert!(one == with("7", "seven.parquet"));
}

/// Whatever is wrong with one: it is named, the exit code is 1, and the others are as without it.
#[test]
fn what_is_broken_stops_nothing() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    let ids = fleet(folder, 2, 6);
    ran(folder, &format!("fleet fit each {FAST} -o whole.parquet"));
    let whole = rows(&folder.join("whole.parquet"));
    let good = fs::read_to_string(folder.join("each/a002.csv")).unwrap();
    let faults = [
        ("x,y\n1,1\n", "a002"),
        ("x,y\n", "no rows"),
        ("", "empty"),
        ("x,z\n1,2\n", "no column `y`"),
        (
            &good.replacen("\n", "\n1,hot\n", 1),
            "`hot` where a finite number",
        ),
        (&good.replacen("\n", "\n1,\n", 2), "an empty cell"),
        (&good.replacen("\n", "\n1,2,3\n", 1), "3 cells"),
    ];
    for (fault, reason) in faults {
        fs::write(folder.join("each/a002.csv"), fault).unwrap();
        let line = format!("fleet fit each {FAST} -o models.parquet");
        let said = refused(folder, &line);
        assert!(said.contains("a002: "), "{said}");
        assert!(said.contains(reason), "{reason}: {said}");
        assert!(said.contains("1 of 6 have no model"), "{said}");
        let others = rows(&folder.join("models.parquet"));
        let expected: Vec<_> = whole.iter().filter(|row| row.id != "a002").collect();
        assert_eq!(others.iter().collect::<Vec<_>>(), expected);
    }
    // The same in one table: a cell, a row, a whole actuator.
    let all = fs::read_to_string(folder.join("all.csv")).unwrap();
    ran(
        folder,
        &format!("fleet fit all.csv --by id {FAST} -o whole.parquet"),
    );
    let whole = rows(&folder.join("whole.parquet"));
    let faults = [
        ("a003,1,hot", "`hot` where a finite number"),
        ("a003,1,2,3", "more or fewer cells"),
        ("a003,inf,1", "where a finite number"),
        ("a003,1,", "an empty cell"),
    ];
    for (fault, reason) in faults {
        let lines: Vec<&str> = all.lines().collect();
        let at = lines
            .iter()
            .position(|line| line.starts_with("a003"))
            .unwrap()
            + 20;
        let mut lines: Vec<&str> = lines;
        lines.insert(at, fault);
        fs::write(folder.join("bad.csv"), lines.join("\n")).unwrap();
        let line = format!("fleet fit bad.csv --by id {FAST} -o models.parquet");
        let said = refused(folder, &line);
        assert!(said.contains("a003: ") && said.contains(reason), "{said}");
        assert!(said.contains(&format!("line {}", at + 1)), "{said}");
        let models = |rows: &[FleetRow]| -> Vec<Vec<f64>> {
            let others = rows.iter().filter(|row| row.id != "a003");
            others.map(|row| row.model.weights().to_vec()).collect()
        };
        assert_eq!(
            models(&rows(&folder.join("models.parquet"))),
            models(&whole)
        );
        let done = run(folder, &format!("{line} --repair"));
        assert!(done.status.success(), "{}", text(&done.stderr));
        assert_eq!(rows(&folder.join("models.parquet")).len(), ids.len());
    }
    let done = run(
        folder,
        &format!("fleet fit bad.csv --by id {FAST} -o m.parquet --json"),
    );
    assert_eq!(done.status.code(), Some(1));
    let said: Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(
        (&said["fitted"], &said["failed"][0]["id"]),
        (&5.into(), &"a003".into())
    );
}

/// Rows in any order give the same models, if memory allows it; otherwise it is said what to do.
#[test]
fn rows_in_any_order_are_sorted_out() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 3, 5);
    let all = fs::read_to_string(folder.join("all.csv")).unwrap();
    let mut lines: Vec<(&str, usize)> = all.lines().skip(1).zip(0..).collect();
    // One actuator's rows keep their order: the second row of each, the third, and so on.
    let mut of_each = std::collections::HashMap::new();
    for (line, place) in &mut lines {
        let count = of_each.entry(line.split(',').next().unwrap()).or_insert(0);
        *place = *count;
        *count += 1;
    }
    lines.sort_by_key(|(_, place)| *place);
    let shuffled: Vec<&str> = lines.iter().map(|(line, _)| *line).collect();
    let shuffled = format!("id,x,y\n{}\n", shuffled.join("\n"));
    fs::write(folder.join("shuffled.csv"), &shuffled).unwrap();
    ran(
        folder,
        &format!("fleet fit all.csv --by id {FAST} -o a.parquet"),
    );
    let done = run(
        folder,
        &format!("fleet fit shuffled.csv --by id {FAST} -o b.parquet"),
    );
    assert!(done.status.success());
    let said = text(&done.stderr);
    assert!(
        said.contains("not next to each other, so it was read whole"),
        "{said}"
    );
    let models = |name: &str| -> Vec<(String, Vec<f64>, String)> {
        let rows = rows(&folder.join(name)).into_iter();
        rows.map(|row| (row.id, row.model.weights().to_vec(), row.digest))
            .collect()
    };
    assert_eq!(models("a.parquet"), models("b.parquet"));
    let line = format!("fleet fit shuffled.csv --by id {FAST} -o c.parquet --max-memory 20K");
    let said = refused(folder, &line);
    assert!(said.contains("sort its rows by `id`"), "{said}");
    assert!(!folder.join("c.parquet").exists());
}

#[test]
fn an_actuator_in_two_tables_is_an_error() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 4, 3);
    fs::create_dir_all(folder.join("parts")).unwrap();
    let all = fs::read_to_string(folder.join("all.csv")).unwrap();
    let some = |keep: &[&str]| {
        let kept = all
            .lines()
            .filter(|line| keep.iter().any(|id| line.starts_with(id)));
        kept.collect::<Vec<_>>().join("\n")
    };
    fs::write(folder.join("parts/1.csv"), some(&["id", "a000", "a001"])).unwrap();
    fs::write(folder.join("parts/2.csv"), some(&["id", "a001", "a002"])).unwrap();
    let line = format!("fleet fit parts --by id {FAST} -o models.parquet");
    let said = refused(folder, &line);
    assert!(
        said.contains("the actuator `a001` is in other data too"),
        "{said}"
    );
    let ids: Vec<String> = rows(&folder.join("models.parquet"))
        .into_iter()
        .map(|r| r.id)
        .collect();
    assert_eq!(ids, ["a000", "a002"]);
}

fn options<'a>() -> FleetOptions<'a> {
    let fit = hysteron::Fit::new().levels(6).smooth(0.0).bootstrap(0);
    FleetOptions {
        by: Some("id"),
        ..FleetOptions::new(Columns::new("x", "y"), fit)
    }
}

/// Ended after any number of actuators, the next run goes on there, and the table is that of a run
/// that was never ended. With other options, or other samples, it fits anew.
#[test]
fn an_ended_run_goes_on() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 5, 12);
    let data = [folder.join("all.csv")];
    let at = |name: &str| folder.join(name);
    let fit = |name: &str, options: &FleetOptions<'_>, ends_after: usize| {
        let count = AtomicUsize::new(0);
        let told = |_: &'static str, _: f64| match count.fetch_add(1, Ordering::SeqCst) {
            done if done + 1 == ends_after => Err(hysteron::Error::Fit("enough".into())),
            _ => Ok(()),
        };
        let target = at(name);
        let target = Destination::from(target.as_path());
        fit_fleet(&data, options, target, Progress::new(&told))
    };
    let never = fit("whole.parquet", &options(), usize::MAX).unwrap();
    assert_eq!((never.fitted, never.resumed), (12, 0));
    let whole = fs::read(at("whole.parquet")).unwrap();
    for ends_after in [1, 2, 5, 11, 12] {
        let ended = fit("models.parquet", &options(), ends_after);
        assert!(ended.unwrap_err().to_string().contains("enough"));
        assert!(!at("models.parquet").exists());
        assert!(at("models.parquet.partial").exists());
        let done = fit("models.parquet", &options(), usize::MAX).unwrap();
        assert!(
            done.resumed >= ends_after,
            "{} of {ends_after}",
            done.resumed
        );
        assert_eq!(done.fitted, 12);
        assert!(fs::read(at("models.parquet")).unwrap() == whole);
        assert!(!at("models.parquet.partial").exists());
        fs::remove_file(at("models.parquet")).unwrap();
    }
    fit("models.parquet", &options(), 6).unwrap_err();
    let mut other = options();
    other.fit = other.fit.levels(7);
    assert_eq!(
        fit("models.parquet", &other, usize::MAX).unwrap().resumed,
        0
    );
    fit("models.parquet", &options(), 12).unwrap_err();
    let text = fs::read_to_string(&data[0]).unwrap();
    let changed = text.replacen("\na000,", "\na000,0.5,0.5\na000,", 1);
    fs::write(&data[0], changed).unwrap();
    let done = fit("models.parquet", &options(), usize::MAX).unwrap();
    assert_eq!((done.fitted, done.resumed), (12, 11));
}

/// Killed at any moment, by a signal that no program can catch.
#[cfg(unix)]
#[test]
fn a_killed_run_goes_on() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 6, 150);
    let line = format!("fleet fit all.csv --by id {FAST} -o models.parquet");
    ran(folder, &line.replace("models", "whole"));
    let whole = fs::read(folder.join("whole.parquet")).unwrap();
    let partial = folder.join("models.parquet.partial");
    let length = || fs::metadata(&partial).map_or(0, |about| about.len());
    let mut resumed = 0;
    for bytes in [1, 1 << 12, 1 << 15, 1 << 17] {
        let mut child = Command::new(assert_cmd::cargo::cargo_bin("hysteron"))
            .current_dir(folder)
            .args(line.split_whitespace())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        while length() < bytes && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_micros(200));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let done = json(folder, &line);
        resumed += done["resumed"].as_u64().unwrap();
        assert_eq!(done["fitted"], 150);
        assert!(fs::read(folder.join("models.parquet")).unwrap() == whole);
        fs::remove_file(folder.join("models.parquet")).unwrap();
        let left = fs::read_dir(folder).unwrap().count();
        assert_eq!(left, 3, "all.csv, each and whole.parquet");
    }
    // One killed at 128 KiB alone leaves some 50 of them, if it did not end first.
    assert!(resumed > 0);
}

/// The same fleet from CSV, from Parquet with labels of text, and with labels that are numbers.
#[test]
fn the_format_of_the_table_does_not_matter() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 7, 4);
    let text = fs::read_to_string(folder.join("all.csv")).unwrap();
    // `simulate` copies a table as Parquet.
    fs::write(folder.join("numbers.csv"), text.replace("\na", "\n1")).unwrap();
    fs::write(
        folder.join("m.json"),
        r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
            "plane": {"min": 0, "max": 1, "levels": 2}, "weights": [1, 2, 3]}"#,
    )
    .unwrap();
    for name in ["all", "numbers"] {
        ran(
            folder,
            &format!("simulate m.json {name}.csv --input x -o {name}.parquet"),
        );
        for ending in ["csv", "parquet"] {
            let line =
                format!("fleet fit {name}.{ending} --by id {FAST} -o {ending}_{name}.parquet");
            ran(folder, &line);
        }
        let [a, b] = ["csv", "parquet"].map(|e| rows(&folder.join(format!("{e}_{name}.parquet"))));
        assert_eq!(a.len(), 4);
        for (a, b) in a.iter().zip(&b) {
            assert_eq!((&a.id, &a.digest), (&b.id, &b.digest));
            assert_eq!(a.model.weights(), b.model.weights());
        }
    }
}

#[test]
fn a_model_is_taken_out_as_fit_writes_it() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 8, 3);
    ran(folder, &format!("fleet fit each {FAST} -o models.parquet"));
    ran(folder, &format!("fit each/a001.csv {FAST} -o alone.json"));
    ran(folder, "fleet extract models.parquet a001 -o taken.json");
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    assert_eq!(read("taken.json"), read("alone.json"));
    let said = refused(folder, "fleet extract models.parquet a009 -o other.json");
    assert!(said.contains("there is no actuator `a009`"), "{said}");
    assert!(!folder.join("other.json").exists());
    let said = refused(folder, "fleet extract each/a001.csv a001 -o other.json");
    assert!(said.contains("a001.csv"), "{said}");
}

/// Parts fitted one by one, by several processes, come to the same bits as all at once.
#[test]
fn parts_are_joined_to_the_table_of_the_whole() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 12, 12);
    fs::create_dir(folder.join("parts")).unwrap();
    let all = fs::read_to_string(folder.join("all.csv")).unwrap();
    for n in 0..3 {
        let mine = |line: &&str| {
            let number = line[1..4].parse::<usize>();
            number.map_or(true, |number| number / 4 == n)
        };
        let part: Vec<&str> = all.lines().filter(mine).collect();
        fs::write(folder.join(format!("parts/{n}.csv")), part.join("\n")).unwrap();
    }
    ran(
        folder,
        &format!("fleet fit parts --by id {FAST} -o whole.parquet"),
    );
    // Whoever comes last, and whoever comes twice.
    for n in [2, 0, 1, 0] {
        let line = format!("fleet fit parts/{n}.csv --by id {FAST} -o {n}.parquet");
        ran(folder, &line);
    }
    ran(
        folder,
        "fleet join 0.parquet 1.parquet 2.parquet -o models.parquet",
    );
    let read = |name: &str| fs::read(folder.join(name)).unwrap();
    assert!(read("models.parquet") == read("whole.parquet"));
    let said = refused(
        folder,
        "fleet join 0.parquet 1.parquet 0.parquet -o m.parquet",
    );
    assert!(
        said.contains("the actuator `a000` is in 0.parquet too"),
        "{said}"
    );
    assert!(!folder.join("m.parquet").exists());
}

/// Of a fleet of like actuators, none is strange; one with a wider loop is.
#[test]
fn the_strange_one_is_found() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    let mut random = SplitMix(9);
    let mut all = "id,x,y\n".to_owned();
    let loops = |width: f64, gain: f64, random: &mut SplitMix| {
        let (mut held, mut rows) = (0.0_f64, Vec::new());
        for n in 0..400 {
            let swing = 100.0 - 25.0 * f64::from(n / 100);
            let x = 0.5 * swing * (1.0 - (f64::from(n) * std::f64::consts::TAU / 100.0).cos());
            held = held.clamp(x - width, x);
            rows.push((x, gain * (held + 0.2 * x) + 0.05 * random.unit()));
        }
        rows
    };
    for n in 0..60 {
        let (width, gain) = (20.0 + random.unit(), 0.1 + 0.005 * random.unit());
        for (x, y) in loops(width, gain, &mut random) {
            writeln!(all, "{n},{x},{y}").unwrap();
        }
    }
    fs::write(folder.join("all.csv"), all).unwrap();
    let fit = "--input x --output y --levels 12 --bootstrap 0 --smooth off --spacing uniform";
    ran(
        folder,
        &format!("fleet fit all.csv --by id {fit} -o models.parquet"),
    );
    for (name, width, gain) in [("wide", 26.0, 0.1025), ("usual", 20.5, 0.1025)] {
        let rows = loops(width, gain, &mut random);
        fs::write(folder.join(format!("{name}.csv")), csv(&rows)).unwrap();
        ran(folder, &format!("fit {name}.csv {fit} -o {name}.json"));
    }
    let found = json(folder, "fleet check models.parquet wide.json usual.json");
    let alike = |n: usize| found["actuators"][n]["alike"].as_bool().unwrap();
    assert_eq!([alike(0), alike(1)], [false, true], "{found}");
    let itself = json(folder, "fleet check models.parquet models.parquet");
    let strange = itself["actuators"].as_array().unwrap().iter();
    let strange = strange.filter(|one| one["alike"] == false).count();
    assert!(strange <= 3, "{strange} of 60");
    let said = ran(folder, "fleet check models.parquet wide.json");
    assert!(said.contains("unlike the others"), "{said}");
}

#[test]
fn wrong_uses_are_refused_before_any_work() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 10, 2);
    let cases = [
        (
            format!("fleet fit each {FAST} -o models.csv"),
            "let its name end with .parquet",
        ),
        (format!("fleet fit nothing {FAST} -o m.parquet"), "nothing"),
        (
            format!("fleet fit . --hold-out a.csv {FAST} -o m.parquet"),
            "one part of each",
        ),
        (
            format!("fleet fit each --by id {FAST} -o m.parquet"),
            "no column `id`",
        ),
    ];
    for (line, reason) in cases {
        let said = refused(folder, &line);
        assert!(said.contains(reason), "{line}: {said}");
    }
    fs::create_dir(folder.join("empty")).unwrap();
    let said = refused(folder, &format!("fleet fit empty {FAST} -o m.parquet"));
    assert!(said.contains("there is no table in this folder"), "{said}");
    fs::write(folder.join("mine.parquet"), "mine").unwrap();
    let said = refused(folder, &format!("fleet fit each {FAST} -o mine.parquet"));
    assert!(said.contains("not a result of hysteron"), "{said}");
    assert_eq!(fs::read(folder.join("mine.parquet")).unwrap(), b"mine");
    // The result may be in the folder that is read: it is no recording.
    for _ in 0..2 {
        ran(
            folder,
            &format!("fleet fit each {FAST} -o each/models.parquet"),
        );
    }
    assert_eq!(rows(&folder.join("each/models.parquet")).len(), 2);
}

#[test]
fn units_and_held_out_parts_are_those_asked_for() {
    let bench: TempDir = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 11, 2);
    let data: [PathBuf; 1] = [folder.join("each")];
    let fit = hysteron::Fit::new().levels(6).smooth(0.0).bootstrap(0);
    let fit = fit
        .solver(Solver::Nnls)
        .operator(Operator::Kp)
        .start(Start::Off);
    let options = FleetOptions {
        hold_out: Some(HoldOut::Branches(0.2)),
        input_unit: Some("V".into()),
        read: ReadOptions::from(Repair::Mend),
        ..FleetOptions::new(Columns::new("x", "y"), fit)
    };
    let target = folder.join("m.parquet");
    let target = Destination::from(target.as_path());
    fit_fleet(&data, &options, target, Progress::NONE).unwrap();
    for row in rows(&folder.join("m.parquet")) {
        assert_eq!(row.model.input.unit.as_deref(), Some("V"));
        assert_eq!(row.model.operator(), Operator::Kp);
        assert!(
            row.model
                .fit
                .as_ref()
                .unwrap()
                .other
                .contains_key("hold_out")
        );
        let recording = Recording::read(
            &folder.join(format!("each/{}.csv", row.id)),
            Columns::new("x", "y"),
            Repair::Refuse,
        );
        let (recording, _) = recording.unwrap();
        let (low, high) = recording.ranges().1;
        assert!(row.shape.stroke.abs() > 0.5 * (high - low));
        let falls = row.model.sign() == Sign::Negative;
        assert_eq!(row.shape.stroke < 0.0, falls);
    }
}

/// A fleet of plays that differ in stroke and offset: a short recording and the prior give the
/// model that a whole recording gives.
#[test]
fn a_prior_says_what_a_short_recording_does_not() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    let mut random = SplitMix(7);
    let mut record = |samples: usize| {
        let (stroke, offset) = (1.0 + random.unit(), random.unit());
        let mut held = 0.0_f64;
        let rows = (0..samples).map(|n| {
            let x = 50.0 - 50.0 * (n as f64 * 0.05).cos() * (1.0 - n as f64 / 1000.0);
            held = held.clamp(x - 20.0, x);
            (x, offset + stroke * held + 0.01 * random.unit())
        });
        rows.collect::<Vec<_>>()
    };
    fs::create_dir(folder.join("each")).unwrap();
    for n in 0..30 {
        fs::write(folder.join(format!("each/{n}.csv")), csv(&record(400))).unwrap();
    }
    let whole = record(400);
    fs::write(folder.join("whole.csv"), csv(&whole)).unwrap();
    fs::write(folder.join("short.csv"), csv(&whole[..40])).unwrap();
    let range = "--range 0,100 --start off";
    ran(
        folder,
        &format!("fleet fit each {FAST} {range} -o models.parquet"),
    );
    let columns = "--input x --output y --start off";
    let said = ran(
        folder,
        &format!("fit short.csv --prior models.parquet {columns} -o short.json"),
    );
    // Strange ones do not count.
    assert!(said.contains(" other actuators"), "{said}");
    ran(
        folder,
        &format!("fit short.csv {FAST} {range} -o alone.json"),
    );
    ran(
        folder,
        &format!("fit whole.csv {FAST} {range} -o whole.json"),
    );
    let error = |model: &str| {
        let line = format!("evaluate {model} whole.csv {columns}");
        json(folder, &line)["forward"]["rmse"].as_f64().unwrap()
    };
    let (short, alone, whole) = (
        error("short.json"),
        error("alone.json"),
        error("whole.json"),
    );
    // Between the model that the whole recording gives, and a third of what the short one lacks.
    assert!(
        short < whole + 0.3 * (alone - whole),
        "{short}, {alone} alone, {whole} of all"
    );
    // A fleet's fit takes the same prior, and each model is that of a fit alone.
    fs::create_dir(folder.join("new")).unwrap();
    fs::copy(folder.join("short.csv"), folder.join("new/short.csv")).unwrap();
    let fleet = "fleet fit new --prior models.parquet";
    ran(folder, &format!("{fleet} {columns} -o new.parquet"));
    let one = Model::from_json(&fs::read_to_string(folder.join("short.json")).unwrap()).unwrap();
    assert_eq!(
        rows(&folder.join("new.parquet"))[0].model.weights(),
        one.weights()
    );
    for (line, reason) in [
        ("--prior nothing.parquet", "nothing.parquet"),
        ("--prior whole.csv", "whole.csv"),
        ("--prior new.parquet", "1 models"),
    ] {
        let line = format!("fit short.csv {columns} {line} -o other.json");
        let said = refused(folder, &line);
        assert!(said.contains(reason), "{line}: {said}");
    }
    let line = format!("fit short.csv {columns} --levels 5 --prior models.parquet -o other.json");
    assert_eq!(run(folder, &line).status.code(), Some(2), "{line}");
}
