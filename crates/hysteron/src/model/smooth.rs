//! The strengths of the smoothness of the weights, in two directions of the plane.

use serde::{Deserialize, Deserializer, Serialize};

/// How strongly the weights of neighbours are pulled together, in two directions.
///
/// With `ρ` the density of the weights, and `α`, `β` in units of the plane's width, the penalty is
/// `along · ∫∫ (∂ρ/∂α + ∂ρ/∂β)² + across · ∫∫ |∇ρ|²`. It is added to the mean squared error. Both
/// strengths have no unit, and their effect does not depend on the number of levels.
///
/// *Along* the diagonal the width `β − α` of an operator stays the same. The density of most
/// materials depends on the width more than on where an operator stands. In the limit of a large
/// `along` it depends on the width alone, which is a Prandtl-Ishlinskii model. *Across* pulls
/// neighbours in both directions together.
///
/// Usual strengths are 1e-10 to 1e-4 along and 1e-10 to 1e-7 across; 0 is none.
///
/// ```
/// use hysteron::Smooth;
/// assert_eq!(Smooth::from(1e-8), Smooth { along: 1e-8, across: 0.0 });
/// assert!(Smooth::NONE.is_none());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Smooth {
    /// Strength along the diagonal, 0 to 1e6.
    pub along: f64,
    /// Strength in both directions, 0 to 1e6.
    pub across: f64,
}

impl Smooth {
    /// No smoothness.
    pub const NONE: Self = Self {
        along: 0.0,
        across: 0.0,
    };

    /// In each direction the larger strength of the two.
    pub(crate) fn at_least(self, other: Self) -> Self {
        Self {
            along: self.along.max(other.along),
            across: self.across.max(other.across),
        }
    }

    /// Whether both strengths are zero.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }
}

impl From<f64> for Smooth {
    /// A strength along the diagonal alone.
    fn from(along: f64) -> Self {
        Self { along, across: 0.0 }
    }
}

impl From<(f64, f64)> for Smooth {
    /// Strengths along and across.
    fn from((along, across): (f64, f64)) -> Self {
        Self { along, across }
    }
}

/// As it is written. Older files have one number, a strength across.
#[derive(Deserialize)]
#[serde(untagged)]
enum Written {
    One(f64),
    Both { along: f64, across: f64 },
}

impl<'de> Deserialize<'de> for Smooth {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(match Written::deserialize(deserializer)? {
            Written::One(across) => Self { along: 0.0, across },
            Written::Both { along, across } => Self { along, across },
        })
    }
}
