//! Files as measuring programs and people write them, each with what is said about it.

use hysteron::{Columns, Recording, Repair, TableReader};
use std::fs;
use std::path::{Path, PathBuf};

fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    folder.join(name)
}

fn written(bytes: impl AsRef<[u8]>) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), bytes).unwrap();
    file
}

/// Reads input `x`, output `y` and, where it is named, a time.
fn read(
    bytes: impl AsRef<[u8]>,
    time: Option<&str>,
    repair: Repair,
) -> Result<(Recording, Vec<String>), String> {
    let file = written(bytes);
    let columns = Columns {
        time,
        ..Columns::new("x", "y")
    };
    let (recording, notes) =
        Recording::read(file.path(), columns, repair).map_err(|error| error.to_string())?;
    let notes = notes.iter().map(ToString::to_string).collect();
    Ok((recording, notes))
}

#[test]
fn lines_above_the_header_are_skipped_and_told() {
    let lvm = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nMulti_Headings\tNo\nX_Columns\tOne\n\
               Time\t10:00:00,5\n***End_of_Header***\t\n\t\nChannels\t2\nSamples\t3\t3\nX_Dimension\tTime\tTime\nX0\t0,0E+0\t0,0E+0\n\
               Delta_X\t0,5\t0,5\n***End_of_Header***\t\t\nX_Value\tx\ty\tComment\n0,0\t20,5\t0,25\tstart\n0,5\t30,5\t1,25\n1,0\t40,5\t2,25\n";
    let logger = "Logger: TC-08\nSerial;A12\nStart;2024-03-01;10:00\nInterval;1\n\nn;x;y\n;degC;mm\n1;20,5;0,25\n2;30,5;1,25\n3;40,5;2,25\n";
    let pairs = "Device,ABC,1\nInterval,1,s\nt,x,y\n0,20.5,0.25\n1,30.5,1.25\n2,40.5,2.25\n";
    let cases = [
        (
            lvm,
            "15 lines above the header skipped; line 16 is the header: X_Value, x, y, Comment",
        ),
        (
            logger,
            "5 lines above the header skipped; line 6 is the header: n, x, y",
        ),
        (
            pairs,
            "2 lines above the header skipped; line 3 is the header: t, x, y",
        ),
    ];
    for (text, note) in cases {
        let (recording, notes) = read(text, None, Repair::Refuse).expect(text);
        assert_eq!(recording.input, [20.5, 30.5, 40.5], "{text}");
        assert_eq!(recording.output, [0.25, 1.25, 2.25], "{text}");
        assert_eq!(notes, [note]);
    }
}

/// Whatever stands above a table, as long as no line of it looks like a header above rows.
#[test]
fn any_preamble_is_skipped_whole() {
    let lines = [
        "Run 7",
        "a: b",
        "Serial no. 12",
        "2024-03-01 10:00:00",
        "== data ==",
        "",
        "# comment",
        "v1.5",
    ];
    for n in 0..8_usize.pow(3) {
        let above = [n % 8, n / 8 % 8, n / 64].map(|k| lines[k]).join("\n");
        for delimiter in [",", ";", "\t"] {
            let table = "t|x|y\n0|20.5|1\n1|30.5|2\n".replace('|', delimiter);
            let text = format!("{above}\n{table}");
            let (recording, notes) = read(&text, Some("t"), Repair::Refuse).expect(&text);
            assert_eq!(recording.input, [20.5, 30.5], "{text}");
            let told = above
                .lines()
                .any(|line| !line.is_empty() && !line.starts_with('#'));
            assert_eq!(notes.len(), usize::from(told), "{text}");
        }
    }
}

#[test]
fn columns_without_names_go_by_number() {
    let note = |above: usize| {
        format!(
            "no header row: the table begins in line {above}, and its columns go by number, 1 to 3"
        )
    };
    for (text, note) in [
        ("0;20,5;1\n1;30,5;2\n", note(1)),
        ("hot;20,5;1\ncold;30,5;2\n", note(1)),
        ("Run 7\nof March\n0\t20.5\t1\n1\t30.5\t2\n", note(3)),
    ] {
        let file = written(text);
        let columns = Columns::new("2", "3");
        let (recording, notes) = Recording::read(file.path(), columns, Repair::Refuse).unwrap();
        assert_eq!(recording.input, [20.5, 30.5]);
        assert_eq!(recording.input_quantity.name, "2");
        assert_eq!(notes[0].to_string(), note);
    }
    // A named column wins, and a number that finds another is told.
    let file = written("a,1,x\n0.5,20,5\n1.5,30,6\n");
    let (recording, notes) =
        Recording::read(file.path(), Columns::new("1", "3"), Repair::Refuse).unwrap();
    assert_eq!(
        (&recording.input[..], &recording.output[..]),
        (&[20.0, 30.0][..], &[5.0, 6.0][..])
    );
    let notes: Vec<String> = notes.iter().map(ToString::to_string).collect();
    assert_eq!(notes, ["`3` is taken for the column `x`"]);
}

