//! One file per kind of figure; `cut` is what those share whose curves leave the panel.

pub(super) mod before_after;
pub(super) mod close_up;
pub(super) mod cut;
pub(super) mod errors;
pub(super) mod input;
pub(super) mod output;
pub(super) mod weights_time;
