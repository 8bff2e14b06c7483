//! A Parquet file with more columns keeps those that it had, whatever they hold.

use hysteron::{
    Invert, Model, Operator, Plane, Policy, Sign, Simulate, TableReader, TableWriter, invert_table,
    simulate_table,
};
use parquet::basic::Compression;
use parquet::column::writer::ColumnCloseResult;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::record::Field;
use parquet::schema::parser::parse_message_type;
use parquet::schema::types::Type;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;

const SCHEMA: &str = "message recording {
    REQUIRED DOUBLE x;
    OPTIONAL BYTE_ARRAY note (UTF8);
    OPTIONAL group tags (LIST) { REPEATED group list { OPTIONAL INT32 element; } }
    REQUIRED INT64 when (TIMESTAMP(MICROS, true));
    REQUIRED BYTE_ARRAY raw;
    OPTIONAL INT32 nothing;
    REQUIRED group at { REQUIRED INT32 row; OPTIONAL DOUBLE height; }
}";

/// A file with groups of so many rows.
fn write(path: &Path, groups: &[usize], compression: Compression, dictionary: bool) {
    let schema = Arc::new(parse_message_type(SCHEMA).unwrap());
    let properties = WriterProperties::builder()
        .set_compression(compression)
        .set_dictionary_enabled(dictionary);
    let file = File::create(path).unwrap();
    let mut writer = SerializedFileWriter::new(file, schema, Arc::new(properties.build())).unwrap();
    let mut first = 0;
    for rows in groups {
        let mut group = writer.next_row_group().unwrap();
        write_group(&mut group, first, *rows);
        group.close().unwrap();
        first += rows;
    }
    writer.close().unwrap();
}

fn write_group(group: &mut SerializedRowGroupWriter<'_, File>, first: usize, rows: usize) {
    let rows = first..first + rows;
    let x: Vec<f64> = rows
        .clone()
        .map(|n| 50.0 - 30.0 * (0.1 * n as f64).cos())
        .collect();
    next::<DoubleType>(group, &x, None, None);
    let defined: Vec<i16> = rows.clone().map(|n| i16::from(n % 3 != 0)).collect();
    let notes = rows.clone().filter(|n| n % 3 != 0);
    let notes: Vec<ByteArray> = notes
        .map(|n| ByteArray::from(&*format!("ü,\"{}", n % 7)))
        .collect();
    next::<ByteArrayType>(group, &notes, Some(&defined), None);
    // Lists of 0, 1 and 2 elements, the second of two without a value.
    let (mut tags, mut levels, mut repeated) = (Vec::new(), Vec::new(), Vec::new());
    for n in rows.clone() {
        let defined: &[i16] = [&[1][..], &[3], &[3, 2]][n % 3];
        levels.extend(defined);
        repeated.extend((0..defined.len()).map(|k| i16::from(k > 0)));
        tags.extend((n % 3 > 0).then_some(n as i32));
    }
    next::<Int32Type>(group, &tags, Some(&levels), Some(&repeated));
    let when: Vec<i64> = rows
        .clone()
        .map(|n| 1_767_225_600_000_000 + 7 * n as i64)
        .collect();
    next::<Int64Type>(group, &when, None, None);
    let raw: Vec<ByteArray> = rows
        .clone()
        .map(|n| ByteArray::from(vec![n as u8, 0xff]))
        .collect();
    next::<ByteArrayType>(group, &raw, None, None);
    next::<Int32Type>(group, &[], Some(&vec![0; rows.len()]), None);
    let numbers: Vec<i32> = rows.clone().map(|n| n as i32).collect();
    next::<Int32Type>(group, &numbers, None, None);
    let heights: Vec<f64> = rows
        .clone()
        .filter(|n| n % 2 == 0)
        .map(|n| n as f64)
        .collect();
    let defined: Vec<i16> = rows.map(|n| i16::from(n % 2 == 0)).collect();
    next::<DoubleType>(group, &heights, Some(&defined), None);
}

fn next<T: parquet::data_type::DataType>(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: &[T::T],
    defined: Option<&[i16]>,
    repeated: Option<&[i16]>,
) {
    let mut column = group.next_column().unwrap().unwrap();
    column
        .typed::<T>()
        .write_batch(values, defined, repeated)
        .unwrap();
    column.close().unwrap();
}

/// The cells of a row by the names of their columns.
type Cells = Vec<(String, Field)>;

/// The schema's columns and the rows of a file.
fn read(path: &Path) -> (Vec<Arc<Type>>, Vec<Cells>) {
    let reader = SerializedFileReader::new(File::open(path).unwrap()).unwrap();
    let fields = reader
        .metadata()
        .file_metadata()
        .schema()
        .get_fields()
        .to_vec();
    let rows = reader.get_row_iter(None).unwrap();
    let rows = rows.map(|row| {
        let row = row.unwrap();
        let cells = row.get_column_iter();
        cells
            .map(|(name, field)| (name.clone(), field.clone()))
            .collect()
    });
    (fields, rows.collect())
}

