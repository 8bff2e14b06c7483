//! Recordings in every format and dialect, and what is mended in them.

use hysteron::{Columns, Memory, Origin, Recording, Repair, TableReader, TableWriter};
use std::fs;
use std::path::{Path, PathBuf};

const TIME: [f64; 6] = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5];
const INPUT: [f64; 6] = [20.0, 35.5, 50.0, 80.0, 50.0, 20.0];
const OUTPUT: [f64; 6] = [0.0, 1.0, 4.0, 14.0, 13.0, 2.0];

fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    folder.join(name)
}

fn timed<'a>(input: &'a str, output: &'a str, time: &'a str) -> Columns<'a> {
    Columns {
        time: Some(time),
        ..Columns::new(input, output)
    }
}

/// Reads a text as a file, and what is said about it.
fn read(text: &str, columns: Columns<'_>, repair: Repair) -> (Recording, Vec<String>) {
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), text).unwrap();
    let (recording, notes) = Recording::read(file.path(), columns, repair).expect(text);
    (recording, notes.iter().map(ToString::to_string).collect())
}

#[test]
fn dialects_of_csv() {
    let dialects = [
        "x,y\n20,0.5\n35.5,1\n",
        "\u{feff}x,y\r\n20,0.5\r\n\r\n35.5,1\r\n",
        "x,y\r20,0.5\r35.5,1\r",
        "y, note,x\n0.5,\"a, b\", 20\n1,\"c\nd\", 35.5",
        "x;y\n20;0,5\n35,5;1\n",
        "x;y\n20;0.5\n35.5;1\n",
        "x\ty\n20\t0,5\n35,5\t1\n",
        "x;load, axial;y\n20;1,25;0,5\n35,5;0;1\n",
        "# logger 7\n% of a kind\n\nx,y\n20,0.5\n# a pause\n  # another\n35.5,1\n",
        "# x, y\n20,0.5\n35.5,1\n",
        "\"x\";\"y\"\n\"20\";\"0,5\"\n\"35,5\";\"1\"\n",
        "x,y\n2e1,5E-1\n+35.5,1.\n",
    ];
    for text in dialects {
        let (recording, notes) = read(text, Columns::new("x", "y"), Repair::Refuse);
        assert_eq!(recording.input, [20.0, 35.5], "{text:?}");
        assert_eq!(recording.output, [0.5, 1.0], "{text:?}");
        assert!(notes.is_empty());
    }
}

#[test]
fn units_below_the_header() {
    for units in ["degC;mm", "[degC];(mm)", " degC ; [ mm ]"] {
        let text = format!("x;y\n{units}\n20;0,5\n");
        let (recording, _) = read(&text, Columns::new("x", "y"), Repair::Refuse);
        assert_eq!(recording.input, [20.0]);
        assert_eq!(recording.input_quantity.to_column(), "x [degC]");
        assert_eq!(recording.output_quantity.to_column(), "y [mm]");
    }
    // The header's own unit is the nearer one.
    let text = "x [K],y\ndegC,\n20,0.5\n";
    let (recording, _) = read(text, Columns::new("x [K]", "y"), Repair::Refuse);
    assert_eq!(recording.input_quantity.unit.as_deref(), Some("K"));
    assert_eq!(recording.output_quantity.unit, None);
}

#[test]
fn parquet_in_every_compression() {
    for name in ["none", "snappy", "gzip", "zstd", "lz4"] {
        let path = fixture(&format!("{name}.parquet"));
        let (recording, _) = Recording::read(&path, timed("x", "n", "t"), Repair::Refuse).unwrap();
        assert_eq!(recording.time.as_deref(), Some(&TIME[..]), "{name}");
        assert_eq!(recording.input, INPUT, "{name}");
        assert_eq!(recording.output, OUTPUT, "{name}");
        assert_eq!(recording.source.unwrap().sha256.len(), 64);
        let (recording, _) =
            Recording::read(&path, Columns::new("u", "on"), Repair::Refuse).unwrap();
        assert_eq!(recording.input[..2], [2_f64.powi(64), 0.0], "{name}");
        assert_eq!(recording.output, [0.0, 0.0, 1.0, 1.0, 1.0, 0.0], "{name}");
        let (recording, notes) =
            Recording::read(&path, Columns::new("x", "y"), Repair::Mend).unwrap();
        assert_eq!(recording.output, OUTPUT[..5], "{name}");
        assert_eq!(notes[0].to_string(), "row 6 without a number: dropped");
    }
}

