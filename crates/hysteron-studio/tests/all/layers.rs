//! What is drawn besides lines, samples that are pointed at, and the archive of C.
#![cfg(feature = "server")]

use crate::asked::ask;
use hysteron_studio::{Id, Session};
use serde_json::{Value, json};
use std::io::Read;
use std::process::{Command, Stdio};

/// A play of 4 degC with loops that shrink; the output was read wrongly at rows 201 and 401.
fn table() -> String {
    let mut text = "time [s],temperature [degC],displacement [mm]\n".to_owned();
    let (mut y, mut seed) = (20.0_f64, 1_u64);
    for n in 0..600 {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let random = (seed >> 40) as f64 / f64::from(1 << 24) - 0.5;
        let t = 50.0 - 30.0 * (f64::from(n) * 0.05).cos() * (1.0 - f64::from(n) / 900.0);
        y = y.clamp(t - 2.0, t + 2.0);
        let read = match n {
            200 => 90.0,
            400 => -80.0,
            _ => 0.2 * y + 0.02 * random,
        };
        text += &format!("{},{t},{read}\n", f64::from(n) * 0.1);
    }
    text
}

fn fitted(options: Value) -> (Session, Id, Id) {
    let mut session = Session::new(1 << 28);
    let file = session.open("run.csv", table().into()).unwrap();
    let fit = ask(&mut session, json!({"request": "fit", "options": options})).unwrap();
    let fit = fit.as_u64().unwrap();
    (session, file, fit)
}

#[test]
fn band_outliers_and_what_was_held_out_are_drawn() {
    let (mut session, file, fit) = fitted(json!({"levels": "12", "bootstrap": "20"}));
    let view = |picture: &str| {
        json!({"request": "curves", "file": file, "fits": [fit], "picture": picture, "of": fit,
            "band": true, "pixels": [600, 400]})
    };
    let seen = ask(&mut session, view("output")).unwrap();
    let [low, high] = [0, 1].map(|end| -> Vec<f64> {
        let values = seen["band"][end][1].as_array().unwrap();
        values.iter().filter_map(Value::as_f64).collect()
    });
    // Points of one column of pixels are the lowest and the highest: ends of the band are ordered
    // where the output is as well.
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    assert!(mean(&low) < mean(&high));
    let times: Vec<f64> = seen["outliers"]
        .as_array()
        .unwrap()
        .iter()
        .map(|point| point[0].as_f64().unwrap())
        .collect();
    // Row 201 may be in a branch that was held out.
    assert!(times.contains(&40.0), "{times:?}");
    assert!(times.iter().all(|time| [20.0, 40.0].contains(time)));
    // As many samples as were tested are inside the spans that were held out.
    let overview = ask(&mut session, json!({"request": "overview"})).unwrap();
    let tested = overview["fits"][0]["held_out"]["model"]["samples"].as_u64();
    let held: f64 = seen["held"]
        .as_array()
        .unwrap()
        .iter()
        .map(|span| 10.0 * (span[1].as_f64().unwrap() - span[0].as_f64().unwrap()) + 1.0)
        .sum();
    assert_eq!(tested, Some(held.round() as u64));
    assert_eq!(overview["fits"][0]["outliers"], times.len());
    assert!(overview["fits"][0]["inverse_errors"]["rmse"].as_f64() > Some(0.0));
    // Two samples that were read wrongly do not set the scale of the histogram.
    let bars = ask(&mut session, view("histogram")).unwrap();
    let middles = bars["lines"][0]["x"].as_array().unwrap();
    assert!(middles.iter().all(|x| x.as_f64().unwrap().abs() < 1.0));
    // Nor that of the drive: the stroke is 12 mm.
    let drive = ask(&mut session, json!({"request": "drive", "fit": fit})).unwrap();
    let ends: [f64; 2] = serde_json::from_value(drive["outputs"].clone()).unwrap();
    assert!((10.0..14.0).contains(&(ends[1] - ends[0])), "{ends:?}");
}

