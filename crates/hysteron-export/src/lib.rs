//! Exports models: as C99 for a microcontroller ([`c()`]), as a library for Arduino ([`arduino()`]), as
//! an FMU for Simulink and other tools
//! ([`fmu()`]).
#![forbid(unsafe_code)]

mod arduino;
mod c;
mod device;
mod fmu;

use hysteron::Model;

pub use arduino::{Arduino, ArduinoOptions, Board, BoardMemory, arduino};
pub use c::{
    CExport, CMemory, COptions, CReal, CSampling, CWorstCase, c, c_controlled, c_sampled, c_texts,
};
pub use fmu::{Fmi, Fmu, FmuOptions, fmu, fmu_bytes};

/// What an export leaves to its caller where the model has a dead time ([`Model::delay`]): the code
/// and the block take the inputs as they act. In samples of `dt` (s), or of the recording.
#[must_use]
pub fn delay_note(model: &Model, dt: Option<f64>) -> Option<String> {
    let (samples, seconds) = (model.delay().at(dt), model.delay().seconds());
    (seconds > 0.0).then(|| {
        // A clock is rounded; a nanosecond is no part of a time that one gives.
        let seconds = (seconds * 1e9).round() / 1e9;
        format!(
            "the inputs are taken as they act: shift them by the dead time, {seconds} s or {samples} \
             samples, before a step, and give those of the inverse so much earlier"
        )
    })
}
