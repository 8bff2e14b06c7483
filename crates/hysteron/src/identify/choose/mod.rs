//! Chooses levels and smoothness by the error on branches that were left out.

pub(super) mod left_out;
pub(super) mod validate;
