//! A dead time through the command: found, kept, used by tables and told by exports.

use crate::common::{json, run, text};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A model with a dead time of two samples of 0.1 s, and the same without one.
fn models(folder: &Path) {
    for (name, version, delay) in [
        ("plain.json", 1, ""),
        (
            "late.json",
            4,
            r#""delay": {"samples": 2, "interval_s": 0.1},"#,
        ),
    ] {
        let model = format!(
            r#"{{"format": "hysteron-model", "version": {version}, "operator": "mkp", {delay}
                "plane": {{"min": 20, "max": 80, "levels": 3}},
                "output": {{"name": "lift", "unit": "mm", "offset": 0.5, "sign": -1}},
                "weights": [1, 0.5, 1, 0.5, 0.5, 1]}}"#
        );
        fs::write(folder.join(name), model).unwrap();
    }
}

/// Rows of several blocks, `dt` apart; the clock goes back at row `back`.
fn table(folder: &Path, dt: f64, count: usize, back: usize) {
    let mut rows = "t,x,y\n".to_owned();
    for n in 0..count {
        let phase = n as f64 * 0.05;
        let t = dt * (n % back) as f64;
        let x = 50.0 - 28.0 * phase.cos() * (0.3 * phase).cos();
        writeln!(rows, "{t},{x},{}", -1.5 - 1.2 * (0.7 * phase).sin()).unwrap();
    }
    fs::write(folder.join("run.csv"), rows).unwrap();
}

/// The cells of a column, as they are written.
fn column(folder: &Path, file: &str, name: &str) -> Vec<String> {
    let text = fs::read_to_string(folder.join(file)).unwrap();
    let mut rows = text.lines().map(|line| line.split(','));
    let at = rows.next().unwrap().position(|cell| cell == name).unwrap();
    rows.map(|mut row| row.nth(at).unwrap().to_owned())
        .collect()
}

fn done(folder: &Path, line: &str) {
    let done = run(folder, line);
    assert!(done.status.success(), "{line}: {}", text(&done.stderr));
}

#[test]
fn tables_are_simulated_and_inverted_behind_a_dead_time_in_each_segment() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    models(folder);
    // More than two blocks. The samples of a delay follow the clock of the table, and are those of
    // the model without one. In the last table the clock goes back twice.
    let count = 17_000;
    for (dt, time, late, back) in [
        (0.1, "--time t", 2, count),
        (0.05, "--time t", 4, count),
        (0.05, "", 2, count),
        (0.1, "--time t --repair", 2, 8_000),
    ] {
        table(folder, dt, count, back);
        for name in ["plain", "late"] {
            let model = format!("{name}.json run.csv --force");
            done(
                folder,
                &format!("simulate {model} --input x {time} -o {name}-out.csv"),
            );
            done(
                folder,
                &format!("invert {model} --target y {time} -o {name}-in.csv"),
            );
        }
        let segments = || {
            (0..count)
                .step_by(back)
                .map(|from| from..count.min(from + back))
        };
        let [plain, shifted] =
            ["plain", "late"].map(|n| column(folder, &format!("{n}-out.csv"), "output_model"));
        for segment in segments() {
            for n in segment.clone() {
                // The first input stood there before, and changes nothing when it comes again.
                let given = n.saturating_sub(late).max(segment.start);
                assert_eq!(shifted[n], plain[given], "{dt} {time}: row {n}");
            }
        }
        let of =
            |name: &str| ["plain", "late"].map(|n| column(folder, &format!("{n}-in.csv"), name));
        let [plain, early] = of("input_model");
        let [plain_status, status] = of("status");
        for segment in segments() {
            for n in segment.clone() {
                let wanted = (n + late).min(segment.end - 1);
                assert_eq!(early[n], plain[wanted], "{dt} {time}: row {n}");
                // No input of the table acts on the first rows.
                let expected = match plain_status[n].as_str() {
                    "ok" if n - segment.start < late => "limited",
                    own => own,
                };
                assert_eq!(status[n], expected, "{dt} {time}: row {n}");
            }
        }
    }
}

