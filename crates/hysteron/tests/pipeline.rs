//! Reader, model and writer work at once. Their result is that of one after the other, whatever the
//! sizes of what arrives, and the error that is told is the first one in the file.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used)]

use hysteron::{
    Around, FirstOrder, Invert, Model, Operator, Plane, Policy, Sign, Simulate, TableReader,
    TableWriter, invert_table, simulate_table,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::fs;
use std::io::Write;
use std::os::fd::AsRawFd;
use std::path::Path;

fn below(rng: &mut ChaCha8Rng, n: usize) -> usize {
    rng.next_u32() as usize % n
}

/// A model that depends on time: time that goes back is its error.
fn model() -> Model {
    let plane = Plane::new(20.0, 80.0, 5).unwrap();
    let mut model = Model::new(Operator::Mkp, plane, vec![0.1; 15], 0.3, Sign::Positive).unwrap();
    model.thermal = Some(FirstOrder {
        ambient: 20.0,
        gain: 1.0,
        tau_heating: 3.0,
        tau_cooling: 6.0,
    });
    model
}

/// What a run says, with `FILE` for the table's path, and what it leaves at `out`.
fn run(source: &Path, out: &Path, how: How) -> (Option<String>, Option<Vec<u8>>) {
    let around = Around {
        time: Some("t"),
        ..Around::default()
    };
    let work = || -> hysteron::Result<()> {
        let mut table = TableReader::open(source)?;
        let out = Some(TableWriter::create(Some(out.into()))?);
        let mut model = model();
        match how {
            How::Simulate => {
                let what = Simulate {
                    input: "x",
                    around,
                    rest: None,
                    band: None,
                };
                simulate_table(&model, model.start(), &mut table, what, out, |_| {})?;
            }
            How::Invert => {
                model.thermal = None;
                let how = Invert {
                    target: "x",
                    around: Around::default(),
                    policy: Policy::Anticipate,
                    tolerance: 0.01,
                    look_ahead: 20_000,
                    drive_range: None,
                    horizon: 0.0,
                    preview: None,
                };
                invert_table(&model, model.start(), &mut table, how, out, |_| {})?;
            }
        }
        Ok(())
    };
    let said = work().err().map(|error| error.to_string());
    let said = said.map(|said| said.replace(&source.display().to_string(), "FILE"));
    let left = out.is_file().then(|| fs::read(out).unwrap());
    if left.is_some() {
        fs::remove_file(out).unwrap();
    }
    (said, left)
}

#[derive(Debug, Clone, Copy)]
enum How {
    Simulate,
    Invert,
}

/// A table of so many rows; in the row `bad` there is no number, at `back` the time goes back.
fn table(rows: usize, rng: &mut ChaCha8Rng, bad: Option<usize>, back: Option<usize>) -> String {
    let notes = [
        "",
        "ok",
        "\"a,b\"",
        "\"two\nlines\"",
        "é",
        "mid\"quote",
        "1",
    ];
    let mut text = "t,x,note\n".to_owned();
    for n in 0..rows {
        let time = if back == Some(n) {
            -1.0
        } else {
            n as f64 * 0.5
        };
        let x = match bad == Some(n) {
            true => "no".to_owned(),
            false => format!("{:.3}", 50.0 - 30.0 * (n as f64 * 0.003).cos()),
        };
        let note = match below(rng, 20) {
            0 => notes[below(rng, notes.len())],
            _ => "run",
        };
        text += &format!("{time},{x},{note}\n");
    }
    text
}

/// Runs on a pipe through which the text comes in pieces.
fn from_pipe(
    text: &str,
    out: &Path,
    how: How,
    rng: &mut ChaCha8Rng,
) -> (Option<String>, Option<Vec<u8>>) {
    let (reader, mut writer) = std::io::pipe().unwrap();
    let most = [1, 7, 100, 5_000, 70_000, 300_000][below(rng, 6)];
    // Small pieces only where there are not too many of them.
    let most = most.max(text.len() / 2_000);
    let mut sizes = ChaCha8Rng::seed_from_u64(rng.next_u64());
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let mut rest = text.as_bytes();
            while !rest.is_empty() {
                let (piece, after) = rest.split_at(rest.len().min(1 + below(&mut sizes, most)));
                // A run that has failed reads no more.
                if writer.write_all(piece).is_err() {
                    break;
                }
                rest = after;
            }
        });
        let path = format!("/dev/fd/{}", reader.as_raw_fd());
        let ended = run(path.as_ref(), out, how);
        drop(reader);
        ended
    })
}

