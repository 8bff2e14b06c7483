//! The gate: it keeps the estimator from learning from outliers.
//!
//! The gate judges the *surprise* of a reading: its prediction error less the error that remained
//! after the last accepted reading. An error that the model makes again and again, on a branch that
//! it knows badly, is no surprise, however large it is.
//!
//! The scale of surprises is a running mean of the sizes of accepted ones, so outliers do not
//! affect it. A plant may really change. Refused readings in a row that agree with each other are
//! taken as a jump of the plant and accepted. Refused readings that do not agree are taken as more
//! noise, and the scale grows step by step.

use crate::scalar::Real;

/// Length of the running mean, in samples. It is shorter than a branch of some hundred samples,
/// because the next branch may have another scale.
const MEMORY: usize = 64;
/// The scale at the start is the model's range divided by this: the usual error of a fitted model.
/// A model with larger errors first has its readings refused, until the scale has grown.
const AT_START: usize = 50;
/// The smallest scale is the model's range divided by this. Without noise, the scale would vanish
/// and rounding errors would be refused. Outliers within a gate of this scale do no harm.
const LEAST: usize = 1000;

/// What the gate says of a reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// No more surprising than those before.
    Usual,
    /// The last of a burst of surprising readings that agree: the plant has jumped.
    Jump,
    /// An outlier, so far.
    Refused,
}

/// Keeps what learns from outliers: it judges each reading by its surprise. All values are in the
/// output's unit. [`crate::Adaptation`] explains the rule.
///
/// An [`crate::Estimator`] has its own. Anything else that learns may use one: it asks before it
/// learns from a reading, and tells what error was left after a reading that was not refused.
///
/// ```
/// use hysteron_core::{Gate, Verdict};
/// let mut gate = Gate::new(10.0);
/// let (limit, burst) = (12.0, 8);
/// for error in [0.1, -0.1, 0.2] {
///     assert_eq!(gate.judge(error, limit, burst), Verdict::Usual);
///     gate.settle(error);
/// }
/// assert_eq!(gate.judge(4095.0, limit, burst), Verdict::Refused);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gate<T> {
    /// Range of the model's output.
    range: T,
    /// Usual size of a surprise.
    scale: T,
    /// The error that remained after the last accepted reading.
    left: T,
    /// The surprise of the last refused reading.
    last: T,
    /// Number of readings refused in a row since the scale last changed.
    refused: u32,
    /// Number of the last of these that agree with each other.
    agreeing: u32,
}

impl<T: Real> Gate<T> {
    /// A gate for a model whose output has this range, before the first error.
    #[must_use]
    pub fn new(range: T) -> Self {
        Self {
            range,
            scale: range / T::from_index(AT_START),
            left: T::ZERO,
            last: T::ZERO,
            refused: 0,
            agreeing: 0,
        }
    }

    /// Forgets all errors, because they were those of other weights.
    pub fn restart(&mut self) {
        *self = Self::new(self.range);
    }

    /// Judges a reading whose prediction has this `error`. `gate` and `burst` are the options of
    /// the same name of [`Adaptation`](super::Adaptation).
    pub fn judge(&mut self, error: T, gate: T, burst: u32) -> Verdict {
        if gate == T::ZERO {
            return Verdict::Usual;
        }
        let surprise = error - self.left;
        let size = surprise.max(-surprise);
        // A model without range gives no scale. The first surprise does.
        if size <= gate * self.scale || self.scale == T::ZERO {
            self.believe(self.scale + (size - self.scale) / T::from_index(MEMORY));
            return Verdict::Usual;
        }
        let agrees = self.agreeing > 0 && agree(surprise, self.last);
        self.agreeing = if agrees { self.agreeing + 1 } else { 1 };
        self.refused += 1;
        self.last = surprise;
        if self.agreeing >= burst {
            self.believe(size);
            return Verdict::Jump;
        }
        if self.refused >= burst {
            self.refused = 0;
            self.rescale(self.scale + self.scale);
        }
        Verdict::Refused
    }

    /// Keeps the error that `left` after learning from an accepted reading.
    pub fn settle(&mut self, left: T) {
        self.left = if left.is_finite() { left } else { T::ZERO };
    }

    fn believe(&mut self, scale: T) {
        (self.refused, self.agreeing) = (0, 0);
        self.rescale(scale);
    }

    fn rescale(&mut self, scale: T) {
        if scale.is_finite() {
            self.scale = scale.max(self.range / T::from_index(LEAST));
        }
    }
}

/// Whether two surprises may come from one jump: they differ by at most half of the larger one.
fn agree<T: Real>(a: T, b: T) -> bool {
    let size = |x: T| x.max(-x);
    size(a - b) <= T::HALF * size(a).max(size(b))
}
