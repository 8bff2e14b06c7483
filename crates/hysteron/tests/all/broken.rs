//! Recordings that cannot be used, each with the error that it gets.

use hysteron::{Columns, Fit, FitOptions, Recording, Repair};
use std::fs;
use std::path::{Path, PathBuf};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests")
        .join(name)
}

/// What reading a recording and fitting a model to it says, without the path.
fn refusal(path: &Path, columns: Columns<'_>) -> String {
    let read = Recording::read(path, columns, Repair::Refuse);
    let done = read.and_then(|(recording, _)| Fit::from(FitOptions::plain()).run(&recording));
    let said = done.expect_err(&path.display().to_string()).to_string();
    let place = path.display().to_string();
    assert!(said.contains(&place), "{said}");
    said.replacen(&place, "FILE", 1)
}

/// Files in `tests/broken`.
const FILES: [(&str, &str); 21] = [
    (
        "empty.csv",
        "recording FILE, line 1: the file is empty: a header row with the columns' names is needed",
    ),
    (
        "header-only.csv",
        "recording FILE, line 1: there are no rows below the header",
    ),
    (
        "missing-column.csv",
        "recording FILE: no column `y`: there are `t`, `x`",
    ),
    (
        "duplicate-columns.csv",
        "recording FILE: two columns are called `x`: give its number, from 1",
    ),
    (
        "ragged.csv",
        "recording FILE, line 3: 2 cells where the header has 3: give every row as many, separated by commas, or use `repair` to drop such rows",
    ),
    (
        "nan.csv",
        "recording FILE, line 3, column `x`: `NaN` where a finite number is needed; in all lines 3, 5, 7 and 2 more without a number: mend or remove them, or use `repair`",
    ),
    (
        "text.csv",
        "recording FILE, line 3, column `x`: `abc` where a finite number is needed: mend or remove the row, or use `repair`",
    ),
    (
        "infinity.csv",
        "recording FILE, line 3, column `y`: `inf` where a finite number is needed: mend or remove the row, or use `repair`",
    ),
    (
        "unclosed-quote.csv",
        "recording FILE, line 3: a quote is opened here and never closed",
    ),
    (
        "latin-1-cell.csv",
        "recording FILE, line 3, column `x`: `3°` where a finite number is needed: mend or remove the row, or use `repair`",
    ),
    (
        "constant-input.csv",
        "recording FILE, column `x`: it is 50 throughout: nothing can be identified from it",
    ),
    (
        "unsorted-time.csv",
        "recording FILE, line 4, column `t`: time goes back from 2 to 1: mend or remove the row, or use `repair`",
    ),
    (
        "repeated-time.csv",
        "recording FILE, line 4, column `t`: the time is 1 again; in all lines 4 and 5 at the time of the row before: mend or remove them, or use `repair`",
    ),
    (
        "huge.csv",
        "recording FILE, column `y`: 1e160 is too large to be squared: use another unit",
    ),
    (
        "numbers-as-header.csv",
        "recording FILE: no column `x`: there are `1`, `2`, `3`",
    ),
    (
        "decimal-comma.csv",
        "recording FILE, line 2: 5 cells where the header has 3: give every row as many, separated by commas; numbers with decimal commas need semicolons or tabs between them, or use `repair` to drop such rows",
    ),
    (
        "thousands.csv",
        "recording FILE, line 2, column `x`: `1,234` where a finite number is needed; in all lines 2 and 3 without a number: mend or remove them, or use `repair`",
    ),
    (
        "units-only.csv",
        "recording FILE, line 2: there are no rows below the header",
    ),
    (
        "many-faults.csv",
        "recording FILE, line 7, column `x`: `-` where a finite number is needed; in all line 7 without a number; line 9 at the time of the row before: mend or remove them, or use `repair`",
    ),
    (
        "text.parquet",
        "recording FILE: this is no Parquet file, for all its name: it does not begin with `PAR1`",
    ),
    (
        "text.mat",
        "recording FILE: this is no MATLAB file of version 5, 7 or 7.3: save it in MATLAB with `-v7`",
    ),
];

#[test]
fn every_broken_file_has_its_error() {
    let columns = Columns {
        time: Some("t"),
        ..Columns::new("x", "y")
    };
    for (name, expected) in FILES {
        let path = folder("broken").join(name);
        assert_eq!(refusal(&path, columns), expected, "{name}");
    }
    let there = fs::read_dir(folder("broken")).unwrap().count();
    assert_eq!(there, FILES.len(), "a file without its error");
}

