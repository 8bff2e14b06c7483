//! Errors of the virtual rig.

use hysteron::filter::FilterError;

/// Why the virtual rig refused a call. Its state is not changed when an error is returned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RigError {
    /// A number is not finite or lies outside the range in which the rig's physics holds.
    #[error("{what} is {value}, but must lie between {low} and {high}")]
    OutOfRange {
        /// Which number, with its unit.
        what: &'static str,
        /// What was given.
        value: f64,
        /// Smallest value accepted.
        low: f64,
        /// Largest value accepted.
        high: f64,
    },
    /// Heating or cooling came to rest before the temperature reached the target.
    #[error(
        "the temperature comes to rest at {reached_degc:.1} degC and never reaches the target \
         {target_degc} degC: choose a target between room temperature and what the current can \
         heat to"
    )]
    TargetNotReached {
        /// The target, °C.
        target_degc: f64,
        /// Where the temperature came to rest, °C.
        reached_degc: f64,
    },
    /// The plant has nothing that this disturbance could act on.
    #[error("this plant has no {0}")]
    NoSuchDisturbance(&'static str),
    /// A recording cannot be filtered because it has no time of its samples.
    #[error("the recording has no time: a filter needs the sampling rate")]
    NoTime,
    /// The low-pass filter refused its arguments.
    #[error(transparent)]
    Filter(#[from] FilterError),
}

impl From<RigError> for hysteron::Error {
    fn from(error: RigError) -> Self {
        hysteron::Error::Plant(Box::new(error))
    }
}

/// Accepts `value` if it is finite and within `[low, high]`.
pub(crate) fn check(what: &'static str, value: f64, low: f64, high: f64) -> Result<(), RigError> {
    if (low..=high).contains(&value) {
        Ok(())
    } else {
        Err(RigError::OutOfRange {
            what,
            value,
            low,
            high,
        })
    }
}
