//! Checks the sizes that a Parquet file claims against the memory that is left, before the library
//! reads it.

use super::thrift::Compact;
use crate::data::table::budget::Budget;
use crate::data::table::stored::ReadSeek;
use parquet::basic::Compression;
use parquet::file::metadata::{ColumnChunkMetaData, RowGroupMetaData};
use std::io::{Read, SeekFrom};

const CONTRADICTION: &str = "it contradicts itself";

/// Largest nesting depth of columns. The library reads them by recursion.
const DEEPEST: usize = 100;

/// A file whose claims are checked before the library reads it.
pub(super) struct Claims {
    file: Box<dyn ReadSeek>,
    length: u64,
    budget: Budget,
}

/// Why a file is refused.
pub(super) enum Refusal {
    Damaged(String),
    TooLarge(String),
    /// It is whole, but needs what is not there.
    Unread(String),
}

impl From<std::io::Error> for Refusal {
    fn from(error: std::io::Error) -> Self {
        Self::Damaged(error.to_string())
    }
}

fn damaged() -> Refusal {
    Refusal::Damaged(CONTRADICTION.into())
}

impl Claims {
    /// The claims of a file that is `length` bytes long.
    pub(super) fn new(file: Box<dyn ReadSeek>, length: u64, budget: Budget) -> Self {
        Self {
            file,
            length,
            budget,
        }
    }

    /// Checks the footer: its length, and how deep its columns are nested. The library checks
    /// everything else against the length of the footer.
    pub(super) fn check_footer(&mut self) -> Result<(), Refusal> {
        /// Size of the footer's length and the mark.
        const TAIL: u64 = 8;
        /// Memory per byte of the footer when it is read; the worst case is a column without
        /// statistics.
        const GROWTH: u128 = 256;
        let Some(end) = self.length.checked_sub(TAIL) else {
            return Ok(());
        };
        let mut size = [0; 4];
        self.file.seek(SeekFrom::Start(end))?;
        self.file.read_exact(&mut size)?;
        let size = u64::from(u32::from_le_bytes(size));
        let Some(start) = end.checked_sub(size) else {
            // The library has a better message for this case.
            return Ok(());
        };
        self.take(u128::from(size) * GROWTH, "the list of its parts")?;
        let footer = self.bytes(start, size as usize)?;
        // If the footer cannot be parsed here, the library will refuse it.
        match nesting(&footer) {
            Some(depth) if depth > DEEPEST => Err(Refusal::Damaged(format!(
                "its columns are nested more than {DEEPEST} deep"
            ))),
            _ => Ok(()),
        }
    }

    /// Checks a row group of which `columns` are read: its rows, and the largest page of any
    /// column.
    pub(super) fn check_group(
        &mut self,
        group: &RowGroupMetaData,
        columns: &[usize],
    ) -> Result<(), Refusal> {
        /// Memory per number: the number itself and, while its column is read, its stored form and
        /// level, in vectors that grow.
        const READ: u128 = 64;
        let rows = u128::try_from(group.num_rows()).map_err(|_| damaged())?;
        let numbers = rows * (8 * columns.len() as u128 + READ);
        self.check(numbers, format_args!("a group of {rows} rows"))?;
        for column in columns {
            let chunk = group.columns().get(*column).ok_or_else(damaged)?;
            check_codec(chunk)?;
            let page = self.largest_page(chunk)?;
            self.check(numbers + page, "a page of a column")?;
        }
        Ok(())
    }

    /// Memory for the largest page of a column. A dictionary and a data page are held at the same
    /// time.
    fn largest_page(&mut self, chunk: &ColumnChunkMetaData) -> Result<u128, Refusal> {
        // `byte_range` panics if one of these is negative.
        let first = chunk.dictionary_page_offset();
        if [
            first.unwrap_or_default(),
            chunk.data_page_offset(),
            chunk.compressed_size(),
        ]
        .iter()
        .any(|number| *number < 0)
        {
            return Err(damaged());
        }
        let (start, length) = chunk.byte_range();
        let end = start.checked_add(length).filter(|end| *end <= self.length);
        let end = end.ok_or_else(damaged)?;
        let (mut at, mut largest) = (start, 0);
        while at < end {
            let (page, header) = self.page(at, end)?;
            at += header;
            let unpacked = self.unpacked(chunk.compression(), &page, at)?;
            largest = largest.max(u128::from(page.packed) + unpacked + page.dictionary());
            at += page.packed;
        }
        Ok(2 * largest)
    }

