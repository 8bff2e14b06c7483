//! Carries a model to where it runs: C99 for a microcontroller ([`c()`]), an FMU for Simulink and
//! other tools ([`fmu()`]).
#![forbid(unsafe_code)]

mod c;
mod device;
mod fmu;

pub use c::{CExport, CMemory, COptions, CReal, CWorstCase, c};
pub use fmu::{Fmi, Fmu, FmuOptions, fmu};
