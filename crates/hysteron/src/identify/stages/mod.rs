//! Identifies the stages in front of the operators, together with the weights. `body` is the
//! thermal body; `nelder_mead` is its search.

pub(super) mod body;
mod nelder_mead;
