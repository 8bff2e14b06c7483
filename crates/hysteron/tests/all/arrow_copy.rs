//! An Arrow table with more columns keeps those that it had; other tables become Arrow and come back.

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, RecordBatch};
use arrow_ipc::reader::{FileReader, StreamReader};
use hysteron::{
    Around, Destination, Invert, Model, Operator, Plane, Policy, Sign, Simulate, TableReader,
    TableWriter, invert_table, simulate_table,
};
use std::fs::{self, File};
use std::path::{Path, PathBuf};

fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    folder.join(name)
}

fn model() -> Model {
    let plane = Plane::new(20.0, 80.0, 5).unwrap();
    Model::new(Operator::Mkp, plane, vec![1.0; 15], 0.0, Sign::Positive).unwrap()
}

fn parts(path: &Path) -> Vec<RecordBatch> {
    let file = File::open(path).unwrap();
    match path.extension().unwrap() == "arrows" {
        true => StreamReader::try_new(file, None)
            .unwrap()
            .map(Result::unwrap)
            .collect(),
        false => FileReader::try_new(file, None)
            .unwrap()
            .map(Result::unwrap)
            .collect(),
    }
}

fn simulate(source: &Path, out: &Path) -> hysteron::Result<()> {
    let mut table = TableReader::open(source)?;
    let writer = TableWriter::create(Some(Destination::keeping_foreign(out, false)))?;
    let what = Simulate {
        input: "x",
        around: Around::default(),
        rest: None,
        band: None,
    };
    let model = model();
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

fn invert(source: &Path, out: &Path) -> hysteron::Result<()> {
    let mut table = TableReader::open(source)?;
    let writer = TableWriter::create(Some(Destination::keeping_foreign(out, false)))?;
    let how = Invert {
        target: "x",
        around: Around::default(),
        policy: Policy::Anticipate,
        tolerance: 0.0,
        look_ahead: 1000,
        drive_range: None,
        horizon: 0.0,
        preview: None,
    };
    let model = model();
    invert_table(&model, model.start(), &mut table, how, Some(writer), |_| {}).map(|_| ())
}

#[test]
fn every_column_of_arrow_goes_over_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    for source in [
        "none.arrow",
        "zstd.arrow",
        "lz4.arrow",
        "stream.arrows",
        "kinds.arrow",
    ] {
        for out in ["out.arrow", "out.feather", "out.arrows"] {
            for inverse in [false, true] {
                let (source, out) = (fixture(source), folder.path().join(out));
                match inverse {
                    true => invert(&source, &out).unwrap(),
                    false => simulate(&source, &out).unwrap(),
                }
                let (before, after) = (parts(&source), parts(&out));
                assert_eq!(before.len(), after.len());
                let (model, mut row) = (model(), 0);
                let mut state = model.start();
                for (before, after) in before.iter().zip(&after) {
                    let count = before.num_columns();
                    for n in 0..count {
                        assert_eq!(before.column(n), after.column(n));
                        assert_eq!(before.schema().field(n), after.schema().field(n));
                    }
                    let x = before
                        .column_by_name("x")
                        .unwrap()
                        .as_primitive::<Float64Type>();
                    let added = after.column(count).as_primitive::<Float64Type>();
                    assert_eq!(added.null_count(), 0);
                    row += before.num_rows();
                    if inverse {
                        let status = after.column_by_name("status").unwrap().as_string::<i32>();
                        assert!(
                            status
                                .iter()
                                .all(|word| word.is_some_and(|word| !word.is_empty()))
                        );
                        continue;
                    }
                    for (x, found) in x.values().iter().zip(added.values()) {
                        let expected = model.step(&mut state, *x).unwrap().output;
                        assert_eq!(expected.to_bits(), found.to_bits());
                    }
                }
                assert!(row > 0);
                // What we wrote as a file is known as ours and replaced. A stream has no mark.
                let again = match inverse {
                    true => simulate(&source, &out),
                    false => invert(&source, &out),
                };
                assert_eq!(
                    again.is_ok(),
                    out.extension().unwrap() != "arrows",
                    "{again:?}"
                );
                fs::remove_file(&out).unwrap();
            }
        }
    }
}

/// The rows of a table as text, once it was written in this format.
fn by_way_of(folder: &Path, source: &Path, name: &str) -> String {
    let (there, back) = (folder.join(name), folder.join("back.csv"));
    simulate(source, &there).unwrap();
    // The second time, another column of words is added, in CSV.
    invert(&there, &back).unwrap();
    let text = fs::read_to_string(&back).unwrap();
    fs::remove_file(there).unwrap();
    fs::remove_file(back).unwrap();
    text
}

#[test]
fn parquet_and_arrow_hold_the_same_numbers_of_any_source() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let csv = folder.join("in.csv");
    let rows: String = (0..20_000)
        .map(|n| {
            let x = 50.0 - 30.0 * (f64::from(n) * 0.01).cos();
            let gap = if n % 3 == 0 {
                String::new()
            } else {
                (f64::from(n) / 7.0).to_string()
            };
            format!("{x},{gap},w{}\n", n % 5)
        })
        .collect();
    fs::write(&csv, format!("x,gap,note\n{rows}")).unwrap();
    for source in [
        csv,
        fixture("v5.mat"),
        fixture("zstd.parquet"),
        fixture("kinds.arrow"),
    ] {
        let expected = by_way_of(folder, &source, "there.parquet");
        for name in ["there.arrow", "there.arrows"] {
            let found = by_way_of(folder, &source, name);
            let of_arrow = source.extension().unwrap() == "arrow";
            // Copied into Arrow, all columns are still there; into Parquet, those of numbers.
            let lines = |text: &str| text.lines().count();
            match of_arrow {
                true => assert_eq!(lines(&found), lines(&expected)),
                false => assert!(found == expected, "{name} of {}", source.display()),
            }
        }
    }
}

#[test]
fn a_column_that_is_there_already_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = ["first.arrow", "second.arrow"].map(|name| folder.path().join(name));
    simulate(&fixture("none.arrow"), &first).unwrap();
    let said = simulate(&first, &second).unwrap_err().to_string();
    assert!(said.contains("`output_model`"), "{said}");
    assert!(!second.exists());
}