#[test]
fn binary_files_that_are_cut_off_or_hold_something_else() {
    let temporary = tempfile::tempdir().unwrap();
    let whole = |name: &str| fs::read(folder("fixtures").join(name)).unwrap();
    // The header of a MATLAB file is 128 bytes long.
    let cases: [(&str, Vec<u8>, &str); 9] = [
        (
            "cut.parquet",
            whole("none.parquet")[..900].to_vec(),
            "recording FILE: the Parquet file is damaged or cut off (Parquet error: Invalid Parquet file. Corrupt footer): write or copy it again",
        ),
        (
            "cut-v5.mat",
            whole("v5.mat")[..150].to_vec(),
            "recording FILE: the MATLAB file is damaged or cut off: save or copy it again",
        ),
        (
            "cut-v7.mat",
            whole("v7.mat")[..700].to_vec(),
            "recording FILE: the MATLAB file is damaged or cut off: save or copy it again",
        ),
        (
            "short.mat",
            whole("v5.mat")[..100].to_vec(),
            "recording FILE: the MATLAB file is damaged or cut off: save or copy it again",
        ),
        (
            "cut-v73.mat",
            whole("v73.mat")[..1500].to_vec(),
            "recording FILE: the MATLAB 7.3 file is damaged or cut off",
        ),
        (
            "nothing.mat",
            whole("v5.mat")[..128].to_vec(),
            "recording FILE: there is no array of real numbers in this file: save vectors, not cells or tables",
        ),
        (
            "run.csv",
            b"\x1f\x8b\x08\0\0\0\0\0".to_vec(),
            "recording FILE: the file is compressed by gzip: unpack it first",
        ),
        (
            "book.csv",
            b"PK\x03\x04\x14\0".to_vec(),
            "recording FILE: this is a workbook or an archive: save the table as CSV",
        ),
        (
            "endless.csv",
            vec![b'7'; 5 << 20],
            "recording FILE, line 1: the line does not end: is this a table?",
        ),
    ];
    for (name, bytes, expected) in cases {
        let path = temporary.path().join(name);
        fs::write(&path, bytes).unwrap();
        let said = refusal(&path, Columns::new("x", "y"));
        // What the HDF5 library says beyond is its own.
        let said = if name == "cut-v73.mat" {
            &said[..expected.len()]
        } else {
            &said
        };
        assert_eq!(said, expected, "{name}");
    }
}

#[test]
fn what_whole_files_do_not_hold() {
    let cases = [
        (
            "v5.mat",
            ["x", "w"],
            "recording FILE: no column `w`: there are `t`, `x`, `y`, `M:1`, `M:2`, `M:3`, `temperature:1`, `temperature:2`, `displacement:1`, `displacement:2`, `on`",
        ),
        (
            "v5.mat",
            ["x", "fs"],
            "recording FILE: `fs` has 1 values where the column asked for before it has 6: name columns that were sampled together",
        ),
        (
            "v5.mat",
            ["temperature", "late"],
            "recording FILE: the times of `late` are not those of `temperature`: use `repair` to interpolate it onto them",
        ),
        (
            "v5.mat",
            ["fs", "fs"],
            "recording FILE: the column `fs` is named twice: input, output, time and load are four things",
        ),
        (
            "none.parquet",
            ["x", "note"],
            "recording FILE: no column `note`: there are `t`, `x`, `y`, `n`, `u`, `on`",
        ),
        (
            "none.parquet",
            ["x", "y"],
            "recording FILE, row 6, column `y`: `NaN` where a finite number is needed: mend or remove the row, or use `repair`",
        ),
    ];
    for (name, [input, output], expected) in cases {
        let path = folder("fixtures").join(name);
        assert_eq!(refusal(&path, Columns::new(input, output)), expected);
    }
    let said = refusal(&folder("broken"), Columns::new("x", "y"));
    assert_eq!(said, "FILE: this is a folder: name a file in it");
    let said = refusal(&folder("none"), Columns::new("x", "y"));
    assert!(said.starts_with("FILE: "), "{said}");
}

/// Damage anywhere is told of, and nothing panics.
#[test]
fn any_byte_of_a_binary_file_may_be_wrong() {
    let temporary = tempfile::tempdir().unwrap();
    for name in [
        "v5.mat",
        "v7.mat",
        "v73.mat",
        "none.parquet",
        "snappy.parquet",
    ] {
        let whole = fs::read(folder("fixtures").join(name)).unwrap();
        let path = temporary.path().join(name);
        // Every byte would take a minute; eleven is no divisor of the sizes of their parts.
        for n in (0..whole.len()).step_by(11) {
            let mut bytes = whole.clone();
            bytes[n] ^= 0xff;
            fs::write(&path, &bytes).unwrap();
            // It may be a byte that nobody reads.
            let _ = Recording::read(&path, Columns::new("x", "t"), Repair::Mend);
            bytes.truncate(n);
            fs::write(&path, &bytes).unwrap();
            let _ = Recording::read(&path, Columns::new("x", "t"), Repair::Mend);
        }
    }
}