fn model() -> Model {
    let plane = Plane::new(20.0, 80.0, 5).unwrap();
    Model::new(Operator::Mkp, plane, vec![1.0; 15], 0.0, Sign::Positive).unwrap()
}

#[test]
fn every_column_goes_over_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let [source, out] = ["in.parquet", "out.parquet"].map(|name| folder.path().join(name));
    let model = model();
    for groups in [
        vec![1],
        vec![100],
        vec![40, 1, 59],
        vec![33, 0, 67, 0],
        vec![0, 5],
    ] {
        for compression in [
            Compression::UNCOMPRESSED,
            Compression::SNAPPY,
            Compression::ZSTD(Default::default()),
        ] {
            for dictionary in [false, true] {
                write(&source, &groups, compression, dictionary);
                let (fields, rows) = read(&source);
                let mut table = TableReader::open(&source).unwrap();
                let writer = TableWriter::create(Some((&out).into())).unwrap();
                let what = Simulate {
                    input: "x",
                    around: Default::default(),
                    rest: None,
                    band: None,
                };
                simulate_table(
                    &model,
                    model.start(),
                    &mut table,
                    what,
                    Some(writer),
                    |_| {},
                )
                .unwrap();
                let (new_fields, new_rows) = read(&out);
                assert_eq!(new_fields[..fields.len()], fields);
                let mut state = model.start();
                for (row, new) in rows.iter().zip(&new_rows) {
                    let (added, kept) = new.split_last().unwrap();
                    assert_eq!(kept, row);
                    let Field::Double(x) = row[0].1 else { panic!() };
                    let expected = model.step(&mut state, x).unwrap().output;
                    assert_eq!(*added, ("output_model".to_owned(), Field::Double(expected)));
                }
                assert_eq!(new_rows.len(), groups.iter().sum::<usize>());
                fs::remove_file(&out).unwrap();
            }
        }
    }
}

/// Rows that wait for the next reversal come in the same order.
#[test]
fn an_inverse_that_looks_ahead_adds_its_columns_too() {
    let folder = tempfile::tempdir().unwrap();
    let [source, out] = ["in.parquet", "out.parquet"].map(|name| folder.path().join(name));
    write(&source, &[30, 70], Compression::SNAPPY, true);
    let mut table = TableReader::open(&source).unwrap();
    let writer = TableWriter::create(Some((&out).into())).unwrap();
    let how = Invert {
        around: Default::default(),
        drive_range: None,
        horizon: 0.0,
        preview: None,
        target: "x",
        policy: Policy::Anticipate,
        tolerance: 0.0,
        look_ahead: 1000,
    };
    let counts = invert_table(
        &model(),
        model().start(),
        &mut table,
        how,
        Some(writer),
        |_| {},
    )
    .unwrap();
    assert_eq!(counts.samples, 100);
    let csv = folder.path().join("out.csv");
    let mut table = TableReader::open(&source).unwrap();
    let writer = TableWriter::create(Some((&csv).into())).unwrap();
    invert_table(
        &model(),
        model().start(),
        &mut table,
        how,
        Some(writer),
        |_| {},
    )
    .unwrap();
    let csv = fs::read_to_string(csv).unwrap();
    let (rows, expected) = (read(&out).1, read(&source).1);
    for ((row, before), line) in rows.iter().zip(&expected).zip(csv.lines().skip(1)) {
        assert_eq!(row[..before.len()], before[..]);
        let cells: Vec<&str> = line.rsplit(',').take(2).collect();
        assert_eq!(
            row[before.len()].1,
            Field::Double(cells[1].parse().unwrap())
        );
        assert_eq!(row[before.len() + 1].1, Field::Str(cells[0].to_owned()));
    }
}

#[test]
fn a_column_that_is_there_already_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [source, out] = ["in.parquet", "out.parquet"].map(|name| folder.path().join(name));
    let schema = "message m { REQUIRED DOUBLE x; REQUIRED BYTE_ARRAY output_model (UTF8); }";
    let schema = Arc::new(parse_message_type(schema).unwrap());
    let mut writer =
        SerializedFileWriter::new(File::create(&source).unwrap(), schema, Default::default())
            .unwrap();
    let mut group = writer.next_row_group().unwrap();
    next::<DoubleType>(&mut group, &[30.0], None, None);
    next::<ByteArrayType>(&mut group, &[ByteArray::from("mine")], None, None);
    group.close().unwrap();
    writer.close().unwrap();
    let mut table = TableReader::open(&source).unwrap();
    let writer = TableWriter::create(Some((&out).into())).unwrap();
    let what = Simulate {
        input: "x",
        around: Default::default(),
        rest: None,
        band: None,
    };
    let said = simulate_table(
        &model(),
        model().start(),
        &mut table,
        what,
        Some(writer),
        |_| {},
    )
    .unwrap_err();
    assert!(said.to_string().contains("`output_model`"), "{said}");
    assert!(!out.exists());
}

