//! The messages of an Arrow file or stream. An Arrow file is a stream between two marks, with a list
//! of its parts at the end that is not needed to read it in order.

use crate::data::table::budget::Budget;
use crate::data::table::quiet;
use crate::data::table::stored::ReadSeek;
use arrow_array::{ArrayRef, RecordBatch};
use arrow_buffer::{Buffer, MutableBuffer};
use arrow_ipc::convert::try_fb_to_schema;
use arrow_ipc::reader::{read_dictionary, read_record_batch};
use arrow_ipc::{Message, MessageHeader, MetadataVersion, root_as_message};
use arrow_schema::{ArrowError, SchemaRef};
use std::collections::HashMap;
use std::fmt::Display;
use std::io::SeekFrom;
use std::sync::Arc;
use std::vec::IntoIter;

/// The first bytes of an Arrow file (Feather of version 2).
pub(in crate::data) const FILE: &[u8] = b"ARROW1";
/// The first bytes of an Arrow stream, and of each message.
pub(in crate::data) const STREAM: &[u8] = b"\xff\xff\xff\xff";

/// Zeros stand between the mark of a file and its first message, up to so many bytes in all.
const MOST_PADDING: u64 = 64;

/// The parts of a table, one after the other. The sizes that they claim are compared with the bytes
/// that are there, and with the memory that may be taken, before any is taken.
pub(in crate::data) struct Batches {
    input: Box<dyn ReadSeek>,
    budget: Budget,
    schema: SchemaRef,
    dictionaries: HashMap<i64, ArrayRef>,
    messages: IntoIter<Place>,
    rows: u64,
}

/// Where a message is: its beginning, and the lengths of what describes it and of its body.
struct Place {
    start: u64,
    about: usize,
    body: usize,
}

impl Batches {
    /// Finds the messages of an input that is `length` bytes long.
    pub(in crate::data) fn open(
        mut input: Box<dyn ReadSeek>,
        length: u64,
        budget: Budget,
    ) -> Result<Self, String> {
        let head = bytes(&mut input, 0, length.min(MOST_PADDING) as usize)?;
        let is_file = head.starts_with(FILE);
        let mut at = match is_file {
            false => 0,
            true => {
                let after = head.get(8..).unwrap_or_default();
                let padding = after.iter().take_while(|byte| **byte == 0).count();
                8 + padding as u64
            }
        };
        let (mut schema, mut messages, mut rows) = (None, Vec::new(), 0_u64);
        loop {
            // A stream may end without its last mark.
            if !is_file && at == length {
                break;
            }
            let left = length.saturating_sub(at + 8);
            let head = bytes(&mut input, at, 8)?;
            let (mark, about) = head.split_at(4);
            if mark != STREAM {
                return Err(damaged("a message has no mark"));
            }
            let about = about.try_into().map_or(0, u32::from_le_bytes);
            if about == 0 {
                break;
            }
            if u64::from(about) > left {
                return Err(damaged("a message goes beyond its end"));
            }
            let about = about as usize;
            budget.check(about as u128, "the list of its columns")?;
            let described = bytes(&mut input, at + 8, about)?;
            let message = parsed(&described)?;
            let body = u64::try_from(message.bodyLength())
                .ok()
                .filter(|body| *body <= left - about as u64)
                .ok_or_else(|| damaged("a message goes beyond its end"))?;
            let start = at + 8;
            at = start + about as u64 + body;
            match (message.header_type(), &schema) {
                (MessageHeader::Schema, None) => {
                    let found = message.header_as_schema().ok_or_else(no_header)?;
                    let found = caught(|| try_fb_to_schema(found))?;
                    schema = Some(Arc::new(found));
                    continue;
                }
                (MessageHeader::RecordBatch, Some(_)) => {
                    let batch = message.header_as_record_batch().ok_or_else(no_header)?;
                    let more = u64::try_from(batch.length()).ok();
                    let all = more.and_then(|more| rows.checked_add(more));
                    rows = all.ok_or_else(|| damaged("a number of rows is negative"))?;
                }
                (MessageHeader::DictionaryBatch, Some(_)) => {}
                _ => return Err(damaged("its messages are not those of a table")),
            }
            let body = usize::try_from(body).map_err(damaged)?;
            messages.push(Place { start, about, body });
        }
        Ok(Self {
            input,
            budget,
            schema: schema.ok_or_else(|| damaged("it has no columns"))?,
            dictionaries: HashMap::new(),
            messages: messages.into_iter(),
            rows,
        })
    }