#[test]
fn a_click_finds_its_sample_and_the_worst_one_is_found() {
    let (mut session, file, fit) = fitted(json!({"levels": "12", "bootstrap": "0"}));
    // As in the verdict, a reading that the fit took for an outlier is not the worst one.
    let worst = ask(&mut session, json!({"request": "worst", "fit": fit})).unwrap();
    let row = worst["sample"]["number"].as_u64().unwrap();
    assert_eq!(worst["file"], file);
    let overview = ask(&mut session, json!({"request": "overview"})).unwrap();
    let verdict = overview["fits"][0]["verdict"].as_array().unwrap().iter();
    let told = verdict
        .filter(|line| line[0] == "worst")
        .map(|line| line[1].as_str().unwrap());
    let told: Vec<&str> = told.collect();
    assert!(
        told.len() == 1 && told[0].starts_with(&format!("sample {row} ")),
        "{row}: {told:?}"
    );
    let outlier = json!({"request": "sample", "file": file, "fits": [fit], "at": 40.0});
    let near = |picture: &str, at: [f64; 2]| {
        json!({"request": "nearest", "at": at, "view": {"file": file, "fits": [fit],
            "picture": picture, "pixels": [600, 400]}})
    };
    let outlier = ask(&mut session, outlier).unwrap();
    let (input, output) = (
        outlier["input"].as_f64().unwrap(),
        outlier["output"].as_f64().unwrap(),
    );
    let residual = outlier["modelled"][0][1].as_f64().unwrap() - output;
    for (picture, at) in [
        ("loop", [input, output + 1.0]),
        ("residuals_over_input", [input, residual]),
        ("histogram", [residual, 3.0]),
        ("output", [40.04, output]),
    ] {
        let found = ask(&mut session, near(picture, at)).unwrap();
        assert_eq!(found["number"], 401, "{picture}");
    }
}

#[test]
fn spans_of_a_second_file_are_its_own_rows() {
    let mut session = Session::new(1 << 28);
    let first = session.open("a.csv", table().into()).unwrap();
    let second = session.open("b.csv", table().into()).unwrap();
    let mark = json!({"request": "mark", "file": second, "rows": [101, 200]});
    ask(&mut session, mark).unwrap();
    let options = json!({"levels": "8", "bootstrap": "0"});
    let fit = ask(&mut session, json!({"request": "fit", "options": options})).unwrap();
    let mut held = |file: Id| {
        let view = json!({"request": "curves", "file": file, "fits": [fit], "picture": "output",
            "of": fit, "pixels": [600, 400]});
        ask(&mut session, view).unwrap()["held"].clone()
    };
    assert_eq!(held(first), json!([]));
    let spans: Vec<[f64; 2]> = serde_json::from_value(held(second)).unwrap();
    assert!(
        (spans[0][0] - 10.0).abs() < 1e-9 && (spans[0][1] - 19.9).abs() < 1e-9,
        "{spans:?}"
    );
}

