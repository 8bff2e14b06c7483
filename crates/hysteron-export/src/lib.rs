//! Exports models: as C99 for a microcontroller ([`c()`]), as an FMU for Simulink and other tools
//! ([`fmu()`]).
#![forbid(unsafe_code)]

mod c;
mod device;
mod fmu;

pub use c::{CExport, CMemory, COptions, CReal, CSampling, CWorstCase, c, c_sampled, c_texts};
pub use fmu::{Fmi, Fmu, FmuOptions, fmu, fmu_bytes};
