//! The **simulated** world: plants to try models and controllers on without a device.
//!
//! - [`rig`]: a NiTi spring under a load, heated by a current, from published laws of the material.
//! - [`plant`]: that spring and a piezo-like actuator behind sensors, to be driven by a controller.
//! - [`joint`]: PID gains from a model, by simulation of the loop around it.
//! - [`track`](mod@track): controllers compared on such a plant, as a scenario file says.
//!
//! No plant here contains a model, an operator or a table of the toolkit. So no model is tested on
//! itself. Every recording is marked as simulated.
#![forbid(unsafe_code)]

pub mod joint;
pub mod plant;
pub mod rig;
pub mod track;
