//! The log: a row for each sample, on the disk before the next sample comes.

use crate::companion::Companion;
use crate::error::{Result, of_file};
use hysteron::{TableReader, TableWriter};
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A table of text that grows row by row. Parquet is written from it at the end, since a file of
/// columns is whole only then; if that fails, the rows are still there.
pub(crate) struct Log {
    path: PathBuf,
    rows: PathBuf,
    file: File,
    /// Bytes of whole rows.
    whole: u64,
}

fn is_parquet(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"))
}

/// Where the rows of a log stand while it is written.
pub(crate) fn rows_of(path: &Path) -> PathBuf {
    match is_parquet(path) {
        true => {
            let mut name = path.as_os_str().to_owned();
            name.push(".rows.csv");
            name.into()
        }
        false => path.to_owned(),
    }
}

/// Whether a log can have this name, and may replace what is there.
///
/// # Errors
/// [`hysteron::Error::File`].
pub(crate) fn claim(path: &Path, force: bool) -> Result<()> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    let regular = std::fs::metadata(path).map(|there| there.is_file());
    let special = matches!(regular, Ok(false));
    if !special && !matches!(ending.as_deref(), Some("csv" | "parquet")) {
        let what = "a log is a table: let its name end with .csv or .parquet";
        return Err(of_file(path, io::Error::other(what)));
    }
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    if folder.is_some_and(|folder| !folder.is_dir()) {
        let what = "there is no such folder to write to";
        return Err(of_file(path, io::Error::new(io::ErrorKind::NotFound, what)));
    }
    let rows = rows_of(path);
    if !force && is_parquet(path) && rows.exists() {
        let what = "these are the rows of a run that was killed: go on with --resume, or lose them";
        return Err(of_file(
            &rows,
            io::Error::new(io::ErrorKind::AlreadyExists, what),
        ));
    }
    match force || special || regular.is_err() || Companion::knows(path) {
        true => Ok(()),
        false => {
            let what = "this file is not a log of hysteron, or it was changed since";
            Err(of_file(
                path,
                io::Error::new(io::ErrorKind::AlreadyExists, what),
            ))
        }
    }
}

/// Refuses to go on with a log of columns that is whole: only its rows could be added to.
///
/// # Errors
/// [`hysteron::Error::File`].
pub(crate) fn resumable(path: &Path) -> Result<()> {
    match is_parquet(path) && !rows_of(path).exists() {
        false => Ok(()),
        true => {
            let what = "a Parquet file that is whole cannot be added to: log to a .csv to resume";
            Err(of_file(path, io::Error::other(what)))
        }
    }
}

impl Log {
    /// A new log with a first row of names.
    ///
    /// # Errors
    /// [`hysteron::Error::File`].
    pub(crate) fn create(path: &Path, columns: &[String]) -> Result<Self> {
        let rows = rows_of(path);
        let failed = |source| of_file(path, source);
        let file = File::create(&rows).map_err(failed)?;
        let mut log = Self {
            path: path.to_owned(),
            rows,
            file,
            whole: 0,
        };
        log.row(columns).map_err(failed)?;
        Ok(log)
    }

    /// Goes on with a log. Half a row at its end, as a kill leaves it, is dropped.
    ///
    /// # Errors
    /// [`hysteron::Error::File`].
    pub(crate) fn reopen(path: &Path) -> Result<Self> {
        let rows = rows_of(path);
        let failed = |source| of_file(&rows, source);
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .open(&rows)
            .map_err(failed)?;
        let whole = whole_rows(&mut file).map_err(failed)?;
        file.set_len(whole).map_err(failed)?;
        file.seek(SeekFrom::Start(whole)).map_err(failed)?;
        Ok(Self {
            path: path.to_owned(),
            rows: rows.clone(),
            file,
            whole,
        })
    }

    /// Where the rows stand.
    pub(crate) fn rows(&self) -> &Path {
        &self.rows
    }

    /// Adds a row; none or all of it.
    pub(crate) fn row(&mut self, cells: &[String]) -> io::Result<()> {
        let line = cells.join(",") + "\n";
        let written = self.file.write_all(line.as_bytes());
        match written {
            Ok(()) => self.whole += line.len() as u64,
            Err(_) => {
                // A device file has no length.
                let _ = self.file.set_len(self.whole);
                let _ = self.file.seek(SeekFrom::Start(self.whole));
            }
        }
        written
    }

    /// Ends the log, and gives its length.
    ///
    /// # Errors
    /// [`hysteron::Error::File`].
    pub(crate) fn finish(self) -> Result<u64> {
        // Pipes and devices cannot be synced.
        if self.file.metadata().is_ok_and(|file| file.is_file()) {
            self.file
                .sync_all()
                .map_err(|source| of_file(&self.rows, source))?;
        }
        if is_parquet(&self.path) {
            as_parquet(&self.rows, &self.path)?;
            std::fs::remove_file(&self.rows).map_err(|source| of_file(&self.rows, source))?;
        }
        Ok(std::fs::metadata(&self.path).map_or(0, |file| file.len()))
    }
}

/// Whether a log at this path can have a companion.
pub(crate) fn is_file(path: &Path) -> bool {
    std::fs::metadata(path).map_or(true, |there| there.is_file())
}

/// Length of a file up to its last end of a line.
fn whole_rows(file: &mut File) -> io::Result<u64> {
    const BLOCK: u64 = 4096;
    let mut end = file.metadata()?.len();
    while end > 0 {
        let start = end.saturating_sub(BLOCK);
        let mut block = vec![0; (end - start) as usize];
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(&mut block)?;
        if let Some(at) = block.iter().rposition(|byte| *byte == b'\n') {
            return Ok(start + at as u64 + 1);
        }
        end = start;
    }
    Ok(0)
}

fn as_parquet(rows: &Path, path: &Path) -> Result<()> {
    let mut table = TableReader::open(rows)?;
    let mut written = TableWriter::plain(Some(path.into()))?;
    written.row(table.header().to_vec())?;
    while table.advance()? {
        let cells = table.row().cells().map(|cell| match cell {
            b"nan" => Vec::new(),
            cell => cell.to_vec(),
        });
        written.row(cells.collect::<Vec<_>>())?;
    }
    Ok(written.finish()?)
}
