//! A fleet that shares its choices: nobody is harmed, and who chose is said.

use crate::common::{run, text};
use hysteron::{
    Columns, Destination, Fit, FleetChoice, FleetFitted, FleetOptions, Progress, fit_fleet,
    read_fleet,
};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

/// From 0 to 1: Steele, Lea and Flood 2014.
fn unit(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// A kind of actuators: how broad its loops are, and its noise.
#[derive(Clone, Copy)]
struct Kind {
    width: f64,
    noise: f64,
    /// The power of its curve.
    bent: f64,
}

const BROAD: Kind = Kind {
    width: 30.0,
    noise: 0.02,
    bent: 1.0,
};
const SLIM: Kind = Kind {
    width: 3.0,
    noise: 0.0,
    bent: 3.0,
};

/// Loops of an actuator that is like others of its kind.
fn actuator(kind: Kind, random: &mut u64, samples: usize) -> Vec<(f64, f64)> {
    let plays: Vec<(f64, f64)> = (1..=5)
        .map(|n| {
            let width = kind.width * (0.2 * f64::from(n) + 0.02 * unit(random));
            (width, 1.0 + 0.1 * unit(random))
        })
        .collect();
    let mut held = [0.0_f64; 5];
    (0..samples)
        .map(|n| {
            let swing = 8.0 * n as f64 / samples as f64;
            let size = 1.0 - 0.1 * swing.floor();
            let x = 100.0 * size * (1.0 - (2.0 * (swing - swing.floor()) - 1.0).abs());
            let mut y = 0.0;
            for (held, (width, weight)) in held.iter_mut().zip(&plays) {
                *held = held.clamp(x - width, x);
                y += weight * 0.2 * (*held / 100.0).max(0.0).powf(kind.bent);
            }
            (x, y + kind.noise * (unit(random) - 0.5))
        })
        .collect()
}

/// A table `fleet.csv` of actuators of these kinds.
fn fleet(folder: &Path, seed: u64, kinds: &[Kind]) {
    let mut random = seed;
    let mut all = "id,x,y\n".to_owned();
    for (n, kind) in kinds.iter().enumerate() {
        for (x, y) in actuator(*kind, &mut random, 160) {
            writeln!(all, "a{n:03},{x},{y}").unwrap();
        }
    }
    fs::write(folder.join("fleet.csv"), all).unwrap();
}

/// Levels are given: in this profile a fit that chooses them takes seconds.
const LINE: &str = "fleet fit fleet.csv --by id --input x --output y --levels 8 --bootstrap 0";

/// Errors on what was left out, in percent, by actuator.
fn errors(table: &Path) -> BTreeMap<String, f64> {
    let mut errors = BTreeMap::new();
    read_fleet(table, |row| {
        let tested = row.model.fit.and_then(|fit| fit.validation).unwrap();
        errors.insert(row.id, tested.nrmse_percent);
        Ok(true)
    })
    .unwrap();
    errors
}

fn fitted(folder: &Path, choice: FleetChoice) -> (FleetFitted, BTreeMap<String, f64>) {
    let options = FleetOptions {
        by: Some("id"),
        choice,
        ..FleetOptions::new(Columns::new("x", "y"), Fit::new().levels(8).bootstrap(0))
    };
    let target = folder.join("models.parquet");
    let to = Destination::from(target.as_path());
    let data = [folder.join("fleet.csv")];
    let found = fit_fleet(&data, &options, to, Progress::NONE).unwrap();
    let errors = errors(&target);
    fs::remove_file(target).unwrap();
    (found, errors)
}

/// Two kinds in any mixture: no actuator's error on what is left out is above 1.3 times that of its
/// own choice. Errors below 0.01 % of the range are equal.
#[test]
fn no_kind_is_harmed_by_another() {
    let mut shared = 0;
    for seed in 0..4 {
        let bench = tempfile::tempdir().unwrap();
        let mut random = 100 + seed;
        let share = unit(&mut random);
        let pick = |random: &mut u64| if unit(random) < share { BROAD } else { SLIM };
        let kinds: Vec<Kind> = (0..32).map(|_| pick(&mut random)).collect();
        fleet(bench.path(), seed, &kinds);
        let (found, with_pilots) = fitted(bench.path(), FleetChoice::Pilots);
        let (_, own) = fitted(bench.path(), FleetChoice::Each);
        shared += usize::from(found.shared.is_some());
        assert_eq!(with_pilots.len(), 32);
        for (id, error) in with_pilots {
            let own = own[&id];
            assert!(
                error <= 1.3 * own.max(0.01),
                "seed {seed}, {id}: {error} % instead of {own} %: {found:#?}"
            );
        }
    }
    assert_eq!(shared, 4);
}

/// One that is unlike all others is fitted by itself, has the model of its fit alone, and is named.
#[test]
fn who_is_not_served_is_named() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    let mut kinds = [BROAD; 30];
    // By its name it is no pilot.
    kinds[17] = Kind {
        width: 2.0,
        noise: 0.0,
        bent: 12.0,
    };
    fleet(folder, 5, &kinds);
    let done = run(folder, &format!("{LINE} -o models.parquet"));
    let said = text(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert!(said.contains("pilots chose for all: levels 8, "), "{said}");
    assert!(said.contains("a017: chosen by itself"), "{said}");
    let printed = text(&done.stdout);
    assert!(printed.contains("with choices of their own"), "{printed}");
    let done = run(folder, &format!("{LINE} --choice each -o each.parquet"));
    assert!(done.status.success());
    assert!(!text(&done.stderr).contains("pilots"));
    let weights = |name: &str| {
        let mut found = Vec::new();
        let mut said = Value::Null;
        read_fleet(&folder.join(name), |row| {
            if row.id == "a017" {
                found = row.model.weights().to_vec();
                let record = row
                    .model
                    .fit
                    .and_then(|fit| fit.other.get("fleet_choice").cloned());
                said = record.unwrap_or_default();
            }
            Ok(true)
        })
        .unwrap();
        (found, said)
    };
    let (own, said) = weights("models.parquet");
    assert_eq!(said["of"], "own");
    assert_eq!(own, weights("each.parquet").0);
    let done = run(folder, &format!("{LINE} -o json.parquet --json"));
    let said: Value = serde_json::from_slice(&done.stdout).unwrap();
    assert!(said["choice"]["pilots"].as_u64().unwrap() >= 8);
    assert_eq!(said["choice"]["kinds"][0]["levels"], 8);
    let named = said["alone"].as_array().unwrap();
    assert!(named.iter().any(|alone| alone["id"] == "a017"), "{said}");
}

#[test]
fn a_small_fleet_and_one_with_nothing_left_to_the_data_have_no_pilots() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 6, &[BROAD; 23]);
    let plain = "--smooth 1e-7 --spacing uniform --start off --delay off --dynamics off";
    let done = run(folder, &format!("{LINE} -o models.parquet"));
    assert!(done.status.success());
    assert!(!text(&done.stderr).contains("pilots"));
    fleet(folder, 6, &[BROAD; 24]);
    let done = run(folder, &format!("{LINE} {plain} -o plain.parquet"));
    assert!(done.status.success());
    assert!(!text(&done.stderr).contains("pilots"));
    let done = run(folder, &format!("{LINE} --choice some -o other.parquet"));
    assert_eq!(done.status.code(), Some(2));
    assert!(text(&done.stderr).contains("'some'"));
}