/// The archive builds with `make`, and its program gives the outputs of the model.
#[test]
fn the_archive_of_c_builds_and_runs() {
    let has = |program: &str| Command::new(program).arg("--version").output().is_ok();
    if !has("make") || !has("gcc") {
        crate::recordings::skip::skipped("there is no gcc, or no make");
        return;
    }
    for options in [
        json!({"levels": "12", "bootstrap": "0"}),
        // With a stage, and one that starts where its fit found it.
        json!({"levels": "12", "bootstrap": "0", "curve": "4"}),
        json!({"levels": "12", "bootstrap": "0", "start": "on"}),
        json!({"levels": "12", "bootstrap": "0", "solver": "ols"}),
    ] {
        let (mut session, file, fit) = fitted(options.clone());
        let taken = json!({"request": "take", "what": "c", "fit": fit});
        let taken = ask(&mut session, taken).unwrap();
        let bytes: Vec<u8> = serde_json::from_value(taken["bytes"].clone()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
        for n in 0..archive.len() {
            let mut entry = archive.by_index(n).unwrap();
            let name = entry.name().unwrap().into_owned();
            let path = folder.path().join(name.split_once('/').unwrap().1);
            let mut text = String::new();
            entry.read_to_string(&mut text).unwrap();
            std::fs::write(path, text).unwrap();
        }
        let flags = "CFLAGS=-O1 -Wall -Wextra -Werror -pedantic";
        let made = Command::new("make")
            .current_dir(folder.path())
            .args(["CC=gcc", flags])
            .output()
            .unwrap();
        assert!(
            made.status.success(),
            "{options}: {}",
            String::from_utf8_lossy(&made.stderr)
        );
        let mut demo = Command::new(folder.path().join("demo"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let inputs: String = table()
            .lines()
            .skip(1)
            .map(|row| format!("{}\n", row.split(',').nth(1).unwrap()))
            .collect();
        let mut stdin = demo.stdin.take().unwrap();
        let writer =
            std::thread::spawn(move || std::io::Write::write_all(&mut stdin, inputs.as_bytes()));
        let said = demo.wait_with_output().unwrap();
        writer.join().unwrap().unwrap();
        let said = String::from_utf8(said.stdout).unwrap();
        let modelled = json!({"request": "take", "what": "table", "file": file, "fits": [fit],
            "picture": "output", "pixels": [1, 1]});
        let modelled = ask(&mut session, modelled).unwrap();
        let modelled: Vec<u8> = serde_json::from_value(modelled["bytes"].clone()).unwrap();
        let modelled = String::from_utf8(modelled).unwrap();
        assert_eq!(said.lines().count(), 600);
        for (line, row) in said.lines().zip(modelled.lines().skip(1)) {
            let found: f64 = line.split(' ').nth(1).unwrap().parse().unwrap();
            let output: f64 = row.split(',').nth(3).unwrap().parse().unwrap();
            // Single precision, six digits printed of at most 20.
            assert!((found - output).abs() < 1e-3, "{options}: {found} {output}");
        }
    }
}

/// A fit that looks for what comes late is tested on the end, where that is like the rest: there it
/// is drawn, with as many samples as were tested.
#[test]
fn an_end_that_was_held_out_is_drawn_at_the_end() {
    let mut text = "time [s],T [degC],lift [mm]\n".to_owned();
    let mut y = 20.0_f64;
    for n in 0..900 {
        let input = 50.0 - 30.0 * (f64::from(n) * 0.05).cos();
        y = y.clamp(input - 4.0, input + 4.0);
        text += &format!("{},{input},{}\n", f64::from(n) * 0.1, 0.2 * y);
    }
    let mut session = Session::new(1 << 28);
    let file = session.open("a.csv", text.into()).unwrap();
    let options = json!({"levels": "8", "bootstrap": "0"});
    let fit = json!({"request": "fit", "options": options});
    let fit = ask(&mut session, fit).unwrap();
    let view = json!({"request": "curves", "file": file, "fits": [fit], "picture": "output",
        "of": fit, "pixels": [600, 400]});
    let seen = ask(&mut session, view).unwrap();
    let overview = ask(&mut session, json!({"request": "overview"})).unwrap();
    let fitted = &overview["fits"][0];
    let tested = fitted["held_out"]["model"]["samples"].as_f64().unwrap();
    assert_eq!(fitted["hold_out"], "branches:20%");
    let held: Vec<[f64; 2]> = serde_json::from_value(seen["held"].clone()).unwrap();
    let [[from, to]] = held[..] else {
        panic!("{held:?}")
    };
    assert!((to - 89.9).abs() < 1e-9, "{to}");
    assert_eq!(((to - from) * 10.0).round() + 1.0, tested);
}
