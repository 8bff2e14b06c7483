//! The records that a long work has made so far, in a file beside its target. A work that was killed
//! goes on with them.
//!
//! The first line names the program, and a key: what the records depend on besides their own keys.
//! Then come the records: their length, a checksum, the record's key, its values. A record that was
//! cut off ends the file.

use super::{Kind, Value};
use crate::error::{Error, Result};
use hysteron_files::Locked;
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::fs::OpenOptions;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

const MARK: &str = "hysteron partial results 1 ";
/// Length, checksum, key.
const HEAD: usize = 4 + 8 + 32;
/// The longest record: some thousand times the usual one.
const LONGEST: u32 = 1 << 30;

/// Where a record is in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Entry {
    at: u64,
    length: u32,
}

/// Digest of what a record was made from.
pub(crate) type Key = [u8; 32];

type Sum = [u8; 8];

/// An open file of records.
pub(crate) struct Partial {
    path: PathBuf,
    file: Locked,
    end: u64,
    known: HashMap<Key, Entry>,
}

impl Partial {
    /// Opens the file beside `target`, with its records if it was made for the same `key`.
    /// Otherwise it starts empty.
    ///
    /// # Errors
    /// [`Error::File`] for a file of another program there, or one that another process writes.
    pub(crate) fn beside(target: &Path, key: &str) -> Result<Self> {
        let mut path = target.as_os_str().to_owned();
        path.push(".partial");
        let path = PathBuf::from(path);
        Self::open(&path, key).map_err(|source| Error::File { path, source })
    }

    fn open(path: &Path, key: &str) -> io::Result<Self> {
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(false);
        let mut file = Locked::new(file.open(path)?)?;
        let head = format!("{MARK}{key}\n");
        let length = file.metadata()?.len();
        let mut found = Vec::new();
        (&mut *file)
            .take(head.len() as u64)
            .read_to_end(&mut found)?;
        let ours = found.starts_with(MARK.as_bytes()) || MARK.as_bytes().starts_with(&found);
        if !ours {
            return Err(io::Error::new(
                io::ErrorKind::AlreadyExists,
                "this file is not one of hysteron: move it away",
            ));
        }
        let mut partial = Self {
            path: path.to_owned(),
            file,
            end: head.len() as u64,
            known: HashMap::new(),
        };
        match found == head.as_bytes() {
            true => partial.read_known(length)?,
            false => {
                partial.file.set_len(0)?;
                partial.file.rewind()?;
                partial.file.write_all(head.as_bytes())?;
            }
        }
        Ok(partial)
    }

    /// Reads the keys of all whole records, and cuts off the rest.
    fn read_known(&mut self, length: u64) -> io::Result<()> {
        let mut file = BufReader::with_capacity(1 << 20, &mut *self.file);
        let mut record = Vec::new();
        let mut head = [0; HEAD];
        while file.read_exact(&mut head).is_ok() {
            let Some((size, sum, key)) = split(&head) else {
                break;
            };
            let end = self.end + HEAD as u64 + u64::from(size);
            if size > LONGEST || end > length {
                break;
            }
            record.resize(size as usize, 0);
            file.read_exact(&mut record)?;
            if sum != checksum(&key, &record) {
                break;
            }
            let entry = Entry {
                at: self.end + HEAD as u64,
                length: size,
            };
            self.known.insert(key, entry);
            self.end = end;
        }
        drop(file);
        self.file.set_len(self.end)
    }

    /// Number of records that were there when the file was opened.
    #[cfg(test)]
    pub(crate) fn found(&self) -> usize {
        self.known.len()
    }

    /// The record that was made from the same, if it is there.
    pub(crate) fn known(&self, key: &Key) -> Option<Entry> {
        self.known.get(key).copied()
    }

    /// Adds a record.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn add(&mut self, key: &Key, values: &[Value]) -> Result<Entry> {
        let mut bytes = vec![0; HEAD];
        for value in values {
            encode(value, &mut bytes);
        }
        let (head, record) = bytes.split_at_mut(HEAD);
        let length = u32::try_from(record.len()).unwrap_or(u32::MAX);
        head[..4].copy_from_slice(&length.to_le_bytes());
        head[4..12].copy_from_slice(&checksum(key, record));
        head[12..].copy_from_slice(key);
        let entry = Entry {
            at: self.end + HEAD as u64,
            length,
        };
        let added = self.file.seek(SeekFrom::Start(self.end));
        let added = added.and_then(|_| self.file.write_all(&bytes));
        added.map_err(|source| self.failed(source))?;
        self.end += bytes.len() as u64;
        Ok(entry)
    }

    /// The values of a record.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn read(&mut self, entry: Entry) -> Result<Vec<Value>> {
        let mut bytes = vec![0; entry.length as usize];
        let read = self.file.seek(SeekFrom::Start(entry.at));
        let read = read.and_then(|_| self.file.read_exact(&mut bytes));
        read.map_err(|source| self.failed(source))?;
        let mut values = Vec::new();
        let mut rest = &bytes[..];
        while !rest.is_empty() {
            let value = decode(&mut rest);
            let damaged = || self.failed(io::Error::from(io::ErrorKind::InvalidData));
            values.push(value.ok_or_else(damaged)?);
        }
        Ok(values)
    }

    /// Removes the file: the work is complete.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn remove(self) -> Result<()> {
        std::fs::remove_file(&self.path).map_err(|source| self.failed(source))
    }

    fn failed(&self, source: io::Error) -> Error {
        Error::File {
            path: self.path.clone(),
            source,
        }
    }
}

