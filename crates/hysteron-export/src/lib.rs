//! Exports models: as C99 for a microcontroller ([`c()`]), as a library for Arduino ([`arduino()`]), as
//! an FMU for Simulink and other tools
//! ([`fmu()`]).
#![forbid(unsafe_code)]

mod arduino;
mod c;
mod device;
mod fmu;

pub use arduino::{Arduino, ArduinoOptions, Board, BoardMemory, arduino};
pub use c::{
    CExport, CMemory, COptions, CReal, CSampling, CWorstCase, c, c_controlled, c_sampled, c_texts,
};
pub use fmu::{Fmi, Fmu, FmuOptions, fmu, fmu_bytes, fmu_controlled};
