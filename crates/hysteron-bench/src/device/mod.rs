//! The ways to a device. All carry the same lines.

mod child;
mod serial;
mod simulated;
mod tcp;
mod wires;

use crate::config::Config;
use crate::error::{Error, Result};
use std::io;
use std::time::Instant;

pub use simulated::Simulated;

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

/// The device that a file names, for people.
pub(crate) fn name(config: &Config) -> String {
    let device = &config.device;
    let command = device
        .command
        .as_ref()
        .map(|words| format!("`{}`", words.join(" ")));
    let serial = device
        .serial
        .as_ref()
        .map(|port| port.display().to_string());
    let simulated = device
        .simulated
        .as_ref()
        .map(|kind| format!("simulated {kind}"));
    let found = command.or(serial).or(device.tcp.clone()).or(simulated);
    found.unwrap_or_default()
}

/// Opens the line that a file names.
///
/// # Errors
/// [`Error::Device`], and [`Error::Config`] for a plant that does not exist.
pub fn open(config: &Config) -> Result<Box<dyn Line>> {
    let device = &config.device;
    let opened: io::Result<Box<dyn Line>> = if let Some(words) = &device.command {
        child::Child::start(words, config.folder()).map(|child| Box::new(child) as _)
    } else if let Some(port) = &device.serial {
        serial::open(&config.at(port), device.baud.unwrap_or(115_200))
            .map(|port| Box::new(port) as _)
    } else if let Some(address) = &device.tcp {
        tcp::open(address).map(|socket| Box::new(socket) as _)
    } else {
        let kind = device.simulated.as_deref().unwrap_or_default();
        let interval_s = device.interval_s.unwrap_or(0.05);
        let plant = Simulated::new(kind, interval_s, device.seed.unwrap_or(1));
        let plant = plant.map_err(|problem| config.refused("device.simulated", problem))?;
        return Ok(Box::new(plant));
    };
    opened.map_err(|source| Error::Device {
        name: name(config),
        problem: format!("it cannot be opened: {source}"),
    })
}