/// Of other sources, numbers become doubles and everything else text; empty cells are null.
#[test]
fn csv_becomes_parquet_with_the_kinds_that_its_cells_have() {
    let folder = tempfile::tempdir().unwrap();
    let [source, out] = ["in.csv", "out.parquet"].map(|name| folder.path().join(name));
    let text = "x,id,note,gap\n20,007,\"a, \"\"b\"\"\",1.5\n50,008,,\n80,009,c,-2e3\n";
    fs::write(&source, text).unwrap();
    let mut table = TableReader::open(&source).unwrap();
    let writer = TableWriter::create(Some((&out).into())).unwrap();
    let what = Simulate {
        input: "x",
        around: Default::default(),
        rest: None,
        band: None,
    };
    simulate_table(
        &model(),
        model().start(),
        &mut table,
        what,
        Some(writer),
        |_| {},
    )
    .unwrap();
    let rows = read(&out).1;
    let text = |text: &str| Field::Str(text.to_owned());
    let expected = [
        [
            Field::Double(20.0),
            text("007"),
            text("a, \"b\""),
            Field::Double(1.5),
        ],
        [Field::Double(50.0), text("008"), Field::Null, Field::Null],
        [
            Field::Double(80.0),
            text("009"),
            text("c"),
            Field::Double(-2000.0),
        ],
    ];
    for (row, expected) in rows.iter().zip(expected) {
        let cells: Vec<Field> = row[..4].iter().map(|(_, cell)| cell.clone()).collect();
        assert_eq!(cells, expected);
        assert!(matches!(row[4], (ref name, Field::Double(_)) if name == "output_model"));
    }
    assert_eq!(rows.len(), 3);
}

/// Simulates `source` into `out`, and says what was wrong.
fn simulated(source: &Path, out: &Path) -> hysteron::Result<()> {
    let mut table = TableReader::open(source)?;
    let what = Simulate {
        input: "x",
        around: Default::default(),
        rest: None,
        band: None,
    };
    let writer = TableWriter::create(Some(out.into()))?;
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

/// What is damaged in a column that the command does not read is refused, or can be read: no copy
/// is damaged as its source is.
#[test]
fn a_damaged_file_is_not_copied() {
    let folder = tempfile::tempdir().unwrap();
    let [source, out] = ["in.parquet", "out.parquet"].map(|name| folder.path().join(name));
    let (mut refused, mut copied) = (0, 0);
    for (seed, codec) in [
        Compression::UNCOMPRESSED,
        Compression::SNAPPY,
        Compression::ZSTD(Default::default()),
    ]
    .into_iter()
    .enumerate()
    {
        write(&source, &[40, 60], codec, seed != 1);
        let whole = fs::read(&source).unwrap();
        let mut random = ChaCha8Rng::seed_from_u64(seed as u64);
        for case in 0..250 {
            let mut bytes = whole.clone();
            for _ in 0..random.random_range(1..4) {
                let at = random.random_range(4..bytes.len() - 8);
                bytes[at] = random.random::<u32>() as u8;
            }
            fs::write(&source, &bytes).unwrap();
            let _ = fs::remove_file(&out);
            match simulated(&source, &out) {
                Ok(()) => {
                    let copy = std::panic::catch_unwind(|| read(&out));
                    assert_eq!(
                        copy.map(|(_, rows)| rows.len()).unwrap_or(0),
                        100,
                        "{codec} {case}"
                    );
                    copied += 1;
                }
                Err(_) => {
                    assert!(!out.exists(), "{codec} {case}");
                    refused += 1;
                }
            }
        }
    }
    println!("{refused} refused, {copied} copied");
    assert!(
        refused > 100 && copied > 50,
        "{refused} refused, {copied} copied"
    );
}

/// A codec that is not read is told by its name, and not as damage.
#[test]
fn a_codec_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let [plain, packed, out] =
        ["plain.parquet", "in.parquet", "out.parquet"].map(|name| folder.path().join(name));
    write(&plain, &[10], Compression::UNCOMPRESSED, false);
    for (codec, name) in [
        (Compression::BROTLI(Default::default()), "Brotli"),
        (Compression::LZO, "LZO"),
    ] {
        // The same pages, said to be packed.
        let reader = SerializedFileReader::new(File::open(&plain).unwrap()).unwrap();
        let schema = reader
            .metadata()
            .file_metadata()
            .schema_descr()
            .root_schema_ptr();
        let file = File::create(&packed).unwrap();
        let mut writer = SerializedFileWriter::new(file, schema, Default::default()).unwrap();
        let mut group = writer.next_row_group().unwrap();
        for column in reader.metadata().row_group(0).columns() {
            let metadata = column.clone().into_builder().set_compression(codec);
            let stored = ColumnCloseResult {
                bytes_written: column.compressed_size() as u64,
                rows_written: 10,
                metadata: metadata.build().unwrap(),
                bloom_filter: None,
                column_index: None,
                offset_index: None,
            };
            group
                .append_column(&File::open(&plain).unwrap(), stored)
                .unwrap();
        }
        group.close().unwrap();
        writer.close().unwrap();
        let said = simulated(&packed, &out).unwrap_err().to_string();
        assert!(said.contains(name) && !said.contains("damaged"), "{said}");
    }
}