#[test]
fn text_of_other_encodings_is_read() {
    let columns = Columns::new("x", "y");
    let (recording, notes) =
        Recording::read(&fixture("latin-1.csv"), columns, Repair::Refuse).unwrap();
    assert_eq!(recording.input, [20.0, 30.0]);
    assert_eq!(
        notes[0].to_string(),
        "the text is not UTF-8: read as windows-1252"
    );
    let text = "Zeit;x [°C];y\n0;20,5;1\n1;30,5;2\n";
    let utf16 = |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
        let units = std::iter::once(0xfeff).chain(text.encode_utf16());
        units.flat_map(bytes).collect()
    };
    let latin1 = text.replace('°', "\u{fffd}").into_bytes();
    let latin1: Vec<u8> = String::from_utf8(latin1)
        .unwrap()
        .chars()
        .map(|c| match c {
            '\u{fffd}' => 0xb0,
            c => c as u8,
        })
        .collect();
    for (bytes, encoding) in [
        (utf16(u16::to_le_bytes), "UTF-16LE"),
        (utf16(u16::to_be_bytes), "UTF-16BE"),
        (latin1, "windows-1252"),
    ] {
        let (recording, notes) = read(&bytes, None, Repair::Refuse).unwrap();
        assert_eq!(recording.input, [20.5, 30.5]);
        assert_eq!(recording.input_quantity.unit.as_deref(), Some("°C"));
        assert_eq!(
            notes,
            [format!("the text is not UTF-8: read as {encoding}")]
        );
    }
    // The whole table is decoded, and what is written again is UTF-8.
    let file = written(b"x,\xb0\n1,\xe9\n2,\xfc\n");
    let mut table = TableReader::open(file.path()).unwrap();
    assert!(table.advance().unwrap());
    let cells: Vec<Vec<u8>> = table.row().cells().map(<[u8]>::to_vec).collect();
    assert_eq!(cells, ["1".as_bytes(), "é".as_bytes()]);
}

#[test]
fn fields_of_structures_are_columns() {
    for name in ["structure-v5.mat", "structure-v7.mat", "structure-v73.mat"] {
        let columns = Columns {
            time: Some("run.t"),
            ..Columns::new("run.probe.temperature", "run.lift")
        };
        let read = Recording::read(&fixture(name), columns, Repair::Refuse);
        let (recording, _) = read.expect(name);
        assert_eq!(
            recording.input,
            [20.0, 35.5, 50.0, 80.0, 50.0, 20.0],
            "{name}"
        );
        assert_eq!(recording.output, [0.0, 1.0, 4.0, 14.0, 13.0, 2.0], "{name}");
        assert_eq!(recording.input_quantity.name, "run.probe.temperature");
    }
}

#[test]
fn rows_cut_short_are_dropped_or_refused_with_their_lines() {
    let text = "t,x,y\n0,20,0\n1,30\n2,40,2\n3,50,3,9\n4,60,4\n";
    let (recording, notes) = read(text, None, Repair::Mend).unwrap();
    assert_eq!(recording.input, [20.0, 40.0, 60.0]);
    assert_eq!(
        notes,
        ["lines 3 and 5 with more or fewer cells than the header: dropped"]
    );
    let refused = read(text, None, Repair::Refuse).unwrap_err();
    assert!(
        refused.contains("line 3: 2 cells where the header has 3"),
        "{refused}"
    );
    assert!(
        refused.ends_with("or use `repair` to drop such rows"),
        "{refused}"
    );
}

#[test]
fn commas_that_may_be_thousands_are_told_or_refused() {
    // Only decimals are possible.
    let (_, notes) = read("x;y\n1,234;0,5\n2,345;1\n", None, Repair::Refuse).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    // Both are.
    let (recording, notes) = read("x;y\n20,125;1\n1,234;2\n", None, Repair::Refuse).unwrap();
    assert_eq!(recording.input, [20.125, 1.234]);
    assert!(
        notes[0].starts_with("line 2, column `x`: commas are read as decimal"),
        "{notes:?}"
    );
    // Numbers below a thousand have no comma, and those above have.
    let refused = read("x\ty\n950\t1\n1,234\t2\n", None, Repair::Refuse).unwrap_err();
    assert!(
        refused.contains("line 3, column `x`: `1,234` may be 1.234 or 1234"),
        "{refused}"
    );
}

