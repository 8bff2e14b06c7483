//! Recognises files that hysteron wrote, by their content.

use super::parquet::PROGRAM;
use crate::data::table::{ARROW_FILE, PARQUET_FILE};
use crate::files::begins_with;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use std::fs::File;
use std::io;
use std::path::Path;

/// The columns that commands add to tables. In CSV they are the last ones. Columns of words come
/// together with columns of numbers.
const ADDED: [&[&str]; 7] = [
    &["output_model"],
    &["output_model", "output_low", "output_high"],
    &["input_model", "status"],
    &["input_model", "temperature_model", "status"],
    &["input_model", "output_low", "output_high", "status"],
    &[
        "input_model",
        "temperature_model",
        "output_low",
        "output_high",
        "status",
    ],
    &["output_model", "error", "outcome"],
];
/// Those columns that hold words.
const WORDS: [&str; 2] = ["status", "outcome"];

/// Whether the file is a table that a command made.
pub(crate) fn is_our_table(path: &Path) -> io::Result<bool> {
    if begins_with(path, PARQUET_FILE)? {
        parquet(path)
    } else if begins_with(path, ARROW_FILE)? {
        super::arrow::is_ours(path)
    } else {
        csv(path)
    }
}

/// Other tools put their own name into the metadata when they write a file again.
fn parquet(path: &Path) -> io::Result<bool> {
    let file = File::open(path)?;
    let writer = crate::data::table::caught(|| {
        let reader = SerializedFileReader::new(file)?;
        Ok(reader
            .metadata()
            .file_metadata()
            .created_by()
            .map(str::to_owned))
    });
    Ok(writer.is_ok_and(|writer| writer.is_some_and(|name| name.starts_with(PROGRAM))))
}

/// The last columns are ours, and every number in them is written as we write it, down to the last
/// line. Spreadsheets write numbers and line ends differently.
fn csv(path: &Path) -> io::Result<bool> {
    let mut rows = csv::ReaderBuilder::new()
        .has_headers(false)
        .terminator(csv::Terminator::Any(b'\n'))
        .from_reader(File::open(path)?);
    let mut row = csv::ByteRecord::new();
    if !rows.read_byte_record(&mut row).unwrap_or(false) {
        return Ok(false);
    }
    let Some(added) = ADDED.into_iter().rev().find(|added| ends_with(&row, added)) else {
        return Ok(false);
    };
    let first = row.len() - added.len();
    loop {
        match rows.read_byte_record(&mut row) {
            Ok(false) => return Ok(true),
            Ok(true) if added.iter().zip(row.iter().skip(first)).all(is_as_written) => {}
            _ => return Ok(false),
        }
    }
}

fn ends_with(header: &csv::ByteRecord, added: &[&str]) -> bool {
    let count = header.len();
    count >= added.len()
        && (header.iter().skip(count - added.len())).eq(added.iter().map(|name| name.as_bytes()))
}

fn is_as_written((name, cell): (&&str, &[u8])) -> bool {
    let number = |cell: &str| {
        cell.parse::<f64>()
            .is_ok_and(|value| value.to_string() == cell)
    };
    WORDS.contains(name) || std::str::from_utf8(cell).is_ok_and(number)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn tables_are_known_by_their_last_columns_and_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        let cases = [
            ("x,output_model\n1,0.25\n", true),
            ("output_model\n", true),
            (
                "x,output_model,output_low,output_high\nhot,1,0.5,1.5\n",
                true,
            ),
            ("y,input_model,status\n3.00,1,ok\n", true),
            ("x,y,output_model,error,outcome\n1,2,3,-1,learned\n", true),
            ("x,output_model,input_model,status\n1,1.50,2,ok\n", true),
            ("", false),
            ("x,y\n1,2\n", false),
            // A user's column after ours, and ours in the middle.
            ("x,output_model,note\n1,0.25,mine\n", false),
            ("output_model,x\n0.25,1\n", false),
            ("x,status\n1,ok\n", false),
            // Numbers as other programs write them.
            ("x,output_model\n1,0.250\n", false),
            ("x,output_model\n1,2.5E-1\n", false),
            ("x,output_model\n1,0.25\n2,\n", false),
            ("x,output_model\n1,0.25\n2\n", false),
            ("x,output_model\r\n1,0.25\r\n", false),
        ];
        for (text, ours) in cases {
            std::fs::write(&path, text).unwrap();
            assert_eq!(is_our_table(&path).unwrap(), ours, "{text:?}");
        }
    }
}
