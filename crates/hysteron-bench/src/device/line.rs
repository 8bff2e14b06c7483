//! What all ways to a device have in common.

use std::io;
use std::time::Instant;

/// What came from a device.
#[derive(Debug, Clone, PartialEq)]
pub enum Received {
    /// A line without its end, and when it came.
    Line(Vec<u8>, Instant),
    /// Nothing until the deadline.
    Silence,
    /// The line is gone.
    Closed,
}

/// A line to a device.
pub trait Line {
    /// Sends a line with its end. It never waits: a device that does not read is an error.
    ///
    /// # Errors
    /// Those of the operating system, and [`io::ErrorKind::WouldBlock`].
    fn send(&mut self, line: &str) -> io::Result<()>;
    /// Waits for the next line until a deadline. What is longer than a line can be comes cut.
    fn receive(&mut self, deadline: Instant) -> Received;
    /// Closes the line at `deadline` at the latest, and ends what the run has begun. How it had
    /// ended before, if it had.
    fn close(self: Box<Self>, deadline: Instant) -> Option<String>;
}