/// The rows of the Parquet files, as Arrow, and written by us as Arrow from Parquet and from Arrow.
#[test]
fn arrow_files_and_streams() {
    for name in ["none.arrow", "zstd.arrow", "lz4.arrow", "stream.arrows"] {
        let path = fixture(name);
        let (recording, _) = Recording::read(&path, timed("x", "n", "t"), Repair::Refuse).unwrap();
        assert_eq!(recording.time.as_deref(), Some(&TIME[..]), "{name}");
        assert_eq!(recording.input, INPUT, "{name}");
        assert_eq!(recording.output, OUTPUT, "{name}");
        let (recording, _) =
            Recording::read(&path, Columns::new("u", "on"), Repair::Refuse).unwrap();
        assert_eq!(recording.input[..2], [2_f64.powi(64), 0.0], "{name}");
        assert_eq!(recording.output, [0.0, 0.0, 1.0, 1.0, 1.0, 0.0], "{name}");
        let (recording, notes) =
            Recording::read(&path, Columns::new("x", "y"), Repair::Mend).unwrap();
        assert_eq!(recording.output, OUTPUT[..5], "{name}");
        assert_eq!(notes[0].to_string(), "row 6 without a number: dropped");
        let bytes = fs::read(&path).unwrap();
        let held = hysteron::TableReader::from_bytes(name, bytes, 1 << 20).unwrap();
        assert_eq!(held.header(), ["t", "x", "y", "n", "u", "on"], "{name}");
    }
}

/// A table of other types is the same from Arrow and from Parquet. Only durations and decimals are
/// read from Arrow alone.
#[test]
fn arrow_has_the_numbers_of_parquet() {
    let rows = |name: &str| {
        let mut table = TableReader::open(&fixture(name)).unwrap();
        let columns: Vec<_> = table.columns().collect();
        let mut rows = Vec::new();
        while table.advance().unwrap() {
            let row = columns.iter().map(|column| table.value(*column));
            rows.push(row.collect::<Vec<_>>());
        }
        (table.header().to_vec(), rows)
    };
    let (header, cells) = rows("kinds.arrow");
    let (of_parquet, expected) = rows("kinds.parquet");
    let day = header.iter().position(|name| name == "day").unwrap();
    assert_eq!(cells[1][day], Some(20_001.0 * 86_400.0));
    for (n, name) in header.iter().enumerate() {
        // Parquet holds halves as two bytes without a meaning that is read.
        if name == "half" {
            assert_eq!(cells[1][n], Some(1.0));
            continue;
        }
        let of_parquet = of_parquet.iter().position(|other| other == name).unwrap();
        for (row, expected) in cells.iter().zip(&expected) {
            assert_eq!(row[n], expected[of_parquet], "{name}");
        }
    }
    assert_eq!(header.len(), of_parquet.len() + 1);
}