#[test]
fn pieces_of_any_size_give_the_bytes_and_errors_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let [source, out] = ["in.csv", "out.csv"].map(|name| folder.path().join(name));
    let (mut whole, mut faults) = (0, 0);
    for seed in 0..60 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let rows = [1, 2, 50, 3_000, 40_000][below(&mut rng, 5)];
        // Often in the last block, or the last row.
        let mut fault = || match below(&mut rng, 3) {
            0 => Some(rows - 1 - below(&mut rng, rows.min(30))),
            1 => Some(below(&mut rng, rows)),
            _ => None,
        };
        let (bad, back) = (fault(), fault());
        let text = table(rows, &mut rng, bad, back);
        fs::write(&source, &text).unwrap();
        for how in [How::Simulate, How::Invert] {
            let expected = run(&source, &out, how);
            let found = from_pipe(&text, &out, how, &mut rng);
            assert_eq!(found.0, expected.0, "seed {seed}, {how:?}");
            assert!(found.1 == expected.1, "seed {seed}, {how:?}");
            // Complete or not at all, and by the first fault.
            assert_eq!(expected.1.is_none(), expected.0.is_some());
            let back = back.filter(|row| matches!(how, How::Simulate) && *row > 0);
            let first = bad.into_iter().chain(back).min();
            assert_eq!(
                first.is_some(),
                expected.0.is_some(),
                "seed {seed}, {how:?}"
            );
            whole += usize::from(first.is_none());
            faults += usize::from(first.is_some());
        }
    }
    assert!(whole > 20 && faults > 20, "{whole} {faults}");
}

/// Whatever stage fails later in the file, or earlier in time, the first fault in the file is told.
#[test]
fn the_first_fault_in_the_file_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let [source, out] = ["in.csv", "out.csv"].map(|name| folder.path().join(name));
    let rows = 30_000;
    let line = |row: usize| format!("line {},", row + 2);
    let plain = |bad: Option<usize>, back: Option<usize>| {
        let mut text = "t,x\n".to_owned();
        for n in 0..rows {
            let time = if back == Some(n) { -1.0 } else { n as f64 };
            let x = if bad == Some(n) { "no" } else { "50" };
            text += &format!("{time},{x}\n");
        }
        text
    };
    for (bad, back) in [
        (20_000, 25_000),
        (25_000, 20_000),
        (20_000, 20_001),
        (20_001, 20_000),
        (rows - 1, rows - 2),
        (rows - 2, rows - 1),
        (5, 3),
        (3, 5),
    ] {
        fs::write(&source, plain(Some(bad), Some(back))).unwrap();
        for _ in 0..10 {
            let (said, left) = run(&source, &out, How::Simulate);
            let said = said.unwrap();
            let column = if bad < back { "`x`" } else { "`t`" };
            assert!(
                said.contains(&line(bad.min(back))) && said.contains(column),
                "{said}"
            );
            assert!(left.is_none());
            // Rows are written before the rows after them are looked at.
            if bad.min(back) >= 20_000 {
                let (said, _) = run(&source, "/dev/full".as_ref(), How::Simulate);
                assert!(said.unwrap().contains("/dev/full"));
            }
        }
    }
    fs::write(&source, plain(None, None)).unwrap();
    for how in [How::Simulate, How::Invert] {
        let (said, _) = run(&source, "/dev/full".as_ref(), how);
        assert!(said.unwrap().contains("/dev/full"), "{how:?}");
    }
}
