//! Carries a model to where it runs: C99 for a microcontroller ([`c()`]), an FMU for Simulink and other tools ([`fmu()`]).
#![forbid(unsafe_code)]

mod c;
mod fmu;

pub use c::{CExport, CMemory, COptions, CReal, CWorstCase, c};
pub use fmu::{Fmi, Fmu, FmuOptions, fmu};

use hysteron::{Error, Model, Result};

/// Refuses what runs nowhere but here: a model is exported at one load and without a thermal body.
fn check(model: &Model) -> Result<()> {
    if model.thermal.is_some() {
        let text = "the model has a thermal body, which needs the time of each sample: only the model behind it can be exported";
        return Err(Error::Export(text.into()));
    }
    if let Some(load) = &model.load {
        let (low, high) = load.range();
        let name = &load.quantity.name;
        let text = format!(
            "the model depends on the load `{name}`: name one with --load, from {low} to {high}"
        );
        return Err(Error::Export(text));
    }
    Ok(())
}