#[test]
fn matlab_files() {
    for name in ["v5.mat", "v7.mat", "v73.mat"] {
        let path = fixture(name);
        let read = |columns| Recording::read(&path, columns, Repair::Refuse).unwrap().0;
        let recording = read(timed("x", "y", "t"));
        assert_eq!(recording.time.as_deref(), Some(&TIME[..]), "{name}");
        assert_eq!(recording.input, INPUT, "{name}");
        assert_eq!(recording.output, OUTPUT, "{name}");
        assert_eq!(read(Columns::new("x", "on")).output[3], 1.0, "{name}");
        // `[TimeValues DataValues]` as input, output, or by its columns.
        for (input, output) in [("temperature", "y"), ("x", "y"), ("temperature:2", "y")] {
            let recording = read(Columns::new(input, output));
            assert_eq!(recording.input, INPUT, "{name}");
            let expected = (input == "temperature").then_some(&TIME[..]);
            assert_eq!(recording.time.as_deref(), expected, "{name}");
        }
        let recording = read(Columns::new("y", "temperature"));
        assert_eq!(recording.time.as_deref(), Some(&TIME[..]), "{name}");
    }
    let path = fixture("v5.mat");
    let columns = Columns::new("temperature", "displacement");
    let (recording, notes) = Recording::read(&path, columns, Repair::Refuse).unwrap();
    assert_eq!(
        (&recording.input[..], &recording.output[..]),
        (&INPUT[..], &OUTPUT[..])
    );
    assert_eq!(recording.input_quantity.name, "temperature");
    assert!(notes.is_empty());
    let (recording, _) =
        Recording::read(&path, Columns::new("M:1", "M:3"), Repair::Refuse).unwrap();
    assert_eq!(recording.output, TIME);
}

/// In `late` the value is ten times the time, from -0.25 to 1.75.
#[test]
fn times_of_their_own_are_brought_together() {
    let columns = Columns::new("temperature", "late");
    let (recording, notes) = Recording::read(&fixture("v5.mat"), columns, Repair::Mend).unwrap();
    assert_eq!(recording.time.as_deref(), Some(&TIME[..4]));
    assert_eq!(recording.input, INPUT[..4]);
    assert_eq!(
        recording.output,
        TIME[..4].iter().map(|t| 10.0 * t).collect::<Vec<_>>()
    );
    let notes: Vec<String> = notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        [
            "rows 5 and 6 without a number: dropped",
            "rows 1, 2, 3 and 1 more of an output with times of its own: interpolated onto the times of the input"
        ]
    );
}

#[test]
fn rows_are_mended() {
    let text = "t,x,y,load\n\
                0,20,0,1\n\
                1,oops,1,1\n\
                2,40,2,1\n\
                # a comment counts as a line\n\
                1,30,1,1\n\
                2,50,4,3\n\
                2,60,6,5\n\
                3,,7,1\n\
                9,70,8,1\n\
                10,80,9,1\n";
    let columns = Columns {
        load: Some("load"),
        ..timed("x", "y", "t")
    };
    let (recording, notes) = read(text, columns, Repair::Mend);
    // The rows keep their order and their values: that whose time alone is wrong goes.
    assert_eq!(recording.time.unwrap(), [0.0, 2.0, 2.0, 2.0, 9.0, 10.0]);
    assert_eq!(recording.input, [20.0, 40.0, 50.0, 60.0, 70.0, 80.0]);
    assert_eq!(recording.output, [0.0, 2.0, 4.0, 6.0, 8.0, 9.0]);
    assert_eq!(recording.load.unwrap(), [1.0, 1.0, 3.0, 5.0, 1.0, 1.0]);
    let expected = [
        "lines 3 and 9 without a number: dropped",
        "line 6 with a time that fits none around: dropped",
        "lines 7 and 8 at the time of the row before: kept",
        "line 10 after a gap of over three times the median time step",
    ];
    assert_eq!(notes, expected);
    // Without a time there is nothing to sort by.
    let (recording, notes) = read(text, Columns::new("x", "y"), Repair::Mend);
    assert_eq!(recording.input, [20.0, 40.0, 30.0, 50.0, 60.0, 70.0, 80.0]);
    assert_eq!(notes.len(), 1);
}

#[test]
fn gaps_are_told_of_and_nothing_else() {
    let (_, notes) = read(
        "t,x,y\n0,1,1\n1,2,2\n2,3,3\n6,4,4\n7,5,5\n",
        timed("x", "y", "t"),
        Repair::Refuse,
    );
    assert_eq!(
        notes,
        ["line 5 after a gap of over three times the median time step"]
    );
}