/// Pilots from files are those of the same actuators in any number of threads, and a run that was
/// ended goes on with their choice.
#[test]
fn the_choice_does_not_depend_on_threads_or_on_an_end() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 7, &[BROAD; 26]);
    let with = |threads: &str| {
        let line = format!("{LINE} --smooth 1e-7 -o models.parquet --force");
        let done = Command::new(assert_cmd::cargo::cargo_bin("hysteron"))
            .env("RAYON_NUM_THREADS", threads)
            .current_dir(folder)
            .args(line.split_whitespace())
            .output()
            .unwrap();
        assert!(done.status.success(), "{}", text(&done.stderr));
        fs::read(folder.join("models.parquet")).unwrap()
    };
    let whole = with("1");
    assert!(whole == with("3"));
    let target = folder.join("ended.parquet");
    let told = |stage: &'static str, done: f64| match stage == "fits" && done > 0.5 {
        true => Err(hysteron::Error::Fit("enough".into())),
        false => Ok(()),
    };
    let fit = Fit::new().levels(8).smooth(1e-7).bootstrap(0);
    let options = FleetOptions {
        by: Some("id"),
        ..FleetOptions::new(Columns::new("x", "y"), fit)
    };
    let data = [folder.join("fleet.csv")];
    let ended = fit_fleet(
        &data,
        &options,
        target.as_path().into(),
        Progress::new(&told),
    );
    assert!(ended.unwrap_err().to_string().contains("enough"));
    let done = fit_fleet(&data, &options, target.as_path().into(), Progress::NONE).unwrap();
    assert!(done.resumed > 0 && done.fitted == 26, "{done:?}");
    assert!(done.shared.is_some());
    assert!(read(&target) == read(&folder.join("models.parquet")));
}

fn read(table: &Path) -> Vec<hysteron::FleetRow> {
    let mut rows = Vec::new();
    read_fleet(table, |mut row| {
        row.file = String::new();
        rows.push(row);
        Ok(true)
    })
    .unwrap();
    rows
}

#[test]
fn rows_of_another_unit_are_found_in_a_fleet_with_pilots() {
    let bench = tempfile::tempdir().unwrap();
    let folder = bench.path();
    fleet(folder, 8, &[BROAD; 28]);
    let table = folder.join("fleet.csv");
    let mut all: Vec<String> = fs::read_to_string(&table)
        .unwrap()
        .lines()
        .map(Into::into)
        .collect();
    // By its name it is no pilot.
    for line in all
        .iter_mut()
        .filter(|line| line.starts_with("a017,"))
        .skip(60)
        .take(40)
    {
        let (others, y) = line.rsplit_once(',').unwrap();
        *line = format!("{others},{}", 10.0 * y.parse::<f64>().unwrap());
    }
    fs::write(&table, all.join("\n")).unwrap();
    let options = FleetOptions {
        by: Some("id"),
        ..FleetOptions::new(Columns::new("x", "y"), Fit::new().levels(8).bootstrap(0))
    };
    let target = folder.join("models.parquet");
    let to = target.as_path().into();
    let found = fit_fleet(&[table], &options, to, Progress::NONE).unwrap();
    assert!(found.shared.is_some());
    let doubted = |row: &&hysteron::FleetRow| row.warnings.iter().any(|w| w.contains("disagree"));
    let rows = read(&target);
    let ids: Vec<&str> = rows
        .iter()
        .filter(doubted)
        .map(|row| row.id.as_str())
        .collect();
    assert_eq!(ids, ["a017"]);
}
