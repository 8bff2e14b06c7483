//! What an export wrote, and what it needs on the target.

use super::real::CReal;
use std::path::PathBuf;

/// What was written, and what it needs on the target.
#[derive(Debug, Clone, PartialEq)]
pub struct CExport {
    /// The files.
    pub files: Vec<PathBuf>,
    /// The model's name in C.
    pub name: String,
    /// The number type.
    pub real: CReal,
    /// `K`.
    pub levels: usize,
    /// Whether there is an inverse: no weight is below zero.
    pub inverse: bool,
    /// What a target may be missed by that the inverse reports as reached, beside its tolerance, in
    /// the output's unit: the rounding of the number type, at most a thousandth of the range of
    /// outputs. Zero without an inverse.
    pub rounding: f64,
    /// The stages around the operators, in the order of the signal: `body`, `load`, `spacing`,
    /// and so on.
    pub stages: Vec<&'static str>,
    /// The sample time in seconds that the constants hold for, where the model depends on time.
    pub dt: Option<f64>,
    /// Bytes on a 32-bit target with naturally aligned numbers, such as a Cortex-M.
    pub memory: CMemory,
    /// Bytes on an 8-bit AVR. Its constants are copied to RAM, but for their tables.
    pub avr: CMemory,
    /// The worst case of one call.
    pub worst_case: CWorstCase,
}

/// Bytes of a model on a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CMemory {
    /// The model's constants: flash.
    pub constants: usize,
    /// Of them, the Everett tables.
    pub table: usize,
    /// Of them, those of the learners, without the weights.
    pub learners: usize,
    /// A state: RAM.
    pub state: usize,
    /// Of it, the operators at the present load, where the weights depend on the load.
    pub mixed: usize,
    /// Its turning points: RAM.
    pub turns: usize,
    /// For a control loop: what it remembers, beside the model's states. RAM.
    pub controller: Option<usize>,
    /// For a model that learns: the additional memory, without its turning points. RAM.
    pub adaptation: Option<usize>,
}

/// How many iterations the loops of one call take at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CWorstCase {
    /// Turning points passed in a step, `2K`.
    pub turning_points: usize,
    /// Iterations of the step's loop, `2K + 3`.
    pub step: usize,
    /// Halvings of an inverse step's two bisections together, before it steps.
    pub halvings: usize,
}

impl CWorstCase {
    pub(super) fn new(levels: usize) -> Self {
        // A bisection of n places takes ⌊log₂ n⌋ + 1 halvings.
        let halvings = |places: usize| places.ilog2() as usize + 1;
        Self {
            turning_points: 2 * levels,
            step: 2 * levels + 3,
            halvings: halvings(2 * levels + 1) + halvings(levels),
        }
    }
}
