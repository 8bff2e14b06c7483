//! The least-squares problem for the weights.
//!
//! `experiment` joins the recordings and `problem` sets up the fit. `sparse` and `rows` apply the
//! regressor of one recording without forming it; `regressor` combines recordings, starts and
//! loads. `units` divides the samples into branches or parts of them; `sums` and `unit_sums` are
//! products of groups of samples, from which fits and their errors follow without the samples.
//! `smoothness` is the penalty and `free` eliminates the offset. `solve` solves the normal equations
//! with `nnls`, `pivoting`, `cholesky` and `definite`; `nested` says where a search begins. With many
//! levels the Gram matrix is kept sparse, over Everett corners: `layout`, `corner_gram`,
//! `corner_system` and `grid_factor`; `coarse` says where their search begins. `room` limits the
//! memory. `again` fits the same inputs to other outputs.

pub(super) mod again;
pub(super) mod cholesky;
mod coarse;
pub(super) mod column;
pub(super) mod corner_gram;
pub(super) mod corner_system;
pub(super) mod definite;
pub(super) mod experiment;
pub(super) mod free;
pub(super) mod gram;
pub(super) mod grid_factor;
pub(super) mod layout;
pub(super) mod nested;
pub(crate) mod nnls;
pub(super) mod not_definite;
pub(super) mod of_load;
pub(crate) mod pivoting;
pub(super) mod problem;
pub(super) mod regressor;
pub(super) mod room;
pub(super) mod rows;
pub(super) mod smoothness;
pub(super) mod solve;
pub(super) mod sparse;
pub(super) mod sums;
pub(super) mod unit_sums;
pub(super) mod units;