/// Copies of a table are plain CSV, whatever it was.
#[test]
fn rows_are_written_with_commas_and_points() {
    let folder = tempfile::tempdir().unwrap();
    let european = folder.path().join("european.csv");
    fs::write(&european, "x;note\ndegC;\n1,5;a, b\n2;\"c;d\"\n").unwrap();
    let expected = [
        (european, "x", "x,note\n1.5,\"a, b\"\n2,c;d\n"),
        (
            fixture("zstd.parquet"),
            "x",
            "t,x,y,n,u,on\n0,20,0,0,18446744073709552000,0\n0.5,35.5,1,1,0,0\n1,50,4,4,1,1\n1.5,80,14,14,2,1\n2,50,13,13,3,1\n2.5,20,,2,4,0\n",
        ),
        (fixture("v5.mat"), "fs", "fs,note.value\n2,3\n"),
    ];
    for (path, column, expected) in expected {
        let mut table = TableReader::open(&path).unwrap();
        table.column(column).unwrap();
        let out = folder.path().join("out.csv");
        let mut writer = TableWriter::plain(Some((&out).into())).unwrap();
        writer.row(table.header()).unwrap();
        while table.advance().unwrap() {
            writer.row(table.row().cells()).unwrap();
        }
        writer.finish().unwrap();
        assert_eq!(
            fs::read_to_string(&out).unwrap(),
            expected,
            "{}",
            path.display()
        );
        assert!(table.bytes_read() > 0);
    }
}

/// Cells of any kind: numbers, words, nothing, quotes.
fn cell(n: u64) -> String {
    let n = n.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
    match n % 5 {
        0 => String::new(),
        1 => format!("a,\"b\" {n}"),
        2 => format!("{}", f64::from(u32::try_from(n).unwrap()) * 1e-3),
        3 => format!("00{n}"),
        _ => n.to_string(),
    }
}

#[test]
fn a_table_in_memory_has_the_bytes_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    for name in [
        "a.csv",
        "a",
        "a.parquet",
        "a.PARQUET",
        "a.arrow",
        "a.feather",
        "a.arrows",
    ] {
        // From an empty table to one of several blocks.
        for rows in [0, 1, 7, 20_000] {
            let path = folder.path().join(name);
            let mut file = TableWriter::plain(Some((&path).into())).unwrap();
            let mut memory = TableWriter::in_memory(name, &Memory::new(1 << 24)).unwrap();
            for table in [&mut file, &mut memory] {
                table.row(["u", "y [mm]", "number"]).unwrap();
                for n in 0..rows {
                    let cells = [cell(2 * n), cell(2 * n + 1), format!("{n}.5")];
                    table.row(cells).unwrap();
                }
            }
            file.finish().unwrap();
            let bytes = memory.into_bytes().unwrap();
            assert!(fs::read(&path).unwrap() == bytes, "{name}, {rows} rows");
            fs::remove_file(&path).unwrap();
        }
    }
    assert!(TableWriter::in_memory("a.xlsx", &Memory::new(1 << 24)).is_err());
    let mut twice = TableWriter::in_memory("a.parquet", &Memory::new(1 << 24)).unwrap();
    twice.row(["u", "u"]).unwrap();
    assert!(twice.into_bytes().is_err());
}

/// What a simulated recording is written with tells so where it is read. Another column of that
/// name does not.
#[test]
fn a_simulated_recording_stays_one() {
    let mut recording = Recording::new(INPUT.to_vec(), OUTPUT.to_vec()).unwrap();
    let file = tempfile::NamedTempFile::with_suffix(".csv").unwrap();
    for origin in [Origin::Simulated, Origin::Measured] {
        recording.origin = origin;
        recording.write_csv(file.path()).unwrap();
        let columns = Columns::new("input", "output");
        let read = Recording::read(file.path(), columns, Repair::Refuse);
        assert_eq!(read.unwrap().0.origin, origin);
    }
    let columns = Columns::new("T", "x");
    for last in ["0", "1.5", "yes", ""] {
        let text = format!("T,x,simulated\n20,0,1\n35,1,1\n50,4,{last}\n");
        let (recording, _) = read(&text, columns, Repair::Refuse);
        assert_eq!(recording.origin, Origin::Measured, "{last}");
    }
}
