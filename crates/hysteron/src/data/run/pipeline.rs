//! Reads, computes and writes a table: three threads, and blocks of rows that go in a circle.
//!
//! A block is filled by the reader, gets its new cells from the work, is written, and goes back to
//! the reader. So memory is bounded by the few blocks that are under way, and order is kept.

use super::Counts;
use super::sink::Sink;
use crate::data::output::{Added, AddedCells, TableWriter};
use crate::data::table::{Block, Column, Needs, TableReader};
use crate::error::Result;
use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::{self, ScopedJoinHandle};

/// Finds the new cells of rows.
pub(super) trait Work: Send {
    /// Adds the cells that are known after these rows: those of rows before them which waited, and
    /// their own. After an error, `cells` holds those of the rows before it.
    ///
    /// # Errors
    /// Those of a model, with the row.
    fn rows(&mut self, block: &Block, cells: &mut AddedCells) -> Result<()>;

    /// Adds the cells of the rows that still wait, at the end of the table.
    ///
    /// # Errors
    /// As [`Work::rows`].
    fn rest(&mut self, cells: &mut AddedCells) -> Result<()>;

    fn counts(&self) -> Counts;
}

/// A block of rows on its way, and new cells: of these rows or of rows before them.
struct Parcel {
    block: Block,
    cells: AddedCells,
}

/// Blocks that may wait before a thread.
const AHEAD: usize = 1;

/// Copies `table` to `out` with the columns `added`, whose cells `work` finds. Reads the numbers of
/// `columns`.
///
/// The error that is returned is the one that comes first in the file: a row is read, computed and
/// written before the rows after it count.
///
/// # Errors
/// Those of the reader, the work and the writer.
pub(super) fn through(
    table: &mut TableReader,
    columns: &[Column],
    out: Option<TableWriter>,
    added: &[Added],
    mut work: impl Work,
    progress: impl Fn(u64),
) -> Result<Counts> {
    let sink = Sink::start(table, out, added)?;
    let needs = sink.needs();
    if needs == Needs::Nothing {
        table.read_only(columns.iter().copied());
    }
    let rows = Rows {
        columns,
        needs,
        added,
    };
    // A page in a browser has no threads of this kind.
    let mut sink = match cfg!(target_family = "wasm") {
        true => in_turn(table, &rows, &mut work, sink, progress)?,
        false => on_threads(table, &rows, &mut work, sink, progress)?,
    };
    let mut rest = AddedCells::of(added);
    let worked = work.rest(&mut rest);
    sink.write(&rest)?;
    worked?;
    sink.finish()?;
    Ok(work.counts())
}

/// What is read of each row, and added to it.
struct Rows<'a> {
    columns: &'a [Column],
    needs: Needs,
    added: &'a [Added],
}

impl Rows<'_> {
    fn parcel(&self) -> Parcel {
        Parcel {
            block: Block::default(),
            cells: AddedCells::of(self.added),
        }
    }

    /// Reads the next rows; false at the end.
    fn read(&self, table: &mut TableReader, parcel: &mut Parcel) -> Result<bool> {
        parcel.cells.clear();
        table.fill(&mut parcel.block, self.columns, self.needs)?;
        Ok(parcel.block.len() > 0)
    }
}

fn in_turn(
    table: &mut TableReader,
    rows: &Rows<'_>,
    work: &mut impl Work,
    mut sink: Sink,
    progress: impl Fn(u64),
) -> Result<Sink> {
    let mut parcel = rows.parcel();
    while rows.read(table, &mut parcel)? {
        let worked = work.rows(&parcel.block, &mut parcel.cells);
        sink.take(&mut parcel.block, &parcel.cells)?;
        worked?;
        progress(table.bytes_read());
    }
    Ok(sink)
}

fn on_threads(
    table: &mut TableReader,
    rows: &Rows<'_>,
    work: &mut impl Work,
    sink: Sink,
    progress: impl Fn(u64),
) -> Result<Sink> {
    let (to_work, read) = sync_channel(AHEAD);
    let (to_sink, worked) = sync_channel(AHEAD);
    let (to_reader, used) = channel();
    thread::scope(|scope| {
        let working = scope.spawn(move || compute(work, &read, &to_sink));
        let writing = scope.spawn(move || write(sink, &worked, &to_reader));
        let read = read_all(table, rows, to_work, &used, progress);
        let worked = joined(working);
        // What was written came before what was computed, and that before what was read.
        let sink = joined(writing)?;
        worked?;
        read?;
        Ok(sink)
    })
}

/// Reads until the end, an error, or the end of the thread that takes the blocks.
fn read_all(
    table: &mut TableReader,
    rows: &Rows<'_>,
    to_work: SyncSender<Parcel>,
    used: &Receiver<Parcel>,
    progress: impl Fn(u64),
) -> Result<()> {
    let (mut spare, mut under_way) = (Vec::new(), 0);
    loop {
        let back = used.try_iter();
        spare.extend(back.inspect(|_| under_way -= 1));
        let mut parcel = spare.pop().unwrap_or_else(|| rows.parcel());
        if !rows.read(table, &mut parcel)? || to_work.send(parcel).is_err() {
            return Ok(());
        }
        under_way += 1;
        progress(table.bytes_read());
        // The next row may come much later. Until then all rows before it are answered, and an
        // error ends the run.
        while table.may_wait() && under_way > 0 {
            let Ok(parcel) = used.recv() else {
                return Ok(());
            };
            spare.push(parcel);
            under_way -= 1;
        }
    }
}

fn compute(
    work: &mut impl Work,
    read: &Receiver<Parcel>,
    to_sink: &SyncSender<Parcel>,
) -> Result<()> {
    for mut parcel in read {
        let worked = work.rows(&parcel.block, &mut parcel.cells);
        if to_sink.send(parcel).is_err() {
            break;
        }
        worked?;
    }
    Ok(())
}

fn write(mut sink: Sink, worked: &Receiver<Parcel>, to_reader: &Sender<Parcel>) -> Result<Sink> {
    for mut parcel in worked {
        sink.take(&mut parcel.block, &parcel.cells)?;
        // After an error the reader takes no more.
        let _ = to_reader.send(parcel);
    }
    Ok(sink)
}

/// What a thread returned; its panic goes on in this thread.
fn joined<T>(thread: ScopedJoinHandle<'_, T>) -> T {
    thread.join().unwrap_or_else(|panic| resume_unwind(panic))
}
