//! The sources in an FMU: they give the library's digits, and are there where C can. The layers of
//! the standards over them need headers of a tool; `fmu/check.py` compiles them.

use crate::common::programs::{has, run};
use crate::common::{STRICT, here, walks};
use crate::fmu::unpacked;
use hysteron::{Clipped, Delay, Direction, FirstOrder, FittedStart, Model, Target};
use hysteron_export::{Fmi, FmuOptions, fmu_bytes};
use rand::RngExt;
use rand::rngs::StdRng;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// The sources by their names.
fn sources(model: &Model, inverse: bool, fmi: Fmi) -> BTreeMap<String, Vec<u8>> {
    let options = FmuOptions {
        inverse,
        fmi,
        name: None,
    };
    let (_, bytes) = fmu_bytes(model, &options).unwrap();
    let files = unpacked(&bytes).into_iter();
    files
        .filter_map(|(name, bytes)| Some((name.strip_prefix("sources/")?.to_owned(), bytes)))
        .collect()
}

/// The block in C, stepped.
fn stepped(model: &Model, inverse: bool, signals: &[(f64, i32)]) -> Vec<(f64, i32)> {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let files = sources(model, inverse, Fmi::V2);
    for (name, bytes) in &files {
        std::fs::write(at(name), bytes).unwrap();
    }
    // The layer's headers are not here.
    let layer = |name: &&String| name.ends_with(".c") && !name.contains("fmi");
    run(Command::new("cc")
        .args(STRICT)
        .arg("-O2")
        .arg("-I")
        .arg(folder.path())
        .arg(here("tests/mcu/block.c"))
        .args(files.keys().filter(layer).map(|name| at(name)))
        .arg("-o")
        .arg(at("block")));
    let mut child = Command::new(at("block"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let lines: String = signals
        .iter()
        .map(|(x, way)| format!("{x:?} {way}\n"))
        .collect();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(lines.as_bytes())
        .unwrap();
    let done = child.wait_with_output().unwrap();
    assert!(done.status.success());
    let text = String::from_utf8(done.stdout).unwrap();
    let row = |line: &str| {
        let (result, flag) = line.split_once(' ').unwrap();
        (result.parse().unwrap(), flag.parse().unwrap())
    };
    text.lines().map(row).collect()
}

/// The same by the library, from the start input of the block.
fn expected(model: &Model, inverse: bool, signals: &[(f64, i32)]) -> Vec<(f64, i32)> {
    let mut state = model.start();
    let (first, _) = model.active_range();
    if !inverse {
        model.step(&mut state, first).unwrap();
        let step = |(input, _): &(f64, i32)| {
            let output = model.step(&mut state, *input).unwrap();
            let flag = match output.clipped {
                None => 0,
                Some(Clipped::Low) => -1,
                Some(Clipped::High) => 1,
            };
            (output.output, flag)
        };
        return signals.iter().map(step).collect();
    }
    let first = match model.fitted() {
        None => model.output_range().0,
        Some(mut state) => model.step(&mut state, first).unwrap().output,
    };
    let inverse = model.inverse().unwrap();
    inverse.step(&mut state, Target::new(first)).unwrap();
    let step = |(target, heading): &(f64, i32)| {
        let heading = match heading {
            0 => None,
            1 => Some(Direction::Rising),
            _ => Some(Direction::Falling),
        };
        let target = Target {
            heading,
            ..Target::new(*target)
        };
        let solution = inverse.step(&mut state, target).unwrap();
        (solution.input, solution.status.number().into())
    };
    signals.iter().map(step).collect()
}

fn random(rng: &mut StdRng, (low, high): (f64, f64)) -> Vec<(f64, i32)> {
    let (low, high) = (low.min(high), low.max(high));
    let beyond = 0.1 * (high - low);
    let mut signal = || {
        let wild = rng.random_bool(0.5);
        let x = rng.random_range(low - beyond..=high + beyond);
        // Exact ends too.
        (
            if wild {
                x
            } else {
                [low, high, x][rng.random_range(0..3)]
            },
            rng.random_range(-1..=1),
        )
    };
    (0..600).map(|_| signal()).collect()
}

#[test]
fn the_sources_give_the_digits_of_the_library() {
    if !has("cc") {
        return;
    }
    let rng = &mut walks::rng(11);
    let mut inverses = 0;
    for operator in walks::OPERATORS {
        for levels in [2, 3, 17] {
            let mut model = walks::model(rng, operator, levels);
            if levels == 3 {
                let mut state = model.start();
                let (low, high) = model.active_range();
                for part in [0.9, 0.2, 0.6] {
                    model.step(&mut state, low + part * (high - low)).unwrap();
                }
                let start = FittedStart {
                    turning_points: state.turning_points().collect(),
                    input: state.input(),
                };
                model = model.with_start(Some(start)).unwrap();
            }
            let signals = random(rng, model.active_range());
            assert_eq!(
                stepped(&model, false, &signals),
                expected(&model, false, &signals)
            );
            if model.inverse().is_ok() {
                inverses += 1;
                let signals = random(rng, model.output_range());
                assert_eq!(
                    stepped(&model, true, &signals),
                    expected(&model, true, &signals)
                );
            }
        }
    }
    assert!(inverses > 3, "{inverses} models have an inverse");
}

#[test]
fn models_of_operators_alone_have_sources() {
    let rng = &mut walks::rng(3);
    let plain = walks::model(rng, walks::OPERATORS[0], 4);
    let mut heated = plain.clone();
    heated.thermal = Some(FirstOrder {
        tau_heating: 2.0,
        tau_cooling: 4.0,
        ..FirstOrder::default()
    });
    let late = plain.clone().with_delay(Delay::new(2, 0.02).unwrap());
    for fmi in [Fmi::V2, Fmi::V3] {
        assert!(sources(&heated, false, fmi).is_empty());
        assert!(sources(&late, false, fmi).is_empty());
        let files = sources(&plain, false, fmi);
        let text = |name: &str| String::from_utf8(files[name].clone()).unwrap();
        assert!(text("block.h").contains("#define BLOCK_TOKEN \"{"));
        let (described, compiled) = match fmi {
            Fmi::V2 => (
                files.contains_key("buildDescription.xml"),
                "hysteron_fmi2.c",
            ),
            Fmi::V3 => {
                let built = text("buildDescription.xml");
                let mut all = files
                    .keys()
                    .filter(|name| Path::new(name).extension() == Some("c".as_ref()));
                (
                    all.all(|name| built.contains(name.as_str())),
                    "hysteron_fmi3.c",
                )
            }
        };
        assert_eq!(described, fmi == Fmi::V3);
        assert!(files.contains_key(compiled));
    }
}
