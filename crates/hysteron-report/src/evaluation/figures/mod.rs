//! One file per kind of figure; `over_time` is what those over time share.

pub(super) mod close_up;
pub(super) mod cross_validation;
pub(super) mod discrepancy;
pub(super) mod evolution;
pub(super) mod excitation_map;
pub(super) mod input_time;
pub(super) mod load_loops;
pub(super) mod load_measured;
pub(super) mod load_shift;
pub(super) mod loops;
pub(super) mod output_time;
mod over_time;
pub(super) mod residuals;
pub(super) mod standard_errors;
pub(super) mod weights_map;
pub(super) mod weights_plane;

pub use excitation_map::excitation_map;
