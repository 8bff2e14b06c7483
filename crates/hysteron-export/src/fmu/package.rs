//! The archive of an FMU.

use super::Fmi;
use super::binaries::binaries;
use super::sources;
use hysteron::{Error, Result};
use std::io::{self, Cursor, Read, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

const LICENCE: &str = include_str!("../../LICENSE-MIT");

const DESCRIPTION: &str = "modelDescription.xml";
/// Files beside the binaries.
const OTHERS: usize = 4;
/// Files in all: of older versions with two binaries; of FMI 2.0 and of FMI 3.0, without sources and
/// with them.
const COUNTS: [usize; 5] = [
    OTHERS + 2,
    OTHERS + 4,
    OTHERS + 5,
    OTHERS + 4 + sources::COUNTS[0],
    OTHERS + 5 + sources::COUNTS[1],
];

pub(super) struct Files {
    pub(super) description: String,
    pub(super) model_text: String,
    pub(super) model_json: String,
    /// Names and texts of the sources, where there are any.
    pub(super) sources: Vec<(String, String)>,
}

/// The same bytes for the same content: without times, in a fixed order.
pub(super) fn zip(files: &Files, name: &str, fmi: Fmi) -> Result<Vec<u8>> {
    let binaries = binaries(fmi);
    let licence = format!(
        "The binaries, and the C in sources/ if it is there, are part of hysteron, under the licence \
         below. The binaries hold parts of Rust's \
         standard library (MIT or Apache-2.0, \
         https://github.com/rust-lang/rust/blob/HEAD/COPYRIGHT), that for Windows also of \
         mingw-w64 and of GCC's runtime (GCC Runtime Library Exception). The model in resources/ \
         and in sources/block_model.c is its maker's.\n\n{LICENCE}"
    );
    let others: [(String, &[u8]); OTHERS] = [
        (DESCRIPTION.into(), files.description.as_bytes()),
        ("resources/model.txt".into(), files.model_text.as_bytes()),
        ("resources/model.json".into(), files.model_json.as_bytes()),
        (
            "documentation/licenses/license.txt".into(),
            licence.as_bytes(),
        ),
    ];
    // Miri takes the way in which the compressor frees its memory for undefined behaviour.
    let (method, level) = match cfg!(miri) {
        false => (CompressionMethod::Deflated, Some(9)),
        true => (CompressionMethod::Stored, None),
    };
    let options = SimpleFileOptions::default()
        .compression_method(method)
        .compression_level(level)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let packed = (|| {
        let binaries = binaries.iter().map(|(platform, ending, bytes)| {
            let path = format!("binaries/{platform}/{name}.{ending}");
            (path, bytes.as_ref())
        });
        let sources = files.sources.iter();
        let sources = sources.map(|(name, text)| (format!("sources/{name}"), text.as_bytes()));
        for (path, bytes) in others.into_iter().chain(sources).chain(binaries) {
            zip.start_file(path, options)?;
            zip.write_all(bytes)?;
        }
        zip.finish()
    })();
    match packed {
        Ok(cursor) => Ok(cursor.into_inner()),
        Err(error) => Err(Error::Export(format!(
            "the archive cannot be made: {error}"
        ))),
    }
}

/// How the last record of an archive begins, and its length where there is no comment.
const END: &[u8] = b"PK\x05\x06";
const END_LENGTH: usize = 22;

/// Whether an archive is one of ours as it was written: the description says so, and no file was
/// added or, as its time would tell, exchanged; and nothing stands before or behind it.
pub(super) fn is_ours(path: &Path) -> io::Result<bool> {
    let bytes = std::fs::read(path)?;
    let end = bytes.len().saturating_sub(END_LENGTH);
    if !bytes[end..].starts_with(END) {
        return Ok(false);
    }
    let Ok(mut archive) = ZipArchive::new(Cursor::new(bytes)) else {
        return Ok(false);
    };
    if !COUNTS.contains(&archive.len()) || archive.offset() != 0 {
        return Ok(false);
    }
    for n in 0..archive.len() {
        let entry = archive.by_index_raw(n);
        if !entry.is_ok_and(|entry| entry.last_modified() == Some(DateTime::default())) {
            return Ok(false);
        }
    }
    let mut text = String::new();
    let description = archive.by_name(DESCRIPTION);
    let read = description.is_ok_and(|mut entry| entry.read_to_string(&mut text).is_ok());
    Ok(read && text.contains("generationTool=\"hysteron "))
}
