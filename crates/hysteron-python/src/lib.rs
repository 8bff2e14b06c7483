//! The Python package `pyhysteron`: types and errors converted, no logic.

mod action;
mod adapt;
mod adaptive;
mod adaptive_load;
mod around;
mod array;
mod batch;
mod choices;
mod compare;
mod controller;
mod convert;
mod design;
mod device;
mod error;
mod evaluate;
mod export;
mod fit;
mod fleet;
mod inputs;
mod integer;
mod inverse;
mod learning;
mod model;
mod pid;
mod plane;
mod plant;
mod plot;
mod pool;
mod prepare;
mod prior;
mod progress;
mod read;
mod recording;
mod relay_test;
mod run;
mod shared;
mod stages;
mod state;
mod trace;
mod track;
mod turning;

use pyo3::prelude::*;

#[pymodule]
mod _hysteron {
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }

    #[pymodule_export]
    use crate::action::Action;
    #[pymodule_export]
    use crate::adapt::{Adapted, adapt};
    #[pymodule_export]
    use crate::adaptive::Adaptive;
    #[pymodule_export]
    use crate::adaptive_load::AdaptiveLoad;
    #[pymodule_export]
    use crate::batch::BatchModel;
    #[pymodule_export]
    use crate::compare::compare;
    #[pymodule_export]
    use crate::controller::Controller;
    #[pymodule_export]
    use crate::design::{Design, design, design_heated};
    #[pymodule_export]
    use crate::evaluate::excitation;
    #[pymodule_export]
    use crate::fit::{fit, left_out};
    #[pymodule_export]
    use crate::fleet::{fit_fleet, join_fleets, prior_of_fleet, read_fleet};
    #[pymodule_export]
    use crate::inverse::Inverse;
    #[pymodule_export]
    use crate::learning::Learning;
    #[pymodule_export]
    use crate::model::Model;
    #[pymodule_export]
    use crate::pid::Pid;
    #[pymodule_export]
    use crate::plant::{BoucWenPlant, LatentWirePlant, PreisachPlant, SimulatedPlant, SpringPlant};
    #[pymodule_export]
    use crate::prepare::prepare;
    #[pymodule_export]
    use crate::prior::WeightPrior;
    #[pymodule_export]
    use crate::read::{read, read_segments};
    #[pymodule_export]
    use crate::recording::Recording;
    #[pymodule_export]
    use crate::relay_test::RelayTest;
    #[pymodule_export]
    use crate::state::State;
    #[pymodule_export]
    use crate::trace::Trace;
    #[pymodule_export]
    use crate::track::{Comparison, scenarios, track, tune};
    #[pymodule_export]
    use crate::turning::{branches, headings, remembered};
}
