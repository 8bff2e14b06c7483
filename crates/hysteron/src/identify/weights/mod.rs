//! Weights from samples: regressor, Gram matrix, smoothness, least squares.

pub(super) mod cholesky;
pub(super) mod experiment;
pub(super) mod fit;
pub(super) mod free;
pub(super) mod initial;
pub(super) mod nnls;
pub(super) mod pivoting;
pub(super) mod problem;
pub(super) mod regressor;
pub(super) mod rows;
pub(super) mod smoothness;
pub(super) mod solve;
pub(super) mod sparse;