#[test]
fn a_table_shorter_than_the_dead_time_is_held() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    models(folder);
    for count in [1, 2, 3] {
        table(folder, 0.1, count, count);
        done(
            folder,
            "simulate late.json run.csv --input x -o out.csv --force",
        );
        let outputs = column(folder, "out.csv", "output_model");
        assert!(outputs.iter().all(|output| *output == outputs[0]));
        done(
            folder,
            "invert late.json run.csv --target y -o in.csv --force",
        );
        let inputs = column(folder, "in.csv", "input_model");
        assert_eq!(inputs.len(), count);
        assert!(inputs.iter().all(|input| *input == inputs[count - 1]));
    }
}

#[test]
fn a_fit_finds_what_a_play_does_late_and_tells_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let input = |n: usize| {
        let phase = n as f64 * 0.1;
        50.0 - 28.0 * phase.cos() * (1.0 - n as f64 / 4000.0)
    };
    let (mut rows, mut y) = ("t,x,output_model\n".to_owned(), 26.0_f64);
    for n in 0..3000_usize {
        let acting = input(n.saturating_sub(2));
        y = y.clamp(acting - 4.0, acting + 4.0);
        writeln!(rows, "{},{},{y}", 0.1 * n as f64, input(n)).unwrap();
    }
    fs::write(folder.join("rec.csv"), rows).unwrap();
    let fit = "fit rec.csv --input x --output output_model --time t --bootstrap 0 --levels 12";
    let said = run(folder, &format!("{fit} -o found.json"));
    assert!(
        text(&said.stdout).contains("dead time of 2 samples, 0.2000 s"),
        "{}",
        text(&said.stdout)
    );
    let read = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(folder.join(name)).unwrap()).unwrap()
    };
    let found = read("found.json");
    assert_eq!(
        (&found["version"], &found["delay"]["samples"]),
        (&4.into(), &2.into())
    );
    // Up to the rounding of a clock that counts in tenths.
    let seconds = json(folder, "inspect found.json")["model"]["delay_s"].clone();
    assert!((seconds.as_f64().unwrap() - 0.2).abs() < 1e-9, "{seconds}");
    done(folder, &format!("{fit} --delay off -o off.json"));
    assert!(read("off.json").get("delay").is_none());
    // Adaptation keeps it.
    done(
        folder,
        "adapt found.json rec.csv --input x --output output_model --time t -o adapted.json",
    );
    assert_eq!(read("adapted.json")["delay"], found["delay"]);
    let refused = run(folder, &format!("{fit} --delay 1001 -o no.json"));
    assert!(!refused.status.success());
}

#[test]
fn exports_carry_the_dead_time() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    models(folder);
    let note = "dead time: 0.2 s or 2 samples";
    for (line, file) in [
        ("export c late.json -o mcu", Some("mcu/late.h")),
        ("export fmu late.json -o late.fmu", None),
    ] {
        let said = text(&run(folder, line).stdout);
        assert!(said.contains(note), "{line}: {said}");
        let header = file.map(|file| fs::read_to_string(folder.join(file)).unwrap());
        let words = |text: String| {
            let words = text.split_whitespace().filter(|word| *word != "*");
            words.collect::<Vec<_>>().join(" ")
        };
        assert!(
            header.is_none_or(|header| words(header).contains(note)),
            "{line}"
        );
        let plain = line.replace("late", "plain").replace("mcu", "plain");
        assert!(
            !text(&run(folder, &plain).stdout).contains("dead time"),
            "{plain}"
        );
    }
    let c = json(folder, "export c late.json -o mcu2");
    assert_eq!(c["delay_samples"], 2);
    let fmu = json(folder, "export fmu late.json -o late2.fmu");
    assert_eq!(fmu["delay_s"], 0.2);
}
