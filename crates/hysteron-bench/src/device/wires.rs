//! A reader and a writer in threads of their own, so that the loop never waits for either.

use super::line::{Line, Received};
use crate::protocol::LONGEST;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Lines that may wait to be read, and to be written.
const INCOMING: usize = 1024;
const OUTGOING: usize = 256;

/// Both directions of a line.
pub(super) struct Wires {
    incoming: Receiver<(Vec<u8>, Instant)>,
    outgoing: Option<SyncSender<String>>,
    writer: Option<JoinHandle<()>>,
    /// Why the writer has given up.
    broken: Arc<Mutex<Option<String>>>,
    /// Ends a reader that polls.
    closed: Arc<AtomicBool>,
}

impl Wires {
    pub(super) fn new(
        from: impl Read + Send + 'static,
        mut to: impl Write + Send + 'static,
        closed: Arc<AtomicBool>,
    ) -> io::Result<Self> {
        let (came, incoming) = sync_channel(INCOMING);
        let (outgoing, leaving) = sync_channel::<String>(OUTGOING);
        let broken = Arc::new(Mutex::new(None));
        let fault = Arc::clone(&broken);
        thread::Builder::new()
            .name("from the device".into())
            .spawn(move || read(BufReader::new(from), &came))?;
        let writer = thread::Builder::new()
            .name("to the device".into())
            .spawn(move || {
                for line in leaving {
                    let written = to.write_all(line.as_bytes()).and_then(|()| to.flush());
                    if let Err(error) = written {
                        *fault.lock().unwrap_or_else(PoisonError::into_inner) =
                            Some(error.to_string());
                        return;
                    }
                }
            })?;
        Ok(Self {
            incoming,
            outgoing: Some(outgoing),
            writer: Some(writer),
            broken,
            closed,
        })
    }

    /// Lets the writer write what waits, until a deadline, and closes its end.
    pub(super) fn finish(&mut self, deadline: Instant) {
        self.outgoing = None;
        let Some(writer) = self.writer.take() else {
            return;
        };
        while !writer.is_finished() && Instant::now() < deadline {
            thread::sleep(Duration::from_millis(2));
        }
        self.closed.store(true, Ordering::SeqCst);
    }
}

impl Line for Wires {
    fn send(&mut self, line: &str) -> io::Result<()> {
        let broken = self.broken.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(fault) = &*broken {
            return Err(io::Error::new(io::ErrorKind::BrokenPipe, fault.clone()));
        }
        drop(broken);
        let gone = || io::Error::new(io::ErrorKind::BrokenPipe, "it is closed");
        let outgoing = self.outgoing.as_ref().ok_or_else(gone)?;
        outgoing
            .try_send(line.to_owned())
            .map_err(|error| match error {
                TrySendError::Full(_) => {
                    io::Error::new(io::ErrorKind::WouldBlock, "the device does not read")
                }
                TrySendError::Disconnected(_) => gone(),
            })
    }

    fn receive(&mut self, deadline: Instant) -> Received {
        let left = deadline.saturating_duration_since(Instant::now());
        match self.incoming.recv_timeout(left) {
            Ok((line, came)) => Received::Line(line, came),
            Err(RecvTimeoutError::Timeout) => Received::Silence,
            Err(RecvTimeoutError::Disconnected) => Received::Closed,
        }
    }

    fn close(mut self: Box<Self>, deadline: Instant) -> Option<String> {
        self.finish(deadline);
        None
    }
}

/// Hands lines on until the end. A line longer than any can be is cut, so that a flood without ends
/// takes no memory. Half a line at the end is none.
fn read(mut from: impl BufRead, came: &SyncSender<(Vec<u8>, Instant)>) {
    let mut line = Vec::with_capacity(LONGEST + 2);
    loop {
        let (used, ended) = match from.fill_buf() {
            Ok([]) => return,
            Ok(bytes) => {
                let end = bytes.iter().position(|byte| *byte == b'\n');
                let part = &bytes[..end.unwrap_or(bytes.len())];
                let room = (LONGEST + 2).saturating_sub(line.len());
                line.extend_from_slice(&part[..room.min(part.len())]);
                (end.map_or(bytes.len(), |end| end + 1), end.is_some())
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(_) => return,
        };
        from.consume(used);
        if ended
            && came
                .send((std::mem::take(&mut line), Instant::now()))
                .is_err()
        {
            return;
        }
    }
}
