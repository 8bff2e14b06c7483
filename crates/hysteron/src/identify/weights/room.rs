//! How much memory the matrices of a fit may take.

use crate::error::{Error, Result};

/// Most memory of a matrix or of its factor, in bytes.
pub(super) const MOST_BYTES: u128 = 4 << 30;

/// About what a column takes in sparse form, most of it in the factor.
const COLUMN_BYTES: u128 = 10 << 10;

/// Checks that so many unknown weights have room in sparse form.
pub(crate) fn check_columns(columns: usize) -> Result<()> {
    check_size(columns, columns as u128 * COLUMN_BYTES)
}

/// Checks that the Gram matrix of so many unknown weights has room with all its elements.
pub(crate) fn check_dense(columns: usize) -> Result<()> {
    check_size(columns, 8 * (columns as u128).pow(2))
}

fn check_size(columns: usize, bytes: u128) -> Result<()> {
    if bytes <= MOST_BYTES {
        return Ok(());
    }
    Err(Error::Fit(format!(
        "the Gram matrix of {columns} unknown weights takes {:.1} GiB, more than the {} GiB \
         allowed: take fewer levels",
        bytes as f64 / f64::from(1 << 30),
        MOST_BYTES >> 30
    )))
}