/// Length, checksum and key of a record.
fn split(head: &[u8; HEAD]) -> Option<(u32, Sum, Key)> {
    let (length, rest) = head.split_first_chunk()?;
    let (sum, rest) = rest.split_first_chunk()?;
    let (key, _) = rest.split_first_chunk()?;
    Some((u32::from_le_bytes(*length), *sum, *key))
}

/// The first bytes of the SHA-256 of key and record.
fn checksum(key: &Key, record: &[u8]) -> Sum {
    let digest = Sha256::new().chain_update(key).chain_update(record);
    let mut sum = Sum::default();
    for (byte, found) in sum.iter_mut().zip(digest.finalize()) {
        *byte = found;
    }
    sum
}

fn encode(value: &Value, bytes: &mut Vec<u8>) {
    let (kind, count) = match value {
        Value::None => (0, 0),
        Value::Text(text) => (kind_code(Kind::Text), text.len()),
        Value::Number(_) => (kind_code(Kind::Number), 1),
        Value::Integer(_) => (kind_code(Kind::Integer), 1),
        Value::Numbers(numbers) => (kind_code(Kind::Numbers), numbers.len()),
    };
    bytes.push(kind);
    bytes.extend((count as u32).to_le_bytes());
    match value {
        Value::None => {}
        Value::Text(text) => bytes.extend(text.as_bytes()),
        Value::Number(number) => bytes.extend(number.to_le_bytes()),
        Value::Integer(integer) => bytes.extend(integer.to_le_bytes()),
        Value::Numbers(numbers) => bytes.extend(numbers.iter().flat_map(|n| n.to_le_bytes())),
    }
}

fn kind_code(kind: Kind) -> u8 {
    match kind {
        Kind::Text => 1,
        Kind::Number => 2,
        Kind::Integer => 3,
        Kind::Numbers => 4,
    }
}

fn decode(bytes: &mut &[u8]) -> Option<Value> {
    let (kind, rest) = bytes.split_first()?;
    let (count, rest) = rest.split_first_chunk::<4>()?;
    let count = u32::from_le_bytes(*count) as usize;
    let size = if *kind == 1 { count } else { 8 * count };
    let (cell, rest) = rest.split_at_checked(size)?;
    *bytes = rest;
    let eights = cell.as_chunks::<8>().0;
    Some(match kind {
        0 => Value::None,
        1 => Value::Text(String::from_utf8(cell.to_vec()).ok()?),
        2 => Value::Number(f64::from_le_bytes(*eights.first()?)),
        3 => Value::Integer(i64::from_le_bytes(*eights.first()?)),
        4 => Value::Numbers(
            eights
                .iter()
                .map(|bytes| f64::from_le_bytes(*bytes))
                .collect(),
        ),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn record(n: usize) -> Vec<Value> {
        vec![
            Value::Text(format!("actuator {n} µ")),
            Value::None,
            Value::Number(1.0 / n as f64),
            Value::Integer(-(n as i64)),
            Value::Numbers((0..n).map(|k| k as f64 / 7.0).collect()),
        ]
    }

    /// Whatever byte the file was cut at, the whole records before it are found, and others can be
    /// added behind them.
    #[test]
    fn a_file_cut_anywhere_keeps_what_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("models.parquet");
        let path = folder.path().join("models.parquet.partial");
        let mut ends = Vec::new();
        let mut partial = Partial::beside(&target, "key").unwrap();
        for n in 0..5 {
            let entry = partial.add(&[n as u8; 32], &record(n)).unwrap();
            ends.push(entry.at + u64::from(entry.length));
        }
        drop(partial);
        let whole = std::fs::read(&path).unwrap();
        for cut in 0..=whole.len() {
            std::fs::write(&path, &whole[..cut]).unwrap();
            let mut partial = Partial::beside(&target, "key").unwrap();
            let expected = ends.iter().filter(|end| **end <= cut as u64).count();
            assert_eq!(partial.found(), expected, "cut at {cut}");
            for n in 0..expected {
                let entry = partial.known(&[n as u8; 32]).unwrap();
                assert_eq!(partial.read(entry).unwrap(), record(n));
            }
            let entry = partial.add(&[9; 32], &record(9)).unwrap();
            drop(partial);
            let mut partial = Partial::beside(&target, "key").unwrap();
            assert_eq!(partial.known(&[9; 32]), Some(entry));
            assert_eq!(partial.read(entry).unwrap(), record(9));
        }
    }

    #[test]
    fn records_of_another_key_or_damaged_ones_are_not_taken() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("models.parquet");
        let path = folder.path().join("models.parquet.partial");
        let mut partial = Partial::beside(&target, "key").unwrap();
        partial.add(&[1; 32], &record(3)).unwrap();
        assert!(Partial::beside(&target, "key").is_err(), "two writers");
        drop(partial);
        let whole = std::fs::read(&path).unwrap();
        for n in MARK.len() + 4..whole.len() {
            let mut damaged = whole.clone();
            damaged[n] ^= 1;
            std::fs::write(&path, &damaged).unwrap();
            assert_eq!(Partial::beside(&target, "key").unwrap().found(), 0, "{n}");
        }
        std::fs::write(&path, &whole).unwrap();
        assert_eq!(Partial::beside(&target, "yek").unwrap().found(), 0);
        std::fs::write(&path, "mine").unwrap();
        assert!(Partial::beside(&target, "key").is_err());
        assert_eq!(std::fs::read(&path).unwrap(), b"mine");
    }
}
