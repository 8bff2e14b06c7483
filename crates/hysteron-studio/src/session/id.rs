//! The numbers that a session gives.

/// The number of a file, a fit, a job or a drive. None is given twice in a session.
pub type Id = u64;

/// The largest number that is given: JavaScript holds no larger one exactly.
pub(super) const LAST: Id = (1 << 53) - 1;
