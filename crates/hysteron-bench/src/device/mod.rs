//! The ways to a device. All carry the same lines.

mod child;
mod line;
mod serial;
mod simulated;
mod tcp;
mod wires;

use crate::config::Config;
use crate::error::{Error, Result};
use std::io;

pub use line::{Line, Received};
pub use simulated::Simulated;

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
