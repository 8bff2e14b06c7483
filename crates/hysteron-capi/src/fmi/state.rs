//! What the blocks remember.

use crate::delay::UnderWay;
use hysteron_core::control::{Gate, LowPass, Pid, Silence, Standstill};
use hysteron_core::{Direction, Model, Placed, StageState, Turn};

/// What a block remembers.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(crate) operators: hysteron_core::State<f64, Vec<Turn<f64>>>,
    pub(crate) stages: StageState<f64>,
    /// The model at the present load, where the weights depend on the load.
    pub(crate) mixed: Option<Mixed>,
    /// The inputs that do not act yet.
    pub(crate) under_way: UnderWay<Vec<f64>>,
    /// The rest of a controller, whose inverse is above.
    pub(crate) own: Option<Box<Loop>>,
}

/// Operators at one load.
#[derive(Debug, Clone)]
pub(crate) struct Mixed {
    pub(crate) model: Model<f64, Vec<f64>>,
    pub(crate) placed: Option<Placed<f64>>,
}

/// What a loop remembers beside the state of the inverse.
#[derive(Debug, Clone)]
pub(crate) struct Loop {
    /// The model at the drives that have acted.
    pub(crate) followed: Box<State>,
    /// Whether the inverse has a state already.
    pub(crate) aimed: bool,
    pub(crate) pid: Pid,
    pub(crate) standstill: Standstill,
    pub(crate) silence: Silence,
    pub(crate) gate: Gate,
    /// Filters of the readings, and of drives and reference, which it makes as late.
    pub(crate) filters: Filters,
    pub(crate) under_way: UnderWay<Vec<f64>>,
    /// The drive to go on from at the next sample, the difference that fades, and for how long.
    pub(crate) from: Option<f64>,
    pub(crate) fade: (f64, u32),
    pub(crate) drive: Option<f64>,
    pub(crate) acting: Option<f64>,
    pub(crate) prediction: f64,
    pub(crate) held: (bool, bool),
    pub(crate) turning: Turning,
    pub(crate) manual: bool,
}

/// Low-pass filters of one time constant.
#[derive(Debug, Clone)]
pub(crate) struct Filters {
    pub(crate) reading: LowPass,
    /// Time since the last reading, s.
    pub(crate) gap: f64,
    pub(crate) drive: LowPass,
    pub(crate) reference: LowPass,
}

/// The branch that the reference is on, as `hysteron::Turning` finds it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turning {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) branch: Option<Direction>,
}
