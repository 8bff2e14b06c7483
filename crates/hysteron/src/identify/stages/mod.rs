//! What stands in front of the operators, identified together with the weights.

pub(super) mod body;
mod nelder_mead;
