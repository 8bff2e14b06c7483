//! Tables that are read and written in blocks come out as by the definition: each row parsed,
//! stepped and written by itself.

use hysteron::{
    Around, Invert, Model, Operator, Plane, Policy, Sign, Simulate, TableReader, TableWriter,
    invert_table, simulate_table,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::fs;
use std::path::Path;

fn below(rng: &mut ChaCha8Rng, n: u32) -> u32 {
    rng.next_u32() % n
}

fn one<'a>(rng: &mut ChaCha8Rng, of: &[&'a str]) -> &'a str {
    of[below(rng, of.len() as u32) as usize]
}

fn model() -> Model {
    let plane = Plane::new(20.0, 80.0, 5).unwrap();
    Model::new(Operator::Mkp, plane, vec![0.1; 15], 0.3, Sign::Positive).unwrap()
}

/// A number as people and programs write it, sometimes none.
fn number(rng: &mut ChaCha8Rng, comma: bool, faults: bool) -> String {
    let value = f64::from(below(rng, 12_000)) / 100.0 - 10.0;
    let text = match below(rng, 12) {
        0 => format!("{value:e}"),
        1 => format!("+{}", value.abs()),
        2 => format!(" {value} "),
        3 => format!("\"{value}\""),
        4 => format!("{value:.17}"),
        5 => format!("{}", value.round()),
        6 => ".5".to_owned(),
        7 => "7.".to_owned(),
        _ => value.to_string(),
    };
    match below(rng, 400) {
        0 if faults => one(
            rng,
            &["", "NaN", "inf", "1e999", "no", "0x1", "1e", "\u{fffd}"],
        )
        .into(),
        _ if comma => text.replace('.', ","),
        _ => text,
    }
}

fn words(rng: &mut ChaCha8Rng) -> &'static str {
    one(
        rng,
        &[
            "",
            "ok",
            " a b ",
            "\"x,y\"",
            "\"two\nlines\"",
            "\"a\r\nb\"",
            "\"say \"\"on\"\"\"",
            "é",
            "\"\"",
            "\"open\"end",
            "mid\"quote",
            "1",
            "a\rb",
            "#7",
            "\t",
            "x;y",
            "x,y",
        ],
    )
}

/// A table of a random dialect. `x` is a column of numbers; the others hold anything.
fn table(rng: &mut ChaCha8Rng) -> String {
    let comma = below(rng, 4) == 0;
    let delimiter = match comma {
        true => ";",
        false => one(rng, &[",", ",", ",", ";", "\t"]),
    };
    let end = one(rng, &["\n", "\n", "\r\n"]);
    let faults = below(rng, 2) == 0;
    let (plain, wide) = (below(rng, 3) == 0, below(rng, 2) == 0);
    let columns = match wide {
        true => 12,
        false => 1 + below(rng, 4),
    };
    let at = below(rng, columns);
    let mut text = one(rng, &["", "", "\u{feff}", "# comment\n"]).to_owned();
    let names = (0..columns).map(|n| if n == at { "x".into() } else { format!("c{n}") });
    text += &names.collect::<Vec<_>>().join(delimiter);
    text += end;
    // Numbers first, so that the dialect is told.
    let rows = 1 + below(rng, 1500);
    for row in 0..rows {
        if row > 3 && below(rng, 100) == 0 {
            text += one(rng, &["", " ", "# note", "% \"note"]);
            text += end;
        }
        let cells = (0..columns).map(|n| match (n == at, row < 3 || plain) {
            (true, _) => number(rng, comma, faults && row > 3),
            (false, true) => format!("{row}"),
            (false, false) => {
                words(rng).replace(['x', ';'], if delimiter == ";" { "-" } else { "x" })
            }
        });
        let mut cells: Vec<String> = cells.collect();
        if faults && row > 3 && below(rng, 1000) == 0 {
            cells.push("more".into());
        }
        text += &cells.join(delimiter);
        text += end;
    }
    match below(rng, 3) {
        0 => text.trim_end_matches(['\r', '\n']).to_owned(),
        _ => text,
    }
}

