//! The binary of an FMU: the functions of FMI 2.0 and 3.0 for co-simulation, one library for every
//! model.
//!
//! The model comes from `resources/model.txt` of the FMU. Instances and saved states, which are
//! pointers in the standards, are handles here. A handle that was freed or never given is refused.
//! No panic leaves a function.
//!
//! FMI 2.0.4 and 3.0.1, Modelica Association, <https://fmi-standard.org>.

#[cfg(not(target_pointer_width = "64"))]
compile_error!("handles stand where the standards have pointers: 64 bits are needed");

mod block;
mod by_load;
mod calls;
mod controller;
pub mod fmi2;
pub mod fmi3;
mod instance;
mod lines;
mod location;
mod logger;
mod resource;
mod settings;
mod snapshot;
mod stages;
mod state;
mod states;
mod values;

use crate::fault::Fault;
use std::fmt;

/// The status of a function. The numbers are the same in FMI 2.0 and 3.0.
pub type Status = i32;
/// `fmi2OK`, `fmi3OK`
pub const OK: Status = 0;
/// `fmi2Discard`, `fmi3Discard`
pub const DISCARD: Status = 2;
/// `fmi2Error`, `fmi3Error`
pub const ERROR: Status = 3;
/// `fmi2Fatal`, `fmi3Fatal`
pub const FATAL: Status = 4;

/// Why a call failed, for the log.
#[derive(Debug)]
pub(crate) struct Problem(String);

pub(crate) type Result<T> = std::result::Result<T, Problem>;

impl Problem {
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl From<Fault> for Problem {
    fn from(fault: Fault) -> Self {
        Self(fault.to_string())
    }
}

impl From<hysteron_core::Error> for Problem {
    fn from(error: hysteron_core::Error) -> Self {
        Self(error.to_string())
    }
}

/// FNV-1a. Changing one byte always changes it.
pub(crate) fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
