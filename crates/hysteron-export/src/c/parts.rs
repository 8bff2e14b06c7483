//! The parts of a control loop that it has only where they are asked for.

use super::algorithm::{CLOCK, DECAY, FILTER, GATE};
use hysteron::control::Scheme;

/// What a loop has only where it was asked for.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    pub(super) gate: bool,
    pub(super) filter: bool,
    /// Measured time.
    pub(super) time: bool,
    /// Whether that makes constants of the model anew.
    pub(super) clock: bool,
}

impl Parts {
    /// `measured` time makes constants anew where a model with stages is `timed`.
    pub(super) fn of(scheme: &Scheme, measured: bool, timed: bool) -> Self {
        Self {
            gate: scheme.gate.is_some(),
            filter: scheme.filter_s > 0.0,
            time: measured,
            clock: measured && timed,
        }
    }

    /// `HYS_LOOP`, and `has` of a loop.
    pub(super) fn bits(self) -> u8 {
        let bits = [self.gate, self.filter, self.time].into_iter().enumerate();
        bits.map(|(n, there)| u8::from(there) << n).sum()
    }

    /// Their files.
    pub(super) fn files(self) -> impl Iterator<Item = (&'static str, &'static str)> {
        let some = |there: bool, files: &'static [_]| if there { files } else { &[] };
        let gate = some(self.gate, &GATE).iter();
        gate.chain(some(self.filter, &FILTER))
            .chain(some(self.clock, &CLOCK))
            .chain(some(self.filter || self.clock, &DECAY))
            .copied()
    }
}