    /// The header of the page at `at`, in a column that ends at `end`; and the length of that
    /// header.
    fn page(&mut self, at: u64, end: u64) -> Result<(Page, u64), Refusal> {
        // The second window is for headers with long statistics.
        for window in [1 << 9, 1 << 20] {
            let bytes = self.bytes(at, (end - at).min(window) as usize)?;
            let mut rest = Compact(&bytes);
            if let Some(page) = Page::read(&mut rest) {
                let header = (bytes.len() - rest.0.len()) as u64;
                let fits = page.packed <= end - at - header;
                return fits.then_some((page, header)).ok_or_else(damaged);
            }
        }
        Err(damaged())
    }

    /// The size of a page when it is unpacked. Two codecs do not stop at the size in the header.
    fn unpacked(&mut self, codec: Compression, page: &Page, at: u64) -> Result<u128, Refusal> {
        let said = u128::from(page.unpacked);
        let packed = u128::from(page.packed);
        match codec {
            // LZ4 can expand data at most 255 times. Refuse the page if even that could be too
            // much.
            Compression::LZ4 => Ok(said.max(255 * packed)),
            Compression::GZIP(_) if 1032 * packed > u128::from(self.budget.left()) => {
                self.check(packed, "a page of a column")?;
                let bytes = self.bytes(at, page.packed as usize)?;
                let unpacked = flate2::read::MultiGzDecoder::new(&bytes[..]);
                let mut more = unpacked.take(page.unpacked + 1);
                let length = std::io::copy(&mut more, &mut std::io::sink())?;
                match length > page.unpacked {
                    true => Err(damaged()),
                    false => Ok(said),
                }
            }
            Compression::GZIP(_) => Ok(said.max(1032 * packed)),
            _ => Ok(said),
        }
    }

    fn bytes(&mut self, start: u64, length: usize) -> Result<Vec<u8>, Refusal> {
        let mut bytes = vec![0; length];
        self.file.seek(SeekFrom::Start(start))?;
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    fn check(&self, bytes: u128, what: impl std::fmt::Display) -> Result<(), Refusal> {
        self.budget.check(bytes, what).map_err(Refusal::TooLarge)
    }

    fn take(&mut self, bytes: u128, what: &str) -> Result<(), Refusal> {
        self.budget.take(bytes, what).map_err(Refusal::TooLarge)
    }
}

/// Refuses a column that is packed with a codec that is not read.
fn check_codec(chunk: &ColumnChunkMetaData) -> Result<(), Refusal> {
    let codec = match chunk.compression() {
        Compression::BROTLI(_) => "Brotli",
        Compression::LZO => "LZO",
        // It is C, and not in a browser.
        Compression::ZSTD(_) if cfg!(target_family = "wasm") => "Zstandard",
        _ => return Ok(()),
    };
    let column = chunk.column_path().string();
    Err(Refusal::Unread(format!(
        "column `{column}` is packed with {codec}, which is not read here: write the file with \
         Snappy, gzip or LZ4, or without compression"
    )))
}

/// The sizes in the header of a page.
#[derive(Default)]
struct Page {
    packed: u64,
    unpacked: u64,
    /// Number of values in a dictionary.
    values: u64,
}

impl Page {
    fn read(bytes: &mut Compact<'_>) -> Option<Self> {
        let mut page = Self::default();
        bytes.fields(|rest, id, kind| {
            let size = |rest: &mut Compact<'_>| u64::try_from(rest.integer()?).ok();
            match id {
                2 => page.unpacked = size(rest)?,
                3 => page.packed = size(rest)?,
                7 => rest.fields(|rest, id, kind| {
                    match id {
                        1 => page.values = size(rest)?,
                        _ => rest.skip(kind)?,
                    }
                    Some(())
                })?,
                _ => rest.skip(kind)?,
            }
            Some(())
        })?;
        Some(page)
    }

    /// Memory for its values as a dictionary.
    fn dictionary(&self) -> u128 {
        16 * u128::from(self.values)
    }
}

/// The nesting depth of the columns in a footer; unlimited if a column claims more parts than there
/// are columns. `None` if the footer cannot be parsed.
fn nesting(footer: &[u8]) -> Option<usize> {
    let (mut deepest, mut open) = (0, Vec::new());
    Compact(footer).fields(|rest, id, kind| {
        if id != 2 {
            return rest.skip(kind);
        }
        let columns = rest.list()?.0;
        for _ in 0..columns {
            let mut children = 0;
            rest.fields(|rest, id, kind| {
                match id {
                    5 => children = rest.integer()?,
                    _ => rest.skip(kind)?,
                }
                Some(())
            })?;
            while open.last() == Some(&0) {
                open.pop();
            }
            if let Some(siblings) = open.last_mut() {
                *siblings -= 1;
            }
            if children > 0 {
                open.push(children);
            }
            deepest = match children > 0 && children as u64 > columns {
                true => usize::MAX,
                false => deepest.max(open.len()),
            };
        }
        Some(())
    })?;
    Some(deepest)
}