#[test]
fn times_become_seconds() {
    let cases = [
        ("t [ms]", "t [ms]", "500", "ms"),
        ("time_min", "time_min", "30", "min"),
        ("Zeit (h)", "Zeit", "0.5", "h"),
        ("t_us", "t_us", "500000", "us"),
    ];
    let seconds = [0.5, 1800.0, 1800.0, 0.5];
    for ((header, asked, value, unit), seconds) in cases.into_iter().zip(seconds) {
        let text = format!("{header},x,y\n0,1,2\n{value},3,4\n");
        let (recording, notes) = read(&text, Some(asked), Repair::Refuse).expect(&text);
        assert_eq!(recording.time.as_deref(), Some(&[0.0, seconds][..]));
        assert_eq!(
            notes,
            [format!(
                "the time in column `{header}` is in {unit}: turned into seconds"
            )]
        );
    }
    let (recording, _) = read("t;x;y\nms;;\n0;1;2\n250;3;4\n", Some("t"), Repair::Refuse).unwrap();
    assert_eq!(recording.time.as_deref(), Some(&[0.0, 0.25][..]));
}

#[test]
fn a_doubtful_time_is_questioned() {
    let rows = |step: f64| -> String {
        (0..3000)
            .map(|n| format!("{},{n},{n}\n", step * f64::from(n)))
            .collect()
    };
    let (_, notes) = read(format!("t,x,y\n{}", rows(10.0)), Some("t"), Repair::Refuse).unwrap();
    assert!(
        notes[0].contains("no unit and is taken as seconds: a step of 10 s, 29990 s in all"),
        "{notes:?}"
    );
    for text in [
        format!("t [s],x,y\n{}", rows(10.0)),
        format!("t,x,y\n{}", rows(0.1)),
    ] {
        let time = text.split(',').next().unwrap().to_owned();
        let (_, notes) = read(&text, Some(&time), Repair::Refuse).unwrap();
        assert!(notes.is_empty(), "{notes:?}");
    }
}

#[test]
fn columns_are_found_by_their_bare_names() {
    let file = written("Zeit [s],Temperatur (°C),Weg [mm],Weg 2 [mm]\n0,20,0,1\n1,30,1,2\n");
    let read = |input, output| {
        Recording::read(file.path(), Columns::new(input, output), Repair::Refuse).map_err(|error| {
            error
                .to_string()
                .rsplit_once(": no ")
                .unwrap_or_default()
                .1
                .to_owned()
        })
    };
    let (recording, notes) = read("temperature", "weg").unwrap();
    assert_eq!(recording.input_quantity.to_column(), "Temperatur [°C]");
    assert_eq!(recording.output_quantity.to_column(), "Weg [mm]");
    assert_eq!(recording.output, [0.0, 1.0]);
    assert_eq!(
        notes[0].to_string(),
        "`temperature` is taken for the column `Temperatur (°C)`"
    );
    let refused = read("temperatur", "wge").unwrap_err();
    assert!(
        refused.starts_with("column `wge`, did you mean")
            || refused.starts_with("column `wge`: there are"),
        "{refused}"
    );
    let ambiguous = Recording::read(
        file.path(),
        Columns::new("temperatur", "we"),
        Repair::Refuse,
    );
    assert!(ambiguous.is_err());
    // Two names for one column.
    let twice = Recording::read(file.path(), Columns::new("weg", "Weg [mm]"), Repair::Refuse);
    assert!(twice.unwrap_err().to_string().contains("four things"));
}

/// A stray quote opens a cell that takes in everything after it. Were each line of it looked at
/// again with all before, four million lines would take days.
#[test]
fn a_stray_quote_is_read_once() {
    let mut text = String::from("x,y\n1,2\n3,\"4\n");
    text.push_str(&"5\n".repeat(3 << 20));
    let refused = read(&text, None, Repair::Mend).unwrap_err();
    assert!(
        refused.contains("line 3: a quote is opened here and never closed"),
        "{refused}"
    );
    let cell = format!("x,y,note\n1,2,\"{}\"\n3,4,ok\n", "5\n".repeat(1 << 20));
    let (recording, _) = read(&cell, None, Repair::Refuse).unwrap();
    assert_eq!(recording.input, [1.0, 3.0]);
}
