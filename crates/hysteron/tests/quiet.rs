//! A damaged file ends in an error. The panic of a library on the way prints nothing.
#![allow(clippy::unwrap_used, clippy::panic)]

use hysteron::{Columns, ReadOptions, Recording, Simulate, TableReader, TableWriter};
use hysteron::{Model, Operator, Plane, Sign, simulate_table};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

static TOLD: AtomicUsize = AtomicUsize::new(0);

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures")
        .join(name)
}

/// Copies the file as the command does: its columns go through the reader and into a new file.
fn copied(source: &Path, out: &Path) -> hysteron::Result<()> {
    let plane = Plane::new(0.0, 1.0, 2)?;
    let model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    let mut table = TableReader::open(source)?;
    let what = Simulate {
        input: "x",
        around: Default::default(),
        rest: None,
        band: None,
    };
    let writer = TableWriter::create(Some(out.into()))?;
    simulate_table(
        &model,
        model.start(),
        &mut table,
        what,
        Some(writer),
        |_| {},
    )
    .map(|_| ())
}

/// One test alone in its program: the hook of panics belongs to the whole process.
#[test]
fn a_damaged_file_says_so_and_prints_no_panic() {
    // The usual hook prints; this one counts. It is here before any file is read.
    std::panic::set_hook(Box::new(|_| {
        TOLD.fetch_add(1, Relaxed);
    }));
    let folder = tempfile::tempdir().unwrap();
    let mut refused = 0;
    let names = [
        "none.arrow",
        "zstd.arrow",
        "lz4.arrow",
        "kinds.arrow",
        "stream.arrows",
    ];
    let others = ["none.parquet", "snappy.parquet", "lz4.parquet", "v73.mat"];
    for (seed, name) in names.into_iter().chain(others).enumerate() {
        let whole = fs::read(fixture(name)).unwrap();
        let path = folder.path().join(name);
        let ending = path.extension().unwrap().to_str().unwrap().to_owned();
        let ending = if ending == "mat" { "csv" } else { &ending };
        let out = folder.path().join(format!("out.{ending}"));
        let mut random = ChaCha8Rng::seed_from_u64(seed as u64);
        for _ in 0..400 {
            let mut bytes = whole.clone();
            for _ in 0..random.random_range(1..4) {
                let at = random.random_range(0..bytes.len());
                match random.random_range(0..4) {
                    0 => bytes[at] ^= 1 << random.random_range(0..8),
                    1 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random.random_range(0..5)],
                    2 => bytes[at..].iter_mut().take(8).for_each(|byte| *byte = 0xff),
                    _ => bytes[at..].iter_mut().take(4).for_each(|byte| *byte = 0),
                }
            }
            fs::write(&path, &bytes).unwrap();
            refused += usize::from(copied(&path, &out).is_err());
            let read = Recording::read(&path, Columns::new("x", "t"), ReadOptions::default());
            refused += usize::from(read.is_err());
        }
    }
    // Back to the usual one, which tells what is asserted here.
    let told = TOLD.load(Relaxed);
    let _ = std::panic::take_hook();
    assert_eq!(told, 0, "panics were printed");
    assert!(refused > 500, "{refused}");
    // A panic of others is still told.
    std::panic::set_hook(Box::new(|_| {
        TOLD.fetch_add(1, Relaxed);
    }));
    let _ = std::panic::catch_unwind(|| panic!("of another"));
    let _ = std::panic::take_hook();
    assert_eq!(TOLD.load(Relaxed), 1);
}