/// The rows before the first fault, each by itself, and the fault.
fn by_definition(path: &Path, model: &Model, invert: bool) -> (Vec<u8>, Option<String>) {
    let mut out = csv::WriterBuilder::new()
        .flexible(true)
        .from_writer(Vec::new());
    let mut rows = || -> hysteron::Result<()> {
        let mut table = TableReader::open(path)?;
        let column = table.column("x")?;
        let added: &[&str] = match invert {
            true => &["input_model", "status"],
            false => &["output_model"],
        };
        let names = table.header().iter().map(String::as_str);
        out.write_record(names.chain(added.iter().copied()))
            .unwrap();
        let (mut state, inverse) = (model.start(), model.inverse()?);
        while table.advance()? {
            let x = table.number(column)?;
            let cells = match invert {
                true => {
                    let found = inverse.step(&mut state, hysteron::Target::new(x))?;
                    vec![found.input.to_string(), found.status.name().to_owned()]
                }
                false => vec![model.step(&mut state, x)?.output.to_string()],
            };
            let row: Vec<Vec<u8>> = table.row().cells().map(<[u8]>::to_vec).collect();
            let added = cells.iter().map(|cell| cell.as_bytes().to_vec());
            out.write_record(row.into_iter().chain(added)).unwrap();
        }
        Ok(())
    };
    let fault = rows().err().map(|error| error.to_string());
    (out.into_inner().unwrap(), fault)
}

fn in_blocks(path: &Path, to: &Path, model: &Model, invert: Option<Policy>) -> Option<String> {
    let around = Around::default();
    let run = || -> hysteron::Result<()> {
        let mut table = TableReader::open(path)?;
        let out = Some(TableWriter::create(Some(to.into()))?);
        let state = model.start();
        match invert {
            None => {
                let what = Simulate {
                    input: "x",
                    around,
                    rest: None,
                    band: None,
                };
                simulate_table(model, state, &mut table, what, out, |_| {})?;
            }
            Some(policy) => {
                let how = Invert {
                    target: "x",
                    around,
                    policy,
                    tolerance: 0.0,
                    look_ahead: 50,
                    drive_range: None,
                    horizon: 0.0,
                    preview: None,
                };
                invert_table(model, state, &mut table, how, out, |_| {})?;
            }
        }
        Ok(())
    };
    run().err().map(|error| error.to_string())
}

#[test]
fn blocks_give_the_bytes_and_faults_of_single_rows() {
    let folder = tempfile::tempdir().unwrap();
    let [source, out] = ["in.csv", "out.csv"].map(|name| folder.path().join(name));
    let model = model();
    let (mut whole, mut faults) = (0, 0);
    for seed in 0..300 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        fs::write(&source, table(&mut rng)).unwrap();
        for invert in [false, true] {
            let (expected, fault) = by_definition(&source, &model, invert);
            let found = in_blocks(&source, &out, &model, invert.then_some(Policy::Hold));
            assert_eq!(found, fault, "seed {seed}");
            // A file appears complete or not at all.
            assert_eq!(out.exists(), fault.is_none(), "seed {seed}");
            if fault.is_none() {
                whole += 1;
                let written = fs::read(&out).unwrap();
                assert!(written == expected, "seed {seed}: see {}", source.display());
                fs::remove_file(&out).unwrap();
            } else {
                faults += 1;
            }
        }
    }
    assert!(whole > 100 && faults > 100, "{whole} {faults}");
}

/// Rows wait for the reversal after them, over the end of their block.
#[test]
fn rows_that_wait_stay_with_their_cells() {
    let folder = tempfile::tempdir().unwrap();
    let [source, out] = ["in.csv", "out.csv"].map(|name| folder.path().join(name));
    let model = model();
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let target = |n: u32| 0.9 + 0.5 * (f64::from(n) * 1e-3).sin();
    let mut text = "n,x\n".to_owned();
    let mut targets = Vec::new();
    for n in 0..40_000 {
        targets.push(target(n) + 1e-3 * f64::from(below(&mut rng, 2)));
        text += &format!("\"row {n}\",{}\n", targets[targets.len() - 1]);
    }
    fs::write(&source, text).unwrap();
    for (policy, look_ahead) in [(Policy::Hold, 0), (Policy::Anticipate, 20_000)] {
        let mut table = TableReader::open(&source).unwrap();
        let writer = TableWriter::create(Some((&out).into())).unwrap();
        let how = Invert {
            target: "x",
            around: Around::default(),
            policy,
            tolerance: 0.01,
            look_ahead,
            drive_range: None,
            horizon: 0.0,
            preview: None,
        };
        let state = model.start();
        invert_table(&model, state, &mut table, how, Some(writer), |_| {}).unwrap();
        let mut rows = csv::Reader::from_path(&out).unwrap();
        let mut state = model.start();
        let mut count = 0;
        for (n, row) in rows.records().enumerate() {
            let row = row.unwrap();
            assert_eq!(row[0], format!("row {n}"));
            assert_eq!(row[1], targets[n].to_string());
            // The input that stands beside a target reaches it: noise below the tolerance is not
            // followed.
            let reached = model
                .step(&mut state, row[2].parse::<f64>().unwrap())
                .unwrap();
            assert!((reached.output - targets[n]).abs() <= 0.01, "row {n}");
            count += 1;
        }
        assert_eq!(count, targets.len());
        fs::remove_file(&out).unwrap();
    }
}