    pub(in crate::data) fn schema(&self) -> &SchemaRef {
        &self.schema
    }

    /// Number of rows of all parts.
    pub(in crate::data) fn rows(&self) -> u64 {
        self.rows
    }

    /// The next part: all its columns, or those of these places. `None` at the end.
    pub(in crate::data) fn next(
        &mut self,
        columns: Option<&[usize]>,
    ) -> Result<Option<RecordBatch>, String> {
        while let Some(place) = self.messages.next() {
            let about = bytes(&mut self.input, place.start, place.about)?;
            let message = parsed(&about)?;
            self.budget
                .check(place.body as u128, "a part of the table")?;
            let mut body = MutableBuffer::from_len_zeroed(place.body);
            let start = place.start + place.about as u64;
            read_at(&mut self.input, start, &mut body)?;
            let body = Buffer::from(body);
            let version = message.version();
            if let Some(batch) = message.header_as_dictionary_batch() {
                let data = batch.data().ok_or_else(no_header)?;
                let size = unpacked(data, &body)?;
                self.budget.take(size, "a dictionary")?;
                let (schema, known) = (&self.schema, &mut self.dictionaries);
                caught(|| read_dictionary(&body, batch, schema, known, &version))?;
                continue;
            }
            let batch = message.header_as_record_batch().ok_or_else(no_header)?;
            let read = columns.map_or(self.schema.fields().len(), <[usize]>::len);
            self.check(batch, &body, read)?;
            return self.decoded(&body, batch, columns, version).map(Some);
        }
        Ok(None)
    }

    /// Compares the memory that a part takes with what there is.
    fn check(
        &self,
        batch: arrow_ipc::RecordBatch<'_>,
        body: &Buffer,
        columns: usize,
    ) -> Result<(), String> {
        let rows = u128::try_from(batch.length()).map_err(damaged)?;
        // A column of nothing takes no bytes in the file.
        let numbers = rows * (8 * columns as u128 + 8);
        let size = body.len() as u128 + unpacked(batch, body)? + numbers;
        self.budget
            .check(size, format_args!("a part of {rows} rows"))
    }

    fn decoded(
        &self,
        body: &Buffer,
        batch: arrow_ipc::RecordBatch<'_>,
        columns: Option<&[usize]>,
        version: MetadataVersion,
    ) -> Result<RecordBatch, String> {
        let (schema, known) = (self.schema.clone(), &self.dictionaries);
        caught(|| read_record_batch(body, batch, schema, known, columns, &version))
    }
}

/// The size of a body when its buffers are unpacked; they begin with it.
fn unpacked(batch: arrow_ipc::RecordBatch<'_>, body: &[u8]) -> Result<u128, String> {
    let Some(buffers) = batch.compression().and(batch.buffers()) else {
        return Ok(body.len() as u128);
    };
    let mut sum = 0;
    for buffer in buffers.iter().filter(|buffer| buffer.length() > 0) {
        let start = usize::try_from(buffer.offset()).map_err(damaged)?;
        let size = body.get(start..).and_then(<[u8]>::first_chunk);
        let size = i64::from_le_bytes(*size.ok_or_else(|| damaged("a column is cut off"))?);
        // A size of -1 marks a buffer that is stored as it is.
        sum += u128::try_from(size).unwrap_or(buffer.length() as u128);
    }
    Ok(sum)
}

fn parsed(about: &[u8]) -> Result<Message<'_>, String> {
    root_as_message(about).map_err(damaged)
}

fn bytes(input: &mut Box<dyn ReadSeek>, start: u64, length: usize) -> Result<Vec<u8>, String> {
    let mut bytes = vec![0; length];
    read_at(input, start, &mut bytes)?;
    Ok(bytes)
}

fn read_at(input: &mut Box<dyn ReadSeek>, start: u64, bytes: &mut [u8]) -> Result<(), String> {
    input.seek(SeekFrom::Start(start)).map_err(damaged)?;
    input.read_exact(bytes).map_err(damaged)
}

fn no_header() -> String {
    damaged("it contradicts itself")
}

/// Calls the Arrow library. It panics if a damaged file contradicts itself; the panic becomes an
/// error.
pub(in crate::data) fn caught<T>(
    use_it: impl FnOnce() -> Result<T, ArrowError>,
) -> Result<T, String> {
    quiet::caught(use_it)
        .ok_or_else(no_header)?
        .map_err(damaged)
}

fn damaged(error: impl Display) -> String {
    format!("the Arrow file is damaged or cut off ({error}): write or copy it again")
}
