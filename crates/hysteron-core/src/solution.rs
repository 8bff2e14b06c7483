//! What the inverse finds: an input, and whether it gives the target.

/// Whether a target can be reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The input gives the target, up to its tolerance.
    Ok,
    /// The target lies below every output. The input is the lowest one, `T_min − ΔT`.
    Low,
    /// The target lies above every output. The input is the highest one, `T_max`.
    High,
    /// The target lies inside a jump of a relay model. The input is that of the jump, and the
    /// output lies beyond the target by more than the tolerance.
    Passed,
    /// The model can give the target, but not in this sample: the drive is at an end of its range,
    /// or the stages after the operators are too slow. The drive goes as far as it can.
    Limited,
}

impl Status {
    /// The number of the status in files and in interfaces without enumerations: 0 for
    /// [`Status::Ok`], −1 for [`Status::Low`], 1 for [`Status::High`], 2 for [`Status::Passed`],
    /// 3 for [`Status::Limited`].
    #[must_use]
    pub fn number(self) -> i8 {
        match self {
            Status::Ok => 0,
            Status::Low => -1,
            Status::High => 1,
            Status::Passed => 2,
            Status::Limited => 3,
        }
    }

    /// The name of the status in tables: `ok`, `low`, `high`, `passed`, `limited`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Low => "low",
            Status::High => "high",
            Status::Passed => "passed",
            Status::Limited => "limited",
        }
    }

    /// Whether the target lies beyond the model's range of outputs by more than its tolerance.
    #[must_use]
    pub fn is_out_of_reach(self) -> bool {
        matches!(self, Status::Low | Status::High)
    }

    /// The status for a model whose output has the opposite sign.
    #[must_use]
    pub fn mirrored(self) -> Self {
        match self {
            Status::Low => Status::High,
            Status::High => Status::Low,
            other => other,
        }
    }
}

/// An input, and whether it gives the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution<T> {
    /// The input, in its unit, within the plane's active range `[T_min − ΔT, T_max]`.
    ///
    /// Relay models have two exceptions. An input beyond the range stays there for as long as the
    /// output stays. An input that fell to `T_max` has to rise above it by
    /// [`Plane::nudge`](crate::Plane::nudge) to switch the relays on again.
    pub input: T,
    /// Whether the input gives the target.
    pub status: Status,
}
