//! The **simulated** world: what models and controllers are tried on where no device is at hand.
//!
//! - [`rig`]: a NiTi spring under a load, heated by a current, from published laws of the material.
//! - [`plant`]: that spring and a piezo-like actuator behind sensors, to be driven by a controller.
//! - [`track`](mod@track): controllers compared on such a plant, as a scenario file says.
//!
//! Nothing here contains a model, an operator or a table of the toolkit. So what is shown on these
//! plants is not shown by a model on itself. Every recording says that it was simulated.
#![forbid(unsafe_code)]

pub mod plant;
pub mod rig;
pub mod track;
