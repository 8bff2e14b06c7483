//! **Simulated** plants to try controllers on, behind the traits of [`control`](hysteron::control).
//!
//! - [`SpringPlant`]: the virtual [`rig`](crate::rig), a NiTi spring heated by a current, read
//!   through a thermocouple and an LVDT.
//! - [`PreisachPlant`]: a piezo-like actuator with an amplifier, made of relays that no model of
//!   this toolkit has on its plane.
//! - [`WirePlant`]: a wire heated by a duty, of which only the displacement is measured.
//! - [`LatentWirePlant`]: a wire whose transformation binds heat, from published laws.
//! - [`BoucWenPlant`]: a piezo stage with Bouc-Wen hysteresis, creep, a resonance and a delay.
//!
//! All are read through a [`SensorChain`]. None contains a model, an operator or a table of the
//! toolkit, so no model is tested on itself. Their options are plain data that a scenario file can
//! set.

mod bouc_wen;
mod cloud;
mod drift;
mod fatigue;
mod latent_wire;
mod preisach;
mod relays;
mod sensor;
mod spring;
mod wire;

pub use bouc_wen::{BoucWenPlant, BoucWenPlantOptions};
pub use drift::DriftOptions;
pub use fatigue::FatigueOptions;
pub use latent_wire::{HeatingDrive, LatentWirePlant, LatentWirePlantOptions};
pub use preisach::{PreisachPlant, PreisachPlantOptions};
pub use sensor::{SensorChain, SensorOptions};
pub use spring::{SpringPlant, SpringPlantOptions};
pub use wire::{WirePlant, WirePlantOptions};

use crate::rig::{RigError, check};

/// Divides `dt_s` (s) into equal steps, none longer than `longest_s`: their number and length. No
/// steps for a time that is not finite or not above zero.
fn divided(dt_s: f64, longest_s: f64) -> (u64, f64) {
    if !(dt_s > 0.0 && dt_s.is_finite()) {
        return (0, 0.0);
    }
    let steps = (dt_s / longest_s).ceil().max(1.0);
    (steps as u64, dt_s / steps)
}

fn check_room(degc: f64) -> Result<(), RigError> {
    check("temperature of the room (degC)", degc, -20.0, 50.0)
}
