//! The error of a factorisation.

use crate::error::Error;

/// Numbers so large or so small that rounding makes the normal equations singular.
pub(crate) fn not_definite() -> Error {
    Error::Fit(
        "the normal equations cannot be factorised, because values in the data are too large or \
         too small: use another unit"
            .into(),
    )
}
